// SPDX-License-Identifier: Apache-2.0
#include "invariants.hpp"

#include <algorithm>
#include <limits>

#include "typed_graph.hpp"

namespace fdcg::tools {
namespace {

// Units in the last place that one rounded plane or unit vector may be off by, times a few for the arithmetic of the check.
constexpr double kRoundings = 16;

void measure(Invariant& invariant, std::uint64_t record, double deviation) {
  ++invariant.checked;
  if (!(deviation <= invariant.worst)) invariant.worst = deviation;
  if (deviation <= invariant.limit) return;  // NaN is a violation
  ++invariant.violations;
  if (invariant.first < 0) invariant.first = static_cast<std::int64_t>(record);
}

template <class Records>
class Checker {
 public:
  explicit Checker(const TypedGraph<Records>& graph)
      : graph_(graph),
        epsilon_(kRoundings * static_cast<double>(std::numeric_limits<typename Records::Real>::epsilon())),
        length_(epsilon_ * graph.header.extent) {}

  std::vector<Invariant> run() {
    return {corners_on_planes(), nodes_convex(), unit_vectors(), voronoi_planes(), end_planes(), types()};
  }

 private:
  [[nodiscard]] Invariant named(const char* name, double limit) const { return {name, 0, 0, 0, limit, -1}; }

  [[nodiscard]] Triple point(std::uint32_t corner) const { return triple(graph_.corners[corner].point); }

  template <class Plane>
  static double distance(const Plane& plane, const Triple& x) {
    return dot(triple(plane.normal), x) + static_cast<double>(plane.offset);
  }

  // A node without INEXACT has its corners on its plane but for the plane's own rounding; others stay within max_deviation.
  Invariant corners_on_planes() {
    Invariant invariant = named("corners lie on their nodes' planes", length_ + graph_.header.max_deviation);
    for (std::uint32_t n = 0; n < graph_.header.node_count; ++n) {
      const auto& node = graph_.nodes[n];
      for (std::uint32_t k = 0; k < node.side_count; ++k) {
        measure(invariant, n, std::abs(distance(node.plane, point(graph_.start_corner(node.first_side + k)))));
      }
    }
    return invariant;
  }

  // Each side's end lies behind the Voronoi plane of the side before: the loop never turns right.
  Invariant nodes_convex() {
    Invariant invariant = named("nodes are convex", length_ + graph_.header.max_deviation);
    for (std::uint32_t n = 0; n < graph_.header.node_count; ++n) {
      const auto& node = graph_.nodes[n];
      for (std::uint32_t k = 0; k < node.side_count; ++k) {
        const std::uint32_t side = node.first_side + k;
        const Triple out = cross(direction(side), triple(node.plane.normal));
        const std::uint32_t beyond = node.first_side + (k + 2) % node.side_count;
        measure(invariant, n,
                std::max(0.0, dot(out, minus(point(graph_.start_corner(beyond)), point(graph_.start_corner(side))))));
      }
    }
    return invariant;
  }

  // The connection's edge vector, along the winding of the side's node.
  [[nodiscard]] Triple direction(std::uint32_t side) const {
    const Triple e = triple(graph_.connections[graph_.connection_of(side)].edge);
    return (graph_.sides[side] & 1) == 0 ? e : Triple{-e[0], -e[1], -e[2]};
  }

  Invariant unit_vectors() {
    Invariant invariant = named("normals and edge vectors have length 1", epsilon_);
    for (std::uint32_t n = 0; n < graph_.header.node_count; ++n) {
      measure(invariant, n, std::abs(length(triple(graph_.nodes[n].plane.normal)) - 1));
    }
    for (std::uint32_t c = 0; c < graph_.header.connection_count; ++c) {
      measure(invariant, c, std::abs(length(triple(graph_.connections[c].edge)) - 1));
    }
    return invariant;
  }

  [[nodiscard]] bool is_exact(std::uint32_t node) const { return (graph_.nodes[node].flags & FDCG_NODE_INEXACT) == 0; }

  // They hold their edge, and on an exactly planar face stand upright, pointing away from it.
  Invariant voronoi_planes() {
    Invariant invariant =
        named("Voronoi planes hold their edges and point out of their faces", length_ + graph_.header.max_deviation);
    if (graph_.voronoi_planes == nullptr) return invariant;
    for (std::uint32_t n = 0; n < graph_.header.node_count; ++n) {
      const auto& node = graph_.nodes[n];
      for (std::uint32_t side = node.first_side; side < node.first_side + node.side_count; ++side) {
        const auto& plane = graph_.voronoi_planes[side];
        const Triple out = cross(direction(side), triple(node.plane.normal));
        const double turned = is_exact(n) ? length(minus(triple(plane.normal), out)) * graph_.header.extent : 0;
        const auto& connection = graph_.connections[graph_.connection_of(side)];
        const double off_edge = std::max(std::abs(distance(plane, point(connection.corner[0]))),
                                         std::abs(distance(plane, point(connection.corner[1]))));
        measure(invariant, n, std::max(turned, off_edge));
      }
    }
    return invariant;
  }

  Invariant end_planes() {
    Invariant invariant = named("end planes pass through their corners", length_);
    for (std::uint32_t c = 0; c < graph_.header.connection_count; ++c) {
      const auto& connection = graph_.connections[c];
      const Triple e = triple(connection.edge);
      measure(invariant, c, std::abs(static_cast<double>(connection.end_offset[0]) - dot(e, point(connection.corner[0]))));
      measure(invariant, c, std::abs(static_cast<double>(connection.end_offset[1]) + dot(e, point(connection.corner[1]))));
    }
    return invariant;
  }

  // The bend s = (n_a x n_b).e speaks against convex below zero, against concave above zero, against coplanar off zero. What
  // rounding can do to two normals is no evidence, nor are the planes of faces that are only nearly flat: there the two source
  // faces at the edge decide.
  Invariant types() {
    Invariant invariant = named("types agree with the bend between exactly planar faces", epsilon_);
    for (std::uint32_t c = 0; c < graph_.header.connection_count; ++c) {
      const auto& connection = graph_.connections[c];
      if (connection.type == FDCG_BOUNDARY || !is_exact(connection.node[0]) || !is_exact(connection.node[1])) continue;
      const Triple a = triple(graph_.nodes[connection.node[0]].plane.normal);
      const Triple b = triple(graph_.nodes[connection.node[1]].plane.normal);
      const double bend = dot(cross(a, b), triple(connection.edge));
      const double against = connection.type == FDCG_CONVEX ? -bend : connection.type == FDCG_CONCAVE ? bend : std::abs(bend);
      measure(invariant, c, std::max(0.0, against));
    }
    return invariant;
  }

  const TypedGraph<Records>& graph_;
  double epsilon_;  // of a direction
  double length_;   // of a position, local units
};

}  // namespace

std::vector<Invariant> check_invariants(const fdcg_graph& graph) {
  return visit_typed(graph, []<class Records>(const TypedGraph<Records>& typed) { return Checker<Records>(typed).run(); });
}

}  // namespace fdcg::tools
