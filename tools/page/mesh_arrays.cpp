// SPDX-License-Identifier: Apache-2.0
#include "mesh_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fdcg::page {
namespace {

struct Frame {
  bake::Vec3 centre{};
  double size = 1;
};

bool is_finite(const bake::Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Frame frame_of(const bake::PolygonSoup& soup) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  bake::Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (const bake::Vec3& p : soup.points) {
    if (!is_finite(p)) continue;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  if (!(low.x <= high.x)) return {};
  Frame frame;
  frame.centre = {low.x / 2 + high.x / 2, low.y / 2 + high.y / 2, low.z / 2 + high.z / 2};
  frame.size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!(frame.size > 0) || !std::isfinite(frame.size)) frame.size = 1;
  return frame;
}

template <class T>
PackedArray array_of(const std::vector<T>& records, std::uint32_t stride) {
  const auto bytes = std::as_bytes(std::span<const T>(records));
  const std::vector<Run> runs{{bytes.size(), stride}};
  return {described(bytes.size(), runs), packed(bytes, runs)};
}

// In units of the frame's size, so that a float holds them whatever the source's unit. NaN stays NaN.
std::vector<float> local_points(const bake::PolygonSoup& soup) {
  const Frame frame = frame_of(soup);
  std::vector<float> points;
  points.reserve(3 * soup.points.size());
  for (const bake::Vec3& p : soup.points) {
    for (const double x :
         {(p.x - frame.centre.x) / frame.size, (p.y - frame.centre.y) / frame.size, (p.z - frame.centre.z) / frame.size})
      points.push_back(is_finite(p) ? static_cast<float>(x) : std::numeric_limits<float>::quiet_NaN());
  }
  return points;
}

}  // namespace

nlohmann::ordered_json mesh_frame(const bake::PolygonSoup& soup) {
  const Frame frame = frame_of(soup);
  return {{"centre", {frame.centre.x, frame.centre.y, frame.centre.z}}, {"size", frame.size}};
}

std::vector<std::pair<std::string, PackedArray>> mesh_arrays(const bake::PolygonSoup& soup) {
  std::vector<std::pair<std::string, PackedArray>> arrays;
  arrays.emplace_back("points", array_of(local_points(soup), 12));
  const std::size_t faces = soup.face_count();
  std::vector<std::uint32_t> sizes(faces);
  for (std::size_t f = 0; f < faces; ++f)
    sizes[f] = soup.face_first[f + 1] - soup.face_first[f];
  const bool all_triangles = std::all_of(sizes.begin(), sizes.end(), [](std::uint32_t size) { return size == 3; });
  arrays.emplace_back("corners", array_of(soup.corners, all_triangles ? 12 : 4));
  if (!all_triangles) arrays.emplace_back("sizes", array_of(sizes, 4));
  if (!soup.face_line.empty()) arrays.emplace_back("face_lines", array_of(soup.face_line, 4));
  if (!soup.point_line.empty()) arrays.emplace_back("point_lines", array_of(soup.point_line, 4));
  if (!soup.face_material.empty()) {
    const std::vector<std::uint32_t> materials(soup.face_material.begin(), soup.face_material.end());
    arrays.emplace_back("face_materials", array_of(materials, 4));
  }
  return arrays;
}

PackedArray graph_array(std::span<const std::byte> file) {
  const std::vector<Run> runs = runs_of_graph(file);
  return {described(file.size(), runs), packed(file, runs)};
}

}  // namespace fdcg::page
