// SPDX-License-Identifier: Apache-2.0
// The step: the friction-cone god-object algorithm of Melder and Harwin (2004) on a Face Directed Connection Graph. Its rules:
// docs/internals/contact-model.md; how these files follow them: docs/internals/step.md.
//
//   Free --sweep--> Face | Edge | Vertex          free_space.hpp, sweep.hpp: where does the hand's way first meet the surface?
//   Face  -> rest | Edge | Vertex | Free          face.hpp     slide to the friction circle, or to the first edge on the way
//   Edge  -> rest | Face | Vertex | Free          edge.hpp     which face pulls more, or slide along the edge
//   Vertex-> rest | Face | Edge | Free            corner.hpp   the steepest descent around the corner
//   ... -> Free                                   leave.hpp    in front, by exact sign, of what is left
//
// Each rule moves the god-object nearer to the HIP or hands over to a neighbour that climbs further; the step ends where a rule
// rests (contact-model TICK-1). Every loop is bounded: work left over is carried to the next tick with a valid god-object.
//
// A template over the geometry: servo_step.cpp has the step on a graph as it is, deform/deform_step.cpp that on a mesh whose
// corners move. What is in here is each such source's own, so that a program may hold steps of other bounds (base/work.hpp)
// than the library's.
#pragma once

#include "base/config.hpp"
#include "base/hooks.hpp"
#include "step/along_edge.hpp"
#include "step/contact_internals.hpp"
#include "step/corner.hpp"
#include "step/edge.hpp"
#include "step/face.hpp"
#include "step/free_space.hpp"
#include "step/hop.hpp"
#include "step/local_hip.hpp"
#include "step/presliding.hpp"
#include "step/response.hpp"
#include "step/rules_loop.hpp"
#include "step/shaded_tick.hpp"
#include "step/shading_account.hpp"

namespace fdcg {
namespace {

// Whether the graph has such a feature; used by an assertion only.
[[maybe_unused]] bool is_of_graph(Feature feature, const fdcg_header& header) {
  const uint32_t count[] = {0, header.node_count, header.connection_count, header.corner_count};
  return feature.is_free() || (feature.state <= FDCG_VERTEX && feature.index < count[feature.state]);
}

inline void write_position(const fdcg_header& header, const fdcg_contact& contact, fdcg_result* result) {
  store((vec(contact.god_object) + vec(header.origin)) * header.metres_per_unit, result->god_object_m);
  result->state = contact.state;
  result->feature = contact.state == FDCG_FREE ? FDCG_NONE : contact.feature;  // a contact of zeros is free, and on nothing
  result->slipping = contact.slipping;
}

inline void leave_seat(fdcg_contact* contact) {
  internals_of(*contact).seat_state = FDCG_FREE;
  internals_of(*contact).seat_feature = FDCG_NONE;
}
inline Feature seat_of(const fdcg_contact& contact) {
  return {internals_of(contact).seat_state, internals_of(contact).seat_feature};
}

// First tick: free, with the god-object at the HIP (contact-model TICK-3).
template <class Real>
[[gnu::noinline, gnu::cold]] void start(const Vec3<Real>& hip, fdcg_contact* contact) {
  store(hip, contact->hip);
  store(hip, contact->god_object);
  contact->started = 1;
  contact->state = FDCG_FREE;
  contact->feature = FDCG_NONE;
  contact->slipping = 0;
  ContactInternals& inner = internals_of(*contact);
  inner.seat_state = FDCG_FREE;
  inner.seat_feature = FDCG_NONE;
  inner.slip_m_per_s = inner.stiffness_n_per_m = 0;
  inner.sweep.is_carried = 0;
  inner.clear_ball = {};
}

template <class Real>
inline PlainFriction<Real> friction_of(const fdcg_params& params, const fdcg_contact& contact) {
  return {static_cast<Real>(params.mu_static), static_cast<Real>(params.mu_dynamic), params.edge_friction == FDCG_EDGE_WEDGE,
          contact.slipping != 0};
}

// The force of a spring, damped along its direction. Call before the new HIP is stored in the contact.
inline void spring_damper_force(const fdcg_header& header, const fdcg_params& params, const fdcg_contact& contact,
                                double newtons_per_metre, Vec3<double> local_hip, Vec3<double> spring, fdcg_result* result) {
  if (params.damping_n_s_per_m > 0) {
    newtons_per_metre = damped(params, newtons_per_metre, spring, local_hip - vec(contact.hip));
  }
  store(spring * (newtons_per_metre * header.metres_per_unit), result->force_n);
}

// F = k (GO - HIP) (contact-model RESP-1).
template <class Real>
inline void respond(const fdcg_header& header, const fdcg_params& params, const fdcg_contact& contact, Vec3<Real> hip,
                    Vec3<Real> god_object, fdcg_result* result) {
  const Vec3<double> local_hip = widen(hip);
  spring_damper_force(header, params, contact, params.stiffness_n_per_m, local_hip, widen(god_object) - local_hip, result);
}

// The same with terms of friction.
template <class Geometry>
[[gnu::noinline, gnu::cold]] void respond_with_terms(const Walk<Geometry>& walk, fdcg_contact* contact, fdcg_result* result) {
  FrictionTerms& terms = *walk.friction.terms;
  const fdcg_params& params = *terms.params;
  ContactInternals& inner = internals_of(*contact);
  inner.slip_m_per_s = inner.stiffness_n_per_m = 0;
  if (walk.active.is_free()) return;
  if (terms.has_last) terms.go_on_to(widen(walk.god_object));
  if (terms.has(FDCG_FRICTION_LAG)) inner.slip_m_per_s = (terms.lagged + terms.per_way * terms.way) * terms.unit_m;
  const Feature was = {contact->state, contact->feature};
  double stiffness;
  if (kShades<Geometry> && terms.shades()) {
    stiffness = settle_shaded(walk, was, vec(contact->god_object), vec(contact->hip), &inner.stiffness_n_per_m);
  } else {
    stiffness = settle(walk, was, vec(contact->god_object));
    if (terms.has_springs()) inner.stiffness_n_per_m = stiffness;
  }
  const Vec3<double> hip = widen(walk.hip), spring = widen(walk.god_object) - hip + terms.yielded;
  spring_damper_force(*walk.graph.header(), params, *contact, stiffness, hip, spring, result);
}

// The long way: drives the rules from where the contact stands, or where hops have led, in so many transitions. `move` is null,
// or what its face has already made of it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void walk_to_hip(Walk<Geometry>& walk, const FaceMove<Real>* move, uint32_t transitions,
                                              const fdcg_params& params, fdcg_contact* contact, fdcg_result* result) {
  ContactInternals& inner = internals_of(*contact);
  FreeSpace space = {&inner, (params.disabled_optimizations & FDCG_STEP_OPT_CLEAR_BALL) == 0, kSweepWork, kMissedWork, contact};
  const bool is_plain = walk.friction.terms == nullptr;
  const bool asks_face = !FDCG_WITH_FAST_FACES && walk.active.state == FDCG_FACE && is_plain;
  uint32_t flags = 0, hops = transitions;
  FaceMove<Real> landing;
  if (walk.active.is_free()) {
    if (FDCG_MUTANT("last-tick-segment")) walk.god_object = walk.hip;
    flags = sweep_to_hip(walk, kFree, walk.god_object, &space);
    transitions = walk.active.is_free() ? 0 : 1;
    if constexpr (kHasEdgeHops<Geometry>) {
      const bool may_hop = is_plain && (params.disabled_optimizations & FDCG_STEP_OPT_HOP) == 0;
      if (may_hop && walk.active.state == FDCG_FACE && hop_on(walk, &hops, &landing)) move = &landing;
      transitions += hops;
    }
  }
  if (!walk.active.is_free()) {
    const Vec3<Real> start_gap = walk.gap();
    const Feature start = walk.active, hopped = hops != 0 ? walk.seat : kFree;
    Decision decided = rest();  // as of an edge that keeps a god-object
    if (move != nullptr && start.state == FDCG_FACE) decided = carry_out(walk, *move);
    if (asks_face) {  // not billed: nor is what a short way finds of its first face
      decided = face_rule(walk);
      walk.work_left = kRuleWork;
    }
    const Progress after =
        move_god_object(walk, start, start_gap, hopped, move != nullptr || asks_face ? &decided : nullptr, &space);
    transitions += after.transitions;
    flags |= after.flags;
  }
  // On a surface it is within the object. Planes of a file that is SAFE, and not FULL, may lie up to four extents away from
  // their corners, and take it where no arithmetic holds any longer (contact-model TICK-8).
  if (!walk.active.is_free() && !is_usable(walk.god_object)) {
    walk.god_object = walk.hip;
    walk.active = walk.seat = kFree;
  }
  FDCG_ASSERT(is_of_graph(walk.active, *walk.graph.header()));
  contact->transition_bound_ticks += (flags & FDCG_RESULT_TRANSITION_BOUND) != 0;
  contact->sweep_bound_ticks += (flags & FDCG_RESULT_SWEEP_BOUND) != 0;
  result->flags = flags;
  result->transitions = transitions;
  const bool is_free = walk.active.is_free();
  if (walk.friction.terms == nullptr) {
    if (!is_free) respond(*walk.graph.header(), params, *contact, walk.hip, walk.god_object, result);
  } else if constexpr (FDCG_WITH_FRICTION_TERMS) {
    respond_with_terms(walk, contact, result);
  }
  store(walk.god_object, contact->god_object);
  contact->state = walk.active.state;
  contact->feature = walk.active.index;
  inner.seat_state = walk.seat.state;
  inner.seat_feature = walk.seat.index;
  const bool is_undecided = inner.sweep.is_carried != 0;  // contact may be regained
  contact->slipping = (!is_free || is_undecided || FDCG_MUTANT("slip-flag-free")) && walk.friction.is_slipping ? 1 : 0;
}

// A tick of a contact that stays on shaded faces, and its account (contact-model SHADE-5). False: it may not, and nothing has
// changed but the field that it keeps.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::hot]] bool step_on_shaded_faces(const fdcg_graph& raw, const fdcg_params& params, const Vec3<Real>& at,
                                                      fdcg_contact* contact, fdcg_result* result) {
  ContactInternals& inner = internals_of(*contact);
  const double own = params.stiffness_n_per_m, kept = inner.stiffness_n_per_m;
  if (raw.normals == nullptr || contact->state != FDCG_FACE || !(kept > 0)) return false;
  const Vec3<Real> hip = by_parts(at);
  const Vec3<double> local_hip = widen(hip), was = vec(contact->god_object), last = was - vec(contact->hip);
  ShadedTick<Real> tick;
  tick.node = contact->feature;
  tick.edge = FDCG_NONE;
  tick.transitions = 0;
  tick.god_object = narrow<Real>(contact->god_object);
  if (!slides_on_shaded_faces<Geometry>(raw, hip, last, friction_of<Real>(params, *contact), &inner.field, &tick)) return false;
  const Vec3<Real> god_object = by_parts(tick.god_object);
  const Vec3<double> before = was - local_hip, spring = widen(god_object) - local_hip;
  const double may = may_store(kept, own, dot(before, before), dot(last, last));
  inner.stiffness_n_per_m = kept_stiffness(kept, own, may, dot(spring, spring), tick.is_rest);
  spring_damper_force(*raw.header, params, *contact, smaller(inner.stiffness_n_per_m, own), local_hip, spring, result);
  inner.slip_m_per_s = 0;
  if (!tick.is_rest) inner.seat_state = FDCG_FREE, inner.seat_feature = FDCG_NONE;
  contact->feature = tick.node;
  contact->slipping = tick.is_slipping ? 1 : 0;
  result->transitions = tick.transitions;
  store(god_object, contact->god_object);
  store(hip, contact->hip);
  write_position(*raw.header, *contact, result);
  return true;
}

// A tick of a contact that has started, with terms of friction: all of it goes the long way.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void step_with_terms(const fdcg_graph& raw, const fdcg_params& params, const Vec3<Real>& hip,
                                                  fdcg_contact* contact, fdcg_result* result) {
  const GraphView<Geometry> graph(raw);
  FrictionTerms terms = terms_of(params, &raw, *contact);
  Walk<Geometry> walk(graph, friction_of<Real>(params, *contact), &terms, hip, plane_rounding_bound(graph, hip),
                      narrow<Real>(contact->god_object), {contact->state, contact->feature}, seat_of(*contact), kRuleWork);
  walk_to_hip<Geometry, Real>(walk, nullptr, 0, params, contact, result);
  store(hip, contact->hip);
  write_position(*raw.header, *contact, result);
  store(vec(result->god_object_m) + terms.yielded * raw.header->metres_per_unit, result->god_object_m);
}

// The same, but for ticks that are plainly shaded.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT void step_with_flags(const fdcg_graph& raw, const fdcg_params& params, Vec3<Real> hip, fdcg_contact* contact,
                              fdcg_result* result) {
  const Vec3<Real> at = by_parts(hip);  // of its own, so that other ways keep nothing in memory
  if constexpr (kShades<Geometry>) {
    if (params.friction_flags == FDCG_FRICTION_SHADING &&
        step_on_shaded_faces<Geometry, Real>(raw, params, at, contact, result))
      return;
  }
  step_with_terms<Geometry>(raw, params, at, contact, result);
}

// Whether a tick on a face has a short way of its own; a library built for size has one way for all.
#if defined(__OPTIMIZE_SIZE__) || !FDCG_WITH_FAST_FACES
inline constexpr bool kGlances = false;
#else
inline constexpr bool kGlances = true;
#endif

// A HIP that is no number, or too far away for the step's arithmetic.
[[gnu::noinline, gnu::cold]] inline void refuse_hip(const fdcg_header& header, fdcg_contact* contact, fdcg_result* result) {
  ++contact->non_finite_ticks;
  result->flags = FDCG_RESULT_NON_FINITE;
  write_position(header, *contact, result);
}

// What a tick finds of a contact on a face before it looks at sides closely.
template <class Real>
struct FaceTick {
  Real side;  // of the HIP, from the face
  bool is_slipping;
  FaceGlance<Real> glance;
};
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT FaceTick<Real> look_at_face(const GraphView<Geometry>& graph, const fdcg_params& params, const fdcg_contact& contact,
                                     Vec3<Real> hip, Real bound) {
  const NodeRef<Geometry> node = graph.node(contact.feature);
  const Vec3<Real> god_object = narrow<Real>(contact.god_object), stands = god_object - hip;
  const Real side = side_of(graph, node, hip, bound, nullptr);
  QuickFriction<Real> friction = {friction_of<Real>(params, contact)};
  const FaceGlance<Real> glance = glance_on_face(node, friction, hip, bound, side, god_object, stands);
  return {side, friction.is_slipping, {glance.kind, glance.near_side, by_parts(glance.target)}};
}

// Whether a god-object ends on its face.
template <class Geometry, class Real = typename Geometry::Real>
inline bool ends_on_face(const GraphView<Geometry>& graph, Vec3<Real> hip, FaceMoveKind kind, bool has_hopped) {
  return kind == FaceMoveKind::slides ? !is_far(graph, hip) : kind == FaceMoveKind::rests && !has_hopped;
}
template <class Real>
FDCG_HOT void end_at(const fdcg_header& header, const fdcg_params& params, const Vec3<Real>& hip, const Vec3<Real>& god_object,
                     bool is_slipping, fdcg_contact* contact, fdcg_result* result) {
  contact->slipping = is_slipping ? 1 : 0;
  respond(header, params, *contact, hip, god_object, result);
  store(god_object, contact->god_object);
}
template <class Real>
FDCG_OUTLINED void end_short_way_at(const fdcg_header& header, const fdcg_params& params, const Vec3<Real>& hip,
                                    const Vec3<Real>& god_object, bool is_slipping, fdcg_contact* contact,
                                    fdcg_result* result) {
  end_at(header, params, hip, by_parts(god_object), is_slipping, contact, result);
}

// A tick that begins on an edge: it is done where the god-object stays. *face: what pulls the god-object off it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::hot]] OnEdge step_along_edge(const fdcg_graph& raw, const fdcg_params& params, const Vec3<Real>& hip,
                                                   fdcg_contact* contact, fdcg_result* result, uint32_t* face) {
  if ((params.disabled_optimizations & FDCG_STEP_OPT_HOP) != 0) return OnEdge::unsure;
  AlongEdge<Real> along;
  along.friction = friction_of<Real>(params, *contact);
  along.god_object = narrow<Real>(contact->god_object);
  const OnEdge what = look_along_edge(GraphView<Geometry>(raw), contact->feature, hip, &along);
  *face = along.face;
  if (what != OnEdge::stays) return what;
  ContactInternals& inner = internals_of(*contact);
  if (along.has_slid) inner.seat_state = FDCG_EDGE, inner.seat_feature = contact->feature;
  end_short_way_at(*raw.header, params, hip, along.god_object, along.friction.is_slipping, contact, result);
  return what;
}

// Goes on from an edge to the face that pulls the god-object off it, and over further edges. False: what the rules' loop
// remembers of the edge may count, and *hop is as it was.
template <class Geometry, class Real = typename Geometry::Real>
inline bool hops_off_edge(const GraphView<Geometry>& graph, const Vec3<Real>& hip, Real bound, uint32_t face, Hop<Real>* hop) {
  const PlainFriction<Real> friction = hop->friction;
  const NodeRef<Geometry> node = graph.node(face);
  spend(&hop->work_left, kEdgeWork + kTransitionWork + kSideWork * node.side_count());
  hop->node = face;
  hop->prefetched = FDCG_NONE;
  hop->side = distance_from(node, hip);
  hop->transitions = 1;
  hop_to_hip(graph, hip, bound, false, hop);
  if (hop->transitions > 1 || ends_on_face(graph, hip, hop->move.kind, false)) return true;
  hop->friction = {friction};
  hop->work_left = kRuleWork;
  hop->transitions = 0;
  return false;
}

// In a graph that may be out of the caches, what a second crossing of a tick would read is prefetched before that tick: all
// around the neighbours of the face that the god-object is on. A tick that came over one edge does so for the new face: its
// neighbours, which name those faces, are at hand already, since the old face's neighbours had the same done. After other ticks
// the first one does that slides. It changes no result.
template <class Geometry>
FDCG_HOT bool is_prefetched_beyond(const GraphView<Geometry>& graph, const fdcg_contact& contact) {
  return graph.is_large() && internals_of(contact).near.prefetched == contact.feature;
}
// `from`: the face that it came from, or FDCG_NONE.
template <class Geometry>
[[gnu::noinline]] void prefetch_beyond(const GraphView<Geometry>& graph, uint32_t from, fdcg_contact* contact) {
  NearNodes& near = internals_of(*contact).near;
  near.of_node = 0;  // a field that shading kept is made anew
  near.prefetched = contact->feature;
  if (graph.is_plain()) graph.prefetch_around_neighbours_of(contact->feature, from);
}
// After a tick that began on face `from`.
template <class Geometry>
FDCG_HOT void prefetch_after(const GraphView<Geometry>& graph, uint32_t from, uint32_t transitions, fdcg_contact* contact) {
  if (!graph.is_large() || transitions != 2 || contact->state != FDCG_FACE) return;
  if (internals_of(*contact).near.prefetched == from) prefetch_beyond(graph, from, contact);
}

// The rest of a tick: from a face that the god-object may leave, or on which it must be asked again, with what has been found
// there; from an edge that a face, `pulling`, pulls it off; or, `tick` null and no such face, from elsewhere.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_OUTLINED void step_on(const fdcg_graph& raw, const fdcg_params& params, const Vec3<Real>& hip, const FaceTick<Real>* tick,
                           uint32_t pulling, fdcg_contact* contact, fdcg_result* result) {
  const GraphView<Geometry> graph(raw);
  const Real bound = plane_rounding_bound(graph, hip);
  bool has_move = contact->state == FDCG_FACE;
  Hop<Real> hop;
  hop.god_object = narrow<Real>(contact->god_object);
  hop.work_left = kRuleWork;
  hop.transitions = 0;
  hop.is_on_edge = false;
  hop.friction = {friction_of<Real>(params, *contact)};
  if (has_move) {
    const NodeRef<Geometry> node = graph.node(contact->feature);
    if constexpr (kGlances) {
      if constexpr (kHasHops<Geometry>) prefetch_ahead(graph, node, tick->glance, is_prefetched_beyond(graph, *contact), &hop);
      hop.friction.is_slipping = tick->is_slipping;
      hop.move = meet_side(node, hop.god_object, tick->glance);
    } else {
      const Vec3<Real> stands = hop.god_object - hip;
      hop.move =
          move_on_face(node, hop.friction, hip, bound, side_of(graph, node, hip, bound, nullptr), hop.god_object, stands);
    }
    hop.node = contact->feature;
    if (kHasHops<Geometry> && hop.move.kind == FaceMoveKind::crosses && tick->side < -bound &&
        (params.disabled_optimizations & FDCG_STEP_OPT_HOP) == 0)
      hop_to_hip(graph, hip, bound, true, &hop);
  } else if (kHasEdgeHops<Geometry> && pulling != FDCG_NONE) {
    has_move = hops_off_edge(graph, hip, bound, pulling, &hop);
  }
  if (has_move) {
    ContactInternals& inner = internals_of(*contact);
    contact->state = FDCG_FACE;
    contact->feature = hop.node;
    const bool ends_on_edge = kHasEdgeHops<Geometry> && hop.is_on_edge;
    if (ends_on_edge) {
      contact->state = inner.seat_state = FDCG_EDGE;
      contact->feature = inner.seat_feature = hop.edge;
    }
    if (ends_on_edge || ends_on_face(graph, hip, hop.move.kind, hop.transitions > 1)) {
      if (!ends_on_edge && hop.move.kind == FaceMoveKind::slides) leave_seat(contact);
      result->transitions = hop.transitions;
      const Vec3<Real>& end = ends_on_edge ? hop.god_object : hop.move.target;
      return end_short_way_at(*raw.header, params, hip, end, hop.friction.is_slipping, contact, result);
    }
  }
  Walk<Geometry> walk(graph, hop.friction, nullptr, hip, bound, hop.god_object, {contact->state, contact->feature},
                      hop.transitions != 0 ? Feature{FDCG_EDGE, hop.edge} : seat_of(*contact), hop.work_left);
  walk_to_hip<Geometry, Real>(walk, has_move ? &hop.move : nullptr, hop.transitions, params, contact, result);
}

// All of a tick by the rules, where the library has no short ways.
template <class Geometry, class Real = typename Geometry::Real>
inline void step_by_rules(const fdcg_graph& raw, const fdcg_params& params, const Vec3<Real>& hip, fdcg_contact* contact,
                          fdcg_result* result) {
  const GraphView<Geometry> graph(raw);
  Walk<Geometry> walk(graph, friction_of<Real>(params, *contact), nullptr, hip, plane_rounding_bound(graph, hip),
                      narrow<Real>(contact->god_object), {contact->state, contact->feature}, seat_of(*contact), kRuleWork);
  walk_to_hip<Geometry, Real>(walk, nullptr, 0, params, contact, result);
}

// A god-object that stays on its face, at rest or sliding, is what a servo loop meets most (contact-model TICK-7): what such a
// tick does not need is made in step_on().
template <class Geometry, class Real = typename Geometry::Real>
void step(const fdcg_graph& raw, const fdcg_params& params, fdcg_contact* contact, const double hip_object_m[3],
          fdcg_result* result) {
  const fdcg_header& header = *raw.header;
  Vec3<double> local_hip = {0, 0, 0};
  *result = {};
  if (!to_local(header, hip_object_m, RealLimits<Real>::kFar, &local_hip)) return refuse_hip(header, contact, result);
  Vec3<Real> hip;
  round_to(local_hip, &hip);
  if (contact->started == 0) {
    start(hip, contact);
  } else if (FDCG_WITH_CLEAR_BALLS && contact->state == FDCG_FREE &&
             is_in_clear_ball(internals_of(*contact).clear_ball, local_hip) &&
             (params.disabled_optimizations & FDCG_STEP_OPT_CLEAR_BALL) == 0 &&
             (internals_of(*contact).clear_ball.near_count == 0 ||
              passes_near_nodes(GraphView<Geometry>(raw), internals_of(*contact), narrow<Real>(contact->god_object), hip))) {
    store(hip, contact->god_object);
    store(hip, contact->hip);
  } else if (FDCG_WITH_FRICTION_TERMS && params.friction_flags != 0) {
    if constexpr (FDCG_WITH_FRICTION_TERMS) return step_with_flags<Geometry>(raw, params, hip, contact, result);
  } else {
    if constexpr (!FDCG_WITH_FAST_FACES) {
      step_by_rules<Geometry>(raw, params, hip, contact, result);
    } else if (kGlances && contact->state == FDCG_FACE) {
      const GraphView<Geometry> graph(raw);
      const FaceTick<Real> tick =
          look_at_face(graph, params, *contact, by_parts(hip), plane_rounding_bound(graph, by_parts(hip)));
      if (ends_on_face(graph, hip, tick.glance.kind, false)) {
        const bool slides = tick.glance.kind == FaceMoveKind::slides;
        if (slides) leave_seat(contact);
        end_at(header, params, hip, tick.glance.target, tick.is_slipping, contact, result);
        if constexpr (kHasHops<Geometry>) {
          if (slides && graph.is_large() && !is_prefetched_beyond(graph, *contact)) prefetch_beyond(graph, FDCG_NONE, contact);
        }
      } else {
        // Of its own, so that the way above keeps nothing in memory.
        const FaceTick<Real> found = {
            tick.side, tick.is_slipping, {tick.glance.kind, tick.glance.near_side, by_parts(tick.glance.target)}};
        const uint32_t from = contact->feature;
        step_on<Geometry, Real>(raw, params, hip, &found, FDCG_NONE, contact, result);
        if constexpr (kHasHops<Geometry>) prefetch_after(graph, from, result->transitions, contact);
      }
    } else {
      const Vec3<Real> at = by_parts(hip);  // as above
      OnEdge what = OnEdge::unsure;
      uint32_t face = FDCG_NONE;
      if (kHasEdgeHops<Geometry> && contact->state == FDCG_EDGE)
        what = step_along_edge<Geometry>(raw, params, at, contact, result, &face);
      if (what != OnEdge::stays)
        step_on<Geometry, Real>(raw, params, at, nullptr, what == OnEdge::pulled ? face : FDCG_NONE, contact, result);
    }
    store(hip, contact->hip);
  }
  write_position(header, *contact, result);
}

}  // namespace
}  // namespace fdcg
