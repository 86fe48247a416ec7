// SPDX-License-Identifier: Apache-2.0
// The C API: a thin coat over Host. No exception leaves it.
#include <algorithm>
#include <cstring>
#include <exception>

#include "fdcg/device.h"
#include "host/emergency.hpp"
#include "host/host.hpp"
#include "profile/profile_json.hpp"
#include "scene/scene_json.hpp"

struct fdcg_host {
  fdcg::dev::Host host;
};

namespace fdcg::dev {
namespace {

static_assert(FDCG_ALL_DEVICES == kAllDevices);
static_assert(FDCG_DISARMED == static_cast<int>(Phase::kDisarmed) && FDCG_RAMPING == static_cast<int>(Phase::kRamping) &&
              FDCG_ARMED == static_cast<int>(Phase::kArmed) && FDCG_FADING == static_cast<int>(Phase::kFading));
static_assert(sizeof(fdcg_device_status) % 8 == 0, "struct_bytes counts in multiples of 8");

void say(fdcg_host_message* message, const std::string& text) {
  if (message == nullptr) return;
  const std::size_t bytes = std::min(text.size(), sizeof message->text - 1);
  std::memcpy(message->text, text.data(), bytes);
  message->text[bytes] = '\0';
}

std::string no_host() {
  return "host is NULL: fdcg_host_open gives one";
}

// `work` hands back a problem, or nothing.
template <class Work>
fdcg_status guarded(fdcg_status failure, fdcg_host_message* message, const Work& work) {
  try {
    const std::string problem = work();
    say(message, problem);
    return problem.empty() ? FDCG_OK : failure;
  } catch (const std::exception& error) {
    say(message, std::string("internal error: ") + error.what());
    return FDCG_E_IO;
  }
}

template <class Parse>
fdcg_status open_host(fdcg_host** host, fdcg_host_message* message, const Parse& parse) {
  if (host == nullptr) return guarded(FDCG_E_ARGUMENT, message, [] { return std::string("host is NULL"); });
  *host = nullptr;
  return guarded(FDCG_E_ARGUMENT, message, [&] {
    HostConfig config;
    std::string problem = parse(&config);
    if (!problem.empty()) return problem;
    auto made = std::make_unique<fdcg_host>();
    problem = made->host.open(std::move(config));
    if (problem.empty()) *host = made.release();
    return problem;
  });
}

void fill_status(const DeviceStatus& from, const ConnectionReport& connection, fdcg_device_status* to) {
  to->is_open = connection.connection == Connection::kOpen;
  to->phase = static_cast<std::uint32_t>(from.last.phase);
  to->fault = static_cast<std::uint32_t>(from.last.fault);
  to->arming_refused = from.last.arming_refused;
  to->state = from.last.state;
  std::copy_n(from.last.hip_world_m, 3, to->tip_world_m);
  std::copy_n(from.last.force.force_n(), 3, to->force_n);
  std::copy_n(from.last.wanted_force_n, 3, to->wanted_force_n);
  to->ticks = from.counters.ticks;
  to->late = from.counters.late;
  to->lost = from.counters.lost;
  for (const std::uint64_t rejected : from.counters.rejected)
    to->rejected += rejected;
  to->write_failures = from.write_failures;
  to->opened = from.opened;
  to->log_dropped = from.log_dropped;
  to->elapsed_s = from.elapsed_s;
  to->interval_p50_s = static_cast<double>(from.interval.quantile(0.5)) * 1e-9;
  to->interval_p999_s = static_cast<double>(from.interval.quantile(0.999)) * 1e-9;
  to->work_p50_s = static_cast<double>(from.work.quantile(0.5)) * 1e-9;
  to->work_p999_s = static_cast<double>(from.work.quantile(0.999)) * 1e-9;
  say(&to->problem, connection.problem);
  to->round_trip_p50_s = static_cast<double>(from.round_trip.quantile(0.5)) * 1e-9;
  to->round_trip_p999_s = static_cast<double>(from.round_trip.quantile(0.999)) * 1e-9;
}

const std::vector<std::string>& profile_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const BuiltinProfile& profile : builtin_profiles())
      all.emplace_back(profile.name);
    return all;
  }();
  return names;
}

}  // namespace
}  // namespace fdcg::dev

using namespace fdcg::dev;

extern "C" {

fdcg_status fdcg_host_open(const char* scene_file, fdcg_host** host, fdcg_host_message* message) {
  return open_host(host, message, [&](HostConfig* config) {
    return scene_file == nullptr ? std::string("scene_file is NULL") : read_scene(scene_file, config);
  });
}

fdcg_status fdcg_host_open_text(const char* scene, uint64_t bytes, const char* name, fdcg_host** host,
                                fdcg_host_message* message) {
  return open_host(host, message, [&](HostConfig* config) {
    if (scene == nullptr || name == nullptr) return std::string("scene or name is NULL");
    return parse_scene(std::string_view(scene, bytes), name, config);
  });
}

fdcg_status fdcg_host_set_transport(fdcg_host* host, int32_t device, const fdcg_transport* transport,
                                    fdcg_host_message* message) {
  return guarded(FDCG_E_ARGUMENT, message, [&]() -> std::string {
    if (host == nullptr || transport == nullptr) return host == nullptr ? "host is NULL" : "transport is NULL";
    return host->host.set_transport(device, *transport);
  });
}

void fdcg_host_allow_plugins(fdcg_host* host) {
  if (host != nullptr) host->host.allow_plugins();
}

fdcg_status fdcg_host_start(fdcg_host* host, fdcg_host_message* message) {
  if (host == nullptr) return guarded(FDCG_E_ARGUMENT, message, no_host);
  return guarded(FDCG_E_IO, message, [&] { return host->host.start(); });
}

fdcg_status fdcg_host_stop(fdcg_host* host, fdcg_host_message* message) {
  if (host == nullptr) return guarded(FDCG_E_ARGUMENT, message, no_host);
  return guarded(FDCG_E_IO, message, [&] { return host->host.stop(); });
}

void fdcg_host_close(fdcg_host* host) {
  delete host;
}

int fdcg_host_wait(fdcg_host* host, int milliseconds) {
  return host == nullptr ? 1 : host->host.wait_ms(milliseconds);
}

void fdcg_host_request_stop(fdcg_host* host) {
  if (host != nullptr) host->host.request_stop();
}

void fdcg_device_install_crash_handlers(void) {
  install_crash_handlers();
}

int32_t fdcg_host_get_device_count(const fdcg_host* host) {
  return host == nullptr ? 0 : host->host.device_count();
}

const char* fdcg_host_get_device_name(const fdcg_host* host, int32_t device) {
  return device < 0 || device >= fdcg_host_get_device_count(host) ? nullptr : host->host.device(device).name.c_str();
}

fdcg_status fdcg_host_keep_snapshots(fdcg_host* host, uint32_t ticks, fdcg_host_message* message) {
  if (host == nullptr) return guarded(FDCG_E_ARGUMENT, message, no_host);
  return guarded(FDCG_E_ARGUMENT, message, [&]() -> std::string {
    if (host->host.has_started()) return "the host has been started; ask for snapshots before";
    host->host.keep_snapshots(ticks);
    return {};
  });
}

uint32_t fdcg_host_take_snapshots(fdcg_host* host, int32_t device, fdcg_snapshot* snapshots, uint32_t most) {
  if (host == nullptr || snapshots == nullptr) return 0;
  return static_cast<uint32_t>(host->host.take_snapshots(device, snapshots, most));
}

uint64_t fdcg_host_get_dropped_snapshots(const fdcg_host* host, int32_t device) {
  return host == nullptr ? 0 : host->host.dropped_snapshots(device);
}

void fdcg_host_arm(fdcg_host* host, int32_t device) {
  if (host != nullptr) host->host.arm(device);
}

void fdcg_host_disarm(fdcg_host* host, int32_t device) {
  if (host != nullptr) host->host.disarm(device);
}

fdcg_status fdcg_host_set_pose(fdcg_host* host, const char* object, const fdcg_pose* pose, fdcg_host_message* message) {
  return guarded(FDCG_E_ARGUMENT, message, [&] {
    if (host == nullptr) return no_host();
    return object == nullptr || pose == nullptr ? std::string("object or pose is NULL") : host->host.set_pose(object, *pose);
  });
}

fdcg_status fdcg_host_get_status(fdcg_host* host, int32_t device, fdcg_device_status* status) {
  if (host == nullptr || status == nullptr) return FDCG_E_ARGUMENT;
  const std::uint32_t bytes = status->struct_bytes;
  if (bytes < 8 || bytes % 8 != 0 || device < 0 || device >= host->host.device_count()) return FDCG_E_ARGUMENT;
  return guarded(FDCG_E_IO, nullptr, [&] {
    fdcg_device_status full{};
    fill_status(host->host.status(device), host->host.connection(device), &full);
    full.struct_bytes = bytes;
    std::memset(static_cast<void*>(status), 0, bytes);
    std::memcpy(static_cast<void*>(status), &full, std::min<std::size_t>(bytes, sizeof full));
    return std::string();
  });
}

const char* fdcg_fault_text(uint32_t fault) {
  return fault < kFaults ? fault_text(static_cast<Fault>(fault)) : "a fault that this version does not know";
}

uint32_t fdcg_device_get_profile_count(void) {
  return static_cast<std::uint32_t>(profile_names().size());
}

const char* fdcg_device_get_profile_name(uint32_t index) {
  return index < profile_names().size() ? profile_names()[index].c_str() : nullptr;
}
}
