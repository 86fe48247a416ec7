// SPDX-License-Identifier: Apache-2.0
// Transports by what they are made from. Each touches no device until it is opened.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tick/transport.hpp"
#include "transport/simulated_device.hpp"

namespace fdcg::dev {

// Of hidapi's. kAny: hidraw, and where that does not open the device, libusb.
enum class HidBackend { kAny, kHidraw, kLibusb };

// Which device, and how it is reached.
struct HidAccess {
  std::string serial, path;  // empty: the first that matches the profile
  HidBackend backend = HidBackend::kAny;
  int servo_priority = 0;  // of the thread that reads: libusb's own thread is given the same
};
std::unique_ptr<Transport> make_hid_transport(const Profile& profile, const HidAccess& access);

struct SerialAccess {
  std::string port;
  int baud = 115200;  // of serial_speeds()
};
std::vector<int> serial_speeds();
std::unique_ptr<Transport> make_serial_transport(const Profile& profile, const SerialAccess& access);

std::unique_ptr<Transport> make_simulated_transport(const SimulationConfig& config);

}  // namespace fdcg::dev
