// SPDX-License-Identifier: Apache-2.0
// The effects of a scene's config, in the scene of its devices.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_build.hpp"

namespace fdcg::dev {

// What fdcg_texture points to.
struct BuiltTexture {
  std::vector<double> speed, force, reflection, deviation;
  fdcg_texture texture{};
};

// Into scene->effects; setup->effects stays null where there are none. `objects`: by the config's. Empty: fine. Otherwise the
// object, and what is wrong with its effect.
std::string build_effects(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                          const std::vector<fdcg_object_id>& objects, int devices, DeviceScene* scene, DeviceSetup* setup);

}  // namespace fdcg::dev
