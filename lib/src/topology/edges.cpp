// SPDX-License-Identifier: Apache-2.0
#include "topology/edges.hpp"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"

namespace fdcg::bake {
namespace {

// The number of corners of a vertex in sound faces, and the first of them.
struct Star {
  std::uint32_t corners = 0;
  std::uint32_t first = kNone;
};

// The number of corners of the fan around corner `start`, followed across pairs of opposite half-edges; 0 if it meets an odd
// edge.
std::uint32_t walk_fan(const Mesh& mesh, const Topology& topology, HalfedgeId start) {
  std::uint32_t count = 1;
  HalfedgeId h = start;
  for (;;) {  // counter-clockwise: across the half-edge that comes in
    h = topology.twin[+previous(mesh, topology.face(h), h)];
    if (h == start) return count;
    if (!is_halfedge(h)) break;
    ++count;
  }
  if (h != Topology::kBoundary) return 0;
  h = start;
  for (;;) {  // clockwise: across the half-edge that goes out
    h = topology.twin[+h];
    if (!is_halfedge(h)) return h == Topology::kBoundary ? count : 0;
    h = next(mesh, topology.face(h), h);
    ++count;
  }
}

// Numbers the fans of one vertex, given the vertices at the far ends of its corners' two edges: corners that share one are
// joined. `ends` holds (far vertex, corner number); `corners` are those of the vertex.
void number_fans(std::vector<std::pair<VertexId, std::uint32_t>>& ends, FanCorner* corners) {
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint32_t> parent(ends.size() / 2);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto find = [&](std::uint32_t i) {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i].first != ends[i - 1].first) continue;
    const std::uint32_t a = find(ends[i].second), b = find(ends[i - 1].second);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::uint32_t fans = 0;
  for (std::uint32_t i = 0; i < parent.size(); ++i)  // the first corner of a fan is its root
    corners[i].fan = find(i) == i ? fans++ : corners[find(i)].fan;
}

}  // namespace

std::vector<OddEdge> odd_edges(const Mesh& mesh, const Topology& topology, unsigned jobs) {
  struct Entry {
    std::uint32_t low, high, slot;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;  // in no particular order at first
  std::mutex lock;
  constexpr std::size_t kAtOnce = 65'536;
  parallel_for(jobs, topology.twin.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Entry> found;
    for (auto h = static_cast<std::uint32_t>(begin); h < end; ++h) {
      if (topology.twin[h] != Topology::kSameWay && topology.twin[h] != Topology::kNonManifold) continue;
      const std::uint32_t u = +mesh.corners[h];
      const std::uint32_t v = +mesh.corners[+next(mesh, topology.face(HalfedgeId{h}), HalfedgeId{h})];
      found.push_back({std::min(u, v), std::max(u, v), h});
    }
    const std::scoped_lock guard(lock);
    entries.insert(entries.end(), found.begin(), found.end());
  });
  std::sort(entries.begin(), entries.end());
  std::vector<OddEdge> edges;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i == 0 || entries[i].low != entries[i - 1].low || entries[i].high != entries[i - 1].high) edges.emplace_back();
    edges.back().halfedges.push_back(HalfedgeId{entries[i].slot});
  }
  std::sort(edges.begin(), edges.end(), [](const OddEdge& a, const OddEdge& b) { return a.halfedges[0] < b.halfedges[0]; });
  return edges;
}

std::vector<VertexId> vertices_of_several_fans(const Mesh& mesh, const Topology& topology,
                                               const std::vector<FaceState>& states) {
  std::vector<Star> stars(mesh.points.size());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (states[f] != FaceState::sound) continue;
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      Star& star = stars[+mesh.corners[h]];
      if (star.corners++ == 0) star.first = h;
    }
  }
  std::vector<VertexId> several;
  std::vector<VertexId> odd;
  for (std::uint32_t v = 0; v < stars.size(); ++v) {
    if (stars[v].corners < 2) continue;
    const std::uint32_t walked = walk_fan(mesh, topology, HalfedgeId{stars[v].first});
    if (walked == 0) {
      odd.push_back(VertexId{v});
    } else if (walked < stars[v].corners) {
      several.push_back(VertexId{v});
    }
  }
  if (!odd.empty()) {
    for (const FanCorner& corner : fans_at(mesh, states, odd)) {
      if (corner.fan > 0 && (several.empty() || several.back() != corner.vertex)) several.push_back(corner.vertex);
    }
    std::sort(several.begin(), several.end());
  }
  return several;
}

std::vector<FanCorner> fans_at(const Mesh& mesh, const std::vector<FaceState>& states, const std::vector<VertexId>& vertices) {
  std::vector<bool> is_asked(mesh.points.size(), false);
  for (const VertexId v : vertices)
    is_asked[+v] = true;
  std::vector<FanCorner> corners;
  std::vector<FaceId> faces;  // of each, before they are sorted
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (states[f] != FaceState::sound) continue;
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      if (!is_asked[+mesh.corners[h]]) continue;
      corners.push_back({mesh.corners[h], HalfedgeId{h}, static_cast<std::uint32_t>(faces.size())});
      faces.push_back(FaceId{f});
    }
  }
  std::sort(corners.begin(), corners.end(),
            [](const FanCorner& a, const FanCorner& b) { return std::tie(a.vertex, a.slot) < std::tie(b.vertex, b.slot); });
  std::vector<std::pair<VertexId, std::uint32_t>> ends;
  for (std::size_t i = 0; i < corners.size();) {
    const std::size_t begin = i;
    ends.clear();
    for (; i < corners.size() && corners[i].vertex == corners[begin].vertex; ++i) {
      const FaceId f = faces[corners[i].fan];
      const auto corner = static_cast<std::uint32_t>(i - begin);
      ends.emplace_back(mesh.corners[+next(mesh, f, corners[i].slot)], corner);
      ends.emplace_back(mesh.corners[+previous(mesh, f, corners[i].slot)], corner);
    }
    number_fans(ends, corners.data() + begin);
  }
  return corners;
}

}  // namespace fdcg::bake
