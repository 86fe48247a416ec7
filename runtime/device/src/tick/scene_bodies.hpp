// SPDX-License-Identifier: Apache-2.0
// The bodies of a scene: their masses, contact points and substeps. Load time only; allocates.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_build.hpp"

namespace fdcg::dev {

// `objects`: of config.objects, in setup->scene. Creates the scene's bodies, pile and reactions, and sets the fields of *setup;
// nothing without bodies. Returns an empty string on success; else the object and the error.
std::string build_bodies(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                         const std::vector<fdcg_object_id>& objects, DeviceScene* scene, DeviceSetup* setup);

// "scene.json: objects[1] 'cube': "
std::string place_of(const HostConfig& config, std::size_t object);

}  // namespace fdcg::dev
