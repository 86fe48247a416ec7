// SPDX-License-Identifier: Apache-2.0
// From a HostConfig to what device_tick works on: the graphs, opened once and only read, and for each device a scene of its
// own, or one for all of them. The host and the replay of its log build it the same way.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "scene/host_config.hpp"
#include "tick/device_tick.hpp"

namespace fdcg::dev {

// The graph files of a scene; objects that share a file share the graph.
class SceneGraphs {
 public:
  SceneGraphs() = default;
  ~SceneGraphs() { close(); }
  SceneGraphs(const SceneGraphs&) = delete;
  SceneGraphs& operator=(const SceneGraphs&) = delete;
  // Opens and verifies every file. Empty: fine. Otherwise the object, its file, and what is wrong with it.
  std::string open(const HostConfig& config);
  void close();
  // Of an object with a file.
  const fdcg_graph& of_object(std::size_t index) const { return graphs_[graph_of_object_[index]]; }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};  // a surface
  std::deque<fdcg_graph> graphs_;                        // a graph that owns its mapping stays where it was opened
  std::vector<std::size_t> graph_of_object_;
};

// Devices of a HostConfig, one after another, that feel one scene.
struct DeviceRange {
  std::size_t first = 0, count = 1;
};
// All of them where they share it (HostConfig::is_shared), otherwise each by itself.
std::vector<DeviceRange> device_ranges(const HostConfig& config);

// The load of a scene by its devices.
struct SceneLoad {
  int contact_count = 0;  // of all devices: they may press on one thing at once
  double pad_m = 0;       // the largest pad
  double fastest_hz = 0, slowest_hz = 0;
};
SceneLoad load_of(const HostConfig& config, const DeviceRange& devices);

// The scene of a device, or of several, in memory that is filled once and does not move.
struct BuiltTexture;  // scene_effects_build.hpp
struct DeviceScene {
  DeviceScene();
  ~DeviceScene();
  DeviceScene(DeviceScene&&) noexcept;
  DeviceScene& operator=(DeviceScene&&) noexcept;

  std::vector<std::uint64_t> memory, pile_memory;
  std::vector<fdcg_scene_body> bodies;
  std::vector<fdcg_reaction> reactions;
  std::vector<std::unique_ptr<SoftObject>> soft;
  std::unique_ptr<SceneEffects> effects;
  std::vector<std::unique_ptr<BuiltTexture>> textures;
  std::deque<fdcg_surface> felt_surfaces;  // with effects
  std::deque<fdcg_waves> waves;            // of reliefs
  std::deque<fdcg_heights> heights;        // likewise
  // One a device; fingers are added by begin_device; driven: the objects with a motion, in the scene's order.
  std::vector<DeviceSetup> setups;
};
// `graphs` must outlive *scene. Empty: fine. Otherwise what the runtime refuses, or devices too unlike to share a scene.
std::string build_device_scene(const HostConfig& config, const DeviceRange& devices, const SceneGraphs& graphs,
                               DeviceScene* scene);

// Where a moved object is so long after the host started. Of MotionKind::kDriven, kFixed, kBody and kSoft: its first pose. No
// heap.
fdcg_pose pose_at(const ObjectConfig& object, double seconds);

}  // namespace fdcg::dev
