// SPDX-License-Identifier: Apache-2.0
// What a scene asks of the devices' own damping.
#pragma once

#include <string>
#include <vector>

#include "scene/host_config.hpp"

namespace fdcg::dev {

// A line for each device and object where the device's damping b does not bear the stiffness K and the damping B that are felt:
// K T / 2 + B <= b is what keeps the loop passive without a hand (Colgate and Schenkel 1997, Passivity of a class of
// sampled-data systems, J. Robotic Systems 14(1)). Lengths are scaled by the mapping, forces are not.
void warn_of_stiffness(const HostConfig& config, std::vector<std::string>* warnings);

}  // namespace fdcg::dev
