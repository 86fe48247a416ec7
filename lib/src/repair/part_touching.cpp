// SPDX-License-Identifier: Apache-2.0
#include "repair/part_touching.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/vec3.hpp"
#include "topology/face_triangles.hpp"
#include "validate/self_intersection.hpp"

namespace fdcg::bake {
namespace {

// Polygons, which middles of edges have made of some triangles, become triangles again.
void cut_polygons(Workpiece& piece) {
  const View view(piece);
  const FaceGeometry geometry(view.mesh, view.states);
  const FaceTriangles cut(view.mesh, geometry, 1);
  if (cut.is_plain()) return;
  PolygonSoup& soup = piece.soup;
  std::vector<std::uint32_t> corners, first{0}, source;
  for (std::uint32_t t = 0; t < cut.count(); ++t) {
    for (std::size_t i = 0; i < 3; ++i)
      corners.push_back(view.mesh.source_point[+cut.corners(t)[i]]);
    first.push_back(static_cast<std::uint32_t>(corners.size()));
    source.push_back(piece.source_face[+cut.face(t)]);
  }
  soup.corners = std::move(corners);
  soup.face_first = std::move(first);
  piece.source_face = std::move(source);
}

// Points at whose coordinates there is another one.
std::vector<std::uint32_t> shared_places(const PolygonSoup& soup) {
  std::vector<std::uint32_t> order(soup.points.size()), shared;
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) { return std::tie(soup.points[v].x, soup.points[v].y, soup.points[v].z); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool as_before = i > 0 && key(order[i]) == key(order[i - 1]);
    const bool as_after = i + 1 < order.size() && key(order[i]) == key(order[i + 1]);
    if (as_before || as_after) shared.push_back(order[i]);
  }
  std::sort(shared.begin(), shared.end());
  return shared;
}

struct Inwards {
  Vec3 way;                 // of length 1, or 0 where there is none
  double shortest = 1e300;  // edge at the point
};

std::vector<Inwards> inward_ways(const PolygonSoup& soup) {
  std::vector<Inwards> ways(soup.points.size());
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t* const c = &soup.corners[soup.face_first[f]];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 a = soup.points[c[(i + 1) % 3]] - soup.points[c[i]], b = soup.points[c[(i + 2) % 3]] - soup.points[c[i]];
      const Vec3 normal = cross(a, b);
      const double size = length(normal);
      Inwards& way = ways[c[i]];
      way.shortest = std::min({way.shortest, length(a), length(b)});
      if (size > 0) way.way = way.way - std::atan2(size, dot(a, b)) / size * normal;
    }
  }
  for (Inwards& each : ways) {
    const double size = length(each.way);
    each.way = size > 1e-6 ? 1 / size * each.way : Vec3{};
  }
  return ways;
}

SelfIntersections meeting_faces(const Workpiece& piece, unsigned jobs) {
  const View view(piece);
  const FaceGeometry geometry(view.mesh, view.states, jobs);
  SelfIntersectionOptions how;
  how.max_listed = kAllElements;
  how.jobs = jobs;
  return find_self_intersections(view.mesh, geometry, how);
}

}  // namespace

Parting part_touching(Workpiece& piece, double reach, bool as_floats, unsigned jobs) {
  Parting parting;
  cut_polygons(piece);
  PolygonSoup& soup = piece.soup;
  const std::vector<std::uint32_t> shared = shared_places(soup);
  if (shared.empty()) return parting;
  const std::vector<Vec3> places = soup.points;
  const std::vector<Inwards> ways = inward_ways(soup);
  constexpr double kShareOfEdge = 1.0 / 16, kLess = 1.0 / 8;
  std::vector<double> step(soup.points.size(), 0);
  for (const std::uint32_t v : shared)
    step[v] = std::min(reach, kShareOfEdge * ways[v].shortest);
  constexpr int kMostTries = 6;
  for (int round = 0; round < kMostTries; ++round) {
    parting.distance = 0;
    for (const std::uint32_t v : shared) {
      Vec3 p = places[v] + step[v] * ways[v].way;
      if (as_floats) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      soup.points[v] = p;
      parting.distance = std::max(parting.distance, length(p - places[v]));
    }
    const SelfIntersections found = meeting_faces(piece, jobs);
    parting.left = found.crossing + found.touching;
    if (parting.left == 0) break;
    for (const MeetingFaces& pair : found.listed) {
      for (const FaceId f : {pair.a, pair.b}) {
        for (std::size_t i = 0; i < 3; ++i)
          step[soup.corners[3 * +f + i]] *= kLess;
      }
    }
  }
  parting.moved = shared.size();
  return parting;
}

}  // namespace fdcg::bake
