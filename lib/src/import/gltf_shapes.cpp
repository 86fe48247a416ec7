// SPDX-License-Identifier: Apache-2.0
// Shapes of KHR_implicit_shapes as surfaces of a scene.
#include <algorithm>
#include <cmath>

#include "import/gltf_physics.hpp"

namespace fdcg::bake {
namespace gltf {
namespace {

using Axes = std::array<Vec3, 3>;

double length_of(const Vec3& v) {
  return std::hypot(v.x, v.y, v.z);
}
double inner(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Where a transform takes the axes, as factors and unit vectors, right-handed: a shape is the same from either side of x.
struct Frame {
  Axes axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::array<double, 3> factors = {1, 1, 1};
  bool is_square = true;  // the axes stay at right angles, and none is flattened
};

Frame frame_of(const Matrix* world) {
  Frame frame;
  if (world == nullptr) return frame;
  const Matrix& m = *world;
  constexpr double kSlack = 1e-9;  // of unit vectors: products of a few matrices of rounded numbers
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 column{m[4 * k], m[4 * k + 1], m[4 * k + 2]};
    const double f = frame.factors[k] = length_of(column);
    frame.is_square = frame.is_square && f > 0 && std::isfinite(f);
    frame.axes[k] = {column.x / f, column.y / f, column.z / f};
  }
  for (std::size_t k = 0; k < 3; ++k)
    frame.is_square = frame.is_square && std::fabs(inner(frame.axes[k], frame.axes[(k + 1) % 3])) <= kSlack;
  if (is_mirrored(m)) frame.axes[0] = {-frame.axes[0].x, -frame.axes[0].y, -frame.axes[0].z};
  return frame;
}

// Of a rotation whose columns are the axes: by the largest of its four parts, which keeps all digits.
std::array<double, 4> quaternion_of(const Axes& a) {
  const double xx = a[0].x, yy = a[1].y, zz = a[2].z;
  const std::array<double, 4> squares = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz};
  const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const double d = 2 * std::sqrt(squares[largest]);
  const double xy = (a[0].y + a[1].x) / d, xz = (a[0].z + a[2].x) / d, yz = (a[1].z + a[2].y) / d;
  const double wx = (a[1].z - a[2].y) / d, wy = (a[2].x - a[0].z) / d, wz = (a[0].y - a[1].x) / d;
  switch (largest) {
    case 0:
      return {d / 4, xy, xz, wx};
    case 1:
      return {xy, d / 4, yz, wy};
    case 2:
      return {xz, yz, d / 4, wz};
    default:
      return {wx, wy, wz, d / 4};
  }
}

// Surfaces have their axis along z: x stays, what was y is z.
Axes with_axis_up(const Axes& a) {
  return {a[0], Vec3{-a[2].x, -a[2].y, -a[2].z}, a[1]};
}

bool is_equal(double a, double b) {
  constexpr double kSlack = 1e-9;
  return std::fabs(a - b) <= kSlack * std::max(std::fabs(a), std::fabs(b));
}

void place_axial(const ImplicitShape& shape, const Frame& frame, StatedShape& placed) {
  const std::array<double, 3>& f = frame.factors;
  placed.radius_m = shape.radius * f[0];
  placed.length_m = shape.height * f[1];
  if (!is_equal(f[0], f[2])) {
    placed.problem = "is stretched across its axis by " + std::to_string(f[0]) + " and " + std::to_string(f[2]);
  } else if (shape.kind == ImplicitShape::Kind::cylinder && shape.radius == shape.top_radius) {
    placed.kind = "cylinder";
  } else if (shape.kind == ImplicitShape::Kind::cylinder) {
    placed.kind = "cone";
    placed.top_radius_m = shape.top_radius * f[0];
  } else if (shape.radius != shape.top_radius) {
    placed.problem = "is a capsule of two radii";
  } else if (!is_equal(f[0], f[1])) {
    placed.problem = "is a capsule stretched along its axis";
  } else {
    placed.kind = "capsule";
  }
}

void place_kind(const ImplicitShape& shape, const Frame& frame, StatedShape& placed) {
  using Kind = ImplicitShape::Kind;
  const std::array<double, 3>& f = frame.factors;
  if (shape.kind == Kind::other) {
    placed.problem = "is of the kind '" + shape.name + "', which no extension that is read describes";
  } else if (!frame.is_square) {
    placed.problem = "is sheared or flattened by the transforms of its node";
  } else if (shape.kind == Kind::box) {
    placed.kind = "box";
    for (std::size_t k = 0; k < 3; ++k)
      placed.half_m[k] = shape.size[k] / 2 * f[k];
  } else if (shape.kind == Kind::sphere) {
    const bool is_round = is_equal(f[0], f[1]) && is_equal(f[1], f[2]);
    placed.kind = is_round ? "sphere" : "ellipsoid";
    if (is_round) placed.radius_m = shape.radius * f[0];
    for (std::size_t k = 0; k < 3 && !is_round; ++k)
      placed.half_m[k] = shape.radius * f[k];
  } else if (shape.kind == Kind::plane) {
    const bool is_endless = shape.size[0] == 0 && shape.size[2] == 0;
    (is_endless ? placed.kind : placed.problem) = is_endless ? "plane" : "is a plane with an end, which encloses nothing";
  } else {
    place_axial(shape, frame, placed);
  }
}

}  // namespace

StatedShape placed_shape(const ImplicitShape& shape, const Matrix* world) {
  using Kind = ImplicitShape::Kind;
  StatedShape placed;
  const Frame frame = frame_of(world);
  place_kind(shape, frame, placed);
  if (placed.kind.empty()) {
    placed.radius_m = placed.length_m = 0;
    return placed;
  }
  const bool has_axis = shape.kind == Kind::capsule || shape.kind == Kind::cylinder || shape.kind == Kind::plane;
  placed.rotation_xyzw = quaternion_of(has_axis ? with_axis_up(frame.axes) : frame.axes);
  if (world != nullptr) placed.translation_m = {(*world)[12], (*world)[13], (*world)[14]};
  return placed;
}

std::array<Vec3, 8> corners_of_box(const ImplicitShape& box) {
  std::array<Vec3, 8> corners;
  for (std::size_t c = 0; c < 8; ++c) {
    const auto side = [&](std::size_t axis) { return (c >> axis & 1) != 0 ? box.size[axis] / 2 : -box.size[axis] / 2; };
    corners[c] = {side(0), side(1), side(2)};
  }
  return corners;
}

}  // namespace gltf

}  // namespace fdcg::bake
