// SPDX-License-Identifier: Apache-2.0
// One host on a device: a lock on its node (flock), which the system lets go when the process ends, however it ends. Programs
// that do not ask for it are not kept out: what they send shows in the device's echo (link_watch.hpp).
#pragma once

#include <string>

namespace fdcg::dev {

class DeviceClaim {
 public:
  DeviceClaim() = default;
  ~DeviceClaim() { release(); }
  DeviceClaim(const DeviceClaim&) = delete;
  DeviceClaim& operator=(const DeviceClaim&) = delete;

  // Empty: it is ours, or the system does not let us open the node for writing (then no other claim of ours could, either).
  // Otherwise who has it, and what to do.
  std::string take(const std::string& node);
  void release();
  // Of the node, for writing, without waiting; -1: none.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace fdcg::dev
