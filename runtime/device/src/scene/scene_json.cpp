// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_json.hpp"

#include <cmath>
#include <filesystem>

#include "scene/scene_parser.hpp"

namespace fdcg::dev {
namespace {

constexpr int kMostObjects = 1000;
constexpr std::size_t kMostSceneBytes = kMostJsonBytes;
constexpr Keys kSceneKeys = {"fdcg_scene", "$schema",          "notes",  "objects", "devices", "loop", "log",
                             "limits",     "gravity_m_per_s2", "ground", "shared"};
constexpr Keys kObjectKeys = {
    "name",       "file",          "surface", "pose", "stiffness_n_per_m", "damping_n_s_per_m", "mu_static",
    "mu_dynamic", "edge_friction", "motion",  "notes"};
constexpr Keys kDeviceKeys = {"name",          "source",     "profile",   "serial", "path", "mapping", "contacts",
                              "force_limit_n", "simulation", "recording", "notes",  "grip", "turn"};
constexpr Keys kGroundKeys = {"normal", "offset_m", "stiffness_n_per_m", "mu_static", "mu_dynamic"};
constexpr Keys kLoopKeys = {"servo_priority", "writer_priority", "cpu", "lock_memory", "backend"};
constexpr Keys kLogKeys = {"file", "limit_mb"};
constexpr Keys kLimitsKeys = {"force_n"};

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

bool read_unit(const JsonObject& from, const char* key, double* x, int count, double tolerance) {
  from.numbers(key, x, count, {-1e6, 1e6});
  const double length = norm(x, count);
  if (std::fabs(length - 1) <= tolerance) return true;
  from.fail(key, "has length " + shown_number(length) + "; it must be 1" +
                     (count == 4 ? ": a unit quaternion x, y, z, w; no rotation is [0, 0, 0, 1]" : ""));
  return false;
}

std::string SceneParser::parse(std::string_view text) {
  const JsonObject scene = file_.parse(text, kSceneKeys);
  scene.integer("fdcg_scene", 1, 1);
  if (scene.has("limits")) {
    scene_force_n_ = scene.object("limits", kLimitsKeys).number("force_n", above_0(kMostForce, "N"));
  }
  for (const JsonObject& object : scene.objects("objects", 0, kMostObjects, kObjectKeys))
    read_object(object);
  for (const JsonObject& device : scene.objects("devices", 1, kMaxDevices, kDeviceKeys))
    read_device(device);
  if (scene.has("gravity_m_per_s2")) scene.numbers("gravity_m_per_s2", config_.gravity_m_per_s2, 3, {-1e4, 1e4});
  if (scene.has("ground")) read_ground(scene.object("ground", kGroundKeys));
  read_shared(scene);
  if (scene.has("loop")) read_loop(scene.object("loop", kLoopKeys));
  if (scene.has("log")) read_log(scene.object("log", kLogKeys));
  return file_.error();
}

void SceneParser::read_loop(const JsonObject& from) {
  LoopConfig& loop = config_.loop;
  const auto priority = [&](const char* key, int fallback) { return static_cast<int>(from.integer_or(key, fallback, 0, 99)); };
  loop.servo_priority = priority("servo_priority", loop.servo_priority);
  loop.writer_priority = priority("writer_priority", loop.writer_priority);
  loop.cpu = static_cast<int>(from.integer_or("cpu", loop.cpu, -1, 1023));
  loop.lock_memory = from.boolean_or("lock_memory", loop.lock_memory);
  loop.backend = static_cast<HidBackend>(from.choice_or("backend", 0, {"any", "hidraw", "libusb"}));
}

void SceneParser::read_log(const JsonObject& from) {
  config_.log_file = beside(file_name_, from.text("file", kLongestPath));
  config_.log_megabytes = from.number_or("limit_mb", 0, from_0(1e9, "MB"));
}

std::string parse_scene(std::string_view text, const std::string& file_name, HostConfig* config,
                        std::vector<std::string>* warnings, const SceneOptions& options) {
  *config = HostConfig{};
  config->scene_file = file_name;
  config->scene_text = std::string(text);
  return SceneParser(file_name, config, warnings, options).parse(text);
}

std::string read_scene(const std::string& path, HostConfig* config, std::vector<std::string>* warnings) {
  std::string text;
  if (std::string error = read_text_file(path, kMostSceneBytes, &text); !error.empty()) return error;
  return parse_scene(text, path, config, warnings);
}

std::size_t find_recorded_device(const HostConfig& recorded, const std::string& name) {
  for (std::size_t i = 0; i < recorded.devices.size(); ++i)
    if (recorded.devices[i].name == name) return i;
  return recorded.devices.size() == 1 ? 0 : recorded.devices.size();
}

}  // namespace fdcg::dev
