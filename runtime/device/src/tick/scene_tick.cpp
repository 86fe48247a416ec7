// SPDX-License-Identifier: Apache-2.0
#include "tick/scene_tick.hpp"

#include <algorithm>
#include <cmath>

#include "fdcg/soft_finger.h"

namespace fdcg::dev {
namespace {

// The targets of a device's contacts at the end of the tick, world.
struct Target {
  double place_m[kMaxContacts][3];
  double moved_m[kMaxContacts][3];  // by reliefs
  double turn_xyzw[4];
};

void contact_place(const DeviceSetup& setup, const GripState& grip, int contact, const double tip_m[3], double world_m[3]) {
  double offset_m[3], place_m[3];
  grip_offset(setup.grip, grip, contact, setup.contacts_m[contact], offset_m);
  for (int i = 0; i < 3; ++i)
    place_m[i] = tip_m[i] + offset_m[i];
  to_world(setup.mapping, place_m, world_m);
}

// How the contacts are turned: the device's turn, about axes of the world.
void turn_of_contacts(const DeviceSetup& setup, const GripState& grip, double turn_xyzw[4]) {
  double q[4];
  grip_turn(setup.grip, grip, q);
  for (int i = 0; i < 3; ++i) {
    const double* const row = setup.mapping.rotation + 3 * i;
    turn_xyzw[i] = row[0] * q[0] + row[1] * q[1] + row[2] * q[2];
  }
  turn_xyzw[3] = q[3];
}

// Sets the fingers' rotations, which pads (soft fingers) need.
void turn_pads(const DeviceSetup& setup, const double turn_xyzw[4]) {
  for (int contact = 0; contact < setup.contact_count; ++contact)
    if (setup.pads_m[contact] > 0) fdcg_scene_set_finger_rotation(setup.scene, setup.fingers[contact], turn_xyzw, nullptr);
}

bool add_fingers(DeviceState& device, const double (*places_m)[3], fdcg_error* error) {
  DeviceSetup& setup = device.setup;
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    fdcg_finger_id* const finger = &setup.fingers[contact];
    if (fdcg_scene_add_finger(setup.scene, places_m[contact], finger, error) != FDCG_OK) return false;
    const double pad_m = setup.pads_m[contact];
    if (pad_m > 0 && fdcg_scene_set_finger_radius(setup.scene, *finger, pad_m, error) != FDCG_OK) return false;
  }
  return true;
}

void remove_fingers(DeviceState& device) {
  for (int contact = 0; contact < device.setup.contact_count; ++contact)
    fdcg_scene_remove_finger(device.setup.scene, device.setup.fingers[contact], nullptr);
  device.has_left = true;
  device.has_place = false;
  if (device.setup.effects != nullptr) device.setup.effects->reset(device.setup.effects_device);
}

// Resets the fingers to a position: no contact on the way there.
void place_fingers(DeviceState& device, const Target& target) {
  if (device.has_left) {
    add_fingers(device, target.place_m, nullptr);  // there is room: it had them before
    device.has_left = false;
  } else {
    for (int contact = 0; contact < device.setup.contact_count; ++contact)
      fdcg_scene_reset_finger(device.setup.scene, device.setup.fingers[contact], target.place_m[contact], nullptr);
  }
  if (device.setup.effects != nullptr) device.setup.effects->reset(device.setup.effects_device);
  std::copy_n(&target.place_m[0][0], 3 * device.setup.contact_count, &device.places_m[0][0]);
  std::copy_n(&target.place_m[0][0], 3 * device.setup.contact_count, &device.moved_m[0][0]);
  std::copy_n(target.turn_xyzw, 4, device.turn_xyzw);
  device.has_place = true;
}

// Interpolates from the last tick's position to the target; at a share of 1 exactly the target.
void move_fingers(const DeviceState& device, const Target& target, double share) {
  const DeviceSetup& setup = device.setup;
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    const double *const from = device.moved_m[contact], *const to = target.moved_m[contact];
    double at_m[3];
    for (int i = 0; i < 3; ++i)
      at_m[i] = share == 1 ? to[i] : from[i] + (to[i] - from[i]) * share;
    fdcg_scene_move_finger(setup.scene, setup.fingers[contact], at_m, nullptr);
  }
  double at_xyzw[4];  // the straight line: of length 1 but for turns of many degrees a tick, of which the end alone is taken
  for (int i = 0; i < 4; ++i)
    at_xyzw[i] = share == 1 ? target.turn_xyzw[i] : device.turn_xyzw[i] + (target.turn_xyzw[i] - device.turn_xyzw[i]) * share;
  turn_pads(setup, at_xyzw);
}

// Substeps of a tick: a slower clock device needs more of them, none longer than those that the scene was built for.
std::uint32_t substeps_of(const DeviceSetup& clock) {
  const double rate_hz = clock.profile.rate_hz;
  if (!(clock.scene_rate_hz > rate_hz)) return clock.substeps;
  constexpr double kRounding = 1e-9;
  return static_cast<std::uint32_t>(std::ceil(clock.substeps * (clock.scene_rate_hz / rate_hz) - kRounding));
}

// Substeps, in which the fingers move in equal parts: a held object does not get one impact per tick.
void step_bodies(const Member* members, int count, const Target* targets, const DeviceSetup& clock) {
  const std::uint32_t substeps = substeps_of(clock);
  const double substep_s = 1 / clock.profile.rate_hz / substeps;
  for (std::uint32_t step = 1; step <= substeps; ++step) {
    const double share = step == substeps ? 1 : static_cast<double>(step) / substeps;
    for (int m = 0; m < count; ++m)
      if (members[m].device->has_place) move_fingers(*members[m].device, targets[m], share);
    const fdcg_status status = fdcg_scene_step_pile(clock.scene, clock.pile, clock.bodies, clock.body_count, 1, substep_s,
                                                    clock.reactions, clock.reaction_count, nullptr);
    if (status == FDCG_OK) continue;
    for (int m = 0; m < count; ++m)
      members[m].device->counters.bodies_lost = 1;
    return;
  }
}

void move_by_reliefs(const DeviceState& device, double tick_s, Target* target) {
  const DeviceSetup& setup = device.setup;
  std::copy_n(&target->place_m[0][0], 3 * setup.contact_count, &target->moved_m[0][0]);
  if (setup.effects == nullptr) return;
  for (int contact = 0; contact < setup.contact_count; ++contact)
    setup.effects->shift(setup.effects_device, contact, target->place_m[contact], tick_s, target->moved_m[contact]);
}

bool may_touch(const DeviceState& device, bool has_moved) {
  return device.has_place || (has_moved && !device.is_waiting);
}

// Moves the contacts to the positions given by tips and grips, and steps the scene.
void step_scene(const Member* members, int count, const bool* has_moved, const DeviceState& clock) {
  Target targets[kMaxDevices];
  for (int m = 0; m < count; ++m) {
    DeviceState& device = *members[m].device;
    if (!may_touch(device, has_moved[m])) continue;
    turn_of_contacts(device.setup, device.grip, targets[m].turn_xyzw);
    for (int contact = 0; contact < device.setup.contact_count; ++contact)
      contact_place(device.setup, device.grip, contact, device.tip_m, targets[m].place_m[contact]);
    if (!device.has_place) place_fingers(device, targets[m]);
    move_by_reliefs(device, 1 / clock.setup.profile.rate_hz, &targets[m]);
  }
  if (clock.setup.body_count > 0 && clock.counters.bodies_lost == 0) {
    step_bodies(members, count, targets, clock.setup);
  } else {
    for (int m = 0; m < count; ++m)
      if (members[m].device->has_place) move_fingers(*members[m].device, targets[m], 1);
    fdcg_scene_step(clock.setup.scene);
  }
  for (int m = 0; m < count; ++m) {
    DeviceState& device = *members[m].device;
    if (!device.has_place) continue;
    std::copy_n(targets[m].turn_xyzw, 4, device.turn_xyzw);
    std::copy_n(&targets[m].place_m[0][0], 3 * device.setup.contact_count, &device.places_m[0][0]);
    std::copy_n(&targets[m].moved_m[0][0], 3 * device.setup.contact_count, &device.moved_m[0][0]);
  }
}

// The sum of the forces on all contacts of the device. The reported state is that of the touch with the largest force.
void sum_touches(DeviceState& device, double tick_s) {
  const DeviceSetup& setup = device.setup;
  double largest = 0;
  std::fill_n(device.wanted_n, 3, 0.0);
  device.state = 0;
  device.rubs = false;
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    fdcg_finger_result felt;
    if (fdcg_scene_get_result(setup.scene, setup.fingers[contact], &felt, nullptr) != FDCG_OK) continue;
    double force_n[3] = {felt.force_n[0], felt.force_n[1], felt.force_n[2]};
    if (setup.effects != nullptr) setup.effects->turn(setup.effects_device, contact, felt, tick_s, force_n);
    for (int i = 0; i < 3; ++i)
      device.wanted_n[i] += force_n[i];
    for (std::uint32_t t = 0; t < felt.touch_count; ++t) {
      const double* const f = felt.touches[t].force_n;
      const double square = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
      device.rubs = device.rubs || (setup.has_friction && felt.touches[t].slipping != 0);
      if (square < largest) continue;
      largest = square;
      device.state = felt.touches[t].state;
    }
  }
}

// The effects on all contacts of the device.
void sum_effects(DeviceState& device, double tick_s) {
  const DeviceSetup& setup = device.setup;
  std::fill_n(device.effect_n, 3, 0.0);
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    fdcg_finger_result felt;
    if (fdcg_scene_get_result(setup.scene, setup.fingers[contact], &felt, nullptr) != FDCG_OK) continue;
    setup.effects->feel(setup.effects_device, contact, device.places_m[contact], felt, tick_s, device.effect_n);
  }
}

// Where bodies are after the step; driven objects are told when they are moved.
void move_bodies(const DeviceSetup& setup) {
  for (std::uint32_t i = 0; i < setup.body_count; ++i)
    setup.effects->move(setup.bodies[i].object, fdcg_body_get_pose(&setup.bodies[i].body));
}

// Steps the soft sheets with the forces of this tick; their motion takes effect in the next tick.
void yield_to(const Member* members, int count, const DeviceSetup& clock) {
  for (int soft = 0; soft < clock.soft_count; ++soft) {
    for (int m = 0; m < count; ++m) {
      const DeviceState& device = *members[m].device;
      for (int contact = 0; device.has_place && contact < device.setup.contact_count; ++contact) {
        fdcg_finger_result felt;
        if (fdcg_scene_get_result(clock.scene, device.setup.fingers[contact], &felt, nullptr) != FDCG_OK) continue;
        for (std::uint32_t t = 0; t < felt.touch_count; ++t)
          if (felt.touches[t].object.index == clock.soft_id[soft].index) clock.soft[soft]->press(felt.touches[t]);
      }
    }
    clock.soft[soft]->relax(1 / clock.profile.rate_hz);
  }
}

bool is_heard_within(const Member& member, double seconds) {
  if (member.device->last_good_ns == 0 || member.input->read == ReadStatus::kLost) return false;
  // a clock that went back is detected by the gate
  const std::uint64_t now_ns = std::max(member.input->now_ns, member.device->last_good_ns);
  return static_cast<double>(now_ns - member.device->last_good_ns) * 1e-9 < seconds;
}

int clock_of(const Member* members, int count) {
  int clock = -1;
  for (int m = 0; m < count; ++m) {
    const double rate_hz = members[m].device->setup.profile.rate_hz;
    if (!is_heard_within(members[m], kMissedTicksToFade / rate_hz)) continue;
    if (clock < 0 || rate_hz > members[clock].device->setup.profile.rate_hz) clock = m;
  }
  return std::max(clock, 0);
}

}  // namespace

void to_world(const Mapping& mapping, const double device_m[3], double world_m[3]) {
  for (int i = 0; i < 3; ++i) {
    const double* const row = mapping.rotation + 3 * i;
    world_m[i] = row[0] * device_m[0] * mapping.scale + row[1] * device_m[1] * mapping.scale +
                 row[2] * device_m[2] * mapping.scale + mapping.offset_m[i];
  }
}

bool begin_fingers(DeviceState* device, fdcg_error* error) {
  const double tip_m[3] = {0, 0, 0};
  double places_m[kMaxContacts][3];
  for (int contact = 0; contact < device->setup.contact_count; ++contact)
    contact_place(device->setup, device->grip, contact, tip_m, places_m[contact]);
  if (!add_fingers(*device, places_m, error)) return false;
  if (device->setup.is_shared) remove_fingers(*device);
  return true;
}

int scene_tick(const Member* members, int count, const bool* has_moved) {
  const int clock = count == 1 ? 0 : clock_of(members, count);
  if (!has_moved[clock]) return clock;
  const DeviceSetup& setup = members[clock].device->setup;
  const TickInput& input = *members[clock].input;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(input.pose_count, setup.driven_count); ++i) {
    // a bad pose: the old one stays
    const fdcg_status status = fdcg_scene_set_pose(setup.scene, setup.driven[i], &input.poses[i], nullptr);
    if (status == FDCG_OK && setup.effects != nullptr) setup.effects->move(setup.driven[i], input.poses[i]);
  }
  step_scene(members, count, has_moved, *members[clock].device);
  for (int m = 0; m < count; ++m)
    if (members[m].device->has_place) sum_touches(*members[m].device, 1 / setup.profile.rate_hz);
  if (setup.effects != nullptr) {
    move_bodies(setup);
    for (int m = 0; m < count; ++m)
      if (members[m].device->has_place) sum_effects(*members[m].device, 1 / setup.profile.rate_hz);
  }
  yield_to(members, count, setup);
  return clock;
}

void leave_scene(const Member& member) {
  DeviceState& device = *member.device;
  const Fault fault = device.gate.fault();
  const bool is_armed = device.gate.phase() != Phase::kDisarmed;
  device.is_waiting = !is_armed && fault != Fault::kCommanded && fault != Fault::kUnknownLimit;
  if (device.has_left || (!device.is_waiting && is_heard_within(member, kSilenceS))) return;
  remove_fingers(device);
  std::fill_n(device.wanted_n, 3, 0.0);
  std::fill_n(device.effect_n, 3, 0.0);
  device.state = 0;
}

}  // namespace fdcg::dev
