// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <cstdio>
#include <exception>
#include <new>

#include "help_page.hpp"
#include "manuals.hpp"
#include "options.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

// Of the program that runs: fail() needs both, far from where the command line was read.
struct Invocation {
  std::string program, command;  // "fdcg", "fdcg compile"
};
Invocation& invocation() {
  static Invocation the_invocation;
  return the_invocation;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : all_commands(app))
    names.push_back(command->get_name());
  return names;
}

// The first word that was not expected, as a message, with what was likely meant by it. "": none, or one too many.
std::string unknown_word(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> words = app.remaining(true);
  if (words.empty()) return "";
  const std::string word = words.front().substr(0, words.front().find('='));
  if (word.starts_with("-")) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options()) {
      for (const std::string& name : option->get_lnames())
        names.push_back("--" + name);
    }
    return "'" + word + "' is no option" + did_you_mean(word, names);
  }
  return &command == &app ? "'" + word + "' is no command" + did_you_mean(word, command_names(app)) : "";
}

int usage_error(const CLI::ParseError& error, const CLI::App& app) {
  const CLI::App* command = &app;
  for (const CLI::App* chosen : app.get_subcommands())
    command = chosen;
  invocation().command = full_name(*command);
  return fail(kUsage, complaint(error, app, *command));
}

// `fdcg help`, `fdcg help compile`.
Command add_help(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("help", "Show the help of a command.");
  const auto name = std::make_shared<std::string>();
  command->add_option("command", *name, offering("The command. Without it: the program's own help.", command_names(app)))
      ->type_name("COMMAND");
  const auto run = [name, &app]() -> int {
    const CLI::App* about = name->empty() ? &app : nullptr;
    for (const CLI::App* const known : all_commands(app)) {
      if (known->get_name() == *name) about = known;
    }
    if (about == nullptr) return fail(kUsage, "'" + *name + "' is no command" + did_you_mean(*name, command_names(app)));
    std::fputs(help_text(page_of(*about)).c_str(), stdout);
    return kClean;
  };
  return {command, run};
}

int run(const Program& program, int argc, char** argv) {
  CLI::App app{program.summary, program.name};
  app.footer(program.footer);
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Show this help.");
  app.set_version_flag("--version", program.version, "Show the version and the version of the file format.");
  app.require_subcommand(1);
  std::vector<Command> commands;
  for (const auto& add : program.commands)
    commands.push_back(add(app));
  commands.push_back(add_help(app));
  if (argc == 4 && std::string_view(argv[1]) == "--write-manuals") {
    const std::string problem = write_manuals(app, program.version, argv[2], argv[3]);
    return problem.empty() ? kClean : fail(kInternal, problem);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    return usage_error(error, app);
  }
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    invocation().command = full_name(*command.app);
    return command.run();
  }
  return kUsage;
}

}  // namespace

int run_program(const Program& program, int argc, char** argv) {
  invocation() = {program.name, program.name};
  try {
    return run(program, argc, argv);
  } catch (const std::bad_alloc&) {
    return fail(kInternal, "out of memory");
  } catch (const std::exception& error) {
    return fail(kInternal, std::string("internal error: ") + error.what());
  }
}

std::string complaint(const CLI::ParseError& error, const CLI::App& app, const CLI::App& command) {
  std::string message = error.what();
  message = message.substr(0, message.find('\n'));
  if (message == "A subcommand is required") message = "a command is required";
  const std::string unknown = unknown_word(app, command);
  return unknown.empty() ? message : unknown;
}

int fail(int exit_code, std::string_view message) {
  std::string line = invocation().program + ": " + std::string(message);
  if (exit_code == kUsage) {
    line += line.ends_with('.') || line.ends_with('?') ? "" : ".";
    line += " Try '" + invocation().command + " --help'.";
  }
  std::fprintf(stderr, "%s\n", line.c_str());
  return exit_code;
}

int commit_all(const std::vector<AtomicFile*>& files, int exit_code) {
  for (const AtomicFile* const file : files)
    if (!file->ok()) return fail(kFile, file->error());
  for (AtomicFile* const file : files)
    if (!file->commit()) return fail(kFile, file->error());
  return exit_code;
}

void warn(std::string_view message) {
  std::fprintf(stderr, "%s: warning: %.*s\n", invocation().program.c_str(), static_cast<int>(message.size()), message.data());
}

std::string exit_codes(std::string_view clean, std::string_view findings) {
  return "Exit codes:\n  0  " + std::string(clean) + "\n  1  " + std::string(findings) +
         "\n  2  wrong usage\n  3  an input cannot be read, or an output cannot be written\n  4  a fault of the program";
}

}  // namespace fdcg::tools
