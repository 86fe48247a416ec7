// SPDX-License-Identifier: Apache-2.0
#include "loop_refined.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <vector>

namespace fdcg::test {
namespace {

using bake::Vec3;

Vec3 sum(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec3 times(const Vec3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}

struct Edge {
  std::uint32_t ends[2];
  std::uint32_t middle;  // of the points: the new one
  int faces = 0;
  Vec3 across{};  // sum of the corners across from it
};

}  // namespace

bake::PolygonSoup loop_refined(const bake::PolygonSoup& soup) {
  const auto count = static_cast<std::uint32_t>(soup.points.size());
  std::unordered_map<std::uint64_t, std::size_t> found;
  std::vector<Edge> edges;
  std::vector<std::array<std::size_t, 3>> edges_of;  // of each face: edge k goes from corner k
  for (std::size_t f = 0; f + 1 < soup.face_first.size(); ++f) {
    const std::uint32_t* const corner = &soup.corners[soup.face_first[f]];
    std::array<std::size_t, 3> sides{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
      const std::uint64_t key = a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
      const auto [at, is_new] = found.try_emplace(key, edges.size());
      if (is_new) edges.push_back({{a, b}, count + static_cast<std::uint32_t>(edges.size()), 0, {}});
      Edge& edge = edges[at->second];
      ++edge.faces;
      edge.across = sum(edge.across, soup.points[corner[(k + 2) % 3]]);
      sides[k] = at->second;
    }
    edges_of.push_back(sides);
  }
  std::vector<Vec3> around(count);
  std::vector<int> neighbours(count);
  std::vector<bool> stays(count);
  for (const Edge& edge : edges) {
    for (int end = 0; end < 2; ++end) {
      const std::uint32_t v = edge.ends[end];
      around[v] = sum(around[v], soup.points[edge.ends[1 - end]]);
      ++neighbours[v];
      if (edge.faces != 2) stays[v] = true;
    }
  }
  bake::PolygonSoup refined;
  refined.name = soup.name;
  for (std::uint32_t v = 0; v < count; ++v) {
    const int n = neighbours[v];
    const double turn = n == 0 ? 0 : 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n),
                 share = n == 0 ? 0 : (0.625 - turn * turn) / n;
    refined.points.push_back(n == 0 || stays[v] ? soup.points[v]
                                                : sum(times(soup.points[v], 1 - n * share), times(around[v], share)));
  }
  for (const Edge& edge : edges) {
    const Vec3 ends = sum(soup.points[edge.ends[0]], soup.points[edge.ends[1]]);
    refined.points.push_back(edge.faces != 2 ? times(ends, 0.5) : sum(times(ends, 0.375), times(edge.across, 0.125)));
  }
  refined.face_first = {0};
  for (std::size_t f = 0; f < edges_of.size(); ++f) {
    const std::uint32_t* const corner = &soup.corners[soup.face_first[f]];
    const std::array<std::uint32_t, 3> middle = {edges[edges_of[f][0]].middle, edges[edges_of[f][1]].middle,
                                                 edges[edges_of[f][2]].middle};
    for (std::size_t k = 0; k < 4; ++k) {
      if (k < 3) refined.corners.insert(refined.corners.end(), {corner[k], middle[k], middle[(k + 2) % 3]});
      if (k == 3) refined.corners.insert(refined.corners.end(), middle.begin(), middle.end());
      refined.face_first.push_back(static_cast<std::uint32_t>(refined.corners.size()));
    }
  }
  return refined;
}

}  // namespace fdcg::test
