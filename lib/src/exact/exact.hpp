// SPDX-License-Identifier: Apache-2.0
// Exact geometric predicates on the stored coordinates. exact.cpp implements them by CGAL's filtered predicates.
#pragma once

#include "fdcg/bake.hpp"

namespace fdcg::bake::exact {

// Orientation test: the sign (-1, 0, +1) of ((b - a) x (c - a)) . (d - a). It is +1 when d is in front of the plane through a,
// b, c, that is, on the side from which they run counter-clockwise. Finite points only. About 10 ns, rarely more.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The sign of the k-th component of (b - a) x (c - a), k = 0, 1, 2: the orientation of the triangle seen along axis k.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int k);

// Whether the points are collinear (two or more equal points are).
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

// The sign of (b - a) . (c - a).
int dot_sign(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace fdcg::bake::exact
