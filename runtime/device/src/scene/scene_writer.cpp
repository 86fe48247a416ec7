// SPDX-License-Identifier: Apache-2.0
// scene_json.cpp's other direction. Doubles are written with as many digits as read back to the same bits.
#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "scene/scene_json.hpp"
#include "scene/scene_writer_effects.hpp"

namespace fdcg::dev {
namespace {

Json surface_json(const fdcg_surface& surface) {
  constexpr const char* kKinds[] = {"plane", "sphere", "cylinder", "capsule", "box", "cone", "torus", "ellipsoid"};
  return {{"kind", kKinds[surface.kind]},         {"hollow", surface.is_hollow != 0},       {"radius_m", surface.radius_m},
          {"top_radius_m", surface.top_radius_m}, {"tube_radius_m", surface.tube_radius_m}, {"length_m", surface.length_m},
          {"half_m", list(surface.half_m)}};
}

Json object_json(const ObjectConfig& object) {
  constexpr const char* kKinds[] = {"fixed", "spin", "swing", "driven", "body", "soft"};
  Json json;
  json["name"] = object.name;
  if (object.is_surface) {
    json["surface"] = surface_json(object.surface);
  } else {
    json["file"] = object.file;
  }
  json["pose"]["rotation_xyzw"] = list(object.pose.rotation_xyzw);
  json["pose"]["translation_m"] = list(object.pose.translation_m);
  json["pose"]["scale"] = object.pose.scale;
  json["stiffness_n_per_m"] = object.params.stiffness_n_per_m;
  json["damping_n_s_per_m"] = object.params.damping_n_s_per_m;
  json["mu_static"] = object.params.mu_static;
  json["mu_dynamic"] = object.params.mu_dynamic;
  json["edge_friction"] = object.params.edge_friction == FDCG_EDGE_PAPER ? "paper" : "wedge";
  if ((object.params.friction_flags & FDCG_FRICTION_SHADING) != 0) json["shading"] = true;
  if (!object.effects.empty()) json["effects"] = effects_json(object.effects);
  if (object.relief) json["relief"] = relief_json(*object.relief);
  const Motion& motion = object.motion;
  json["motion"]["kind"] = kKinds[static_cast<int>(motion.kind)];
  if (motion.kind == MotionKind::kSpin || motion.kind == MotionKind::kSwing) {
    json["motion"]["axis"] = list(motion.axis);
    json["motion"]["rate_hz"] = motion.rate_hz;
  }
  if (motion.kind == MotionKind::kSwing) json["motion"]["amplitude_m"] = motion.amplitude_m;
  if (motion.kind == MotionKind::kSoft) {
    json["motion"]["stiffness_n_per_m"] = motion.soft.stiffness_n_per_m;
    json["motion"]["tension_n_per_m"] = motion.soft.tension_n_per_m;
    json["motion"]["damping_n_s_per_m"] = motion.soft.damping_n_s_per_m;
    json["motion"]["depth_m"] = motion.soft.depth_m;
    if (motion.soft.radius_m) json["motion"]["radius_m"] = *motion.soft.radius_m;
  }
  if (motion.kind != MotionKind::kBody) return json;
  const BodyConfig& body = motion.body;
  if (body.mass_kg > 0) json["motion"]["mass_kg"] = body.mass_kg;
  if (body.density_kg_per_m3 > 0) json["motion"]["density_kg_per_m3"] = body.density_kg_per_m3;
  json["motion"]["linear_damping_per_s"] = body.linear_damping_per_s;
  json["motion"]["angular_damping_per_s"] = body.angular_damping_per_s;
  json["motion"]["points"] = body.points;
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
  if (simulation.script.empty()) {
    json["start_m"] = list(simulation.start_m);
    json["amplitude_m"] = list(simulation.amplitude_m);
    json["frequency_hz"] = list(simulation.frequency_hz);
  }
  for (const ScriptStep& step : simulation.script) {
    Json buttons = Json::array();
    for (int button = 0; button < 8; ++button)
      if ((step.buttons >> button & 1) != 0) buttons.push_back(button);
    json["script"].push_back({{"at_s", step.at_s}, {"place_m", list(step.place_m)}, {"buttons", buttons}});
  }
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

Json button_json(const HeldButton& button) {
  return {{"button", std::countr_zero(button.mask)}, {"seconds", button.seconds}};
}

Json device_json(const DeviceConfig& device) {
  constexpr const char* kSources[] = {"hid", "simulated", "recorded", "plugin", "serial"};
  Json json;
  json["name"] = device.name;
  json["source"] = kSources[static_cast<int>(device.source)];
  if (device.source == DeviceSource::kPlugin) {
    if (!device.plugin.empty()) json["plugin"] = device.plugin;
    json["settings"] = nlohmann::json::parse(device.plugin_settings, nullptr, false);
  } else if (device.profile_text.empty() && device.limits_text.empty()) {  // the simulation names the profile
    json["simulation"] = simulation_json(device.simulation);
  } else if (!device.profile_text.empty()) {
    json["profile"] = nlohmann::json::parse(device.profile_text, nullptr, false);  // its keys sorted: always the same text
  }
  if (!device.limits_text.empty()) {
    json["rate_hz"] = device.profile.rate_hz;
    json["limits"] = nlohmann::json::parse(device.limits_text, nullptr, false);
  }
  if (device.source == DeviceSource::kSerial) {
    json["port"] = device.serial_access.port;
    json["baud"] = device.serial_access.baud;
  }
  if (!device.serial.empty()) json["serial"] = device.serial;
  if (!device.path.empty()) json["path"] = device.path;
  if (!device.recording.empty()) json["recording"] = device.recording;
  json["mapping"]["scale"] = device.mapping.scale;
  json["mapping"]["rotation_matrix"] = list(device.mapping.rotation);
  json["mapping"]["offset_m"] = list(device.mapping.offset_m);
  const Grip& grip = device.grip;
  for (int i = 0; i < device.contact_count; ++i) {
    json["contacts"].push_back({{"offset_m", list(device.contacts_m[i])}});
    if (grip.close.mask != 0) json["contacts"].back()["closed_m"] = list(grip.closed_m[i]);
    if (device.pads_m[i] > 0) json["contacts"].back()["pad_radius_m"] = device.pads_m[i];
  }
  if (grip.close.mask != 0) json["grip"] = button_json(grip.close);
  if (grip.turn.mask != 0) {
    json["turn"] = button_json(grip.turn);
    json["turn"]["rotation_xyzw"] = list(grip.turn_xyzw);
  }
  if (device.dead_man_mask != 0) json["dead_man"]["button"] = std::countr_zero(device.dead_man_mask);
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
  if (!config.effects.empty()) scene["effects"] = effects_json(config.effects);
  if (config.devices.size() > 1) scene["shared"] = config.is_shared;
  scene["gravity_m_per_s2"] = list(config.gravity_m_per_s2);
  if (config.ground.is_there) {
    const GroundConfig& ground = config.ground;
    scene["ground"] = {{"normal", list(ground.normal)},
                       {"offset_m", ground.offset_m},
                       {"stiffness_n_per_m", ground.params.stiffness_n_per_m},
                       {"mu_static", ground.params.mu_static},
                       {"mu_dynamic", ground.params.mu_dynamic}};
  }
  scene["loop"]["servo_priority"] = config.loop.servo_priority;
  scene["loop"]["writer_priority"] = config.loop.writer_priority;
  scene["loop"]["cpu"] = config.loop.cpu;
  scene["loop"]["lock_memory"] = config.loop.lock_memory;
  scene["loop"]["backend"] = kBackends[static_cast<int>(config.loop.backend)];
  scene["stability"]["passivity"] = config.stability.has_passivity;
  scene["stability"]["calming"] = config.stability.has_calming;
  scene["loop"]["graphs"] = config.loop.maps_graphs ? "map" : "copy";
  if (!config.log_file.empty()) {
    scene["log"]["file"] = config.log_file;
    scene["log"]["limit_mb"] = config.log_megabytes;
  }
  return scene.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fdcg::dev
