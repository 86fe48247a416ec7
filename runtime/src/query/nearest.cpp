// SPDX-License-Identifier: Apache-2.0
// The nearest place of a graph's surface. A node's part is found by the planes of its record: inside all of its Voronoi planes
// it is the foot on the node's plane, else it is on one of the sides whose plane has the point in front.
#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "fdcg/query.h"
#include "graph/tolerances.hpp"
#include "query/surface_search.hpp"

namespace fdcg {
namespace {

template <class Real>
class NearestSearch {
  using View = RigidView<Real>;
  using Node = NodeRef<RigidGeometry<Real>>;

 public:
  NearestSearch(const View& graph, QueryPoint at, NearestPlace* best)
      : graph_(graph),
        at_(at),
        best_(*best),
        slack_(graph.header()->max_deviation),
        per_unit_(1 / tree_unit(graph.header()->extent)),
        pad_(2 * tree_rounding<double>(norm1(at) * per_unit_, norm1(at) * per_unit_ * RealLimits<double>::kEpsilon)) {}

  void run() {
    if (graph_.hierarchy() == nullptr) {
      for (uint32_t n = 0; n < graph_.header()->node_count; ++n)
        look_at_node(graph_.node(n), n);
      return;
    }
    const QueryPoint scaled = at_ * per_unit_;
    const float point[3] = {static_cast<float>(scaled.x), static_cast<float>(scaled.y), static_cast<float>(scaled.z)};
    const BoxTree tree(graph_.header()->node_count);
    WaitingBoxes waiting(tree);
    narrow_limit();
    while (!waiting.is_empty()) {
      const WaitingBoxes::Item next = waiting.pop();
      if (next.key > limit2_) continue;
      if (next.level < 0) {
        look_at_leaf(next.index);
        continue;
      }
      float distance2[FDCG_TREE_WAYS];
      const fdcg_box8& boxes = graph_.hierarchy()[tree.first[next.level] + next.index];
      const uint32_t near = squared_distances(boxes, point, limit2_, distance2) & tree.lanes(next.level, next.index);
      waiting.push(next, near, distance2);
    }
  }

 private:
  // What is farther, in tree units squared, is not looked at.
  void narrow_limit() {
    const double reach = root(best_.distance2) * per_unit_ + pad_;
    limit2_ = static_cast<float>(smaller(reach * reach * (1 + 0x1p-20), 1e30));
  }

  void look_at_leaf(uint32_t leaf) {
    const uint32_t first = leaf * FDCG_LEAF_NODES, left = graph_.header()->node_count - first;
    const uint32_t count = left < FDCG_LEAF_NODES ? left : FDCG_LEAF_NODES;
    for (uint32_t n = first; n < first + count; ++n)
      look_at_node(graph_.node(n), n);
  }

  void look_at_node(const Node& node, uint32_t index) {
    const double from_plane = plane_distance(graph_, node, at_);
    const double slack = node.is_inexact() ? slack_ : 0;
    const double nearer = absolute(from_plane) - slack;
    if (nearer > 0 && nearer * nearer >= best_.distance2) return;
    double farthest_beside = 0;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      const double beside = beyond(node, k);
      if (beside > farthest_beside) farthest_beside = beside;
    }
    if (!(farthest_beside > 0)) {
      take(from_plane * from_plane, at_ - widen(node.normal()) * from_plane, FDCG_FACE, index, index);
      return;
    }
    if (nearer > 0 && farthest_beside > slack) {
      const double beside = (farthest_beside - slack) * (1 - 0x1p-20);
      if (nearer * nearer + beside * beside >= best_.distance2 * (1 + 0x1p-40)) return;
    }
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (beyond(node, k) > 0) look_at_side(node, k, index);
    }
  }

  double beyond(const Node& node, uint32_t k) const {
    return dot(widen(node.voronoi_plane(k).normal), at_ - corner_place(graph_, node.corner(k)));
  }

  void look_at_side(const Node& node, uint32_t k, uint32_t index) {
    const uint32_t ends[2] = {node.corner(k), node.corner(node.next(k))};
    const QueryPoint a = corner_place(graph_, ends[0]), along = corner_place(graph_, ends[1]) - a, from_a = at_ - a;
    const double length2 = dot(along, along), way = dot(from_a, along);
    if (way > 0 && way < length2) {
      const QueryPoint foot = a + along * (way / length2), gap = at_ - foot;
      take(dot(gap, gap), foot, FDCG_EDGE, node.connection(k), index);
      return;
    }
    const uint32_t end = way > 0 ? 1 : 0;
    const QueryPoint corner = corner_place(graph_, ends[end]), gap = at_ - corner;
    take(dot(gap, gap), corner, FDCG_VERTEX, ends[end], index);
  }

  void take(double distance2, QueryPoint point, uint32_t state, uint32_t feature, uint32_t node) {
    if (!(distance2 < best_.distance2)) return;
    best_ = {distance2, point, state, feature, node};
    if (graph_.hierarchy() != nullptr) narrow_limit();
  }

  const View& graph_;
  QueryPoint at_;
  NearestPlace& best_;
  double slack_, per_unit_, pad_;
  float limit2_ = 0;
};

}  // namespace

template <class Real>
void find_nearest(const RigidView<Real>& graph, QueryPoint at, NearestPlace* best) {
  NearestSearch<Real>(graph, at, best).run();
}

namespace {

fdcg_status search_nearest(const fdcg_graph* graph, const double point_object_m[3], double reach_m, NearestPlace* found,
                           int* side, fdcg_error* error) {
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (point_object_m == nullptr) return refuse(error, "point_object_m: null pointer");
  if (!(reach_m >= 0)) return refuse(error, "reach_m: below 0, or not a number");
  QueryPoint at;
  if (!to_local_place(*graph->header, point_object_m, &at))
    return refuse(error, "point_object_m: not finite, or farther than 1e60 times the object's size");
  constexpr double kFarthest = 1e150;
  const double reach = smaller(reach_m / graph->header->metres_per_unit, kFarthest);
  *found = {reach * reach * (1 + RealLimits<double>::kEpsilon), {0, 0, 0}, FDCG_FREE, FDCG_NONE, FDCG_NONE};
  with_real_of(*graph->header, [&](auto real) {
    const RigidView<decltype(real)> view(*graph);
    find_nearest(view, at, found);
    if (found->state != FDCG_FREE) *side = side_of_nearest(view, at, *found);
  });
  if (found->state == FDCG_FREE) return refuse(error, FDCG_E_ABSENT, "no place of the surface is within reach_m");
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_surface_hit_init(fdcg_surface_hit* hit, uint32_t struct_bytes) {
  fdcg::fill_defaults(hit, fdcg_surface_hit{}, struct_bytes);
}

extern "C" fdcg_status fdcg_find_nearest(const fdcg_graph* graph, const double point_object_m[3], double reach_m,
                                         fdcg_surface_hit* hit, fdcg_error* error) {
  using namespace fdcg;
  if (hit == nullptr) return refuse(error, "hit: null pointer");
  fdcg_status status = check_struct_bytes(hit->struct_bytes, sizeof *hit, "hit", "; start from fdcg_make_surface_hit()", error);
  NearestPlace found;
  int side = 0;
  if (status == FDCG_OK) status = search_nearest(graph, point_object_m, reach_m, &found, &side, error);
  if (status != FDCG_OK) return status;
  fdcg_surface_hit full = {};
  full.state = found.state;
  full.feature = found.feature;
  full.node = found.node;
  full.side = side;
  store((found.point + vec(graph->header->origin)) * graph->header->metres_per_unit, full.point_m);
  store(normal_at(*graph, found.state, found.feature), full.normal);
  full.distance_m = root(found.distance2) * graph->header->metres_per_unit;
  fill_defaults(hit, full, hit->struct_bytes);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_get_signed_distance(const fdcg_graph* graph, const double point_object_m[3], double* distance_m,
                                                fdcg_error* error) {
  using namespace fdcg;
  if (distance_m == nullptr) return refuse(error, "distance_m: null pointer");
  NearestPlace found;
  int side = 0;
  const fdcg_status status = search_nearest(graph, point_object_m, HUGE_VAL, &found, &side, error);
  if (status == FDCG_OK) *distance_m = root(found.distance2) * graph->header->metres_per_unit * (side < 0 ? -1 : 1);
  return status;
}

extern "C" fdcg_status fdcg_is_inside(const fdcg_graph* graph, const double point_object_m[3], int32_t* is_inside,
                                      fdcg_error* error) {
  using namespace fdcg;
  if (is_inside == nullptr) return refuse(error, "is_inside: null pointer");
  NearestPlace found;
  int side = 0;
  const fdcg_status status = search_nearest(graph, point_object_m, HUGE_VAL, &found, &side, error);
  if (status == FDCG_OK) *is_inside = side < 0 ? 1 : 0;
  return status;
}
