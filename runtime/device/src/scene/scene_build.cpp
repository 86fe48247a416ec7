// SPDX-License-Identifier: Apache-2.0
#include "base/rotation.hpp"
#include "scene/scene_bodies.hpp"
#include "scene/scene_effects_build.hpp"
#include "shared/text.hpp"

#include <algorithm>
#include <cmath>

namespace fdcg::dev {
namespace {

constexpr std::uint32_t kMostTouches = 8;  // objects that one contact can feel at once
constexpr double kTurn = 6.283185307179586;

constexpr double kMostRateRatio = 8;  // between devices that share a scene: a slow clock's tick is that many fast ones

// Empty, or the error.
std::string make_soft(const ObjectConfig& object, const SceneLoad& load, const fdcg_graph& graph, const fdcg_params& params,
                      DeviceScene* scene) {
  const SoftConfig& soft = object.motion.soft;
  // All contacts may press on one corner: its spring must not overshoot within a tick.
  const double most = soft.damping_n_s_per_m * load.slowest_hz + soft.stiffness_n_per_m;
  const double pressed = params.stiffness_n_per_m * load.contact_count;
  if (!(pressed <= most)) {
    return "a corner takes up " + shown_number(most) + " N/m in a tick, and " + std::to_string(load.contact_count) +
           (load.contact_count == 1 ? " contact presses with " : " contacts press with ") + shown_number(pressed) +
           "; raise the motion's damping_n_s_per_m to " + shown_number(std::ceil(pressed / load.slowest_hz)) +
           " or lower the object's stiffness_n_per_m";
  }
  scene->soft.push_back(std::make_unique<SoftObject>());
  return scene->soft.back()->begin(graph, soft, object.pose);
}

// Of config.objects[index], into the scene; what its devices have in common into *setup. Empty, or why it cannot be.
std::string add_object(const HostConfig& config, std::size_t index, const SceneLoad& load, const SceneGraphs& graphs,
                       DeviceScene* scene, DeviceSetup* setup, fdcg_object_id* id) {
  const ObjectConfig& object = config.objects[index];
  fdcg_params params = object.params;
  params.tick_s = 1 / load.fastest_hz;
  fdcg_error error{};
  fdcg_status status = FDCG_OK;
  if (object.is_surface) {
    status = fdcg_scene_add_surface(setup->scene, &object.surface, &params, &object.pose, id, &error);
  } else if (object.motion.kind == MotionKind::kSoft) {
    if (std::string problem = make_soft(object, load, graphs.of_object(index), params, scene); !problem.empty()) return problem;
    SoftObject* const soft = scene->soft.back().get();
    status = fdcg_scene_add_deform(setup->scene, soft->deform(), &params, &object.pose, id, &error);
    setup->soft[setup->soft_count] = soft;
    setup->soft_id[setup->soft_count++] = *id;
  } else {
    if ((params.friction_flags & FDCG_FRICTION_SHADING) != 0 && graphs.of_object(index).normals == nullptr)
      return object.file +
             " has no normals at the corners of its faces, so it cannot be shaded; compile it with --normals faces";
    status = fdcg_scene_add_object(setup->scene, &graphs.of_object(index), &params, &object.pose, id, &error);
  }
  return status == FDCG_OK ? std::string() : error.message;
}

// "scene.json: devices[1] 'thumb': "
std::string place_of_device(const HostConfig& config, std::size_t device) {
  return config.scene_file + ": devices[" + std::to_string(device) + "] '" + config.devices[device].name + "': ";
}

// Empty, or which device is too slow for the others: of equal ones the first.
std::string judge_rates(const HostConfig& config, const DeviceRange& devices, const SceneLoad& load) {
  if (load.fastest_hz <= kMostRateRatio * load.slowest_hz) return {};
  std::size_t slowest = devices.first;
  while (config.devices[slowest].profile.rate_hz > load.slowest_hz)
    ++slowest;
  return place_of_device(config, slowest) + "it reports " + shown_number(load.slowest_hz) +
         " times a second, and another device that shares the scene " + shown_number(load.fastest_hz) +
         "; it must be at least an eighth of that (" + shown_number(load.fastest_hz / kMostRateRatio) +
         "): lower the other's rate, or give the slow one a scene of its own";
}

// Room for every finger of the devices, and the scene's switches.
fdcg_scene_config capacities_for(const HostConfig& config, const SceneLoad& load) {
  const auto object_count = static_cast<std::uint32_t>(config.objects.size());
  fdcg_scene_config capacities = fdcg_make_scene_config();
  capacities.object_capacity = std::max(1u, object_count);
  capacities.finger_capacity = static_cast<std::uint32_t>(load.contact_count);
  capacities.touches_per_finger = std::clamp(object_count, 1u, kMostTouches);
  const auto is_soft = [](const ObjectConfig& object) { return object.motion.kind == MotionKind::kSoft; };
  capacities.has_deforms = std::any_of(config.objects.begin(), config.objects.end(), is_soft) ? 1 : 0;
  capacities.has_soft_fingers = load.pad_m > 0 ? 1 : 0;
  return capacities;
}

// The device's own part of its setup.
double least_stiffness(const HostConfig& config) {
  double least = 0;
  for (const ObjectConfig& object : config.objects) {
    const double stiffness = object.params.stiffness_n_per_m;
    if (stiffness > 0 && (least == 0 || stiffness < least)) least = stiffness;
  }
  return least;
}

void add_device(const DeviceConfig& from, const HostConfig& config, DeviceSetup* setup) {
  setup->profile = from.profile;
  setup->mapping = from.mapping;
  setup->contact_count = from.contact_count;
  std::copy(&from.contacts_m[0][0], &from.contacts_m[0][0] + kMaxContacts * 3, &setup->contacts_m[0][0]);
  std::copy_n(from.pads_m, kMaxContacts, setup->pads_m);
  setup->grip = from.grip;
  setup->dead_man_mask = from.dead_man_mask;
  setup->most_force_n = from.most_force_n;
  setup->is_played = from.source == DeviceSource::kRecorded;
  // of a recording the hand does not feel the force: there is no loop
  setup->stability.has_passivity = config.stability.has_passivity && !setup->is_played;
  setup->stability.has_calming = config.stability.has_calming && !setup->is_played;
  setup->has_friction = std::any_of(config.objects.begin(), config.objects.end(),
                                    [](const ObjectConfig& object) { return object.params.mu_static > 0; });
  setup->stability.stiffness_n_per_m = least_stiffness(config) * from.mapping.scale;
}

}  // namespace

DeviceScene::DeviceScene() = default;
DeviceScene::~DeviceScene() = default;
DeviceScene::DeviceScene(DeviceScene&&) noexcept = default;
DeviceScene& DeviceScene::operator=(DeviceScene&&) noexcept = default;

std::string SceneGraphs::open(const HostConfig& config) {
  close();
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    if (config.objects[i].is_surface) {
      graph_of_object_.push_back(kNone);
      continue;
    }
    const auto same_file = [&](const ObjectConfig& other) { return other.file == config.objects[i].file; };
    const auto first = static_cast<std::size_t>(std::find_if(config.objects.begin(), config.objects.end(), same_file) -
                                                config.objects.begin());
    if (first < i) {
      graph_of_object_.push_back(graph_of_object_[first]);
      continue;
    }
    graph_of_object_.push_back(graphs_.size());
    fdcg_error error{};
    fdcg_open_options options = fdcg_make_open_options();
    options.verify = FDCG_VERIFY_SAFE;
    options.huge_pages = !config.loop.maps_graphs;  // a copy
    if (fdcg_open_file_with(config.objects[i].file.c_str(), &options, &graphs_.emplace_back(), &error) != FDCG_OK) {
      close();
      return place_of(config, i) + error.message;
    }
  }
  return {};
}

void SceneGraphs::close() {
  for (fdcg_graph& graph : graphs_)
    fdcg_close(&graph);
  graphs_.clear();
  graph_of_object_.clear();
}

std::vector<DeviceRange> device_ranges(const HostConfig& config) {
  if (config.is_shared) return {{0, config.devices.size()}};
  std::vector<DeviceRange> ranges(config.devices.size());
  for (std::size_t i = 0; i < ranges.size(); ++i)
    ranges[i].first = i;
  return ranges;
}

SceneLoad load_of(const HostConfig& config, const DeviceRange& devices) {
  SceneLoad load;
  for (std::size_t i = devices.first; i < devices.first + devices.count; ++i) {
    const DeviceConfig& device = config.devices[i];
    const double rate_hz = device.profile.rate_hz;
    load.contact_count += device.contact_count;
    load.pad_m = std::max(load.pad_m, *std::max_element(device.pads_m, device.pads_m + device.contact_count));
    load.fastest_hz = std::max(load.fastest_hz, rate_hz);
    load.slowest_hz = i == devices.first ? rate_hz : std::min(load.slowest_hz, rate_hz);
  }
  return load;
}

std::string build_device_scene(const HostConfig& config, const DeviceRange& devices, const SceneGraphs& graphs,
                               DeviceScene* scene) {
  const SceneLoad load = load_of(config, devices);
  if (std::string problem = judge_rates(config, devices, load); !problem.empty()) return problem;
  const fdcg_scene_config capacities = capacities_for(config, load);
  const std::uint64_t bytes = fdcg_scene_bytes(&capacities);
  scene->memory.assign(static_cast<std::size_t>(bytes / sizeof(std::uint64_t) + 1), 0);
  scene->soft.clear();
  DeviceSetup setup;  // what all devices of the scene have
  setup.is_shared = devices.count > 1;
  setup.scene_rate_hz = load.fastest_hz;
  fdcg_error error{};
  if (fdcg_scene_create(scene->memory.data(), bytes, &capacities, &setup.scene, &error) != FDCG_OK) {
    return place_of_device(config, devices.first) + error.message;
  }
  std::vector<fdcg_object_id> objects;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    fdcg_object_id id{};
    if (const std::string problem = add_object(config, i, load, graphs, scene, &setup, &id); !problem.empty())
      return place_of(config, i) + problem;
    objects.push_back(id);
    if (!is_moved(config.objects[i].motion)) continue;
    if (setup.driven_count == kMaxDriven) {
      return place_of(config, i) + "more than " + std::to_string(kMaxDriven) + " objects have a motion; make it fixed";
    }
    setup.driven[setup.driven_count++] = id;
  }
  if (std::string problem = build_bodies(config, load, graphs, objects, scene, &setup); !problem.empty()) return problem;
  const auto count = static_cast<int>(devices.count);
  if (std::string problem = build_effects(config, load, graphs, objects, count, scene, &setup); !problem.empty())
    return problem;
  scene->setups.assign(devices.count, setup);
  for (int i = 0; i < count; ++i) {
    DeviceSetup* const own = &scene->setups[static_cast<std::size_t>(i)];
    own->effects_device = i;
    add_device(config.devices[devices.first + static_cast<std::size_t>(i)], config, own);
  }
  return {};
}

fdcg_pose pose_at(const ObjectConfig& object, double seconds) {
  const Motion& motion = object.motion;
  fdcg_pose pose = object.pose;
  // turns taken off before the sine: as exact after a day as at the start
  const double turns = motion.rate_hz * seconds;
  const double angle = kTurn * (turns - std::floor(turns));
  if (motion.kind == MotionKind::kSpin) {
    const double sine = std::sin(angle / 2);
    const double turn[4] = {motion.axis[0] * sine, motion.axis[1] * sine, motion.axis[2] * sine, std::cos(angle / 2)};
    multiply(turn, object.pose.rotation_xyzw, pose.rotation_xyzw);
  } else if (motion.kind == MotionKind::kSwing) {
    for (int axis = 0; axis < 3; ++axis)
      pose.translation_m[axis] += motion.axis[axis] * motion.amplitude_m * std::sin(angle);
  }
  return pose;
}

}  // namespace fdcg::dev
