// SPDX-License-Identifier: Apache-2.0
// Axes to the tip's position, in the device's frame, and the Jacobian that takes forces back to efforts. Pure; no heap, no lock.
#pragma once

#include "profile.hpp"

namespace fdcg::dev {

struct TipPose {
  double position_m[3] = {};
  double jacobian[3][kMaxAxes] = {};  // d position / d axis; effort = transpose(jacobian) * force. Unused axes are 0.
};

// False where the axes have no pose (a delta out of reach, a number that is not finite): *tip is then not to be used.
bool tip_pose(const KinematicsParams& kinematics, int axis_count, const double axis[kMaxAxes], TipPose* tip);

}  // namespace fdcg::dev
