// SPDX-License-Identifier: Apache-2.0
#include "completions.hpp"

#include <algorithm>
#include <string_view>

#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

std::string command_of(const HelpPage& page) {
  return page.name.substr(page.name.find(' ') + 1);
}

// bash: the names of a function that takes '-' for '_'.
std::string function_name(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return "_" + name;
}

bool names_a_file(const std::string& value) {
  constexpr std::string_view kFiles[] = {"FILE", "FILE...", "MESH", "MESH...", "GRAPH", "OBJECT", "SCENE", "FOLDER"};
  return std::find(std::begin(kFiles), std::end(kFiles), value) != std::end(kFiles);
}

std::vector<std::string> option_names(const HelpPage& page) {
  std::vector<std::string> names;
  for (const HelpGroup& group : page.groups) {
    for (const HelpRow& row : group.rows)
      names.insert(names.end(), row.names.begin(), row.names.end());
  }
  return names;
}

// Of a command, by the word before: "    compile:--units) words='m mm cm in' ;;"
std::string bash_cases(const HelpPage& page) {
  std::string text;
  for (const HelpGroup& group : page.groups) {
    for (const HelpRow& row : group.rows) {
      if (row.value.empty()) continue;
      std::vector<std::string> labels;
      for (const std::string& name : row.names)
        labels.push_back(command_of(page) + ":" + name);
      const std::string kind = names_a_file(row.value) ? "file" : "value";
      text += "    " + listed(labels, " | ") + ") kind=" + kind + " words='" + listed(row.words, " ") + "' ;;\n";
    }
  }
  std::vector<std::string> words;
  bool takes_file = false;
  for (const HelpRow& row : page.arguments) {
    words.insert(words.end(), row.words.begin(), row.words.end());
    takes_file = takes_file || names_a_file(row.value);
  }
  return text + "    " + command_of(page) + ":*) kind=" + (takes_file ? "file" : "value") + " words='" + listed(words, " ") +
         "' options='" + listed(option_names(page), " ") + "' ;;\n";
}

// Inside '...', in the part of a specification of _arguments that stands in brackets.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return out;
}

std::string zsh_value(const HelpRow& row) {
  if (row.value.empty()) return "";
  const std::string action = !row.words.empty() ? "(" + listed(row.words, " ") + ")" : names_a_file(row.value) ? "_files" : " ";
  return ":" + zsh_text(row.value) + ":" + action;
}

std::string zsh_option(const HelpRow& row) {
  const std::string help = "[" + zsh_text(row.help) + "]" + zsh_value(row);
  const auto form = [&row](const std::string& name) {
    return name + (row.value.empty() || !name.starts_with("--") ? "" : "=");
  };
  const std::string others = row.is_repeatable ? "*" : "(" + listed(row.names, " ") + ")";
  std::string text;
  for (const std::string& name : row.names)
    text += " \\\n        '" + others + form(name) + help + "'";
  return text;
}

std::string zsh_arguments(const HelpPage& page) {
  std::string text;
  for (const HelpGroup& group : page.groups) {
    for (const HelpRow& row : group.rows)
      text += zsh_option(row);
  }
  for (const HelpRow& row : page.arguments)
    text += " \\\n        '" + std::string(row.is_repeatable ? "*" : row.is_required ? "" : ":") + zsh_value(row) + "'";
  return text;
}

}  // namespace

std::string bash_completion(const std::vector<HelpPage>& pages) {
  const HelpPage& program = pages.front();
  std::vector<std::string> commands;
  std::string cases;
  for (std::size_t i = 1; i < pages.size(); ++i) {
    commands.push_back(command_of(pages[i]));
    cases += bash_cases(pages[i]);
  }
  const std::string function = function_name(program.name);
  return "# SPDX-License-Identifier: Apache-2.0\n# Completion of " + program.name + " in bash, made from its options.\n" +
         function + R"(() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= kind=value words= options= i
  COMPREPLY=()
  # --format=json comes as three words
  [[ $word == '=' ]] && word=
  [[ $previous == '=' ]] && previous=${COMP_WORDS[COMP_CWORD - 2]}
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
    )" + listed(commands, " | ") +
         R"()
      command=${COMP_WORDS[i]}
      break
      ;;
    esac
  done
  case $command:$previous in
    :*) words=')" +
         listed(commands, " ") + "' options='" + listed(option_names(program), " ") + "' ;;\n" + cases + R"(  esac
  [[ $word == -* ]] && words=$options
  if [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  fi
  # without a match the shell completes names of files, where one may stand
  [[ $kind == file ]] || compopt +o default 2>/dev/null
  return 0
}
complete -o default -F )" +
         function + " " + program.name + "\n";
}

std::string zsh_completion(const std::vector<HelpPage>& pages) {
  const HelpPage& program = pages.front();
  std::string text = "#compdef " + program.name + "\n# SPDX-License-Identifier: Apache-2.0\n# Completion of " + program.name +
                     " in zsh, made from its options.\n" + function_name(program.name) +
                     "() {\n  local context state line curcontext=$curcontext\n  local -a commands\n  commands=(\n";
  for (const auto& [name, summary] : program.commands)
    text += "    '" + zsh_text(name) + ":" + zsh_text(summary) + "'\n";
  text += "  )\n  _arguments -C" + zsh_arguments(program) +
          " \\\n        '1:COMMAND:->command' \\\n        '*::argument:->argument'\n  case $state in\n"
          "    command) _describe -t commands command commands ;;\n    argument)\n      case $line[1] in\n";
  for (std::size_t i = 1; i < pages.size(); ++i)
    text += "      " + command_of(pages[i]) + ") _arguments" + zsh_arguments(pages[i]) + " ;;\n";
  return text + "      esac\n      ;;\n  esac\n}\n" + function_name(program.name) + " \"$@\"\n";
}

}  // namespace fdcg::tools
