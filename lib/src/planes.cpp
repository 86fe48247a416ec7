// SPDX-License-Identifier: Apache-2.0
#include "planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vec.hpp"

namespace fdcg::bake {
namespace {

// An unevaluated sum: the value and what rounding it left over.
struct Split {
  double value, rest;
};

// a - b exactly (Knuth).
Split difference(double a, double b) {
  const double value = a - b;
  const double b_part = a - value;
  const double a_part = value + b_part;
  return {value, (a - a_part) + (b_part - b)};
}

// a * b exactly (Dekker), barring underflow.
Split product(double a, double b) {
  constexpr double kSplitter = 134217729;  // 2^27 + 1
  const double ca = kSplitter * a, cb = kSplitter * b;
  const double a_high = ca - (ca - a), b_high = cb - (cb - b);
  const double a_low = a - a_high, b_low = b - b_high;
  const double value = a * b;
  return {value, a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

// a * d - b * c of split numbers, with a relative error of some 2^-100 of the two products.
double cross_component(const Split& a, const Split& b, const Split& c, const Split& d) {
  const Split ad = product(a.value, d.value), bc = product(b.value, c.value);
  const Split sum = difference(ad.value, bc.value);
  const double rests = (a.value * d.rest + a.rest * d.value) - (b.value * c.rest + b.rest * c.value);
  return sum.value + (sum.rest + ((ad.rest - bc.rest) + rests));
}

constexpr double kSmall = 1e-60, kLarge = 1e60;  // products of four of these neither underflow nor overflow

// A power of two that brings `size` near 1.
double scale_for(double size) {
  int exponent = 0;
  std::frexp(size, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

bool is_moderate(double size) {
  return size > kSmall && size < kLarge;
}

}  // namespace

Vec3 unit_of_any_size(const Vec3& v) {
  const double size = largest_component(v);
  if (size == 0) return v;
  const Vec3 scaled = scale_for(size) * v;
  // The least numbers need more than one step.
  return is_moderate(largest_component(scaled)) ? unit(scaled) : unit(scale_for(largest_component(scaled)) * scaled);
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Split ux = difference(b.x, a.x), uy = difference(b.y, a.y), uz = difference(b.z, a.z);
  const Split vx = difference(c.x, a.x), vy = difference(c.y, a.y), vz = difference(c.z, a.z);
  const double size = std::max({std::fabs(ux.value), std::fabs(uy.value), std::fabs(uz.value), std::fabs(vx.value),
                                std::fabs(vy.value), std::fabs(vz.value)});
  if (!is_moderate(size) && size > 0) {
    const double s = scale_for(size);
    const Vec3 scaled_a = s * a, scaled_b = s * b, scaled_c = s * c;
    const double again = std::max(largest_component(scaled_b - scaled_a), largest_component(scaled_c - scaled_a));
    if (is_moderate(again)) return unit_normal(scaled_a, scaled_b, scaled_c);
  }
  return unit({cross_component(uy, uz, vy, vz), cross_component(uz, ux, vz, vx), cross_component(ux, uy, vx, vy)});
}

double balanced_offset(const Vec3& normal, std::span<const Vec3> points) {
  const Vec3& first = points.front();
  double lowest = 0, highest = 0;
  for (const Vec3& point : points.subspan(1)) {
    const double height = dot(normal, point - first);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  const Split x = product(normal.x, first.x), y = product(normal.y, first.y), z = product(normal.z, first.z);
  const Split xy = difference(x.value, -y.value), xyz = difference(xy.value, -z.value);
  const double rest = ((x.rest + y.rest) + z.rest) + (xy.rest + xyz.rest);
  return -(xyz.value + (rest + 0.5 * (lowest + highest)));
}

Plane stored_plane(const Vec3& normal, std::span<const Vec3> points, Precision precision) {
  if (precision == Precision::f64) return {normal, balanced_offset(normal, points)};
  const Vec3 rounded{static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)};
  return {rounded, static_cast<float>(balanced_offset(rounded, points))};
}

double angle_between(const Vec3& a, const Vec3& b) {
  constexpr double kPi = 3.14159265358979323846;
  const double cosine = dot(a, b), c = std::min(std::fabs(cosine), 1.0);
  constexpr std::array<double, 8> kSeries{-0.0012624911, 0.0066700901, -0.0170881256, 0.0308918810,
                                          -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050};
  double sum = 0;
  for (const double coefficient : kSeries)
    sum = coefficient + c * sum;
  const double angle = std::sqrt(1 - c) * sum;
  return cosine < 0 ? kPi - angle : angle;
}

}  // namespace fdcg::bake
