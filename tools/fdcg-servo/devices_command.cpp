// SPDX-License-Identifier: Apache-2.0
// fdcg-servo devices: the HID devices of this machine, the profiles that fit them, and what stands in the way of opening them.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json_reader.hpp"
#include "profile/profile_json.hpp"
#include "servo_commands.hpp"
#include "transport/hid_devices.hpp"

namespace fdcg::servo {
namespace {

using Json = nlohmann::ordered_json;

struct DevicesArguments {
  std::vector<std::string> profiles;  // files, beside the built-in ones
  std::string hid;
  bool json = false, udev = false;
};

struct NamedProfile {
  std::string name;  // as a scene would give it
  dev::Profile profile;
};

std::string hexadecimal(unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "%04x", value);
  return text;
}

// Empty, or what is wrong with a file.
std::string read_profiles(const DevicesArguments& arguments, std::vector<NamedProfile>* profiles) {
  for (const dev::BuiltinProfile& built_in : dev::builtin_profiles()) {
    NamedProfile named{std::string(built_in.name), {}};
    if (std::string problem = dev::parse_profile(built_in.text, named.name, &named.profile); !problem.empty()) return problem;
    profiles->push_back(named);
  }
  for (const std::string& file : arguments.profiles) {
    NamedProfile named{file, {}};
    std::string text;
    std::string problem = dev::read_text_file(file, dev::kMostJsonBytes, &text);
    if (problem.empty()) problem = dev::parse_profile(text, file, &named.profile);
    if (!problem.empty()) return problem;
    profiles->push_back(named);
  }
  return {};
}

// A hidraw node's parent is named BUS:VENDOR:PRODUCT.NUMBER, whatever the bus; the USB device itself is for libusb.
std::string udev_rules(const std::vector<NamedProfile>& profiles) {
  std::string text =
      "# fdcg: devices of its profiles for whoever sits at the machine, and for the group plugdev.\n"
      "# fdcg-servo devices --udev | sudo tee /etc/udev/rules.d/70-fdcg.rules\n"
      "# sudo udevadm control --reload && sudo udevadm trigger, or plug the device in again\n";
  const std::string grant = "TAG+=\"uaccess\", GROUP=\"plugdev\", MODE=\"0660\"\n";
  for (const NamedProfile& named : profiles) {
    const std::string vendor = hexadecimal(named.profile.match.vendor), product = hexadecimal(named.profile.match.product);
    char upper[16];
    std::snprintf(upper, sizeof upper, "%04X:%04X", named.profile.match.vendor, named.profile.match.product);
    text += "\n# " + std::string(named.profile.name) + " (" + named.name + ")\n";
    text += "KERNEL==\"hidraw*\", SUBSYSTEM==\"hidraw\", KERNELS==\"*:" + std::string(upper) + ".*\", " + grant;
    text += "SUBSYSTEM==\"usb\", ENV{DEVTYPE}==\"usb_device\", ATTR{idVendor}==\"" + vendor + "\", ATTR{idProduct}==\"" +
            product + "\", " + grant;
  }
  return text;
}

struct Found {
  dev::HidDevice device;
  std::vector<std::pair<std::string, bool>> profiles;  // true: for sure
  std::string problem;                                 // empty: it may be opened
};

std::string text_of(const Found& found) {
  std::string text = dev::describe(found.device) + "\n  profile  ";
  for (std::size_t i = 0; i < found.profiles.size(); ++i) {
    text += (i == 0 ? "" : ", ") + found.profiles[i].first;
    if (!found.profiles[i].second) text += " (perhaps: its usage page is not told here)";
  }
  if (found.profiles.empty()) text += "none";
  return text + "\n  open     " + (found.problem.empty() ? "yes" : "no: " + found.problem) + "\n";
}

Json json_of(const Found& found) {
  const dev::HidDevice& device = found.device;
  Json json;
  json["path"] = device.path;
  json["vendor_id"] = "0x" + hexadecimal(device.vendor);
  json["product_id"] = "0x" + hexadecimal(device.product);
  json["usage_page"] = "0x" + hexadecimal(device.usage_page);
  json["usage"] = "0x" + hexadecimal(device.usage);
  json["interface"] = device.interface_number;
  json["serial"] = device.serial;
  json["manufacturer"] = device.manufacturer;
  json["product"] = device.product_name;
  json["profiles"] = Json::array();
  for (const auto& [name, is_sure] : found.profiles)
    json["profiles"].push_back({{"name", name}, {"is_sure", is_sure}});
  json["can_open"] = found.problem.empty();
  if (!found.problem.empty()) json["problem"] = found.problem;
  return json;
}

const dev::HidLibrary* load_library(const std::string& name, std::string* problem) {
  if (name == "libusb") return dev::hid_library(dev::HidBackend::kLibusb, problem);
  const dev::HidLibrary* const hidraw = dev::hid_library(dev::HidBackend::kHidraw, problem);
  if (hidraw != nullptr || name == "hidraw") return hidraw;
  std::string libusb_problem;
  const dev::HidLibrary* const libusb = dev::hid_library(dev::HidBackend::kLibusb, &libusb_problem);
  if (libusb == nullptr) *problem += "; " + libusb_problem;
  return libusb;
}

int run_devices(const DevicesArguments& arguments) {
  std::vector<NamedProfile> profiles;
  if (const std::string problem = read_profiles(arguments, &profiles); !problem.empty()) return fail(kFile, problem);
  if (arguments.udev) {
    std::fputs(udev_rules(profiles).c_str(), stdout);
    return kClean;
  }
  std::string problem;
  const dev::HidLibrary* const library = load_library(arguments.hid, &problem);
  if (library == nullptr) return fail(kFile, problem);
  std::vector<Found> all;
  for (dev::HidDevice& device : dev::list_hid_devices(*library)) {
    Found found;
    for (const NamedProfile& named : profiles) {
      const dev::Fit fit = dev::fit_of(named.profile.match, device);
      if (fit != dev::Fit::kNo) found.profiles.emplace_back(named.name, fit == dev::Fit::kYes);
    }
    found.problem = dev::permission_problem(device);
    found.device = std::move(device);
    all.push_back(std::move(found));
  }
  if (arguments.json) {
    Json json;
    json["backend"] = library->name;
    json["devices"] = Json::array();
    for (const Found& found : all)
      json["devices"].push_back(json_of(found));
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return kClean;
  }
  for (const Found& found : all)
    std::fputs(text_of(found).c_str(), stdout);
  if (all.empty()) std::printf("No HID device is seen (%s).\n", library->name);
  return kClean;
}

}  // namespace

Command add_devices(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("devices", "List the HID devices, the profiles that fit them, and who may open them");
  command->footer(R"(
Examples:
  fdcg-servo devices
  fdcg-servo devices --profile my-device.json --json
  fdcg-servo devices --udev | sudo tee /etc/udev/rules.d/70-fdcg.rules)");
  const auto arguments = std::make_shared<DevicesArguments>();
  command->add_option("--profile", arguments->profiles, "Try these profiles too")->type_name("FILE...");
  command->add_option("--hid", arguments->hid, "hidapi's back end; default: hidraw, then libusb")
      ->type_name("hidraw|libusb")
      ->check(CLI::IsMember({"hidraw", "libusb"}));
  CLI::Option* const json = command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--udev", arguments->udev, "Print udev rules that let users open the profiles' devices")->excludes(json);
  return {command, [arguments] { return run_devices(*arguments); }};
}

}  // namespace fdcg::servo
