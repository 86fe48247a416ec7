// SPDX-License-Identifier: Apache-2.0
// The host: every device of a scene with its own servo thread, writer thread and fdcg_scene (or one servo thread and scene for
// all of them, HostConfig::is_shared), one supervisor that opens and re-opens them, and the log. All of it on one screen:
//
//   Host host;
//   host.open(config);     graphs opened and verified, scenes built; no thread yet
//   host.start();          threads run; devices are opened as they appear
//   host.arm(kAllDevices); each device's gate decides, in its next ticks
//   host.wait_ms(100);     ... status(), connection(), until is_stopping()
//   host.stop();           zero force, safe-stop reports, threads joined, devices closed, log written
//
// One thread at a time is in a host, but for request_stop.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fdcg/device.h"
#include "fdcg/transport.h"
#include "host/make_transport.hpp"
#include "host/status.hpp"
#include "scene/host_config.hpp"

namespace fdcg::dev {

// What stands between a device and its use. Empty `problem`: it is open, or nobody has tried yet.
struct ConnectionReport {
  Connection connection = Connection::kAbsent;
  std::string problem;   // why the last attempt to open it failed, and what to do
  bool is_over = false;  // a recording that has ended: it will not open again
};

using TransportMaker = std::function<std::unique_ptr<Transport>(const DeviceConfig&, const LoopConfig&)>;

class Host {
 public:
  explicit Host(TransportMaker maker = make_transport);  // another one: a caller's own devices
  ~Host();                                               // stops
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Empty: fine. Otherwise the file or the device, what is wrong with it, and what to do.
  std::string open(HostConfig config);
  // Empty: fine. A device that is not there is no error: it is waited for (connection() says what is missing).
  std::string start();
  // What the system did not grant (real-time priority, locked memory, a cpu), a line each: worse timing, nothing more.
  const std::vector<std::string>& warnings() const;

  bool has_started() const;
  int device_count() const;
  const DeviceConfig& device(int index) const;
  const std::vector<ObjectConfig>& objects() const;  // of an open scene
  // Before start. A table for a device of DeviceSource::kPlugin without a file; whether files that the scene names are loaded.
  std::string set_transport(int device, const fdcg_transport& transport);
  void allow_plugins();
  // Before start: so many ticks of each device are kept for take_snapshots; 0, the default: none, at no cost.
  void keep_snapshots(std::size_t ticks);
  // The oldest that were not taken yet, up to `most`; how many. What there was no room for is dropped, and counted.
  std::size_t take_snapshots(int device, fdcg_snapshot* snapshots, std::size_t most);
  std::uint64_t dropped_snapshots(int device) const;
  // A request; the gate grants it in a later tick, or status().last says arming_refused or the fault.
  void arm(int device);
  void disarm(int device);
  // Of an object with MotionKind::kDriven, by its name in the scene; felt by every device from its next tick on. Empty: fine.
  std::string set_pose(const std::string& object, const fdcg_pose& pose);

  // The newest that the device's threads have said, some 20 ms old at most.
  DeviceStatus status(int device);
  ConnectionReport connection(int device);
  std::string log_failure() const;  // empty: the log is well, or there is none

  // Asks wait_ms to return and the loop of the caller to end. Async-signal-safe.
  void request_stop() noexcept;
  bool is_stopping() const noexcept;
  // Sleeps up to that long; true as soon as a stop is requested or every device is over.
  bool wait_ms(int milliseconds);

  // Within kStopS, whatever state the devices are in. Empty, or what could not be ended in order ("takes no output").
  std::string stop();
  static constexpr double kStopS = 6;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fdcg::dev
