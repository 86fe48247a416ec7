// SPDX-License-Identifier: Apache-2.0
// A device in memory with switches for the faults of real ones, and a profile and a scene for it: the tip moves along z, the
// top of a cube is at z = 0 of the device's frame. It counts protocol violations of the host: reading, writing or closing at
// the wrong time. Reading takes no lock and no heap.
#pragma once

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include "base/threads.hpp"
#include "profile/report_codec.hpp"
#include "scene/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev::test {

inline void sleep_ns(std::uint64_t ns) {
  const timespec pause{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  nanosleep(&pause, nullptr);
}
inline void sleep_ms(int ms) {
  sleep_ns(static_cast<std::uint64_t>(ms) * 1'000'000);
}

// True as soon as `is_so` is, false after `ms`.
template <class Condition>
bool within_ms(int ms, const Condition& is_so) {
  const std::uint64_t until_ns = monotonic_ns() + static_cast<std::uint64_t>(ms) * 1'000'000;
  while (!is_so()) {
    if (monotonic_ns() >= until_ns) return false;
    sleep_ns(200'000);
  }
  return true;
}

inline Field field(Role role, NumberType type, int offset, int axis = 0) {
  Field result;
  result.role = role;
  result.type = type;
  result.offset = static_cast<std::uint16_t>(offset);
  result.axis = static_cast<std::uint8_t>(axis);
  return result;
}

inline Profile fake_profile() {
  Profile profile;
  std::snprintf(profile.name, sizeof profile.name, "fake");
  profile.rate_hz = 1000;
  profile.axis_count = 3;
  profile.input.id = 1;
  profile.input.bytes = 17;
  profile.output.id = 2;
  profile.output.bytes = 22;
  profile.has_output = true;
  const auto add = [](ReportLayout* layout, const Field& one) { layout->fields[layout->field_count++] = one; };
  add(&profile.input, field(Role::kSequence, NumberType::kU32, 1));
  add(&profile.output, field(Role::kSequence, NumberType::kU32, 1));
  add(&profile.output, field(Role::kEcho, NumberType::kU32, 5));
  for (int axis = 0; axis < 3; ++axis) {
    add(&profile.input, field(Role::kAxis, NumberType::kF32, 5 + 4 * axis, axis));
    add(&profile.output, field(Role::kEffort, NumberType::kF32, 9 + 4 * axis, axis));
    profile.limits.effort[axis] = 5;
    profile.limits.workspace_min_m[axis] = -0.1;
    profile.limits.workspace_max_m[axis] = 0.1;
  }
  Field enable = field(Role::kEnable, NumberType::kU8, 21);
  enable.constant = 1;
  add(&profile.output, enable);
  profile.limits.force_n = 5;
  profile.limits.slew_n_per_s = 1e4;
  profile.limits.velocity_m_per_s = 1000;
  profile.limits.device_watchdog_s = 0.02;
  profile.safe_stop_count = 1;
  profile.safe_stop[0].bytes = 3;
  profile.safe_stop[0].data[0] = 9;
  return profile;
}

struct Written {
  std::uint64_t ns = 0;
  Command command;
};

// The state and history of a device; outlives its transport.
struct FakeDevice {
  // Knobs.
  std::atomic<bool> is_plugged{true}, is_silent{false}, holds_reads{false}, holds_writes{false}, refuses_writes{false};
  std::atomic<double> tip_z_m{0.01};
  std::atomic<bool> answers_polls{false};  // a read that does not wait gets a report that is due, too
  std::atomic<int> burst{0};               // reports that wait all at once
  std::atomic<int> excess{0};              // bytes too many on each report
  std::atomic<int> emergency{-1};
  std::uint64_t period_ns = 1'000'000;
  // What it saw.
  std::atomic<int> opened{0}, closed{0}, misused{0}, safe_stops{0};
  std::atomic<std::uint64_t> writes{0}, last_write_ns{0}, reads{0};
  std::atomic<double> force_n{0};  // of the last output report that it took
  std::atomic<bool> is_enabled{false};
  std::atomic<std::uint32_t> sequence{0}, echo{0};
  std::atomic<bool> is_open{false};
  std::atomic<int> inside_reads{0}, inside_writes{0};
  std::mutex mutex;
  std::vector<Written> written;  // under mutex
  std::vector<Written> all_written() {
    const std::lock_guard<std::mutex> lock(mutex);
    return written;
  }
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(FakeDevice& device) : device_(device), profile_(fake_profile()) {}

  std::string open() override {
    if (!device_.is_plugged) return "not plugged in";
    device_.misused += device_.is_open.exchange(true);
    ++device_.opened;
    return {};
  }
  void close() override {
    device_.misused += device_.inside_reads != 0 || device_.inside_writes != 0;
    device_.closed += device_.is_open.exchange(false);
  }
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override {
    const Inside inside(device_.inside_reads);
    device_.misused += !device_.is_open;
    ++device_.reads;
    while (device_.holds_reads)
      sleep_ms(1);
    if (!device_.is_plugged) return {ReadStatus::kLost, 0};
    if (!wait_for_report(timeout_ms)) return {ReadStatus::kTimeout, 0};
    if (!device_.is_plugged) return {ReadStatus::kLost, 0};
    Sample sample;
    sample.sequence = ++sequence_;
    sample.axis[2] = device_.tip_z_m;
    std::uint8_t report[kMaxReportBytes] = {};
    encode_input(profile_, sample, report);
    const int bytes = std::min(profile_.input.bytes + device_.excess.load(), capacity);
    for (int i = 0; i < bytes; ++i)
      data[i] = i < kMaxReportBytes ? report[i] : 0;
    return {ReadStatus::kReport, bytes};
  }
  bool write(const std::uint8_t* data, int bytes) override {
    const Inside inside(device_.inside_writes);
    device_.misused += !device_.is_open;
    while (device_.holds_writes)
      sleep_ns(300'000);
    device_.last_write_ns = monotonic_ns();
    ++device_.writes;
    if (!device_.is_plugged || device_.refuses_writes) return false;
    Command command;
    if (data[0] == 9 && bytes == 3) {
      ++device_.safe_stops;
    } else if (decode_output(profile_, data, bytes, &command)) {
      device_.force_n = std::fabs(command.effort[0]) + std::fabs(command.effort[1]) + std::fabs(command.effort[2]);
      device_.is_enabled = command.is_enabled;
      device_.misused += command.sequence <= device_.sequence;
      device_.sequence = command.sequence;
      device_.echo = command.echo;
      const std::lock_guard<std::mutex> lock(device_.mutex);
      device_.written.push_back({device_.last_write_ns, command});
    } else {
      ++device_.misused;
    }
    return true;
  }
  bool write_feature(const std::uint8_t*, int) override { return false; }
  int emergency_descriptor() const override { return device_.emergency; }

 private:
  struct Inside {
    explicit Inside(std::atomic<int>& count) : count_(count) { ++count_; }
    ~Inside() { --count_; }
    std::atomic<int>& count_;
  };
  bool wait_for_report(int timeout_ms) {
    if (device_.burst > 0) {
      --device_.burst;
      return true;
    }
    if (timeout_ms == 0 && !device_.answers_polls) return false;
    const std::uint64_t until_ns = monotonic_ns() + static_cast<std::uint64_t>(timeout_ms) * 1'000'000;
    const bool is_due = due_ns_ <= until_ns && !device_.is_silent;
    const std::uint64_t wake_ns = is_due ? due_ns_ : until_ns, now_ns = monotonic_ns();
    if (wake_ns > now_ns) sleep_ns(wake_ns - now_ns);
    constexpr std::uint64_t kQueued = 10;  // reports that wait for a host that is late
    if (is_due) due_ns_ += device_.period_ns;
    if (is_due && due_ns_ + kQueued * device_.period_ns < monotonic_ns()) due_ns_ = monotonic_ns();
    return is_due;
  }

  FakeDevice& device_;
  const Profile profile_;
  std::uint32_t sequence_ = 0;
  std::uint64_t due_ns_ = 0;
};

// One device and, unless file is empty, the cube.
inline HostConfig fake_config(const std::string& file) {
  HostConfig config;
  config.scene_file = "fake scene";
  DeviceConfig device;
  device.name = "fake";
  device.profile = fake_profile();
  device.mapping.offset_m[2] = 0.5;
  config.devices.push_back(device);
  if (!file.empty()) {
    ObjectConfig object;
    object.name = "cube";
    object.file = file;
    object.pose = fdcg_make_identity_pose();
    object.params = fdcg_make_params();
    config.objects.push_back(object);
  }
  config.loop.servo_priority = config.loop.writer_priority = 0;
  config.loop.lock_memory = false;
  return config;
}

}  // namespace fdcg::dev::test
