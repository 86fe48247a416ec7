// SPDX-License-Identifier: Apache-2.0
// The "input" and "output" of a profile's JSON. A part of profile_json.cpp.
#pragma once

#include "base/json_reader.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

// Fills the layout, and *axis_count for an input report (for an output report it is given): every axis from 0 on stands there
// exactly once. Axes and efforts are lengths and forces of a cartesian device, angles and torques of any other.
// What is wrong goes to the file's error.
void read_input(const JsonObject& report, KinematicsKind kinematics, ReportLayout* layout, int* axis_count);
void read_output(const JsonObject& report, KinematicsKind kinematics, int axis_count, ReportLayout* layout);

}  // namespace fdcg::dev
