// SPDX-License-Identifier: Apache-2.0
// What a segment meets first. Every edge is judged by one exact sign, whichever face asks, so no ray slips between two faces; a
// face of more than three sides is a fan of triangles from its first corner.
#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "fdcg/query.h"
#include "graph/tolerances.hpp"
#include "query/surface_search.hpp"

namespace fdcg {
namespace {

template <class Real>
class RaySearch {
  using View = RigidView<Real>;
  using Node = NodeRef<RigidGeometry<Real>>;

 public:
  RaySearch(const View& graph, QueryPoint from, QueryPoint to)
      : graph_(graph),
        from_(from),
        to_(to),
        bound_(8 * static_cast<double>(RealLimits<Real>::kEpsilon) *
                   (larger(norm1(from), norm1(to)) + 2 * graph.header()->extent) +
               graph.header()->max_deviation) {}

  FirstMeeting run() {
    if (graph_.hierarchy() == nullptr) {
      for (uint32_t n = 0; n < graph_.header()->node_count; ++n)
        look_at_node(n);
      return best_;
    }
    if (!enter_tree()) return best_;
    const BoxTree tree(graph_.header()->node_count);
    WaitingBoxes waiting(tree);
    while (!waiting.is_empty()) {
      const WaitingBoxes::Item next = waiting.pop();
      const float limit = limit_in_tree();
      if (next.key > limit) continue;
      if (next.level < 0) {
        look_at_leaf(next.index);
        continue;
      }
      float entry[FDCG_TREE_WAYS];
      const uint32_t touched = touched_boxes(graph_.hierarchy()[tree.first[next.level] + next.index], way_, limit, entry);
      waiting.push(next, touched & tree.lanes(next.level, next.index), entry);
    }
    return best_;
  }

 private:
  // Puts the segment into tree units, cut to its part near the tree. False: it passes by.
  bool enter_tree() {
    constexpr double kNear = 16;
    const double per_unit = 1 / tree_unit(graph_.header()->extent);
    const QueryPoint from = from_ * per_unit, to = to_ * per_unit, along = to - from;
    const double size = norm1(from) + norm1(to);
    if (!(size > kNear)) {
      tree_way({static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
               {static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z)},
               static_cast<float>(tree_rounding(size, size * RealLimits<double>::kEpsilon)), &way_);
      return true;
    }
    double end = 1;
    if (!cut_tree_way(from, to, &way_, &begin_, &end)) return false;
    per_part_ = 1 / (end - begin_);
    return true;
  }

  // As far as a box is of interest, as a fraction of the part near the tree.
  [[nodiscard]] float limit_in_tree() const {
    const double part = (best_.fraction - begin_) * per_part_ * (1 + 0x1p-20) + 0x1p-20;
    return part < 1 ? static_cast<float>(part) : 1.0F;
  }

  void look_at_leaf(uint32_t leaf) {
    const uint32_t first = leaf * FDCG_LEAF_NODES, left = graph_.header()->node_count - first;
    const uint32_t count = left < FDCG_LEAF_NODES ? left : FDCG_LEAF_NODES;
    for (uint32_t n = first; n < first + count; ++n)
      look_at_node(n);
  }

  void look_at_node(uint32_t index) {
    const Node node = graph_.node(index);
    const double from = plane_distance(graph_, node, from_), to = plane_distance(graph_, node, to_);
    if ((from > bound_ && to > bound_) || (from < -bound_ && to < -bound_)) return;
    const QueryPoint hub = corner_place(graph_, node.corner(0));
    QueryPoint last = corner_place(graph_, node.corner(1));
    int hub_sign = orient3d_sign(from_, to_, hub, last);
    for (uint32_t k = 2; k < node.side_count(); ++k) {
      const QueryPoint next = corner_place(graph_, node.corner(k));
      const int side_sign = orient3d_sign(from_, to_, last, next), back_sign = orient3d_sign(from_, to_, next, hub);
      look_at_triangle({hub, last, next}, {hub_sign, side_sign, back_sign}, index, from, to);
      hub_sign = -back_sign;
      last = next;
    }
  }

  struct Corners {
    QueryPoint a, b, c;
  };
  struct Signs {
    int ab, bc, ca;
  };

  // Met where the line passes all three sides on one side, and the ends are not both on one side of the plane.
  void look_at_triangle(const Corners& at, const Signs& sign, uint32_t index, double from, double to) {
    const bool is_left = sign.ab >= 0 && sign.bc >= 0 && sign.ca >= 0, is_right = sign.ab <= 0 && sign.bc <= 0 && sign.ca <= 0;
    if (is_left == is_right) return;  // beside it, or in its plane
    const int from_sign = orient3d_sign(at.a, at.b, at.c, from_), to_sign = orient3d_sign(at.a, at.b, at.c, to_);
    if (from_sign * to_sign > 0 || (from_sign == 0 && to_sign == 0)) return;
    double fraction = from_sign == 0 ? 0 : to_sign == 0 ? 1 : from / (from - to);
    if (!(fraction > 0)) fraction = 0;
    if (fraction > 1) fraction = 1;
    if (best_.node != FDCG_NONE && !(fraction < best_.fraction)) return;
    best_ = {fraction, index, from_sign};
  }

  const View& graph_;
  QueryPoint from_, to_;
  double bound_;
  TreeWay way_ = {};
  double begin_ = 0, per_part_ = 1;  // of the segment: what way_ covers
  FirstMeeting best_ = {1, FDCG_NONE, 0};
};

}  // namespace

template <class Real>
FirstMeeting find_first(const RigidView<Real>& graph, QueryPoint from, QueryPoint to) {
  return RaySearch<Real>(graph, from, to).run();
}

#if FDCG_WITH_F64
template FirstMeeting find_first<double>(const RigidView<double>&, QueryPoint, QueryPoint);
#endif
#if FDCG_WITH_F32
template FirstMeeting find_first<float>(const RigidView<float>&, QueryPoint, QueryPoint);
#endif

}  // namespace fdcg

extern "C" fdcg_status fdcg_cast_ray(const fdcg_graph* graph, const double from_object_m[3], const double direction[3],
                                     double reach_m, fdcg_surface_hit* hit, fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (from_object_m == nullptr || direction == nullptr || hit == nullptr)
    return refuse(error, "from_object_m, direction or hit: null pointer");
  if (const fdcg_status status =
          check_struct_bytes(hit->struct_bytes, sizeof *hit, "hit", "; start from fdcg_make_surface_hit()", error);
      status != FDCG_OK) {
    return status;
  }
  const fdcg_header& header = *graph->header;
  QueryPoint from;
  if (!to_local_place(header, from_object_m, &from))
    return refuse(error, "from_object_m: not finite, or farther than 1e60 times the object's size");
  const double size = larger(larger(absolute(direction[0]), absolute(direction[1])), absolute(direction[2]));
  if (!(size > 0 && size <= 1e300)) return refuse(error, "direction: zero or not finite");
  if (!(reach_m >= 0)) return refuse(error, "reach_m: below 0, or not a number");
  QueryPoint unit = QueryPoint{direction[0] / size, direction[1] / size, direction[2] / size};
  unit = unit * (1 / norm(unit));
  // Far enough to be past the object, wherever it starts.
  const double length = smaller(reach_m / header.metres_per_unit, norm1(from) + 4 * header.extent);
  const QueryPoint to = from + unit * length;
  FirstMeeting met;
  with_real_of(header, [&](auto real) { met = find_first(RigidView<decltype(real)>(*graph), from, to); });
  if (met.node == FDCG_NONE) return refuse(error, FDCG_E_ABSENT, "the ray meets nothing within reach_m");
  fdcg_surface_hit full = {};
  full.state = FDCG_FACE;
  full.feature = full.node = met.node;
  full.side = met.from_side;
  store((from + (to - from) * met.fraction + vec(header.origin)) * header.metres_per_unit, full.point_m);
  store(normal_at(*graph, FDCG_FACE, met.node), full.normal);
  full.distance_m = met.fraction * length * header.metres_per_unit;
  fill_defaults(hit, full, hit->struct_bytes);
  return FDCG_OK;
}
