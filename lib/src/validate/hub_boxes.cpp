// SPDX-License-Identifier: Apache-2.0
#include "validate/hub_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

// Far above the rounding error of a direction, far below the differences between directions that matter.
constexpr double kSlack = 0x1p-40;

Vec3 scaled(const Vec3& v) {
  const double size = largest_component(v);
  return size > 0x1p-1000 ? 1 / size * v : 0x1p1000 * v;
}
Vec3 unit(const Vec3& v) {
  const Vec3 s = scaled(v);
  return 1 / length(s) * s;
}

// A box around two points of the unit sphere.
struct HubPatch {
  Vec3 low, high;
  HubPatch(const Vec3& a, const Vec3& b, double slack)
      : low{std::min(a.x, b.x) - slack, std::min(a.y, b.y) - slack, std::min(a.z, b.z) - slack},
        high{std::max(a.x, b.x) + slack, std::max(a.y, b.y) + slack, std::max(a.z, b.z) + slack} {}
};

RawArray<CellBox> cells_of(const std::vector<HubPatch>& patches) {
  std::vector<Vec3> ends;
  for (const HubPatch& patch : patches) {
    ends.push_back(patch.low);
    ends.push_back(patch.high);
  }
  const CellGrid grid(ends, 1);
  RawArray<CellBox> boxes(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    boxes[i] = CellBox::around(grid.cell(patches[i].low));
    boxes[i].add(CellBox::around(grid.cell(patches[i].high)));
  }
  return boxes;
}

}  // namespace

RawArray<CellBox> boxes_around(const Vec3* hub, const std::vector<ContactTriangle>& triangles) {
  std::vector<HubPatch> patches;
  for (const ContactTriangle& t : triangles) {
    const auto at = static_cast<std::size_t>(std::find(t.corner.begin(), t.corner.end(), hub) - t.corner.begin());
    const Vec3 p = unit(*t.corner[(at + 1) % 3] - *hub), q = unit(*t.corner[(at + 2) % 3] - *hub);
    // Sagitta: the distance of the arc between the two from its chord.
    const double bulge = 1 - 0.5 * length(p + q);
    patches.emplace_back(p, q, bulge + kSlack);
  }
  return cells_of(patches);
}

RawArray<CellBox> boxes_around(const Vec3* from, const Vec3* to, const std::vector<ContactTriangle>& triangles) {
  const Vec3 e = unit(*to - *from);
  std::vector<HubPatch> patches;
  for (const ContactTriangle& t : triangles) {
    const Vec3* const third = *std::find_if(t.corner.begin(), t.corner.end(), [&](auto p) { return p != from && p != to; });
    const Vec3 normal = cross(e, unit(*third - *from));
    const double sine = length(normal);  // small where the triangle is thin, and its normal then uncertain
    const bool is_certain = sine > kSlack;
    const Vec3 n = is_certain ? 1 / sine * normal : Vec3{};
    patches.emplace_back(n, n, is_certain ? kSlack / sine : 1);
  }
  return cells_of(patches);
}

}  // namespace fdcg::bake
