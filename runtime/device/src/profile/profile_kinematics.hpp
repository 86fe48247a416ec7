// SPDX-License-Identifier: Apache-2.0
// The "kinematics" of a profile's JSON. A part of profile_json.cpp.
#pragma once

#include "profile/profile.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::dev {

// Of all kinds together; read_kinematics refuses those of another kind.
inline constexpr json::Keys kKinematicsKeys{"kind",      "radius_m",          "shoulder_height_m", "upper_m",
                                            "forearm_m", "origin_m",          "elbow_coupling",    "base_radius_m",
                                            "lower_m",   "platform_radius_m", "origin_z_m",        "azimuths_rad"};

// Throw json::Refusal.
void read_kinematics(const json::Value& json, KinematicsParams* kinematics);
void check_axis_count(const json::Value& kinematics, KinematicsKind kind, int axis_count);

}  // namespace fdcg::dev
