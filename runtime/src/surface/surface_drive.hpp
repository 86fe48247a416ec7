// SPDX-License-Identifier: Apache-2.0
// The step on a surface of one shape: the same states, friction and response as servo_step.hpp, with a shape in place of a
// graph's features. Each kind's source makes its two functions of surface_kinds.hpp from step_on() and normal_on().
#pragma once

#include "step/contact_internals.hpp"
#include "step/near_zero.hpp"
#include "step/response.hpp"
#include "surface/surface.hpp"
#include "surface/surface_kinds.hpp"

namespace fdcg::surface_drive {

inline constexpr uint32_t kMostTransitions = 24;  // of one tick; two or three are usual

// From free space, or from the surface that was just left: the contact is placed on what the way to the HIP meets, or at the
// HIP.
template <class Shape>
void sweep(const Shape& shape, SurfaceWalk& walk, bool begins_outside) {
  const Entry entry = shape.enter(walk.god_object, walk.hip, begins_outside);
  walk.god_object = entry.is_met ? entry.point : walk.hip;
  walk.active = entry.is_met ? entry.feature : kFree;
}

// Drives the rules until one rests.
template <class Shape>
Progress move_god_object(const Shape& shape, SurfaceWalk& walk) {
  Progress progress = {0, 0};
  if (walk.active == kFree) {
    sweep(shape, walk, shape.is_outside(walk.god_object));
    if (walk.active == kFree) return progress;
    ++progress.transitions;
  }
  for (; progress.transitions < kMostTransitions; ++progress.transitions) {
    const Decision decision = shape.rule(walk);
    if (decision == rest()) {
      if (walk.moves_left == 0) progress.flags = FDCG_RESULT_TRANSITION_BOUND;
      return progress;
    }
    if (!(next_of(decision) == kFree)) {
      walk.active = next_of(decision);
      continue;
    }
    const bool is_convex_solid = Shape::kIsConvex && shape.sign > 0;  // what leaves it cannot meet it
    // In front of a tangent plane and yet in the solid: by rounding alone. As a free contact it would pass through.
    if (is_convex_solid && !shape.is_outside(walk.hip)) return progress;
    ++progress.transitions;
    if (is_convex_solid) {
      walk.god_object = walk.hip;
      walk.active = kFree;
    } else {
      sweep(shape, walk, true);
    }
    if (walk.active == kFree) return progress;
  }
  progress.flags = FDCG_RESULT_TRANSITION_BOUND;
  return progress;
}

inline bool is_usable_place(const double p[3]) {
  constexpr double kFar = RealLimits<double>::kFar;
  return absolute(p[0]) <= kFar && absolute(p[1]) <= kFar && absolute(p[2]) <= kFar;
}

inline Point place_of(const double p[3], double extent) {
  const double least = kLeastShare * extent;
  return {zero_below(least, p[0]), zero_below(least, p[1]), zero_below(least, p[2])};
}

// Whether place_of() would not change a place; only a branch depends on the result.
FDCG_HOT bool is_plain_place(Point p, double extent) {
  const double least = kLeastShare * extent;
  return !((absolute(p.x) < least && p.x != 0) || (absolute(p.y) < least && p.y != 0) || (absolute(p.z) < least && p.z != 0));
}

inline void start(Point hip, fdcg_contact* contact) {
  store(hip, contact->hip);
  store(hip, contact->god_object);
  contact->started = 1;
  contact->state = internals_of(*contact).seat_state = FDCG_FREE;
  contact->feature = internals_of(*contact).seat_feature = FDCG_NONE;
  contact->slipping = 0;
}

// Where the contact is; one of zeros is free, and on nothing.
FDCG_HOT void report(const fdcg_contact& contact, fdcg_result* result) {
  store(vec(contact.god_object), result->god_object_m);
  result->state = contact.state;
  result->feature = contact.state == FDCG_FREE ? FDCG_NONE : contact.feature;
  result->slipping = contact.slipping;
}

struct Tick {
  const fdcg_surface& surface;
  const fdcg_params& params;
  fdcg_contact* contact;
  const double* hip_m;
  fdcg_result* result;
};

// Stores a contact on the surface in its new place, and what the hand feels of it.
FDCG_HOT void respond(const Tick& tick, const Touch& touch, Feature feature) {
  fdcg_contact& contact = *tick.contact;
  fdcg_result& result = *tick.result;
  const Point spring = touch.god_object - touch.hip;
  double newtons_per_metre = tick.params.stiffness_n_per_m;
  if (tick.params.damping_n_s_per_m > 0)
    newtons_per_metre = damped(tick.params, newtons_per_metre, spring, touch.hip - vec(contact.hip));
  store(spring * newtons_per_metre, result.force_n);
  store(touch.god_object, contact.god_object);
  store(touch.god_object, result.god_object_m);
  store(touch.hip, contact.hip);
  contact.state = result.state = feature.state;
  contact.feature = result.feature = feature.index;
  contact.slipping = result.slipping = touch.friction.is_slipping ? 1 : 0;
}
// Free, and at the HIP or on the way to it.
FDCG_HOT void respond_free(const Tick& tick, Point at, Point hip) {
  store(at, tick.contact->god_object);
  store(hip, tick.contact->hip);
  tick.contact->state = FDCG_FREE;
  tick.contact->feature = FDCG_NONE;
  tick.contact->slipping = 0;
  report(*tick.contact, tick.result);
}

FDCG_HOT Touch touch_of(const Tick& tick, Point hip) {
  const fdcg_params& params = tick.params;
  return {{{params.mu_static, params.mu_dynamic, params.edge_friction == FDCG_EDGE_WEDGE, tick.contact->slipping != 0}},
          hip,
          vec(tick.contact->god_object)};
}

template <class Shape>
[[gnu::noinline]] void step_by_rules(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* at,
                                     const double* hip_m, fdcg_result* result) {
  const Tick tick = {surface, params, at, hip_m, result};
  fdcg_contact& contact = *at;
  const Shape shape(tick.surface);
  SurfaceWalk walk = {
      touch_of(tick, place_of(tick.hip_m, shape.extent)), {contact.state, contact.feature}, FDCG_SURFACE_MAX_MOVES};
  if (contact.started == 0) {
    start(walk.hip, &contact);
    report(contact, tick.result);
    return;
  }
  const Progress progress = move_god_object(shape, walk);
  tick.result->transitions = progress.transitions;
  tick.result->flags = progress.flags;
  contact.transition_bound_ticks += progress.flags != 0 ? 1 : 0;
  if (walk.active == kFree) {
    respond_free(tick, walk.god_object, walk.hip);
  } else {
    respond(tick, walk, walk.active);
  }
}

// No less than a way's length, and all roundings of where it leads.
FDCG_HOT double way_bound(Point way, double extent) {
  return norm1(way) * (1 + 0x1p-20) + 16 * kEps * extent;
}

// The usual ticks, handled before the rules and in registers: nothing here is passed to another function by reference. Quick:
// the part of the shape for that, with is_clear(), slide_quickly() and extent.
template <class Shape, class Quick>
FDCG_HOT void step_on(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* at, const double* hip_m,
                      fdcg_result* result) {
  const Tick tick = {surface, params, at, hip_m, result};
  fdcg_contact& contact = *at;
  const Quick shape(surface);
  const Point hip = {hip_m[0], hip_m[1], hip_m[2]};
  if (!is_plain_place(hip, shape.extent)) return step_by_rules<Shape>(surface, params, at, hip_m, result);
  Touch touch = touch_of(tick, hip);
  const Point way = touch.hip - touch.god_object;
  if (contact.state == FDCG_FREE && contact.started != 0 && shape.is_clear(touch.hip, way_bound(way, shape.extent))) {
    respond_free(tick, touch.hip, touch.hip);
  } else if (contact.state == FDCG_FACE && shape.slide_quickly(contact.feature, touch)) {
    respond(tick, touch, {FDCG_FACE, contact.feature});
  } else {
    step_by_rules<Shape>(surface, params, at, hip_m, result);
  }
}

template <class Shape>
void normal_on(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {
  const Point at = vec(result.god_object_m);
  const Point n = Shape(surface).normal({result.state, result.feature}, at, at - vec(result.force_n));
  normal[0] = n.x;
  normal[1] = n.y;
  normal[2] = n.z;
}

}  // namespace fdcg::surface_drive

// What surface_kinds.hpp declares of a kind, once in the kind's own source. Quick: what most ticks need of the shape.
#define FDCG_SURFACE_KIND(name, kind, Shape, Quick)                                                                            \
  extern "C" const uint32_t fdcg_linked_##name = kind;                                                                         \
  void fdcg::step_##name(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3], \
                         fdcg_result* result) {                                                                                \
    surface_drive::step_on<Shape, Quick>(surface, params, contact, hip_m, result);                                             \
  }                                                                                                                            \
  void fdcg::normal_of_##name(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {                      \
    surface_drive::normal_on<Shape>(surface, result, normal);                                                                  \
  }
