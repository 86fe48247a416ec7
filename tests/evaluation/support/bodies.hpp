// SPDX-License-Identifier: Apache-2.0
// The bodies that are evaluated: a ladder of sizes, and shapes that are awkward to touch. All of them are 0.1 m along their
// longest side; points are doubles (rounded_to_float() of meshes.hpp makes floats of them).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

constexpr double kBody_m = 0.1;  // the longest side of every body's bounds

enum class BodyGroup {
  sphere,  // the ladder, geodesic: every edge convex
  star,    // the ladder, waves and roughness of a tenth of an edge: half of the edges concave
  torus,   // the ladder, long rows of quads cut into triangles
  awkward
};

// What can be made; nothing is made before make().
struct Body {
  std::string name;  // as in every table: letters, digits, _
  BodyGroup group = BodyGroup::awkward;
  std::uint32_t faces = 0;  // of the soup
  bool is_closed = true;    // and of positive volume; else an open patch
  std::string what;         // one line
  bake::PolygonSoup (*make_unscaled)(int) = nullptr;
  int size = 0;  // what make_unscaled gets: parts, faces around, ...

  [[nodiscard]] bake::PolygonSoup make() const;  // metres
};

// Its longest side made kBody_m.
bake::PolygonSoup scaled_to_body(const bake::PolygonSoup& soup);

// Every body of at most so many faces, the ladder first, each group in ascending order of faces.
std::vector<Body> bodies(std::uint32_t most_faces = 1'100'000);
// Throws std::invalid_argument, listing the names, where there is no such body.
Body body_named(const std::string& name);

}  // namespace fdcg::test
