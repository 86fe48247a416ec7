// SPDX-License-Identifier: Apache-2.0
// The HID devices of this machine: enumeration, the match with a profile, and diagnosis of permissions. For the thread that
// opens and closes; takes milliseconds.
#pragma once

#include <string>
#include <vector>

#include "profile/profile.hpp"
#include "transport/hid_library.hpp"

namespace fdcg::dev {

struct HidDevice {
  std::string path;  // "/dev/hidraw0"; of libusb "1-2:1.0"
  std::uint16_t vendor = 0, product = 0;
  std::uint16_t usage_page = 0, usage = 0;  // 0, 0: not told (libusb)
  int interface_number = -1;                // -1: not a USB device
  std::string serial, manufacturer, product_name;
};

// Those of one vendor and product; 0, 0: all. libusb opens every device that it lists, to read its strings, so limit the
// request.
std::vector<HidDevice> list_hid_devices(const HidLibrary& library, std::uint16_t vendor = 0, std::uint16_t product = 0);

enum class Fit {
  kNo,
  kYes,
  kUnsure,  // the profile has a usage page or usage that this back end does not report
};
Fit fit_of(const Match& match, const HidDevice& device);

// The first of `devices` that fits and has that serial number and path (empty: any). An unsure one is chosen only if it is the
// only candidate interface of its device. Null with *problem: what was sought and what was found.
const HidDevice* choose_hid_device(const std::vector<HidDevice>& devices, const Match& match, const std::string& serial,
                                   const std::string& path, std::string* problem);

// "/dev/hidraw0 (16c0:0486, usage page ffab, usage 0200, interface 0, serial 'A1', 'Teensyduino RawHID')"
std::string describe(const HidDevice& device);

// The file that must be readable and writable: the path itself, or the USB device's node of a libusb path; empty: not known.
std::string device_node(const HidDevice& device);
// Empty: it may be opened, as far as permissions go. Otherwise the node, its owner and mode, the user's groups, and the remedy.
std::string permission_problem(const HidDevice& device);

}  // namespace fdcg::dev
