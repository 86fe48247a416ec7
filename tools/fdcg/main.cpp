// SPDX-License-Identifier: Apache-2.0
// fdcg: the offline compiler. One file a subcommand; this one only chooses.
#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include "../common/nearest.hpp"
#include "fdcg/fdcg.h"
#include "fdcg_commands.hpp"

namespace fdcg::tools {
namespace {

constexpr const char* kExamples = R"(
Examples:
  fdcg validate bunny.off
  fdcg compile bunny.off -o bunny.fdcg --units mm
  fdcg repair bunny.off -o clean.off --all
  fdcg inspect bunny.fdcg
  fdcg explain non-manifold-edge
  fdcg grasp cube.fdcg --contacts fingers.csv --mu 0.5 --grip 10

Exit codes: 0 clean; 1 findings; 2 wrong usage; 3 an input that cannot be read or an output that cannot be written;
4 a fault of the program.
'fdcg COMMAND --help' tells the options of each command.)";

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// What was likely meant by the first word that nobody expected.
std::string hint_for(const CLI::App& app, const CLI::App& command) {
  for (const std::string& word : app.remaining(true)) {
    std::vector<std::string> names;
    if (word.starts_with("-")) {
      for (const CLI::Option* const option : command.get_options()) {
        for (const std::string& name : option->get_lnames())
          names.push_back("--" + name);
      }
    } else if (&command == &app) {
      for (const CLI::App* const known : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(known->get_name());
    }
    return did_you_mean(word.substr(0, word.find('=')), names);
  }
  return "";
}

int usage_error(const CLI::ParseError& error, const CLI::App& app) {
  std::string name = "fdcg";
  const CLI::App* command = &app;
  for (const CLI::App* chosen : app.get_subcommands()) {
    name += " " + chosen->get_name();
    command = chosen;
  }
  return fail(kUsage, first_line(error.what()) + hint_for(app, *command) + " (see '" + name + " --help')");
}

int run(int argc, char** argv) {
  CLI::App app{"Compiles polygon meshes into Face Directed Connection Graphs (.fdcg) for haptic rendering.", "fdcg"};
  app.footer(kExamples);
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "fdcg " FDCG_VERSION_STRING " (file format 1)");
  app.require_subcommand(1);
  const std::vector<Command> commands{add_compile(app), add_validate(app), add_repair(app),
                                      add_inspect(app), add_explain(app),  add_grasp(app)};
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
