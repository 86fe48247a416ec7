// SPDX-License-Identifier: Apache-2.0
// The effect of the node transforms of a glTF scene on the rounding errors of the points' coordinates.
#pragma once

#include <array>

#include "fdcg/bake.hpp"
#include "import/gltf_accessor.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

Matrix product(const Matrix& a, const Matrix& b);
Vec3 applied(const Matrix& m, const Vec3& p);
bool is_mirrored(const Matrix& m);

// Precision of positions in their own frame.
struct Grain {
  double relative = 0x1p-53;  // of each coordinate
  double half_step = 0;       // of each coordinate; 0: not quantised
};

Grain grain_of(const Positions& positions);

// Bounds the rounding error of the transformed points. A transform is the same for all points of a node, so its own rounding
// does not bend a flat face; what counts is the transformed rounding error of the points, and the rounding of the sums.
class Rounding {
 public:
  // Adds the points of a primitive whose coordinates are at most `largest`; `world` null: they are not transformed.
  void note(const Grain& grain, const std::array<double, 3>& largest, const Matrix* world);

  // Sets the soup's quanta. Where no point is transformed, the quantum follows from the coordinates themselves (floats or not).
  // Else they are doubles with one absolute bound for all: a relative one would grow with the distance that a node was moved.
  void finish(PolygonSoup& soup) const;

 private:
  bool is_moved_ = false;
  double half_step_ = 0;  // of points that are not transformed
  double bound_ = 0;
};

}  // namespace fdcg::bake::gltf
