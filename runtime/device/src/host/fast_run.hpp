// SPDX-License-Identifier: Apache-2.0
// A scene's simulated and recorded devices without real time: one thread, no waiting, every device on its own clock, which its
// reports carry forward. The same ticks, gate and log as the Host's; and the same bytes in the log every time. For tests,
// examples, and for playing a recording to a changed scene.
//
//   FastRun run;
//   run.open(config);      as Host::open; a hid device is refused
//   run.run(10, true);     ten seconds of the devices' time, armed as soon as the gate allows
//   run.status(0)
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/host_config.hpp"
#include "host/status.hpp"

namespace fdcg::dev {

class FastRun {
 public:
  FastRun();
  ~FastRun();
  FastRun(const FastRun&) = delete;
  FastRun& operator=(const FastRun&) = delete;

  // Returns an empty string on success; else the file or the device, the error and the remedy.
  std::string open(HostConfig config);
  // Once. seconds: of the devices' time; 0: until every recording has ended (refused where a device is simulated: it never
  // ends). arm: asks each device's gate until it has granted it once. is_stopping (may be empty) is asked every 1,000 ticks.
  // Empty: fine. Otherwise what is wrong with the log, or a device that could not be opened.
  std::string run(double seconds, bool arm, const std::function<bool()>& is_stopping = {});

  int device_count() const;
  const DeviceConfig& device(int index) const;
  // After run. Times are not measured.
  const DeviceStatus& status(int device) const;
  bool has_ended(int device) const;  // a recording that has been played
  bool has_failed_file() const;      // the text that run gave is the log's

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fdcg::dev
