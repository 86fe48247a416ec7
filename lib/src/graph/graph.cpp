// SPDX-License-Identifier: Apache-2.0
#include "graph/graph.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "base/parallel.hpp"
#include "base/release.hpp"
#include "base/vec3.hpp"
#include "exact/projection.hpp"
#include "graph/box_order.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kNodeGrain = 1u << 13;

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
    place_nodes(order_faces());
    copy_sides();
    parallel_for(jobs_, 2, 1, [&](std::size_t task, std::size_t) { task == 0 ? name_corners() : name_connections(); });
    return std::move(graph_);
  }

 private:
  std::vector<std::uint32_t> order_faces() {
    std::vector<std::uint32_t> faces(mesh_.face_count());
    std::iota(faces.begin(), faces.end(), 0u);
    order_by_boxes(mesh_, faces, jobs_);
    graph_.fan_runs = gather_fans(mesh_, topology_, faces);
    if (graph_.fan_runs.empty()) return faces;
    // What the fans have left is no whole boxes any more.
    order_by_boxes(mesh_, std::span(faces).first(graph_.fan_runs.front().first), jobs_);
    return faces;
  }

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
    parallel_for(jobs_, faces.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
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
    parallel_for(jobs_, side_of_slot_.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
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
