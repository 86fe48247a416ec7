// SPDX-License-Identifier: Apache-2.0
#include "import/scene_soup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/json/reader.hpp"

namespace fdcg::bake {
std::uint32_t SceneSoup::add_points(const PrintedPoints& source, const Matrix* world) {
  charge(points_, source.points.size());
  const auto first = static_cast<std::uint32_t>(soup_.points.size());
  std::array<double, 3> largest{};
  const std::size_t wanted = soup_.points.size() + source.points.size();
  if (wanted > soup_.points.capacity()) soup_.points.reserve(std::max(wanted, 2 * soup_.points.size()));
  for (const Vec3& p : source.points) {
    soup_.points.push_back(world != nullptr ? applied(*world, p) : p);
    const std::array<double, 3> size = {std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
    for (std::size_t k = 0; k < 3; ++k) {
      if (size[k] <= std::numeric_limits<double>::max()) largest[k] = std::max(largest[k], size[k]);
    }
  }
  const double extent = *std::max_element(largest.begin(), largest.end());
  const bool are_floats = source.precision.are_floats();
  if (are_floats && world == nullptr) has_floats_ = true;
  rounding_.note({are_floats ? 0x1p-24 : 0x1p-53, source.precision.half_step(extent)}, largest, world);
  return first;
}

void SceneSoup::begin_part(const std::string& name, std::string_view material, std::uint32_t first_point) {
  end_part();
  charge_node();
  set_material(material);
  soup_.parts.push_back({name, static_cast<std::uint32_t>(soup_.face_count()), first_point});
}

void SceneSoup::set_material(std::string_view material) {
  if (!materials_.begin(soup_, material)) ignore("materials beyond the 65,535th");
}

void SceneSoup::end_part() {
  if (!soup_.parts.empty() && soup_.parts.back().first_face == soup_.face_count()) soup_.parts.pop_back();
}

void SceneSoup::add_face(std::span<const std::uint32_t> corners, std::uint32_t first_point, std::size_t points,
                         bool is_mirrored) {
  charge(corners_, std::max<std::size_t>(corners.size(), 1));
  const auto numbered = [&](std::uint32_t corner) {
    return corner < points ? first_point + corner : PolygonSoup::kInvalidVertex;
  };
  if (!corners.empty()) soup_.corners.push_back(numbered(corners.front()));
  for (std::size_t k = 1; k < corners.size(); ++k)
    soup_.corners.push_back(numbered(corners[is_mirrored ? corners.size() - k : k]));
  soup_.face_first.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
}

void SceneSoup::ignore(const std::string& what, std::uint64_t count) {
  if (count > 0) ignored_[what] += count;
}

void SceneSoup::finish() {
  end_part();
  rounding_.finish(soup_);
  if (has_floats_ && soup_.relative_quantum == 0) soup_.relative_quantum = 0x1p-24;
  materials_.finish(soup_);
  for (const auto& [what, count] : ignored_)
    soup_.ignored.push_back({what, count});
}

void SceneSoup::charge(Budget& budget, std::uint64_t more) const {
  constexpr std::uint64_t kFree = 1024, kEachByte = 16;
  const std::uint64_t limit = kFree + kEachByte * bytes_ / budget.cost;
  if (more > limit - std::min(budget.used, limit)) {
    throw json::Refusal{"shows more than " + std::to_string(limit) + " " + budget.what +
                        ", the limit for a file of this size; export instances as meshes of their own"};
  }
  if (more > budget.most - budget.used)
    throw json::Refusal{"holds more than " + std::to_string(budget.most) + " " + budget.what + "; cut the mesh into parts"};
  budget.used += more;
}

}  // namespace fdcg::bake
