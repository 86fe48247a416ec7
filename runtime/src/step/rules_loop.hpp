// SPDX-License-Identifier: Apache-2.0
// The loop over the rules of a tick, and what ends it (contact-model TICK-1, TICK-5, TICK-6, BOUND-1).
#pragma once

#include "step/corner.hpp"
#include "step/edge.hpp"
#include "step/face.hpp"
#include "step/free_space.hpp"
#include "step/leave.hpp"
#include "step/local_hip.hpp"

namespace fdcg {
namespace {

// The features visited since the god-object last came nearer to the HIP. To meet one of them again is to go round in a circle
// that only rounding can make: the step rests there (contact-model TICK-5).
template <class Geometry>
class Trail {
  using Real = typename Geometry::Real;

 public:
  Trail(Feature start, Vec3<Real> start_gap) : nearest2_(dot(start_gap, start_gap)), count_(1) { visited_[0] = key(start); }

  bool has_met_again(const Walk<Geometry>& walk) {
    const Vec3<Real> gap = walk.gap();
    const Real now2 = dot(gap, gap);
    if (now2 < nearest2_) {
      nearest2_ = now2;
      count_ = 0;
      rounds_ = 0;
      was_let_go_ = false;
    }
    return !may_visit(walk.active);
  }
  // Another feature at the same place. False: it has been visited. Of a circle of more features than fit the tick's work is the
  // end: a HIP so far away that no move on the object changes its rounded distance may be many features off.
  FDCG_ONE_COPY bool may_visit(Feature feature) {
    for (int i = 0; i < count_; ++i) {
      if (visited_[i] == key(feature)) return false;
    }
    count_ &= kCapacity - 1;  // begins anew
    visited_[count_++] = key(feature);
    return true;
  }
  // A feature has let the god-object go.
  void let_go() { was_let_go_ = true; }
  [[nodiscard]] bool was_let_go() const { return was_let_go_; }
  // Whether the circle leads through free space, past faces, and the HIP is clearly over none of them. Faces that move may have
  // been squeezed to lines, which are under nothing.
  [[nodiscard, gnu::noinline, gnu::cold]] bool passes_hip_by(const Walk<Geometry>& walk) const {
    if (!Geometry::kKeepsDirections) return false;
    bool is_beside = false;
    for (int i = 0; i < count_; ++i) {
      if (visited_[i] >> 32 != FDCG_FACE) continue;
      const NodeRef<Geometry> node = walk.graph.node(static_cast<uint32_t>(visited_[i]));
      is_beside = false;
      for (uint32_t k = 0; k < node.side_count(); ++k)
        is_beside = is_beside || distance_beyond(node, k, walk.hip) > walk.hip_bound;
      if (!is_beside) return false;
    }
    return is_beside;
  }
  // Where hops have led to the start: the edge that they went over last.
  void add(Feature edge) { visited_[count_++] = key(edge); }

  // Called where the step would rest (contact-model TICK-6). A rest must hold in the next tick, which knows nothing of the
  // features visited here: so the step continues as that tick would, unless it already did so from here; a few times for each
  // time that the god-object came nearer.
  bool begins_again(Walk<Geometry>& walk) {
    constexpr int kMostRounds = 4;
    if (rounds_ == kMostRounds || norm1(walk.god_object - begun_from_) == 0) return false;
    ++rounds_;
    begun_from_ = walk.god_object;
    was_let_go_ = false;
    visited_[0] = key(walk.active);
    count_ = 1;
    return true;
  }

 private:
  static constexpr int kCapacity = 32;  // without a move, a step climbs: vertex, edge, face are three

  static uint64_t key(Feature feature) { return uint64_t{feature.state} << 32 | feature.index; }

  Real nearest2_;
  int count_;
  bool was_let_go_ = false;  // since it came nearer, or began again
  int rounds_ = 0;           // begun again, since it came nearer; and from which place last
  Vec3<Real> begun_from_ = {RealLimits<Real>::kFar, 0, 0};
  uint64_t visited_[kCapacity];  // the first count_ are set
};

template <class Geometry>
Decision apply_rule(Walk<Geometry>& walk) {
  switch (walk.active.state) {
    case FDCG_FACE:
      return face_rule(walk);
    case FDCG_EDGE:
      return edge_rule(walk);
    default:
      return corner_rule(walk);
  }
}

// Whether the edge on which the god-object was last placed would let go a HIP that is behind and over one of its faces.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool lets_go_over_face(Walk<Geometry>& walk) {
  const ConnectionRef<Geometry> connection = walk.graph.connection(walk.rim);
  if (connection.type() == FDCG_BOUNDARY) return false;
  EdgeSides<Real> s;
  look_at_sides(walk, connection, &s);
  const bool is_over = (s.side[0] < 0 && s.voronoi[0] < 0) || (s.side[1] < 0 && s.voronoi[1] < 0);
  return is_over && lets_go(walk.graph, walk.hip_bound, connection.type(), s);
}

// Whether the god-object is, but for rounding, at an end of the edge on which it was last placed (contact-model TICK-5). It is
// then placed on the corner there.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool goes_to_corner(Walk<Geometry>& walk) {
  if (walk.rim == FDCG_NONE) return false;
  const Real near = corner_rounding(Real(walk.graph.header()->extent), Real(walk.graph.max_deviation()));
  for (uint32_t end = 0; end < 2; ++end) {
    const uint32_t corner = walk.graph.connection(walk.rim).corner(end);
    if (norm1(walk.graph.corner_point(corner) - walk.god_object) > near) continue;
    walk.place(walk.graph.corner_point(corner), {FDCG_VERTEX, corner});
    return true;
  }
  return false;
}

// contact-model TICK-5: rounding hands the god-object around a corner. The corner, whose rule is exact, decides if it has not
// been asked; whatever the way here was, or the next tick, which knows nothing of it, would decide otherwise. If it has, and
// a face there has sent the god-object back, the edge is asked by which the face did so: at the tip of a long body the corner's
// edges lead as far but for rounding, and so edge by edge the one is reached that holds. An edge is not asked that would let
// go a HIP behind and over one of its faces: the corner has found that it is inside. False: neither is left.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool goes_on_at_corner(Walk<Geometry>& walk, Trail<Geometry>* trail) {
  if (FDCG_MUTANT("circle-at-corner") || !goes_to_corner(walk)) return false;
  Feature next = walk.seat;
  if (!trail->may_visit(next)) {
    next = {FDCG_EDGE, walk.rim};
    if (!trail->may_visit(next) || lets_go_over_face(walk)) return false;
  }
  walk.active = next;
  return true;
}

// From the HIP to the god-object as the tick found it, before any hops.
template <class Geometry, class Real = typename Geometry::Real>
inline Vec3<Real> gap_begun(const Walk<Geometry>& walk, const FreeSpace& space) {
  return narrow<Real>(space.begun->god_object) - walk.hip;
}
template <class Real>
inline bool is_shorter(const Vec3<Real>& a, const Vec3<Real>& b) {
  return dot(a, a) < dot(b, b);
}

// Whether a HIP among merged faces is told to be outside, as FREE-9 tells it: what lets go may hold again by rounding alone.
template <class Geometry, class Real = typename Geometry::Real>
inline bool is_told_outside(const Walk<Geometry>& walk, FreeSpace* space) {
  if constexpr (Geometry::kKeepsDirections) {
    const GraphView<Geometry>& graph = walk.graph;
    if (!graph.has_inexact_nodes() || graph.header()->connection_type_count[FDCG_BOUNDARY] != 0) return false;
    return !has_come_in<Geometry, Real>(graph, nullptr, walk.hip, walk.hip, &space->missed_work_left) &&
           space->missed_work_left > 0;
  } else {
    return false;
  }
}

template <class Geometry>
FDCG_OUTLINED void let_go_to_hip(Walk<Geometry>& walk) {
  walk.place(walk.hip, kFree);
  walk.active = kFree;
}

// Drives the rules until one rests, from where the contact stands (`decision` null) or from what its feature's rule has already
// decided. It stood on `start` then, `start_gap` away from the HIP; `hopped`: the edge over which hops led there, or kFree.
template <class Geometry, class Real = typename Geometry::Real>
Progress move_god_object(Walk<Geometry>& walk, Feature start, Vec3<Real> start_gap, Feature hopped, const Decision* decided,
                         FreeSpace* space) {
  Progress progress = {0, 0};
  Trail<Geometry> trail(start, start_gap);
  if (!hopped.is_free()) trail.add(hopped);
  bool is_first_let_go = true;  // of this tick
  while (true) {
    const Feature at = walk.active;
    const Decision decision = decided != nullptr ? *decided : apply_rule(walk);
    decided = nullptr;
    if (decision == rest()) return progress;
    walk.active = next_of(decision);
    ++progress.transitions;
    if (FDCG_MUTANT("walk-cut") && progress.transitions > 3) return progress;
    if (walk.active.state == FDCG_FACE) walk.graph.prefetch_around(walk.graph.node(walk.active.index));
    if (walk.active.is_free()) {
      const bool can_wait = FDCG_WITH_BUSY_CORNERS && walk.work_left < kRuleWork / 2 &&
                            ((is_first_let_go && !(at == start)) || is_shorter(walk.gap(), gap_begun(walk, *space)));
      is_first_let_go = false;
      trail.let_go();
      const Vec3<Real> stood = walk.god_object;
      const Feature seat = walk.seat;
      step_clear_of(walk, at);
      progress.flags |= sweep_to_hip(walk, at, stood, space);
      if (can_wait && progress.flags != 0) {  // contact-model BOUND-2: the next tick has more work for this sweep
        space->inner->sweep.is_carried = 0;
        walk.god_object = stood;
        walk.active = at;
        walk.seat = seat;
        progress.flags = FDCG_RESULT_TRANSITION_BOUND;
        return progress;
      }
      if (walk.active.is_free()) return progress;
      ++progress.transitions;
    }
    if (!FDCG_MUTANT("met-again") && trail.has_met_again(walk) && !goes_on_at_corner(walk, &trail) &&
        !trail.begins_again(walk)) {
      if (trail.was_let_go() && (trail.passes_hip_by(walk) || is_told_outside(walk, space))) {
        let_go_to_hip(walk);
        return progress;
      }
      // Of a face and an edge the face pulls; a shaded one pulls another way than its plane does.
      if (at.state == FDCG_FACE && walk.active.state == FDCG_EDGE && normals_of(walk, at.index) == nullptr) walk.active = at;
      return progress;
    }
    walk.spend(kTransitionWork);
    if (walk.work_left == 0) {
      // No nearer: where the tick began the next one would do the same; elsewhere, with the HIP where it was, a circle may take
      // several ticks, and a way around a fan, nearer by less than rounding, as many as pass all faces (contact-model TICK-6).
      // There the god-object moves, even where the HIP is so far away that the gap does not.
      constexpr uint32_t kMostStalledTicks = 3, kFacesATick = 8;
      const double* const last = space->begun->hip;
      const bool is_held = last[0] == walk.hip.x && last[1] == walk.hip.y && last[2] == walk.hip.z;
      const bool is_at_start = walk.active == start;
      const Vec3<Real> begun = narrow<Real>(space->begun->god_object);
      uint32_t most = kMostStalledTicks;
      if (norm1(walk.god_object - begun) > 0) most += walk.graph.header()->node_count / kFacesATick;
      uint32_t* const stalled = &space->inner->sweep.stalled_ticks;
      const bool gets_on = is_shorter(walk.gap(), begun - walk.hip) || (!is_held && !is_at_start);
      *stalled = gets_on ? 0 : *stalled + (*stalled < most);
      if (gets_on || (*stalled < most && !is_at_start)) {
        progress.flags |= FDCG_RESULT_TRANSITION_BOUND;
      }
      return progress;
    }
  }
}

}  // namespace
}  // namespace fdcg
