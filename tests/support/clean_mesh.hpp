// SPDX-License-Identifier: Apache-2.0
// Meshes without any defect, to plant defects in, with the properties known by construction.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "random.hpp"

namespace fdcg::test {

// Closed, consistent, manifold surfaces apart from one another; every coordinate a float's value, no two points equal, every
// face convex and exactly flat, none thin.
struct CleanMesh {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  struct Shell {
    std::uint32_t first_face, end_face;
    std::uint32_t parent = kNone;  // the shell that it lies in
    bool is_cavity = false;        // looks inwards, encloses negative volume
  };

  bake::PolygonSoup soup;
  std::vector<Shell> shells;
  // Pairs of vertices across a thin wall: the first may be moved onto, or a little beyond, the second without its faces
  // touching anything on the way.
  std::vector<std::array<std::uint32_t, 2>> facing;
};

// About so many faces, of shapes drawn at random: plates, waved plates, rounded bodies, tori, hollow ones of both, nested ones,
// and unless `triangles_only` boxes of quads and prisms.
CleanMesh random_clean_mesh(Random& random, std::uint32_t faces, bool triangles_only);

}  // namespace fdcg::test
