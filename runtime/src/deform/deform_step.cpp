// SPDX-License-Identifier: Apache-2.0
// The step on a deformable mesh: that on any graph (step/servo_step.hpp), on the geometry of one whose corners move, after the
// contact has taken part in the mesh's motion.
#include "base/struct_bytes.hpp"
#include "deform/deform_clear.hpp"
#include "deform/deform_motion.hpp"
#include "deform/deformable_geometry.hpp"
#include "step/admit.hpp"
#include "step/contact_internals.hpp"
#include "step/servo_step.hpp"

namespace fdcg {
namespace {

inline Vec3<double> place_of(const fdcg_contact& contact) {
  return vec(contact.god_object);
}

template <class Real>
inline void place_god_object(fdcg_contact* contact, Vec3<double> place) {
  store(Vec3<Real>{static_cast<Real>(place.x), static_cast<Real>(place.y), static_cast<Real>(place.z)}, contact->god_object);
}

// The ends of a connection's edge, before or after the tick.
template <class Real>
inline void ends_of(const Upkeep<Real>& upkeep, uint32_t connection, bool is_before, Vec3<double> (&end)[2]) {
  const fdcg_connection& record = upkeep.deform().connections[connection];
  const fdcg_side* const sides = upkeep.node(record.node).sides;
  for (uint32_t e = 0; e < 2; ++e) {
    const uint32_t c = sides[(record.side[0] + e) % 3].corner;
    end[e] = widen(is_before ? upkeep.old_point(c) : upkeep.point(c));
  }
}

template <class Real>
inline bool is_on_rim(const Upkeep<Real>& upkeep, uint32_t n, Feature seat) {
  for (const fdcg_side& side : upkeep.node(n).sides) {
    if (seat.state == FDCG_EDGE && side.link >> 1 == seat.index) return true;
    if (seat.state == FDCG_VERTEX && side.corner == seat.index) return true;
  }
  return false;
}
template <class Real>
inline bool is_end(const Upkeep<Real>& upkeep, uint32_t connection, uint32_t corner) {
  const fdcg_connection& record = upkeep.deform().connections[connection];
  const fdcg_side* const sides = upkeep.node(record.node).sides;
  return sides[record.side[0]].corner == corner || sides[(record.side[0] + 1) % 3].corner == corner;
}

// `saw_before`: the contact was stepped on the mesh as it was before the tick; otherwise only its present place is known.
template <class Real>
void ride_on_edge(const Upkeep<Real>& upkeep, uint32_t connection, bool saw_before, fdcg_contact* contact) {
  Vec3<double> old_end[2], end[2];
  ends_of(upkeep, connection, saw_before, old_end);
  ends_of(upkeep, connection, false, end);
  const auto is_same = [](Vec3<double> a, Vec3<double> b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  if (saw_before && is_same(old_end[0], end[0]) && is_same(old_end[1], end[1])) return;
  place_god_object<Real>(contact, point_along(end, share_along(old_end, place_of(*contact))));
}

// Off a triangle that is a line now and whose front may be its back: just in front of its neighbours, so that the way to the
// HIP meets what is there. Where no direction leads in front of all it stays.
template <class Real>
[[gnu::noinline, gnu::cold]] void step_off_line(const Upkeep<Real>& upkeep, uint32_t n, fdcg_contact* contact) {
  Vec3<double> normal[3], out = {0, 0, 0};
  uint32_t count = 0;
  for (const fdcg_side& side : upkeep.node(n).sides) {
    if (side.across == FDCG_NONE) continue;
    if (upkeep.is_sliver(side.across)) return;
    normal[count] = widen(vec(upkeep.node(side.across).plane.normal));
    out = out + normal[count++];
  }
  const double length = norm(out);
  for (uint32_t i = 0; i < count; ++i)
    if (!(dot(out, normal[i]) > length / 4)) return;
  if (count == 0) return;
  const double lift = 16 * double{RealLimits<Real>::kEpsilon} * upkeep.deform().header.extent / length;
  ContactInternals& inner = internals_of(*contact);
  contact->state = inner.seat_state = FDCG_FREE;
  contact->feature = inner.seat_feature = FDCG_NONE;
  end_clear_ball(&inner.clear_ball);
  place_god_object<Real>(contact, place_of(*contact) + out * lift);
}

template <class Real>
void ride_on_face(const Upkeep<Real>& upkeep, uint32_t n, bool saw_before, fdcg_contact* contact) {
  Vec3<double> old_point[3], point[3];
  bool has_moved = !saw_before;
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t c = upkeep.node(n).sides[k].corner;
    old_point[k] = widen(saw_before ? upkeep.old_point(c) : upkeep.point(c));
    point[k] = widen(upkeep.point(c));
    has_moved = has_moved || upkeep.has_moved(c);
  }
  if (!has_moved) return;
  place_god_object<Real>(contact, point_at(foot_in(old_point, place_of(*contact)), point));
  if (__builtin_expect(is_line<Real>(point[0], point[1], point[2], upkeep.deform().header.extent), false))
    step_off_line(upkeep, n, contact);
}

// Where it was on its triangle, edge or corner it still is. One that was seated on a rim or in a corner stays there.
template <class Real>
void ride(const Upkeep<Real>& upkeep, bool saw_before, fdcg_contact* contact) {
  Feature on = {contact->state, contact->feature};
  const Feature seat = {internals_of(*contact).seat_state, internals_of(*contact).seat_feature};
  if (on.state == FDCG_FACE && is_on_rim(upkeep, on.index, seat)) on = seat;
  if (on.state == FDCG_EDGE && seat.state == FDCG_VERTEX && is_end(upkeep, on.index, seat.index)) on = seat;
  if (on.state == FDCG_FACE) {
    ride_on_face(upkeep, on.index, saw_before, contact);
  } else if (on.state == FDCG_EDGE) {
    ride_on_edge(upkeep, on.index, saw_before, contact);
  } else {
    place_god_object<Real>(contact, widen(upkeep.point(on.index)));
  }
}

// No face stays on a line: a god-object on a triangle without area goes on to the rim, where it is.
template <class Real>
void leave_sliver(const Upkeep<Real>& upkeep, fdcg_contact* contact) {
  if (contact->state != FDCG_FACE || !upkeep.is_sliver(contact->feature)) return;
  const fdcg_side& side = upkeep.node(contact->feature).sides[upkeep.longest_side(contact->feature)];
  const uint32_t connection = side.link >> 1;
  Vec3<double> end[2];
  ends_of(upkeep, connection, false, end);
  const double share = share_along(end, place_of(*contact));
  contact->state = internals_of(*contact).seat_state = FDCG_EDGE;
  contact->feature = internals_of(*contact).seat_feature = connection;
  place_god_object<Real>(contact, point_along(end, share));
}

// What is left of a clear ball when no face has come nearer than `travel`. False: the god-object is not in it any more.
inline bool keep_ball(double travel, fdcg_contact* contact) {
  ClearBall& ball = internals_of(*contact).clear_ball;
  constexpr double kKept = 1 - 16 * RealLimits<double>::kEpsilon;
  const double radius = ball.radius2 > 0 ? root(ball.radius2) * kKept - travel : 0;
  const Vec3<double> gap = place_of(*contact) - vec(ball.centre);
  ball.radius2 = radius > 0 && dot(gap, gap) < radius * radius ? radius * radius : 0;
  return ball.radius2 > 0;
}

// What a contact's clear ball, if it still has one, excludes since its last step: nothing, that a face has reached the
// god-object, or that one has reached the way from it to the HIP (not tested where `hip` is null).
enum class Clear { no, at_god_object, all_the_way };
template <class Real>
Clear clear_of_faces(const Upkeep<Real>& upkeep, double travel, const Vec3<double>* hip, fdcg_deform_contact* contact) {
  const ClearBall& ball = internals_of(contact->contact).clear_ball;
  if (!upkeep.deform().watched.holds(contact->ball, ball) && !keep_ball(travel, &contact->contact)) return Clear::no;
  return hip != nullptr && is_in_clear_ball(ball, *hip) ? Clear::all_the_way : Clear::at_god_object;
}

inline void seat_on(uint32_t n, fdcg_contact* contact) {
  contact->state = FDCG_FACE;
  contact->feature = n;
  contact->slipping = 0;
  ContactInternals& inner = internals_of(*contact);
  inner.seat_state = FDCG_FREE;
  inner.seat_feature = FDCG_NONE;
  inner.slip_m_per_s = inner.stiffness_n_per_m = 0;
}

// A sweep that ran out of work restarts, on the present mesh, and goes half as far (shorten): from the feature that the
// god-object left, if it is still there. From free space it would meet that feature first and search its surroundings twice.
// Returns whether it went back to a feature.
inline bool begin_sweep_anew(fdcg_deform_contact* contact) {
  constexpr uint32_t kMostHalvings = 24;
  CarriedSweep& sweep = internals_of(contact->contact).sweep;
  if (sweep.is_carried == 0) {
    if (contact->halvings > 0) --contact->halvings;
    return false;
  }
  if (contact->halvings < kMostHalvings) ++contact->halvings;
  sweep.is_carried = 0;
  if (sweep.left_state == FDCG_FREE) return false;
  contact->contact.state = sweep.left_state;
  contact->contact.feature = sweep.left_feature;
  return true;
}

// A contact in free space. Returns whether a face has passed over it.
template <class Real>
bool wait_for_faces(const Upkeep<Real>& upkeep, double travel, bool saw_before, const Vec3<double>* hip,
                    fdcg_deform_contact* waiting) {
  fdcg_contact* const contact = &waiting->contact;
  const Clear clear = clear_of_faces(upkeep, travel, hip, waiting);
  bool is_in_box = false;  // then there is no quiet ball around it: not looked for
  if (clear == Clear::no && saw_before) {
    const Catch caught = catch_of(upkeep, narrow<Real>(contact->god_object));
    if (caught.node != FDCG_NONE) {
      seat_on(caught.node, contact);
      place_god_object<Real>(contact, caught.place);
      return true;
    }
    is_in_box = caught.is_in_box;
  }
  if (clear == Clear::all_the_way || (hip != nullptr && !is_in_box && find_quiet_ball(upkeep, *hip, waiting)))
    waiting->halvings = 0;
  return false;
}

// The motion of the present tick. Returns what it adds to the result's flags.
template <class Real>
[[gnu::noinline]] uint32_t take_part(const Upkeep<Real>& upkeep, const fdcg_params& params, const double hip_object_m[3],
                                     fdcg_deform_contact* contact) {
  const fdcg_deform& deform = upkeep.deform();
  const bool is_started = contact->contact.started != 0, saw_before = contact->tick + 1 == deform.tick;
  const double travel = (deform.travel - contact->travel) * (1 + 4 * RealLimits<double>::kEpsilon) +
                        4 * RealLimits<double>::kEpsilon * deform.travel;
  contact->tick = deform.tick;
  contact->travel = deform.travel;
  if (!is_started) return 0;
  uint32_t flags = saw_before ? 0 : FDCG_DEFORM_MISSED;
  if (contact->contact.state != FDCG_FREE) {
    ride(upkeep, saw_before, &contact->contact);
  } else {
    Vec3<double> hip;
    const bool looks_for_balls = (params.disabled_optimizations & FDCG_STEP_OPT_CLEAR_BALL) == 0 &&
                                 to_local(deform.header, hip_object_m, RealLimits<Real>::kFar, &hip);
    if (wait_for_faces(upkeep, travel, saw_before, looks_for_balls ? &hip : nullptr, contact)) flags |= FDCG_DEFORM_CAUGHT;
  }
  return flags;
}

// What was moved since the last step is the motion of a new tick.
template <class Real>
[[gnu::noinline]] void begin_tick(const Upkeep<Real>& upkeep) {
  fdcg_deform& deform = upkeep.deform();
  deform.has_moved = 0;
  deform.tick_travel = root(deform.way2) * (1 + 0x1p-20);
  deform.travel += deform.tick_travel;
  deform.way2 = 0;
  ++deform.tick;
}

// Where to, on the way to the HIP: a sweep that ran out of work on a mesh that moves all the time would begin anew for ever,
// and takes shorter ways until one can be looked at within a tick.
inline void shorten(const fdcg_header& header, const fdcg_deform_contact& contact, const double hip_object_m[3],
                    double (&to)[3]) {
  const double share = 1 / static_cast<double>(uint32_t{1} << contact.halvings);
  for (int k = 0; k < 3; ++k) {
    const double from = (contact.contact.god_object[k] + header.origin[k]) * header.metres_per_unit;
    to[k] = from + (hip_object_m[k] - from) * share;
  }
}

// A step to a HIP nearer than the hand's; the hand's HIP is stored in the contact afterwards.
template <class Real>
[[gnu::noinline, gnu::cold]] void step_part_way(const fdcg_deform& deform, const fdcg_params& params,
                                                fdcg_deform_contact* contact, const double hip_object_m[3],
                                                fdcg_result* result) {
  double to[3], before[3];
  shorten(deform.header, *contact, hip_object_m, to);
  memcpy(before, contact->contact.hip, sizeof before);
  step<DeformableGeometry<Real>>(deform.graph, params, &contact->contact, to, result);
  Vec3<double> hip;
  if (contact->contact.state != FDCG_FREE) {  // the step to the hand's HIP follows
    memcpy(contact->contact.hip, before, sizeof before);
  } else if (to_local(deform.header, hip_object_m, RealLimits<Real>::kFar, &hip)) {
    store(hip, contact->contact.hip);
  }
}

template <class Real>
void step_on(fdcg_deform* deform, const fdcg_params& params, fdcg_deform_contact* contact, const double hip_object_m[3],
             fdcg_result* result) {
  const Upkeep<Real> upkeep(*deform);
  deform->upkeep_left = kUpkeepWork;
  if (deform->has_moved != 0) begin_tick(upkeep);
  uint32_t flags = 0;
  bool begins_anew = false;
  if (contact->tick != deform->tick) {
    begins_anew = begin_sweep_anew(contact);
    flags = take_part(upkeep, params, hip_object_m, contact);
  }
  if (contact->contact.state == FDCG_FACE) leave_sliver(upkeep, &contact->contact);
  if (contact->contact.state != FDCG_FREE && !begins_anew) contact->halvings = 0;
  if (contact->halvings > 0) {
    step_part_way<Real>(*deform, params, contact, hip_object_m, result);
    if (contact->contact.state == FDCG_FREE) flags |= FDCG_RESULT_SWEEP_BOUND;
  }
  if ((flags & FDCG_RESULT_SWEEP_BOUND) == 0) {
    contact->halvings = 0;
    step<DeformableGeometry<Real>>(deform->graph, params, &contact->contact, hip_object_m, result);
  }
  if (contact->contact.state == FDCG_FACE && upkeep.is_sliver(contact->contact.feature)) {
    leave_sliver(upkeep, &contact->contact);
    write_position(deform->header, contact->contact, result);
  }
  result->flags |= flags;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_deform_step(fdcg_deform* deform, const fdcg_params* params, fdcg_deform_contact* contact,
                                 const double hip_object_m[3], fdcg_result* result) {
  fdcg_params room;
  params = fdcg::admitted(fdcg::deformable_mark_of(deform->header), *params, &room, &contact->contact, result);
  if (params == nullptr) return;
  fdcg::with_real_of(deform->header,
                     [&](auto real) { fdcg::step_on<decltype(real)>(deform, *params, contact, hip_object_m, result); });
}
