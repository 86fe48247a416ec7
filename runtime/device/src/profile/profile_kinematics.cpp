// SPDX-License-Identifier: Apache-2.0
#include "profile/profile_kinematics.hpp"

#include <algorithm>
#include <string>

#include "profile/kinematics.hpp"

namespace fdcg::dev {
namespace {

// Of a device for a hand.
constexpr NumberRange kLength{0, 10, false, "m"};
constexpr NumberRange kLengthOrNone{0, 10, true, "m"};
constexpr NumberRange kPlace{-10, 10, true, "m"};
constexpr NumberRange kAngle{-7, 7, true, "rad"};  // a turn and a bit
constexpr NumberRange kCoupling{-1, 1, true, ""};

// The slots are those of kinematics.hpp.
void read_arm(const JsonObject& json, KinematicsParams* kinematics) {
  json.allow_only({"kind", "shoulder_height_m", "upper_m", "forearm_m", "origin_m", "elbow_coupling"}, " of a serial arm");
  double* lengths_m = kinematics->lengths_m;
  lengths_m[0] = json.number("shoulder_height_m", kLengthOrNone);
  lengths_m[1] = json.number("upper_m", kLength);
  lengths_m[2] = json.number("forearm_m", kLength);
  if (json.has("origin_m")) json.numbers("origin_m", lengths_m + 3, 3, kPlace);
  kinematics->angles_rad[0] = json.number_or("elbow_coupling", 0, kCoupling);
}

void read_delta(const JsonObject& json, KinematicsParams* kinematics) {
  json.allow_only({"kind", "base_radius_m", "upper_m", "lower_m", "platform_radius_m", "origin_z_m", "azimuths_rad"},
                  " of a delta");
  double* lengths_m = kinematics->lengths_m;
  lengths_m[0] = json.number("base_radius_m", kLengthOrNone);
  lengths_m[1] = json.number("upper_m", kLength);
  lengths_m[2] = json.number("lower_m", kLength);
  lengths_m[3] = json.number("platform_radius_m", kLengthOrNone);
  lengths_m[4] = json.number_or("origin_z_m", 0, kPlace);
  if (!json.has("azimuths_rad")) return;
  double* azimuths_rad = kinematics->angles_rad;
  json.numbers("azimuths_rad", azimuths_rad, 3, kAngle);
  if (azimuths_rad[0] == azimuths_rad[1] || azimuths_rad[1] == azimuths_rad[2] || azimuths_rad[2] == azimuths_rad[0])
    json.fail("azimuths_rad", "has two that are equal; three arms stand in three directions");
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
      kinematics->lengths_m[0] = json.number("radius_m", kLength);
      break;
    case KinematicsKind::kSerialArm:
      read_arm(json, kinematics);
      break;
    case KinematicsKind::kDelta:
      read_delta(json, kinematics);
      break;
  }
}

void check_axis_count(const JsonObject& profile, KinematicsKind kind, int axis_count) {
  if (axis_count_fits(kind, axis_count)) return;
  const char* wanted = kind == KinematicsKind::kRotary      ? "one axis"
                       : kind == KinematicsKind::kCartesian ? "1 to 3 axes"
                                                            : "3 axes";
  profile.fail("kinematics.kind", std::string("takes ") + wanted + "; the input report has " + std::to_string(axis_count));
}

}  // namespace fdcg::dev
