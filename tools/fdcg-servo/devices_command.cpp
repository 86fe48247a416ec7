// SPDX-License-Identifier: Apache-2.0
// fdcg-servo devices: the HID devices of this machine, the profiles that fit them, and what stands in the way of opening them.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "../common/options.hpp"
#include "fdcg/device_tools.hpp"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

using Json = nlohmann::ordered_json;

struct DevicesArguments {
  dev::DeviceSearch search;
  bool json = false, udev = false;
  std::string printed;  // the profile's name; empty: none
};

std::string hexadecimal(unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", value);
  return text;
}

std::string text_of(const dev::FoundDevice& found) {
  std::string text = found.description + "\n  profile  ";
  for (std::size_t i = 0; i < found.profiles.size(); ++i) {
    text += (i == 0 ? "" : ", ") + found.profiles[i].name;
    if (!found.profiles[i].is_sure) text += " (perhaps: its usage page is not told here)";
  }
  if (found.profiles.empty()) text += "none";
  return text + "\n  open     " + (found.problem.empty() ? "yes" : "no: " + found.problem) + "\n";
}

Json json_of(const dev::FoundDevice& found) {
  Json json;
  json["path"] = found.path;
  json["vendor_id"] = hexadecimal(found.vendor);
  json["product_id"] = hexadecimal(found.product);
  json["usage_page"] = hexadecimal(found.usage_page);
  json["usage"] = hexadecimal(found.usage);
  json["interface"] = found.interface_number;
  json["serial"] = found.serial;
  json["manufacturer"] = found.manufacturer;
  json["product"] = found.product_name;
  json["profiles"] = Json::array();
  for (const dev::ProfileMatch& match : found.profiles)
    json["profiles"].push_back({{"name", match.name}, {"is_sure", match.is_sure}});
  json["can_open"] = found.problem.empty();
  if (!found.problem.empty()) json["problem"] = found.problem;
  return json;
}

int run_devices(const DevicesArguments& arguments) {
  if (!arguments.printed.empty()) {
    std::string text;
    if (const std::string problem = dev::print_profile(arguments.printed, &text); !problem.empty())
      return fail(kUsage, problem);
    std::fputs(text.c_str(), stdout);
    return kClean;
  }
  if (arguments.udev) {
    std::string rules;
    if (const std::string problem = dev::make_udev_rules(arguments.search.profile_files, &rules); !problem.empty())
      return fail(kFile, problem);
    std::fputs(rules.c_str(), stdout);
    return kClean;
  }
  std::vector<dev::FoundDevice> all;
  std::string backend;
  if (const std::string problem = dev::find_devices(arguments.search, &all, &backend); !problem.empty())
    return fail(kFile, problem);
  if (arguments.json) {
    Json json;
    json["backend"] = backend;
    json["devices"] = Json::array();
    for (const dev::FoundDevice& found : all)
      json["devices"].push_back(json_of(found));
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return kClean;
  }
  for (const dev::FoundDevice& found : all)
    std::fputs(text_of(found).c_str(), stdout);
  if (all.empty()) std::printf("No HID device is seen (%s).\n", backend.c_str());
  return kClean;
}

}  // namespace

Command add_devices(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("devices", "List the HID devices, the profiles that match them, and whether they can be opened.");
  command->footer(R"(Examples:
  fdcg-servo devices
  fdcg-servo devices --profile my-device.json --json
  fdcg-servo devices --print woodenhaptics > my-device.json
  fdcg-servo devices --udev | sudo tee /etc/udev/rules.d/70-fdcg.rules

)" + tools::exit_codes("success", "not used by this command"));
  const auto arguments = std::make_shared<DevicesArguments>();
  command->add_option("--profile", arguments->search.profile_files, "Match these profiles too, beside the built-in ones.")
      ->type_name("FILE...")
      ->group("Devices");
  add_hid_option(tools::OptionGroup(*command, "Devices"), arguments->search.backend, "hidraw, then libusb");
  const tools::OptionGroup output(*command, "Output");
  CLI::Option* const json = output.flag("--json", arguments->json, "Print JSON.");
  CLI::Option* const udev =
      output.flag("--udev", arguments->udev, "Print udev rules that let users open the devices of the profiles.")
          ->excludes(json);
  command->add_option("--print", arguments->printed, "Print this built-in profile, for a file of your own.")
      ->type_name("PROFILE")
      ->group("Output")
      ->excludes(json)
      ->excludes(udev);
  return {command, [arguments] { return run_devices(*arguments); }};
}

}  // namespace fdcg::servo
