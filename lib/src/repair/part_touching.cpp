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

// Points at whose coordinates there is another one, and those from `first_made` on.
std::vector<std::uint32_t> shared_places(const PolygonSoup& soup, std::uint32_t first_made) {
  std::vector<std::uint32_t> order(soup.points.size()), shared;
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) { return std::tie(soup.points[v].x, soup.points[v].y, soup.points[v].z); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool as_before = i > 0 && key(order[i]) == key(order[i - 1]);
    const bool as_after = i + 1 < order.size() && key(order[i]) == key(order[i + 1]);
    if (as_before || as_after || order[i] >= first_made) shared.push_back(order[i]);
  }
  std::sort(shared.begin(), shared.end());
  return shared;
}

// Of the faces at one vertex: where the vertex may go to leave the others at its place.
class TouchingFans {
 public:
  TouchingFans(const PolygonSoup& soup, const std::vector<std::uint32_t>& shared) : soup_(soup), fan_(soup.points.size()) {
    for (const std::uint32_t v : shared)
      fan_[v].is_shared = true;
    for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (fan_[soup.corners[3 * f + i]].is_shared) add(f, i);
      }
    }
    const auto key = [&](std::uint32_t v) { return std::tie(soup.points[v].x, soup.points[v].y, soup.points[v].z); };
    std::vector<std::uint32_t> order = shared;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
      while (end < order.size() && key(order[end]) == key(order[first]))
        ++end;
      for (std::size_t i = first; i < end; ++i)
        fan_[order[i]].way = way_of(
            order[i], {order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(end)});
    }
  }

  // A way to try, the likeliest first; of length 1, or 0 where there is none. They repeat.
  [[nodiscard]] Vec3 way(std::uint32_t v, int attempt) const {
    const Fan& fan = fan_[v];
    if (attempt % kWays == 0) return fan.way;
    if (attempt % kWays == 2) return -fan.way;
    Vec3 sum;
    for (const Sector& sector : fan.sectors)
      sum = sum + sector.a + sector.b;
    const double size = length(sum);
    return size > 0 ? 1 / size * sum : Vec3{};
  }
  static constexpr int kWays = 3;
  // The least distance of the vertex from the sides across in its faces.
  [[nodiscard]] double room(std::uint32_t v) const { return fan_[v].room; }

 private:
  struct Sector {  // a face at the vertex, as two directions of length 1
    Vec3 a, b;
  };
  struct Fan {
    bool is_shared = false;
    std::vector<Sector> sectors;
    Vec3 normal, way;
    double room = 1e300;
  };

  void add(std::uint32_t f, std::uint32_t i) {
    const std::uint32_t* const c = &soup_.corners[3 * f];
    const Vec3 a = soup_.points[c[(i + 1) % 3]] - soup_.points[c[i]], b = soup_.points[c[(i + 2) % 3]] - soup_.points[c[i]];
    const Vec3 normal = cross(a, b);
    const double size = length(normal), across = length(b - a);
    Fan& fan = fan_[c[i]];
    if (!(size > 0)) return;
    fan.room = std::min({fan.room, size / across, length(a), length(b)});
    fan.normal = fan.normal + std::atan2(size, dot(a, b)) / size * normal;
    fan.sectors.push_back({1 / length(a) * a, 1 / length(b) * b});
  }

  // Away from the others: into the solid behind the fan where they are in front of it, into the air before it where they are
  // behind; none where they are on both sides, which then have to leave it.
  [[nodiscard]] Vec3 way_of(std::uint32_t v, const std::vector<std::uint32_t>& group) const {
    const Fan& fan = fan_[v];
    const double size = length(fan.normal);
    constexpr double kFlat = 1e-6;
    if (fan.sectors.empty() || !(size > kFlat)) return {};
    if (group.size() == 1) return -1 / size * fan.normal;  // the middle of an edge where solids touch
    bool has_front = false, has_back = false;
    for (const std::uint32_t other : group) {
      if (other == v || fan_[other].sectors.empty()) continue;
      const Sector& sector = fan_[other].sectors[fan_[other].sectors.size() / 2];
      (is_behind(fan, sector.a + sector.b) ? has_back : has_front) = true;
    }
    if (has_front == has_back) return {};
    return (has_front ? -1 : 1) / size * fan.normal;
  }

  // Whether a direction leads into the solid: by the sectors that the way to a place just in front of one of them passes.
  static bool is_behind(const Fan& fan, const Vec3& to) {
    const Sector& first = fan.sectors[fan.sectors.size() / 3];
    const Vec3 normal = cross(first.a, first.b);
    const Vec3 front = 0.5 * (first.a + first.b) + 1e-3 / length(normal) * normal;
    bool is_behind = false;
    for (const Sector& sector : fan.sectors) {
      const Vec3 m = cross(sector.a, sector.b);
      if ((dot(m, front) > 0) == (dot(m, to) > 0)) continue;
      const Vec3 at = std::fabs(dot(m, to)) * front + std::fabs(dot(m, front)) * to;  // where the way passes the plane
      if (dot(cross(sector.a, at), m) > 0 && dot(cross(at, sector.b), m) > 0) is_behind = !is_behind;
    }
    return is_behind;
  }

  const PolygonSoup& soup_;
  std::vector<Fan> fan_;
};

SelfIntersections meeting_faces(const Workpiece& piece, unsigned jobs) {
  const View view(piece);
  const FaceGeometry geometry(view.mesh, view.states, jobs);
  SelfIntersectionOptions how;
  how.max_listed = kAllElements;
  how.jobs = jobs;
  return find_self_intersections(view.mesh, geometry, how);
}

}  // namespace

Parting part_touching(Workpiece& piece, std::uint32_t first_made, double reach, bool as_floats, unsigned jobs) {
  Parting parting;
  cut_polygons(piece);
  PolygonSoup& soup = piece.soup;
  const std::vector<std::uint32_t> shared = shared_places(soup, first_made);
  if (shared.empty()) return parting;
  const std::vector<Vec3> places = soup.points;
  const TouchingFans fans(soup, shared);
  constexpr double kShareOfRoom = 1.0 / 8, kLess = 1.0 / 8;
  constexpr int kSizes = 3;  // of each way
  std::vector<int> tried(soup.points.size(), 0);
  for (int round = 0; round < kSizes * TouchingFans::kWays; ++round) {
    parting.distance = 0;
    for (const std::uint32_t v : shared) {
      const double step = std::min(reach, kShareOfRoom * fans.room(v)) * std::pow(kLess, tried[v] % kSizes);
      Vec3 p = places[v] + step * fans.way(v, tried[v] / kSizes);
      if (as_floats) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      soup.points[v] = p;
      parting.distance = std::max(parting.distance, length(p - places[v]));
    }
    const SelfIntersections found = meeting_faces(piece, jobs);
    parting.left = found.crossing + found.touching;
    if (parting.left == 0) break;
    std::vector<bool> is_met(soup.points.size(), false);
    for (const MeetingFaces& pair : found.listed) {
      for (const FaceId f : {pair.a, pair.b}) {
        for (std::size_t i = 0; i < 3; ++i)
          is_met[soup.corners[3 * +f + i]] = true;
      }
    }
    for (std::size_t v = 0; v < is_met.size(); ++v)
      tried[v] += is_met[v];
  }
  parting.moved = shared.size();
  return parting;
}

}  // namespace fdcg::bake
