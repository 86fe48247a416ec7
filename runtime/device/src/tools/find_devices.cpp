// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "fdcg/device_tools.hpp"
#include "profile/profile_json.hpp"
#include "shared/json/reader.hpp"
#include "transport/hid_devices.hpp"

namespace fdcg::dev {
namespace {

struct NamedProfile {
  std::string name;  // as a scene would give it
  Profile profile;
};

// The built-in ones, then the files.
std::string read_profiles(const std::vector<std::string>& files, std::vector<NamedProfile>* profiles) {
  for (const BuiltinProfile& built_in : builtin_profiles()) {
    NamedProfile named{std::string(built_in.name), {}};
    if (std::string problem = parse_profile(built_in.text, named.name, &named.profile); !problem.empty()) return problem;
    profiles->push_back(named);
  }
  for (const std::string& file : files) {
    NamedProfile named{file, {}};
    std::string text;
    std::string problem = json::read_text_file(file, json::Limits{}.bytes, &text);
    if (problem.empty()) problem = parse_profile(text, file, &named.profile);
    if (problem.empty() && named.profile.match.vendor == 0)
      problem = file + ": has no \"match\": it is of a device on a serial line";
    if (!problem.empty()) return problem;
    profiles->push_back(named);
  }
  return {};
}

const HidLibrary* load_library(const std::string& name, std::string* problem) {
  if (name == "libusb") return hid_library(HidBackend::kLibusb, problem);
  const HidLibrary* const hidraw = hid_library(HidBackend::kHidraw, problem);
  if (hidraw != nullptr || name == "hidraw") return hidraw;
  std::string libusb_problem;
  const HidLibrary* const libusb = hid_library(HidBackend::kLibusb, &libusb_problem);
  if (libusb == nullptr) *problem += "; " + libusb_problem;
  return libusb;
}

FoundDevice found_of(const HidDevice& device, const std::vector<NamedProfile>& profiles) {
  FoundDevice found;
  found.path = device.path;
  found.serial = device.serial;
  found.manufacturer = device.manufacturer;
  found.product_name = device.product_name;
  found.vendor = device.vendor;
  found.product = device.product;
  found.usage_page = device.usage_page;
  found.usage = device.usage;
  found.interface_number = device.interface_number;
  found.description = describe(device);
  for (const NamedProfile& named : profiles) {
    const Fit fit = fit_of(named.profile.match, device);
    if (fit != Fit::kNo) found.profiles.push_back({named.name, fit == Fit::kYes});
  }
  found.problem = permission_problem(device);
  return found;
}

}  // namespace

std::string find_devices(const DeviceSearch& search, std::vector<FoundDevice>* devices, std::string* backend) {
  std::vector<NamedProfile> profiles;
  if (std::string problem = read_profiles(search.profile_files, &profiles); !problem.empty()) return problem;
  std::string problem;
  const HidLibrary* const library = load_library(search.backend, &problem);
  if (library == nullptr) return problem;
  *backend = library->name;
  for (const HidDevice& device : list_hid_devices(*library))
    devices->push_back(found_of(device, profiles));
  return {};
}

// A hidraw node's parent is named BUS:VENDOR:PRODUCT.NUMBER, whatever the bus; the USB device itself is for libusb.
std::string make_udev_rules(const std::vector<std::string>& profile_files, std::string* rules) {
  std::vector<NamedProfile> profiles;
  if (std::string problem = read_profiles(profile_files, &profiles); !problem.empty()) return problem;
  *rules =
      "# fdcg: devices of its profiles for whoever sits at the machine, and for the group plugdev.\n"
      "# fdcg-servo devices --udev | sudo tee /etc/udev/rules.d/70-fdcg.rules\n"
      "# sudo udevadm control --reload && sudo udevadm trigger, or plug the device in again\n";
  const std::string grant = "TAG+=\"uaccess\", GROUP=\"plugdev\", MODE=\"0660\"\n";
  for (const NamedProfile& named : profiles) {
    const Match& match = named.profile.match;
    char upper[16], vendor[8], product[8];
    std::snprintf(upper, sizeof upper, "%04X:%04X", match.vendor, match.product);
    std::snprintf(vendor, sizeof vendor, "%04x", match.vendor);
    std::snprintf(product, sizeof product, "%04x", match.product);
    *rules += "\n# " + std::string(named.profile.name) + " (" + named.name + ")\n";
    *rules += "KERNEL==\"hidraw*\", SUBSYSTEM==\"hidraw\", KERNELS==\"*:" + std::string(upper) + ".*\", " + grant;
    *rules += "SUBSYSTEM==\"usb\", ENV{DEVTYPE}==\"usb_device\", ATTR{idVendor}==\"" + std::string(vendor) +
              "\", ATTR{idProduct}==\"" + product + "\", " + grant;
  }
  return {};
}

std::string print_profile(const std::string& name, std::string* text) {
  if (const BuiltinProfile* const built_in = find_builtin_profile(name)) {
    *text = built_in->text;
    return {};
  }
  std::string names;
  for (const BuiltinProfile& profile : builtin_profiles())
    names += (names.empty() ? "" : ", ") + std::string(profile.name);
  return "there is no built-in profile '" + name + "'; there are " + names;
}

}  // namespace fdcg::dev
