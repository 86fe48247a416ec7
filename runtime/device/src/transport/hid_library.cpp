// SPDX-License-Identifier: Apache-2.0
#include "transport/hid_library.hpp"

#include <dlfcn.h>

namespace fdcg::dev {

namespace {

template <class Function>
bool find(void* file, const char* name, Function* function) {
  *function = reinterpret_cast<Function>(dlsym(file, name));
  return *function != nullptr;
}

std::string load(bool is_libusb, HidLibrary* library) {
  const char* const file_name = is_libusb ? "libhidapi-libusb.so.0" : "libhidapi-hidraw.so.0";
  const std::string package = is_libusb ? "libhidapi-libusb0" : "libhidapi-hidraw0";
  // Both export the same names: local, so that neither finds the other's.
  void* const file = dlopen(file_name, RTLD_NOW | RTLD_LOCAL);
  if (file == nullptr) {
    const char* const reason = dlerror();
    return std::string(reason != nullptr ? reason : file_name) + "; install " + package +
           " (Debian, Ubuntu) or hidapi (others)";
  }
  HidLibrary found;
  found.name = is_libusb ? "libusb" : "hidraw";
  found.is_libusb = is_libusb;
  decltype(&::hid_init) init = nullptr;
  const bool is_whole =
      find(file, "hid_init", &init) && find(file, "hid_enumerate", &found.enumerate) &&
      find(file, "hid_free_enumeration", &found.free_enumeration) && find(file, "hid_open_path", &found.open_path) &&
      find(file, "hid_close", &found.close) && find(file, "hid_read_timeout", &found.read_timeout) &&
      find(file, "hid_write", &found.write) && find(file, "hid_send_feature_report", &found.send_feature_report) &&
      find(file, "hid_get_feature_report", &found.get_feature_report) && find(file, "hid_error", &found.error);
  if (!is_whole || init() != 0) {
    const std::string what = is_whole ? ": cannot be initialised" : ": lacks a function of hidapi 0.12";
    dlclose(file);
    return file_name + what + "; install " + package + " 0.13 or newer";
  }
  *library = found;
  return {};
}

}  // namespace

const HidLibrary* hid_library(HidBackend backend, std::string* problem) {
  static HidLibrary libraries[2];
  const bool is_libusb = backend == HidBackend::kLibusb;
  HidLibrary& library = libraries[is_libusb];
  if (library.name == nullptr) *problem = load(is_libusb, &library);
  return library.name != nullptr ? &library : nullptr;
}

}  // namespace fdcg::dev
