// SPDX-License-Identifier: Apache-2.0
#include "exact/planes.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "random.hpp"
#include "shared/face_plane.hpp"

using namespace fdcg::bake;
using fdcg::test::Random;

namespace {

constexpr unsigned kBits = 2400;  // exponents of 1e-150 and 1e150 side by side

using Wide = std::array<mpf_class, 3>;

Wide wide(const Vec3& v) {
  return {mpf_class(v.x, kBits), mpf_class(v.y, kBits), mpf_class(v.z, kBits)};
}
Wide minus(const Wide& a, const Wide& b) {
  return {mpf_class(a[0] - b[0]), mpf_class(a[1] - b[1]), mpf_class(a[2] - b[2])};
}
Wide exact_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Wide u = minus(wide(b), wide(a)), v = minus(wide(c), wide(a));
  Wide n{mpf_class(u[1] * v[2] - u[2] * v[1]), mpf_class(u[2] * v[0] - u[0] * v[2]), mpf_class(u[0] * v[1] - u[1] * v[0])};
  const mpf_class size = sqrt(mpf_class(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
  for (mpf_class& x : n)
    x /= size;
  return n;
}

// The largest error of a component, in units of 2^-53 (half a unit in the last place of 1).
double error_of(const Vec3& normal, const Wide& exact) {
  const std::array<double, 3> n{normal.x, normal.y, normal.z};
  double most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::fabs(mpf_class(mpf_class(n[k], kBits) - exact[k]).get_d()) * 0x1p53);
  return most;
}

}  // namespace

TEST_CASE("normals are good to two units in the last place on triangles of every shape") {
  Random random(1);
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    const double thinness = std::pow(10.0, -random.uniform(0, 14)), size = std::pow(10.0, random.uniform(-6, 6));
    const Vec3 a = random.uniform(0, 10) * size * random.direction();
    const Vec3 u = random.direction(), v = random.direction();
    const Vec3 b = a + size * u, c = a + size * (random.uniform(-1, 1) * u + thinness * v);
    const Wide exact = exact_normal(a, b, c);
    if (!(squared_length(cross(b - a, c - a)) > 0)) continue;
    most = std::max(most, error_of(unit_normal(a, b, c), exact));
  }
  INFO("largest error, units of 2^-53: " << most);
  CHECK(most <= 4);
}

// What a deformable mesh computes each tick, and what the compiler stores: the same bits, with every sign of zero.
TEST_CASE("the fast path of a normal gives the same bits") {
  Random random(11);
  int quick64 = 0, quick32 = 0, known = 0;
  constexpr int kTriangles = 200000;
  for (int i = 0; i < kTriangles; ++i) {
    const double thinness = random.chance(0.5) ? 1 : std::pow(10.0, -random.uniform(0, 14));
    const double size = std::pow(10.0, random.chance(0.9) ? random.uniform(-4, 4) : random.uniform(-70, 70));
    const Vec3 from = random.chance(0.8) ? std::pow(10.0, random.uniform(-8, 3)) * size * random.direction() : Vec3{};
    Vec3 u = random.direction(), v = random.uniform(-1, 1) * u + thinness * random.direction();
    if (random.chance(0.3)) u.z = v.z = 0;  // normals with zeros in them
    if (random.chance(0.1)) u.x = v.y = 0;
    const auto as_float = [](Vec3 p) { return fdcg::Vec3<double>{float(p.x), float(p.y), float(p.z)}; };
    const auto as_double = [](Vec3 p) { return fdcg::Vec3<double>{p.x, p.y, p.z}; };
    fdcg::Vec3<double> unit;
    const auto a = as_double(from), b = as_double(from + size * u), c = as_double(from + size * v);
    if (fdcg::quick_normal_of(a, b, c, &unit, double{})) {
      ++quick64;
      const auto whole = fdcg::unit_normal_of(a, b, c);
      known += std::memcmp(&unit, &whole, sizeof unit) == 0;
    }
    const auto fa = as_float(from), fb = as_float(from + size * u), fc = as_float(from + size * v);
    if (!(size < 1e30 && size > 1e-30) || !fdcg::quick_normal_of(fa, fb, fc, &unit, float{})) continue;
    ++quick32;
    const auto whole = fdcg::unit_normal_of(fa, fb, fc);
    const std::array<float, 3> is = {float(unit.x), float(unit.y), float(unit.z)},
                               ought = {float(whole.x), float(whole.y), float(whole.z)};
    known += std::memcmp(is.data(), ought.data(), sizeof is) == 0;
  }
  CHECK(known == quick64 + quick32);
  CHECK(quick64 > kTriangles / 2);
  CHECK(quick32 > kTriangles / 2);
}

TEST_CASE("normals are accurate at both ends of the exponent range") {
  Random random(2);
  for (const double size : {1e-300, 1e-150, 1e-60, 1e60, 1e150, 1e300}) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 a = size * random.direction(), b = size * random.direction(), c = size * random.direction();
      const Vec3 scaled = unit_normal(1 / size * a, 1 / size * b, 1 / size * c), plain = unit_normal(a, b, c);
      CAPTURE(size);
      CHECK(length(plain) == Approx(1).epsilon(1e-15));
      CHECK(dot(scaled, plain) == Approx(1).epsilon(1e-12));
      CHECK(length(edge_direction(a, b)) == Approx(1).epsilon(1e-15));
    }
  }
}

TEST_CASE("edge direction: swapping the ends negates it exactly") {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = random.direction(), b = random.direction();
    CHECK(edge_direction(a, b) == -edge_direction(b, a));
  }
}

TEST_CASE("the offset compensates the rounding of the normal") {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const std::array<Vec3, 3> p{100 * random.direction(), 100 * random.direction(), 100 * random.direction()};
    const Plane plane = stored_plane(unit_normal(p[0], p[1], p[2]), p, Precision::f32);
    mpf_class low(1e9, 300), high(-1e9, 300);
    for (const Vec3& v : p) {
      const mpf_class d = mpf_class(plane.normal.x, 300) * v.x + mpf_class(plane.normal.y, 300) * v.y +
                          mpf_class(plane.normal.z, 300) * v.z + plane.offset;
      low = std::min(low, d);
      high = std::max(high, d);
    }
    // Equal distances on both sides but for the rounding of the offset itself.
    CHECK(std::fabs(mpf_class(low + high).get_d()) <= 2 * 0x1p-24 * std::fabs(plane.offset) + 1e-13);
    CHECK(static_cast<float>(plane.offset) == plane.offset);
    CHECK(static_cast<float>(plane.normal.x) == plane.normal.x);
  }
}

TEST_CASE("angles between unit vectors agree with the arc cosine") {
  Random random(5);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 a = random.direction(), far = random.direction();
    const double t = std::pow(10.0, -random.uniform(0, 8)) * (random.chance(0.5) ? 1 : -1);
    const Vec3 b = unit((random.chance(0.5) ? a : -a) + t * far);
    const double expected = std::atan2(length(cross(a, b)), dot(a, b));
    const double nearest = std::min(expected, std::acos(-1.0) - expected);  // b is rounded
    CHECK(std::fabs(angle_between(a, b) - expected) <= 4e-8 * nearest + 4e-16);
  }
  CHECK(angle_between({1, 0, 0}, {1, 0, 0}) == 0);
  CHECK(angle_between({1, 0, 0}, {-1, 0, 0}) == Approx(std::acos(-1.0)));
}
