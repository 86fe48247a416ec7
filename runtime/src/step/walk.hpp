// SPDX-License-Identifier: Apache-2.0
// The state of one contact within one step, and the moves that the rules share. face.hpp, edge.hpp, corner.hpp hold the rules
// contact-model FACE-1 to FACE-6, EDGE-1 to EDGE-7, CORNER-1 to CORNER-7, free_space.hpp and sweep.hpp those of free space;
// rules_loop.hpp drives them.
#pragma once

#include "base/mutation.hpp"
#include "base/work.hpp"
#include "graph/graph_view.hpp"
#include "step/friction.hpp"

// Of functions that stay apart from their callers; but a library built for size has one way for all.
#ifdef __OPTIMIZE_SIZE__
#define FDCG_OUTLINED inline
#else
#define FDCG_OUTLINED [[gnu::noinline]]
#endif

namespace fdcg {
// Where the god-object is: free, or on a node, a connection or a corner.
struct Feature {
  uint32_t state = FDCG_FREE;  // fdcg_state
  uint32_t index = FDCG_NONE;

  [[nodiscard]] bool is_free() const { return state == FDCG_FREE; }
  friend bool operator==(Feature a, Feature b) { return a.state == b.state && a.index == b.index; }
};
inline constexpr Feature kFree = {};

template <class Geometry>
struct Walk {
  using Real = typename Geometry::Real;

  // Number by number (by_parts); what is not given here has its value below.
  FDCG_OUTLINED Walk(const GraphView<Geometry>& in, const PlainFriction<Real>& laws, FrictionTerms* terms, const Vec3<Real>& to,
                     Real to_bound, const Vec3<Real>& from, Feature on, Feature sits, uint32_t work)
      : graph(in), hip(by_parts(to)), hip_bound(to_bound), god_object(by_parts(from)), active(on), seat(sits), work_left(work) {
    friction.mu_static = laws.mu_static;
    friction.mu_dynamic = laws.mu_dynamic;
    friction.has_wedge = laws.has_wedge;
    friction.is_slipping = laws.is_slipping;
    friction.terms = terms;
  }

  GraphView<Geometry> graph;
  Friction<Real> friction;
  Vec3<Real> hip;
  Real hip_bound;  // plane_rounding_bound of hip
  Vec3<Real> god_object;
  Feature active;
  Feature seat;              // the edge or vertex on which the god-object was last placed and still is; kFree: none
  uint32_t work_left;        // for the rules, see work.hpp
  uint32_t rim = FDCG_NONE;  // the connection on which the god-object was last placed in this step

  [[nodiscard, gnu::noinline, gnu::hot]] Real side(NodeRef<Geometry> node) {
    return side_of(graph, node, hip, hip_bound, &work_left);
  }
  // From the HIP to the god-object.
  [[nodiscard]] FDCG_ONE_COPY Vec3<Real> gap() const { return god_object - hip; }
  void spend(uint32_t units) { fdcg::spend(&work_left, units); }

  // A move on a face's inside or along an edge.
  void place(Vec3<Real> point, Feature new_seat) {
    god_object = point;
    seat = new_seat;
  }
};

// The foot of a place on a node's plane.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<Real> foot_on(NodeRef<Geometry> node, const Vec3<Real>& x) {
  return x - node.normal() * distance_from(node, x);
}

// What a step did besides moving the god-object (contact-model RESP-3).
struct Progress {
  uint32_t transitions;  // changes of state
  uint32_t flags;        // fdcg_result_flag: what was cut short
};

// What a rule decides: stay (rest), or go on at another feature. One word, which is returned in registers: of parts written one
// by one the caller would wait for the whole.
enum class Decision : uint64_t {
  rest = ~uint64_t{0},  // no state has such a number
};
inline Decision rest() {
  return Decision::rest;
}
inline Decision go_to(Feature next) {
  return Decision{uint64_t{next.index} << 32 | next.state};
}
inline Feature next_of(Decision decision) {
  const auto word = static_cast<uint64_t>(decision);
  return {static_cast<uint32_t>(word), static_cast<uint32_t>(word >> 32)};
}

// A connection's line, and how near to an end the vertex is meant (contact-model FACE-6).
template <class Real>
struct EdgeLine : Edge<Real> {
  Real end_tolerance;

  // `where`: a connection, or a node and a side of it.
  template <class Geometry, class... Where>
  explicit EdgeLine(const GraphView<Geometry>& graph, Where... where) {
    graph.read_edge(where..., this);
    end_tolerance = end_rounding(Real(graph.header()->extent));
  }

  [[nodiscard]] FDCG_HOT Real parameter(const Vec3<Real>& x) const { return dot(x - this->start, this->direction); }
};

// How far a place is past the nearer end of a side, less that end's tolerance times `share`; negative between the ends.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Real past_ends(NodeRef<Geometry> node, uint32_t k, const Vec3<Real>& x, Real share) {
  const EdgeLine<Real> line(node.graph(), node, k);
  const Real u = line.parameter(x), past = u - line.length;
  return (-u > past ? -u : past) - share * line.end_tolerance;
}

// Whether a place is between the ends of a side, up to rounding.
template <class Geometry, class Real = typename Geometry::Real>
inline bool is_between_ends(NodeRef<Geometry> node, uint32_t k, const Vec3<Real>& x) {
  return past_ends(node, k, x, Real(1)) <= 0;
}

// Places the god-object at u on a connection: on a corner at, past or within rounding of an end: walk.seat says which.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void place_on_edge(Walk<Geometry>& walk, uint32_t connection_index, const EdgeLine<Real>& line,
                                                Real u) {
  walk.rim = connection_index;
  Vec3<Real> point = line.start + line.direction * u;
  Feature on = {FDCG_EDGE, connection_index};
  for (uint32_t end = 0; end < 2; ++end) {
    const Real from_end = end == 0 ? u : line.length - u;
    if (FDCG_MUTANT("lands-on-vertex") ? !(from_end < 0) : !(from_end <= line.end_tolerance)) continue;
    const uint32_t at = FDCG_MUTANT("corners-swapped") ? 1 - end : end;
    on = {FDCG_VERTEX, walk.graph.connection(connection_index).corner(at)};
    point = walk.graph.corner_point(on.index);
    break;
  }
  walk.place(point, on);
}

}  // namespace fdcg
