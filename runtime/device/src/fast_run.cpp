// SPDX-License-Identifier: Apache-2.0
#include "fast_run.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "make_transport.hpp"
#include "report_codec.hpp"
#include "scene_build.hpp"
#include "session_log.hpp"
#include "threads.hpp"

namespace fdcg::dev {
namespace {

constexpr std::uint32_t kLogRingBytes = 1u << 22;
constexpr std::uint64_t kOriginNs = 1'000'000'000;  // of the host's clock: a time of 0 says "never" in places
constexpr std::uint64_t kArmAgainNs = 200'000'000;
constexpr std::uint64_t kRoomWaitNs = 1'000'000;
constexpr int kMostOpenings = 100'000;  // attempts in a row: 1,000 s of a simulated device's time; a file is there or not
constexpr int kLookTicks = 1000;

struct Unit {
  std::unique_ptr<Transport> transport;
  DeviceScene scene;
  DeviceState device;
  TickInput input;
  TickOutput output;
  std::unique_ptr<LogRing> log;
  std::vector<const ObjectConfig*> moving;
  DeviceStatus status;
  std::uint32_t sequence = 1;  // of the next output report
  std::uint64_t armed_ns = 0;  // when it was last asked to arm
  std::uint64_t last_good_ns = 0;
  bool is_open = false, has_ended = false, begins = false, wants_arming = false, has_write_failed = false;
};

}  // namespace

struct FastRun::Impl {
  HostConfig config;
  SceneGraphs graphs;
  std::vector<std::unique_ptr<Unit>> units;
  SessionLog log;
  bool has_run = false, has_failed_file = false;

  std::string build_unit(std::size_t index);
  std::string start_log();
  std::string open_device(std::size_t index);
  std::string tick(std::size_t index);
  void gather(Unit& unit) const;
  void send(Unit& unit, const GatedForce& force, std::uint32_t echo);
  Unit* earliest(std::uint64_t until_ns, std::size_t* index);
};

FastRun::FastRun() : impl_(std::make_unique<Impl>()) {}
FastRun::~FastRun() = default;

std::string FastRun::open(HostConfig config) {
  for (DeviceConfig& device : config.devices) {
    if (device.source == DeviceSource::kHid) {
      return "device '" + device.name + "': a hid device lives in real time; run it without --fast";
    }
    device.simulation.is_real_time = device.is_recording_in_real_time = false;
  }
  impl_ = std::make_unique<Impl>();
  impl_->config = std::move(config);
  std::string problem = impl_->graphs.open(impl_->config);
  for (std::size_t i = 0; i < impl_->config.devices.size() && problem.empty(); ++i)
    problem = impl_->build_unit(i);
  return problem;
}

std::string FastRun::Impl::build_unit(std::size_t index) {
  const DeviceConfig& from = config.devices[index];
  auto unit = std::make_unique<Unit>();
  unit->transport = make_transport(from, config.loop);
  if (std::string problem = build_device_scene(config, index, graphs, &unit->scene); !problem.empty()) return problem;
  fdcg_error error{};
  if (!begin_device(unit->scene.setup, &unit->device, &error)) return "device '" + from.name + "': " + error.message;
  for (const ObjectConfig& object : config.objects)
    if (is_moved(object.motion)) unit->moving.push_back(&object);
  unit->input.pose_count = static_cast<std::uint32_t>(unit->moving.size());
  if (!config.log_file.empty()) unit->log = std::make_unique<LogRing>(kLogRingBytes);
  units.push_back(std::move(unit));
  return {};
}

std::string FastRun::Impl::start_log() {
  if (config.log_file.empty()) return {};
  std::vector<LogRing*> rings;
  for (const auto& unit : units)
    rings.push_back(unit->log.get());
  std::string problem = log.start(config, rings.data(), static_cast<int>(rings.size()));
  has_failed_file = !problem.empty();
  return problem;
}

// The device whose clock is behind the others', as long as it is before the end; null: all are done.
Unit* FastRun::Impl::earliest(std::uint64_t until_ns, std::size_t* index) {
  Unit* first = nullptr;
  for (std::size_t i = 0; i < units.size(); ++i) {
    Unit& unit = *units[i];
    const std::uint64_t clock_ns = unit.transport->clock_ns();
    if (unit.has_ended || (until_ns != 0 && clock_ns >= until_ns)) continue;
    if (first != nullptr && clock_ns >= first->transport->clock_ns()) continue;
    first = &unit;
    *index = i;
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
  std::size_t index = 0;
  for (std::uint64_t ticks = 1; problem.empty() && impl.earliest(until_ns, &index) != nullptr; ++ticks) {
    problem = impl.tick(index);
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

std::string FastRun::Impl::open_device(std::size_t index) {
  Unit& unit = *units[index];
  std::string problem = "it could not be opened";
  const int most = config.devices[index].source == DeviceSource::kSimulated ? kMostOpenings : 1;
  for (int i = 0; i < most && !problem.empty(); ++i)
    problem = unit.transport->open();
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

// Reports, clock and poses, as ServoLoop::gather has them.
void FastRun::Impl::gather(Unit& unit) const {
  TickInput& input = unit.input;
  input.report_count = 0;
  input.read = ReadStatus::kTimeout;
  std::uint8_t data[kMaxReportBytes + 1];
  while (input.report_count < kMaxDrain) {
    const ReadResult read = unit.transport->read(data, sizeof data, input.report_count == 0 ? 1 : 0);
    if (read.status != ReadStatus::kReport) {
      if (read.status == ReadStatus::kLost) input.read = ReadStatus::kLost;
      break;
    }
    RawReport& report = input.reports[input.report_count++];
    report.host_ns = kOriginNs + unit.transport->clock_ns();
    report.bytes = static_cast<std::uint16_t>(std::clamp(read.bytes, 0, kMaxReportBytes + 1));
    std::memcpy(report.data, data, std::min<std::size_t>(report.bytes, kMaxReportBytes));
    input.read = ReadStatus::kReport;
  }
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

void FastRun::Impl::send(Unit& unit, const GatedForce& force, std::uint32_t echo) {
  const Profile& profile = unit.scene.setup.profile;
  if (!profile.has_output) return;
  Command command;
  std::copy_n(force.effort(), profile.axis_count, command.effort);
  command.is_enabled = force.is_enabled();
  command.echo = echo;
  command.sequence = unit.sequence++;
  std::uint8_t report[kMaxReportBytes] = {};
  encode_output(profile, command, report);
  unit.has_write_failed = !unit.transport->write(report, profile.output.bytes);
  ++unit.status.writes;
  unit.status.write_failures += unit.has_write_failed;
}

std::string FastRun::Impl::tick(std::size_t index) {
  Unit& unit = *units[index];
  if (!unit.is_open) {
    if (std::string problem = open_device(index); !problem.empty()) return problem;
  }
  gather(unit);
  device_tick(unit.device, unit.input, &unit.output);
  send(unit, unit.output.force, unit.output.echo);
  if (unit.output.phase != Phase::kDisarmed) unit.wants_arming = false;  // after a fault it is the user's to ask again
  if (unit.output.has_sample) {
    if (unit.last_good_ns != 0) unit.status.interval.add(unit.input.now_ns - unit.last_good_ns);
    unit.last_good_ns = unit.input.now_ns;
  }
  Event never;
  while (unit.log != nullptr && !unit.log->has_room())
    never.wait(kRoomWaitNs);
  if (unit.log != nullptr) unit.log->put(unit.input, unit.output);
  unit.status.last = unit.output;
  unit.status.counters = unit.device.counters;
  unit.status.elapsed_s = static_cast<double>(unit.transport->clock_ns()) * 1e-9;
  if (unit.input.read != ReadStatus::kLost) return {};
  unit.transport->close();
  unit.is_open = false;
  unit.has_ended = unit.transport->is_over();
  unit.status.connection = Connection::kAbsent;
  return {};
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
