// SPDX-License-Identifier: Apache-2.0
// fdcg explain: what a rule means, why it matters at contact, what to do.
#include <algorithm>
#include <cstdio>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "fdcg/bake.hpp"
#include "fdcg_commands.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

std::string severity_name(bake::Severity severity) {
  constexpr const char* kNames[] = {"note", "warning", "error"};
  return kNames[static_cast<int>(severity)];
}

std::vector<std::string> rule_names() {
  std::vector<std::string> names;
  for (const bake::Rule& rule : bake::rules())
    names.emplace_back(rule.name);
  return names;
}

std::string list_of_rules() {
  std::string text;
  for (const bake::Rule& rule : bake::rules()) {
    std::string line(rule.name);
    line.resize(std::max<std::size_t>(line.size(), 24), ' ');
    std::string severity = severity_name(rule.severity);
    severity.resize(9, ' ');
    text += line + severity + std::string(rule.meaning) + "\n";
  }
  return text;
}

std::string explanation(const bake::Rule& rule) {
  std::string text = std::string(rule.name) + " (" + severity_name(rule.severity) + ")\n\n";
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
  CLI::App* const command =
      app.add_subcommand("explain", "Explain a rule: what it means, why it matters for contact, how to fix it.");
  command->footer("Examples:\n  fdcg explain\n  fdcg explain winding-inconsistent\n\n" +
                  exit_codes("success", "not used by this command"));
  const auto name = std::make_shared<std::string>();
  const std::string help = "Name of a rule, as validate prints it. Without it: the list of all rules.";
  command->add_option("rule", *name, offering(help, rule_names()))->type_name("RULE");
  const auto run = [name]() -> int {
    const bake::Rule* const rule = bake::find_rule(*name);
    if (!name->empty() && rule == nullptr) {
      return fail(kUsage, "'" + *name + "' is no rule; the nearest is '" + nearest(*name, rule_names()) +
                              "', 'fdcg explain' lists them all");
    }
    AtomicFile out("-");
    out.write(rule == nullptr ? list_of_rules() : explanation(*rule));
    return commit_all({&out});
  };
  return {command, run};
}

}  // namespace fdcg::tools
