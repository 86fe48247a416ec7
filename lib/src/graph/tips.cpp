// SPDX-License-Identifier: Apache-2.0
#include "graph/tips.hpp"

#include "fdcg/format.h"

namespace fdcg::bake {
namespace {

std::uint32_t previous_in_triangle(std::uint32_t slot) {
  return slot % 3 == 0 ? slot + 2 : slot - 1;
}
std::uint32_t next_in_triangle(std::uint32_t slot) {
  return slot % 3 == 2 ? slot - 2 : slot + 1;
}

// Around the vertex at which `start` starts, counter-clockwise, from the border where there is one.
std::uint32_t planes_around(const Topology& topology, const Regions& regions, std::uint32_t start) {
  std::uint32_t first = start;
  while (topology.twin[first] != Topology::kBoundary) {
    first = next_in_triangle(+topology.twin[first]);
    if (first == start) break;
  }
  const auto region_of = [&](std::uint32_t slot) { return regions.of(FaceId{slot / 3}); };
  std::uint32_t planes = 0, slot = first, last = first;
  while (true) {
    const bool goes_on = slot != first && region_of(slot) != kNone && region_of(slot) == region_of(last);
    planes += goes_on ? 0 : 1;
    last = slot;
    const HalfedgeId twin = topology.twin[previous_in_triangle(slot)];
    if (twin == Topology::kBoundary) return planes;
    slot = +twin;
    if (slot == first) break;
  }
  const bool closes = planes > 1 && region_of(last) != kNone && region_of(last) == region_of(first);
  return planes - (closes ? 1 : 0);
}

}  // namespace

bool mark_tips(const Mesh& mesh, const Topology& topology, const Regions& regions, std::uint32_t most_planes,
               std::vector<bool>& is_tip) {
  std::vector<std::uint32_t> faces_at(mesh.points.size(), 0);
  for (const VertexId v : mesh.corners)
    ++faces_at[+v];
  bool is_new = false;
  for (std::uint32_t slot = 0; slot < mesh.corners.size(); ++slot) {
    const std::uint32_t v = +mesh.corners[slot];
    if (faces_at[v] <= FDCG_BUSY_FAN) continue;
    faces_at[v] = 0;  // asked once
    if (is_tip[v] || planes_around(topology, regions, slot) <= most_planes) continue;
    is_tip[v] = is_new = true;
  }
  return is_new;
}

}  // namespace fdcg::bake
