// SPDX-License-Identifier: Apache-2.0
#include "profile/profile_kinematics.hpp"

#include <algorithm>
#include <string>

#include "profile/kinematics.hpp"

namespace fdcg::dev {
namespace {

// Of a device for a hand.
constexpr json::NumberRange kLength{0, 10, false, "m"};
constexpr json::NumberRange kLengthOrNone{0, 10, true, "m"};
constexpr json::NumberRange kOffset{-10, 10, true, "m"};
constexpr json::NumberRange kAngle{-7, 7, true, "rad"};  // a turn and a bit
constexpr json::NumberRange kCoupling{-1, 1, true, ""};

// The slots are those of kinematics.hpp.
void read_arm(const json::Value& json, KinematicsParams* kinematics) {
  json.allow_only({"kind", "shoulder_height_m", "upper_m", "forearm_m", "origin_m", "elbow_coupling"}, " of a serial arm");
  double* lengths_m = kinematics->lengths_m;
  lengths_m[0] = json["shoulder_height_m"].number(kLengthOrNone);
  lengths_m[1] = json["upper_m"].number(kLength);
  lengths_m[2] = json["forearm_m"].number(kLength);
  if (json["origin_m"]) json["origin_m"].numbers(lengths_m + 3, 3, kOffset);
  kinematics->angles_rad[0] = json["elbow_coupling"].number_or(0, kCoupling);
}

void read_delta(const json::Value& json, KinematicsParams* kinematics) {
  json.allow_only({"kind", "base_radius_m", "upper_m", "lower_m", "platform_radius_m", "origin_z_m", "azimuths_rad"},
                  " of a delta");
  double* lengths_m = kinematics->lengths_m;
  lengths_m[0] = json["base_radius_m"].number(kLengthOrNone);
  lengths_m[1] = json["upper_m"].number(kLength);
  lengths_m[2] = json["lower_m"].number(kLength);
  lengths_m[3] = json["platform_radius_m"].number(kLengthOrNone);
  lengths_m[4] = json["origin_z_m"].number_or(0, kOffset);
  if (!json["azimuths_rad"]) return;
  double* azimuths_rad = kinematics->angles_rad;
  json["azimuths_rad"].numbers(azimuths_rad, 3, kAngle);
  if (azimuths_rad[0] == azimuths_rad[1] || azimuths_rad[1] == azimuths_rad[2] || azimuths_rad[2] == azimuths_rad[0])
    json["azimuths_rad"].fail("has two that are equal; three arms stand in three directions");
}

}  // namespace

void read_kinematics(const json::Value& json, KinematicsParams* kinematics) {
  kinematics->kind = static_cast<KinematicsKind>(json["kind"].choice({"cartesian", "rotary", "serial-arm", "delta"}));
  switch (kinematics->kind) {
    case KinematicsKind::kCartesian:
      json.allow_only({"kind"}, " of a cartesian device");
      break;
    case KinematicsKind::kRotary:
      json.allow_only({"kind", "radius_m"}, " of a rotary device");
      kinematics->lengths_m[0] = json["radius_m"].number(kLength);
      break;
    case KinematicsKind::kSerialArm:
      read_arm(json, kinematics);
      break;
    case KinematicsKind::kDelta:
      read_delta(json, kinematics);
      break;
  }
}

void check_axis_count(const json::Value& kinematics, KinematicsKind kind, int axis_count) {
  if (axis_count_fits(kind, axis_count)) return;
  const char* wanted = kind == KinematicsKind::kRotary      ? "one axis"
                       : kind == KinematicsKind::kCartesian ? "1 to 3 axes"
                                                            : "3 axes";
  kinematics["kind"].fail(std::string("takes ") + wanted + "; the input report has " + std::to_string(axis_count));
}

}  // namespace fdcg::dev
