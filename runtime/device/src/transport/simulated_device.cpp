// SPDX-License-Identifier: Apache-2.0
#include "transport/simulated_device.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "transport/simulated_body.hpp"

namespace fdcg::dev {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kStepS = 50e-6;  // of the mass: a hundredth of the fastest that a hand and a handle swing
// Device clocks start three seconds before they wrap, so that every longer run includes a wrap.
constexpr std::uint32_t kClockAtBootUs = 0u - 3000000u;
constexpr std::uint8_t kFaultBits = FDCG_FW_WATCHDOG | FDCG_FW_FAULTS;

double norm(const std::array<float, 3>& force_n) {
  return std::sqrt(double{force_n[0]} * force_n[0] + double{force_n[1]} * force_n[1] + double{force_n[2]} * force_n[2]);
}

std::int32_t to_counts(double position_m, double quantum_m) {
  return static_cast<std::int32_t>(std::clamp(std::nearbyint(position_m / quantum_m), -2147483648.0, 2147483647.0));
}

template <class Number>
Number in_range(double value, Number most) {
  return static_cast<Number>(std::clamp(value, 1.0, static_cast<double>(most)));
}

fdcg_fw_config firmware_config(const SimulationConfig& config) {
  fdcg_fw_config fw = {};
  fw.counts_per_unit = in_range<std::uint32_t>(std::nearbyint(1 / config.quantum_m), 4294967295u);
  const DeviceLimits limits = simulated_profile(config).limits;
  for (int i = 0; i < 3; ++i) {
    fw.workspace_min_mm[i] = static_cast<std::int16_t>(std::clamp(limits.workspace_min_m[i] * 1000, -32768.0, 32767.0));
    fw.workspace_max_mm[i] = static_cast<std::int16_t>(std::clamp(limits.workspace_max_m[i] * 1000, -32768.0, 32767.0));
  }
  fw.peak_force_n = fw.continuous_force_n = static_cast<float>(config.force_n);
  fw.rate_hz = in_range<std::uint16_t>(std::ceil(config.rate_hz), 65535);
  fw.watchdog_ms = in_range<std::uint16_t>(std::nearbyint(config.watchdog_s * 1000), 65535);
  fw.dof = 3;
  fw.axes = FDCG_FW_CARTESIAN;
  return fw;
}

Field field(Role role, NumberType type, int offset, double scale = 1, std::uint32_t constant = 0) {
  Field f;
  f.role = role;
  f.type = type;
  f.offset = static_cast<std::uint16_t>(offset);
  f.scale = scale;
  f.constant = constant;
  return f;
}

void add(ReportLayout* layout, const Field& f) {
  layout->fields[layout->field_count++] = f;
}

void finish(ReportLayout* layout, unsigned id, unsigned bytes) {
  layout->id = static_cast<std::uint8_t>(id);
  layout->bytes = static_cast<std::uint16_t>(bytes);
  layout->crc.kind = CrcKind::kCrc16CcittFalse;
  layout->crc.offset = layout->crc.bytes = static_cast<std::uint16_t>(bytes - 2);
}

constexpr double kRoomM = 0.1;  // for what forces do to the hand, beyond where it goes by itself

// Where the hand's target goes along an axis, and how fast at most.
struct HandRange {
  double least_m = 0, most_m = 0, speed_m_per_s = 0;
};
HandRange hand_range(const SimulationConfig& config, int axis) {
  if (config.script.empty()) {
    const double swing_m = std::fabs(config.amplitude_m[axis]);
    return {config.start_m[axis] - swing_m, config.start_m[axis] + swing_m,
            kTwoPi * std::fabs(config.frequency_hz[axis]) * swing_m};
  }
  const double first_m = config.script[0].place_m[axis];
  HandRange range{first_m, first_m, 0};
  for (std::size_t i = 1; i < config.script.size(); ++i) {
    const ScriptStep &from = config.script[i - 1], &to = config.script[i];
    range.least_m = std::min(range.least_m, to.place_m[axis]);
    range.most_m = std::max(range.most_m, to.place_m[axis]);
    constexpr double kPeak = 1.5;  // of the speed, over the mean of a way from rest to rest
    range.speed_m_per_s =
        std::max(range.speed_m_per_s, kPeak * std::fabs(to.place_m[axis] - from.place_m[axis]) / (to.at_s - from.at_s));
  }
  return range;
}

}  // namespace

Profile simulated_profile(const SimulationConfig& config) {
  Profile p;
  std::snprintf(p.name, sizeof p.name, "simulated device");
  p.rate_hz = config.rate_hz;
  p.axis_count = 3;
  add(&p.input, field(Role::kSequence, NumberType::kU32, 1));
  add(&p.input, field(Role::kTime, NumberType::kU32, 5, 1e-6));
  for (int i = 0; i < 3; ++i) {
    const NumberType type = config.has_float_axes ? NumberType::kF32 : NumberType::kI32;
    add(&p.input, field(Role::kAxis, type, 9 + 4 * i, config.has_float_axes ? 1 : config.quantum_m));
    p.input.fields[p.input.field_count - 1].axis = static_cast<std::uint8_t>(i);
  }
  add(&p.input, field(Role::kEcho, NumberType::kU32, 21));
  add(&p.input, field(Role::kButtons, NumberType::kU8, 25));
  add(&p.input, field(Role::kStatus, NumberType::kU8, 26, 1, kFaultBits));
  p.input.fields[p.input.field_count - 1].enabled = FDCG_FW_ENABLED;
  finish(&p.input, FDCG_FW_INPUT_ID, FDCG_FW_INPUT_BYTES);
  p.has_output = true;
  add(&p.output, field(Role::kSequence, NumberType::kU32, 1));
  for (int i = 0; i < 3; ++i) {
    add(&p.output, field(Role::kEffort, NumberType::kF32, 5 + 4 * i));
    p.output.fields[p.output.field_count - 1].axis = static_cast<std::uint8_t>(i);
  }
  add(&p.output, field(Role::kEcho, NumberType::kU32, 17));
  add(&p.output, field(Role::kEnable, NumberType::kU8, 21, 1, FDCG_FW_ENABLE));
  finish(&p.output, FDCG_FW_OUTPUT_ID, FDCG_FW_OUTPUT_BYTES);
  p.limits.force_n = config.force_n;
  p.limits.slew_n_per_s = config.force_n / 0.005;
  p.limits.velocity_m_per_s = 2;
  p.limits.device_watchdog_s = config.watchdog_s;
  for (int i = 0; i < 3; ++i) {
    p.limits.effort[i] = config.force_n;
    const HandRange range = hand_range(config, i);
    p.limits.velocity_m_per_s += range.speed_m_per_s;
    p.limits.workspace_min_m[i] = range.least_m - kRoomM;
    p.limits.workspace_max_m[i] = range.most_m + kRoomM;
  }
  return p;
}

SimulationRecord::SimulationRecord() {
  for (auto& noticed : noticed_ns)
    noticed.store(kNever, std::memory_order_relaxed);
}

std::uint64_t SimulationRecord::zero_at(std::uint64_t from_ns) const {
  std::array<float, 3> force_n = {};
  for (const Force& change : forces) {
    if (change.time_ns > from_ns && norm(force_n) == 0) return from_ns;
    force_n = change.force_n;
    if (change.time_ns > from_ns && norm(force_n) == 0) return change.time_ns;
  }
  return norm(force_n) == 0 ? from_ns : kNever;
}

float SimulationRecord::most_force_between(std::uint64_t from_ns, std::uint64_t to_ns) const {
  double before = 0, most = 0;
  for (const Force& change : forces) {
    if (change.time_ns > to_ns) break;
    if (change.time_ns <= from_ns)
      before = norm(change.force_n);
    else
      most = std::max(most, norm(change.force_n));
  }
  return static_cast<float>(std::max(before, most));
}

SimulatedBody::SimulatedBody(const SimulationConfig& config) : config_(config) {
  const double* const start_m = config.script.empty() ? config.start_m : config.script[0].place_m;
  std::copy(start_m, start_m + 3, position_m_);
  if (config_.record != nullptr) config_.record->forces.reserve(SimulationRecord::kMaxForces);
  power_up();
}

void SimulatedBody::power_up() {
  const fdcg_fw_config fw = firmware_config(config_);
  fdcg_fw_init(&fw_, &fw);
  boot_ns_ = time_ns_;
  had_tripped_ = false;
  note_force();
}

void SimulatedBody::unplug() {
  fdcg_fw_stop(&fw_);
  note_force();
}

void SimulatedBody::set_fault(bool has_fault) {
  fdcg_fw_set_faults(&fw_, has_fault ? FDCG_FW_FAULT : 0);
  note_force();
}

std::uint32_t SimulatedBody::clock_us() const {
  return static_cast<std::uint32_t>((time_ns_ - boot_ns_) / 1000) + kClockAtBootUs;
}

// The last step whose time has come; 0 before the first.
std::size_t SimulatedBody::script_step(double now_s) const {
  const auto is_later = [](double time_s, const ScriptStep& step) { return time_s < step.at_s; };
  const auto next = std::upper_bound(config_.script.begin(), config_.script.end(), now_s, is_later);
  return next == config_.script.begin() ? 0 : static_cast<std::size_t>(next - config_.script.begin()) - 1;
}

// Of the hand.
void SimulatedBody::target(double now_s, int axis, double* place_m, double* speed_m_per_s) const {
  if (config_.script.empty()) {
    const double omega = kTwoPi * config_.frequency_hz[axis], amplitude = config_.amplitude_m[axis];
    *place_m = config_.start_m[axis] + amplitude * std::sin(omega * now_s);
    *speed_m_per_s = amplitude * omega * std::cos(omega * now_s);
    return;
  }
  const std::size_t step = script_step(now_s);
  const ScriptStep& from = config_.script[step];
  *place_m = from.place_m[axis];
  *speed_m_per_s = 0;
  if (step + 1 == config_.script.size() || now_s <= from.at_s) return;
  const ScriptStep& to = config_.script[step + 1];
  const double span_s = to.at_s - from.at_s, share = (now_s - from.at_s) / span_s;
  const double way_m = to.place_m[axis] - from.place_m[axis];
  *place_m += way_m * share * share * (3 - 2 * share);
  *speed_m_per_s = way_m * 6 * share * (1 - share) / span_s;
}

// Backward Euler: stable whatever the spring and the mass, and its own damping, half the step times the spring, is small beside
// the hand's.
void SimulatedBody::step(double step_s) {
  note_force();
  const float* force_n = noted_n_;
  const double stiffness = config_.hand_stiffness_n_per_m, hand = config_.hand_damping_n_s_per_m;
  const double now_s = static_cast<double>(time_ns_) * 1e-9 + step_s, inverse = step_s / config_.mass_kg;
  for (int i = 0; i < 3; ++i) {
    double target_m = 0, target_m_per_s = 0;
    target(now_s, i, &target_m, &target_m_per_s);
    const double push = force_n[i] + stiffness * (target_m - position_m_[i]) + hand * target_m_per_s;
    velocity_m_per_s_[i] = (velocity_m_per_s_[i] + inverse * push) /
                           (1 + inverse * (config_.damping_n_s_per_m + hand) + inverse * step_s * stiffness);
    position_m_[i] += step_s * velocity_m_per_s_[i];
  }
}

void SimulatedBody::advance(std::uint64_t time_ns) {
  if (time_ns <= time_ns_) return;
  constexpr auto kMost = static_cast<std::uint64_t>(kMostCatchUpS * 1e9);
  if (time_ns - time_ns_ > kMost) time_ns_ = time_ns - kMost;
  const auto span_ns = static_cast<double>(time_ns - time_ns_);
  const auto steps = static_cast<std::uint64_t>(std::ceil(span_ns / (kStepS * 1e9)));
  const std::uint64_t begin_ns = time_ns_;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const std::uint64_t next_ns = begin_ns + (time_ns - begin_ns) * (i + 1) / steps;
    step(static_cast<double>(next_ns - time_ns_) * 1e-9);
    time_ns_ = next_ns;
  }
  note_force();
}

void SimulatedBody::note_force() {
  float force_n[3];
  fdcg_fw_force(&fw_, clock_us(), force_n);
  const bool is_new = std::memcmp(force_n, noted_n_, sizeof noted_n_) != 0;
  std::memcpy(noted_n_, force_n, sizeof noted_n_);
  if (config_.record == nullptr) return;
  SimulationRecord& record = *config_.record;
  const bool has_tripped = (fw_.status & FDCG_FW_WATCHDOG) != 0;
  if (has_tripped && !had_tripped_) ++record.watchdog_trips;
  had_tripped_ = has_tripped;
  record.end_ns = time_ns_;
  if (!is_new) return;
  const SimulationRecord::Force change = {time_ns_, {force_n[0], force_n[1], force_n[2]}};
  record.most_force_n = std::max(record.most_force_n, static_cast<float>(norm(change.force_n)));
  if (record.forces.size() < SimulationRecord::kMaxForces) {
    record.forces.push_back(change);
  } else {
    ++record.forces_not_kept;
  }
}

void SimulatedBody::make_report(std::uint8_t* report) {
  std::int32_t counts[3];
  for (int i = 0; i < 3; ++i)
    counts[i] = to_counts(position_m_[i], config_.quantum_m);
  if (config_.has_float_axes) {
    for (int i = 0; i < 3; ++i) {  // the same encoders, another number
      const auto metres = static_cast<float>(counts[i] * config_.quantum_m);
      std::memcpy(&counts[i], &metres, sizeof metres);
    }
  }
  const double now_s = static_cast<double>(time_ns_) * 1e-9;
  const std::uint32_t buttons = config_.script.empty() ? 0 : config_.script[script_step(now_s)].buttons;
  fdcg_fw_make_input(&fw_, clock_us(), counts, static_cast<std::uint8_t>(buttons), report);
  if (config_.record != nullptr) ++config_.record->reports;
}

void SimulatedBody::take(const std::uint8_t* data, int bytes) {
  const fdcg_fw_verdict verdict = fdcg_fw_take_output(&fw_, clock_us(), data, static_cast<std::size_t>(bytes));
  note_force();
  if (config_.record != nullptr) ++config_.record->verdicts[verdict];
}

}  // namespace fdcg::dev
