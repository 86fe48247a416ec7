// SPDX-License-Identifier: Apache-2.0
// A command's options as a table. Help, manual pages and shell completions are all made from it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace fdcg::tools {

struct HelpRow {
  std::vector<std::string> names;  // "-o", "--output"; empty: a positional argument
  std::string value;               // "FILE"; empty: a flag
  std::string help;                // sentences
  std::string default_text;        // "f64"; empty: none that is worth a word
  std::vector<std::string> words;  // values that completion offers
  bool is_required = false, is_repeatable = false;
};

struct HelpGroup {
  std::string title;  // "Output"
  std::vector<HelpRow> rows;
};

// The footer is paragraphs, apart by an empty line: text, which is wrapped, or a title that ends with a colon ("Examples:") and
// indented lines, which stay as they are.
struct HelpPage {
  std::string name;     // "fdcg compile"
  std::string summary;  // a sentence
  std::vector<HelpRow> arguments;
  std::vector<HelpGroup> groups;                              // in the order of their first options
  std::vector<std::pair<std::string, std::string>> commands;  // name and summary
  std::string footer;
};

// What the parser knows: group() is the group's title, type_name() the value's name, default_str() the default, the description
// the help. std::logic_error where an option lacks its group, its help or its value's name: a fault of the program.
HelpPage page_of(const CLI::App& app);

std::vector<const CLI::App*> all_commands(const CLI::App& app);
std::string full_name(const CLI::App& app);        // "fdcg compile"
std::string usage_line(const HelpPage& page);      // "fdcg compile [OPTIONS] MESH -o FILE"
std::string names_and_value(const HelpRow& row);   // "-o, --output FILE"
std::string help_and_default(const HelpRow& row);  // help and "Default: f64."
std::string help_text(const HelpPage& page);       // for a terminal of 80 columns
std::vector<std::string> paragraphs_of(const std::string& footer);

class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override;
};

}  // namespace fdcg::tools
