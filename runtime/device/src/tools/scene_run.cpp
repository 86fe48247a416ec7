// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "fdcg/device_tools.hpp"
#include "host/fast_run.hpp"
#include "host/host.hpp"
#include "scene/scene_json.hpp"

namespace fdcg::dev {
namespace {

DeviceLook look_at(const DeviceConfig& device, const DeviceStatus& status) {
  DeviceLook look;
  look.name = device.name;
  look.is_recorded = device.source == DeviceSource::kRecorded;
  look.stated_rate_hz = device.profile.rate_hz;
  look.takes_output = device.profile.has_output;
  look.is_open = status.connection == Connection::kOpen;
  look.phase = status.last.phase;
  look.fault = status.last.fault;
  look.state = status.last.state;
  look.calmed = status.last.calmed;
  look.damping_n_s_per_m = status.last.damping_n_s_per_m;
  look.is_hot = status.last.is_hot;
  for (int i = 0; i < 3; ++i) {
    look.tip_m[i] = status.last.hip_world_m[i];
    look.wanted_force_n[i] = status.last.wanted_force_n[i];
    look.force_n[i] = status.last.force.force_n()[i];
  }
  look.bodies.assign(status.last.bodies, status.last.bodies + status.last.body_count);
  look.counters = status.counters;
  look.opened = status.opened;
  look.writes = status.writes;
  look.write_failures = status.write_failures;
  look.log_dropped = status.log_dropped;
  look.elapsed_s = status.elapsed_s;
  look.interval = status.interval;
  look.work = status.work;
  look.write = status.write;
  look.round_trip = status.round_trip;
  return look;
}

}  // namespace

// ---- Scene

struct Scene::Impl {
  HostConfig config;
};
Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::string Scene::read(const std::string& path, std::vector<std::string>* warnings) {
  return read_scene(path, &impl_->config, warnings);
}
void Scene::set_log_file(const std::string& path) {
  impl_->config.log_file = path;
}
void Scene::set_backend(const std::string& backend) {
  impl_->config.loop.backend = backend == "libusb" ? HidBackend::kLibusb : HidBackend::kHidraw;
}
const std::string& Scene::log_file() const {
  return impl_->config.log_file;
}
bool Scene::has_simulated_device() const {
  const std::vector<DeviceConfig>& devices = impl_->config.devices;
  return std::any_of(devices.begin(), devices.end(),
                     [](const DeviceConfig& device) { return device.source == DeviceSource::kSimulated; });
}

// ---- SceneRun

struct SceneRun::Impl {
  Host host;
};
SceneRun::SceneRun() : impl_(std::make_unique<Impl>()) {}
SceneRun::~SceneRun() = default;

std::string SceneRun::open(Scene scene) {
  return impl_->host.open(std::move(scene.impl_->config));
}
void SceneRun::allow_plugins() {
  impl_->host.allow_plugins();
}
std::string SceneRun::start() {
  return impl_->host.start();
}
const std::vector<std::string>& SceneRun::warnings() const {
  return impl_->host.warnings();
}
int SceneRun::device_count() const {
  return impl_->host.device_count();
}
void SceneRun::arm(int device) {
  impl_->host.arm(device);
}
void SceneRun::disarm(int device) {
  impl_->host.disarm(device);
}
DeviceLook SceneRun::look(int device) {
  const ConnectionReport connection = impl_->host.connection(device);
  DeviceLook look = look_at(impl_->host.device(device), impl_->host.status(device));
  look.is_open = connection.connection == Connection::kOpen;
  look.is_over = connection.is_over;
  look.problem = connection.problem;
  return look;
}
void SceneRun::keep_snapshots(std::size_t ticks) {
  impl_->host.keep_snapshots(ticks);
}
std::size_t SceneRun::take_snapshots(int device, fdcg_snapshot* snapshots, std::size_t most) {
  return impl_->host.take_snapshots(device, snapshots, most);
}
std::uint64_t SceneRun::dropped_snapshots(int device) const {
  return impl_->host.dropped_snapshots(device);
}
std::vector<std::string> SceneRun::object_names() const {
  std::vector<std::string> names;
  for (const ObjectConfig& object : impl_->host.objects())
    names.push_back(object.name);
  return names;
}
std::vector<std::string> SceneRun::body_names() const {
  std::vector<std::string> names;
  for (const ObjectConfig& object : impl_->host.objects())
    if (object.motion.kind == MotionKind::kBody) names.push_back(object.name);
  return names;
}
std::string SceneRun::log_failure() const {
  return impl_->host.log_failure();
}
void SceneRun::request_stop() noexcept {
  impl_->host.request_stop();
}
bool SceneRun::is_stopping() const noexcept {
  return impl_->host.is_stopping();
}
bool SceneRun::wait_ms(int milliseconds) {
  return impl_->host.wait_ms(milliseconds);
}
std::string SceneRun::stop() {
  return impl_->host.stop();
}

// ---- FastSceneRun

std::string FastSceneRun::run(Scene scene) {
  FastRun run;
  has_failed_file = true;
  if (std::string problem = run.open(std::move(scene.impl_->config)); !problem.empty()) return problem;
  std::string problem = run.run(for_s, arm, is_stopping);
  has_failed_file = run.has_failed_file();
  for (int i = 0; i < run.device_count(); ++i) {
    looks.push_back(look_at(run.device(i), run.status(i)));
    looks.back().is_over = run.has_ended(i);
  }
  return problem;
}

}  // namespace fdcg::dev
