// SPDX-License-Identifier: Apache-2.0
// Which side of the nearest place a point is on: of a face by an exact sign; of an edge by the sum of its faces' normals; of a
// vertex by its faces where they agree. Where they do not, as at saddles, by what the way to one of them meets first.
#include "base/config.hpp"
#include "fdcg/fdcg.h"
#include "query/surface_search.hpp"

namespace fdcg {
namespace {

template <class Real>
int side_of_edge(const RigidView<Real>& graph, QueryPoint gap, uint32_t connection) {
  QueryPoint sum = {0, 0, 0};
  for (uint32_t k = 0; k < 2; ++k) {
    const uint32_t n = graph.connection(connection).node(k);
    if (n != FDCG_NONE) sum = sum + widen(graph.node(n).normal());
  }
  const double above = dot(sum, gap);
  return above > 0 ? 1 : above < 0 ? -1 : 0;
}

template <class Real>
int side_by_way(const RigidView<Real>& graph, QueryPoint at, uint32_t node) {
  const NodeRef<RigidGeometry<Real>> face = graph.node(node);
  QueryPoint middle = {0, 0, 0};
  for (uint32_t k = 0; k < face.side_count(); ++k)
    middle = middle + corner_place(graph, face.corner(k)) * (1.0 / face.side_count());
  // A little beyond: the face itself is met at the latest.
  const FirstMeeting met = find_first(graph, at, at + (middle - at) * (1 + 0x1p-20));
  return met.node == FDCG_NONE ? plane_sign(graph, face, at) : met.from_side;
}

template <class Real>
int side_of_vertex(const RigidView<Real>& graph, QueryPoint at, QueryPoint gap, uint32_t corner) {
  bool is_before_one = false, is_behind_one = false;
  double farthest = -1;
  uint32_t node = FDCG_NONE;
  graph.for_each_in_fan(graph.corner(corner), [&](const FanEntry& entry) {
    if (entry.node == FDCG_NONE) return;
    const double above = dot(widen(graph.node(entry.node).normal()), gap);
    is_before_one |= above > 0;
    is_behind_one |= above < 0;
    if (absolute(above) > farthest) farthest = absolute(above), node = entry.node;
  });
  if (is_before_one != is_behind_one) return is_before_one ? 1 : -1;
  return is_before_one ? side_by_way(graph, at, node) : 0;
}

}  // namespace

template <class Real>
int side_of_nearest(const RigidView<Real>& graph, QueryPoint at, const NearestPlace& nearest) {
  if (nearest.state == FDCG_FACE) return plane_sign(graph, graph.node(nearest.feature), at);
  const QueryPoint gap = at - nearest.point;
  if (nearest.state == FDCG_EDGE) return side_of_edge(graph, gap, nearest.feature);
  return side_of_vertex(graph, at, gap, nearest.feature);
}

#if FDCG_WITH_F64
template int side_of_nearest<double>(const RigidView<double>&, QueryPoint, const NearestPlace&);
#endif
#if FDCG_WITH_F32
template int side_of_nearest<float>(const RigidView<float>&, QueryPoint, const NearestPlace&);
#endif

}  // namespace fdcg
