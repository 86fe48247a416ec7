// SPDX-License-Identifier: Apache-2.0
// fdcg explain: what a rule means, why it matters at contact, what to do.
#include <algorithm>
#include <cstdio>

#include "../common/atomic_file.hpp"
#include "command.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {
namespace {

std::string_view severity_name(bake::Severity severity) {
  switch (severity) {
    case bake::Severity::note:
      return "note";
    case bake::Severity::warning:
      return "warning";
    case bake::Severity::error:
      break;
  }
  return "error";
}

// Edits (insert, delete, replace one letter) between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

std::string_view nearest_rule(std::string_view name) {
  const auto& rules = bake::rules();
  return std::min_element(rules.begin(), rules.end(),
                          [name](const bake::Rule& a, const bake::Rule& b) {
                            return edit_distance(a.name, name) < edit_distance(b.name, name);
                          })
      ->name;
}

std::string list_of_rules() {
  std::string text;
  for (const bake::Rule& rule : bake::rules()) {
    std::string line(rule.name);
    line.resize(std::max<std::size_t>(line.size(), 24), ' ');
    std::string severity(severity_name(rule.severity));
    severity.resize(9, ' ');
    text += line + severity + std::string(rule.meaning) + "\n";
  }
  return text;
}

std::string explanation(const bake::Rule& rule) {
  std::string text = std::string(rule.name) + " (" + std::string(severity_name(rule.severity)) + ")\n\n";
  text += "What it counts\n  " + std::string(rule.meaning) + "\n\n";
  text += "Why it matters\n  " + std::string(rule.why) + "\n\n";
  text += "What to do\n  " + std::string(rule.remedy) + "\n";
  if (rule.severity == bake::Severity::error) {
    text += rule.can_be_allowed ? "\n'fdcg compile --allow " + std::string(rule.name) + "' lets it pass.\n"
                                : std::string("\n'fdcg compile' always refuses it.\n");
  }
  return text;
}

}  // namespace

Command add_explain(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("explain", "What a rule means, why it matters for contact, how to fix it");
  command->footer("\nExamples:\n  fdcg explain                      the list of rules\n  fdcg explain winding-inconsistent");
  const auto name = std::make_shared<std::string>();
  command->add_option("rule", *name, "Name of a rule, as validate prints it; none: list them all")->type_name("RULE");
  const auto run = [name]() -> int {
    const bake::Rule* const rule = bake::find_rule(*name);
    if (!name->empty() && rule == nullptr) {
      return fail(kUsage, "'" + *name + "' is no rule; the nearest is '" + std::string(nearest_rule(*name)) +
                              "', 'fdcg explain' lists them all");
    }
    AtomicFile out("-");
    out.write(rule == nullptr ? list_of_rules() : explanation(*rule));
    return out.commit() ? kClean : fail(kFile, out.error());
  };
  return {command, run};
}

}  // namespace fdcg::tools
