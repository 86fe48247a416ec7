// SPDX-License-Identifier: Apache-2.0
// The "kinematics" of a profile's JSON. A part of profile_json.cpp.
#pragma once

#include "base/json_reader.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

// Of all kinds together; read_kinematics refuses those of another kind.
inline constexpr Keys kKinematicsKeys{"kind",      "radius_m",          "shoulder_height_m", "upper_m",
                                      "forearm_m", "origin_m",          "elbow_coupling",    "base_radius_m",
                                      "lower_m",   "platform_radius_m", "origin_z_m",        "azimuths_rad"};

// What is wrong goes to the file's error.
void read_kinematics(const JsonObject& json, KinematicsParams* kinematics);
// `profile` is the whole file.
void check_axis_count(const JsonObject& profile, KinematicsKind kind, int axis_count);

}  // namespace fdcg::dev
