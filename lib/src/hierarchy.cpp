// SPDX-License-Identifier: Apache-2.0
#include "hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.hpp"
#include "vec.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kGrain = 1u << 12;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float round_down(double x) {
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -kInfinity) : f;
}

float round_up(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafter(f, kInfinity) : f;
}

fdcg_box leaf_box(const Graph& graph, std::uint32_t begin, std::uint32_t end, double max_deviation) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 low{kFar, kFar, kFar}, high = -low;
  for (std::uint32_t n = begin; n < end; ++n) {
    const std::uint32_t region = graph.region_of(n);
    const double margin = region == kNone || graph.regions[region].is_exact ? 0 : max_deviation;
    for (std::uint32_t side = graph.first_side[n]; side < graph.first_side[n + 1]; ++side) {
      const Vec3& p = graph.points[graph.corner[side]];
      low = {std::min(low.x, p.x - margin), std::min(low.y, p.y - margin), std::min(low.z, p.z - margin)};
      high = {std::max(high.x, p.x + margin), std::max(high.y, p.y + margin), std::max(high.z, p.z + margin)};
    }
  }
  return {{round_down(low.x), round_down(low.y), round_down(low.z)}, {round_up(high.x), round_up(high.y), round_up(high.z)}};
}

fdcg_box join(const fdcg_box& a, const fdcg_box& b) {
  fdcg_box box;
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(a.min[k], b.min[k]);
    box.max[k] = std::max(a.max[k], b.max[k]);
  }
  return box;
}

}  // namespace

std::vector<std::uint32_t> hierarchy_levels(std::uint32_t node_count) {
  std::vector<std::uint32_t> levels{(node_count + FDCG_LEAF_NODES - 1) / FDCG_LEAF_NODES};
  while (levels.back() > 1)
    levels.push_back((levels.back() + 1) / 2);
  std::reverse(levels.begin(), levels.end());
  return levels;
}

void build_hierarchy(const Graph& graph, double max_deviation, std::span<fdcg_box> boxes, unsigned jobs) {
  const std::vector<std::uint32_t> levels = hierarchy_levels(graph.node_count());
  std::span<fdcg_box> below = boxes.last(levels.back());
  parallel_for(jobs, below.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      const std::uint32_t first = i * FDCG_LEAF_NODES;
      below[i] = leaf_box(graph, first, std::min(first + FDCG_LEAF_NODES, graph.node_count()), max_deviation);
    }
  });
  for (std::size_t level = levels.size() - 1; level-- > 0;) {
    boxes = boxes.first(boxes.size() - below.size());
    const std::span<fdcg_box> here = boxes.last(levels[level]);
    for (std::size_t i = 0; i < here.size(); ++i)
      here[i] = 2 * i + 1 < below.size() ? join(below[2 * i], below[2 * i + 1]) : below[2 * i];
    below = here;
  }
}

}  // namespace fdcg::bake
