// SPDX-License-Identifier: Apache-2.0
// A triangle's plane, good to a unit or two in the last place whatever its shape: the compiler stores the bits that these
// expressions give, and a deformable graph computes them again.
#pragma once

#include "shared/derive.hpp"
#include "shared/error_free.hpp"

namespace fdcg {

// a * d - b * c of split numbers, with a relative error of some 2^-100 of the two products.
FDCG_HOT double cross_component(const Split& a, const Split& b, const Split& c, const Split& d) {
  const Split ad = exact_product(a.value, d.value), bc = exact_product(b.value, c.value);
  const Split sum = exact_difference(ad.value, bc.value);
  const double rests = (a.value * d.rest + a.rest * d.value) - (b.value * c.rest + b.rest * c.value);
  return sum.value + (sum.rest + ((ad.rest - bc.rest) + rests));
}

inline double largest_of(Vec3<double> v) {
  const double x = absolute(v.x), y = absolute(v.y), z = absolute(v.z), xy = x > y ? x : y;
  return xy > z ? xy : z;
}

// A power of two that brings `size` near 1.
inline double scale_for(double size) {
  constexpr int kMost = 1000;  // its inverse is a number too
  constexpr int kBias = 1023, kBits = 52;
  // 2^(exponent - 1) <= size < 2^exponent; of a denormal number less than -kMost, which is all that counts.
  const int exponent = static_cast<int>(__builtin_bit_cast(uint64_t, size) >> kBits & 0x7FF) - (kBias - 1);
  const int scale = exponent > kMost ? -kMost : exponent < -kMost ? kMost : -exponent;
  return __builtin_bit_cast(double, static_cast<uint64_t>(scale + kBias) << kBits);
}

// Products of four numbers of such a size neither underflow nor overflow.
inline bool is_moderate(double size) {
  return size > 1e-60 && size < 1e60;
}

inline Vec3<double> over(Vec3<double> v, double length) {
  return {v.x / length, v.y / length, v.z / length};
}

// unit(v), with no loss at either end of the exponent's range; zero stays zero.
inline Vec3<double> unit_of_any_size(Vec3<double> v) {
  const double size = largest_of(v);
  if (size == 0) return v;
  Vec3<double> scaled = v * scale_for(size);
  // The least numbers need more than one step.
  if (!is_moderate(largest_of(scaled))) scaled = scaled * scale_for(largest_of(scaled));
  return over(scaled, norm(scaled));
}
// Of a square whose own square and root's products stay in range.
inline bool is_square_in_range(double squared) {
  return squared > 1e-200 && squared < 1e200;
}
inline Vec3<double> unit_of(Vec3<double> v) {
  const double squared = dot(v, v);
  return is_square_in_range(squared) ? over(v, root(squared)) : unit_of_any_size(v);
}

struct SplitEdges {
  Split ux, uy, uz, vx, vy, vz;

  SplitEdges(Vec3<double> a, Vec3<double> b, Vec3<double> c)
      : ux(exact_difference(b.x, a.x)),
        uy(exact_difference(b.y, a.y)),
        uz(exact_difference(b.z, a.z)),
        vx(exact_difference(c.x, a.x)),
        vy(exact_difference(c.y, a.y)),
        vz(exact_difference(c.z, a.z)) {}

  [[nodiscard]] double size() const {
    const double u = largest_of({ux.value, uy.value, uz.value}), v = largest_of({vx.value, vy.value, vz.value});
    return u > v ? u : v;
  }
  [[nodiscard]] Vec3<double> product() const {
    return {cross_component(uy, uz, vy, vz), cross_component(uz, ux, vz, vx), cross_component(ux, uy, vx, vy)};
  }
};

// unit((b - a) x (c - a)): differences and products without rounding error where it matters, so that needles come out as
// well as equilateral triangles. Zero where the three are collinear.
inline Vec3<double> unit_normal_of(Vec3<double> a, Vec3<double> b, Vec3<double> c) {
  const SplitEdges edges(a, b, c);
  const double size = edges.size();
  if (!is_moderate(size) && size > 0) {
    const double s = scale_for(size);
    const SplitEdges scaled(a * s, b * s, c * s);
    if (is_moderate(scaled.size())) return unit_of(scaled.product());
  }
  return unit_of(edges.product());
}

// Of the product of two sides: a triangle whose doubled area is more is none in one line, whatever the rounding.
inline constexpr double kSurelyWide = 1e-12;

// The same, which rounded to Real is so to the bit, with less work; false: not for this triangle, which may be a line.
FDCG_HOT bool quick_normal_of(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double>* unit, double) {
  const SplitEdges edges(a, b, c);
  const double u = norm1(Vec3<double>{edges.ux.value, edges.uy.value, edges.uz.value}),
               v = norm1(Vec3<double>{edges.vx.value, edges.vy.value, edges.vz.value});
  if (!(is_moderate(u / 4) && is_moderate(v / 4))) return false;
  const Vec3<double> product = edges.product();
  const double squared = dot(product, product);
  if (!(norm1(product) > kSurelyWide * (u * v) && is_square_in_range(squared))) return false;
  *unit = over(product, root(squared));
  return true;
}

inline bool is_sure_float(double x, double error) {
  const auto low = static_cast<float>(x - error), high = static_cast<float>(x + error);
  return __builtin_bit_cast(uint32_t, low) == __builtin_bit_cast(uint32_t, high);
}

// In plain double: its error is some 2^-50 of the two products that a component is the difference of, and of the component.
// Where that is too little to matter to the float that is nearest, the exact one has the same.
FDCG_HOT bool quick_normal_of(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double>* unit, float) {
  constexpr double kRounding = 0x1p-49;
  const Vec3<double> u = b - a, v = c - a;
  const Vec3<double> plus = {u.y * v.z, u.z * v.x, u.x * v.y}, minus = {u.z * v.y, u.x * v.z, u.y * v.x};
  const Vec3<double> product = plus - minus;
  const double squared = dot(product, product);
  if (!(norm1(product) > kSurelyWide * (norm1(u) * norm1(v)) && is_square_in_range(squared))) return false;
  const double inverse = 1 / root(squared), rounding = kRounding * inverse;
  *unit = product * inverse + Vec3<double>{0, 0, 0};  // no -0, which the exact one is not
  const double own = rounding * (norm1(plus) + norm1(minus));
  return is_sure_float(unit->x, rounding * (absolute(plus.x) + absolute(minus.x)) + own * absolute(unit->x)) &&
         is_sure_float(unit->y, rounding * (absolute(plus.y) + absolute(minus.y)) + own * absolute(unit->y)) &&
         is_sure_float(unit->z, rounding * (absolute(plus.z) + absolute(minus.z)) + own * absolute(unit->z));
}

// Of numbers that are Reals: floats' products are exact as they are.
template <class Real>
FDCG_HOT Split exact_product_of(double a, double b) {
  if constexpr (sizeof(Real) < sizeof(double)) return {a * b, 0};
  return exact_product(a, b);
}

// -normal.point, rounded once at the end but for `middle`, which is taken off.
template <class Real>
FDCG_HOT double offset_through(Vec3<double> normal, Vec3<double> point, double middle) {
  const Split x = exact_product_of<Real>(normal.x, point.x), y = exact_product_of<Real>(normal.y, point.y),
              z = exact_product_of<Real>(normal.z, point.z);
  const Split xy = exact_difference(x.value, -y.value), xyz = exact_difference(xy.value, -z.value);
  const double rest = ((x.rest + y.rest) + z.rest) + (xy.rest + xyz.rest);
  return -(xyz.value + (rest + middle));
}

inline double lesser_of(double a, double b) {
  return b < a ? b : a;
}
inline double greater_of(double a, double b) {
  return a < b ? b : a;
}

// The plane as it is stored: the normal rounded to Real, then the offset that makes the largest distance of the three corners
// from it smallest, rounded. Corners are Reals.
template <class Real>
FDCG_HOT Plane<Real> plane_with_normal(Vec3<double> unit, Vec3<double> a, Vec3<double> b, Vec3<double> c) {
  const Vec3<Real> normal = {static_cast<Real>(unit.x), static_cast<Real>(unit.y), static_cast<Real>(unit.z)};
  const Vec3<double> stored = {normal.x, normal.y, normal.z};
  const double height_b = dot(stored, b - a), height_c = dot(stored, c - a);
  const double lowest = lesser_of(lesser_of(0, height_b), height_c), highest = greater_of(greater_of(0, height_b), height_c);
  return {normal, static_cast<Real>(offset_through<Real>(stored, a, 0.5 * (lowest + highest)))};
}

// The angle between two unit vectors, 0 .. pi, within 4e-8 of itself or of what it lacks to pi (Abramowitz and Stegun 4.4.46;
// from the chord, of which a small angle is as good as the vectors): a weight for a corner's normal, of which only the side
// counts. By additions, products and square root alone, so that every compiler and C library gives the same bits.
inline double angle_of(Vec3<double> a, Vec3<double> b) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kSeries[8] = {-0.0012624911, 0.0066700901, -0.0170881256, 0.0308918810,
                                 -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050};
  const bool is_blunt = dot(a, b) < 0;
  const Vec3<double> chord = is_blunt ? a + b : a - b;
  const double less = lesser_of(dot(chord, chord) / 2, 1.0), cosine = 1 - less;
  double sum = 0;
  for (const double coefficient : kSeries)
    sum = coefficient + cosine * sum;
  const double angle = root(less) * sum;
  return is_blunt ? kPi - angle : angle;
}

}  // namespace fdcg
