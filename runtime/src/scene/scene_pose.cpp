// SPDX-License-Identifier: Apache-2.0
// Poses as callers give them.
#include "base/message.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {
namespace {

constexpr double kLargestScale = 1e9, kFarthestTranslation_m = 1e12;

bool is_within(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

fdcg_status checked_pose(const fdcg_pose* asked, fdcg_pose* pose, fdcg_error* error) {
  if (asked == nullptr) return refuse(error, "pose: null pointer");
  static const char* const kTranslation[] = {"pose.translation_m[0]", "pose.translation_m[1]", "pose.translation_m[2]"};
  double length2 = 0;
  for (const double part : asked->rotation_xyzw)
    length2 += part * part;
  const double length = root(length2);
  if (!is_within(length, 1 - kUnitTolerance, 1 + kUnitTolerance))
    return refuse(error, "pose.rotation_xyzw's length", length, 1 - kUnitTolerance, 1 + kUnitTolerance);
  for (int k = 0; k < 3; ++k) {
    if (!is_within(asked->translation_m[k], -kFarthestTranslation_m, kFarthestTranslation_m))
      return refuse(error, kTranslation[k], asked->translation_m[k], -kFarthestTranslation_m, kFarthestTranslation_m);
  }
  if (!is_within(asked->scale, 1 / kLargestScale, kLargestScale))
    return refuse(error, "pose.scale", asked->scale, 1 / kLargestScale, kLargestScale);
  *pose = *asked;
  for (double& part : pose->rotation_xyzw)
    part /= length;
  return FDCG_OK;
}

bool is_same(const fdcg_pose& a, const fdcg_pose& b) {
  for (int k = 0; k < 4; ++k) {
    if (a.rotation_xyzw[k] != b.rotation_xyzw[k]) return false;
  }
  return a.translation_m[0] == b.translation_m[0] && a.translation_m[1] == b.translation_m[1] &&
         a.translation_m[2] == b.translation_m[2] && a.scale == b.scale;
}

}  // namespace fdcg

extern "C" fdcg_pose fdcg_make_identity_pose(void) {
  fdcg_pose pose = {};
  pose.rotation_xyzw[3] = 1;
  pose.scale = 1;
  return pose;
}
