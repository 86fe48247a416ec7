// SPDX-License-Identifier: Apache-2.0
// The subcommands of fdcg: each declares its options on the app and hands back what runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>

namespace fdcg::tools {

// The promise of the command line; of several files the first in this order that occurred: internal, file, findings, clean.
enum ExitCode { kClean = 0, kFindings = 1, kUsage = 2, kFile = 3, kInternal = 4 };

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  // the exit code
};

Command add_compile(CLI::App& app);
Command add_validate(CLI::App& app);
Command add_repair(CLI::App& app);
Command add_inspect(CLI::App& app);
Command add_explain(CLI::App& app);
Command add_grasp(CLI::App& app);

// "fdcg: message" on standard error; returns the code.
int fail(int exit_code, std::string_view message);

}  // namespace fdcg::tools
