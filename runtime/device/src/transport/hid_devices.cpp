// SPDX-License-Identifier: Apache-2.0
#include "transport/hid_devices.hpp"

#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "shared/text.hpp"

namespace fdcg::dev {

namespace {

constexpr std::size_t kMostListed = 8;

// UTF-8, whatever the locale; what is no character becomes '?'.
std::string utf8(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != L'\0'; ++text) {
    const auto c = static_cast<std::uint32_t>(*text);
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c < 0x800) {
      out += {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 0x3F))};
    } else if (c < 0x10000 && (c < 0xD800 || c > 0xDFFF)) {
      out +=
          {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
    } else if (c >= 0x10000 && c < 0x110000) {
      out += {static_cast<char>(0xF0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 0x3F)),
              static_cast<char>(0x80 | (c >> 6 & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
    } else {
      out += '?';
    }
  }
  return one_line(out);
}

template <class... Numbers>
std::string printed(const char* format, Numbers... numbers) {
  char text[96];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

// A number that stands alone in a small file of sysfs; -1: there is none.
int number_in(const std::string& path) {
  std::ifstream file(path);
  int number = -1;
  return file >> number ? number : -1;
}

std::string group_name(gid_t group) {
  const struct group* const entry = getgrgid(group);
  return entry != nullptr ? entry->gr_name : std::to_string(group);
}

std::string own_groups() {
  gid_t groups[256];
  const int count = getgroups(256, groups);
  std::vector<std::string> names{group_name(getegid())};
  for (int i = 0; i < count; ++i) {
    if (groups[i] != getegid()) names.push_back(group_name(groups[i]));
  }
  return listed(names);
}

std::string wanted_text(const Match& match, const std::string& serial, const std::string& path) {
  std::string text = printed("%04x:%04x", match.vendor, match.product);
  if (match.usage_page >= 0) text += printed(", usage page %04x", static_cast<unsigned>(match.usage_page));
  if (match.usage >= 0) text += printed(", usage %04x", static_cast<unsigned>(match.usage));
  if (match.interface_number >= 0) text += printed(", interface %d", match.interface_number);
  if (!serial.empty()) text += ", serial " + in_quotes(serial);
  if (!path.empty()) text += ", path " + in_quotes(path);
  return text;
}

std::string seen_text(const std::vector<HidDevice>& devices) {
  if (devices.empty()) return "none is seen";
  std::string text = "seen: ";
  for (std::size_t i = 0; i < devices.size() && i < kMostListed; ++i)
    text += (i > 0 ? "; " : "") + describe(devices[i]);
  if (devices.size() > kMostListed) text += "; and " + std::to_string(devices.size() - kMostListed) + " more";
  return text;
}

// Interfaces of the same plugged-in device have paths that differ behind the last colon (libusb).
std::string before_colon(const std::string& path) {
  return path.substr(0, path.rfind(':'));
}

}  // namespace

std::vector<HidDevice> list_hid_devices(const HidLibrary& library, std::uint16_t vendor, std::uint16_t product) {
  std::vector<HidDevice> devices;
  hid_device_info* const list = library.enumerate(vendor, product);
  for (const hid_device_info* info = list; info != nullptr; info = info->next) {
    HidDevice device;
    device.path = info->path != nullptr ? info->path : "";
    device.vendor = info->vendor_id;
    device.product = info->product_id;
    device.usage_page = info->usage_page;
    device.usage = info->usage;
    device.interface_number = info->interface_number;
    device.serial = utf8(info->serial_number);
    device.manufacturer = utf8(info->manufacturer_string);
    device.product_name = utf8(info->product_string);
    devices.push_back(std::move(device));
  }
  library.free_enumeration(list);
  return devices;
}

Fit fit_of(const Match& match, const HidDevice& device) {
  if (match.vendor != device.vendor || match.product != device.product) return Fit::kNo;
  if (match.interface_number >= 0 && match.interface_number != device.interface_number) return Fit::kNo;
  if (device.usage_page == 0 && device.usage == 0) {
    const bool asks = match.usage_page >= 0 || match.usage >= 0;
    return asks && match.interface_number < 0 ? Fit::kUnsure : Fit::kYes;
  }
  const bool fits =
      (match.usage_page < 0 || match.usage_page == device.usage_page) && (match.usage < 0 || match.usage == device.usage);
  return fits ? Fit::kYes : Fit::kNo;
}

const HidDevice* choose_hid_device(const std::vector<HidDevice>& devices, const Match& match, const std::string& serial,
                                   const std::string& path, std::string* problem) {
  const auto is_meant = [&](const HidDevice& device) {
    return (serial.empty() || serial == device.serial) && (path.empty() || path == device.path);
  };
  bool is_unsure = false;
  for (const HidDevice& device : devices) {
    const Fit fit = fit_of(match, device);
    if (fit == Fit::kNo || !is_meant(device)) continue;
    const auto siblings = std::count_if(devices.begin(), devices.end(), [&](const HidDevice& other) {
      return fit_of(match, other) != Fit::kNo && before_colon(other.path) == before_colon(device.path);
    });
    if (fit == Fit::kYes || siblings == 1 || !path.empty()) return &device;
    is_unsure = true;
  }
  *problem = is_unsure
                 ? "the device has several HID interfaces and this back end does not tell their usages; give the profile's"
                   " match an \"interface\", or the scene's device a \"path\": "
                 : "no HID device is " + wanted_text(match, serial, path) + "; ";
  *problem += seen_text(devices);
  return nullptr;
}

std::string describe(const HidDevice& device) {
  std::string text = one_line(device.path) + printed(" (%04x:%04x", device.vendor, device.product);
  if (device.usage_page != 0) text += printed(", usage page %04x, usage %04x", device.usage_page, device.usage);
  if (device.interface_number >= 0) text += printed(", interface %d", device.interface_number);
  if (!device.serial.empty()) text += ", serial " + in_quotes(device.serial);
  if (!device.product_name.empty()) text += ", " + in_quotes(device.product_name);
  return text + ")";
}

std::string device_node(const HidDevice& device) {
  if (!device.path.empty() && device.path[0] == '/') return device.path;
  const std::string system = "/sys/bus/usb/devices/" + before_colon(device.path);
  const int bus = number_in(system + "/busnum"), number = number_in(system + "/devnum");
  return bus < 0 || number < 0 ? std::string() : printed("/dev/bus/usb/%03d/%03d", bus, number);
}

std::string permission_problem(const HidDevice& device) {
  const std::string node = device_node(device);
  if (node.empty() || access(node.c_str(), R_OK | W_OK) == 0) return {};
  if (errno != EACCES && errno != EPERM) return node + ": " + std::strerror(errno);
  std::string text = node + ": no permission to read and write it";
  struct stat status {};
  if (stat(node.c_str(), &status) == 0) {
    text += printed(" (mode %04o, owner %u, group ", static_cast<unsigned>(status.st_mode & 07777),
                    static_cast<unsigned>(status.st_uid)) +
            group_name(status.st_gid) + "; you are in " + own_groups() + ")";
  }
  return text + "; install the udev rule that 'fdcg-servo devices --udev' prints, then plug the device in again";
}

}  // namespace fdcg::dev
