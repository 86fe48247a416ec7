// SPDX-License-Identifier: Apache-2.0
#include "pareto.hpp"

#include <algorithm>
#include <cstdio>

namespace fdcg::test {

void rank(std::vector<Standing>& entries, double resolution, double floor_m) {
  for (Standing& entry : entries) {
    const Standing* fastest = nullptr;
    for (const Standing& other : entries) {
      if (std::max(other.error_m, floor_m) > std::max(entry.error_m, floor_m)) continue;
      if (other.time_ns * (1 + resolution) >= entry.time_ns) continue;
      if (fastest == nullptr || other.time_ns < fastest->time_ns) fastest = &other;
    }
    entry.is_on_frontier = fastest == nullptr;
    entry.beaten_by = fastest == nullptr ? "" : fastest->name;
  }
}

std::string where_others_win(const std::vector<Standing>& entries, const std::string& family) {
  std::string text;
  const auto compare = [&](const char* what, double Standing::*figure) {
    const Standing* own = nullptr;
    for (const Standing& entry : entries) {
      if (entry.family == family && (own == nullptr || entry.*figure < own->*figure)) own = &entry;
    }
    for (const Standing& entry : entries) {
      if (own == nullptr || entry.family == family || !(entry.*figure < own->*figure)) continue;
      char part[200];
      std::snprintf(part, sizeof part, "%s%s %s: %.2g times %s, error %.2g m against %.2g m", text.empty() ? "" : "; ",
                    entry.name.c_str(), what, entry.*figure / (own->*figure), own->name.c_str(), entry.error_m, own->error_m);
      text += part;
    }
  };
  compare("faster", &Standing::time_ns);
  compare("smaller", &Standing::bytes_per_face);
  compare("earlier baked", &Standing::bake_s);
  return text;
}

}  // namespace fdcg::test
