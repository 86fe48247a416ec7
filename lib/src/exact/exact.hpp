// SPDX-License-Identifier: Apache-2.0
// Exact signs of the stored coordinates. CGAL's filtered predicates stand behind it, in exact.cpp alone.
#pragma once

#include "fdcg/bake.hpp"

namespace fdcg::bake::exact {

// The sign (-1, 0, +1) of ((b - a) x (c - a)) . (d - a): +1 when d is in front of the plane through a, b, c, whose normal
// points to where they run counter-clockwise. Finite points only. Some 10 ns, rarely more.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The sign of the k-th component of (b - a) x (c - a), k = 0, 1, 2: the orientation of the triangle seen along axis k.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int k);

// All on one line, or two of them equal.
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

// The sign of (b - a) . (c - a).
int dot_sign(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace fdcg::bake::exact
