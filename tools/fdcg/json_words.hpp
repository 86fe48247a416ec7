// SPDX-License-Identifier: Apache-2.0
// What the JSON files of people need beside nlohmann's document: members that stand twice, and plain words for what is no JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace fdcg::tools {

// A callback of Json::parse. Two members of one name in an object hide each other: `duplicate` is the first such name.
class DuplicateKeys {
 public:
  bool operator()(int, nlohmann::json::parse_event_t event, nlohmann::json& parsed);
  std::string duplicate;

 private:
  std::vector<std::set<std::string>> keys_;
};

// Why a text is no JSON, from the parser's own words: "line 1, column 19: invalid literal; last read: ...".
std::string plain_complaint(const nlohmann::json::exception& error);

}  // namespace fdcg::tools
