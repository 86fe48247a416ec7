// SPDX-License-Identifier: Apache-2.0
#include "manuals.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "completions.hpp"
#include "help_page.hpp"

namespace fdcg::tools {
namespace {

// What roff would take for a request, an escape or a hyphen.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool begins_line = out.empty() || out.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else {
      out += c;
    }
  }
  return out;
}

std::string upper(std::string text) {
  for (char& c : text)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

std::string page_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string tagged(const std::string& tag, const std::string& text) {
  return ".TP\n.B " + roff(tag) + "\n" + roff(text) + "\n";
}

std::string footer_section(const std::string& paragraph) {
  const std::size_t first_line = paragraph.find(":\n  ");
  if (first_line == std::string::npos) return ".PP\n" + roff(paragraph) + "\n";
  const std::string title = paragraph.substr(0, first_line);
  std::string text = ".SH " + (title == "Exit codes" ? "EXIT STATUS" : upper(title)) + "\n.nf\n";
  std::string lines = paragraph.substr(first_line + 2);
  for (std::size_t at = lines.find("\n  "); at != std::string::npos; at = lines.find("\n  ", at + 1))
    lines.erase(at + 1, 2);
  return text + roff(lines.substr(2)) + "\n.fi\n";
}

std::string manual_page(const HelpPage& page, const std::vector<std::string>& see_also, const std::string& version,
                        const std::string& date) {
  std::string text =
      ".\\\" SPDX-License-Identifier: Apache-2.0\n.TH " + upper(page_name(page.name)) + " 1 " + date + " \"" + version + "\"\n";
  text += ".SH NAME\n" + roff(page_name(page.name)) + " \\- " + roff(page.summary.substr(0, page.summary.size() - 1)) + "\n";
  text += ".SH SYNOPSIS\n.B " + roff(usage_line(page)) + "\n.SH DESCRIPTION\n" + roff(page.summary) + "\n";
  std::string sections;
  for (const std::string& paragraph : paragraphs_of(page.footer))
    (paragraph.find(":\n  ") == std::string::npos ? text : sections) += footer_section(paragraph);
  if (!page.commands.empty()) text += ".SH COMMANDS\n";
  for (const auto& [name, summary] : page.commands)
    text += tagged(name, summary);
  if (!page.arguments.empty()) text += ".SH ARGUMENTS\n";
  for (const HelpRow& row : page.arguments)
    text += tagged(names_and_value(row), help_and_default(row));
  text += ".SH OPTIONS\n";
  for (const HelpGroup& group : page.groups) {
    text += ".SS " + group.title + "\n";
    for (const HelpRow& row : group.rows)
      text += tagged(names_and_value(row), help_and_default(row));
  }
  text += sections + ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < see_also.size(); ++i)
    text += ".BR " + roff(see_also[i]) + " (1)" + (i + 1 == see_also.size() ? "" : ",") + "\n";
  return text;
}

std::string write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  return file ? "" : "cannot write '" + path.string() + "'";
}

}  // namespace

std::string write_manuals(const CLI::App& app, const std::string& version, const std::string& folder, const std::string& date) {
  const std::filesystem::path root = folder;
  std::vector<HelpPage> pages{page_of(app)};
  for (const CLI::App* const command : all_commands(app))
    pages.push_back(page_of(*command));
  std::string problem;
  const auto write = [&problem](const std::filesystem::path& path, const std::string& text) {
    if (problem.empty()) problem = write_file(path, text);
  };
  for (const HelpPage& page : pages) {
    std::vector<std::string> see_also;
    for (const HelpPage& other : pages)
      if (other.name != page.name) see_also.push_back(page_name(other.name));
    write(root / "man1" / (page_name(page.name) + ".1"), manual_page(page, see_also, version, date));
  }
  write(root / "bash-completion" / "completions" / app.get_name(), bash_completion(pages));
  write(root / "zsh" / "site-functions" / ("_" + app.get_name()), zsh_completion(pages));
  return problem;
}

}  // namespace fdcg::tools
