// SPDX-License-Identifier: Apache-2.0
// The "input" and "output" of a profile's JSON. A part of profile_json.cpp.
#pragma once

#include "profile/profile.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::dev {

// Fills the layout, and *axis_count for an input report (for an output report it is given): every axis from 0 on stands there
// exactly once. Axes and efforts are lengths and forces of a cartesian device, angles and torques of any other.
// Throw json::Refusal.
void read_input(const json::Value& report, KinematicsKind kinematics, ReportLayout* layout, int* axis_count);
void read_output(const json::Value& report, KinematicsKind kinematics, int axis_count, ReportLayout* layout);

}  // namespace fdcg::dev
