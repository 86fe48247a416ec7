// SPDX-License-Identifier: Apache-2.0
// A scene's tick: take in poses (scene_advance.cpp), and for each finger find out which objects it can have met, and step those
// contacts.
//
//   out of reach     the motion of the finger since its last broad-phase update, plus the largest motion of an object, is less
//                    than the distance found then: nothing to do
//   look             broad-phase update: the distance to every object; the near ones get the finger's free slots
//   near             the tick's way may have touched its sphere and box: fdcg_step or its like, in the object's frame
//   touched          fdcg_step
//
// Which contacts are stepped depends only on the positions of this tick and the last, never on the time of the last broad-phase
// update, so the optimizations do not change any force. The state of a free contact is only the HIP's last position in the
// object's frame (contact-model FREE-1), so it can be created again at any time.
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

// After as many steps in which it reached none of its near objects, the finger updates its broad phase.
constexpr uint32_t kIdleSteps = 64;

}  // namespace

fdcg_params params_met(const Object& object, const Finger& finger) {
  fdcg_params params = object.params;
  constexpr uint32_t kMixedInTheStep = FDCG_FRICTION_MATERIALS | FDCG_FRICTION_FINGER;
  if (finger.has_material != 0 && object.graph() != nullptr && (params.friction_flags & kMixedInTheStep) != 0) {
    params.finger = finger.material;
    params.friction_flags |= FDCG_FRICTION_FINGER;
  } else if (finger.has_material != 0) {
    const fdcg_material own = {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
    const fdcg_material both = fdcg_combine_materials(&own, &finger.material);
    params.mu_static = both.mu_static;
    params.mu_dynamic = both.mu_dynamic;
    params.stiffness_n_per_m = both.stiffness_n_per_m;
  }
  measure_in_object(object.now.scale, &params);
  return params;
}

namespace {

// Whether no object without a slot can have been touched since the last broad-phase update.
inline bool is_out_of_reach(const fdcg_scene& scene, const Finger& finger, World hip) {
  const double left = finger.limit - scene.travel - 4 * RealLimits<double>::kEpsilon * scene.travel;
  const World way = hip - finger.anchor;
  return left > 0 && dot(way, way) < left * left * kHoldBack && finger.look == scene.look;
}

// ---- stepping
// ----------------------------------------------------------------------------------------------------------------

void step_contact(const Object& object, const Finger& finger, fdcg_contact* contact, World at, fdcg_result* result) {
  fdcg_params room;
  const fdcg_params* params = &object.params;
  if ((finger.has_material | params->friction_flags) != 0) {
    room = params_met(object, finger);
    params = &room;
  }
  step_object(object, params, contact, at, result);
}

// Whether the contact with a near object is created again at the start of the tick's way. A contact with a deformable mesh also
// tracks the mesh's motion since its last step: it is kept as long as every step of the finger has stepped it, from the first
// on (deform_scene.cpp). A new one starts outside of all places where the mesh can be.
bool is_renewed(const Tick& tick, const Object& object, const Slot& slot, bool missed) {
  if (slot.step != tick.finger.step) return true;
  return object.deform == nullptr && (missed || !tick.scene.skips(FDCG_OPT_RENEWAL));
}

void renew(const Object& object, fdcg_contact* contact) {
  if (object.deform != nullptr) {
    *reinterpret_cast<fdcg_deform_contact*>(contact) = {};
  } else {
    *contact = {};
  }
}

// Steps the slot's contact. Returns whether there is a contact force or a sweep to carry over.
bool step_slot(const Tick& tick, Slot& slot, fdcg_contact* contact, bool missed, fdcg_result* result) {
  const fdcg_scene& scene = tick.scene;
  const Object& object = scene.objects()[slot.object];
  LocalWay way;
  if (slot.is_held != 0) {
    way.to = object.now.to_object(tick.hip, scene.skips(FDCG_OPT_ROTATION));
  } else {
    if (!can_have_met(tick, object, &way)) return false;
    if (is_renewed(tick, object, slot, missed)) {
      renew(object, contact);
      step_contact(object, tick.finger, contact, way.from, result);
    }
  }
  tick.finger.idle_steps = 0;
  slot.step = tick.finger.step + 1;
  if (scene.step_soft == nullptr) {
    step_contact(object, tick.finger, contact, way.to, result);
  } else {
    const auto finger = static_cast<uint32_t>(&tick.finger - scene.fingers());
    const auto index = static_cast<uint32_t>(&slot - tick.slots);
    scene.step_soft(&tick.scene, finger, index, {slot.object, object.generation}, contact, way.to, result);
  }
  const bool has_swept = norm1(vec(contact->god_object) - vec(contact->hip)) == 0;
  slot.is_held = result->state != FDCG_FREE || (result->flags & FDCG_RESULT_SWEEP_BOUND) != 0 || !has_swept;
  return slot.is_held != 0;
}

fdcg_touch touch_of(const fdcg_scene& scene, uint32_t index, const fdcg_result& result) {
  const Object& object = scene.objects()[index];
  const bool may_skip = scene.skips(FDCG_OPT_ROTATION);
  fdcg_touch touch = {};
  touch.object = {index, object.generation};
  store(object.now.turned_to_world(vec(result.force_n), may_skip), touch.force_n);
  store(object.now.to_world(vec(result.god_object_m), may_skip), touch.god_object_m);
  touch.state = result.state;
  touch.feature = result.feature;
  touch.slipping = result.slipping;
  touch.transitions = result.transitions;
  touch.flags = result.flags;
  return touch;
}

void step_slots(const Tick& tick, bool missed, bool is_felt) {
  fdcg_scene& scene = tick.scene;
  Finger& finger = tick.finger;
  if (++finger.idle_steps >= kIdleSteps + (own_bits(scene, finger) & (kIdleSteps - 1))) finger.limit = -HUGE_VAL;
  const auto index = static_cast<uint32_t>(&finger - scene.fingers());
  fdcg_contact* contact = scene.first_contact(index);
  fdcg_touch* const touches = scene.touches(index);
  constexpr uint32_t kCarriedOver = FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND;
  for (uint32_t s = 0; s < scene.config.touches_per_finger;
       ++s, contact = part_at<fdcg_contact>(contact, scene.contact_bytes)) {
    Slot& slot = tick.slots[s];
    fdcg_result result;
    if (slot.object == FDCG_NONE || !step_slot(tick, slot, contact, missed, &result)) continue;
    if (!is_felt) store(World{0, 0, 0}, result.force_n);
    if ((result.flags & kCarriedOver) != 0) finger.flags |= FDCG_FINGER_BOUNDED;
    uint32_t place = finger.touch_count++;
    for (; place > 0 && touches[place - 1].object.index > slot.object; --place)
      touches[place] = touches[place - 1];
    touches[place] = touch_of(scene, slot.object, result);
  }
  World force = {0, 0, 0};
  for (uint32_t i = 0; i < finger.touch_count; ++i)
    force = force + vec(touches[i].force_n);
  finger.force = force;
}

// The tick of a finger that is in reach of an object or has slots in use.
[[gnu::noinline]] void step_near(fdcg_scene& scene, Finger& finger) {
  const auto index = static_cast<uint32_t>(&finger - scene.fingers());
  const bool is_felt = is_place(finger.hip);
  finger.flags = is_felt ? 0 : uint32_t{FDCG_FINGER_NON_FINITE};
  finger.non_finite_steps += is_felt ? 0 : 1;
  finger.touch_count = 0;
  finger.force = {0, 0, 0};
  if (finger.is_started == 0) {
    if (!is_felt) return;
    finger.is_started = 1;
    finger.last = finger.hip;
    finger.tick = scene.tick;
    if (scene.start_on_deforms != nullptr) scene.start_on_deforms(scene, finger);
    return;
  }
  const Tick tick = {scene, finger, scene.slots(index), is_felt ? finger.hip : finger.last, finger.tick == scene.tick};
  const uint32_t missed = tick.is_second ? 0 : scene.tick - finger.tick - 1;
  if (missed > 0) finger.flags |= FDCG_FINGER_MISSED_TICK;
  finger.missed_ticks += missed;
  if (!is_out_of_reach(scene, finger, tick.hip) || !scene.skips(FDCG_OPT_OUT_OF_REACH)) look(tick);
  if (finger.busy > 0) step_slots(tick, missed > 0, is_felt);
  finger.last = tick.hip;
  finger.tick = scene.tick;
  ++finger.step;
}

inline void step_finger(fdcg_scene& scene, Finger& finger) {
  const bool is_in_step = scene.tick - finger.tick <= 1 && finger.is_started != 0 && finger.flags == 0;
  if (finger.busy == 0 && is_in_step && is_out_of_reach(scene, finger, finger.hip) && scene.skips(FDCG_OPT_OUT_OF_REACH)) {
    finger.last = finger.hip;
    finger.tick = scene.tick;
    ++finger.step;
    return;
  }
  step_near(scene, finger);
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_scene_step(fdcg_scene* scene) {
  if (scene == nullptr) return;
  fdcg_scene_advance(scene);
  fdcg::Finger* const fingers = scene->fingers();
  for (uint32_t i = 0; i < scene->finger_end; ++i) {
    if (fingers[i].is_used != 0) fdcg::step_finger(*scene, fingers[i]);
  }
}

extern "C" fdcg_status fdcg_scene_step_finger(fdcg_scene* scene, fdcg_finger_id id, fdcg_error* error) {
  fdcg::Finger* const finger = fdcg::find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  fdcg::settle_place(scene);
  fdcg::step_finger(*scene, *finger);
  return FDCG_OK;
}
