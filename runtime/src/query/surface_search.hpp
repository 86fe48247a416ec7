// SPDX-License-Identifier: Apache-2.0
// The two searches of a graph's hierarchy: for the node nearest to a point, and for the first that a segment meets. In doubles,
// local frame, whatever the graph's precision.
#pragma once

#include "graph/graph_view.hpp"

namespace fdcg {

using QueryPoint = Vec3<double>;

// Where a search has come to. `state` FDCG_FREE: nothing yet.
struct NearestPlace {
  double distance2;
  QueryPoint point;
  uint32_t state, feature, node;
};

// The first node that a segment meets.
struct FirstMeeting {
  double fraction;
  uint32_t node;  // FDCG_NONE: none
  int from_side;  // of the segment's start: 1 in front, -1 behind, 0 on the plane
};

template <class Real>
void find_nearest(const RigidView<Real>& graph, QueryPoint at, NearestPlace* best);
template <class Real>
FirstMeeting find_first(const RigidView<Real>& graph, QueryPoint from, QueryPoint to);

// signed_distance.cpp: 1 in front of the nearest place, -1 behind, 0 on it.
template <class Real>
int side_of_nearest(const RigidView<Real>& graph, QueryPoint at, const NearestPlace& nearest);

// From metres in the object's frame. False: not usable.
inline bool to_local_place(const fdcg_header& header, const double object_m[3], QueryPoint* local) {
  constexpr double kFarthestExtents = 1e60;
  for (int k = 0; k < 3; ++k) {
    if (!(absolute(object_m[k]) <= 1e110)) return false;
  }
  const double unit_m = header.metres_per_unit;
  *local = QueryPoint{object_m[0] / unit_m, object_m[1] / unit_m, object_m[2] / unit_m} - vec(header.origin);
  const double farthest = smaller(kFarthestExtents * header.extent, RealLimits<double>::kFar / 4);
  return norm1(*local) <= farthest;
}

template <class Real>
inline QueryPoint corner_place(const RigidView<Real>& graph, uint32_t corner) {
  return widen(graph.corner_point(corner));
}

// The distance from a node's plane, from a corner that is near, so that few digits are lost.
template <class Real>
inline double plane_distance(const RigidView<Real>& graph, NodeRef<RigidGeometry<Real>> node, QueryPoint at) {
  return dot(widen(node.normal()), at - corner_place(graph, node.corner(0)));
}

// Its exact sign, of a node whose corners lie in its plane; else that of the distance.
template <class Real>
inline int plane_sign(const RigidView<Real>& graph, NodeRef<RigidGeometry<Real>> node, QueryPoint at) {
  const double distance = plane_distance(graph, node, at);
  const double bound = 8 * static_cast<double>(RealLimits<Real>::kEpsilon) * (norm1(at) + 2 * graph.header()->extent);
  if (absolute(distance) > bound || node.is_inexact()) return distance > 0 ? 1 : distance < 0 ? -1 : 0;
  return orient3d_sign(corner_place(graph, node.corner(0)), corner_place(graph, node.corner(1)),
                       corner_place(graph, node.corner(2)), at);
}

// The outward normal at a feature: FDCG_EDGE's is the direction of its faces' sum.
QueryPoint normal_at(const fdcg_graph& graph, uint32_t state, uint32_t feature);

}  // namespace fdcg
