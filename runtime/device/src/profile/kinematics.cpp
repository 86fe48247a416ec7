// SPDX-License-Identifier: Apache-2.0
#include "profile/kinematics.hpp"

#include <cmath>

namespace fdcg::dev {
namespace {

struct V3 {
  double x, y, z;
};
V3 operator+(V3 a, V3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V3 operator-(V3 a, V3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V3 operator*(double s, V3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
double dot(V3 a, V3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
V3 cross(V3 a, V3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

void set_position(TipPose* tip, V3 p) {
  tip->position_m[0] = p.x;
  tip->position_m[1] = p.y;
  tip->position_m[2] = p.z;
}

void set_column(TipPose* tip, int axis, V3 d) {
  tip->jacobian[0][axis] = d.x;
  tip->jacobian[1][axis] = d.y;
  tip->jacobian[2][axis] = d.z;
}

bool cartesian(int axis_count, const double* axis, TipPose* tip) {
  for (int i = 0; i < axis_count; ++i) {
    tip->position_m[i] = axis[i];
    tip->jacobian[i][i] = 1;
  }
  return true;
}

bool rotary(const KinematicsParams& k, const double* axis, TipPose* tip) {
  const double r = k.lengths_m[0];
  if (!(r > 0)) return false;
  const double c = r * std::cos(axis[0]), s = r * std::sin(axis[0]);
  set_position(tip, {c, s, 0});
  set_column(tip, 0, {-s, c, 0});
  return true;
}

bool serial_arm(const KinematicsParams& k, const double* axis, TipPose* tip) {
  const double a = k.lengths_m[0], b = k.lengths_m[1], c = k.lengths_m[2], coupling = k.angles_rad[0];
  if (!(a >= 0 && b > 0 && c > 0)) return false;
  const double elbow = axis[2] + coupling * axis[1];
  const V3 forward = {std::cos(axis[0]), std::sin(axis[0]), 0}, up = {0, 0, 1};
  const double bs = b * std::sin(axis[1]), bc = b * std::cos(axis[1]), cs = c * std::sin(elbow), cc = c * std::cos(elbow);
  const V3 upper = bc * forward - bs * up, fore = cc * forward - cs * up;  // derivatives by q1 alone and by the elbow's angle
  set_position(tip, (bs + cs) * forward + (a + bc + cc) * up - V3{k.lengths_m[3], k.lengths_m[4], k.lengths_m[5]});
  set_column(tip, 0, (bs + cs) * V3{-forward.y, forward.x, 0});
  set_column(tip, 1, upper + coupling * fore);
  set_column(tip, 2, fore);
  return true;
}

// Where three spheres of radius `radius` meet, on the side of their centres' plane to which z points. False: nowhere, or along
// a curve.
bool meeting_point(const V3 centre[3], double radius, V3* point) {
  const V3 u = centre[1] - centre[0], v = centre[2] - centre[0];
  V3 normal = cross(u, v);
  const double normal2 = dot(normal, normal);
  if (!(normal2 > 0)) return false;  // on one line; nearly so, and the circle below is out of reach
  // the circumcentre of the triangle, from centre 0
  const V3 c = (1 / (2 * normal2)) * (dot(u, u) * cross(v, normal) + dot(v, v) * cross(normal, u));
  const double height2 = radius * radius - dot(c, c);
  if (!(height2 >= 0)) return false;
  if (normal.z < 0) normal = -1.0 * normal;
  *point = centre[0] + c + std::sqrt(height2 / normal2) * normal;
  return true;
}

// The Jacobian from |P - C_i(q_i)| = l: with w_i = P - C_i, w_i . dP = (w_i . C_i') dq_i.
bool delta(const KinematicsParams& k, const double* axis, TipPose* tip) {
  const double base = k.lengths_m[0], upper = k.lengths_m[1], lower = k.lengths_m[2], platform = k.lengths_m[3];
  if (!(base >= 0 && upper > 0 && lower > 0 && platform >= 0)) return false;
  constexpr double kThird = 2.0943951023931953;  // 120 degrees
  const bool is_even = k.angles_rad[0] == 0 && k.angles_rad[1] == 0 && k.angles_rad[2] == 0;
  V3 centre[3], motion[3];
  for (int i = 0; i < 3; ++i) {
    const double azimuth = is_even ? i * kThird : k.angles_rad[i];
    const V3 outward = {std::cos(azimuth), std::sin(azimuth), 0};
    const double c = upper * std::cos(axis[i]), s = upper * std::sin(axis[i]);
    centre[i] = (base - platform + c) * outward + V3{0, 0, s};
    motion[i] = -s * outward + V3{0, 0, c};
  }
  V3 point;
  if (!meeting_point(centre, lower, &point)) return false;
  const V3 w[3] = {point - centre[0], point - centre[1], point - centre[2]};
  const double determinant = dot(w[0], cross(w[1], w[2]));
  constexpr double kSingular = 1e-6;  // lower arms in one plane: no effort holds the platform
  if (!(std::fabs(determinant) > kSingular * lower * lower * lower)) return false;
  set_position(tip, point - V3{0, 0, k.lengths_m[4]});
  for (int i = 0; i < 3; ++i)
    set_column(tip, i, (dot(w[i], motion[i]) / determinant) * cross(w[(i + 1) % 3], w[(i + 2) % 3]));
  return true;
}

bool is_finite(const TipPose& tip) {
  double sum = 0;  // times zero: NaN as soon as one of them is infinite or NaN
  for (int i = 0; i < 3; ++i) {
    sum += 0 * tip.position_m[i];
    for (int j = 0; j < kMaxAxes; ++j)
      sum += 0 * tip.jacobian[i][j];
  }
  return sum == 0;
}

}  // namespace

bool axis_count_fits(KinematicsKind kind, int axis_count) {
  if (kind == KinematicsKind::kCartesian) return axis_count >= 1 && axis_count <= kMaxAxes;
  return axis_count == (kind == KinematicsKind::kRotary ? 1 : 3);
}

bool tip_pose(const KinematicsParams& kinematics, int axis_count, const double axis[kMaxAxes], TipPose* tip) {
  *tip = TipPose();
  if (!axis_count_fits(kinematics.kind, axis_count)) return false;
  for (int i = 0; i < axis_count; ++i)
    if (!std::isfinite(axis[i])) return false;
  bool is_there = false;
  switch (kinematics.kind) {
    case KinematicsKind::kCartesian:
      is_there = cartesian(axis_count, axis, tip);
      break;
    case KinematicsKind::kRotary:
      is_there = rotary(kinematics, axis, tip);
      break;
    case KinematicsKind::kSerialArm:
      is_there = serial_arm(kinematics, axis, tip);
      break;
    case KinematicsKind::kDelta:
      is_there = delta(kinematics, axis, tip);
      break;
  }
  return is_there && is_finite(*tip);
}

}  // namespace fdcg::dev
