// SPDX-License-Identifier: Apache-2.0
// A pile's tick. In each substep: the fingers; the poses of all members; for every body its neighbours; for its points,
// god-objects and springs; the dampers, one after the other; then the bodies move.
#include "base/message.hpp"
#include "body/body_scene.hpp"
#include "body/pile_memory.hpp"
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

bool is_same(const Pose& a, const Pose& b) {
  for (int k = 0; k < 3; ++k) {
    if (norm1(a.row[k] - b.row[k]) != 0) return false;
  }
  return norm1(a.translation - b.translation) == 0 && a.scale == b.scale;
}

// The most that a unit vector moves: by no more than the rotation's change in the Frobenius norm over the root of 2.
double turn_between(const Pose& from, const Pose& to) {
  double turned2 = 0;
  for (int k = 0; k < 3; ++k) {
    const World change = to.row[k] - from.row[k];
    turned2 += dot(change, change);
  }
  return root(0.5 * turned2) * (1 + 0x1p-20);
}

void find_bodies(fdcg_pile& pile, const fdcg_scene_body* bodies, uint32_t body_count) {
  for (uint32_t m = 0; m < pile.member_end; ++m)
    pile.members()[m].body = FDCG_NONE;
  for (uint32_t i = 0; i < body_count; ++i) {
    const fdcg_object_id id = bodies[i].object;
    if (id.index >= pile.member_end) continue;
    PileMember& member = pile.members()[id.index];
    if (member.is_used != 0 && member.object.generation == id.generation) member.body = i;
  }
}

// The data of a moving body that the dampers use.
void set_motion(const fdcg_body& body, PileMember* member) {
  const Matrix rotation = rotation_of(body.rotation_xyzw), own = inverse_of(tensor_of(body.config.inertia_kg_m2));
  for (int k = 0; k < 3; ++k)  // symmetrical: rows are columns
    member->inverse_inertia.row[k] = rotation * (own * rotation.row[k]);
  member->lightness_per_kg = 1 / body.config.mass_kg;
  member->velocity_m_per_s = vec(body.velocity_m_per_s);
  member->spin_rad_per_s = member->inverse_inertia * vec(body.angular_momentum);
  member->kick_n_m_s = {0, 0, 0};
}

// The poses and velocities of all members in this substep.
void begin(const Meeting& meeting) {
  fdcg_pile& pile = meeting.pile;
  if (pile.scene_look != meeting.scene.look) ++pile.look;
  pile.scene_look = meeting.scene.look;
  double farthest_moved = 0;
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    PileMember& member = pile.members()[m];
    if (member.is_used == 0) continue;
    const Object& object = meeting.object(member);
    if (object.is_used == 0 || object.generation != member.object.generation) {
      leave_pile(pile, m);
      continue;
    }
    if (object.is_enabled == 0 && member.is_enabled != 0) let_go(pile, m);
    member.is_enabled = object.is_enabled;
    const bool has_moved = object.is_changing != 0 && !is_same(object.now, object.last);
    member.is_moving = has_moved || member.seen_look != pile.look ? 1 : 0;
    member.seen_look = pile.look;
    member.move_m = has_moved ? norm(object.now.centre - object.last.centre) : 0;
    member.turn = has_moved ? turn_between(object.last, object.now) : 0;
    farthest_moved = larger(farthest_moved, member.move_m);
    if (object.bounds.is_endless && member.turn > 0) ++pile.look;  // a rotation moves its points without bound
    member.is_awake = member.has_touched = 0;
    if (member.body == FDCG_NONE) continue;
    const fdcg_body& body = meeting.bodies[member.body].body;
    member.force_n = member.torque_n_m = {0, 0, 0};
    member.centre_m = vec(body.centre_m);
    member.is_awake = body.is_asleep == 0 ? 1 : 0;
    if (member.is_awake != 0) set_motion(body, &member);
  }
  pile.travel_m = (pile.travel_m + farthest_moved) * (1 + 2 * DBL_EPSILON);
}

// Whether the contact of the two can have changed since the last substep.
bool is_awake(const fdcg_pile& pile, const PileMember& member) {
  return member.is_moving != 0 || !pile.skips(FDCG_PILE_OPT_STILL);
}
bool is_awake(const fdcg_pile& pile, const PileMember& member, uint32_t on) {
  return is_awake(pile, member) || (on != kGround && pile.members()[on].is_moving != 0);
}

bool has_touch(const fdcg_pile& pile, const PilePoint& point, uint32_t on) {
  for (uint32_t t = point.touch; t != FDCG_NONE; t = pile.touches()[t].next) {
    if (pile.touches()[t].on == on) return true;
  }
  return false;
}

// Starts a touch from the free list if the point's way in this step meets the object.
void try_new_touch(const Meeting& meeting, PileMember* owner, PilePoint* point, const PointWay& way, uint32_t on) {
  fdcg_pile& pile = meeting.pile;
  const uint32_t index = pile.free_touch;
  PileTouch room;
  PileTouch& touch = index != FDCG_NONE ? pile.touches()[index] : room;
  const uint32_t next_free = index != FDCG_NONE ? touch.next : FDCG_NONE;
  touch = {};
  touch.on = on;
  const bool meets = step_touch(meeting, *owner, way, true, &touch);
  if (meets && index == FDCG_NONE) ++pile.counts.overflowed_contacts;
  if (!meets || index == FDCG_NONE) {
    touch.next = next_free;
    return;
  }
  pile.free_touch = next_free;
  touch.next = point->touch;
  point->touch = index;
  ++owner->touch_count;
}

// Steps the point's touches where either side has moved, and drops those that have ended.
void step_touches(const Meeting& meeting, PileMember* owner, PilePoint* point, const PointWay& way) {
  drop_touches(meeting.pile, *owner, *point, [&](PileTouch& touch) {
    return is_awake(meeting.pile, *owner, touch.on) && !step_touch(meeting, *owner, way, false, &touch);
  });
}

PointWay way_of(const Object& object, const PilePoint& point) {
  const World at = vec(point.at);
  return {object.last.to_world(at, true), object.now.to_world(at, true)};
}

void meet_ground(const Meeting& meeting, PileMember* owner) {
  fdcg_pile& pile = meeting.pile;
  const Object& object = meeting.object(*owner);
  const GroundCull cull = ground_cull_of(meeting, *owner);
  for (uint32_t p = 0; p < owner->point_count; ++p) {
    PilePoint& point = pile.points()[owner->first_point + p];
    if (!cull.may_have_met(vec(point.at)) || has_touch(pile, point, kGround)) continue;
    const PointWay way = way_of(object, point);
    if (dot(pile.ground_normal, way.to) < pile.ground_offset_m) try_new_touch(meeting, owner, &point, way, kGround);
  }
}

void meet_member(const Meeting& meeting, PileMember* owner, uint32_t on) {
  fdcg_pile& pile = meeting.pile;
  const Object& object = meeting.object(*owner);
  const Cull cull = cull_of(meeting, *owner, pile.members()[on]);
  for (uint32_t p = 0; p < owner->point_count; ++p) {
    PilePoint& point = pile.points()[owner->first_point + p];
    if (cull.may_have_met(vec(point.at)) && !has_touch(pile, point, on))
      try_new_touch(meeting, owner, &point, way_of(object, point), on);
  }
}

void step_points(const Meeting& meeting, PileMember* owner, bool is_near_ground) {
  fdcg_pile& pile = meeting.pile;
  const Object& object = meeting.object(*owner);
  for (uint32_t p = 0; p < owner->point_count && owner->touch_count > 0; ++p) {
    PilePoint& point = pile.points()[owner->first_point + p];
    if (point.touch != FDCG_NONE) step_touches(meeting, owner, &point, way_of(object, point));
  }
  if (is_near_ground && is_awake(pile, *owner)) meet_ground(meeting, owner);
  const bool asks_all = owner->near_count > PileMember::kMostNear;
  const uint32_t near_count = asks_all ? pile.member_end : owner->near_count;
  for (uint32_t i = 0; i < near_count; ++i) {
    const uint32_t on = asks_all ? i : owner->near[i];
    const PileMember& other = pile.members()[on];
    if (&other == owner || other.is_used == 0 || other.is_enabled == 0) continue;
    if (is_awake(pile, *owner, on)) meet_member(meeting, owner, on);
  }
}

bool is_near_ground(const Meeting& meeting, const PileMember& member) {
  const fdcg_pile& pile = meeting.pile;
  if (pile.has_ground == 0) return false;
  const Pose& now = meeting.object(member).now;
  const double above = dot(pile.ground_normal, now.centre) - pile.ground_offset_m;
  return above <= member.radius_m * now.scale + 64 * DBL_EPSILON * (norm1(now.centre) + absolute(pile.ground_offset_m));
}

// A member without a body is not moved by touches: its points are not stepped.
bool has_points_to_step(const PileMember& member) {
  return member.is_used != 0 && member.is_enabled != 0 && member.body != FDCG_NONE && member.point_count > 0;
}

// Whether the member, a neighbour or a member that it touches is awake.
bool has_to_step(fdcg_pile& pile, PileMember* member, bool is_near_ground) {
  if (member->near_count == 0 && !is_near_ground && member->touch_count == 0) return false;
  if (is_awake(pile, *member) || member->near_count > PileMember::kMostNear) return true;
  bool has = false;
  for (uint32_t i = 0; i < member->near_count; ++i)
    has = has || pile.members()[member->near[i]].is_moving != 0;
  for_each_touch(pile, member, [&](PileTouch* touch) { has = has || is_awake(pile, *member, touch->on); });
  return has;
}

void add_push(PileMember* to, World at, World force) {
  if (to == nullptr || to->body == FDCG_NONE) return;
  to->force_n = to->force_n + force;
  to->torque_n_m = to->torque_n_m + cross(at - to->centre_m, force);
}

void meet(const Meeting& meeting) {
  fdcg_pile& pile = meeting.pile;
  begin(meeting);
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    if (has_points_to_step(pile.members()[m])) judge_patches(pile, pile.members() + m);
  }
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    PileMember& member = pile.members()[m];
    if (!has_points_to_step(member)) continue;
    find_near(meeting, &member);
    const bool near_ground = is_near_ground(meeting, member);
    if (has_to_step(pile, &member, near_ground)) step_points(meeting, &member, near_ground);
    for_each_touch(pile, &member, [&](PileTouch* touch) {
      if (touch->is_pressing == 0) return;
      add_push(&member, touch->god_object, touch->force_n);
      add_push(touch->on == kGround ? nullptr : pile.members() + touch->on, touch->god_object, touch->force_n * -1.0);
    });
  }
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    PileMember& member = pile.members()[m];
    if (!has_points_to_step(member)) continue;
    for_each_touch(pile, &member, [&](PileTouch* touch) { damp_touch(meeting, &member, touch); });
  }
}

// Applies the dampers' impulses to the bodies.
void take_motion(const PileMember& member, fdcg_body* body) {
  if (member.has_touched == 0) return;
  put(member.velocity_m_per_s, body->velocity_m_per_s);
  put(vec(body->angular_momentum) + member.kick_n_m_s, body->angular_momentum);
}

fdcg_status move_all(const Meeting& meeting, uint32_t body_count, const fdcg_reaction* reactions, fdcg_error* error) {
  fdcg_status status = FDCG_OK;
  for (uint32_t i = 0; status == FDCG_OK && i < body_count; ++i) {
    fdcg_scene_body& body = meeting.bodies[i];
    fdcg_reaction push = about_centre(body.body, reactions[body.object.index]);
    const PileMember* const member =
        body.object.index < meeting.pile.member_end ? meeting.pile.members() + body.object.index : nullptr;
    if (member != nullptr && member->is_used != 0 && member->body == i) {
      take_motion(*member, &body.body);
      put(vec(push.force_n) + member->force_n, push.force_n);
      put(vec(push.torque_n_m) + member->torque_n_m, push.torque_n_m);
    }
    status = move_body(&meeting.scene, &body, push, meeting.step_s, error);
  }
  return status;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_step_pile(fdcg_scene* scene, fdcg_pile* pile, fdcg_scene_body* bodies, uint32_t body_count,
                                            uint32_t substeps, double tick_s, fdcg_reaction* reactions, uint32_t reaction_count,
                                            fdcg_error* error) {
  using namespace fdcg;
  if (pile == nullptr) return Message(error, FDCG_E_ARGUMENT).text("pile: null pointer");
  fdcg_status status = check_bodies(scene, bodies, body_count, substeps, tick_s, reactions, reaction_count, error);
  if (status != FDCG_OK) return status;
  if (pile->member_end > scene->object_end) return Message(error, FDCG_E_ARGUMENT).text("pile: not this scene's");
  find_bodies(*pile, bodies, body_count);
  const Meeting meeting = {*scene, *pile, bodies, tick_s / substeps};
  begin_ways(scene);
  for (uint32_t step = 0; status == FDCG_OK && step < substeps; ++step) {
    move_fingers(scene, step, substeps);
    fdcg_scene_step(scene);
    fdcg_scene_get_reactions(scene, reactions, reaction_count);
    meet(meeting);
    status = move_all(meeting, body_count, reactions, error);
  }
  end_ways(scene);
  return status;
}
