// SPDX-License-Identifier: Apache-2.0
// A number for a finding that stays when the file is renumbered or changed elsewhere: Element::fingerprint.
#pragma once

#include <cstdint>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A hash of the rule's name and of a multiset of points, in whatever order they come. Points are taken bit for bit but that
// -0 = 0 and all NaN are one; the same on every machine. What is added:
//   findings at vertices   the vertex
//   at edges               both ends; at a vertex inside an edge these three
//   at faces               all corners; of a pair of faces those of both, of a duplicate those of one
//   at patches             the corner of the patch least in x, then y, then z
//   at the whole file      nothing
// A corner that names no vertex counts as one point of its own.
class Fingerprint {
 public:
  explicit Fingerprint(std::string_view rule);
  void add(const Vec3& point);
  void add_missing_corner();
  [[nodiscard]] std::uint64_t value() const;

 private:
  std::uint64_t rule_;
  std::uint64_t sum_ = 0;
};

}  // namespace fdcg::bake
