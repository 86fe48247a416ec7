// SPDX-License-Identifier: Apache-2.0
// fdcg-servo: the host of the servo step. One file a subcommand; this one only chooses.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "fdcg/fdcg.h"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

constexpr const char* kExamples = R"(
Examples:
  fdcg-servo run scene.json --arm
  fdcg-servo devices
  fdcg-servo check scene.json
  fdcg-servo replay bunny.fdcg --trajectory hip.csv -o log.csv
  fdcg-servo replay session.fdcglog

Exit codes: 0 clean; 1 findings (each command says which); 2 wrong usage; 3 an input that cannot be read or an output that cannot be written; 4 a fault of the
program.)";

int run(int argc, char** argv) {
  CLI::App app{"Runs the servo step of Face Directed Connection Graphs (.fdcg): on devices, or replayed.", "fdcg-servo"};
  app.footer(kExamples);
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "fdcg-servo " FDCG_VERSION_STRING " (file format 1)");
  app.require_subcommand(1);
  const std::vector<Command> commands{add_run(app), add_devices(app), add_check(app), add_replay(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    const std::string text = error.what();
    const std::string command = app.get_subcommands().empty() ? "" : " " + app.get_subcommands().front()->get_name();
    return fail(kUsage, text.substr(0, text.find('\n')) + " (see 'fdcg-servo" + command + " --help')");
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return kUsage;
}

}  // namespace

int fail(int exit_code, std::string_view message) {
  std::fprintf(stderr, "fdcg-servo: %.*s\n", static_cast<int>(message.size()), message.data());
  return exit_code;
}

}  // namespace fdcg::servo

int main(int argc, char** argv) {
  try {
    return fdcg::servo::run(argc, argv);
  } catch (const std::exception& error) {
    return fdcg::servo::fail(fdcg::servo::kInternal, std::string("internal error: ") + error.what());
  }
}
