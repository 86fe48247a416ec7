// SPDX-License-Identifier: Apache-2.0
#include "tick/device_tick.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "tick/scene_tick.hpp"

namespace fdcg::dev {
namespace {

constexpr double kLatePeriods = 1.5;

void force_to_device(const Mapping& mapping, const double world_n[3], double device_n[3]) {
  const double* const r = mapping.rotation;
  for (int i = 0; i < 3; ++i)
    device_n[i] = r[i] * world_n[0] + r[3 + i] * world_n[1] + r[6 + i] * world_n[2];
}

// Judges what was read. True with the newest good report in *sample.
bool newest_good(DeviceState& device, const TickInput& input, Sample* sample) {
  const Profile& profile = device.setup.profile;
  TickCounters& counters = device.counters;
  const std::uint64_t lost_before = device.judge.lost;
  device.link.note_sent(input.sent);
  bool has_sample = false;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(input.report_count, kMaxDrain); ++i) {
    const RawReport& report = input.reports[i];
    Sample read;
    Verdict verdict = decode_input(profile, report.data, report.bytes, &read);
    const std::uint64_t restarts = device.judge.restarts;
    if (verdict == Verdict::kGood) {
      verdict = judge_report(profile, read, static_cast<double>(report.host_ns) * 1e-9, &device.judge);
    }
    if (verdict != Verdict::kGood) {
      ++counters.rejected[static_cast<int>(verdict)];
      continue;
    }
    if (device.judge.restarts != restarts) device.link.open(report.host_ns);
    device.link.note_report(read, report.host_ns);
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

// Judge, kinematics, grip. What the gate is to know of the report in to_gate. True: the tip has a place.
bool take_reports(const Member& member) {
  DeviceState& device = *member.device;
  GateInput* const gate = &device.to_gate;
  *gate = GateInput();
  static_cast<TickTold&>(*member.output) = TickTold();  // as many bodies in each tick: those beyond stay as they are
  if (member.input->begins) {
    device.judge = ReportJudge();
    device.link.open(member.input->now_ns);
    device.samples = 0;
    device.has_place = false;
    device.last_good_ns = 0;
  }
  Sample sample;
  const std::uint64_t restarts = device.judge.restarts;
  const bool has_sample = newest_good(device, *member.input, &sample);
  gate->link_fault = device.judge.restarts != restarts ? Fault::kRestarted : Fault::kNone;
  member.output->has_sample = has_sample;
  count_tick(device, *member.input, has_sample);
  if (!has_sample) return false;  // the last state is kept; the gate checks its age
  const Profile& profile = device.setup.profile;
  device.sample = sample;
  device.samples = std::min(device.samples + 1, kSamplesToArm);
  gate->has_sample = true;
  gate->device_fault = sample.has_fault;
  gate->is_tip_valid = tip_pose(profile.kinematics, profile.axis_count, sample.axis, &gate->tip);
  move_grip(device.setup.grip, sample.buttons, 1 / profile.rate_hz, &device.grip);
  if (!gate->is_tip_valid) return false;
  std::copy_n(gate->tip.position_m, 3, device.tip_m);
  to_world(device.setup.mapping, device.tip_m, device.tip_world_m);
  return true;
}

void tell(const DeviceState& device, TickOutput* output) {
  output->sample = device.sample;
  output->echo = device.sample.sequence;
  output->state = device.state;
  std::copy_n(device.tip_world_m, 3, output->hip_world_m);
  std::copy_n(device.wanted_n, 3, output->wanted_force_n);
  for (int i = 0; device.setup.effects != nullptr && i < 3; ++i)
    output->wanted_force_n[i] += device.effect_n[i];
  output->body_count = device.setup.body_count;
  for (std::uint32_t i = 0; i < output->body_count; ++i)
    output->bodies[i] = fdcg_body_get_pose(&device.setup.bodies[i].body);
}

// What of the force that was let through is the effects' own: they have the share that the whole has.
void note_effects(DeviceState& device) {
  const double* const sent = device.gate.last_force_n();
  const double asked2 = dot(device.steadied_n, device.steadied_n), sent2 = dot(sent, sent);
  const double share = asked2 > 0 ? std::min(1.0, std::sqrt(sent2 / asked2)) * device.stability.share() : 0;
  for (int i = 0; i < 3; ++i)
    device.effects.sent_n[i] = share * device.effects.now_n[i];
}

// What was wanted, in the device's frame, through the stage of stability. Without a report the force stays.
void steady(DeviceState& device, const TickInput& input) {
  if (device.gate.phase() == Phase::kDisarmed && input.arm) device.stability.reset();
  if (!device.to_gate.has_sample) return;
  force_to_device(device.setup.mapping, device.wanted_n, device.steadied_n);
  // disarmed, they are left out: a hum would keep the gate from arming, which ramps them up then as all else
  const bool is_armed = device.gate.phase() != Phase::kDisarmed;
  const double none_n[3] = {0, 0, 0};
  force_to_device(device.setup.mapping, is_armed ? device.effect_n : none_n, device.effects.now_n);
  device.stability.step(device.tip_m, input.now_ns, device.gate.last_force_n(), device.link.round_trip_s(), device.rubs,
                        device.steadied_n, device.effects);
}

void pass_gate(const Member& member) {
  DeviceState& device = *member.device;
  GateInput* const gate = &device.to_gate;
  const TickInput& input = *member.input;
  TickOutput& output = *member.output;
  const bool wants_force = device.gate.phase() != Phase::kDisarmed || input.arm;
  gate->now_ns = input.now_ns;
  gate->slept_ns = input.slept_ns;
  if (gate->link_fault == Fault::kNone) gate->link_fault = device.link.fault(input.now_ns, wants_force);
  gate->lags = device.link.lags();
  gate->arm = input.arm && device.samples == kSamplesToArm;
  gate->disarm = input.disarm;
  gate->read_failed = input.read == ReadStatus::kLost;
  gate->write_failed = input.write_failed;
  gate->write_busy_ns = input.write_busy_ns;
  steady(device, input);
  if (gate->link_fault == Fault::kNone && device.stability.shakes()) gate->link_fault = Fault::kShaking;
  const bool is_released = device.setup.dead_man_mask != 0 && (device.sample.buttons & device.setup.dead_man_mask) == 0;
  if (gate->link_fault == Fault::kNone && is_released && wants_force) gate->link_fault = Fault::kReleased;
  std::copy_n(device.steadied_n, 3, gate->wanted_force_n);
  const Phase phase_before = device.gate.phase();
  output.force = device.gate.step(*gate);
  if (device.setup.effects != nullptr) note_effects(device);
  output.phase = device.gate.phase();
  output.fault = device.gate.fault();
  output.calmed = 1 - device.stability.share();
  output.damping_n_s_per_m = device.stability.damping();
  output.is_hot = device.stability.is_hot();
  output.round_trip_s = device.link.round_trip_s();
  output.arming_refused = device.gate.arming_refused() || (input.arm && !gate->arm);
  if (phase_before != Phase::kDisarmed && output.phase == Phase::kDisarmed) {
    ++device.counters.disarmed[static_cast<int>(output.fault)];
  }
}

}  // namespace

bool begin_device(const DeviceSetup& setup, DeviceState* device, fdcg_error* error) {
  *device = DeviceState();
  device->setup = setup;
  device->link.begin(setup.profile, !setup.is_played);
  device->gate.begin(setup.profile.limits, setup.profile.axis_count, setup.profile.rate_hz, setup.most_force_n);
  device->stability.begin(setup.stability, device->gate.limits(), setup.profile.rate_hz);
  return begin_fingers(device, error);
}

void device_tick(DeviceState& device, const TickInput& input, TickOutput* output) {
  const Member alone = {&device, &input, output};
  group_tick(&alone, 1);
}

int group_tick(const Member* members, int count) {
  bool has_moved[kMaxDevices] = {};
  for (int m = 0; m < count; ++m)
    has_moved[m] = take_reports(members[m]);
  const int clock = scene_tick(members, count, has_moved);
  for (int m = 0; m < count; ++m) {
    tell(*members[m].device, members[m].output);
    pass_gate(members[m]);
    if (members[m].device->setup.is_shared) leave_scene(members[m]);
  }
  return clock;
}

}  // namespace fdcg::dev
