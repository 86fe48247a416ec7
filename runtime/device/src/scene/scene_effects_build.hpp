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

// The images of a graph's file as an object of this scale has them: it is larger, and its heights are as they were. Empty:
// fine.
std::string heights_of(const fdcg_graph& graph, double scale, fdcg_heights* heights);

// What a config says, with the materials of this graph (null: none), for ticks of at least slowest_hz; a texture is kept in
// *textures. Empty: fine.
std::string make_effect(const EffectConfig& from, const fdcg_graph* graph, double slowest_hz,
                        std::vector<std::unique_ptr<BuiltTexture>>* textures, fdcg_effect* effect);

// Into scene->effects; setup->effects stays null where there are none. `objects`: by the config's. Empty: fine. Otherwise the
// object, and what is wrong with its effect.
std::string build_effects(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                          const std::vector<fdcg_object_id>& objects, int devices, DeviceScene* scene, DeviceSetup* setup);

}  // namespace fdcg::dev
