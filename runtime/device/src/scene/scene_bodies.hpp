// SPDX-License-Identifier: Apache-2.0
// The bodies of a scene: what they weigh, where they touch, how often a tick they are stepped. Load time only;
// allocates.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_build.hpp"

namespace fdcg::dev {

// `objects`: of config.objects, in setup->scene. Fills the scene's bodies, pile and reactions, and what *setup says of them;
// nothing where there is no body. Empty: fine. Otherwise the object and what is wrong with it.
std::string build_bodies(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                         const std::vector<fdcg_object_id>& objects, DeviceScene* scene, DeviceSetup* setup);

// "scene.json: objects[1] 'cube': "
std::string place_of(const HostConfig& config, std::size_t object);

}  // namespace fdcg::dev
