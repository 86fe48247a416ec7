// SPDX-License-Identifier: Apache-2.0
// The way from a god-object in free space to the HIP (contact-model FREE-1 to FREE-9, LEAVE-1, BOUND-2): whether a sweep is
// needed, the contact with what it met, and the work carried over to later ticks. docs/internals/sweep.md has the sequence.
#pragma once

#include "step/clear_ball.hpp"
#include "step/contact_internals.hpp"
#include "step/missed_way.hpp"

namespace fdcg {

// Where faces were merged a way that meets one may begin behind its plane, within its slab, or meet it before: friction would
// hold the god-object there.
template <class Geometry, class Real = typename Geometry::Real>
inline Vec3<Real> onto_slab(const Walk<Geometry>& walk, Vec3<Real> point, uint32_t n) {
  return walk.graph.has_inexact_nodes() ? foot_on(walk.graph.node(n), point) : point;
}

// Places the contact at the first collision on the way, or at its end.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void arrive(Walk<Geometry>& walk, const Sweep<Geometry>& sweep, const Vec3<Real>& to,
                                         const FirstHit<Real>& first) {
  const bool is_on_face = first.feature.state == FDCG_FACE;
  const Real over = FDCG_MUTANT("grazing") && is_on_face ? first.fraction + Real(0.01)
                    : is_on_face && !sweep.is_over()     ? sweep.part_over(first.feature.index, first.fraction, 0)
                                                         : first.fraction;
  Vec3<Real> point = sweep.point_at(FDCG_MUTANT("arrives-late") ? over + Real(0.01) : over <= 1 ? over : first.fraction);
  if (is_on_face) point = onto_slab(walk, point, first.feature.index);
  walk.active = first.feature;
  if (first.feature.state == FDCG_VERTEX) {
    walk.place(walk.graph.corner_point(first.feature.index), first.feature);
  } else if (first.feature.state == FDCG_EDGE) {
    const EdgeLine<Real> line(walk.graph, first.feature.index);
    place_on_edge(walk, first.feature.index, line, line.parameter(point));
    walk.active = walk.seat;
  } else {
    walk.place(first.feature.is_free() ? to : point, kFree);
  }
}

// Work and state of free space carried over between ticks; all but the work is part of the contact.
struct FreeSpace {
  ContactInternals* inner;
  bool looks_for_balls;
  uint32_t work_left;
  uint32_t missed_work_left;
  const fdcg_contact* begun;  // with HIP and god-object as the tick found them
};

// contact-model FREE-9. Faces that move are triangles, none of them merged.
template <class Geometry, class Real = typename Geometry::Real>
inline void take_what_was_missed(const Sweep<Geometry>& sweep, const GraphView<Geometry>& graph, const Vec3<Real>& to,
                                 FirstHit<Real>* first, FreeSpace* space) {
  if constexpr (Geometry::kKeepsDirections) {
    if (graph.has_inexact_nodes() && first->feature.is_free()) *first = missed_by(sweep, graph, to, &space->missed_work_left);
  }
}

// contact-model FREE-2, BOUND-2: goes on with a sweep of an earlier tick. False: it is still not done, and the god-object has
// not moved.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool finish_carried_sweep(Walk<Geometry>& walk, FreeSpace* space) {
  CarriedSweep* const carried = &space->inner->sweep;
  const Vec3<Real> target = {Real(carried->target[0]), Real(carried->target[1]), Real(carried->target[2])};
  const Vec3<Real> to = FDCG_MUTANT("carried-way-to-the-newest-hip") ? walk.hip : target;
  FirstHit<Real> first = {Real(carried->fraction), carried->node, {carried->state, carried->feature}};
  Sweep<Geometry> sweep(walk.graph, walk.god_object, walk.god_object, to, {carried->left_state, carried->left_feature},
                        &space->work_left);
  // Nearest boxes first once more, with the work of a whole tick: in order fans are looked at node by node.
  const bool is_done = (carried->next_leaf == 0 && sweep.run(&first)) || sweep.run_in_order(&first, &carried->next_leaf);
  carried->fraction = first.fraction;
  carried->node = first.node;
  carried->state = first.feature.state;
  carried->feature = first.feature.index;
  if (!is_done) return false;
  carried->is_carried = 0;
  take_what_was_missed(sweep, walk.graph, to, &first, space);
  arrive(walk, sweep, to, first);
  return true;
}

// Where there was no ball, or none that would hold the next way too, the next looks wait for longer and longer: there a sweep
// is cheaper.
inline void wait_longer(ClearBall* ball) {
  constexpr int kLongestWait = 15;
  ball->next_wait = static_cast<uint16_t>(ball->next_wait < kLongestWait ? 2 * ball->next_wait + 1 : kLongestWait);
  ball->wait = ball->next_wait;
}

// Looks for a ball around the end of a way that no faces touch but a few; it is kept.
template <class Geometry, class Real = typename Geometry::Real>
inline void look_for_ball(const GraphView<Geometry>& graph, const Vec3<Real>& from, const Vec3<Real>& to,
                          ContactInternals* inner) {
  ClearBall* const ball = &inner->clear_ball;
  if (ball->wait > 0) {
    --ball->wait;
    return;
  }
  const Real way = graph.with_way_of_surface(norm(to - from)), radius = clear_radius(graph, to, way, &inner->near, ball);
  if (radius > 2 * way) {
    ball->wait = ball->next_wait = 0;
  } else {
    wait_longer(ball);
  }
  if (!(radius > way)) return end_clear_ball(ball);
  store(to, ball->centre);
  ball->radius2 = FDCG_MUTANT("clear-ball-large") ? 4 * radius * radius : radius * radius;
}

// contact-model FREE-5: a way that begins far away, cut to begin where it comes near the graph; `to` where it passes by, or
// where its numbers, which out there are coarser than the object, cannot tell. A place computed from the whole way might be
// anywhere.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<Real> near_start(const GraphView<Geometry>& graph, const Vec3<Real>& from,
                                                   const Vec3<Real>& to) {
  constexpr Real kFar = kNearExtents, kBefore = 4;  // extents; the graph lies within less than two of the origin
  const Real extent = static_cast<Real>(graph.header()->extent);
  if (!(norm1(from) > kFar * extent)) return from;
  const Vec3<Real> way = to - from;
  const Real length = norm(way);
  if (!(length > 0)) return from;
  const Real nearer = norm1(to) < norm1(from) ? norm1(to) : norm1(from);  // all places on the way are as coarse, or coarser
  if (are_coarse(nearer, extent)) return to;
  const Vec3<Real> along = way * (1 / length);
  const bool is_from_end = norm1(to) < norm1(from);                          // from the nearer end, where numbers are finer
  const Real past = dot(is_from_end ? to : from, along) + kBefore * extent;  // how far that end is past the cut
  if (is_from_end ? !(past < length) : !(past < 0)) return from;
  if (is_from_end ? !(past > 0) : !(-past < length)) return to;
  const Vec3<Real> start = (is_from_end ? to : from) - along * past;
  return norm1(start) > kFar * extent ? to : start;
}

// From free space, or from the surface that was just left, on which the god-object `stood`: places the contact on what the way
// to the HIP meets, or at the HIP. A sweep that was carried over comes first. Returns FDCG_RESULT_SWEEP_BOUND where the work
// ran out, else 0.
template <class Geometry, class Real = typename Geometry::Real>
inline uint32_t sweep_with_loan(Walk<Geometry>& walk, Feature left, const Vec3<Real>& stood, FreeSpace* space) {
  CarriedSweep* const carried = &space->inner->sweep;
  ClearBall* const ball = &space->inner->clear_ball;
  const bool may_look = FDCG_WITH_CLEAR_BALLS && space->looks_for_balls && left.is_free();
  if (!(may_look && is_in_clear_ball(*ball, widen(walk.hip)))) end_clear_ball(ball);
  if (carried->is_carried != 0) {
    if (!finish_carried_sweep(walk, space)) return FDCG_RESULT_SWEEP_BOUND;
    if (!walk.active.is_free()) return 0;
  }
  const Vec3<Real> to = walk.hip, from = left.is_free() ? near_start(walk.graph, walk.god_object, to) : walk.god_object;
  const bool is_still = from.x == to.x && from.y == to.y && from.z == to.z;  // no way, no direction
  // Where the last look found a ball, this one comes first and may spare the sweep. Else, close to a surface, it comes after
  // the sweep, and only where that met nothing: the tick of a touch needs no ball.
  const bool looks = may_look && walk.graph.hierarchy() != nullptr && !(ball->radius2 > 0);
  const bool looks_first = looks && ball->next_wait == 0;
  if (looks_first) look_for_ball(walk.graph, from, to, space->inner);
  if (is_still || (looks_first && ball->radius2 > 0 && passes_near_nodes(walk.graph, *space->inner, from, to))) {
    walk.place(to, kFree);
    return 0;
  }
  walk.god_object = from;
  Sweep<Geometry> sweep(walk.graph, left.is_free() ? from : stood, from, to, left, &space->work_left);
  FirstHit<Real> first;
  const bool is_in_ball =
      FDCG_WITH_CLEAR_BALLS && ball->radius2 > 0 && ball->lists_all != 0;  // then only what it lists can be met
  if (is_in_ball) sweep.run_near(space->inner->near.node, ball->near_count, &first);
  if (is_in_ball || sweep.run(&first)) {
    take_what_was_missed(sweep, walk.graph, to, &first, space);
    arrive(walk, sweep, to, first);
    if (!walk.active.is_free()) {
      end_clear_ball(ball);
      if (looks && !looks_first && ball->wait == 0) wait_longer(ball);
      return 0;
    }
    if (looks && !looks_first) look_for_ball(walk.graph, from, to, space->inner);
    return 0;
  }
  end_clear_ball(ball);
  *carried = {{to.x, to.y, to.z},
              first.fraction,
              first.feature.state,
              first.feature.index,
              first.node,
              left.state,
              left.index,
              0,
              1,
              0};
  walk.active = walk.seat = kFree;
  if (space->work_left == 0 || !finish_carried_sweep(walk, space)) return FDCG_RESULT_SWEEP_BOUND;
  return 0;
}

// The same with work lent: a way that leaves a feature begins beside its neighbours, and one past a busy corner may graze
// dozens of faces. The rules lend half of what they have left, and get back what is not needed (contact-model BOUND-2).
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] uint32_t sweep_to_hip(Walk<Geometry>& walk, Feature left, const Vec3<Real>& stood, FreeSpace* space) {
  const uint32_t lent = walk.work_left / 2;
  space->work_left += lent;
  const uint32_t flags = sweep_with_loan(walk, left, stood, space);
  const uint32_t unspent = lent < space->work_left ? lent : space->work_left;
  space->work_left -= unspent;
  walk.spend(lent - unspent);
  return flags;
}

}  // namespace fdcg
