// SPDX-License-Identifier: Apache-2.0
#include "graph/graph.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "base/hilbert.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "base/raw_array.hpp"
#include "base/release.hpp"
#include "base/vec3.hpp"
#include "exact/projection.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kRankGrain = 1u << 13;

struct Ranked {
  std::uint64_t key;
  std::uint32_t face;
};

// Twice the centre of the bounding box: cheap, and sorts as well as the centroid.
Vec3 doubled_centre(const Mesh& mesh, std::uint32_t f) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
  for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
    const Vec3& p = mesh.points[+mesh.corners[h]];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return low + high;
}

std::pair<Vec3, Vec3> bounds_of(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {low, high};
}

// Bits an axis: cells small enough that a surface of so many faces has some four cells for each.
unsigned curve_bits(std::uint32_t faces) {
  constexpr unsigned kLeast = 5, kMost = 16;
  return std::clamp(static_cast<unsigned>(std::bit_width(faces)) / 2 + 1, kLeast, kMost);
}

RawArray<Ranked> positions_along_curve(const Mesh& mesh, unsigned bits, unsigned jobs) {
  const auto [low, high] = bounds_of(mesh.points);
  const double size = largest_component(high - low);
  const double cells = 1u << bits;
  const double cells_per_unit = size > 0 ? 0.5 * cells / size : 0;
  const auto cell = [&](double doubled, double from) {
    return static_cast<std::uint32_t>(std::clamp((doubled - 2 * from) * cells_per_unit, 0.0, cells - 1));
  };
  RawArray<Ranked> ranked(mesh.face_count());
  parallel_for(jobs, ranked.size(), kRankGrain, [&, from = low](std::size_t begin, std::size_t end) {
    for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) {
      const Vec3 c = doubled_centre(mesh, f);
      ranked[f] = {hilbert_position({cell(c.x, from.x), cell(c.y, from.y), cell(c.z, from.z)}, bits), f};
    }
  });
  return ranked;
}

// The first corner of a polygon: the one whose triangle with the two next corners is the largest in the projection of the
// region, and exactly non-degenerate.
std::uint32_t best_start(const Mesh& mesh, std::uint32_t f, const Vec3& normal) {
  const std::uint32_t first = mesh.face_first[f], count = mesh.face_first[f + 1] - first;
  const Projection view(normal);
  const auto point = [&](std::uint32_t i) -> const Vec3& { return mesh.points[+mesh.corners[first + i % count]]; };
  std::uint32_t best = 0;
  double best_area = -1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 &a = point(i), &b = point(i + 1), &c = point(i + 2);
    const double area = dot(normal, cross(b - a, c - a));
    if (area > best_area && view.orient(a, b, c) > 0) {
      best = i;
      best_area = area;
    }
  }
  return best;
}

// Builds the graph from the mesh.
class Orderer {
 public:
  Orderer(Mesh& mesh, Topology& topology, std::vector<EdgeClass>& edges, Regions& regions, unsigned jobs, bool names_vertices)
      : mesh_(mesh), topology_(topology), edges_(edges), regions_(regions), jobs_(jobs), names_vertices_(names_vertices) {}

  Graph run() {
    {
      const unsigned bits = curve_bits(mesh_.face_count());
      RawArray<Ranked> ranked = positions_along_curve(mesh_, bits, jobs_);
      radix_sort(ranked, 3 * bits, jobs_, [](const Ranked& item) { return item.key; });
      std::vector<std::uint32_t> faces(ranked.size());
      std::transform(ranked.begin(), ranked.end(), faces.begin(), [](const Ranked& item) { return item.face; });
      ranked = {};
      graph_.fan_runs = gather_fans(mesh_, topology_, faces);
      place_nodes(faces);
    }
    copy_sides();
    parallel_for(jobs_, 2, 1, [&](std::size_t task, std::size_t) { task == 0 ? name_corners() : name_connections(); });
    return std::move(graph_);
  }

 private:
  void place_nodes(const std::vector<std::uint32_t>& faces) {
    graph_.first_side.resize(faces.size() + 1);
    graph_.node_of_face.resize(faces.size());
    side_of_slot_.resize(mesh_.corners.size());
    std::uint32_t sum = 0;
    for (std::size_t n = 0; n < faces.size(); ++n) {
      graph_.first_side[n] = sum;
      sum += mesh_.face_first[faces[n] + 1] - mesh_.face_first[faces[n]];
    }
    graph_.first_side[faces.size()] = sum;
    const bool all_triangles = topology_.face_of.empty();
    if (!all_triangles) graph_.node_of_side.resize(mesh_.corners.size());
    if (!regions_.list.empty()) graph_.region.resize(faces.size());
    graph_.regions = std::move(regions_.list);
    parallel_for(jobs_, faces.size(), kRankGrain, [&](std::size_t begin, std::size_t end) {
      for (auto n = static_cast<std::uint32_t>(begin); n < end; ++n) {
        const std::uint32_t f = faces[n], first = mesh_.face_first[f], count = mesh_.face_first[f + 1] - first;
        graph_.node_of_face[f] = n;
        if (!graph_.region.empty()) graph_.region[n] = regions_.of_face[f];
        const std::uint32_t start = count == 3 ? 0 : best_start(mesh_, f, graph_.regions[graph_.region[n]].plane.normal);
        for (std::uint32_t i = 0; i < count; ++i) {
          const std::uint32_t side = graph_.first_side[n] + (i + count - start) % count;
          side_of_slot_[first + i] = side;
          if (!all_triangles) graph_.node_of_side[side] = n;
        }
      }
    });
  }

  template <class Value, class OfSlot>
  void copy_to_sides(std::vector<Value>& of_side, const OfSlot& of_slot) {
    of_side.resize(side_of_slot_.size());
    parallel_for(jobs_, side_of_slot_.size(), kRankGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot)
        of_side[side_of_slot_[slot]] = of_slot(slot);
    });
  }

  // One array after the other, each freed at once: together they would be the most that a compilation holds.
  void copy_sides() {
    release(topology_.face_of);
    release(mesh_.face_first);
    regions_ = {};
    copy_to_sides(graph_.twin, [&](std::size_t slot) {
      const HalfedgeId twin = topology_.twin[slot];
      return twin == Topology::kBoundary ? kNone : side_of_slot_[+twin];
    });
    topology_ = {};
    copy_to_sides(graph_.corner, [&](std::size_t slot) { return +mesh_.corners[slot]; });
    release(mesh_.corners);
    copy_to_sides(graph_.edges, [&](std::size_t slot) { return edges_[slot]; });
    release(edges_);
    release(side_of_slot_);
  }

  // By first use; a boundary side always starts its corner's fan.
  void name_corners() {
    std::vector<std::uint32_t> corner_of(mesh_.points.size(), kNone);
    std::vector<std::uint32_t>& fan = graph_.first_fan;
    graph_.points.reserve(mesh_.points.size());
    graph_.fan_start.reserve(mesh_.points.size());
    fan.reserve(mesh_.points.size() + 1);
    for (std::uint32_t side = 0; side < graph_.side_count(); ++side) {
      const std::uint32_t vertex = graph_.corner[side];
      std::uint32_t& corner = corner_of[vertex];
      if (corner == kNone) {
        corner = static_cast<std::uint32_t>(graph_.points.size());
        graph_.points.push_back(mesh_.points[vertex]);
        graph_.fan_start.push_back(side);
        fan.push_back(0);
      }
      graph_.corner[side] = corner;
      ++fan[corner];
      if (graph_.twin[side] == kNone) {
        graph_.fan_start[corner] = side;
        ++fan[corner];  // the boundary connection that closes an open fan is no side that leaves the corner
      }
    }
    for (FanRun& run : graph_.fan_runs)
      run.vertex = corner_of[run.vertex];
    if (names_vertices_) graph_.corner_of_vertex = std::move(corner_of);
    release(mesh_.points);
    fan.push_back(0);
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : fan) {
      graph_.largest_fan = std::max(graph_.largest_fan, entry);
      sum += std::exchange(entry, sum);
    }
  }

  void name_connections() {
    graph_.connection.resize(graph_.side_count());
    for (std::uint32_t side = 0; side < graph_.side_count(); ++side) {
      const std::uint32_t twin = graph_.twin[side];
      graph_.connection[side] = twin < side ? graph_.connection[twin] | 1u : graph_.connection_count++ << 1;
    }
  }

  Mesh& mesh_;
  Topology& topology_;
  std::vector<EdgeClass>& edges_;
  Regions& regions_;
  unsigned jobs_;
  bool names_vertices_;
  Graph graph_;
  std::vector<std::uint32_t> side_of_slot_;
};

}  // namespace

Graph order_graph(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions, unsigned jobs,
                  bool names_vertices) {
  return Orderer(mesh, topology, edges, regions, jobs, names_vertices).run();
}

}  // namespace fdcg::bake
