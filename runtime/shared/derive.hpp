// SPDX-License-Identifier: Apache-2.0
// What a file may leave out, from what it always has. The compiler stores the bits that these expressions give (format.h:
// fdcg_edge, Voronoi planes), so that a graph steps the same whether its planes are stored or derived.
#pragma once

#include "fdcg/format.h"
#include "shared/vec.hpp"

namespace fdcg {

// normal.x + offset: positive outside.
template <class Real>
struct Plane {
  Vec3<Real> normal;
  Real offset;

  [[nodiscard]] FDCG_HOT Real distance(const Vec3<Real>& x) const { return dot(normal, x) + offset; }
};

// A connection's line: start + u direction, 0 <= u <= length, from corner 0 to corner 1.
template <class Real>
struct Edge {
  Vec3<Real> start, direction;
  Real length;
};

// A difference of corners whose square is below kSquare is multiplied by kScale first: squares of denormals have no digits.
template <class Real>
struct TinyEdge;
template <>
struct TinyEdge<double> {
  static constexpr double kSquare = FDCG_TINY_SQUARE_F64, kScale = 0x1p700;
};
template <>
struct TinyEdge<float> {
  static constexpr float kSquare = static_cast<float>(FDCG_TINY_SQUARE_F32), kScale = 0x1p100F;
};

template <class Real>
inline Edge<Real> derive_edge(Vec3<Real> corner0, Vec3<Real> corner1) {
  Vec3<Real> along = corner1 - corner0;
  const bool is_tiny = dot(along, along) < TinyEdge<Real>::kSquare;
  if (is_tiny) along = along * TinyEdge<Real>::kScale;
  const Real length = norm(along);
  return {corner0, {along.x / length, along.y / length, along.z / length}, is_tiny ? length / TinyEdge<Real>::kScale : length};
}

// Through the edge, pointing out of the face with this normal: `which` 0 where the face's winding runs along the edge.
template <class Real>
inline Plane<Real> derive_voronoi_plane(Vec3<Real> start, Vec3<Real> direction, Vec3<Real> normal, uint32_t which) {
  const Vec3<Real> out = which == 0 ? cross(direction, normal) : cross(normal, direction);
  const Real length = norm(out);
  const Vec3<Real> m = {out.x / length, out.y / length, out.z / length};
  return {m, -dot(m, start)};
}

}  // namespace fdcg
