// SPDX-License-Identifier: Apache-2.0
// The half-edges of sound faces, by the vertices at their ends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

class EdgeTable {
 public:
  // n log n.
  EdgeTable(const Mesh& mesh, const std::vector<FaceState>& states) {
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      if (states[f] != FaceState::sound) continue;
      for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
        const std::uint32_t u = +mesh.corners[h], v = +mesh.corners[+next(mesh, FaceId{f}, HalfedgeId{h})];
        entries_.push_back({key(u, v), FaceId{f}, u < v});
      }
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.ends < b.ends; });
  }

  struct Entry {
    std::uint64_t ends;
    FaceId face;
    bool goes_up;  // from the smaller vertex to the larger one
  };
  // In no particular order.
  [[nodiscard]] std::span<const Entry> at(VertexId u, VertexId v) const {
    const auto is_before = [](const Entry& a, const Entry& b) { return a.ends < b.ends; };
    const auto [first, end] =
        std::equal_range(entries_.begin(), entries_.end(), Entry{key(+u, +v), FaceId{0}, false}, is_before);
    return {first, end};
  }
  struct Count {
    std::size_t along = 0, against = 0;  // the way from u to v
  };
  [[nodiscard]] Count count(VertexId u, VertexId v) const {
    Count count;
    for (const Entry& entry : at(u, v))
      ++(entry.goes_up == (+u < +v) ? count.along : count.against);
    return count;
  }

 private:
  static std::uint64_t key(std::uint32_t u, std::uint32_t v) { return std::uint64_t{std::min(u, v)} << 32 | std::max(u, v); }
  std::vector<Entry> entries_;
};

}  // namespace fdcg::bake
