// SPDX-License-Identifier: Apache-2.0
// T-junctions and slivers at every size, rotated, rounded; the counts on small meshes are recounted in validate_test.
#include "validate/t_junctions.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "catch.hpp"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::Faces;
using fdcg::test::joined;
using fdcg::test::make_soup;

namespace {

std::uint64_t total(const PolygonSoup& soup, const std::string& rule, const ValidateOptions& options = {}) {
  for (const Issue& issue : validate(soup, options).issues)
    if (issue.rule == rule) return issue.total;
  return 0;
}

// A strip of `coarse` triangles pairs whose far side is cut into `fine` times as many, so that fine - 1 vertices stand inside
// each coarse edge of the seam y = 0.
PolygonSoup seam(std::uint32_t coarse, std::uint32_t fine) {
  std::vector<Vec3> points;
  Faces faces;
  const auto strip = [&](std::uint32_t cells, double width, double far) {
    const auto base = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i <= cells; ++i) {
      points.push_back({i * width, 0, 0});
      points.push_back({i * width, far, 0});
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = base + 2 * i;
      faces.push_back({a, a + 2, a + 3});
      faces.push_back({a, a + 3, a + 1});
    }
  };
  strip(coarse, 1, 1);
  strip(coarse * fine, 1.0 / fine, -1);
  return make_soup(points, faces);
}

struct Rotation {
  double m[3][3];
  explicit Rotation(std::mt19937& rng) {
    std::normal_distribution<double> normal;
    double q[4];
    for (double& c : q)
      c = normal(rng);
    const double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double x = q[1], y = q[2], z = q[3], w = q[0];
    const double r[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                            {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                            {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
    std::copy(&r[0][0], &r[0][0] + 9, &m[0][0]);
  }
  Vec3 operator()(const Vec3& p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z, m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z,
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z};
  }
};

}  // namespace

TEST_CASE("a seam has its vertices inside edges counted, rotated and rounded, in double and in float") {
  std::mt19937 rng(41);
  for (int round = 0; round < 200; ++round) {
    CAPTURE(round);
    const std::uint32_t coarse = 1 + static_cast<std::uint32_t>(rng() % 30), fine = 1 + static_cast<std::uint32_t>(rng() % 6);
    PolygonSoup soup = seam(coarse, fine);
    const Rotation rotation(rng);
    const bool is_float = round % 2 == 0;
    const double offset = round % 3 == 0 ? 1000 : 0;
    for (Vec3& p : soup.points) {
      p = rotation(p);
      p = {p.x + offset, p.y, p.z - offset};
      if (is_float) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    soup.relative_quantum = is_float ? 0x1p-24 : 0x1p-53;
    CHECK(total(soup, "t-junction") == coarse * (fine - 1));
  }
}

TEST_CASE("vertices off the edge by more than the rounding, or at its ends, are no T-junctions") {
  PolygonSoup soup = seam(1, 2);
  const auto with_middle = [&](const Vec3& p) {
    PolygonSoup moved = soup;
    for (Vec3& q : moved.points)
      if (q == Vec3{0.5, 0, 0}) q = p;
    return total(moved, "t-junction");
  };
  soup.absolute_quantum = 1e-6;  // six digits after the point: reach is 4 sqrt(3) times that
  CHECK(with_middle({0.5, 0, 0}) == 1);
  CHECK(with_middle({0.5, -6.9e-6, 0}) == 1);
  CHECK(with_middle({0.5, 0, 6.9e-6}) == 1);
  CHECK(with_middle({0.5, -7.0e-6, 0}) == 0);
  CHECK(with_middle({6.9e-6, 0, 0}) == 0);  // as far as the file tells the same vertex as the end
  CHECK(with_middle({7.0e-6, 0, 0}) == 1);
  CHECK(with_middle({0.5, -0.5, 0}) == 0);
}

TEST_CASE("an exact T-junction is found whatever the rounding") {
  // (0.1, 0.3, 0.7) times 3 is not representable; the points below are on one line exactly, the last far out.
  const Vec3 d{0.1, 0.3, 0.7};
  const PolygonSoup soup = make_soup({{0, 0, 0}, {1024 * d.x, 1024 * d.y, 1024 * d.z}, {5, 0, 0}, d, {-5, 0, 0}, {0, -5, 0}},
                                     {{0, 1, 2}, {3, 4, 5}});
  CHECK(total(soup, "t-junction") == 1);
}

TEST_CASE("T-junctions and slivers are found at extreme sizes") {
  for (const double scale : {1e-310, 1e-300, 1e-200, 1e-30, 1.0, 1e30, 1e200, 5e307}) {
    CAPTURE(scale);
    const auto scaled = [&](PolygonSoup soup) {
      for (Vec3& p : soup.points)
        p = {p.x * scale, p.y * scale, p.z * scale};
      return soup;
    };
    CHECK(total(scaled(seam(1, 2)), "t-junction") == 1);
    CHECK(total(scaled(make_soup({{-2, 0, 0}, {2, 0, 0}, {0, 0.00398, 0}}, {{0, 1, 2}})), "sliver-face") == 1);
    CHECK(total(scaled(make_soup({{-2, 0, 0}, {2, 0, 0}, {0, 0.00402, 0}}, {{0, 1, 2}})), "sliver-face") == 0);
    CHECK(total(scaled(make_soup({{-2, 0, 0}, {2, 0, 0}, {2, 0.00398, 0}, {-2, 0.00398, 0}}, {{0, 1, 2, 3}})), "sliver-face") ==
          1);
    CHECK(total(scaled(make_soup({{-2, 0, 0}, {2, 0, 0}, {2, 0.00403, 0}, {-2, 0.00403, 0}}, {{0, 1, 2, 3}})), "sliver-face") ==
          0);
  }
}

TEST_CASE("the corners of the edge's own face do not lie inside it") {
  PolygonSoup soup = make_soup({{0, 0, 0}, {2, 0, 0}, {1, 1e-7, 0}}, {{0, 1, 2}});
  soup.absolute_quantum = 1e-6;
  CHECK(total(soup, "t-junction") == 0);
  CHECK(total(soup, "sliver-face") == 1);
}

TEST_CASE("T-junctions: time is near linear on open meshes of many faces") {
  const auto start = std::chrono::steady_clock::now();
  ValidateOptions loose;
  loose.weld = {Weld::Kind::none, 0};
  loose.severities["self-intersection"] = std::nullopt;  // billions of pairs that touch, which that rule has to count
  // A fan of 100,000 faces around one point, none of them sharing a vertex: 100,000 copies of the centre.
  std::vector<Vec3> points;
  Faces faces;
  constexpr std::uint32_t kFaces = 100000;
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const double a = 6.283185307179586 * i / kFaces, b = 6.283185307179586 * (i + 1) / kFaces;
    points.insert(points.end(), {{0, 0, 0}, {std::cos(a), std::sin(a), 0}, {std::cos(b), std::sin(b), 0}});
    faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  CHECK(total(make_soup(points, faces), "t-junction", loose) == 0);
  // As many long edges over as many vertices on one line.
  points.clear();
  faces.clear();
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    points.insert(points.end(), {{double(i), 0, 0}, {2.0 * kFaces - i, 0, 0}, {double(i), double(i + 1), 1}});
    faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  CHECK(total(make_soup(points, faces), "t-junction", loose) == 2 * kFaces - 2);
  CHECK(total(seam(1, kFaces), "t-junction") == kFaces - 1);
  CHECK(total(seam(kFaces, 2), "t-junction") == kFaces);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
}
