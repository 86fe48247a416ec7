// SPDX-License-Identifier: Apache-2.0
#include "import/dae_transform.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace fdcg::bake::dae {
namespace {

using xml::Node;

constexpr double kRadians = std::numbers::pi / 180;

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const xml::File& file, const Node& node) {
  std::array<double, kCount> values{};
  std::size_t at = 0;
  const std::uint64_t there = file.for_each_real(node, [&](double value, const Printed&) {
    if (at < kCount) values[at++] = value;
  });
  if (there != kCount) file.fail(node, "has " + std::to_string(there) + " numbers, not " + std::to_string(kCount));
  return values;
}

double dot_product(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3 cross_product(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A vector of length 1.
Vec3 direction_of(const xml::File& file, const Node& node, const Vec3& v, const std::string& trouble) {
  const double length = std::hypot(v.x, v.y, v.z);
  if (!(length > 0 && std::isfinite(length))) file.fail(node, trouble + "; export the scene again");
  return {v.x / length, v.y / length, v.z / length};
}

// Row by row in the file.
Matrix matrix_of(const xml::File& file, const Node& node) {
  const auto rows = numbers_of<16>(file, node);
  if (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1)
    file.fail(node, "has a last row that is not 0 0 0 1; export the scene again");
  Matrix matrix{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column)
      matrix[4 * column + row] = rows[4 * row + column];
  }
  return matrix;
}

// An axis and degrees; quarter turns are exact.
Matrix rotation_of(const xml::File& file, const Node& node) {
  const auto [x, y, z, degrees] = numbers_of<4>(file, node);
  if (!std::isfinite(degrees)) file.fail(node, "turns by no finite angle; export the scene again");
  const double turn = std::fmod(degrees, 360.0);
  if (turn == 0) return kIdentity;
  const Vec3 axis = direction_of(file, node, {x, y, z}, "turns about an axis without direction");
  double c = std::cos(turn * kRadians), s = std::sin(turn * kRadians);
  if (std::fmod(turn, 90.0) == 0) {
    const int quarters = (static_cast<int>(turn / 90) + 4) % 4;
    c = quarters == 0 ? 1 : quarters == 2 ? -1 : 0;
    s = quarters == 1 ? 1 : quarters == 3 ? -1 : 0;
  }
  return turned_about(axis, c, s);
}

// Degrees, an axis, and the direction along which points are shifted: as far as they lie along the axis, so that the axis
// itself leans by the angle towards that direction (the Skew of RenderMan).
Matrix skew_of(const xml::File& file, const Node& node) {
  const auto n = numbers_of<7>(file, node);
  const Vec3 axis = direction_of(file, node, {n[1], n[2], n[3]}, "skews an axis without direction");
  const Vec3 shift = direction_of(file, node, {n[4], n[5], n[6]}, "skews along an axis without direction");
  const double along = dot_product(axis, shift);
  const Vec3 across{axis.x - along * shift.x, axis.y - along * shift.y, axis.z - along * shift.z};
  const double part = std::hypot(across.x, across.y, across.z);
  constexpr double kLeastPart = 1e-9;  // below, the axes are parallel but for the rounding of their numbers
  if (part < kLeastPart) file.fail(node, "skews an axis along itself; export the scene with matrices");
  const double lean = std::atan2(along, part) + n[0] * kRadians;
  if (!(std::fabs(lean) < std::numbers::pi / 2))
    file.fail(node, "skews by an angle that reaches the axis of the shift; export the scene with matrices");
  const double factor = (std::tan(lean) - along / part) / part;
  Matrix m = kIdentity;
  const std::array<double, 3> from = {across.x * factor, across.y * factor, across.z * factor};
  const std::array<double, 3> to = {shift.x, shift.y, shift.z};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      m[4 * column + row] += to[row] * from[column];
  }
  return m;
}

// An eye, a point that it looks at, and up: the node's -z points there, its y is as far up as that leaves.
Matrix look_of(const xml::File& file, const Node& node) {
  const auto n = numbers_of<9>(file, node);
  const Vec3 eye{n[0], n[1], n[2]};
  const Vec3 back = direction_of(file, node, {n[0] - n[3], n[1] - n[4], n[2] - n[5]}, "looks at its own place");
  const Vec3 up = direction_of(file, node, {n[6], n[7], n[8]}, "has an 'up' without direction");
  const Vec3 right = direction_of(file, node, cross_product(up, back), "looks straight up");
  const Vec3 top = cross_product(back, right);
  return {right.x, right.y, right.z, 0, top.x, top.y, top.z, 0, back.x, back.y, back.z, 0, eye.x, eye.y, eye.z, 1};
}

}  // namespace

Matrix transform_of(const xml::File& file, const Node& element) {
  const std::string_view kind = xml::name_of(element);
  Matrix own = kIdentity;
  if (kind == "translate") {
    const auto t = numbers_of<3>(file, element);
    own[12] = t[0], own[13] = t[1], own[14] = t[2];
  } else if (kind == "scale") {
    const auto s = numbers_of<3>(file, element);
    own[0] = s[0], own[5] = s[1], own[10] = s[2];
  } else if (kind == "matrix") {
    own = matrix_of(file, element);
  } else if (kind == "rotate") {
    own = rotation_of(file, element);
  } else if (kind == "skew") {
    own = skew_of(file, element);
  } else if (kind == "lookat") {
    own = look_of(file, element);
  }
  return own;
}

}  // namespace fdcg::bake::dae
