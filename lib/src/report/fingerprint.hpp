// SPDX-License-Identifier: Apache-2.0
// Element::fingerprint: identifies a finding independently of indices and of changes elsewhere in the file.
#pragma once

#include <cstdint>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A hash of the rule's name and of a multiset of points, independent of their order. Points are hashed bit for bit as
// floats hold them, so that a mesh which was saved in another format has the same, except that -0 = 0 and all NaN are equal;
// the same on every machine. The points are:
//   findings at vertices   the vertex
//   at edges               both ends; at a vertex inside an edge these three
//   at faces               all corners; of a pair of faces those of both, of a duplicate those of one
//   at patches             the corner of the patch with the smallest x, then y, then z
//   at the whole file      nothing
// Corners with an invalid index all count as one special point.
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
