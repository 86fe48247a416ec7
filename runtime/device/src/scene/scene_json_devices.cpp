// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "profile/profile_json.hpp"
#include "scene/scene_parser.hpp"
#include "session/session_reader.hpp"
#include "tick/gate.hpp"
#include "transport/plugin_transport.hpp"
#include "transport/simulated_device.hpp"

namespace fdcg::dev {
namespace {

constexpr double kOrthonormalTolerance = 1e-9;  // of a rotation matrix
constexpr double kLeastPad_m = 1e-9;            // of fdcg_scene_set_finger_radius
constexpr json::Keys kMappingKeys = {"scale", "rotation_xyzw", "rotation_matrix", "offset_m"};
constexpr json::Keys kContactKeys = {"offset_m", "closed_m", "pad_radius_m"};
constexpr json::Keys kGripKeys = {"button", "seconds"};
constexpr json::Keys kTurnKeys = {"button", "seconds", "rotation_xyzw"};
constexpr json::Keys kScriptKeys = {"at_s", "place_m", "buttons", "notes"};
constexpr json::Keys kSimulationKeys = {"rate_hz",
                                        "mass_kg",
                                        "damping_n_s_per_m",
                                        "hand_stiffness_n_per_m",
                                        "hand_damping_n_s_per_m",
                                        "quantum_m",
                                        "start_m",
                                        "amplitude_m",
                                        "frequency_hz",
                                        "real_time",
                                        "seed",
                                        "force_n",
                                        "watchdog_s",
                                        "script",
                                        "float_axes",
                                        "faults"};
constexpr json::Keys kFaultKeys = {"kind", "at_s", "for_s", "delay_s", "reports"};

// What every device may have, and what only those of its source.
void allow_keys(const json::Value& device, DeviceSource source) {
  struct Own {
    json::Keys keys;
    const char* of;
  };
  static constexpr Own kOwn[] = {{{"profile", "serial", "path"}, " of a hid device"},
                                 {{"simulation"}, " of a simulated device"},
                                 {{"profile", "recording", "simulation", "rate_hz", "limits"}, " of a recorded device"},
                                 {{"plugin", "settings", "rate_hz", "limits"}, " of a plugin's device"},
                                 {{"profile", "port", "baud"}, " of a serial device"}};
  const Own& own = kOwn[static_cast<int>(source)];
  std::vector<std::string> keys{"name", "source", "mapping", "contacts", "grip", "turn", "dead_man", "force_limit_n", "notes"};
  keys.insert(keys.end(), own.keys.begin(), own.keys.end());
  device.allow_only(keys, own.of);
}

}  // namespace

void SceneParser::read_device(const json::Value& from) {
  DeviceConfig device;
  device.source = static_cast<DeviceSource>(from["source"].choice_or(0, {"hid", "simulated", "recorded", "plugin", "serial"}));
  allow_keys(from, device.source);
  device.name = from["name"].text(kLongestName);
  refuse_twins(from, config_.devices, device.name);
  if (device.source == DeviceSource::kHid) {
    read_profile(from, &device);
    if (device.profile.match.vendor == 0) from["profile"].fail("has no \"match\", by which a HID device is found");
    if (device.profile.input.is_text()) from["profile"].fail("has reports of text, which a HID device does not send");
    device.serial = from["serial"].text_or("", kLongestName);
    device.path = from["path"].text_or("", kLongestPath);
  } else if (device.source == DeviceSource::kSerial) {
    read_profile(from, &device);
    read_serial(from, &device);
  } else if (device.source == DeviceSource::kPlugin) {
    read_plugin(from, &device);
  } else if (device.source == DeviceSource::kSimulated) {
    if (from["simulation"]) read_simulation(from["simulation"].object(kSimulationKeys), &device.simulation);
    device.profile = simulated_profile(device.simulation);
    warn_of_rate(device);
  } else {
    read_recording(from, &device);
  }
  if (from["mapping"]) read_mapping(from["mapping"].object(kMappingKeys), &device.mapping);
  read_contacts(from, &device);
  device.most_force_n = scene_force_n_;
  if (from["force_limit_n"]) {
    const double own = from["force_limit_n"].number(above_0(kMostForce, "N"));
    device.most_force_n = scene_force_n_ > 0 ? std::min(own, scene_force_n_) : own;
  }
  if (device.source == DeviceSource::kHid) refuse_same_node(from, device);
  config_.devices.push_back(std::move(device));
}

void SceneParser::read_serial(const json::Value& from, DeviceConfig* device) const {
  SerialAccess& access = device->serial_access;
  access.port = from["port"].text(kLongestPath);
  access.baud = static_cast<int>(from["baud"].integer_or(access.baud, 1, 100'000'000));
  const std::vector<int> speeds = serial_speeds();
  if (std::find(speeds.begin(), speeds.end(), access.baud) == speeds.end()) {
    std::vector<std::string> texts;
    for (const int speed : speeds)
      texts.push_back(std::to_string(speed));
    from["baud"].must_be("one of " + listed(texts));
  }
  for (const DeviceConfig& other : config_.devices) {
    if (other.source == DeviceSource::kSerial && other.serial_access.port == access.port)
      from["port"].fail("is that of device " + in_quotes(other.name) + " too; a port has one owner");
  }
}

// Its limits are those of a profile; how its reports are laid out is ours.
void SceneParser::read_plugin(const json::Value& from, DeviceConfig* device) {
  if (from["plugin"]) device->plugin = beside(file_name_, from["plugin"].text(kLongestPath));
  // never from where the system looks for libraries
  if (!device->plugin.empty() && device->plugin.find('/') == std::string::npos) device->plugin.insert(0, "./");
  device->plugin_settings = from["settings"] ? from["settings"].dump() : "{}";
  if (from["settings"] && !from["settings"].is_object()) from["settings"].fail("is no object");
  read_plugin_profile(from, device);
}

void SceneParser::read_plugin_profile(const json::Value& from, DeviceConfig* device) {
  DeviceLimits limits;
  constexpr int kAxes = 3;
  if (from["limits"]) read_limits(from["limits"], kAxes, &limits);
  device->limits_text = from["limits"] ? from["limits"].dump() : "{}";
  device->profile = plugin_profile(from["rate_hz"].number({1, 20000, true, "Hz"}), limits);
  warn_of_rate(*device);
  if (!are_known(limits, kAxes, device->profile.rate_hz) && warnings_ != nullptr)
    warnings_->push_back("device " + in_quotes(device->name) + ": a limit is not known: the device is read but gives no force");
}

// Two devices of a scene that could not but open the same node.
void SceneParser::refuse_same_node(const json::Value& from, const DeviceConfig& device) const {
  for (const DeviceConfig& other : config_.devices) {
    if (other.source != DeviceSource::kHid) continue;
    if (!device.path.empty() && device.path == other.path)
      return from["path"].fail("is that of device " + in_quotes(other.name) + " too; a device node has one owner");
    const Match &a = device.profile.match, &b = other.profile.match;
    const bool is_same_match = a.vendor == b.vendor && a.product == b.product && a.usage_page == b.usage_page &&
                               a.usage == b.usage && a.interface_number == b.interface_number;
    if (is_same_match && device.path.empty() && other.path.empty() && device.serial == other.serial)
      return from["profile"].fail("finds the same device as that of " + in_quotes(other.name) +
                                  "; give each a \"serial\" or a \"path\" of its own (fdcg-servo devices)");
  }
}

void SceneParser::read_button(const json::Value& from, HeldButton* button) {
  button->mask = std::uint32_t{1} << from["button"].integer(0, kMaxButtons - 1);
  button->seconds = from["seconds"].number_or(button->seconds, {0.001, 1000, true, "s"});
}

void SceneParser::read_contacts(const json::Value& from, DeviceConfig* device) {
  Grip& grip = device->grip;
  if (from["dead_man"]) {
    const json::Value dead_man = from["dead_man"].object({"button"});
    const ReportLayout& input = device->profile.input;
    const bool has_buttons = std::any_of(input.fields, input.fields + input.field_count,
                                         [](const Field& field) { return field.role == Role::kButtons; });
    if (!has_buttons) from["dead_man"].fail("asks for a button, and the device's profile has none");
    device->dead_man_mask = std::uint32_t{1} << dead_man["button"].integer(0, kMaxButtons - 1);
  }
  if (from["grip"]) read_button(from["grip"].object(kGripKeys), &grip.close);
  if (from["turn"]) {
    const json::Value turn = from["turn"].object(kTurnKeys);
    read_button(turn, &grip.turn);
    // up to half a turn, the shorter way round: the end then defines the way
    read_unit(turn["rotation_xyzw"], grip.turn_xyzw, 4);
    const double sign = grip.turn_xyzw[3] < 0 ? -1 : 1;
    for (double& x : grip.turn_xyzw)
      x *= sign;
  }
  if (!from["contacts"]) return;
  const std::vector<json::Value> contacts = from["contacts"].objects(1, kMaxContacts, kContactKeys);
  device->contact_count = std::max<int>(1, static_cast<int>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i]["offset_m"].numbers(device->contacts_m[i], 3, kLengths);
    std::copy_n(device->contacts_m[i], 3, grip.closed_m[i]);
    device->pads_m[i] = contacts[i]["pad_radius_m"].number_or(0, {0, 1, true, "m"});
    if (device->pads_m[i] > 0 && device->pads_m[i] < kLeastPad_m) {
      contacts[i]["pad_radius_m"].fail("is " + shown_number(device->pads_m[i]) + "; it must be 0 (a point) or a number from " +
                                       shown_number(kLeastPad_m) + " to 1 m");
    }
    if (!contacts[i]["closed_m"]) continue;
    contacts[i]["closed_m"].numbers(grip.closed_m[i], 3, kLengths);
    if (grip.close.mask == 0) contacts[i]["closed_m"].fail("has no \"grip\" that would close it; name a button there");
  }
}

void SceneParser::parse_profile_of(const json::Value& from, const std::string& text, const std::string& name,
                                   DeviceConfig* device) {
  std::vector<std::string> warnings;
  if (const std::string error = parse_profile(text, name, &device->profile, &warnings); !error.empty()) {
    return from["profile"].fail("is refused: " + error);
  }
  device->profile_text = text;
  if (warnings_ == nullptr) return;
  for (const std::string& warning : warnings)
    warnings_->push_back("device " + in_quotes(device->name) + ": " + warning);
}

// For a device without a profile file: parse_profile() warns of the rate of a file.
void SceneParser::warn_of_rate(const DeviceConfig& device) {
  const std::string warning = rate_warning(device.profile.rate_hz);
  if (warnings_ != nullptr && !warning.empty()) warnings_->push_back("device " + in_quotes(device.name) + ": " + warning);
}

// A built-in one by its name, a file, or in place.
void SceneParser::read_profile(const json::Value& from, DeviceConfig* device) {
  if (from["profile"].is_object()) return parse_profile_of(from, from["profile"].dump(), "it", device);
  const std::string name = from["profile"].text(kLongestPath);
  if (name.empty()) return;
  if (const BuiltinProfile* const built_in = find_builtin_profile(name)) {
    return parse_profile_of(from, std::string(built_in->text), "built-in " + name, device);
  }
  if (name.find_first_of("./\\") == std::string::npos) {
    std::vector<std::string> names;
    for (const BuiltinProfile& profile : builtin_profiles())
      names.emplace_back(profile.name);
    return from["profile"].fail("is " + in_quotes(name) + "; it must be a file's name (with .json) or one of the built-in " +
                                listed(names) + did_you_mean(name, names));
  }
  if (!options_.reads_files) return from["profile"].fail("names a file, and none is read here");
  std::string text;
  const std::string path = beside(file_name_, name);
  if (const std::string error = json::read_text_file(path, json::Limits{}.bytes, &text); !error.empty()) {
    return from["profile"].fail("is refused: " + error);
  }
  parse_profile_of(from, text, path, device);
}

// The profile is the one that the recorded device had, unless the scene gives another.
void SceneParser::read_recording(const json::Value& from, DeviceConfig* device) {
  device->recording = beside(file_name_, from["recording"].text(kLongestPath));
  if (from["profile"]) return read_profile(from, device);
  if (from["rate_hz"]) return read_plugin_profile(from, device);  // of a plugin's device, as in a log of its recording
  if (from["simulation"]) {  // of a device that was simulated when it was recorded: so a log of its recording says all
    read_simulation(from["simulation"].object(kSimulationKeys), &device->simulation);
    device->profile = simulated_profile(device->simulation);
    return warn_of_rate(*device);
  }
  if (!options_.reads_files) return from["recording"].fail("names a file, and none is read here");
  SessionReader reader;
  if (const std::string error = reader.open(device->recording); !error.empty()) {
    return from["recording"].fail("is refused: " + error);
  }
  HostConfig recorded;
  const std::string error = parse_scene(reader.header().scene, device->recording + " (its scene)", &recorded);
  if (!error.empty()) return from["recording"].fail("is refused: " + error);
  const std::size_t index = find_recorded_device(recorded, device->name);
  if (index == recorded.devices.size()) {
    std::vector<std::string> names;
    for (const DeviceConfig& other : recorded.devices)
      names.push_back(other.name);
    return from["recording"].fail("has no device " + in_quotes(device->name) + " but " + listed(names) +
                                  "; give this device the name of one of them");
  }
  device->profile = recorded.devices[index].profile;
  device->profile_text = recorded.devices[index].profile_text;
  device->simulation = recorded.devices[index].simulation;
  device->limits_text = recorded.devices[index].limits_text;
  warn_of_rate(*device);
}

void SceneParser::read_mapping(const json::Value& from, Mapping* mapping) {
  mapping->scale = from["scale"].number_or(1, {1e-6, 1e6});
  if (from["offset_m"]) from["offset_m"].numbers(mapping->offset_m, 3, kLengths);
  double* const r = mapping->rotation;
  if (from["rotation_matrix"]) {
    if (from["rotation_xyzw"]) from["rotation_matrix"].fail("stands beside rotation_xyzw; give one of them");
    from["rotation_matrix"].numbers(r, 9, {-1 - kOrthonormalTolerance, 1 + kOrthonormalTolerance});
    double worst = std::fabs(r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
                             r[2] * (r[3] * r[7] - r[4] * r[6]) - 1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        worst = std::max(worst, std::fabs(r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2] -
                                          (i == j ? 1 : 0)));
    if (!(worst <= kOrthonormalTolerance)) {
      from["rotation_matrix"].fail("is off a rotation by " + shown_number(worst) + "; at most " +
                                   shown_number(kOrthonormalTolerance) +
                                   ": three rows of length 1, at right angles, "
                                   "right-handed");
    }
  } else if (double q[4]; from["rotation_xyzw"]) {
    read_unit(from["rotation_xyzw"], q, 4);
    const double length = norm(q, 4);
    for (double& x : q)
      x /= length;
    rows_of(q, r);
  }
}

void SceneParser::read_simulation(const json::Value& from, SimulationConfig* simulation) {
  SimulationConfig& s = *simulation;
  s.rate_hz = from["rate_hz"].number_or(s.rate_hz, {1, 20000, true, "Hz"});
  s.mass_kg = from["mass_kg"].number_or(s.mass_kg, {0.001, 100, true, "kg"});
  s.damping_n_s_per_m = from["damping_n_s_per_m"].number_or(s.damping_n_s_per_m, from_0(1000, "N s/m"));
  s.hand_stiffness_n_per_m = from["hand_stiffness_n_per_m"].number_or(s.hand_stiffness_n_per_m, from_0(1e5, "N/m"));
  s.hand_damping_n_s_per_m = from["hand_damping_n_s_per_m"].number_or(s.hand_damping_n_s_per_m, from_0(1000, "N s/m"));
  s.quantum_m = from["quantum_m"].number_or(s.quantum_m, {1e-9, 0.01, true, "m"});
  if (from["script"]) read_script(from, &s);
  if (from["start_m"]) from["start_m"].numbers(s.start_m, 3, metres(10));
  if (from["amplitude_m"]) from["amplitude_m"].numbers(s.amplitude_m, 3, metres(10));
  if (from["frequency_hz"]) from["frequency_hz"].numbers(s.frequency_hz, 3, from_0(1000, "Hz"));
  s.is_real_time = from["real_time"].boolean_or(s.is_real_time);
  s.seed = static_cast<std::uint64_t>(from["seed"].integer_or(static_cast<std::int64_t>(s.seed), 0, 9007199254740992));
  s.force_n = from["force_n"].number_or(s.force_n, above_0(kMostForce, "N"));
  s.watchdog_s = from["watchdog_s"].number_or(s.watchdog_s, {0.001, 10, true, "s"});
  s.has_float_axes = from["float_axes"].boolean_or(s.has_float_axes);
  if (!from["faults"]) return;
  for (const json::Value& fault : from["faults"].objects(0, SimulationRecord::kMaxFaults, kFaultKeys)) {
    SimulatedFault f;
    f.kind = static_cast<SimulatedFaultKind>(
        fault["kind"].choice({"unplug", "restart", "short", "long", "garbled", "unknown-id", "repeated", "out-of-order",
                              "stale", "not-finite", "stall", "no-output", "device-fault"}));
    f.at_s = fault["at_s"].number(from_0(1e6, "s"));
    f.for_s = fault["for_s"].number_or(f.for_s, from_0(1e6, "s"));
    f.delay_s = fault["delay_s"].number_or(f.delay_s, from_0(1e3, "s"));
    f.reports = static_cast<int>(fault["reports"].integer_or(f.reports, 1, 1000000));
    if (f.kind == SimulatedFaultKind::kNotFinite && !s.has_float_axes) {
      fault["kind"].fail("is not-finite, which counts cannot be; set float_axes to true");
    }
    s.faults.push_back(f);
  }
}

void SceneParser::read_script(const json::Value& from, SimulationConfig* simulation) {
  for (const char* const key : {"start_m", "amplitude_m", "frequency_hz"})
    if (from[key]) from[key].fail("stands beside script, which says where the hand is; leave it out");
  for (const json::Value& step : from["script"].objects(1, SimulationConfig::kMaxScript, kScriptKeys)) {
    ScriptStep s;
    s.at_s = step["at_s"].number(from_0(1e6, "s"));
    step["place_m"].numbers(s.place_m, 3, metres(10));
    if (step["buttons"]) {
      for (const double button : step["buttons"].numbers(0, 8, {0, 7})) {
        if (button != std::floor(button)) step["buttons"].fail("has " + shown_number(button) + "; buttons are 0 to 7");
        s.buttons |= 1u << static_cast<int>(button);
      }
    }
    constexpr double kLeastStepS = 0.001;
    if (!simulation->script.empty() && !(s.at_s >= simulation->script.back().at_s + kLeastStepS)) {
      step["at_s"].fail("is " + shown_number(s.at_s) + ", less than 1 ms after the step before it, " +
                        shown_number(simulation->script.back().at_s) + "; times ascend");
    }
    simulation->script.push_back(s);
  }
}

}  // namespace fdcg::dev
