// SPDX-License-Identifier: Apache-2.0
// scene_json.cpp's other direction. Doubles are written with as many digits as read back to the same bits.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene_json.hpp"

namespace fdcg::dev {
namespace {

using Json = nlohmann::ordered_json;

template <std::size_t count>
Json list(const double (&values)[count]) {
  return Json(std::vector<double>(values, values + count));
}

Json object_json(const ObjectConfig& object) {
  constexpr const char* kKinds[] = {"fixed", "spin", "swing", "driven"};
  Json json;
  json["name"] = object.name;
  json["file"] = object.file;
  json["pose"]["rotation_xyzw"] = list(object.pose.rotation_xyzw);
  json["pose"]["translation_m"] = list(object.pose.translation_m);
  json["pose"]["scale"] = object.pose.scale;
  json["stiffness_n_per_m"] = object.params.stiffness_n_per_m;
  json["damping_n_s_per_m"] = object.params.damping_n_s_per_m;
  json["mu_static"] = object.params.mu_static;
  json["mu_dynamic"] = object.params.mu_dynamic;
  json["edge_friction"] = object.params.edge_friction == FDCG_EDGE_PAPER ? "paper" : "wedge";
  const Motion& motion = object.motion;
  json["motion"]["kind"] = kKinds[static_cast<int>(motion.kind)];
  if (motion.kind == MotionKind::kSpin || motion.kind == MotionKind::kSwing) {
    json["motion"]["axis"] = list(motion.axis);
    json["motion"]["rate_hz"] = motion.rate_hz;
  }
  if (motion.kind == MotionKind::kSwing) json["motion"]["amplitude_m"] = motion.amplitude_m;
  return json;
}

Json simulation_json(const SimulationConfig& simulation) {
  Json json;
  json["rate_hz"] = simulation.rate_hz;
  json["mass_kg"] = simulation.mass_kg;
  json["damping_n_s_per_m"] = simulation.damping_n_s_per_m;
  json["hand_stiffness_n_per_m"] = simulation.hand_stiffness_n_per_m;
  json["hand_damping_n_s_per_m"] = simulation.hand_damping_n_s_per_m;
  json["quantum_m"] = simulation.quantum_m;
  json["start_m"] = list(simulation.start_m);
  json["amplitude_m"] = list(simulation.amplitude_m);
  json["frequency_hz"] = list(simulation.frequency_hz);
  json["real_time"] = simulation.is_real_time;
  json["seed"] = simulation.seed;
  json["force_n"] = simulation.force_n;
  json["watchdog_s"] = simulation.watchdog_s;
  json["float_axes"] = simulation.has_float_axes;
  constexpr const char* kFaults[] = {"unplug",       "restart", "short",      "long",  "garbled",   "unknown-id",  "repeated",
                                     "out-of-order", "stale",   "not-finite", "stall", "no-output", "device-fault"};
  static_assert(std::size(kFaults) == kSimulatedFaultKinds);
  for (const SimulatedFault& fault : simulation.faults)
    json["faults"].push_back({{"kind", kFaults[static_cast<int>(fault.kind)]},
                              {"at_s", fault.at_s},
                              {"for_s", fault.for_s},
                              {"delay_s", fault.delay_s},
                              {"reports", fault.reports}});
  return json;
}

Json device_json(const DeviceConfig& device) {
  constexpr const char* kSources[] = {"hid", "simulated", "recorded"};
  Json json;
  json["name"] = device.name;
  json["source"] = kSources[static_cast<int>(device.source)];
  if (device.source == DeviceSource::kSimulated) {
    json["simulation"] = simulation_json(device.simulation);
  } else {
    json["profile"] = nlohmann::json::parse(device.profile_text, nullptr, false);  // its keys sorted: always the same text
  }
  if (!device.serial.empty()) json["serial"] = device.serial;
  if (!device.path.empty()) json["path"] = device.path;
  if (!device.recording.empty()) json["recording"] = device.recording;
  json["mapping"]["scale"] = device.mapping.scale;
  json["mapping"]["rotation_matrix"] = list(device.mapping.rotation);
  json["mapping"]["offset_m"] = list(device.mapping.offset_m);
  for (int i = 0; i < device.contact_count; ++i)
    json["contacts"].push_back({{"offset_m", list(device.contacts_m[i])}});
  if (device.most_force_n > 0) json["force_limit_n"] = device.most_force_n;
  return json;
}

}  // namespace

std::string write_scene(const HostConfig& config) {
  constexpr const char* kBackends[] = {"any", "hidraw", "libusb"};
  Json scene;
  scene["fdcg_scene"] = 1;
  scene["objects"] = Json::array();
  for (const ObjectConfig& object : config.objects)
    scene["objects"].push_back(object_json(object));
  for (const DeviceConfig& device : config.devices)
    scene["devices"].push_back(device_json(device));
  scene["loop"]["servo_priority"] = config.loop.servo_priority;
  scene["loop"]["writer_priority"] = config.loop.writer_priority;
  scene["loop"]["cpu"] = config.loop.cpu;
  scene["loop"]["lock_memory"] = config.loop.lock_memory;
  scene["loop"]["backend"] = kBackends[static_cast<int>(config.loop.backend)];
  if (!config.log_file.empty()) {
    scene["log"]["file"] = config.log_file;
    scene["log"]["limit_mb"] = config.log_megabytes;
  }
  return scene.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fdcg::dev
