// SPDX-License-Identifier: Apache-2.0
#include "json_words.hpp"

#include <string_view>

namespace fdcg::tools {

bool DuplicateKeys::operator()(int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
  using Event = nlohmann::json::parse_event_t;
  if (event == Event::object_start) keys_.emplace_back();
  if (event == Event::object_end) keys_.pop_back();
  if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second && duplicate.empty())
    duplicate = parsed.get<std::string>();
  return true;
}

std::string plain_complaint(const nlohmann::json::exception& error) {
  std::string what = error.what();
  for (const std::string_view own : {"] parse error at ", "] "}) {  // after the number that the parser has for it
    const std::size_t at = what.find(own);
    if (at == std::string::npos) continue;
    what.erase(0, at + own.size());
    break;
  }
  const std::size_t from = what.find(": syntax error while parsing "), to = what.find(" - ");
  if (from != std::string::npos && to != std::string::npos && from < to) what.replace(from, to + 3 - from, ": ");
  return what;
}

}  // namespace fdcg::tools
