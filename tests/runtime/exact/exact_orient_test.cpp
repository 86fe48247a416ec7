// SPDX-License-Identifier: Apache-2.0
#include "exact/exact_orient.hpp"

#include <gmpxx.h>

#include <cmath>
#include <random>

#include "base/work.hpp"
#include "catch.hpp"

namespace {

using Point = fdcg::Vec3<double>;

int rational_sign(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto q = [](double x, double y) -> mpq_class { return mpq_class(x) - mpq_class(y); };
  const mpq_class ux = q(b.x, a.x), uy = q(b.y, a.y), uz = q(b.z, a.z);
  const mpq_class vx = q(c.x, a.x), vy = q(c.y, a.y), vz = q(c.z, a.z);
  const mpq_class wx = q(d.x, a.x), wy = q(d.y, a.y), wz = q(d.z, a.z);
  const mpq_class det = (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz;
  return sgn(det);
}

double nudge(double x, int steps) {
  for (; steps > 0; --steps)
    x = std::nextafter(x, 1e300);
  for (; steps < 0; ++steps)
    x = std::nextafter(x, -1e300);
  return x;
}

}  // namespace

TEST_CASE("orientation has the sign of the rational determinant for points in general position") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Point{uniform(random), uniform(random), uniform(random)}; };
  for (int i = 0; i < 2000; ++i) {
    const Point a = point(), b = point(), c = point(), d = point();
    REQUIRE(fdcg::orient3d_sign(a, b, c, d) == rational_sign(a, b, c, d));
  }
}

TEST_CASE("orientation is exact within units in the last place of a plane, at any size and offset") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::uniform_int_distribution<int> steps(-2, 2);
  int zeros = 0;
  for (const double size : {1e-30, 1e-6, 1.0, 1e6, 1e30}) {
    for (const double offset : {0.0, 1.0, 1e6}) {
      const auto coordinate = [&] { return size * (offset + uniform(random)); };
      const auto point = [&] { return Point{coordinate(), coordinate(), coordinate()}; };
      for (int i = 0; i < 300; ++i) {
        const Point a = point(), b = point(), c = point();
        const double s = uniform(random), t = uniform(random);
        const auto on_plane = [&](double pa, double pb, double pc) {
          return nudge(pa + s * (pb - pa) + t * (pc - pa), steps(random));
        };
        const Point d = {on_plane(a.x, b.x, c.x), on_plane(a.y, b.y, c.y), on_plane(a.z, b.z, c.z)};
        const int expected = rational_sign(a, b, c, d);
        REQUIRE(fdcg::orient3d_sign(a, b, c, d) == expected);
        REQUIRE(fdcg::orient3d_sign(b, a, c, d) == -expected);
        REQUIRE(fdcg::orient3d_sign(c, d, a, b) == expected);
        zeros += expected == 0;
      }
    }
  }
  INFO("exactly coplanar cases met: " << zeros);
}

TEST_CASE("orientation of points on one line or in one plane is zero") {
  const Point a = {0.1, 0.2, 0.3}, b = {0.7, -0.4, 0.9};
  REQUIRE(fdcg::orient3d_sign(a, b, a, b) == 0);
  REQUIRE(fdcg::orient3d_sign(a, b, b, {5, 6, 7}) == 0);
  REQUIRE(fdcg::orient3d_sign({0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.3, 0.4, 1}) == 0);
  REQUIRE(fdcg::orient3d_sign({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5e-300}) == 1);
}

TEST_CASE("orientation is exact for coordinates of every size a double has, up to 1e70") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int decided[3] = {};
  for (const int spread : {4, 40, 100, 300, 1050}) {
    std::uniform_int_distribution<int> exponent(-spread, 0);
    const auto coordinate = [&] { return std::ldexp(uniform(random), exponent(random)); };
    const auto point = [&] { return Point{coordinate(), coordinate(), coordinate()}; };
    for (const double size : {1.0, 1e70}) {
      for (int i = 0; i < 400; ++i) {
        Point a = point(), b = point(), c = point(), d = point();
        if (i % 4 == 1) d = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
        if (i % 4 == 2) c = {a.x + b.x, a.y + b.y, a.z + b.z}, d = {a.x - b.x, a.y - b.y, a.z - b.z};
        if (i % 4 == 3) a.z = b.z = c.z = d.z = coordinate();
        for (Point* p : {&a, &b, &c, &d})
          *p = {size * p->x, size * p->y, size * p->z};
        const int expected = rational_sign(a, b, c, d);
        INFO("spread " << spread << ", size " << size << ", case " << i);
        REQUIRE(fdcg::orient3d_sign(a, b, c, d) == expected);
        REQUIRE(fdcg::orient3d_sign(a, c, b, d) == -expected);
        ++decided[expected + 1];
      }
    }
  }
  CHECK(decided[0] > 100);
  CHECK(decided[1] > 100);
  CHECK(decided[2] > 100);
}

TEST_CASE("orientation uses no more work than a sign needs") {
  using fdcg::kExactWork, fdcg::kLongExactWork, fdcg::kPairsWork;
  const auto spent = [](const Point& a, const Point& b, const Point& c, const Point& d) {
    uint32_t left = 1000;
    fdcg::orient3d_sign(a, b, c, d, &left);
    return 1000 - left;
  };
  const Point a = {0.1, 0.2, 0.3}, b = {1.3, 0.4, 0.7}, c = {0.6, 1.9, 1.1};
  CHECK(spent(a, b, c, {0.5, 0.5, 2}) == 0);                          // the filter
  CHECK(spent(a, b, c, b) == 0);                                      // a corner
  CHECK(spent({1, 2, 5}, {3, 7, 5}, {4, 1, 5}, {0.1, 0.3, 5}) == 0);  // an axis' plane
  const Point middle = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
  CHECK(spent(a, b, c, {middle.x, middle.y, nudge(middle.z, 1)}) == kPairsWork);
  const Point even = {1, 2, 3}, along = {2, 4, 7}, across = {5, 1, 2};
  CHECK(spent(even, along, across, {3, 6, 11}) == kPairsWork + kExactWork);  // even + 2 (along - even)
  CHECK(spent({0, 0, 0}, {0x1p-60, 1, 0}, {0x1p-60, 1, 1}, {0x1p-59, 2, 5}) == kPairsWork + kLongExactWork);
}

TEST_CASE("orientation is right beside planes closer than double-double arithmetic resolves") {
  for (const double off : {0x1p-100, 0x1p-150, 0x1p-300, -0x1p-101, -0x1p-400}) {
    const Point a = {0, 0, 0}, b = {1, 3, 0}, c = {2, 1, 1}, d = {3, 4, 1};  // d = b + c
    INFO(off);
    CHECK(fdcg::orient3d_sign({off, 0, 0}, b, c, d) == rational_sign({off, 0, 0}, b, c, d));
    CHECK(fdcg::orient3d_sign(a, {1, 3, off}, c, d) == rational_sign(a, {1, 3, off}, c, d));
  }
}
