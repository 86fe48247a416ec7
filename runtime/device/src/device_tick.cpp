// SPDX-License-Identifier: Apache-2.0
#include "device_tick.hpp"

#include <algorithm>

#include "fdcg/soft_finger.h"

namespace fdcg::dev {
namespace {

constexpr double kLatePeriods = 1.5;

void to_world(const Mapping& mapping, const double device_m[3], double world_m[3]) {
  for (int i = 0; i < 3; ++i) {
    const double* const row = mapping.rotation + 3 * i;
    world_m[i] = row[0] * device_m[0] * mapping.scale + row[1] * device_m[1] * mapping.scale +
                 row[2] * device_m[2] * mapping.scale + mapping.offset_m[i];
  }
}

void force_to_device(const Mapping& mapping, const double world_n[3], double device_n[3]) {
  const double* const r = mapping.rotation;
  for (int i = 0; i < 3; ++i)
    device_n[i] = r[i] * world_n[0] + r[3 + i] * world_n[1] + r[6 + i] * world_n[2];
}

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

// Pads resist being turned against what they touch, so they have to know how they stand.
void turn_pads(const DeviceSetup& setup, const double turn_xyzw[4]) {
  for (int contact = 0; contact < setup.contact_count; ++contact)
    if (setup.pads_m[contact] > 0) fdcg_scene_turn_finger(setup.scene, setup.fingers[contact], turn_xyzw, nullptr);
}

// Judges what was read. True with the newest good report in *sample.
bool newest_good(DeviceState& device, const TickInput& input, Sample* sample) {
  const Profile& profile = device.setup.profile;
  TickCounters& counters = device.counters;
  const std::uint64_t lost_before = device.judge.lost;
  bool has_sample = false;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(input.report_count, kMaxDrain); ++i) {
    const RawReport& report = input.reports[i];
    Sample read;
    Verdict verdict = decode_input(profile, report.data, report.bytes, &read);
    if (verdict == Verdict::kGood) {
      verdict = judge_report(profile, read, static_cast<double>(report.host_ns) * 1e-9, &device.judge);
    }
    if (verdict != Verdict::kGood) {
      ++counters.rejected[static_cast<int>(verdict)];
      continue;
    }
    counters.superseded += has_sample;
    has_sample = true;
    *sample = read;
  }
  counters.lost += device.judge.lost - lost_before;
  return has_sample;
}

void count_tick(DeviceState& device, const TickInput& input, bool has_sample) {
  TickCounters& counters = device.counters;
  counters.timeouts += input.read == ReadStatus::kTimeout && input.report_count == 0;
  if (!has_sample) return;
  const double since_s = static_cast<double>(input.now_ns - device.last_good_ns) * 1e-9;
  counters.late += device.last_good_ns != 0 && since_s * device.setup.profile.rate_hz > kLatePeriods;
  device.last_good_ns = input.now_ns;
  ++counters.ticks;
}

// Substeps, in which the fingers go in even steps to where they are now: what they hold is not struck once a tick.
void step_bodies(DeviceState& device, const double (*to_m)[3], const double to_xyzw[4]) {
  const DeviceSetup& setup = device.setup;
  const std::uint32_t count = setup.substeps;
  const double substep_s = 1 / setup.profile.rate_hz / count;
  for (std::uint32_t step = 1; step <= count; ++step) {
    const double share = static_cast<double>(step) / count;
    for (int contact = 0; contact < setup.contact_count; ++contact) {
      const double* const from = device.places_m[contact];
      double at_m[3];
      for (int i = 0; i < 3; ++i)
        at_m[i] = step == count ? to_m[contact][i] : from[i] + (to_m[contact][i] - from[i]) * share;
      fdcg_scene_move_finger(setup.scene, setup.fingers[contact], at_m, nullptr);
    }
    double at_xyzw[4];  // the straight line: of length 1 but for turns of many degrees a tick, of which the end alone is taken
    for (int i = 0; i < 4; ++i)
      at_xyzw[i] = step == count ? to_xyzw[i] : device.turn_xyzw[i] + (to_xyzw[i] - device.turn_xyzw[i]) * share;
    turn_pads(setup, at_xyzw);
    const fdcg_status status = fdcg_scene_step_pile(setup.scene, setup.pile, setup.bodies, setup.body_count, 1, substep_s,
                                                    setup.reactions, setup.reaction_count, nullptr);
    if (status == FDCG_OK) continue;
    device.counters.bodies_lost = 1;
    return;
  }
}

// The contacts to where tip and grip have them now, and the scene steps.
void step_scene(DeviceState& device, const double tip_m[3]) {
  const DeviceSetup& setup = device.setup;
  const bool has_bodies = setup.body_count > 0 && device.counters.bodies_lost == 0;
  double to_m[kMaxContacts][3], to_xyzw[4];
  turn_of_contacts(setup, device.grip, to_xyzw);
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    contact_place(setup, device.grip, contact, tip_m, to_m[contact]);
    if (device.has_place && has_bodies) continue;
    const auto place = device.has_place ? fdcg_scene_move_finger : fdcg_scene_reset_finger;
    place(setup.scene, setup.fingers[contact], to_m[contact], nullptr);
    std::copy_n(to_m[contact], 3, device.places_m[contact]);
  }
  if (!device.has_place) std::copy_n(to_xyzw, 4, device.turn_xyzw);
  device.has_place = true;
  if (has_bodies) {
    step_bodies(device, to_m, to_xyzw);
  } else {
    turn_pads(setup, to_xyzw);
    fdcg_scene_step(setup.scene);
  }
  std::copy_n(to_xyzw, 4, device.turn_xyzw);
  std::copy_n(&to_m[0][0], 3 * setup.contact_count, &device.places_m[0][0]);
}

// The state that is told is that of the touch with the largest force.
void note_touch(const double force_n[3], std::uint32_t state, double* largest, TickOutput* output) {
  const double square = force_n[0] * force_n[0] + force_n[1] * force_n[1] + force_n[2] * force_n[2];
  if (square < *largest) return;
  *largest = square;
  output->state = state;
}

// What gives way does, under what the fingers have just felt of it: they feel that in the next tick.
void yield_to(const DeviceSetup& setup) {
  for (int soft = 0; soft < setup.soft_count; ++soft) {
    for (int contact = 0; contact < setup.contact_count; ++contact) {
      fdcg_finger_result felt;
      if (fdcg_scene_result(setup.scene, setup.fingers[contact], &felt, nullptr) != FDCG_OK) continue;
      for (std::uint32_t t = 0; t < felt.touch_count; ++t)
        if (felt.touches[t].object.index == setup.soft_id[soft].index) setup.soft[soft]->press(felt.touches[t]);
    }
    setup.soft[soft]->relax(1 / setup.profile.rate_hz);
  }
}

// Moves the fingers to the tip, steps the scene, sums what they feel. World's frame.
void feel(DeviceState& device, const TickInput& input, const double tip_m[3], TickOutput* output) {
  const DeviceSetup& setup = device.setup;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(input.pose_count, setup.driven_count); ++i) {
    fdcg_scene_set_pose(setup.scene, setup.driven[i], &input.poses[i], nullptr);  // a bad pose: the old one stays
  }
  step_scene(device, tip_m);
  double largest = 0;
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    fdcg_finger_result felt;
    if (fdcg_scene_result(setup.scene, setup.fingers[contact], &felt, nullptr) != FDCG_OK) continue;
    for (int i = 0; i < 3; ++i)
      output->wanted_force_n[i] += felt.force_n[i];
    for (std::uint32_t t = 0; t < felt.touch_count; ++t)
      note_touch(felt.touches[t].force_n, felt.touches[t].state, &largest, output);
  }
  yield_to(setup);
}

}  // namespace

bool begin_device(const DeviceSetup& setup, DeviceState* device, fdcg_error* error) {
  *device = DeviceState();
  device->setup = setup;
  device->gate.begin(setup.profile.limits, setup.profile.axis_count, setup.profile.rate_hz, setup.most_force_n);
  const double tip_m[3] = {0, 0, 0};
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    double world_m[3];
    contact_place(setup, device->grip, contact, tip_m, world_m);
    fdcg_finger_id* const finger = &device->setup.fingers[contact];
    if (fdcg_scene_add_finger(setup.scene, world_m, finger, error) != FDCG_OK) return false;
    const double pad_m = setup.pads_m[contact];
    if (pad_m > 0 && fdcg_scene_soften_finger(setup.scene, *finger, pad_m, error) != FDCG_OK) return false;
  }
  return true;
}

void device_tick(DeviceState& device, const TickInput& input, TickOutput* output) {
  *output = TickOutput();
  if (input.begins) {
    device.judge = ReportJudge();
    device.samples = 0;
    device.has_place = false;
    device.last_good_ns = 0;
  }
  Sample sample;
  output->has_sample = newest_good(device, input, &sample);
  count_tick(device, input, output->has_sample);

  GateInput gate;
  if (output->has_sample) {
    device.sample = sample;
    device.samples = std::min(device.samples + 1, kSamplesToArm);
    gate.has_sample = true;
    gate.device_fault = sample.has_fault;
    gate.is_tip_valid = tip_pose(device.setup.profile.kinematics, device.setup.profile.axis_count, sample.axis, &gate.tip);
    move_grip(device.setup.grip, sample.buttons, 1 / device.setup.profile.rate_hz, &device.grip);
    if (gate.is_tip_valid) {
      feel(device, input, gate.tip.position_m, output);
      to_world(device.setup.mapping, gate.tip.position_m, device.tip_world_m);
      std::copy_n(output->wanted_force_n, 3, device.wanted_n);
      device.state = output->state;
    }
  }
  // Without a good report all stays as it was last seen; the gate knows how old that is.
  output->sample = device.sample;
  output->echo = device.sample.sequence;
  output->state = device.state;
  std::copy_n(device.tip_world_m, 3, output->hip_world_m);
  std::copy_n(device.wanted_n, 3, output->wanted_force_n);
  output->body_count = device.setup.body_count;
  for (std::uint32_t i = 0; i < output->body_count; ++i)
    output->bodies[i] = fdcg_body_pose(&device.setup.bodies[i].body);

  gate.now_ns = input.now_ns;
  gate.arm = input.arm && device.samples == kSamplesToArm;
  gate.disarm = input.disarm;
  gate.read_failed = input.read == ReadStatus::kLost;
  gate.write_failed = input.write_failed;
  gate.write_busy_ns = input.write_busy_ns;
  force_to_device(device.setup.mapping, device.wanted_n, gate.wanted_force_n);
  const Phase phase_before = device.gate.phase();
  output->force = device.gate.step(gate);
  output->phase = device.gate.phase();
  output->fault = device.gate.fault();
  output->arming_refused = device.gate.arming_refused() || (input.arm && !gate.arm);
  if (phase_before != Phase::kDisarmed && output->phase == Phase::kDisarmed) {
    ++device.counters.disarmed[static_cast<int>(output->fault)];
  }
}

}  // namespace fdcg::dev
