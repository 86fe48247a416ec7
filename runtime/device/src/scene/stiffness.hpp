// SPDX-License-Identifier: Apache-2.0
// What a scene asks of the devices' own damping.
#pragma once

#include <string>
#include <vector>

#include "fdcg/relief.h"
#include "scene/scene_build.hpp"

namespace fdcg::dev {

// A line for each device and object where the device's damping b does not bear the stiffness K and the damping B that are felt:
// K T / 2 + B <= b is what keeps the loop passive without a hand (Colgate and Schenkel 1997, Passivity of a class of
// sampled-data systems, J. Robotic Systems 14(1)). Lengths are scaled by the mapping, forces are not.
void warn_of_stiffness(const HostConfig& config, std::vector<std::string>* warnings);

// A line where the relief of an object is stiffer along the surface, at the device's force limit, than its profile allows.
void warn_of_relief(const DeviceConfig& device, const ObjectConfig& object, const fdcg_relief& relief,
                    std::vector<std::string>* warnings);
// The same of all devices and objects whose relief is the images of their file, which is `graphs`' own.
void warn_of_image_reliefs(const HostConfig& config, const SceneGraphs& graphs, std::vector<std::string>* warnings);

}  // namespace fdcg::dev
