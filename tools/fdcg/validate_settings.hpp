// SPDX-License-Identifier: Apache-2.0
// Settings of validate for a file, from the command line or from .fdcg-validate.json.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// A severity, or nothing: "never" of --fail-on, "off" of --severity.
using Level = std::optional<bake::Severity>;

struct ValidateSettings {
  std::optional<bake::Weld> weld;
  std::optional<Level> fail_on;
  std::set<std::string> allow;
  std::map<std::string, Level> severities;
  std::optional<std::string> baseline;  // a path
};

// `stronger` where it says something; lists are joined, and of one rule's severity the stronger counts.
ValidateSettings combined(const ValidateSettings& weaker, const ValidateSettings& stronger);

// Values as the command line and the configuration file spell them. A wrong one is a Failure (2) that starts with the value and
// names the right ones.
bake::Result<Level> parse_fail_on(const std::string& text);
bake::Result<Level> parse_severity(const std::string& rule, const std::string& text);
// What to tell whoever made an error that no graph can stand less than one: compile refuses such meshes all the same. Empty:
// nobody.
std::string lowered_errors(const ValidateSettings& settings);
std::optional<bake::Failure> check_allowed_rule(const std::string& rule);

}  // namespace fdcg::tools
