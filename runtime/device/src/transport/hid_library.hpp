// SPDX-License-Identifier: Apache-2.0
// hidapi's two back ends, each loaded on first use: hidraw (the kernel's driver stays in place; preferred) and libusb (detaches
// the kernel's driver; where there is no hidraw). So a program starts, and runs simulated devices, on a machine that has
// neither. To be called by one thread only, the one that opens and closes.
#pragma once

#include <hidapi/hidapi.h>

#include <string>

#include "transport/transports.hpp"

namespace fdcg::dev {

struct HidLibrary {
  const char* name = nullptr;  // "hidraw", "libusb"
  bool is_libusb = false;
  decltype(&::hid_enumerate) enumerate = nullptr;
  decltype(&::hid_free_enumeration) free_enumeration = nullptr;
  decltype(&::hid_open_path) open_path = nullptr;
  decltype(&::hid_close) close = nullptr;
  decltype(&::hid_read_timeout) read_timeout = nullptr;
  decltype(&::hid_write) write = nullptr;
  decltype(&::hid_send_feature_report) send_feature_report = nullptr;
  decltype(&::hid_get_feature_report) get_feature_report = nullptr;
  decltype(&::hid_error) error = nullptr;
};

// kHidraw or kLibusb. Null with *problem where it cannot be had; a later call tries again. Lives until the process ends.
const HidLibrary* hid_library(HidBackend backend, std::string* problem);

}  // namespace fdcg::dev
