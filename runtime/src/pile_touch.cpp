// SPDX-License-Identifier: Apache-2.0
// One touch of a pile: the god-object's step, and the spring between it and the point.
#include "friction.hpp"
#include "pile_memory.hpp"
#include "scene_tick.hpp"
#include "struct_bytes.hpp"

namespace fdcg {
namespace {

// Times the step squared and how easily the place moves, over all three directions: what stability can bear is 4 for all
// springs that pull in one way, so 32 of them may.
constexpr double kMostStiffness = 0.125;

// Where the god-object and the spring are, and along what the load is measured.
void place(PileTouch* touch, World god_object, World point, World normal, bool has_normal) {
  const World spring = god_object - point;
  const double length = norm(spring);
  touch->god_object = god_object;
  touch->has_normal = has_normal || length > 0;
  touch->normal = has_normal ? normal : (length > 0 ? spring * (1 / length) : World{0, 0, 0});
}

// The spring between god-object and point. `pair` is what acts between the two: mu_static and stiffness are asked.
void press(const Meeting& meeting, const PileMember& owner, World point, const fdcg_material& pair, bool was_pressing,
           PileTouch* touch) {
  if (!was_pressing) {
    const PileMember* const other = touch->on == kGround ? nullptr : meeting.pile.members() + touch->on;
    double looseness = looseness_at(&owner, other, touch->god_object);
    // asleep: as a cube's corner
    if (looseness == 0) looseness = 12 / meeting.bodies[owner.body].body.config.mass_kg;
    const double most = kMostStiffness / (looseness * meeting.step_s * meeting.step_s);
    touch->stiffness_n_per_m = pair.stiffness_n_per_m < most ? pair.stiffness_n_per_m : most;
  }
  touch->mu_static = pair.mu_static;
  touch->force_n = (touch->god_object - point) * touch->stiffness_n_per_m;
  touch->load_n = dot(touch->force_n, touch->normal);
}

fdcg_material material_of(const fdcg_params& params) {
  return {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
}

// The rules of contact-model sections 4 and 5 on one plane that has no edge.
bool step_on_ground(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch) {
  const fdcg_pile& pile = meeting.pile;
  fdcg_contact& contact = touch->contact;
  const bool was_pressing = !is_new && touch->is_pressing != 0;
  const World n = pile.ground_normal;
  const double depth = pile.ground_offset_m - dot(n, way.to);
  const fdcg_material own = material_of(meeting.object(owner).params), ground = material_of(pile.ground_params);
  const fdcg_material pair = fdcg_combine_materials(&own, &ground);
  World god_object = was_pressing ? vec(contact.god_object) : way.to;
  if (!(depth > 0)) return false;
  if (!was_pressing) {
    contact = {};
    const double before = pile.ground_offset_m - dot(n, way.from);
    // the point of entry; what began below it begins straight above
    god_object = before <= 0 ? way.from + (way.to - way.from) * (before / (before - depth)) : way.to + n * depth;
  }
  const World surface_point = way.to + n * depth, off = god_object - surface_point;
  const World gap = off - n * dot(off, n);
  Friction<double> friction = {pair.mu_static, pair.mu_dynamic, true, contact.slipping != 0};
  const double gap2 = dot(gap, gap);
  const Slip<double> slip = friction.slip(god_object, gap2, depth);
  if (!slip.is_rest) god_object = surface_point + gap * (slip.gap / root(gap2));
  put(god_object, contact.god_object);
  contact.state = FDCG_FACE;
  contact.slipping = friction.is_slipping ? 1 : 0;
  touch->is_pressing = 1;
  place(touch, god_object, way.to, n, true);
  press(meeting, owner, way.to, pair, was_pressing, touch);
  return true;
}

// What the step is told. Where faces have materials it mixes them itself, as with a finger of the point's material.
fdcg_params pair_params(const Meeting& meeting, const Object& on, const fdcg_material& own) {
  fdcg_params params = on.params;
  const fdcg_material whole = material_of(on.params), pair = fdcg_combine_materials(&whole, &own);
  params.damping_n_s_per_m = 0;  // the force is this file's affair
  params.tick_s = meeting.step_s;
  params.terms &= ~uint32_t{FDCG_TERM_FINGER};
  measure_in_object(on.now.scale, &params);
  if ((params.terms & FDCG_TERM_MATERIALS) != 0 && on.graph != nullptr) {
    params.terms |= FDCG_TERM_FINGER;
    params.finger = own;
    return params;
  }
  params.mu_static = pair.mu_static;
  params.mu_dynamic = pair.mu_dynamic;
  params.stiffness_n_per_m = pair.stiffness_n_per_m;
  return params;
}

// Of the face that was met, where faces have materials.
fdcg_material pair_at(const Object& on, const fdcg_material& own, const fdcg_result& result) {
  fdcg_material face = material_of(on.params);
  if ((on.params.terms & FDCG_TERM_MATERIALS) != 0 && on.graph != nullptr && on.graph->node_materials != nullptr &&
      result.state == FDCG_FACE) {
    const uint32_t material = on.graph->node_materials[result.feature];
    if (material < on.params.material_count) face = on.params.materials[material];
  }
  return fdcg_combine_materials(&face, &own);
}

World turned(const Pose& pose, World v) {
  return {dot(pose.row[0], v), dot(pose.row[1], v), dot(pose.row[2], v)};
}

// World, unit; zero where the object says none: on a graph's edges and corners.
World normal_at(const Object& on, const fdcg_result& result) {
  double normal[3] = {0, 0, 0};
  if (on.shape_normal != nullptr) {
    on.shape_normal(on, &result, normal);
    return turned(on.now, vec(normal));
  }
  if (result.state != FDCG_FACE) return {0, 0, 0};
  return turned(on.now, vec(fdcg_get_node(on.graph, result.feature).normal));
}

bool step_on_object(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch) {
  const Object& on = meeting.object(meeting.pile.members()[touch->on]);
  const fdcg_material own = material_of(meeting.object(owner).params);
  const fdcg_params params = pair_params(meeting, on, own);
  const bool may_skip = meeting.scene.skips(FDCG_SKIP_ROTATION);
  const bool was_pressing = !is_new && touch->is_pressing != 0;
  fdcg_contact& contact = touch->contact;
  fdcg_result result;
  World from, to;
  if (is_new) {
    if (!can_have_met(meeting, on, way.from, way.to, &from, &to)) return false;
    contact = {};
    step_object(on, &params, &contact, from, &result);
  }
  to = on.now.to_object(way.to, may_skip);
  step_object(on, &params, &contact, to, &result);
  touch->is_pressing = result.state != FDCG_FREE ? 1 : 0;
  touch->force_n = touch->damper_n = {0, 0, 0};
  touch->load_n = 0;
  if (touch->is_pressing == 0) {
    return (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0 || can_have_met(meeting, on, way.from, way.to, &from, &to);
  }
  const World spring = on.now.turned_to_world(vec(result.god_object_m) - to, may_skip), normal = normal_at(on, result);
  place(touch, way.to + spring, way.to, normal, norm1(normal) > 0);
  press(meeting, owner, way.to, pair_at(on, own, result), was_pressing, touch);
  return true;
}

}  // namespace

bool step_touch(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch) {
  ++meeting.pile.counts.steps;
  return touch->on == kGround ? step_on_ground(meeting, owner, way, is_new, touch)
                              : step_on_object(meeting, owner, way, is_new, touch);
}

}  // namespace fdcg
