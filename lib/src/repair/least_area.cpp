// SPDX-License-Identifier: Apache-2.0
#include "repair/least_area.hpp"

#include <limits>
#include <utility>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {

std::vector<std::array<std::uint32_t, 3>> least_area_triangles(
    std::span<const Vec3> outline, const std::function<bool(std::uint32_t, std::uint32_t)>& is_barred) {
  const auto count = static_cast<std::uint32_t>(outline.size());
  if (count < 3 || count > kMostLeastAreaCorners) return {};
  constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Best {
    double cost = 0;
    std::uint32_t apex = 0;
  };
  std::vector<Best> table(std::size_t{count} * count);
  const auto best = [&](std::uint32_t i, std::uint32_t k) -> Best& { return table[std::size_t{i} * count + k]; };
  double whole = 0;  // more than any triangulation without a barred diagonal costs
  for (std::uint32_t i = 1; i + 1 < count; ++i) {
    for (std::uint32_t j = 0; j < count; ++j)
      whole += length(cross(outline[i] - outline[j], outline[i + 1] - outline[j]));
  }
  for (std::uint32_t span = 2; span < count; ++span) {
    for (std::uint32_t i = 0; i + span < count; ++i) {
      const std::uint32_t k = i + span;
      Best found{kNever, 0};
      for (std::uint32_t j = i + 1; j < k; ++j) {
        const double rest = best(i, j).cost + best(j, k).cost;
        if (!(rest < found.cost)) continue;
        const double cost = rest + length(cross(outline[j] - outline[i], outline[k] - outline[i]));
        if (cost < found.cost && !exact::collinear(outline[i], outline[j], outline[k])) found = {cost, j};
      }
      const bool is_diagonal = !(i == 0 && k == count - 1);
      if (is_diagonal && is_barred(i, k)) found.cost += whole;
      best(i, k) = found;
    }
  }
  if (!(best(0, count - 1).cost < kNever)) return {};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, count - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const std::uint32_t j = best(i, k).apex;
    triangles.push_back({i, j, k});
    open.emplace_back(i, j);
    open.emplace_back(j, k);
  }
  return triangles;
}

}  // namespace fdcg::bake
