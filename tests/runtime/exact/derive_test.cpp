// SPDX-License-Identifier: Apache-2.0
#include "shared/derive.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "catch.hpp"

using namespace fdcg;
using Random = std::mt19937_64;

namespace {

template <class Real>
Vec3<Real> any_point(Random& random, double size) {
  const auto coordinate = [&] { return static_cast<Real>(size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1)); };
  return {coordinate(), coordinate(), coordinate()};
}

template <class Real>
void check_edges(double size) {
  constexpr double kEps = static_cast<double>(std::numeric_limits<Real>::epsilon());
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3<Real> a = any_point<Real>(random, size), b = any_point<Real>(random, size);
    const Edge<Real> edge = derive_edge(a, b), back = derive_edge(b, a);
    const long double x = static_cast<long double>(b.x) - a.x, y = static_cast<long double>(b.y) - a.y,
                      z = static_cast<long double>(b.z) - a.z;
    const long double length = std::sqrt(x * x + y * y + z * z);
    INFO("size " << size << ", edge " << i);
    CHECK(std::fabs(static_cast<double>(edge.length / length - 1)) <= 4 * kEps);
    CHECK(std::fabs(static_cast<double>(edge.direction.x - x / length)) <= 4 * kEps);
    CHECK(std::fabs(static_cast<double>(edge.direction.y - y / length)) <= 4 * kEps);
    CHECK(std::fabs(static_cast<double>(edge.direction.z - z / length)) <= 4 * kEps);
    CHECK((edge.direction.x == -back.direction.x && edge.direction.y == -back.direction.y &&
           edge.direction.z == -back.direction.z));
    CHECK(edge.length == back.length);
  }
}

}  // namespace

TEST_CASE("an edge is the unit of its corners' difference at every size that a file may have") {
  for (const double size : {1e-300, 1e-160, 1e-60, 1.0, 1e60})
    check_edges<double>(size);
  for (const double size : {1e-35, 1e-20, 1e-9, 1.0, 1e9})
    check_edges<float>(size);
}

TEST_CASE("a Voronoi plane faces out of its face and holds the edge") {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const auto a = any_point<double>(random, 1), b = any_point<double>(random, 1), c = any_point<double>(random, 1);
    const Vec3<double> across = cross(b - a, c - a), n = across * (1 / norm(across));
    const double tolerance = 1e-15 / (norm(across) / (norm(b - a) * norm(c - a)));
    const Edge<double> edge = derive_edge(a, b);
    for (const uint32_t which : {0u, 1u}) {  // face 1 lies on the other side of the edge, with c mirrored
      const Plane<double> m = derive_voronoi_plane(edge.start, edge.direction, which == 0 ? n : n * -1.0, which);
      CHECK(m.distance(c) < 0);
      CHECK(std::fabs(m.distance(a)) < tolerance);
      CHECK(std::fabs(m.distance(b)) < tolerance);
      CHECK(std::fabs(dot(m.normal, n)) < tolerance);
    }
  }
}
