// SPDX-License-Identifier: Apache-2.0
// The file's records by the graph's real type, and the layout of a node's block.
#pragma once

#include "fdcg/format.h"

namespace fdcg {

template <class Real>
struct Records;
template <>
struct Records<double> {
  using Plane = fdcg_plane_f64;
  using Node = fdcg_node_f64;
  using Edge = fdcg_connection_geometry_f64;
  using Corner = fdcg_corner_f64;
  using FanBox = fdcg_fan_box_f64;
};
template <>
struct Records<float> {
  using Plane = fdcg_plane_f32;
  using Node = fdcg_node_f32;
  using Edge = fdcg_connection_geometry_f32;
  using Corner = fdcg_corner_f32;
  using FanBox = fdcg_fan_box_f32;
};

// Where a node's Voronoi planes start in its block, and where the block ends: after its sides, zeros up to a multiple of Real.
template <class Real>
constexpr uint32_t planes_at(uint32_t side_count) {
  constexpr uint32_t kSidesAt = offsetof(typename Records<Real>::Node, sides);
  return (kSidesAt + side_count * uint32_t{sizeof(fdcg_side)} + sizeof(Real) - 1) / sizeof(Real) * sizeof(Real);
}
template <class Real>
constexpr uint32_t node_bytes(uint32_t side_count, bool has_planes) {
  return planes_at<Real>(side_count) + (has_planes ? side_count * uint32_t{sizeof(typename Records<Real>::Plane)} : 0u);
}

}  // namespace fdcg
