// SPDX-License-Identifier: Apache-2.0
#include "device.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace fdcg::vm {
namespace {

// Where an output report has the sequence number of the input report that it answers (schemas/fdcg-hid.md).
constexpr int kAnswersOffset = 17;
constexpr std::uint32_t kCountsPerMetre = 1'000'000;
constexpr std::uint16_t kWatchdogMs = 20, kNoWatchdogMs = 65'535;  // a minute: none

// While inside the surface the hand trembles, the more the deeper it is, and strokes, so that no force is like the one before.
constexpr double kTrembleM = 0.0005, kTrembleHz = 7, kStrokeM = 0.002, kStrokeHz = 3;

std::uint32_t get32(const std::uint8_t* at) {
  return at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 | std::uint32_t{at[3]} << 24;
}

}  // namespace

void set_crc(Bytes& report) {
  const std::uint16_t crc = fdcg_fw_crc16(report.data(), report.size() - 2);
  report[report.size() - 2] = static_cast<std::uint8_t>(crc);
  report[report.size() - 1] = static_cast<std::uint8_t>(crc >> 8);
}

std::array<double, 3> Hand::at(Nanoseconds now) {
  const double time_s = static_cast<double>(now) / kSecond;
  const double reach_m = last_ == 0 ? 0 : kSpeedMPerS * static_cast<double>(now - last_) / kSecond;
  last_ = now;
  z_m_ += std::clamp(target_m_ - z_m_, -reach_m, reach_m);
  const double inside = std::max(0.0, z_m_ / kBelowM);
  const double turn = 2 * std::numbers::pi * time_s;
  return {kStrokeM * std::sin(turn * kStrokeHz), 0, z_m_ + inside * kTrembleM * std::sin(turn * kTrembleHz)};
}

void Record::restart() {
  sent = answered = outputs = refused = misled = watchdog_trips = 0;
  oldest_answer = 0;
  most_force_n = force_n;
  round_trips_ns.clear();
}

Device::Device(std::unique_ptr<Port> port, int rate_hz, bool has_float_axes, bool has_watchdog)
    : port_(std::move(port)), rate_hz_(rate_hz), has_float_axes_(has_float_axes), has_watchdog_(has_watchdog) {
  record.round_trips_ns.reserve(kRemembered);
  power_up();
}

void Device::power_up() {
  fdcg_fw_config config{};
  config.counts_per_unit = kCountsPerMetre;
  std::fill_n(config.workspace_min_mm, 3, std::int16_t{-100});
  std::fill_n(config.workspace_max_mm, 3, std::int16_t{100});
  config.peak_force_n = 8;
  config.continuous_force_n = 3;
  config.rate_hz = static_cast<std::uint16_t>(rate_hz_);
  config.watchdog_ms = has_watchdog_ ? kWatchdogMs : kNoWatchdogMs;
  config.dof = 3;
  config.axes = FDCG_FW_CARTESIAN;
  fdcg_fw_init(&firmware_, &config);
  born_ = now_ns();
  sent_.assign(kRemembered, Sent());
}

void Device::plug(bool is_power_cycled) {
  if (is_power_cycled) power_up();
  port_->plug();
}

void Device::unplug() {
  port_->unplug();
  note_force(now_ns());
}

void Device::receive() {
  port_->receive(*this);
}

void Device::hear_another(std::uint32_t ahead) {
  Bytes report(FDCG_FW_OUTPUT_BYTES);
  report[0] = FDCG_FW_OUTPUT_ID;
  const std::uint32_t sequence = firmware_.echo + ahead;
  for (std::size_t i = 0; i < 4; ++i)
    report[1 + i] = static_cast<std::uint8_t>(sequence >> 8 * i);
  set_crc(report);
  on_output(report.data(), static_cast<int>(report.size()));
}

void Device::take_output(bool takes) {
  port_->take_output(takes);
  if (takes) receive();  // what has waited
}

void Device::lag(Nanoseconds on_reports, Nanoseconds on_outputs) {
  lag_of_reports_ = on_reports;
  lag_of_outputs_ = on_outputs;
  reports_.clear();
  outputs_.clear();
}

// What is due, but for the jitter of the ticks.
void Device::arrive(Nanoseconds now) {
  now += kSecond / rate_hz_ / 4;
  for (; !outputs_.empty() && outputs_.front().due <= now; outputs_.pop_front())
    take(outputs_.front().bytes.data(), static_cast<int>(outputs_.front().bytes.size()));
  for (; !reports_.empty() && reports_.front().due <= now; reports_.pop_front())
    send(reports_.front().bytes);
}

void Device::tick() {
  arrive(now_ns());
  const Nanoseconds now = now_ns();  // no earlier than what has arrived: the firmware's time does not go back
  note_force(now);
  const std::array<double, 3> place_m = hand.at(now);
  std::int32_t counts[3];
  for (int i = 0; i < 3; ++i) {
    counts[i] = has_float_axes_ ? std::bit_cast<std::int32_t>(static_cast<float>(place_m[i]))
                                : static_cast<std::int32_t>(std::lround(place_m[i] * kCountsPerMetre));
  }
  Bytes report(FDCG_FW_INPUT_BYTES);
  fdcg_fw_make_input(&firmware_, device_us(now), counts, 0, report.data());
  sent_[firmware_.sequence % kRemembered] = {firmware_.sequence, is_bad_, false, now};
  ++record.sent;
  if (wire_) return wire_(report);
  if (lag_of_reports_ == 0) return send(report);
  reports_.push_back({now + lag_of_reports_, report});
}

void Device::on_output(const std::uint8_t* data, int bytes) {
  if (lag_of_outputs_ == 0) return take(data, bytes);
  outputs_.push_back({now_ns() + lag_of_outputs_, Bytes(data, data + bytes)});
}

void Device::take(const std::uint8_t* data, int bytes) {
  const Nanoseconds now = now_ns();
  ++record.outputs;
  const fdcg_fw_verdict verdict = fdcg_fw_take_output(&firmware_, device_us(now), data, static_cast<std::size_t>(bytes));
  if (verdict > FDCG_FW_HELD) {
    ++record.refused;
    return;
  }
  record.last_output = now;
  record.is_enabled = (firmware_.status & FDCG_FW_ENABLED) != 0;
  const std::uint32_t answers = get32(data + kAnswersOffset);
  Sent& sent = sent_[answers % kRemembered];
  const bool is_known = sent.sequence == answers && sent.at != 0;
  if (is_known && !sent.is_answered) {
    sent.is_answered = true;
    ++record.answered;
    if (record.round_trips_ns.size() < kRemembered) record.round_trips_ns.push_back(static_cast<std::uint32_t>(now - sent.at));
  }
  note_force(now);
  if (record.force_n == 0) return;
  record.misled += !is_known || sent.is_bad;
  if (is_known) record.oldest_answer = std::max(record.oldest_answer, now - sent.at);
}

Bytes Device::on_get_feature(int report_id) {
  if (report_id != static_cast<int>(FDCG_FW_FEATURE_ID)) return {};
  Bytes report(FDCG_FW_FEATURE_BYTES);
  fdcg_fw_feature(&firmware_, report.data());
  if (wrong_byte_ >= 0) {
    report[static_cast<std::size_t>(wrong_byte_)] ^= 1;
    set_crc(report);
  }
  return report;
}

void Device::note_force(Nanoseconds now) {
  float force_n[3];
  fdcg_fw_force(&firmware_, device_us(now), force_n);
  const bool is_tripped = (firmware_.status & FDCG_FW_WATCHDOG) != 0;
  record.watchdog_trips += is_tripped && !was_tripped_;
  was_tripped_ = is_tripped;
  const double before_n = record.force_n;
  record.force_n = std::hypot(force_n[0], force_n[1], force_n[2]);
  record.most_force_n = std::max(record.most_force_n, record.force_n);
  if (record.force_n == 0 && now >= record.watched_from && record.first_zero == 0) {
    record.first_zero = now;
    record.output_before_zero = record.last_output;
  }
  if (record.first_zero == 0) record.most_rise_n = std::max(record.most_rise_n, record.force_n - before_n);
  if (before_n == 0 && record.force_n != 0) record.force_since = now;
}

}  // namespace fdcg::vm
