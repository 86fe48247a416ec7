// SPDX-License-Identifier: Apache-2.0
// Transforms of the scenes that mesh files hold, and their effect on the rounding errors of the points' coordinates.
#pragma once

#include <array>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// Column by column: x' = m[0] x + m[4] y + m[8] z + m[12].
using Matrix = std::array<double, 16>;
inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix product(const Matrix& a, const Matrix& b);
// The turn about a unit axis by the angle of this cosine and sine.
Matrix turned_about(const Vec3& axis, double cosine, double sine);
Vec3 applied(const Matrix& m, const Vec3& p);
bool is_mirrored(const Matrix& m);
bool is_finite(const Matrix& m);

// Precision of positions in their own frame.
struct Grain {
  double relative = 0x1p-53;  // of each coordinate
  double half_step = 0;       // of each coordinate; 0: not quantised
};

// Bounds the rounding error of the transformed points. A transform is the same for all points of a node, so its own rounding
// does not bend a flat face; what counts is the transformed rounding error of the points, and the rounding of the sums.
class Rounding {
 public:
  // Adds points whose coordinates are at most `largest`; `world` null: they are not transformed.
  void note(const Grain& grain, const std::array<double, 3>& largest, const Matrix* world);

  // Sets the soup's quanta. Where no point is transformed, the quantum follows from the coordinates themselves (floats or not).
  // Else they are doubles with one absolute bound for all: a relative one would grow with the distance that a node was moved.
  void finish(PolygonSoup& soup) const;

 private:
  bool is_moved_ = false;
  double half_step_ = 0;  // of points that are not transformed
  double bound_ = 0;
};

}  // namespace fdcg::bake
