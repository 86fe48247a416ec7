// SPDX-License-Identifier: Apache-2.0
// Where the nodes of a glTF scene put points, and how far that carries the rounding of the points' coordinates.
#pragma once

#include <array>

#include "fdcg/bake.hpp"
#include "import/gltf_accessor.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

Matrix product(const Matrix& a, const Matrix& b);
Vec3 applied(const Matrix& m, const Vec3& p);
bool is_mirrored(const Matrix& m);

// How finely positions are known in their own frame.
struct Grain {
  double relative = 0x1p-53;  // of each coordinate
  double half_step = 0;       // of each coordinate; 0: they are no steps of a grid
};

Grain grain_of(const Positions& positions);

// What rounding did to the points once they are in place. The transforms are the same for all points of a node, and so neither
// bend nor break a flat face; what counts is how far they carry the rounding of the points themselves, and that of the sums.
class Rounding {
 public:
  // Points of a primitive whose coordinates are at most `largest`; `world` null: they stay where they are.
  void note(const Grain& grain, const std::array<double, 3>& largest, const Matrix* world);

  // Sets the soup's quanta. Where every point stays where it is, the coordinates say by themselves whether they are floats.
  // Else they are doubles, and one bound holds for all: a relative one would grow with the distance that a node was moved.
  void finish(PolygonSoup& soup) const;

 private:
  bool is_moved_ = false;
  double half_step_ = 0;  // of points that stay where they are
  double bound_ = 0;
};

}  // namespace fdcg::bake::gltf
