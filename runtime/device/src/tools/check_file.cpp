// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "fdcg/device_tools.hpp"
#include "host/make_transport.hpp"
#include "profile/profile_json.hpp"
#include "recording/session_log.hpp"
#include "scene/scene_build.hpp"
#include "scene/scene_json.hpp"
#include "scene/stiffness.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::dev {
namespace {

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// What a run would refuse at its start, for devices that share one scene.
std::string problem_of(const HostConfig& config, const DeviceRange& devices, const SceneGraphs& graphs) {
  DeviceScene scene;
  if (std::string problem = build_device_scene(config, devices, graphs, &scene); !problem.empty()) return problem;
  for (std::size_t i = 0; i < devices.count; ++i) {
    const DeviceConfig& device = config.devices[devices.first + i];
    const auto state = std::make_unique<DeviceState>();
    fdcg_error error{};
    if (!begin_device(scene.setups[i], state.get(), &error)) return "device '" + device.name + "': " + error.message;
    if (device.source != DeviceSource::kRecorded) continue;
    const std::string problem = make_transport(device, config.loop)->open();
    if (!problem.empty()) return "device '" + device.name + "': " + problem;
  }
  return {};
}

// Names, values, files, and whether the runtime accepts the whole.
FileCheck check_scene(const std::string& file, const std::string& text) {
  FileCheck check;
  HostConfig config;
  check.problem = parse_scene(text, file, &config, &check.warnings);
  if (!check.problem.empty()) return check;
  check.what = "scene: " + counted(config.objects.size(), "object") + ", " + counted(config.devices.size(), "device") +
               (config.is_shared ? " that share it" : "");
  warn_of_stiffness(config, &check.warnings);
  SceneGraphs graphs;
  check.problem = graphs.open(config);
  if (check.problem.empty()) warn_of_image_reliefs(config, graphs, &check.warnings);
  for (const DeviceRange& devices : device_ranges(config))
    if (check.problem.empty()) check.problem = problem_of(config, devices, graphs);
  if (check.problem.empty()) check.problem = log_problem(config, &check.warnings);
  if (!check.problem.empty() && check.problem.rfind(file, 0) != 0) check.problem.insert(0, file + ": ");
  return check;
}

FileCheck check_profile(const std::string& file, const std::string& text) {
  FileCheck check;
  Profile profile;
  check.problem = parse_profile(text, file, &profile, &check.warnings);
  check.what = "device profile: " + std::string(profile.name);
  return check;
}

}  // namespace

// A file that is not JSON is parsed as a scene, for the position of the error.
FileCheck check_file(const std::string& path) {
  FileCheck check;
  std::string text;
  check.problem = json::read_text_file(path, json::Limits{}.bytes, &text);
  check.is_unreadable = !check.problem.empty();
  if (check.is_unreadable) return check;
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_discarded() && !json.contains("fdcg_scene")) {
    if (json.contains("fdcg_profile")) return check_profile(path, text);
    check.problem = path + ": neither a scene nor a device profile: \"fdcg_scene\": 1 or \"fdcg_profile\": 1 must say which";
    return check;
  }
  check = check_scene(path, text);
  check.is_unreadable = json.is_discarded();
  return check;
}

}  // namespace fdcg::dev
