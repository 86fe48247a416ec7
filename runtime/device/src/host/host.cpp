// SPDX-License-Identifier: Apache-2.0
#include "host/host.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

#include "base/real_time.hpp"
#include "base/threads.hpp"
#include "host/emergency.hpp"
#include "host/servo_loop.hpp"
#include "host/stand_in.hpp"
#include "host/supervisor.hpp"
#include "host/writer.hpp"
#include "recording/session_log.hpp"
#include "scene/scene_build.hpp"
#include "tick/link.hpp"
#include "transport/plugin_transport.hpp"

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kStopNs = static_cast<std::uint64_t>(Host::kStopS * 1e9);
constexpr std::uint64_t kStopMarginNs = 100'000'000;  // of kStopS, for what follows the threads

}  // namespace

// A device and all that its threads touch.
struct Unit {
  Unit(std::unique_ptr<Transport> way, const Profile& profile) : transport(std::move(way)), writer(profile, *transport, link) {}

  std::unique_ptr<Transport> transport;
  Link link;
  Writer writer;
  ServoLoop servo;
  std::vector<std::size_t> moving;  // objects
  EmergencyExit emergency;
  StandIn stand_in{writer, link, emergency};
  // The latest status from the threads.
  DeviceStatus status;
  WriterStatus writes;
  bool is_left = false;  // its servo thread has not ended
};

// A scene and the devices that feel it: one servo thread.
struct Group {
  DeviceRange devices;
  DeviceScene scene;
  std::unique_ptr<LogRing> log;
  std::vector<ServoLoop*> loops;
};

// All data shared by the threads of a host. A thread that cannot be joined keeps its shared_ptr, so that its data is not freed.
struct Shared {
  HostConfig config;
  SceneGraphs graphs;
  std::vector<std::unique_ptr<Unit>> units;
  std::vector<std::unique_ptr<Group>> groups;
  Supervisor supervisor;
  SessionLog log;
  std::uint64_t start_ns = monotonic_ns();  // the same for all: motions of one object agree
};

struct Host::Impl {
  TransportMaker maker;
  std::shared_ptr<Shared> shared;
  Thread supervisor;
  std::vector<Thread> servos;              // as the groups
  std::vector<Thread> writers, stand_ins;  // as the units
  std::vector<std::string> warnings;
  bool is_running = false, has_run = false, has_log = false;
  std::atomic<bool> is_stopping{false};
  Event stop_asked;

  std::string build_group(const DeviceRange& devices);
  std::string build_unit(std::size_t index, Group& group);
  std::string start_threads();
  std::string start_log();
  void make_punctual();
  void read_status(Unit& unit);
  std::string end_threads();
};

Host::Host(TransportMaker maker) : impl_(std::make_unique<Impl>()) {
  impl_->maker = std::move(maker);
}

Host::~Host() {
  stop();
}

std::string Host::open(HostConfig config) {
  if (impl_->is_running) return "the host is running; stop it first";
  if (config.devices.empty()) return config.scene_file + ": \"devices\": the scene names none; a host needs at least one";
  if (config.devices.size() > kMaxDevices) {
    return config.scene_file + ": \"devices\": " + std::to_string(config.devices.size()) + " devices; at most " +
           std::to_string(kMaxDevices) + " are driven by one host";
  }
  auto shared = std::make_shared<Shared>();
  shared->config = std::move(config);
  std::string problem = shared->graphs.open(shared->config);
  if (!problem.empty()) return problem;
  impl_->shared = std::move(shared);
  impl_->warnings.clear();
  impl_->has_run = false;
  impl_->is_stopping.store(false);
  for (const DeviceRange& devices : device_ranges(impl_->shared->config))
    if (problem.empty()) problem = impl_->build_group(devices);
  if (!problem.empty()) impl_->shared = nullptr;
  return problem;
}

std::string Host::Impl::build_group(const DeviceRange& devices) {
  auto group = std::make_unique<Group>();
  group->devices = devices;
  for (std::size_t i = devices.first; devices.count > 1 && i < devices.first + devices.count; ++i) {
    const DeviceConfig& device = shared->config.devices[i];
    const bool is_free_running = device.source == DeviceSource::kSimulated && !device.simulation.is_real_time;
    if (is_free_running || (device.source == DeviceSource::kRecorded && !device.is_recording_in_real_time)) {
      return "device '" + device.name + "': it shares the scene with others, so all must live in real time; set its " +
             "simulation's real_time to true, or run the scene with --fast";
    }
  }
  std::string problem = build_device_scene(shared->config, devices, shared->graphs, &group->scene);
  if (!problem.empty()) return problem;
  if (!shared->config.log_file.empty()) {
    const auto count = static_cast<std::uint32_t>(devices.count);
    group->log = std::make_unique<LogRing>(LogRing::kUsualBytes * std::bit_ceil(count), static_cast<int>(count));
  }
  for (std::size_t i = devices.first; problem.empty() && i < devices.first + devices.count; ++i)
    problem = build_unit(i, *group);
  shared->groups.push_back(std::move(group));
  return problem;
}

std::string Host::Impl::build_unit(std::size_t index, Group& group) {
  const DeviceConfig& config = shared->config.devices[index];
  auto unit = std::make_unique<Unit>(maker(config, shared->config.loop), config.profile);
  ServoParts parts;
  parts.transport = unit->transport.get();
  parts.link = &unit->link;
  parts.writer = &unit->writer;
  parts.lost = &shared->supervisor.lost();
  parts.stalled = &unit->stand_in.stalled();
  parts.start_ns = shared->start_ns;
  parts.log = group.log.get();
  parts.log_place = static_cast<int>(index - group.devices.first);
  for (std::size_t i = 0; i < shared->config.objects.size(); ++i) {
    const ObjectConfig& object = shared->config.objects[i];
    if (!is_moved(object.motion)) continue;
    parts.moving.push_back(&object);
    unit->moving.push_back(i);
  }
  fdcg_error error;
  const DeviceSetup& setup = group.scene.setups[index - group.devices.first];
  if (!unit->servo.begin(setup, parts, &error)) return "device '" + config.name + "': " + error.message;
  unit->emergency.profile = &config.profile;
  unit->emergency.writer = &unit->writer;
  shared->supervisor.add({parts.transport, parts.link, &unit->servo, &unit->writer, &unit->emergency});
  group.loops.push_back(&unit->servo);
  shared->units.push_back(std::move(unit));
  return {};
}

std::string Host::start() {
  if (!impl_->shared) return "no scene is open";
  if (impl_->is_running) return "the host is running already";
  if (impl_->has_run) return "the host has stopped; open the scene again";
  std::string problem = impl_->start_log();
  if (!problem.empty()) return problem;
  impl_->is_running = impl_->has_run = true;
  problem = impl_->start_threads();
  if (!problem.empty()) {
    stop();
    return problem;
  }
  impl_->make_punctual();
  return {};
}

std::string Host::Impl::start_log() {
  if (shared->config.log_file.empty()) return {};
  std::vector<LogRing*> rings;
  for (const auto& group : shared->groups)
    rings.push_back(group->log.get());
  std::string problem = shared->log.start(shared->config, rings.data(), static_cast<int>(rings.size()), &shared->graphs);
  has_log = problem.empty();
  return problem;
}

// Each thread's body holds `shared`: see there.
std::string Host::Impl::start_threads() {
  servos.resize(shared->groups.size());
  writers.resize(shared->units.size());
  stand_ins.resize(shared->units.size());
  const std::shared_ptr<Shared> share = shared;
  for (std::size_t i = 0; i < shared->units.size(); ++i) {
    Unit* const unit = shared->units[i].get();
    if (!add_emergency_exit(&unit->emergency))
      warnings.push_back("too many devices: one gets no zero force if this program crashes");
    std::string problem = writers[i].start("fdcg-writer", [share, unit] { unit->writer.run(); });
    if (problem.empty()) problem = stand_ins[i].start("fdcg-stand-in", [share, unit] { unit->stand_in.run(); });
    if (!problem.empty()) return problem;
  }
  for (std::size_t i = 0; i < shared->groups.size(); ++i) {
    Group* const group = shared->groups[i].get();
    const int count = static_cast<int>(group->loops.size());
    std::string problem =
        servos[i].start("fdcg-servo", [share, group, count] { ServoLoop::run_together(group->loops.data(), count); });
    if (!problem.empty()) return problem;
  }
  return supervisor.start("fdcg-supervisor", [share] { share->supervisor.run(); });
}

// Called outside of the servo loop, which must not allocate strings.
void Host::Impl::make_punctual() {
  const LoopConfig& loop = shared->config.loop;
  const auto warn = [&](std::string warning) {
    if (!warning.empty()) warnings.push_back(std::move(warning));
  };
  if (loop.lock_memory) warn(lock_memory());
  // A device that answers as fast as it is read would keep a real-time thread from ever sleeping.
  const auto is_free_running = [&](std::size_t i) {
    const DeviceConfig& device = shared->config.devices[i];
    return device.source == DeviceSource::kSimulated && !device.simulation.is_real_time;
  };
  for (std::size_t i = 0; i < shared->groups.size(); ++i) {
    const DeviceRange& devices = shared->groups[i]->devices;
    if (is_free_running(devices.first)) continue;
    const std::string name = "device '" + shared->config.devices[devices.first].name +
                             (devices.count > 1 ? "' and those that share its scene" : "'") + ", servo thread";
    warn(set_real_time_priority(servos[i], name, loop.servo_priority));
    warn(set_cpu(servos[i], name, loop.cpu));
  }
  for (std::size_t i = 0; i < shared->units.size(); ++i) {
    if (is_free_running(i)) continue;
    const std::string name = "device '" + shared->config.devices[i].name + "', writer thread";
    warn(set_real_time_priority(writers[i], name, loop.writer_priority));
    set_real_time_priority(stand_ins[i], name, loop.writer_priority);  // where it is not granted, that has been said
  }
}

const std::vector<std::string>& Host::warnings() const {
  return impl_->warnings;
}

bool Host::has_started() const {
  return impl_->has_run;
}

int Host::device_count() const {
  return impl_->shared ? static_cast<int>(impl_->shared->units.size()) : 0;
}

const DeviceConfig& Host::device(int index) const {
  return impl_->shared->config.devices[static_cast<std::size_t>(index)];
}

const std::vector<ObjectConfig>& Host::objects() const {
  return impl_->shared->config.objects;
}

std::string Host::set_transport(int device, const fdcg_transport& transport) {
  if (device < 0 || device >= device_count()) return "the scene has no device " + std::to_string(device);
  if (impl_->is_running) return "the host is running; hand transports over before it is started";
  const DeviceConfig& config = this->device(device);
  auto* const plugin = dynamic_cast<PluginTransport*>(impl_->shared->units[static_cast<std::size_t>(device)]->transport.get());
  if (plugin == nullptr || !config.plugin.empty())
    return "device '" + config.name + "': its source is not \"plugin\" without a file";
  if (transport.struct_bytes < sizeof transport)
    return "device '" + config.name + "': struct_bytes of the transport is too small";
  if (transport.open == nullptr || transport.close == nullptr || transport.read == nullptr || transport.write == nullptr)
    return "device '" + config.name + "': the transport lacks open, close, read or write";
  plugin->set(transport);
  return {};
}

void Host::allow_plugins() {
  for (int i = 0; i < device_count(); ++i) {
    auto* const plugin = dynamic_cast<PluginTransport*>(impl_->shared->units[static_cast<std::size_t>(i)]->transport.get());
    if (plugin != nullptr) plugin->allow();
  }
}

void Host::keep_snapshots(std::size_t ticks) {
  if (impl_->is_running) return;
  for (int i = 0; i < device_count(); ++i)
    impl_->shared->units[static_cast<std::size_t>(i)]->servo.keep_snapshots(ticks);
}

std::size_t Host::take_snapshots(int device, fdcg_snapshot* snapshots, std::size_t most) {
  if (device < 0 || device >= device_count()) return 0;
  return impl_->shared->units[static_cast<std::size_t>(device)]->servo.snapshots().take(snapshots, most);
}

std::uint64_t Host::dropped_snapshots(int device) const {
  if (device < 0 || device >= device_count()) return 0;
  return impl_->shared->units[static_cast<std::size_t>(device)]->servo.snapshots().dropped();
}

void Host::arm(int device) {
  for (int i = 0; i < device_count(); ++i) {
    if (device == kAllDevices || device == i) impl_->shared->units[static_cast<std::size_t>(i)]->servo.request_arm();
  }
}

void Host::disarm(int device) {
  for (int i = 0; i < device_count(); ++i) {
    if (device == kAllDevices || device == i) impl_->shared->units[static_cast<std::size_t>(i)]->servo.request_disarm();
  }
}

std::string Host::set_pose(const std::string& object, const fdcg_pose& pose) {
  if (!impl_->shared) return "no scene is open";
  const auto& objects = impl_->shared->config.objects;
  const auto found = std::find_if(objects.begin(), objects.end(), [&](const ObjectConfig& one) { return one.name == object; });
  if (found == objects.end()) return "the scene has no object '" + object + "'";
  if (found->motion.kind != MotionKind::kDriven) {
    return "object '" + object + "' is not driven by the program; give it \"motion\": {\"kind\": \"driven\"} in the scene";
  }
  const auto index = static_cast<std::size_t>(found - objects.begin());
  for (const auto& unit : impl_->shared->units) {
    const auto place = std::find(unit->moving.begin(), unit->moving.end(), index);
    unit->servo.set_pose(static_cast<int>(place - unit->moving.begin()), pose);
  }
  return {};
}

void Host::Impl::read_status(Unit& unit) {
  unit.servo.take_status(&unit.status);
  unit.writer.take_status(&unit.writes);
  unit.status.writes = unit.writes.writes;
  unit.status.write_failures = unit.writes.failures;
  unit.status.write = unit.writes.write;
}

DeviceStatus Host::status(int device) {
  if (device < 0 || device >= device_count()) return DeviceStatus();
  Unit& unit = *impl_->shared->units[static_cast<std::size_t>(device)];
  impl_->read_status(unit);
  DeviceStatus status = unit.status;
  if (impl_->is_running || unit.is_left)
    tell_standstill(static_cast<double>(monotonic_ns() - impl_->shared->start_ns) * 1e-9, &status);
  return status;
}

ConnectionReport Host::connection(int device) {
  ConnectionReport report;
  if (device < 0 || device >= device_count()) return report;
  const Unit& unit = *impl_->shared->units[static_cast<std::size_t>(device)];
  report.connection = unit.link.is_open() ? Connection::kOpen : Connection::kAbsent;
  if (report.connection == Connection::kAbsent) report.problem = impl_->shared->supervisor.problem(device);
  report.is_over = impl_->shared->supervisor.is_over(device);
  return report;
}

std::string Host::log_failure() const {
  return impl_->has_log ? impl_->shared->log.failure() : std::string();
}

void Host::request_stop() noexcept {
  impl_->is_stopping.store(true);
  impl_->stop_asked.signal();
}

bool Host::is_stopping() const noexcept {
  return impl_->is_stopping.load();
}

bool Host::wait_ms(int milliseconds) {
  constexpr std::uint64_t kMsNs = 1'000'000;
  if (!is_stopping()) impl_->stop_asked.wait(static_cast<std::uint64_t>(std::max(milliseconds, 0)) * kMsNs);
  if (is_stopping()) return true;
  for (int i = 0; i < device_count(); ++i) {
    if (!impl_->shared->supervisor.is_over(i)) return false;
  }
  return device_count() > 0;
}

std::string Host::stop() {
  if (!impl_->shared || !impl_->is_running) return {};
  impl_->is_running = false;
  impl_->is_stopping.store(true);
  std::string problem = impl_->end_threads();
  for (const auto& unit : impl_->shared->units)
    remove_emergency_exit(&unit->emergency);
  if (impl_->has_log) {
    const std::string log_problem = impl_->shared->log.stop();
    if (!log_problem.empty()) problem += (problem.empty() ? "" : "; ") + log_problem;
  }
  impl_->has_log = false;
  return problem;
}

// The writers are stopped first, all at once: each sends its zero report without waiting for another thread.
std::string Host::Impl::end_threads() {
  const std::uint64_t until_ns = monotonic_ns() + kStopNs - kStopMarginNs;
  const auto join = [&](Thread& thread) {
    const std::uint64_t now_ns = monotonic_ns();
    if (thread.join_within(now_ns < until_ns ? until_ns - now_ns : 1)) return true;
    thread.abandon();
    return false;
  };
  for (const auto& unit : shared->units)
    unit->writer.request_stop();
  for (const auto& unit : shared->units)
    unit->servo.request_stop();
  for (const auto& unit : shared->units)
    unit->stand_in.request_stop();
  shared->supervisor.request_stop();
  const bool has_supervisor_ended = join(supervisor);
  std::string problem;
  std::vector<bool> have_servos_ended(shared->units.size());
  for (std::size_t i = 0; i < shared->groups.size(); ++i) {
    const DeviceRange& devices = shared->groups[i]->devices;
    const bool has_ended = join(servos[i]);
    std::fill_n(have_servos_ended.begin() + static_cast<std::ptrdiff_t>(devices.first), devices.count, has_ended);
  }
  for (std::size_t i = 0; i < shared->units.size(); ++i) {
    Unit& unit = *shared->units[i];
    const bool has_writer_ended = join(writers[i]), has_stand_in_ended = join(stand_ins[i]);
    const bool has_servo_ended = have_servos_ended[i];
    unit.link.close();
    unit.emergency.descriptor.store(-1);
    unit.emergency.call.store(nullptr);
    unit.is_left = !has_servo_ended;
    const bool has_ended = has_writer_ended && has_stand_in_ended && has_servo_ended && has_supervisor_ended;
    if (has_ended) unit.transport->close();
    if (has_ended && unit.writer.has_left_zero()) continue;
    problem += (problem.empty() ? "device '" : "; device '") + shared->config.devices[i].name + "': ";
    if (!has_writer_ended || !has_stand_in_ended || !unit.writer.has_left_zero()) {
      problem += "takes no output, and may not have got its zero force";
    } else {
      problem += !has_servo_ended ? "its read does not return" : "was being opened";
    }
    if (!has_ended) problem += "; it is left as it is";
  }
  return problem;
}

}  // namespace fdcg::dev
