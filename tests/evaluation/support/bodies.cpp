// SPDX-License-Identifier: Apache-2.0
#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "drilled_plate.hpp"
#include "meshes.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr int kBusyFan = 10'000;  // faces at the apex of the fans
constexpr int kNeedles = 500;     // of the strip: each 500 times as long as wide
constexpr double kRadian = std::numbers::pi / 180;
constexpr std::uint64_t kTilt = 31;  // seed of the rotation of tilted bodies: no face is parallel to an axis

// Waves that a finger follows, of a tenth of the radius; on them hashed roughness, in edges.
PolygonSoup waved(int parts, double roughness) {
  PolygonSoup soup = geodesic_sphere(parts);
  const double edge = std::sqrt(4 * std::numbers::pi / (20.0 * parts * parts) * 4 / std::sqrt(3.0));
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    Vec3& p = soup.points[i];
    const double waves = std::sin(3 * p.x + 1) * std::cos(4 * p.y) + std::sin(5 * p.z + 2 * p.x);
    const double factor = 1 + 0.05 * waves + roughness * edge * (2 * hashed_unit(7, i) - 1);
    p = {p.x * factor, p.y * factor, p.z * factor};
  }
  return soup;
}

// A tenth of an edge: about half of all edges are concave whatever the fineness.
PolygonSoup star(int parts) {
  return waved(parts, 0.1);
}

PolygonSoup stretched(PolygonSoup soup, const Vec3& by) {
  for (Vec3& p : soup.points)
    p = {p.x * by.x, p.y * by.y, p.z * by.z};
  return soup;
}

// As a scanner sees it: noise of half an edge along the ray, coordinates of so many steps a radius.
PolygonSoup scan(int parts) {
  constexpr double kSteps = 1024;
  PolygonSoup soup = waved(parts, 0.5);
  for (Vec3& p : soup.points)
    p = {std::round(p.x * kSteps) / kSteps, std::round(p.y * kSteps) / kSteps, std::round(p.z * kSteps) / kSteps};
  return soup;
}

// 2 * 2n * n triangles.
PolygonSoup ring(int n) {
  return torus(2 * n, n);
}

PolygonSoup tilted(const PolygonSoup& soup) {
  return transformed(soup, random_rotation(kTilt));
}

// One point for each that a face uses.
std::vector<Body> awkward_bodies() {
  const auto group = BodyGroup::awkward;
  return {
      {"corner_pit", group, 24, true, "a cube without its octant: a concave corner of three faces, exact coordinates",
       [](int) { return corner_pit(); }},
      {"corner_pit_tilted", group, 48, true, "the same in triangles, turned: coplanar neighbours only to rounding",
       [](int) { return tilted(triangulated(corner_pit())); }},
      {"v_groove", group, 13, true, "a groove of 60 degrees in a block", [](int) { return v_groove(60 * kRadian); }},
      {"v_groove_tilted", group, 0, true, "the same in triangles, turned",
       [](int) { return tilted(triangulated(v_groove(60 * kRadian))); }},
      {"thin_plate", group, 0, true, "1 mm thick, each side 16 x 16 x 2 triangles",
       [](int) { return tilted(triangulated(thin_plate(0.01, 16))); }},
      {"foil", group, 0, true, "0.1 micrometres thick, in triangles",
       [](int) { return tilted(triangulated(thin_plate(1e-6, 4))); }},
      {"knife", group, 0, true, "a wedge of 2 degrees", [](int) { return tilted(wedge(2 * kRadian)); }},
      {"needle_strip", group, 0, false, "an open, arched strip of needles 500 times as long as wide",
       [](int) { return needle_strip(kNeedles, 0.2, 3); }},
      {"scan_24k", group, 0, true, "the waved ball as a scanner sees it: noise of half an edge, rounded coordinates",
       [](int) { return scan(35); }},
      {"drilled_plate", group, 0, true, "as CAD tessellates it: needles from the corners of a plate to its round hole",
       [](int) { return tilted(drilled_plate(512)); }},
      {"squashed_10k", group, 0, true, "the waved ball, a twentieth as thick",
       [](int) {
         return tilted(stretched(star(22), {1, 1, 0.05}));
       }},
      {"spindle_10k", group, 0, true, "the waved ball, a twentieth as wide: faces 20 times as long as wide",
       [](int) {
         return tilted(stretched(star(22), {0.05, 0.05, 1}));
       }},
      {"spiky", group, 0, true, "every vertex pulled out by up to the radius: sharp peaks, deep valleys",
       [](int) { return spiky_sphere(3, 1, 2); }},
      {"saddle", group, 0, true, "a saddle corner of eight faces", [](int) { return saddle_block(); }},
      {"fan_peak", group, 0, true, "a cone of 10,000 faces at one convex corner", [](int) { return cone(kBusyFan); }},
      {"fan_pit", group, 0, true, "a funnel of 10,000 faces at one concave corner", [](int) { return cone_pit(kBusyFan); }},
  };
}

std::vector<Body> every_body() {
  std::vector<Body> list = {
      {"cube_12", BodyGroup::sphere, 12, true, "twelve triangles", [](int) { return triangulated(cube()); }}};
  struct Rung {
    const char* name;
    int sphere_parts, ring;
  };
  constexpr Rung rungs[] = {{"80", 2, 0},      {"1k", 7, 16},    {"10k", 22, 50},
                            {"100k", 71, 158}, {"1M", 224, 500}, {"10M", 707, 1581}};
  const auto geodesic = [](int parts) { return static_cast<std::uint32_t>(20 * parts * parts); };
  for (const Rung& rung : rungs) {
    list.push_back({std::string("sphere_") + rung.name, BodyGroup::sphere, geodesic(rung.sphere_parts), true, "geodesic sphere",
                    geodesic_sphere, rung.sphere_parts});
  }
  for (const Rung& rung : rungs) {
    list.push_back({std::string("star_") + rung.name, BodyGroup::star, geodesic(rung.sphere_parts), true,
                    "a waved, rough ball: half of its edges concave", star, rung.sphere_parts});
  }
  for (const Rung& rung : rungs) {
    if (rung.ring == 0) continue;
    list.push_back({std::string("torus_") + rung.name, BodyGroup::torus, static_cast<std::uint32_t>(4 * rung.ring * rung.ring),
                    true, "torus", ring, rung.ring});
  }
  for (Body& body : awkward_bodies()) {
    body.faces = static_cast<std::uint32_t>(body.make_unscaled(0).face_count());
    list.push_back(std::move(body));
  }
  return list;
}

}  // namespace

bake::PolygonSoup scaled_to_body(const bake::PolygonSoup& soup) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (const Vec3& p : soup.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return scaled(soup, kBody_m / std::max({high.x - low.x, high.y - low.y, high.z - low.z}));
}

bake::PolygonSoup Body::make() const {
  PolygonSoup soup = scaled_to_body(make_unscaled(size));
  soup.name = name;
  return soup;
}

std::vector<Body> bodies(std::uint32_t most_faces) {
  std::vector<Body> list = every_body();
  std::erase_if(list, [&](const Body& body) { return body.faces > most_faces; });
  return list;
}

Body body_named(const std::string& name) {
  std::string names;
  for (Body& body : every_body()) {
    if (body.name == name) return std::move(body);
    names += (names.empty() ? "" : ", ") + body.name;
  }
  throw std::invalid_argument("no body '" + name + "'; there are: " + names);
}

}  // namespace fdcg::test
