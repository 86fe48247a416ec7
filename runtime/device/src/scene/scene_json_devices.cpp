// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "profile/profile_json.hpp"
#include "scene/scene_parser.hpp"
#include "session/session_reader.hpp"
#include "transport/simulated_device.hpp"

namespace fdcg::dev {
namespace {

constexpr double kOrthonormalTolerance = 1e-9;  // of a rotation matrix
constexpr double kLeastPad_m = 1e-9;            // of fdcg_scene_set_finger_radius
constexpr Keys kMappingKeys = {"scale", "rotation_xyzw", "rotation_matrix", "offset_m"};
constexpr Keys kContactKeys = {"offset_m", "closed_m", "pad_radius_m"};
constexpr Keys kGripKeys = {"button", "seconds"};
constexpr Keys kTurnKeys = {"button", "seconds", "rotation_xyzw"};
constexpr Keys kScriptKeys = {"at_s", "place_m", "buttons", "notes"};
constexpr Keys kSimulationKeys = {"rate_hz",
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
constexpr Keys kFaultKeys = {"kind", "at_s", "for_s", "delay_s", "reports"};

}  // namespace

void SceneParser::read_device(const JsonObject& from) {
  DeviceConfig device;
  device.name = from.text("name", kLongestName);
  refuse_twins(from, config_.devices, device.name);
  device.source = static_cast<DeviceSource>(from.choice_or("source", 0, {"hid", "simulated", "recorded"}));
  if (device.source == DeviceSource::kHid) {
    from.allow_only(
        {"name", "source", "mapping", "contacts", "grip", "turn", "force_limit_n", "notes", "profile", "serial", "path"},
        " of a hid device");
    read_profile(from, &device);
    device.serial = from.text_or("serial", "", kLongestName);
    device.path = from.text_or("path", "", kLongestPath);
  } else if (device.source == DeviceSource::kSimulated) {
    from.allow_only({"name", "source", "mapping", "contacts", "grip", "turn", "force_limit_n", "notes", "simulation"},
                    " of a simulated device");
    if (from.has("simulation")) read_simulation(from.object("simulation", kSimulationKeys), &device.simulation);
    device.profile = simulated_profile(device.simulation);
    warn_of_rate(device);
  } else {
    from.allow_only({"name", "source", "mapping", "contacts", "grip", "turn", "force_limit_n", "notes", "profile", "recording",
                     "simulation"},
                    " of a recorded device");
    read_recording(from, &device);
  }
  if (from.has("mapping")) read_mapping(from.object("mapping", kMappingKeys), &device.mapping);
  read_contacts(from, &device);
  device.most_force_n = scene_force_n_;
  if (from.has("force_limit_n")) {
    const double own = from.number("force_limit_n", above_0(kMostForce, "N"));
    device.most_force_n = scene_force_n_ > 0 ? std::min(own, scene_force_n_) : own;
  }
  config_.devices.push_back(std::move(device));
}

void SceneParser::read_button(const JsonObject& from, HeldButton* button) {
  button->mask = std::uint32_t{1} << from.integer("button", 0, kMaxButtons - 1);
  button->seconds = from.number_or("seconds", button->seconds, {0.001, 1000, true, "s"});
}

void SceneParser::read_contacts(const JsonObject& from, DeviceConfig* device) {
  Grip& grip = device->grip;
  if (from.has("grip")) read_button(from.object("grip", kGripKeys), &grip.close);
  if (from.has("turn")) {
    const JsonObject turn = from.object("turn", kTurnKeys);
    read_button(turn, &grip.turn);
    // up to half a turn: of the two ways round the shorter, so that the way there is told by its end
    if (read_unit(turn, "rotation_xyzw", grip.turn_xyzw, 4, kUnitTolerance) && grip.turn_xyzw[3] < 0) {
      for (double& x : grip.turn_xyzw)
        x = -x;
    }
  }
  if (!from.has("contacts")) return;
  const std::vector<JsonObject> contacts = from.objects("contacts", 1, kMaxContacts, kContactKeys);
  device->contact_count = std::max<int>(1, static_cast<int>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].numbers("offset_m", device->contacts_m[i], 3, kLengths);
    std::copy_n(device->contacts_m[i], 3, grip.closed_m[i]);
    device->pads_m[i] = contacts[i].number_or("pad_radius_m", 0, {0, 1, true, "m"});
    if (device->pads_m[i] > 0 && device->pads_m[i] < kLeastPad_m) {
      contacts[i].fail("pad_radius_m", "is " + shown_number(device->pads_m[i]) + "; it must be 0 (a point) or a number from " +
                                           shown_number(kLeastPad_m) + " to 1 m");
    }
    if (!contacts[i].has("closed_m")) continue;
    contacts[i].numbers("closed_m", grip.closed_m[i], 3, kLengths);
    if (grip.close.mask == 0) contacts[i].fail("closed_m", "has no \"grip\" that would close it; name a button there");
  }
}

void SceneParser::parse_profile_of(const JsonObject& from, const std::string& text, const std::string& name,
                                   DeviceConfig* device) {
  std::vector<std::string> warnings;
  if (const std::string error = parse_profile(text, name, &device->profile, &warnings); !error.empty()) {
    return from.fail("profile", "is refused: " + error);
  }
  device->profile_text = text;
  if (warnings_ == nullptr) return;
  for (const std::string& warning : warnings)
    warnings_->push_back("device " + in_quotes(device->name) + ": " + warning);
}

// Of a device whose profile nobody has read: a profile that is read has warned of its own rate.
void SceneParser::warn_of_rate(const DeviceConfig& device) {
  const std::string warning = rate_warning(device.profile.rate_hz);
  if (warnings_ != nullptr && !warning.empty()) warnings_->push_back("device " + in_quotes(device.name) + ": " + warning);
}

// A built-in one by its name, a file, or in place.
void SceneParser::read_profile(const JsonObject& from, DeviceConfig* device) {
  if (from.is_object("profile")) return parse_profile_of(from, from.json("profile"), "it", device);
  const std::string name = from.text("profile", kLongestPath);
  if (name.empty()) return;
  if (const BuiltinProfile* const built_in = find_builtin_profile(name)) {
    return parse_profile_of(from, std::string(built_in->text), "built-in " + name, device);
  }
  if (name.find_first_of("./\\") == std::string::npos) {
    std::vector<std::string> names;
    for (const BuiltinProfile& profile : builtin_profiles())
      names.emplace_back(profile.name);
    return from.fail("profile", "is " + in_quotes(name) + "; it must be a file's name (with .json) or one of the built-in " +
                                    listed(names) + did_you_mean(name, names));
  }
  if (!options_.reads_files) return from.fail("profile", "names a file, and none is read here");
  std::string text;
  const std::string path = beside(file_name_, name);
  if (const std::string error = read_text_file(path, kMostJsonBytes, &text); !error.empty()) {
    return from.fail("profile", "is refused: " + error);
  }
  parse_profile_of(from, text, path, device);
}

// The profile is the one that the recorded device had, unless the scene gives another.
void SceneParser::read_recording(const JsonObject& from, DeviceConfig* device) {
  device->recording = beside(file_name_, from.text("recording", kLongestPath));
  if (from.has("profile")) return read_profile(from, device);
  if (from.has("simulation")) {  // of a device that was simulated when it was recorded: so a log of its recording says all
    read_simulation(from.object("simulation", kSimulationKeys), &device->simulation);
    device->profile = simulated_profile(device->simulation);
    return warn_of_rate(*device);
  }
  if (file_.has_failed()) return;
  if (!options_.reads_files) return from.fail("recording", "names a file, and none is read here");
  SessionReader reader;
  if (const std::string error = reader.open(device->recording); !error.empty()) {
    return from.fail("recording", "is refused: " + error);
  }
  HostConfig recorded;
  const std::string error = parse_scene(reader.header().scene, device->recording + " (its scene)", &recorded);
  if (!error.empty()) return from.fail("recording", "is refused: " + error);
  const std::size_t index = find_recorded_device(recorded, device->name);
  if (index == recorded.devices.size()) {
    std::vector<std::string> names;
    for (const DeviceConfig& other : recorded.devices)
      names.push_back(other.name);
    return from.fail("recording", "has no device " + in_quotes(device->name) + " but " + listed(names) +
                                      "; give this device the name of one of them");
  }
  device->profile = recorded.devices[index].profile;
  device->profile_text = recorded.devices[index].profile_text;
  device->simulation = recorded.devices[index].simulation;
  warn_of_rate(*device);
}

void SceneParser::read_mapping(const JsonObject& from, Mapping* mapping) {
  mapping->scale = from.number_or("scale", 1, {1e-6, 1e6});
  if (from.has("offset_m")) from.numbers("offset_m", mapping->offset_m, 3, kLengths);
  double* const r = mapping->rotation;
  if (from.has("rotation_matrix")) {
    if (from.has("rotation_xyzw")) from.fail("rotation_matrix", "stands beside rotation_xyzw; give one of them");
    from.numbers("rotation_matrix", r, 9, {-1 - kOrthonormalTolerance, 1 + kOrthonormalTolerance});
    double worst = std::fabs(r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
                             r[2] * (r[3] * r[7] - r[4] * r[6]) - 1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        worst = std::max(worst, std::fabs(r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2] -
                                          (i == j ? 1 : 0)));
    if (!(worst <= kOrthonormalTolerance)) {
      from.fail("rotation_matrix", "is off a rotation by " + shown_number(worst) + "; at most " +
                                       shown_number(kOrthonormalTolerance) +
                                       ": three rows of length 1, at right angles, "
                                       "right-handed");
    }
  } else if (double q[4]; from.has("rotation_xyzw") && read_unit(from, "rotation_xyzw", q, 4, kUnitTolerance)) {
    const double length = norm(q, 4);
    for (double& x : q)
      x /= length;
    rows_of(q, r);
  }
}

void SceneParser::read_simulation(const JsonObject& from, SimulationConfig* simulation) {
  SimulationConfig& s = *simulation;
  s.rate_hz = from.number_or("rate_hz", s.rate_hz, {1, 20000, true, "Hz"});
  s.mass_kg = from.number_or("mass_kg", s.mass_kg, {0.001, 100, true, "kg"});
  s.damping_n_s_per_m = from.number_or("damping_n_s_per_m", s.damping_n_s_per_m, from_0(1000, "N s/m"));
  s.hand_stiffness_n_per_m = from.number_or("hand_stiffness_n_per_m", s.hand_stiffness_n_per_m, from_0(1e5, "N/m"));
  s.hand_damping_n_s_per_m = from.number_or("hand_damping_n_s_per_m", s.hand_damping_n_s_per_m, from_0(1000, "N s/m"));
  s.quantum_m = from.number_or("quantum_m", s.quantum_m, {1e-9, 0.01, true, "m"});
  if (from.has("script")) read_script(from, &s);
  if (from.has("start_m")) from.numbers("start_m", s.start_m, 3, metres(10));
  if (from.has("amplitude_m")) from.numbers("amplitude_m", s.amplitude_m, 3, metres(10));
  if (from.has("frequency_hz")) from.numbers("frequency_hz", s.frequency_hz, 3, from_0(1000, "Hz"));
  s.is_real_time = from.boolean_or("real_time", s.is_real_time);
  s.seed = static_cast<std::uint64_t>(from.integer_or("seed", static_cast<std::int64_t>(s.seed), 0, 9007199254740992));
  s.force_n = from.number_or("force_n", s.force_n, above_0(kMostForce, "N"));
  s.watchdog_s = from.number_or("watchdog_s", s.watchdog_s, {0.001, 10, true, "s"});
  s.has_float_axes = from.boolean_or("float_axes", s.has_float_axes);
  if (!from.has("faults")) return;
  for (const JsonObject& fault : from.objects("faults", 0, SimulationRecord::kMaxFaults, kFaultKeys)) {
    SimulatedFault f;
    f.kind = static_cast<SimulatedFaultKind>(
        fault.choice("kind", {"unplug", "restart", "short", "long", "garbled", "unknown-id", "repeated", "out-of-order",
                              "stale", "not-finite", "stall", "no-output", "device-fault"}));
    f.at_s = fault.number("at_s", from_0(1e6, "s"));
    f.for_s = fault.number_or("for_s", f.for_s, from_0(1e6, "s"));
    f.delay_s = fault.number_or("delay_s", f.delay_s, from_0(1e3, "s"));
    f.reports = static_cast<int>(fault.integer_or("reports", f.reports, 1, 1000000));
    if (f.kind == SimulatedFaultKind::kNotFinite && !s.has_float_axes) {
      fault.fail("kind", "is not-finite, which counts cannot be; set float_axes to true");
    }
    s.faults.push_back(f);
  }
}

void SceneParser::read_script(const JsonObject& from, SimulationConfig* simulation) {
  for (const char* const key : {"start_m", "amplitude_m", "frequency_hz"})
    if (from.has(key)) from.fail(key, "stands beside script, which says where the hand is; leave it out");
  for (const JsonObject& step : from.objects("script", 1, SimulationConfig::kMaxScript, kScriptKeys)) {
    ScriptStep s;
    s.at_s = step.number("at_s", from_0(1e6, "s"));
    step.numbers("place_m", s.place_m, 3, metres(10));
    if (step.has("buttons")) {
      for (const double button : step.numbers("buttons", 0, 8, {0, 7})) {
        if (button != std::floor(button)) step.fail("buttons", "has " + shown_number(button) + "; buttons are 0 to 7");
        s.buttons |= 1u << static_cast<int>(button);
      }
    }
    constexpr double kLeastStepS = 0.001;
    if (!simulation->script.empty() && !(s.at_s >= simulation->script.back().at_s + kLeastStepS)) {
      step.fail("at_s", "is " + shown_number(s.at_s) + ", less than 1 ms after the step before it, " +
                            shown_number(simulation->script.back().at_s) + "; times ascend");
    }
    simulation->script.push_back(s);
  }
}

}  // namespace fdcg::dev
