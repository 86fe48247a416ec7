// SPDX-License-Identifier: Apache-2.0
// The subcommands of fdcg-servo: each declares its options on the app and hands back what runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string_view>

namespace fdcg::servo {

enum ExitCode { kClean = 0, kFindings = 1, kUsage = 2, kFile = 3, kInternal = 4 };

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  // the exit code
};

Command add_replay(CLI::App& app);
Command add_run(CLI::App& app);
Command add_devices(CLI::App& app);
Command add_check(CLI::App& app);

// "fdcg-servo: message" on standard error; returns the code.
int fail(int exit_code, std::string_view message);

}  // namespace fdcg::servo
