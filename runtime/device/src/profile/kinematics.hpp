// SPDX-License-Identifier: Apache-2.0
// Axes to the tip's position, in the device's frame, and the Jacobian that takes forces back to efforts. Pure; no heap, no
// lock.
//
// Parameters, in the order of KinematicsParams. Parameters that a kind does not name are ignored. An axis' zero and direction
// are the bias and scale of its field in the profile.
//
// kCartesian: 1 to 3 axes in metres, x, y, z; one that is not there is 0. No parameters.
//
// kRotary: 1 axis, the angle q. A handle on a circle about the z axis: tip = r (cos q, sin q, 0).
//   lengths_m[0] = r > 0
//
// kSerialArm: 3 axes: yaw q0 about the vertical z axis, shoulder q1 and elbow q2, as WoodenHaptics and Phantom devices have.
//
//        z |    b    o.            q1: of the upper link b, from straight up, forward
//          |      /    ' . c       e: of the forearm c, from straight up, forward: e = q2 + k q1
//          |    /          ' .
//          |  / q1             tip
//   a  o---+
//          |  yaw             tip = (cos q0 s, sin q0 s, h) - origin, s = b sin q1 + c sin e, h = a + b cos q1 + c cos e
//
//   lengths_m[0..2] = a >= 0, b > 0, c > 0: heights of the shoulder, lengths of the links
//   lengths_m[3..5] = origin: where the device's frame begins, seen from the base (its axes are the base's)
//   angles_rad[0] = k (rad per rad): 0 where the elbow's motor stands on the base, and a parallelogram or a tendon keeps its
//                   angle to the vertical (WoodenHaptics, Phantom); 1 where it measures the angle between the links
//
// kDelta: 3 axes, the angles of three upper arms. z points from the base to the platform.
//
//      R - centre to motor axis     upper arm L, at the angle q_i from straight outward towards +z
//     +-----o___                    lower arm l, a parallelogram: the platform does not turn
//     |     q ''--..L               platform of radius r, its centre is the tip
//     |             o               the arms stand around the z axis at the azimuths angles_rad[0..2]
//     |           .' l
//     +--r--o---'                   tip = centre of the platform - (0, 0, z0)
//
//   lengths_m[0..3] = R >= 0, L > 0, l > 0, r >= 0
//   lengths_m[4] = z0
//   angles_rad[0..2]: all three 0 means 0, 120 and 240 degrees
#pragma once

#include "profile/profile.hpp"

namespace fdcg::dev {

struct TipPose {
  double position_m[3] = {};
  double jacobian[3][kMaxAxes] = {};  // d position / d axis; effort = transpose(jacobian) * force. Unused axes are 0.
};

// False where the axes have no pose (a delta out of reach, a number that is not finite) or the kind no such parameters or
// number of axes: *tip is then not to be used.
bool tip_pose(const KinematicsParams& kinematics, int axis_count, const double axis[kMaxAxes], TipPose* tip);

// How many axes a kind has: kCartesian 1 to 3, kRotary 1, the others 3.
bool axis_count_fits(KinematicsKind kind, int axis_count);

}  // namespace fdcg::dev
