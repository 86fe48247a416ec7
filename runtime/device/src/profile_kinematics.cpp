// SPDX-License-Identifier: Apache-2.0
#include "profile_kinematics.hpp"

#include <algorithm>
#include <string>

namespace fdcg::dev {
namespace {

constexpr NumberRange kLength{-10, 10, true, "m"};  // a device for a hand
constexpr NumberRange kRadius{0, 10, false, "m"};
constexpr NumberRange kAngle{-100, 100, true, "rad"};
constexpr int kMostParameters = 6;

void copy(const std::vector<double>& from, double* to) {
  std::copy(from.begin(), from.end(), to);
}

}  // namespace

void read_kinematics(const JsonObject& json, KinematicsParams* kinematics) {
  kinematics->kind = static_cast<KinematicsKind>(json.choice("kind", {"cartesian", "rotary", "serial-arm", "delta"}));
  switch (kinematics->kind) {
    case KinematicsKind::kCartesian:
      json.allow_only({"kind"}, " of a cartesian device");
      break;
    case KinematicsKind::kRotary:
      json.allow_only({"kind", "radius_m"}, " of a rotary device");
      kinematics->lengths_m[0] = json.number("radius_m", kRadius);
      break;
    case KinematicsKind::kSerialArm:
    case KinematicsKind::kDelta:
      json.allow_only({"kind", "lengths_m", "angles_rad"}, " of a jointed device");
      copy(json.numbers("lengths_m", 1, kMostParameters, kLength), kinematics->lengths_m);
      if (json.has("angles_rad")) copy(json.numbers("angles_rad", 1, kMostParameters, kAngle), kinematics->angles_rad);
      break;
  }
}

void check_axis_count(const JsonObject& profile, KinematicsKind kind, int axis_count) {
  const int fewest = kind == KinematicsKind::kCartesian || kind == KinematicsKind::kRotary ? 1 : 3;
  const int most = kind == KinematicsKind::kRotary ? 1 : 3;
  if (axis_count >= fewest && axis_count <= most) return;
  profile.fail("kinematics.kind", "takes " + std::to_string(fewest) + (fewest == most ? "" : " to " + std::to_string(most)) +
                                      " axes; the input report has " + std::to_string(axis_count));
}

}  // namespace fdcg::dev
