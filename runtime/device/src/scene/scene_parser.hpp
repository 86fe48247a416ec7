// SPDX-License-Identifier: Apache-2.0
// The parser behind scene_json.hpp, in three files: the whole (scene_json.cpp), objects and what moves them
// (scene_json_objects.cpp), devices (scene_json_devices.cpp). For these alone.
#pragma once

#include <string>
#include <vector>

#include "base/json_reader.hpp"
#include "base/words.hpp"
#include "scene/scene_json.hpp"

namespace fdcg::dev {

inline constexpr std::size_t kLongestName = 60, kLongestPath = 4000;
inline constexpr double kUnitTolerance = 1e-3;  // of a quaternion, as fdcg_pose has it
inline constexpr double kMostForce = 1000;      // N; no hand goes beyond

constexpr NumberRange metres(double most) {
  return {-most, most, true, "m"};
}
constexpr NumberRange from_0(double most, const char* unit) {
  return {0, most, true, unit};
}
constexpr NumberRange above_0(double most, const char* unit) {
  return {0, most, false, unit};
}
inline constexpr NumberRange kLengths = metres(1e6);

double norm(const double* x, int count);
// Length 1, exactly as far as doubles go; false with an error where it is not near it.
bool read_unit(const JsonObject& from, const char* key, double* x, int count, double tolerance);
// `name` from the scene file's folder.
std::string beside(const std::string& scene_file, const std::string& name);

class SceneParser {
 public:
  SceneParser(const std::string& file_name, HostConfig* config, std::vector<std::string>* warnings, const SceneOptions& options)
      : file_(file_name), file_name_(file_name), config_(*config), warnings_(warnings), options_(options) {}

  std::string parse(std::string_view text);

 private:
  void read_object(const JsonObject& from);
  void read_surface(const JsonObject& from, ObjectConfig* object);
  void refuse_surface(const JsonObject& from, const fdcg_surface& surface);
  void read_friction(const JsonObject& from, fdcg_params* params);
  void read_motion(const JsonObject& from, Motion* motion);
  void read_body(const JsonObject& from, BodyConfig* body);
  void read_soft(const JsonObject& from, SoftConfig* soft);
  void read_ground(const JsonObject& from);
  void read_shared(const JsonObject& scene);
  void read_contacts(const JsonObject& from, DeviceConfig* device);
  void read_button(const JsonObject& from, HeldButton* button);
  void read_script(const JsonObject& from, SimulationConfig* simulation);
  void read_device(const JsonObject& from);
  void read_profile(const JsonObject& from, DeviceConfig* device);
  void warn_of_rate(const DeviceConfig& device);
  void read_recording(const JsonObject& from, DeviceConfig* device);
  void read_mapping(const JsonObject& from, Mapping* mapping);
  void read_simulation(const JsonObject& from, SimulationConfig* simulation);
  void read_loop(const JsonObject& from);
  void read_log(const JsonObject& from);
  void parse_profile_of(const JsonObject& from, const std::string& text, const std::string& name, DeviceConfig* device);

  template <class Named>
  void refuse_twins(const JsonObject& from, const std::vector<Named>& others, const std::string& name) {
    for (const Named& other : others)
      if (other.name == name) from.fail("name", "is " + in_quotes(name) + ", which another one has too; names are unique");
  }

  JsonFile file_;
  std::string file_name_;
  HostConfig& config_;
  std::vector<std::string>* warnings_;
  const SceneOptions& options_;
  double scene_force_n_ = 0;  // 0: none
};

}  // namespace fdcg::dev
