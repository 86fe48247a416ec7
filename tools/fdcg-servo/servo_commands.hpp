// SPDX-License-Identifier: Apache-2.0
// The subcommands of fdcg-servo: each declares its options on the app and hands back what runs when it was chosen.
#pragma once

#include "../common/program.hpp"

namespace fdcg::servo {

using tools::Command;
using tools::fail;
using enum tools::ExitCode;

Command add_replay(CLI::App& app);
Command add_run(CLI::App& app);
Command add_devices(CLI::App& app);
Command add_check(CLI::App& app);

}  // namespace fdcg::servo
