// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scene/scene_parser.hpp"

namespace fdcg::dev {
namespace {

constexpr int kMostObjects = 1000;
constexpr std::size_t kMostSceneBytes = json::Limits{}.bytes;
constexpr json::Keys kSceneKeys = {"fdcg_scene", "$schema",          "notes",  "objects", "devices",   "loop",   "log",
                                   "limits",     "gravity_m_per_s2", "ground", "shared",  "stability", "effects"};
constexpr json::Keys kObjectKeys = {"name",
                                    "file",
                                    "surface",
                                    "pose",
                                    "stiffness_n_per_m",
                                    "damping_n_s_per_m",
                                    "mu_static",
                                    "mu_dynamic",
                                    "edge_friction",
                                    "shading",
                                    "motion",
                                    "notes",
                                    "effects",
                                    "relief"};
constexpr json::Keys kGroundKeys = {"normal", "offset_m", "stiffness_n_per_m", "mu_static", "mu_dynamic"};
constexpr json::Keys kLoopKeys = {"servo_priority", "writer_priority", "cpu", "lock_memory", "backend", "graphs"};
constexpr json::Keys kLogKeys = {"file", "limit_mb"};

}  // namespace

std::string beside(const std::string& scene_file, const std::string& name) {
  const std::filesystem::path path(name);
  return path.is_absolute() ? name : (std::filesystem::path(scene_file).parent_path() / path).string();
}

double norm(const double* x, int count) {
  double square = 0;
  for (int i = 0; i < count; ++i)
    square += x[i] * x[i];
  return std::sqrt(square);
}

void read_unit(const json::Value& from, double* x, int count) {
  from.numbers(x, count, {-1e6, 1e6});
  const double length = norm(x, count);
  if (std::fabs(length - 1) <= kUnitTolerance) return;
  from.fail("has length " + shown_number(length) + "; it must be 1" +
            (count == 4 ? ": a unit quaternion x, y, z, w; no rotation is [0, 0, 0, 1]" : ""));
}

void SceneParser::parse(std::string_view text) {
  const json::Document document(text);
  const json::Value scene = document.object(kSceneKeys);
  (void)scene["fdcg_scene"].integer(1, 1);
  if (const json::Value limits = scene["limits"]) {
    limits.allow_only({"force_n"});
    scene_force_n_ = limits["force_n"].number(above_0(kMostForce, "N"));
  }
  for (const json::Value& object : scene["objects"].objects(0, kMostObjects, kObjectKeys))
    read_object(object);
  if (scene["effects"]) config_.effects = read_effects(scene["effects"], nullptr);
  for (const json::Value& device : scene["devices"].objects(1, kMaxDevices))
    read_device(device);
  if (scene["gravity_m_per_s2"]) scene["gravity_m_per_s2"].numbers(config_.gravity_m_per_s2, 3, {-1e4, 1e4});
  if (scene["ground"]) read_ground(scene["ground"].object(kGroundKeys));
  read_shared(scene);
  if (scene["loop"]) read_loop(scene["loop"].object(kLoopKeys));
  read_stability(scene);
  judge_stiffness(scene);
  if (scene["log"]) read_log(scene["log"].object(kLogKeys));
}

void SceneParser::read_loop(const json::Value& from) {
  LoopConfig& loop = config_.loop;
  const auto priority = [&](const char* key, int fallback) { return static_cast<int>(from[key].integer_or(fallback, 0, 99)); };
  loop.servo_priority = priority("servo_priority", loop.servo_priority);
  loop.writer_priority = priority("writer_priority", loop.writer_priority);
  loop.cpu = static_cast<int>(from["cpu"].integer_or(loop.cpu, -1, 1023));
  loop.lock_memory = from["lock_memory"].boolean_or(loop.lock_memory);
  loop.backend = static_cast<HidBackend>(from["backend"].choice_or(0, {"any", "hidraw", "libusb"}));
  loop.maps_graphs = from["graphs"].choice_or(0, {"copy", "map"}) == 1;
}

// No more than a device's maker allows. Lengths are scaled by the mapping, forces are not.
void SceneParser::judge_stiffness(const json::Value& scene) {
  for (const DeviceConfig& device : config_.devices) {
    const double allowed = device.profile.limits.stiffness_n_per_m;
    for (const ObjectConfig& object : config_.objects) {
      const double felt = object.params.stiffness_n_per_m * device.mapping.scale;
      if (allowed <= 0 || felt <= allowed) continue;
      scene["devices"].fail(": device " + in_quotes(device.name) + ": object " + in_quotes(object.name) +
                            ": its stiffness is felt as " + shown_number(felt) + " N/m; the profile allows " +
                            shown_number(allowed) + ": lower it, or the mapping's scale");
    }
    judge_effects(scene, device);
  }
}

// Called after the objects are known.
void SceneParser::read_stability(const json::Value& scene) {
  StabilityConfig& stability = config_.stability;
  stability.has_passivity = std::all_of(config_.objects.begin(), config_.objects.end(),
                                        [](const ObjectConfig& object) { return object.motion.kind == MotionKind::kFixed; });
  if (!scene["stability"]) return;
  const json::Value from = scene["stability"].object({"passivity", "calming"});
  stability.has_passivity = from["passivity"].boolean_or(stability.has_passivity);
  stability.has_calming = from["calming"].boolean_or(stability.has_calming);
  if (warnings_ == nullptr) return;
  if (from["passivity"] && !stability.has_passivity)
    warnings_->push_back("stability.passivity is switched off: what the scene gives out is not damped");
  if (!stability.has_calming) warnings_->push_back("stability.calming is switched off: a loop that shakes goes on shaking");
}

void SceneParser::read_log(const json::Value& from) {
  config_.log_file = beside(file_name_, from["file"].text(kLongestPath));
  config_.log_megabytes = from["limit_mb"].number_or(0, from_0(1e9, "MB"));
}

std::string parse_scene(std::string_view text, const std::string& file_name, HostConfig* config,
                        std::vector<std::string>* warnings, const SceneOptions& options) {
  *config = HostConfig{};
  config->scene_file = file_name;
  config->scene_text = std::string(text);
  try {
    SceneParser(file_name, config, warnings, options).parse(text);
  } catch (const json::Refusal& refusal) {
    return one_line(file_name + ": " + refusal.message);
  }
  return "";
}

std::string read_scene(const std::string& path, HostConfig* config, std::vector<std::string>* warnings) {
  std::string text;
  if (std::string error = json::read_text_file(path, kMostSceneBytes, &text); !error.empty()) return error;
  return parse_scene(text, path, config, warnings);
}

std::size_t find_recorded_device(const HostConfig& recorded, const std::string& name) {
  for (std::size_t i = 0; i < recorded.devices.size(); ++i)
    if (recorded.devices[i].name == name) return i;
  return recorded.devices.size() == 1 ? 0 : recorded.devices.size();
}

}  // namespace fdcg::dev
