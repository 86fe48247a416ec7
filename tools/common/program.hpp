// SPDX-License-Identifier: Apache-2.0
// What fdcg and fdcg-servo have in common: subcommands, help, exit codes, and the style of their errors.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "atomic_file.hpp"

namespace fdcg::tools {

// The promise of the command line; of several files the first in this order that occurred: internal, file, findings, clean.
enum ExitCode { kClean = 0, kFindings = 1, kUsage = 2, kFile = 3, kInternal = 4 };

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  // the exit code
};

struct Program {
  std::string name;     // "fdcg"
  std::string summary;  // one sentence
  std::string version;  // what --version prints
  std::string footer;   // as of a command: help_page.hpp
  std::vector<Command (*)(CLI::App&)> commands;
};

// The whole of main: reads the command line, answers --help, --version and `help COMMAND`, runs the command that was chosen.
// `--write-manuals FOLDER DATE`, for the build, writes manual pages and shell completions (manuals.hpp). Exceptions become exit
// code 4.
int run_program(const Program& program, int argc, char** argv);

// What is wrong with a command line, in one line: of `app`, or of `command`, its subcommand, or the same.
std::string complaint(const CLI::ParseError& error, const CLI::App& app, const CLI::App& command);

// "PROGRAM: message" on standard error; returns the code. After wrong usage it names the help of the command that runs.
int fail(int exit_code, std::string_view message);
// Gives the outputs their names, in this order, once all of them are sound: `exit_code`, or what fail(kFile, ...) returns.
int commit_all(const std::vector<AtomicFile*>& files, int exit_code = kClean);
// "PROGRAM: warning: message" on standard error.
void warn(std::string_view message);

// The paragraph of a footer that lists exit codes: what 0 and 1 mean for this command, and the other three.
std::string exit_codes(std::string_view clean, std::string_view findings);

}  // namespace fdcg::tools
