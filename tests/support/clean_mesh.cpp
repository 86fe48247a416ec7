// SPDX-License-Identifier: Apache-2.0
#include "clean_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "meshes.hpp"

namespace fdcg::test {
namespace {

constexpr double kPi = std::numbers::pi;

// Appends the shells of `part`, those on top level inside `parent`.
void append(CleanMesh& mesh, const CleanMesh& part, std::uint32_t parent = CleanMesh::kNone) {
  PolygonSoup& soup = mesh.soup;
  if (soup.face_first.empty()) soup.face_first.push_back(0);
  const auto point = static_cast<std::uint32_t>(soup.points.size()), face = static_cast<std::uint32_t>(soup.face_count());
  const auto corner = static_cast<std::uint32_t>(soup.corners.size()), shell = static_cast<std::uint32_t>(mesh.shells.size());
  soup.points.insert(soup.points.end(), part.soup.points.begin(), part.soup.points.end());
  for (const std::uint32_t v : part.soup.corners)
    soup.corners.push_back(point + v);
  for (std::size_t f = 1; f < part.soup.face_first.size(); ++f)
    soup.face_first.push_back(corner + part.soup.face_first[f]);
  for (CleanMesh::Shell s : part.shells) {
    s.first_face += face;
    s.end_face += face;
    s.parent = s.parent == CleanMesh::kNone ? parent : shell + s.parent;
    mesh.shells.push_back(s);
  }
  for (const auto& [v, w] : part.facing)
    mesh.facing.push_back({point + v, point + w});
}

// A closed surface; a cavity's faces are turned over.
void add_shell(CleanMesh& mesh, const PolygonSoup& surface, std::uint32_t parent, bool is_cavity) {
  CleanMesh part;
  part.soup = surface;
  part.shells.push_back({0, static_cast<std::uint32_t>(surface.face_count()), CleanMesh::kNone, is_cavity});
  for (std::size_t f = 0; is_cavity && f < surface.face_count(); ++f)
    std::reverse(part.soup.corners.begin() + surface.face_first[f], part.soup.corners.begin() + surface.face_first[f + 1]);
  append(mesh, part, parent);
}

// A plate of n x n squares in triangles, waved by `wave`; its inner vertices face one another through the plate.
CleanMesh plate(std::uint32_t n, double wave, std::uint64_t seed) {
  const double cell = 1.0 / n, thickness = 1.5 * cell;
  PolygonSoup box = grid_box(static_cast<int>(n), static_cast<int>(n), 1, {1, 1, thickness});
  CleanMesh mesh;
  const auto place = [&](const Vec3& p) {
    return std::pair<int, int>{static_cast<int>(std::lround((p.x + 0.5) * n)), static_cast<int>(std::lround((p.y + 0.5) * n))};
  };
  std::map<std::pair<int, int>, std::uint32_t> below;
  const int last = static_cast<int>(n);
  for (std::uint32_t v = 0; v < box.points.size(); ++v) {
    const auto [i, j] = place(box.points[v]);
    if (box.points[v].z < 0 && i > 0 && j > 0 && i < last && j < last) below[{i, j}] = v;
  }
  for (std::uint32_t v = 0; v < box.points.size(); ++v) {
    const auto other = below.find(place(box.points[v]));
    if (box.points[v].z > 0 && other != below.end()) mesh.facing.push_back({v, other->second});
  }
  PolygonSoup triangles = triangulated(box, seed);
  for (Vec3& p : triangles.points)
    p.z += wave * (p.x * p.x - p.y * p.y);
  add_shell(mesh, triangles, CleanMesh::kNone, false);
  return mesh;
}

// `outer` with its own shape shrunk as its cavity: `inner` has the same vertices closer in.
CleanMesh hollow(const PolygonSoup& outer, const PolygonSoup& inner, bool faces_through) {
  CleanMesh mesh;
  add_shell(mesh, outer, CleanMesh::kNone, false);
  add_shell(mesh, inner, 0, true);
  const auto n = static_cast<std::uint32_t>(outer.points.size());
  for (std::uint32_t v = 0; faces_through && v < n; ++v)
    mesh.facing.push_back({v, v + n});
  return mesh;
}

CleanMesh solid(const PolygonSoup& soup) {
  CleanMesh mesh;
  add_shell(mesh, soup, CleanMesh::kNone, false);
  return mesh;
}

// The level at which 20 * 4^level comes closest to so many faces, at least 1.
int sphere_level(double faces) {
  return std::clamp(static_cast<int>(std::lround(std::log(std::max(faces, 1.0) / 20) / std::log(4.0))), 1, 6);
}

CleanMesh hollow_sphere(std::uint32_t faces) {
  const int level = std::max(2, sphere_level(faces / 2.0));
  const double edge = 1.1 * std::pow(0.5, level);
  const PolygonSoup outer = ico_sphere(level);
  return hollow(outer, scaled(outer, 1 - 1.2 * edge), true);
}

// Quads of about equal sides on a torus, each in two triangles.
PolygonSoup torus_of(std::uint32_t faces, double tube) {
  const int across = std::max(6, static_cast<int>(std::lround(std::sqrt(faces / 2.0 * tube))));
  return torus(std::max(8, static_cast<int>(std::lround(across / tube))), across, tube);
}

CleanMesh hollow_torus(std::uint32_t faces) {
  const int across = std::max(16, static_cast<int>(std::lround(std::sqrt(faces / 4.0 * 0.4))));
  const int around = 5 * across / 2;
  // The inner tube's circle around lies where the outer one's does, so that each vertex faces its namesake. The wall is one and
  // a half edges thick: the neighbours of a vertex lie well above the inner tube's tangent plane there.
  return hollow(torus(around, across, 0.4), torus(around, across, 0.4 * (1 - 3 * kPi / across)), true);
}

PolygonSoup prism_row(std::uint32_t faces, Random& random) {
  const int sides = 5 + static_cast<int>(random.below(12));
  const std::uint32_t floors = std::max(1u, faces / static_cast<std::uint32_t>(sides));
  // One tall prism in storeys: quads around, a polygon at either end. Storeys are about as high as wide.
  const double height = std::ldexp(1.0, static_cast<int>(std::lround(std::log2(2 * kPi / sides))));
  std::vector<Vec3> points;
  std::vector<Polygon> loops;
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k <= floors; ++k) {
    for (std::uint32_t i = 0; i < n; ++i)
      points.push_back({std::cos(2 * kPi * i / sides), std::sin(2 * kPi * i / sides), height * k});
  }
  for (std::uint32_t k = 0; k < floors; ++k) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      loops.push_back({k * n + i, k * n + j, k * n + n + j, k * n + n + i});
    }
  }
  Polygon floor, roof;
  for (std::uint32_t i = 0; i < n; ++i) {
    floor.push_back(n - 1 - i);
    roof.push_back(floors * n + i);
  }
  loops.push_back(floor);
  loops.push_back(roof);
  return make_soup("storeys", std::move(points), loops);
}

CleanMesh one_piece(Random& random, std::uint32_t faces, bool triangles_only) {
  const auto side = std::max(3u, static_cast<std::uint32_t>(std::sqrt(faces / 4.0)));
  switch (random.below(triangles_only ? 6 : 9)) {
    case 0:
      return plate(side, 0, random.bits());
    case 1:
      return plate(side, 0.4, random.bits());
    case 2: {
      const int level = sphere_level(faces);
      return solid(star_sphere(level, 0.2 * std::pow(0.5, level), random.bits()));
    }
    case 3:
      return solid(torus_of(faces, 0.4));
    case 4:
      return hollow_sphere(faces);
    case 5:
      return hollow_torus(faces);
    case 6: {
      const int n = std::max(2, static_cast<int>(std::sqrt(faces / 6.0)));
      return solid(grid_box(n, n, n, {1, 1, 1}));
    }
    case 7:
      return solid(grid_box(static_cast<int>(side), static_cast<int>(side), 2, {1, 1, 2.0 / side}));
    default:
      return solid(prism_row(faces, random));
  }
}

// A piece inside the cavity of a larger hollow sphere.
CleanMesh nested(Random& random, std::uint32_t faces, bool triangles_only) {
  constexpr double kOuter = 16, kInner = 12;  // every piece but long prisms lies within 4 of the origin
  const PolygonSoup sphere = ico_sphere(std::min(3, sphere_level(faces / 4.0)));
  CleanMesh mesh = hollow(scaled(sphere, kOuter), scaled(sphere, kInner), false);
  CleanMesh inside;
  do {
    inside = one_piece(random, faces / 2, triangles_only);
  } while (std::any_of(inside.soup.points.begin(), inside.soup.points.end(),
                       [](const Vec3& p) { return std::hypot(p.x, p.y, p.z) > 4; }));
  append(mesh, inside, 1);
  return mesh;
}

void require_distinct(const PolygonSoup& soup) {
  std::set<std::tuple<double, double, double>> seen;
  for (const Vec3& p : soup.points) {
    if (!seen.emplace(p.x, p.y, p.z).second) throw std::logic_error("clean mesh: two points came out equal");
  }
}

}  // namespace

CleanMesh random_clean_mesh(Random& random, std::uint32_t faces, bool triangles_only) {
  const std::uint32_t pieces = faces < 400 ? 1 : 1 + random.below(4);
  CleanMesh mesh;
  double x = 0;
  for (std::uint32_t k = 0; k < pieces; ++k) {
    const bool is_nested = faces / pieces > 1500 && random.chance(0.25);
    CleanMesh piece =
        is_nested ? nested(random, faces / pieces, triangles_only) : one_piece(random, faces / pieces, triangles_only);
    double low = 0, high = 0;
    for (const Vec3& p : piece.soup.points) {
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
    for (Vec3& p : piece.soup.points)
      p.x += x - std::floor(low);
    x += std::ceil(high) - std::floor(low) + 1;
    append(mesh, piece);
  }
  mesh.soup = rounded_to_float(mesh.soup);
  mesh.soup.name = "clean";
  require_distinct(mesh.soup);
  return mesh;
}

}  // namespace fdcg::test
