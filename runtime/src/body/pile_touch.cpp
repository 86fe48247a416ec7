// SPDX-License-Identifier: Apache-2.0
// One touch of a pile: the god-object's step, and the spring between it and the point.
#include "body/pile_memory.hpp"
#include "scene/finger_tick.hpp"
#include "step/contact_internals.hpp"
#include "step/friction.hpp"

namespace fdcg {
namespace {

// The god-object, the spring, and the direction of the normal load.
void place(PileTouch* touch, World god_object, World point, World normal, bool has_normal) {
  const World spring = god_object - point;
  const double length = norm(spring);
  touch->god_object = god_object;
  touch->has_normal = has_normal || length > 0;
  touch->normal = has_normal ? normal : (length > 0 ? spring * (1 / length) : World{0, 0, 0});
}

// The contact law between the two.
struct PairMaterial {
  fdcg_material material;  // only mu_static and stiffness are used
  bool follows_faces;      // it may change from step to step
};

// The spring between god-object and point.
void press(const Meeting& meeting, const PileMember& owner, World point, const PairMaterial& pair, bool was_pressing,
           PileTouch* touch) {
  if (!was_pressing) {
    const PileMember* const other = touch->on == kGround ? nullptr : meeting.pile.members() + touch->on;
    double looseness = looseness_at(&owner, other, touch->god_object);
    // asleep: as a cube's corner
    if (looseness == 0) looseness = 12 / meeting.bodies[owner.body].body.config.mass_kg;
    touch->most_stiffness = kMostPileStiffness / (looseness * meeting.step_s * meeting.step_s);
  }
  if (!was_pressing || pair.follows_faces)
    touch->stiffness_n_per_m = smaller(pair.material.stiffness_n_per_m, touch->most_stiffness);
  touch->is_softened = touch->stiffness_n_per_m < pair.material.stiffness_n_per_m ? 1 : 0;
  meeting.pile.counts.softened_steps += touch->is_softened;
  touch->mu_static = pair.material.mu_static;
  touch->force_n = (touch->god_object - point) * touch->stiffness_n_per_m;
  touch->load_n = dot(touch->force_n, touch->normal);
}

fdcg_material material_of(const fdcg_params& params) {
  return {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
}

struct GroundStep {
  World normal, god_object, surface_point;
  double depth;
};

// The god-object's position under friction.
World slide(Friction<double>& friction, const GroundStep& step) {
  const World off = step.god_object - step.surface_point, gap = off - step.normal * dot(off, step.normal);
  const double gap2 = dot(gap, gap);
  const Slip<double> slip = friction.slip(step.god_object, gap2, step.depth);
  return slip.is_rest ? step.god_object : step.surface_point + gap * (slip.gap / root(gap2));
}

#if FDCG_WITH_FRICTION_TERMS
// The same by the friction curve, as fdcg_step has it on a face.
World slide_by_curve(const Meeting& meeting, const fdcg_material& own, Friction<double>& friction, const GroundStep& step,
                     fdcg_contact* contact) {
  fdcg_params params = meeting.pile.ground_params;
  params.tick_s = meeting.step_s;
  params.friction_flags |= FDCG_FRICTION_FINGER;
  params.finger = own;
  FrictionTerms terms = terms_of(params, nullptr, *contact);
  friction.terms = &terms;
  const World to = slide(friction, step);
  terms.go_on_to(to);
  internals_of(*contact).slip_m_per_s = terms.has(FDCG_FRICTION_LAG) ? terms.lagged + terms.per_way * terms.way : 0;
  return to;
}

// The contact law where faces have materials, by the rules of the step: on an edge the faces' coefficients, weighted by load,
// and the smaller stiffness; at a corner the previous one or, if the contact begins there, that of an adjacent face. `across`:
// from the god-object to the HIP, object's frame.
fdcg_material pair_by_faces(const Object& on, const fdcg_params& params, const fdcg_result& result, World across,
                            const PileTouch& touch, bool was_pressing) {
  FrictionTerms terms = terms_of(params, on.graph(), touch.contact);
  if (result.state == FDCG_FACE) {
    terms.select_material_of_face(result.feature);
  } else if (result.state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(on.graph(), result.feature);
    const bool is_open = edge.node[1] == FDCG_NONE;
    const double share = is_open ? 1
                                 : share_of_load(vec(fdcg_get_node(on.graph(), edge.node[0]).normal),
                                                 vec(fdcg_get_node(on.graph(), edge.node[1]).normal), across);
    terms.select_material_of_edge(edge.node[0], edge.node[1], share);
  } else if (was_pressing) {
    terms.material.mu_static = touch.mu_static;
  } else {
    uint32_t entry = 0;
    fdcg_get_fan(on.graph(), result.feature, &entry, 1);
    terms.select_material_of_face(fdcg_get_connection(on.graph(), entry >> 1).node[0]);
  }
  terms.material.stiffness_n_per_m = internals_of(touch.contact).stiffness_n_per_m;
  return terms.material;
}
#endif

// The contact rules on one infinite plane: contact-model FREE-3, FACE-1 to FACE-4.
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
    // the point of entry; a contact that begins below the plane starts at its projection
    god_object = before <= 0 ? way.from + (way.to - way.from) * (before / (before - depth)) : way.to + n * depth;
  }
  const GroundStep step = {n, god_object, way.to + n * depth, depth};
  const bool holds = touch->patch == PatchFriction::holds && pile.ground_params.friction_flags == 0;
  Friction<double> friction = {{pair.mu_static, holds ? pair.mu_static : pair.mu_dynamic, true, contact.slipping != 0}};
#if FDCG_WITH_FRICTION_TERMS
  god_object =
      pile.ground_params.friction_flags != 0 ? slide_by_curve(meeting, own, friction, step, &contact) : slide(friction, step);
#else
  god_object = slide(friction, step);
#endif
  put(god_object, contact.god_object);
  contact.state = FDCG_FACE;
  contact.slipping = friction.is_slipping ? 1 : 0;
  touch->is_pressing = 1;
  place(touch, god_object, way.to, n, true);
  press(meeting, owner, way.to, {pair, false}, was_pressing, touch);
  return true;
}

// Whether the step combines the materials of faces and point.
bool mixes_itself(const fdcg_params& params, const Object& on) {
  return (params.friction_flags & FDCG_FRICTION_MATERIALS) != 0 && on.graph() != nullptr;
}

// The parameters of the step. Where faces have materials, it combines them with the point's as with a finger's material.
fdcg_params pair_params(const Meeting& meeting, const Object& on, const fdcg_material& own) {
  fdcg_params params = on.params;
  const fdcg_material whole = material_of(on.params), pair = fdcg_combine_materials(&whole, &own);
  params.damping_n_s_per_m = 0;  // damping is applied by pile_damp.cpp
  params.tick_s = meeting.step_s;
  params.friction_flags &= ~uint32_t{FDCG_FRICTION_FINGER | FDCG_FRICTION_SHADING};  // bodies lie on facets
  measure_in_object(on.now.scale, &params);
  if (mixes_itself(params, on)) {
    params.friction_flags |= FDCG_FRICTION_FINGER;
    params.finger = own;
    return params;
  }
  params.mu_static = pair.mu_static;
  params.mu_dynamic = pair.mu_dynamic;
  params.stiffness_n_per_m = pair.stiffness_n_per_m;
  return params;
}

World turned(const Pose& pose, World v) {
  return {dot(pose.row[0], v), dot(pose.row[1], v), dot(pose.row[2], v)};
}

bool step_on_object(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch) {
  const Object& on = meeting.object(meeting.pile.members()[touch->on]);
  const fdcg_material own = material_of(meeting.object(owner).params);
  fdcg_params params = pair_params(meeting, on, own);
  if (touch->patch == PatchFriction::holds && params.friction_flags == 0) params.mu_dynamic = params.mu_static;
  const bool may_skip = meeting.scene.skips(FDCG_OPT_ROTATION);
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
  const World reach = vec(result.god_object_m) - to;
  const World spring = on.now.turned_to_world(reach, may_skip), normal = turned(on.now, object_normal(on, result));
  place(touch, way.to + spring, way.to, normal, norm1(normal) > 0);
  PairMaterial pair = {{params.mu_static, params.mu_dynamic, params.stiffness_n_per_m}, mixes_itself(params, on)};
#if FDCG_WITH_FRICTION_TERMS
  if (pair.follows_faces) pair.material = pair_by_faces(on, params, result, reach * -1.0, *touch, was_pressing);
#endif
  press(meeting, owner, way.to, pair, was_pressing, touch);
  return true;
}

}  // namespace

bool step_touch(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch) {
  ++meeting.pile.counts.steps;
  return touch->on == kGround ? step_on_ground(meeting, owner, way, is_new, touch)
                              : step_on_object(meeting, owner, way, is_new, touch);
}

}  // namespace fdcg
