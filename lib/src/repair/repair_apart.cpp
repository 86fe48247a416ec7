// SPDX-License-Identifier: Apache-2.0
// Moves vertices at equal coordinates apart, for files that know vertices by their coordinates alone (STL).
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "base/vec3.hpp"
#include "repair/repair.hpp"

namespace fdcg::bake {
namespace {

struct IsBefore {
  bool operator()(const Vec3& a, const Vec3& b) const { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
};

double next_towards(double x, double direction, bool as_float) {
  const double end = direction > 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  if (as_float) return std::nextafterf(static_cast<float>(x), static_cast<float>(end));
  return std::nextafter(x, end);
}

// The sum of the ways to the neighbours of each point in its faces: into its fan.
std::vector<Vec3> inward_directions(const PolygonSoup& soup) {
  std::vector<Vec3> direction(soup.points.size());
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], count = soup.face_first[f + 1] - first;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t p = soup.corners[first + i], q = soup.corners[first + (i + 1) % count];
      if (p >= soup.points.size() || q >= soup.points.size()) continue;
      direction[p] = direction[p] + (soup.points[q] - soup.points[p]);
      direction[q] = direction[q] + (soup.points[p] - soup.points[q]);
    }
  }
  return direction;
}

}  // namespace

RepairAction part_equal_points_step(Workpiece& piece) {
  PolygonSoup& soup = piece.soup;
  const std::vector<Vec3> direction = inward_directions(soup);
  std::set<Vec3, IsBefore> taken;
  std::vector<std::uint32_t> again;
  for (std::uint32_t v = 0; v < soup.points.size(); ++v) {
    soup.points[v] = soup.points[v] + Vec3{};  // -0 and 0 are one place
    if (!taken.insert(soup.points[v]).second) again.push_back(v);
  }
  Tally tally;
  for (const std::uint32_t v : again) {
    Vec3& p = soup.points[v];
    do {
      const Vec3& way = direction[v];
      const int axis = dominant_axis(way);
      double& moved = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      moved = next_towards(moved, component(way, axis), piece.has_floats);
    } while (!taken.insert(p).second);
    tally.done.push_back(piece.source_point[v]);
  }
  return action_of(piece, "part-equal-vertices", Kind::vertices,
                   counted(tally.done.size(), "vertex was", "vertices were") +
                       " moved by the least step of its numbers, since the format knows vertices by their coordinates",
                   tally);
}

}  // namespace fdcg::bake
