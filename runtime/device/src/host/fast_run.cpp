// SPDX-License-Identifier: Apache-2.0
#include "host/fast_run.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "base/threads.hpp"
#include "host/make_transport.hpp"
#include "host/servo_loop.hpp"
#include "profile/report_codec.hpp"
#include "recording/session_log.hpp"
#include "scene/scene_build.hpp"

namespace fdcg::dev {
namespace {

constexpr std::uint64_t kOriginNs = 1'000'000'000;  // of the host's clock: a time of 0 says "never" in places
constexpr std::uint64_t kArmAgainNs = 200'000'000;
constexpr std::uint64_t kRoomWaitNs = 1'000'000;
constexpr int kMostOpenings = 100'000;  // attempts in a row: 1,000 s of a simulated device's time; a file is there or not
constexpr int kLookTicks = 1000;

}  // namespace

struct FastUnit {
  std::unique_ptr<Transport> transport;
  DeviceState device;
  TickInput input;
  TickOutput output;
  std::vector<const ObjectConfig*> moving;
  DeviceStatus status;
  std::uint32_t sequence = 1;  // of the next output report
  std::uint64_t armed_ns = 0;  // when it was last asked to arm
  std::uint64_t last_good_ns = 0;
  bool is_open = false, has_ended = false, begins = false, wants_arming = false, has_write_failed = false;
};

// A scene and the devices that feel it, ticked as one.
struct FastGroup {
  DeviceRange devices;
  DeviceScene scene;
  std::uint64_t clock_ns = 0;
  int clock = 0;  // the device whose reports drive the ticks
};

struct FastRun::Impl {
  HostConfig config;
  SceneGraphs graphs;
  std::vector<std::unique_ptr<FastUnit>> units;
  std::vector<std::unique_ptr<FastGroup>> groups;
  std::unique_ptr<LogRing> ring;  // of all devices: the order of the log is that of the ticks
  SessionLog log;
  bool has_run = false, has_failed_file = false;

  std::string build_group(const DeviceRange& devices);
  std::string build_unit(std::size_t index, const DeviceSetup& setup);
  std::string start_log();
  std::string open_device(std::size_t index, bool is_alone);
  std::string tick(FastGroup& group);
  std::string choose_clock(FastGroup& group);
  void read_reports(FastUnit& unit, int timeout_ms) const;
  void catch_up(FastUnit& unit, std::uint64_t until_ns) const;
  void finish_input(FastUnit& unit) const;
  void send(FastUnit& unit, const GatedForce& force, std::uint32_t echo);
  void note_tick(std::size_t index);
  bool has_ended(const FastGroup& group) const;
  FastGroup* earliest(std::uint64_t until_ns) const;
};

FastRun::FastRun() : impl_(std::make_unique<Impl>()) {}
FastRun::~FastRun() = default;

std::string FastRun::open(HostConfig config) {
  for (DeviceConfig& device : config.devices) {
    if (device.source == DeviceSource::kHid || device.source == DeviceSource::kPlugin ||
        device.source == DeviceSource::kSerial) {
      return "device '" + device.name +
             "': a device that is not simulated or recorded lives in real time; run it without --fast";
    }
    device.simulation.is_real_time = device.is_recording_in_real_time = false;
  }
  impl_ = std::make_unique<Impl>();
  impl_->config = std::move(config);
  std::string problem = impl_->graphs.open(impl_->config);
  for (const DeviceRange& devices : device_ranges(impl_->config))
    if (problem.empty()) problem = impl_->build_group(devices);
  return problem;
}

std::string FastRun::Impl::build_group(const DeviceRange& devices) {
  auto group = std::make_unique<FastGroup>();
  group->devices = devices;
  std::string problem = build_device_scene(config, devices, graphs, &group->scene);
  for (std::size_t i = 0; i < devices.count && problem.empty(); ++i)
    problem = build_unit(devices.first + i, group->scene.setups[i]);
  groups.push_back(std::move(group));
  return problem;
}

std::string FastRun::Impl::build_unit(std::size_t index, const DeviceSetup& setup) {
  const DeviceConfig& from = config.devices[index];
  auto unit = std::make_unique<FastUnit>();
  unit->transport = make_transport(from, config.loop);
  fdcg_error error{};
  if (!begin_device(setup, &unit->device, &error)) return "device '" + from.name + "': " + error.message;
  for (const ObjectConfig& object : config.objects)
    if (is_moved(object.motion)) unit->moving.push_back(&object);
  unit->input.pose_count = static_cast<std::uint32_t>(unit->moving.size());
  units.push_back(std::move(unit));
  return {};
}

std::string FastRun::Impl::start_log() {
  if (config.log_file.empty()) return {};
  const auto count = static_cast<std::uint32_t>(units.size());
  ring = std::make_unique<LogRing>(LogRing::kUsualBytes * std::bit_ceil(count), static_cast<int>(count));
  LogRing* const rings[] = {ring.get()};
  std::string problem = log.start(config, rings, 1, &graphs);
  has_failed_file = !problem.empty();
  return problem;
}

bool FastRun::Impl::has_ended(const FastGroup& group) const {
  for (std::size_t i = 0; i < group.devices.count; ++i)
    if (!units[group.devices.first + i]->has_ended) return false;
  return true;
}

// The device whose clock is furthest behind and before the end; null: all have finished.
FastGroup* FastRun::Impl::earliest(std::uint64_t until_ns) const {
  FastGroup* first = nullptr;
  for (const auto& group : groups) {
    if (has_ended(*group) || (until_ns != 0 && group->clock_ns >= until_ns)) continue;
    if (first == nullptr || group->clock_ns < first->clock_ns) first = group.get();
  }
  return first;
}

std::string FastRun::run(double seconds, bool arm, const std::function<bool()>& is_stopping) {
  Impl& impl = *impl_;
  if (impl.units.empty() || impl.has_run) return "no scene is open, or it has run; open it first";
  for (const auto& unit : impl.units)
    unit->wants_arming = arm;
  const auto is_simulated = [](const DeviceConfig& device) { return device.source == DeviceSource::kSimulated; };
  const auto& devices = impl.config.devices;
  if (!(seconds > 0) && std::any_of(devices.begin(), devices.end(), is_simulated)) {
    return "a simulated device never ends; say for how long it runs (--for)";
  }
  impl.has_run = true;
  if (std::string problem = impl.start_log(); !problem.empty()) return problem;
  const auto until_ns = static_cast<std::uint64_t>(std::max(seconds, 0.0) * 1e9);
  std::string problem;
  for (std::uint64_t ticks = 1; problem.empty(); ++ticks) {
    FastGroup* const group = impl.earliest(until_ns);
    if (group == nullptr) break;
    problem = impl.tick(*group);
    if (ticks % kLookTicks == 0 && is_stopping && is_stopping()) break;
  }
  for (const auto& unit : impl.units) {
    if (unit->is_open) impl.send(*unit, GatedForce(), 0);
    unit->transport->close();
  }
  if (impl.config.log_file.empty()) return problem;
  const std::string of_log = impl.log.stop();
  impl.has_failed_file |= problem.empty() && !of_log.empty();
  return problem.empty() ? of_log : problem;
}

// A single device is opened with repeated attempts; one of several is tried once, and the others continue without it.
std::string FastRun::Impl::open_device(std::size_t index, bool is_alone) {
  FastUnit& unit = *units[index];
  std::string problem = "it could not be opened";
  const bool is_simulated = config.devices[index].source == DeviceSource::kSimulated;
  const int most = is_simulated && is_alone ? kMostOpenings : 1;
  for (int i = 0; i < most && !problem.empty(); ++i)
    problem = unit.transport->open();
  if (!problem.empty() && is_simulated && !is_alone) return {};
  if (!problem.empty()) {
    has_failed_file = most == 1;
    return "device '" + config.devices[index].name + "': " + problem;
  }
  unit.is_open = unit.begins = true;
  unit.has_write_failed = false;
  unit.last_good_ns = 0;
  unit.status.connection = Connection::kOpen;
  ++unit.status.opened;
  return {};
}

// All that have come, the first with a wait.
void FastRun::Impl::read_reports(FastUnit& unit, int timeout_ms) const {
  TickInput& input = unit.input;
  std::uint8_t data[kMaxReportBytes + 1];
  for (bool is_first = true; input.report_count < kMaxDrain; is_first = false) {
    const ReadResult read = unit.transport->read(data, sizeof data, is_first ? timeout_ms : 0);
    if (read.status != ReadStatus::kReport) {
      if (read.status == ReadStatus::kLost) input.read = ReadStatus::kLost;
      return;
    }
    RawReport& report = input.reports[input.report_count++];
    report.host_ns = kOriginNs + unit.transport->clock_ns();
    report.bytes = static_cast<std::uint16_t>(std::clamp(read.bytes, 0, kMaxReportBytes + 1));
    std::memcpy(report.data, data, std::min<std::size_t>(report.bytes, kMaxReportBytes));
    input.read = ReadStatus::kReport;
  }
}

// Reads the other devices' reports up to that time. Each device has its own clock, advanced only by its reads.
void FastRun::Impl::catch_up(FastUnit& unit, std::uint64_t until_ns) const {
  bool is_behind = true;
  while (is_behind && unit.is_open && unit.input.read != ReadStatus::kLost && unit.input.report_count < kMaxDrain) {
    is_behind = unit.transport->clock_ns() < until_ns;
    read_reports(unit, is_behind ? kReadTimeoutMs : 0);
  }
}

// Clock, poses and commands, as ServoLoop::gather has them.
void FastRun::Impl::finish_input(FastUnit& unit) const {
  TickInput& input = unit.input;
  const std::uint64_t clock_ns = unit.transport->clock_ns();
  input.now_ns = kOriginNs + clock_ns;
  input.begins = unit.begins;
  input.write_failed = unit.has_write_failed;
  for (std::size_t i = 0; i < unit.moving.size(); ++i)
    input.poses[i] = pose_at(*unit.moving[i], static_cast<double>(clock_ns) * 1e-9);
  input.arm = unit.wants_arming && input.now_ns - unit.armed_ns >= kArmAgainNs && unit.device.samples == kSamplesToArm;
  if (input.arm) unit.armed_ns = input.now_ns;
  unit.begins = false;
}

void FastRun::Impl::send(FastUnit& unit, const GatedForce& force, std::uint32_t echo) {
  const Profile& profile = unit.device.setup.profile;
  if (!profile.has_output) return;
  Command command;
  std::copy_n(force.effort(), profile.axis_count, command.effort);
  command.is_enabled = force.is_enabled();
  command.echo = echo;
  command.sequence = unit.sequence++;
  std::uint8_t report[kMaxReportBytes] = {};
  unit.has_write_failed = !unit.transport->write(report, encode_output(profile, command, report));
  if (!unit.has_write_failed) unit.input.sent = {kOriginNs + unit.transport->clock_ns(), command.sequence, command.is_enabled};
  ++unit.status.writes;
  unit.status.write_failures += unit.has_write_failed;
}

// Opens the devices that can be opened, reads the report of the device that is next, and sets the group's clock by it.
std::string FastRun::Impl::choose_clock(FastGroup& group) {
  const DeviceRange& devices = group.devices;
  FastUnit* waiting = nullptr;
  for (std::size_t i = 0; i < devices.count; ++i) {
    const std::size_t index = devices.first + (static_cast<std::size_t>(group.clock) + i) % devices.count;
    FastUnit& unit = *units[index];
    unit.input.report_count = 0;
    unit.input.read = unit.is_open ? ReadStatus::kTimeout : ReadStatus::kLost;
    if (unit.has_ended) continue;
    if (!unit.is_open && unit.transport->clock_ns() <= group.clock_ns) {
      if (std::string problem = open_device(index, devices.count == 1); !problem.empty()) return problem;
      if (unit.is_open) unit.input.read = ReadStatus::kTimeout;
    }
    if (waiting == nullptr && unit.is_open) waiting = &unit;
  }
  if (waiting == nullptr) {
    group.clock_ns += kAwayTickNs;
    return {};
  }
  read_reports(*waiting, kReadTimeoutMs);
  group.clock_ns = std::max(group.clock_ns, waiting->transport->clock_ns());
  return {};
}

std::string FastRun::Impl::tick(FastGroup& group) {
  if (std::string problem = choose_clock(group); !problem.empty()) return problem;
  const std::size_t first = group.devices.first;
  const int count = static_cast<int>(group.devices.count);
  Member members[kMaxDevices];
  for (int i = 0; i < count; ++i) {
    FastUnit& unit = *units[first + static_cast<std::size_t>(i)];
    catch_up(unit, group.clock_ns);
    finish_input(unit);
    members[i] = {&unit.device, &unit.input, &unit.output};
  }
  group.clock = group_tick(members, count);
  for (int i = 0; i < count; ++i) {
    FastUnit& unit = *units[first + static_cast<std::size_t>(i)];
    if (unit.is_open) send(unit, unit.output.force, unit.output.echo);
    if (unit.output.phase != Phase::kDisarmed) unit.wants_arming = false;  // after a fault the user must arm again
  }
  Event never;
  while (ring != nullptr && !ring->has_room())
    never.wait(kRoomWaitNs);
  for (int i = 0; i < count; ++i) {
    const std::size_t index = first + static_cast<std::size_t>(i);
    if (ring != nullptr) ring->put(units[index]->input, units[index]->output, static_cast<int>(index));
    note_tick(index);
  }
  return {};
}

void FastRun::Impl::note_tick(std::size_t index) {
  FastUnit& unit = *units[index];
  if (unit.output.has_sample) {
    if (unit.last_good_ns != 0) unit.status.interval.add(unit.input.now_ns - unit.last_good_ns);
    unit.last_good_ns = unit.input.now_ns;
    if (unit.output.round_trip_s > 0) unit.status.round_trip.add(static_cast<std::uint64_t>(unit.output.round_trip_s * 1e9));
  }
  unit.status.last = unit.output;
  unit.status.counters = unit.device.counters;
  unit.status.elapsed_s = static_cast<double>(unit.transport->clock_ns()) * 1e-9;
  if (!unit.is_open || unit.input.read != ReadStatus::kLost) return;
  unit.transport->close();
  unit.is_open = false;
  unit.has_ended = unit.transport->is_over();
  unit.status.connection = Connection::kAbsent;
}

int FastRun::device_count() const {
  return static_cast<int>(impl_->units.size());
}
const DeviceConfig& FastRun::device(int index) const {
  return impl_->config.devices[static_cast<std::size_t>(index)];
}
const DeviceStatus& FastRun::status(int device) const {
  return impl_->units[static_cast<std::size_t>(device)]->status;
}
bool FastRun::has_ended(int device) const {
  return impl_->units[static_cast<std::size_t>(device)]->has_ended;
}
bool FastRun::has_failed_file() const {
  return impl_->has_failed_file;
}

}  // namespace fdcg::dev
