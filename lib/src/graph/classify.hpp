// SPDX-License-Identifier: Apache-2.0
// Classification of each edge of a triangle mesh as convex, concave or coplanar.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "base/quantum.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/format.h"

namespace fdcg::bake {

// How flat an edge is: the first tier whose condition holds.
enum class Flat : std::uint8_t {
  no = 0,
  exact,    // the four corners are exactly coplanar and the normals agree
  quantum,  // moving each of the four by its quantum could make it so, and the normals are within 90 degrees
  angle     // the normals are within the user's angle
};

// The sign is that of the stored points, whatever the tier: fdcg_connection_type, where FDCG_COPLANAR with Flat::no is a fold
// (the two faces lie on one another).
class EdgeClass {
 public:
  EdgeClass() = default;
  EdgeClass(fdcg_connection_type sign, Flat flat)
      : bits_(static_cast<std::uint8_t>(static_cast<unsigned>(sign) | static_cast<unsigned>(flat) << 2)) {}
  [[nodiscard]] fdcg_connection_type sign() const { return static_cast<fdcg_connection_type>(bits_ & 3u); }
  [[nodiscard]] Flat flat() const { return static_cast<Flat>(bits_ >> 2); }
  [[nodiscard]] bool is_fold() const { return sign() == FDCG_COPLANAR && flat() == Flat::no; }
  friend bool operator==(EdgeClass, EdgeClass) = default;

 private:
  std::uint8_t bits_ = 0;
};

// The class of every half-edge; both halves of an edge have the same. Triangles only, none degenerate, finite points.
// Signs are exact (a static filter decides nearly all of them, exact::orient3d the rest). Linear time, on `jobs` threads.
[[nodiscard]] std::vector<EdgeClass> classify_edges(const Mesh& mesh, const Topology& topology, const Quantum& quantum,
                                                    const Coplanar& coplanar, unsigned jobs);

}  // namespace fdcg::bake
