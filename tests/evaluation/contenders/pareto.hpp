// SPDX-License-Identifier: Apache-2.0
// Which contenders no other beats in both time and error.
#pragma once

#include <string>
#include <vector>

namespace fdcg::test {

struct Standing {
  std::string name, family;
  double time_ns = 0, error_m = 0, bytes_per_face = 0, bake_s = 0;
  // found by rank():
  bool is_on_frontier = false;
  std::string beaten_by;  // the fastest that is no less exact
  double cold_ns = 0;     // for the table alone
};

// An entry is beaten by one whose error is no larger and whose time is shorter by more than `resolution`, the part of a time
// that measuring the same thing twice differs by: what is not told apart does not beat. Errors below `floor_m` count as that.
void rank(std::vector<Standing>& entries, double resolution, double floor_m);

// Of those that are not of `family`: who beats its best time, size or bake, by how much, and at what error. Empty: nobody.
std::string where_others_win(const std::vector<Standing>& entries, const std::string& family);

}  // namespace fdcg::test
