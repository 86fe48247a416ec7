// SPDX-License-Identifier: Apache-2.0
#include "transport/simulated_faults.hpp"

#include <algorithm>
#include <cstring>

#include "fdcg_firmware.h"

namespace fdcg::dev {
namespace {

constexpr std::uint64_t kNever = SimulationRecord::kNever;
constexpr int kExcessBytes = 16;  // of a report that is too long

std::uint64_t to_ns(double seconds) {
  return seconds < 9e9 ? static_cast<std::uint64_t>(std::max(0.0, seconds) * 1e9) : kNever / 2;
}

bool is_counted(SimulatedFaultKind kind) {
  switch (kind) {
    case SimulatedFaultKind::kShort:
    case SimulatedFaultKind::kLong:
    case SimulatedFaultKind::kGarbled:
    case SimulatedFaultKind::kUnknownId:
    case SimulatedFaultKind::kRepeated:
    case SimulatedFaultKind::kOutOfOrder:
    case SimulatedFaultKind::kNotFinite:
      return true;
    default:
      return false;
  }
}

}  // namespace

SimulatedFaults::SimulatedFaults(const SimulationConfig& config)
    : faults_(config.faults), record_(config.record), has_float_axes_(config.has_float_axes), random_(config.seed) {
  if (faults_.size() > SimulationRecord::kMaxFaults) faults_.resize(SimulationRecord::kMaxFaults);
  for (const SimulatedFault& fault : faults_)
    left_.push_back(fault.kind == SimulatedFaultKind::kRestart ? 1 : fault.reports);
}

std::uint64_t SimulatedFaults::begin_ns(int fault) const {
  return to_ns(faults_[fault].at_s);
}

std::uint64_t SimulatedFaults::end_ns(int fault) const {
  const SimulatedFault& f = faults_[fault];
  if (f.kind == SimulatedFaultKind::kUnplug && f.for_s <= 0) return kNever;
  return to_ns(f.at_s + f.for_s);
}

int SimulatedFaults::lasting(SimulatedFaultKind kind, std::uint64_t time_ns) const {
  for (int i = 0; i < static_cast<int>(faults_.size()); ++i)
    if (faults_[i].kind == kind && begin_ns(i) <= time_ns && time_ns < end_ns(i)) return i;
  return kNone;
}

std::uint64_t SimulatedFaults::unplugged_at(std::uint64_t opened_ns) const {
  std::uint64_t first = kNever;
  for (int i = 0; i < static_cast<int>(faults_.size()); ++i)
    if (faults_[i].kind == SimulatedFaultKind::kUnplug && begin_ns(i) > opened_ns) first = std::min(first, begin_ns(i));
  return first;
}

void SimulatedFaults::notice(int fault, std::uint64_t time_ns) const {
  if (record_ == nullptr || fault == kNone) return;
  std::uint64_t never = kNever;  // only the first time counts
  record_->noticed_ns[fault].compare_exchange_strong(never, time_ns, std::memory_order_acq_rel);
}

void SimulatedFaults::notice_unplugging(std::uint64_t time_ns) const {
  for (int i = 0; i < static_cast<int>(faults_.size()); ++i)
    if (faults_[i].kind == SimulatedFaultKind::kUnplug && begin_ns(i) <= time_ns) notice(i, time_ns);
}

bool SimulatedFaults::restarts(std::uint64_t time_ns) {
  for (int i = 0; i < static_cast<int>(faults_.size()); ++i) {
    if (faults_[i].kind != SimulatedFaultKind::kRestart || left_[i] == 0 || begin_ns(i) > time_ns) continue;
    left_[i] = 0;
    restarted_by_ = i;
    return true;
  }
  return false;
}

bool SimulatedFaults::touch(SimulatedPacket* packet) {
  const std::uint64_t now = packet->arrival_ns;
  const SimulatedPacket good = *packet;
  bool is_to_wait = false, is_repeated = false;
  packet->fault = std::max(restarted_by_, lasting(SimulatedFaultKind::kDeviceFault, now));
  restarted_by_ = kNone;
  for (int i = 0; i < static_cast<int>(faults_.size()); ++i) {
    const SimulatedFault& fault = faults_[i];
    if (!is_counted(fault.kind) || left_[i] <= 0 || begin_ns(i) > now) continue;
    --left_[i];
    packet->fault = i;
    is_to_wait |= fault.kind == SimulatedFaultKind::kOutOfOrder;
    is_repeated |= fault.kind == SimulatedFaultKind::kRepeated;
    damage(fault, packet);
  }
  if (const int stale = lasting(SimulatedFaultKind::kStale, now); stale != kNone) {
    packet->fault = stale;
    packet->arrival_ns = now + to_ns(faults_[stale].delay_s);
  }
  if (!is_repeated) last_ = good;
  return is_to_wait;
}

void SimulatedFaults::damage(const SimulatedFault& fault, SimulatedPacket* packet) {
  switch (fault.kind) {
    case SimulatedFaultKind::kShort:
      packet->bytes /= 2;
      break;
    case SimulatedFaultKind::kLong:
      std::memset(packet->data + packet->bytes, 0xAA, kExcessBytes);
      packet->bytes += kExcessBytes;
      break;
    case SimulatedFaultKind::kGarbled: {
      const auto bits = static_cast<std::uint64_t>(packet->bytes) * 8;
      const std::uint64_t first = random() % bits, flips = 1 + random() % 8;
      for (std::uint64_t i = 0; i < flips; ++i) {  // 11 bits apart: none is flipped twice
        const std::uint64_t bit = (first + 11 * i) % bits;
        packet->data[bit / 8] = static_cast<std::uint8_t>(packet->data[bit / 8] ^ 1u << bit % 8);
      }
      break;
    }
    case SimulatedFaultKind::kUnknownId:
      packet->data[0] = 0x7F;
      break;
    case SimulatedFaultKind::kRepeated:
      if (last_.bytes > 0) std::memcpy(packet->data, last_.data, sizeof packet->data);
      break;
    case SimulatedFaultKind::kNotFinite:
      not_a_number(packet);
      break;
    default:
      break;
  }
}

void SimulatedFaults::not_a_number(SimulatedPacket* packet) {
  if (!has_float_axes_) return;
  const std::uint8_t nan[4] = {0, 0, 0xC0, 0x7F};
  std::memcpy(packet->data + 9 + 4 * (random() % 3), nan, sizeof nan);
  const std::uint16_t crc = fdcg_fw_crc16(packet->data, FDCG_FW_INPUT_BYTES - 2);
  packet->data[FDCG_FW_INPUT_BYTES - 2] = static_cast<std::uint8_t>(crc);
  packet->data[FDCG_FW_INPUT_BYTES - 1] = static_cast<std::uint8_t>(crc >> 8);
}

// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t SimulatedFaults::random() {
  std::uint64_t z = random_ += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace fdcg::dev
