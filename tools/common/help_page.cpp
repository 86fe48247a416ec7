// SPDX-License-Identifier: Apache-2.0
#include "help_page.hpp"

#include <algorithm>
#include <stdexcept>

#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kHelpColumn = 28;
constexpr const char* kGeneral = "General";

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

// Words are kept together up to the column; every line but the first is indented.
std::string wrapped(const std::string& text, std::size_t column, std::size_t indent) {
  std::string lines;
  for (const std::string& word : split(text, ' ')) {
    if (word.empty()) continue;
    if (column + word.size() + 1 > kColumns && !lines.empty()) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!lines.empty()) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

// "  NAME        help, wrapped in its column"; a long name stands on a line of its own.
std::string two_columns(const std::string& name, const std::string& help) {
  std::string line = "  " + name;
  if (line.size() + 2 > kHelpColumn) line += "\n" + std::string(kHelpColumn, ' ');
  if (line.find('\n') == std::string::npos) line.resize(kHelpColumn, ' ');
  return line + wrapped(help, kHelpColumn, kHelpColumn) + "\n";
}

HelpRow row_of(const CLI::Option& option) {
  HelpRow row;
  for (const std::string& name : option.get_snames())
    row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    row.names.push_back("--" + name);
  if (option.get_items_expected_max() != 0) row.value = option.get_type_name();
  std::vector<std::string> lines = split(option.get_description(), '\n');
  row.help = lines.front();
  row.words.assign(lines.begin() + 1, lines.end());
  row.default_text = option.get_default_str();
  row.is_required = option.get_required();
  row.is_repeatable = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll || option.get_expected_max() > 1;
  return row;
}

void require_complete(const std::string& command, const HelpRow& row, const std::string& group) {
  const std::string name = row.names.empty() ? row.value : row.names.back();
  const bool is_plain_value = row.value.find_first_of("{}[]|: ") == std::string::npos && row.value != "TEXT";
  if (row.help.empty() || !row.help.ends_with('.') || (group == "Options" && !row.names.empty()) || !is_plain_value)
    throw std::logic_error("'" + command + "': the option '" + name + "' lacks a group, a sentence or a value's name");
}

}  // namespace

HelpPage page_of(const CLI::App& app) {
  HelpPage page{full_name(app), app.get_description(), {}, {}, {}, app.get_footer()};
  for (const CLI::Option* const option : app.get_options()) {
    const bool is_general = option == app.get_help_ptr() || option == app.get_version_ptr();
    const std::string group = is_general ? kGeneral : option->get_group();
    HelpRow row = row_of(*option);
    require_complete(page.name, row, group);
    if (option->get_positional()) {
      page.arguments.push_back(std::move(row));
      continue;
    }
    auto found =
        std::find_if(page.groups.begin(), page.groups.end(), [&](const HelpGroup& known) { return known.title == group; });
    if (found == page.groups.end()) found = page.groups.insert(page.groups.end(), {group, {}});
    found->rows.push_back(std::move(row));
  }
  // the parser knows --help before all others; it is the last that one looks for
  std::stable_partition(page.groups.begin(), page.groups.end(), [](const HelpGroup& group) { return group.title != kGeneral; });
  for (const CLI::App* const command : all_commands(app))
    page.commands.emplace_back(command->get_name(), command->get_description());
  return page;
}

std::vector<const CLI::App*> all_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : full_name(*app.get_parent()) + " " + app.get_name();
}

std::string usage_line(const HelpPage& page) {
  std::string line = page.name + (page.commands.empty() ? "" : " COMMAND") + " [OPTIONS]";
  for (const HelpRow& row : page.arguments)
    line += row.is_required ? " " + row.value : " [" + row.value + "]";
  for (const HelpGroup& group : page.groups) {
    for (const HelpRow& row : group.rows)
      if (row.is_required) line += " " + row.names.front() + " " + row.value;
  }
  return line;
}

std::string names_and_value(const HelpRow& row) {
  std::string text = listed(row.names);
  if (!row.value.empty()) text += (text.empty() ? "" : " ") + row.value;
  return text;
}

std::string help_and_default(const HelpRow& row) {
  return row.help + (row.default_text.empty() ? "" : " Default: " + row.default_text + ".");
}

std::vector<std::string> paragraphs_of(const std::string& footer) {
  std::vector<std::string> paragraphs;
  for (const std::string& line : split(footer, '\n')) {
    if (line.empty() || paragraphs.empty()) paragraphs.emplace_back();
    if (!line.empty()) paragraphs.back() += (paragraphs.back().empty() ? "" : "\n") + line;
  }
  paragraphs.erase(std::remove(paragraphs.begin(), paragraphs.end(), ""), paragraphs.end());
  return paragraphs;
}

std::string help_text(const HelpPage& page) {
  std::string text = wrapped(page.summary, 0, 0) + "\n\nUsage: " + usage_line(page) + "\n";
  const auto add_rows = [&text](const std::string& title, const std::vector<HelpRow>& rows) {
    if (!rows.empty()) text += "\n" + title + ":\n";
    for (const HelpRow& row : rows)
      text += two_columns(names_and_value(row), help_and_default(row));
  };
  if (!page.commands.empty()) text += "\nCommands:\n";
  for (const auto& [name, summary] : page.commands)
    text += two_columns(name, summary);
  add_rows("Arguments", page.arguments);
  for (const HelpGroup& group : page.groups)
    add_rows(group.title, group.rows);
  for (const std::string& paragraph : paragraphs_of(page.footer)) {
    const bool stays = paragraph.find("\n  ") != std::string::npos;
    std::string words = paragraph;
    std::replace(words.begin(), words.end(), '\n', ' ');
    text += "\n" + (stays ? paragraph : wrapped(words, 0, 0)) + "\n";
  }
  return text;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const {
  return help_text(page_of(*app));
}

}  // namespace fdcg::tools
