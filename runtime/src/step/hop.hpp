// SPDX-License-Identifier: Apache-2.0
// A tick that slides over edges from face to face, or onto an edge that keeps it: what a moving hand meets most, also where it
// has just landed. The same numbers, to the bit, as the rules of face.hpp and edge.hpp one after the other, without what serves
// other ends of theirs. Whatever is not plain is left to them, from where the hops end: corners, borders, doubtful signs, two
// faces that both pull, a place that is no nearer to the HIP, friction that holds. Graphs that are not plain have no hops.
#pragma once

#include "step/along_edge.hpp"
#include "step/face.hpp"

namespace fdcg {

// Not on a mesh whose corners move, where work is counted as numbers are renewed, nor where a test takes rules out; and a
// library built for size does without.
#if defined(__OPTIMIZE_SIZE__) || FDCG_WITH_MUTANTS == 1 || !FDCG_WITH_FAST_FACES
template <class Geometry>
inline constexpr bool kHasHops = false;
#else
template <class Geometry>
inline constexpr bool kHasHops = Geometry::kKeepsDirections;
#endif
// The same for ticks that begin on an edge or end there, and for those that land on a face.
template <class Geometry>
inline constexpr bool kHasEdgeHops = FDCG_WITH_FAST_EDGES&& kHasHops<Geometry>;

// From face to edge to face: a change of state, the edge's rule, a change of state.
inline constexpr uint32_t kHopWork = 2 * kTransitionWork + kEdgeWork;

// A god-object on its way over faces.
template <class Real>
struct Hop {
  uint32_t node;
  uint32_t prefetched;   // the node around which all has been prefetched
  uint32_t edge;         // the last that it went over
  uint32_t transitions;  // 0: none yet
  bool is_on_edge;       // where it stays
  uint32_t work_left;    // as the rules would have it
  Real side;             // of the HIP, from the node
  Real gap2;             // squared distance from the HIP
  Vec3<Real> god_object;
  QuickFriction<Real> friction;
  FaceMove<Real> move;  // on the node
};

// Whether an edge that it has come to keeps the god-object; else nothing has changed.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] bool stops_on_edge(const GraphView<Geometry>& graph, const Vec3<Real>& hip, uint32_t edge,
                                     const Vec3<Real>& god_object, Hop<Real>* hop) {
  AlongEdge<Real> along;
  along.friction = hop->friction;
  along.god_object = by_parts(god_object);
  if (look_along_edge(graph, edge, hip, &along) != OnEdge::stays) return false;
  hop->god_object = by_parts(along.god_object);
  hop->friction = {along.friction};
  hop->edge = edge;
  hop->is_on_edge = true;
  ++hop->transitions;
  return true;
}

// Prefetches what a second crossing of this tick would read, before it is sure that there is a first; unless it `has_been`.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT void prefetch_ahead(const GraphView<Geometry>& graph, NodeRef<Geometry> node, const FaceGlance<Real>& glance,
                             bool has_been, Hop<Real>* hop) {
  hop->prefetched = FDCG_NONE;
  if (glance.kind != FaceMoveKind::nears || !graph.is_plain()) return;
  const uint32_t across = node.side(glance.near_side).across;
  if (across == FDCG_NONE) return;
  if (!has_been) graph.prefetch_neighbours_of(across);
  hop->prefetched = across;
}

// Puts the place where a move crosses a side onto the edge, as place_on_rim() does. False: at or past one of its ends.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool goes_onto_edge(const GraphView<Geometry>& graph, NodeRef<Geometry> node, uint32_t side,
                                                 Vec3<Real>* place) {
  const EdgeLine<Real> line(graph, node, side);
  const Real u = line.parameter(*place);
  if (!(u > line.end_tolerance && line.length - u > line.end_tolerance)) return false;
  *place = line.start + line.direction * u;
  return true;
}

// Goes over the side that the move on its face meets (contact-model FACE-6, EDGE-1), and stands before the face beyond. False:
// not plainly so, and nothing has changed.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT bool hop_over(const GraphView<Geometry>& graph, const Vec3<Real>& hip, Real bound, Hop<Real>* hop) {
  const NodeRef<Geometry> here = graph.node(hop->node);
  const uint32_t k = hop->move.crossing.local_side;
  const fdcg_side& crossed = here.side(k);
  if (crossed.across == FDCG_NONE) return false;
  const NodeRef<Geometry> there = graph.node(crossed.across);
  if (crossed.across != hop->prefetched) graph.prefetch_neighbours_of(crossed.across);
  const Real side = there.plane().distance(hip);
  const uint32_t back = there.side_of_link(crossed.link ^ 1u);
  if (back >= there.side_count()) return false;
  const bool goes_over =
      (side < -bound && there.stored_plane(back).distance(hip) < 0 && here.stored_plane(k).distance(hip) >= 0) ||
      FDCG_MUTANT("hops-anywhere");
  if (!FDCG_WITH_FAST_EDGES && !goes_over) return false;
  if (!goes_over) graph.prefetch_edge(here, k);
  Vec3<Real> god_object = where_it_crosses(hop->god_object, hop->move);
  if (!goes_onto_side<true>(hip, here, k, &god_object)) {
    Vec3<Real> on_edge = by_parts(god_object);  // of its own, so that the place above stays in registers
    if (!goes_onto_edge(graph, here, k, &on_edge)) return false;
    god_object = by_parts(on_edge);
  }
  const Vec3<Real> gap = god_object - hip;
  const Real gap2 = dot(gap, gap);
  if (!(gap2 < hop->gap2)) return false;
  if (!goes_over) return FDCG_WITH_FAST_EDGES && stops_on_edge(graph, hip, crossed.link >> 1, by_parts(god_object), hop);
  hop->god_object = by_parts(FDCG_MUTANT("hop-stays") ? hop->god_object : god_object);
  hop->gap2 = gap2;
  hop->node = FDCG_MUTANT("hop-keeps-face") ? hop->node : crossed.across;
  hop->edge = crossed.link >> 1;
  hop->transitions += 2;
  hop->side = side;
  spend(&hop->work_left, kHopWork + kSideWork * there.side_count());
  return true;
}

// From the face of *hop, where it `has_move` or is to make one, as far as it is plain: to where a move ends on its face, to an
// edge that keeps it, or to where the rules go on.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] void hop_to_hip(const GraphView<Geometry>& graph, const Vec3<Real>& hip, Real bound, bool has_move,
                                  Hop<Real>* hop) {
  using Kind = typename FaceMove<Real>::Kind;
  if (!graph.is_plain()) return;
  const Vec3<Real> begin = hop->god_object - hip;
  hop->gap2 = dot(begin, begin);
  for (;; has_move = false) {
    if (!has_move) {
      const Vec3<Real> gap = hop->god_object - hip;
      hop->move =
          move_on_face<true>(graph.node(hop->node), hop->friction, hip, bound, hop->side, by_parts(hop->god_object), gap);
    }
    if (hop->move.kind != Kind::crosses || hop->work_left <= kHopWork) return;
    if (!hop_over(graph, hip, bound, hop) || hop->is_on_edge) return;
  }
}

// A god-object that a sweep has put on a face goes on from there as one that a tick finds there. True: what is left to carry
// out is *move, on the face that it stands on then; nothing where that is on an edge. False: not plainly so, and nothing has
// changed.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool hop_on(Walk<Geometry>& walk, uint32_t* transitions, FaceMove<Real>* move) {
  const NodeRef<Geometry> node = walk.graph.node(walk.active.index);
  Hop<Real> hop;
  hop.side = distance_from(node, walk.hip);
  if (!walk.graph.is_plain() || !(hop.side < -walk.hip_bound)) return false;
  walk.spend(kSideWork * node.side_count());
  hop.node = walk.active.index;
  hop.prefetched = FDCG_NONE;
  hop.transitions = 0;
  hop.is_on_edge = false;
  hop.work_left = walk.work_left;
  hop.god_object = walk.god_object;
  hop.friction = {walk.friction};
  hop_to_hip(walk.graph, walk.hip, walk.hip_bound, false, &hop);
  walk.friction.is_slipping = hop.friction.is_slipping;
  walk.work_left = hop.work_left;
  *transitions = hop.transitions;
  if (hop.transitions != 0) {
    walk.place(hop.god_object, {FDCG_EDGE, hop.edge});
    walk.active = hop.is_on_edge ? walk.seat : Feature{FDCG_FACE, hop.node};
  }
  *move = {hop.move.kind, by_parts(hop.move.target), hop.move.crossing};
  return true;
}

}  // namespace fdcg
