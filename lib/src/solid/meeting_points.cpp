// SPDX-License-Identifier: Apache-2.0
#include "solid/meeting_points.hpp"

#include <algorithm>
#include <utility>

namespace fdcg::bake {
namespace {

// Not numbers of points: which kind of point a key is for.
constexpr std::uint32_t kEdgeAndPlane = 0xFFFFFFFFu, kPlanes = 0xFFFFFFFEu;

PointEdge side_of(const Triangle3& t, TrianglePart side) {
  const std::size_t i = side - kFirstSide;
  return {t[i], t[(i + 1) % 3]};
}

PointEdge in_order(PointEdge e) {
  return {std::min(e[0], e[1]), std::max(e[0], e[1])};
}

}  // namespace

std::size_t MeetingPoints::Hash::operator()(const Key& key) const {
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (const std::uint32_t k : key) {
    h = (h ^ k) * 0xD6E8FEB86659FD93u;
    h ^= h >> 32;
  }
  return h;
}

PointId MeetingPoints::at(std::uint32_t a, std::uint32_t b, const MeetingPoint& end) {
  const Triangle3 &s = triangles_[a], &t = triangles_[b];
  if (end.in_a < kFirstSide) return s[end.in_a];
  if (end.in_b < kFirstSide) return t[end.in_b];
  if (end.in_a == kInterior) return of_edge_and_plane(side_of(t, end.in_b), a);
  if (end.in_b == kInterior) return of_edge_and_plane(side_of(s, end.in_a), b);
  // Two sides that cross in their interiors: seen along some axis the ends of each lie on either side of the other.
  const PointEdge p = side_of(s, end.in_a), q = side_of(t, end.in_b);
  for (int axis = 0; axis < 3; ++axis) {
    const int first = points_.orient2d(p[0], p[1], q[0], axis);
    if (first != 0 && first != points_.orient2d(p[0], p[1], q[1], axis)) return of_edges(p, q, axis);
  }
  return of_edge_and_plane(p, b);
}

PointId MeetingPoints::crossing(std::uint32_t triangle, const SupportLine& a, const SupportLine& b, int axis) {
  if (a.is_edge() && b.is_edge()) return of_edges(a.edge, b.edge, axis);
  if (a.is_edge()) return of_edge_and_plane(a.edge, b.triangle);
  if (b.is_edge()) return of_edge_and_plane(b.edge, a.triangle);
  return of_planes({triangle, a.triangle, b.triangle});
}

PointId MeetingPoints::of_edge_and_plane(PointEdge edge, std::uint32_t triangle) {
  edge = in_order(edge);
  const auto [place, is_new] = made_.try_emplace(Key{edge[0], edge[1], triangle, kEdgeAndPlane});
  if (is_new) place->second = points_.on_plane(edge, triangles_[triangle]);
  return place->second;
}

PointId MeetingPoints::of_edges(PointEdge a, PointEdge b, int axis) {
  a = in_order(a);
  b = in_order(b);
  if (b < a) std::swap(a, b);
  const auto [place, is_new] = made_.try_emplace(Key{a[0], a[1], b[0], b[1]});
  if (is_new) place->second = points_.on_lines(a, b, axis);
  return place->second;
}

PointId MeetingPoints::of_planes(std::array<std::uint32_t, 3> triangles) {
  std::sort(triangles.begin(), triangles.end());
  const auto [place, is_new] = made_.try_emplace(Key{triangles[0], triangles[1], triangles[2], kPlanes});
  if (is_new) place->second = points_.on_planes(triangles_[triangles[0]], triangles_[triangles[1]], triangles_[triangles[2]]);
  return place->second;
}

}  // namespace fdcg::bake
