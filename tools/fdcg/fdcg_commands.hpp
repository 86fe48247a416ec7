// SPDX-License-Identifier: Apache-2.0
// The subcommands of fdcg: each declares its options on the app and hands back what runs when it was chosen.
#pragma once

#include "../common/program.hpp"

namespace fdcg::tools {

Command add_compile(CLI::App& app);
Command add_validate(CLI::App& app);
Command add_repair(CLI::App& app);
Command add_batch(CLI::App& app);
Command add_inspect(CLI::App& app);
Command add_explain(CLI::App& app);
Command add_grasp(CLI::App& app);
Command add_view(CLI::App& app);

}  // namespace fdcg::tools
