// SPDX-License-Identifier: Apache-2.0
#include "bench_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "meshes.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr double kRadius_m = kObject_m / 2;
constexpr int kFewFaces =
    2000;  // up to here a sphere's faces are planes to the path, beyond they lie within a micrometre of it
constexpr double kRoughness = 0.1;  // of an edge

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Edges that a straight way crosses in the mean per metre: 2 / pi of the edges' length per area (Buffon). Regular triangles of
// side e have 3 e / 2 of edge to sqrt(3) / 4 e^2 of area.
double face_way_of_triangles(double edge_m) {
  return std::numbers::pi / 2 * (std::sqrt(3.0) / 4 * edge_m * edge_m) / (1.5 * edge_m);
}

// Of a regular triangle, as many of which as the body has faces cover the sphere.
double edge_of_sphere_m(int faces) {
  const double area = 4 * std::numbers::pi * kRadius_m * kRadius_m;
  return std::sqrt(area / faces * 4 / std::sqrt(3.0));
}

}  // namespace

BenchGraph::BenchGraph(const bake::PolygonSoup& soup, const bake::CompileOptions& options) {
  auto compiled = bake::compile(soup, options);
  fdcg_error error = {};
  if (compiled) bytes_ = std::move(compiled->bytes);
  if (!compiled || fdcg_open_memory(bytes_.data(), bytes_.size(), FDCG_VERIFY_TRUSTED, &view_, &error) != FDCG_OK) {
    std::fprintf(stderr, "%s: %s\n", soup.name.c_str(), compiled ? error.message : compiled.error().message.c_str());
    std::exit(2);
  }
}

bake::PolygonSoup make_body(Body body, int parts) {
  if (body == Body::cube || body == Body::block) return scaled(triangulated(cube()), kObject_m);
  bake::PolygonSoup soup = scaled(geodesic_sphere(parts), kRadius_m);
  if (body == Body::rough) {
    const double edge = edge_of_sphere_m(faces_of(body, parts)) / kRadius_m;
    Random random(1);
    for (bake::Vec3& p : soup.points) {
      const double factor = 1 + kRoughness * edge * random.uniform(-1, 1);
      p = {p.x * factor, p.y * factor, p.z * factor};
    }
  }
  return soup;
}

Surface::Surface(Body body, int parts) {
  if (body == Body::cube || body == Body::block) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double sign : {-1.0, 1.0}) {
        Point normal = {};
        normal[k] = sign;
        normals_.push_back(normal);
        offsets_m_.push_back(kRadius_m);
      }
    }
    edge_m_ = kObject_m;
    is_box_ = true;
    face_way_m_ = std::numbers::pi / 2 * kObject_m / std::numbers::sqrt2;  // the sides' diagonals; rims are not slid over
    return;
  }
  edge_m_ = edge_of_sphere_m(faces_of(body, parts));
  face_way_m_ = face_way_of_triangles(edge_m_);
  if (faces_of(body, parts) > kFewFaces) return;
  const bake::PolygonSoup soup = make_body(body, parts);
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const auto at = [&](std::size_t k) { return soup.points[soup.corners[soup.face_first[f] + k]]; };
    const bake::Vec3 a = at(0), b = at(1), c = at(2);
    const double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
    Point normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(dot(normal, normal));
    for (double& n : normal)
      n /= length;
    normals_.push_back(normal);
    offsets_m_.push_back(normal[0] * a.x + normal[1] * a.y + normal[2] * a.z);
  }
}

bool Surface::is_near_rim(const Point& direction) const {
  constexpr double kNear = 0.9;  // of the way from the middle of a side to its rim
  if (!is_box_) return false;
  Point size = {std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])};
  std::sort(size.begin(), size.end());
  return size[1] > kNear * size[2];
}

Point Surface::point(const Point& direction, double depth_m) const {
  double reach = normals_.empty() ? kRadius_m - depth_m : 1;
  for (std::size_t f = 0; f < normals_.size(); ++f) {
    const double slope = dot(normals_[f], direction);
    if (slope > 0) reach = std::min(reach, (offsets_m_[f] - depth_m) / slope);
  }
  return {direction[0] * reach, direction[1] * reach, direction[2] * reach};
}

namespace {

// A great circle that turns by a little over a hundredth of its own angle.
Point direction_at(double angle) {
  const double turn = 0.0137 * angle;
  return {std::cos(angle) * std::cos(turn), std::sin(angle), std::cos(angle) * std::sin(turn)};
}

// Depths from -`depth` to `depth` within a few ticks, rest at `depth`.
double depth_at(int tick, double depth_m) {
  constexpr int kPeriod = 250, kRamp = 10;
  const int phase = tick % kPeriod;
  const int from_end = std::min(phase, kPeriod - 1 - phase);
  return from_end < kRamp ? depth_m * (2.0 * from_end / kRamp - 1) : depth_m;
}

template <class Depth>
Path along(const Surface& surface, double way_m, int ticks, Depth depth) {
  Path path;
  path.reserve(static_cast<std::size_t>(ticks));
  double angle = 0.1;
  for (int i = 0; i < ticks; ++i) {
    const double depth_m = depth(i, direction_at(angle));
    const Point here = surface.point(direction_at(angle), depth_m);
    path.push_back(here);
    const double guess = way_m / kRadius_m;
    const double reached = distance(here, surface.point(direction_at(angle + guess), depth_m));
    angle += reached > 0 ? std::min(guess * way_m / reached, 1.5) : guess;
  }
  return path;
}

}  // namespace

Path slide(const Surface& surface, double way_m, double depth_m, int ticks) {
  return along(surface, way_m, ticks,
               [&](int i, const Point& direction) { return surface.is_near_rim(direction) ? -depth_m : depth_at(i, depth_m); });
}

Path hover(const Surface& surface, double way_m, double height_m, int ticks) {
  return along(surface, way_m, ticks, [&](int, const Point&) { return -height_m; });
}

Path far_away(double way_m, int ticks) {
  Path path;
  for (int i = 0; i < ticks; ++i)
    path.push_back({10 * kObject_m, way_m * i, 0.3 * way_m * i});
  return path;
}

Path teleports(int ticks, unsigned seed) {
  Random random(seed);
  Path path;
  for (int i = 0; i < ticks; ++i) {
    Point p;
    for (double& c : p)
      c = 1.2 * kRadius_m * random.uniform(-1, 1);
    path.push_back(p);
  }
  return path;
}

}  // namespace fdcg::test
