// SPDX-License-Identifier: Apache-2.0
// fdcg: the offline compiler. One file a subcommand; this one only chooses.
#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include "command.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {
namespace {

constexpr const char* kExamples = R"(
Examples:
  fdcg validate bunny.off
  fdcg compile bunny.off -o bunny.fdcg --units mm
  fdcg repair bunny.off -o clean.off --all
  fdcg inspect bunny.fdcg
  fdcg explain non-manifold-edge

Exit codes: 0 clean; 1 findings; 2 wrong usage; 3 an input that cannot be read or an output that cannot be written;
4 a fault of the program.
'fdcg COMMAND --help' tells the options of each command.)";

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

int usage_error(const CLI::ParseError& error, const CLI::App& app) {
  std::string command = "fdcg";
  for (const CLI::App* chosen : app.get_subcommands())
    command += " " + chosen->get_name();
  return fail(kUsage, first_line(error.what()) + " (see '" + command + " --help')");
}

int run(int argc, char** argv) {
  CLI::App app{"Compiles polygon meshes into Face Directed Connection Graphs (.fdcg) for haptic rendering.", "fdcg"};
  app.footer(kExamples);
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "fdcg " FDCG_VERSION_STRING " (file format 1)");
  app.require_subcommand(1);
  const std::vector<Command> commands{add_compile(app), add_validate(app), add_repair(app), add_inspect(app), add_explain(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    return usage_error(error, app);
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return kUsage;
}

}  // namespace

int fail(int exit_code, std::string_view message) {
  std::fprintf(stderr, "fdcg: %.*s\n", static_cast<int>(message.size()), message.data());
  return exit_code;
}

}  // namespace fdcg::tools

int main(int argc, char** argv) {
  try {
    return fdcg::tools::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return fdcg::tools::fail(fdcg::tools::kInternal, "out of memory");
  } catch (const std::exception& error) {
    return fdcg::tools::fail(fdcg::tools::kInternal, std::string("internal error: ") + error.what());
  }
}
