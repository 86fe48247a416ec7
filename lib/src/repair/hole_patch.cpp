// SPDX-License-Identifier: Apache-2.0
#include "repair/hole_patch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "base/vec3.hpp"
#include "exact/outline.hpp"
#include "exact/polygon_cut.hpp"
#include "repair/fair_patch.hpp"
#include "repair/least_area.hpp"

namespace fdcg::bake {
namespace {

using HoleTriangles = std::vector<std::array<std::uint32_t, 3>>;

// Within a millionth of its size of the plane of its mean normal.
bool is_nearly_flat(std::span<const Vec3> outline) {
  Vec3 middle, normal, low = outline[0], high = outline[0];
  for (const Vec3& p : outline) {
    middle = middle + 1.0 / static_cast<double>(outline.size()) * p;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  for (std::size_t i = 0; i < outline.size(); ++i)
    normal = normal + cross(outline[i] - middle, outline[(i + 1) % outline.size()] - middle);
  const double area = length(normal);
  if (!(area > 0)) return false;
  constexpr double kFlat = 1e-6;
  const double most = kFlat * length(high - low);
  return std::all_of(outline.begin(), outline.end(),
                     [&](const Vec3& p) { return std::fabs(dot(normal, p - middle)) <= most * area; });
}

HoleTriangles flat_triangles(std::span<const Vec3> outline) {
  const std::optional<Projection> view = simple_view(outline);
  if (!view) return {};
  PolygonCutter cutter;
  const std::span<const Ear> ears = cutter.cut(*view, outline);
  return {ears.begin(), ears.end()};
}

// Cuts off the corner with the shortest diagonal, again and again. Any outline has such a triangulation.
HoleTriangles short_triangles(std::span<const Vec3> outline) {
  const auto count = static_cast<std::uint32_t>(outline.size());
  std::vector<std::uint32_t> next(count), before(count), version(count, 0);
  struct Cut {
    double length;
    std::uint32_t tip, version;
    bool operator<(const Cut& other) const { return std::tie(other.length, other.tip) < std::tie(length, tip); }
  };
  std::priority_queue<Cut> open;
  const auto offer = [&](std::uint32_t tip) {
    open.push({squared_length(outline[next[tip]] - outline[before[tip]]), tip, ++version[tip]});
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    next[i] = (i + 1) % count;
    before[i] = (i + count - 1) % count;
  }
  for (std::uint32_t i = 0; i < count; ++i)
    offer(i);
  HoleTriangles triangles;
  for (std::uint32_t left = count; left > 2;) {
    const Cut cut = open.top();
    open.pop();
    if (cut.version != version[cut.tip]) continue;
    const std::uint32_t a = before[cut.tip], b = next[cut.tip];
    triangles.push_back({a, cut.tip, b});
    ++version[cut.tip];
    next[a] = b;
    before[b] = a;
    if (--left <= 2) break;
    offer(a);
    offer(b);
  }
  return triangles;
}

// For each corner a point of the surface around the hole, as far away as its edges are long.
std::vector<Vec3> points_beyond(std::span<const Vec3> outline, std::span<const Vec3> normals) {
  const std::size_t count = outline.size();
  std::vector<Vec3> beyond(outline.begin(), outline.end());
  for (std::size_t i = 0; i < count; ++i) {  // the faces run against the outline, and lie to their left
    const Vec3 way = outline[i] - outline[(i + 1) % count], out = cross(normals[i], way);
    const double size = length(out);
    if (!(size > 0)) continue;
    const Vec3 half = 0.5 * length(way) / size * out;
    beyond[i] = beyond[i] + half;
    beyond[(i + 1) % count] = beyond[(i + 1) % count] + half;
  }
  return beyond;
}

}  // namespace

HolePatch patch_hole(std::span<const Vec3> outline, std::span<const Vec3> normals,
                     const std::function<bool(std::uint32_t, std::uint32_t)>& is_barred) {
  HolePatch patch;
  if (outline.size() == 3) {
    patch.is_flat = true;
    patch.triangles = {{0, 1, 2}};
    return patch;
  }
  if (is_nearly_flat(outline)) patch.triangles = flat_triangles(outline);
  patch.is_flat = !patch.triangles.empty();
  if (patch.is_flat) return patch;
  patch.triangles = least_area_triangles(outline, is_barred);
  if (patch.triangles.empty()) patch.triangles = short_triangles(outline);
  FairPatch fair = fair_patch(outline, points_beyond(outline, normals), std::move(patch.triangles));
  patch.points = std::move(fair.points);
  patch.triangles = std::move(fair.triangles);
  return patch;
}

}  // namespace fdcg::bake
