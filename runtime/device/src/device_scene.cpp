// SPDX-License-Identifier: Apache-2.0
#include "device_scene.hpp"

#include <algorithm>

namespace fdcg::dev {

SceneGraphs::~SceneGraphs() {
  for (const auto& file : files_) fdcg_close(&file->graph);
}

std::string SceneGraphs::open(const std::vector<ObjectConfig>& objects) {
  for (const ObjectConfig& object : objects) {
    auto known = std::find_if(files_.begin(), files_.end(), [&](const auto& file) { return file->path == object.file; });
    if (known == files_.end()) {
      auto file = std::make_unique<File>();
      file->path = object.file;
      fdcg_error error;
      if (fdcg_open_file(object.file.c_str(), FDCG_VERIFY_FULL, &file->graph, &error) != FDCG_OK) {
        return "object '" + object.name + "': " + object.file + ": " + error.message;
      }
      known = files_.insert(files_.end(), std::move(file));
    }
    by_object_.push_back(&(*known)->graph);
  }
  return {};
}

namespace {

std::string add_object(const ObjectConfig& object, const fdcg_graph& graph, double rate_hz, DeviceScene* scene) {
  fdcg_params params = object.params;
  if (rate_hz > 0) params.tick_s = 1 / rate_hz;
  fdcg_error error;
  fdcg_object_id id;
  if (fdcg_scene_add_object(scene->setup.scene, &graph, &params, &object.pose, &id, &error) != FDCG_OK) {
    return "object '" + object.name + "': " + error.message;
  }
  if (object.motion.kind == MotionKind::kFixed) return {};
  if (scene->setup.driven_count == kMaxDriven) {
    return "object '" + object.name + "': more than " + std::to_string(kMaxDriven) +
           " objects move; make some of them fixed";
  }
  scene->setup.driven[scene->setup.driven_count++] = id;
  return {};
}

}  // namespace

std::string DeviceScene::build(const HostConfig& config, int device, const SceneGraphs& graphs) {
  const DeviceConfig& wanted = config.devices[static_cast<std::size_t>(device)];
  setup = DeviceSetup();
  setup.profile = wanted.profile;
  setup.mapping = wanted.mapping;
  setup.contact_count = wanted.contact_count;
  std::copy(&wanted.contacts_m[0][0], &wanted.contacts_m[0][0] + kMaxContacts * 3, &setup.contacts_m[0][0]);
  setup.most_force_n = wanted.most_force_n;

  fdcg_scene_config capacity = fdcg_default_scene_config();
  capacity.object_capacity = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(config.objects.size()));
  capacity.finger_capacity = kMaxContacts;
  fdcg_error error;
  const std::uint64_t bytes = fdcg_scene_bytes(&capacity);
  memory.assign(bytes / sizeof(std::uint64_t) + 1, 0);
  if (fdcg_scene_create(memory.data(), memory.size() * sizeof(std::uint64_t), &capacity, &setup.scene, &error) != FDCG_OK) {
    return "device '" + wanted.name + "': " + error.message;
  }
  moving.clear();
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const ObjectConfig& object = config.objects[i];
    const std::string problem = add_object(object, graphs.of_object(static_cast<int>(i)), wanted.profile.rate_hz, this);
    if (!problem.empty()) return problem;
    if (object.motion.kind != MotionKind::kFixed) moving.push_back(static_cast<int>(i));
  }
  return {};
}

}  // namespace fdcg::dev
