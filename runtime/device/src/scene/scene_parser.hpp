// SPDX-License-Identifier: Apache-2.0
// The parser behind scene_json.hpp, in four files: the whole (scene_json.cpp), objects and what moves them
// (scene_json_objects.cpp), effects (scene_json_effects.cpp), devices (scene_json_devices.cpp). For these alone.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_json.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::dev {

inline constexpr std::size_t kLongestName = 60, kLongestPath = 4000;
inline constexpr double kUnitTolerance = 1e-3;  // of a quaternion, as fdcg_pose has it
inline constexpr double kMostForce = 1000;      // N; more than a hand can press

constexpr json::NumberRange metres(double most) {
  return {-most, most, true, "m"};
}
constexpr json::NumberRange from_0(double most, const char* unit) {
  return {0, most, true, unit};
}
constexpr json::NumberRange above_0(double most, const char* unit) {
  return {0, most, false, unit};
}
inline constexpr json::NumberRange kLengths = metres(1e6);

double norm(const double* x, int count);
// Length 1, exactly as far as doubles go; refused where it is not near it.
void read_unit(const json::Value& from, double* x, int count);
// `name` from the scene file's folder.
std::string beside(const std::string& scene_file, const std::string& name);

class SceneParser {
 public:
  SceneParser(const std::string& file_name, HostConfig* config, std::vector<std::string>* warnings, const SceneOptions& options)
      : file_name_(file_name), config_(*config), warnings_(warnings), options_(options) {}

  void parse(std::string_view text);  // throws json::Refusal

 private:
  void read_object(const json::Value& from);
  void read_surface(const json::Value& from, ObjectConfig* object);
  void refuse_surface(const json::Value& from, const fdcg_surface& surface);
  void read_friction(const json::Value& from, fdcg_params* params);
  std::vector<EffectConfig> read_effects(const json::Value& from, const ObjectConfig* object);
  EffectConfig read_effect(const json::Value& from, const ObjectConfig* object);
  ReliefConfig read_relief(const json::Value& from, const ObjectConfig& object);
  TextureConfig read_texture(const json::Value& from);
  void read_motion(const json::Value& from, Motion* motion);
  void read_body(const json::Value& from, BodyConfig* body);
  void read_soft(const json::Value& from, SoftConfig* soft);
  void read_ground(const json::Value& from);
  void read_shared(const json::Value& scene);
  void read_contacts(const json::Value& from, DeviceConfig* device);
  void read_plugin_profile(const json::Value& from, DeviceConfig* device);
  void read_plugin(const json::Value& from, DeviceConfig* device);
  void read_serial(const json::Value& from, DeviceConfig* device) const;
  void refuse_same_node(const json::Value& from, const DeviceConfig& device) const;
  void read_button(const json::Value& from, HeldButton* button);
  void read_script(const json::Value& from, SimulationConfig* simulation);
  void read_device(const json::Value& from);
  void read_profile(const json::Value& from, DeviceConfig* device);
  void warn_of_rate(const DeviceConfig& device);
  void read_recording(const json::Value& from, DeviceConfig* device);
  void read_mapping(const json::Value& from, Mapping* mapping);
  void read_simulation(const json::Value& from, SimulationConfig* simulation);
  void read_stability(const json::Value& scene);
  void judge_effects(const json::Value& scene, const DeviceConfig& device) const;
  void judge_stiffness(const json::Value& scene);
  void read_loop(const json::Value& from);
  void read_log(const json::Value& from);
  void parse_profile_of(const json::Value& from, const std::string& text, const std::string& name, DeviceConfig* device);

  template <class Named>
  void refuse_twins(const json::Value& from, const std::vector<Named>& others, const std::string& name) {
    for (const Named& other : others)
      if (other.name == name) from["name"].fail("is " + in_quotes(name) + ", which another one has too; names are unique");
  }

  std::string file_name_;
  HostConfig& config_;
  std::vector<std::string>* warnings_;
  const SceneOptions& options_;
  double scene_force_n_ = 0;  // 0: none
  int effect_count_ = 0;
};

}  // namespace fdcg::dev
