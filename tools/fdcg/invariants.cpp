// SPDX-License-Identifier: Apache-2.0
#include "invariants.hpp"

#include <algorithm>
#include <limits>

#include "points.hpp"

namespace fdcg::tools {
namespace {

using bake::Vec3;

// Units in the last place that one rounded plane or unit vector may be off by, times a few for the arithmetic of the check.
constexpr double kRoundings = 16;
constexpr std::uint64_t kReportEvery = 1 << 14;       // measures
constexpr double kMeasuresOfAConnection = 3 * 2 + 3;  // of its two sides, and its own

class Checker {
 public:
  Checker(const fdcg_graph& graph, const bake::Progress& progress)
      : graph_(graph),
        header_(*graph.header),
        epsilon_(kRoundings * (header_.real_bytes == 8 ? std::numeric_limits<double>::epsilon()
                                                       : static_cast<double>(std::numeric_limits<float>::epsilon()))),
        length_(epsilon_ * header_.extent),
        progress_(progress),
        all_(kMeasuresOfAConnection * header_.connection_count + header_.node_count) {}

  std::vector<Invariant> run() {
    return {corners_on_planes(), nodes_convex(), unit_vectors(), voronoi_planes(), edges(), types()};
  }

 private:
  void measure(Invariant& invariant, std::uint64_t record, double deviation) {
    if (++measured_ % kReportEvery == 0 && progress_) progress_("measure the geometry", static_cast<double>(measured_) / all_);
    ++invariant.checked;
    if (!(deviation <= invariant.worst)) invariant.worst = deviation;
    if (deviation <= invariant.limit) return;  // NaN is a violation
    ++invariant.violations;
    if (invariant.first < 0) invariant.first = static_cast<std::int64_t>(record);
  }

  [[nodiscard]] Invariant named(const char* name, double limit) const { return {name, 0, 0, 0, limit, -1}; }

  [[nodiscard]] Vec3 point(std::uint32_t corner) const { return vec3(fdcg_get_corner(&graph_, corner).point); }
  [[nodiscard]] Vec3 start(std::uint32_t n, std::uint32_t k) const { return point(fdcg_get_side(&graph_, n, k).corner); }

  // A node without INEXACT has its corners on its plane but for the plane's own rounding; others stay within max_deviation.
  Invariant corners_on_planes() {
    Invariant invariant = named("corners lie on their nodes' planes", length_ + header_.max_deviation);
    for (std::uint32_t n = 0; n < header_.node_count; ++n) {
      const fdcg_node_info node = fdcg_get_node(&graph_, n);
      for (std::uint32_t k = 0; k < node.side_count; ++k)
        measure(invariant, n, std::abs(dot(vec3(node.normal), start(n, k)) + node.offset));
    }
    return invariant;
  }

  // Each side's end lies behind the Voronoi plane of the side before: the loop never turns right.
  Invariant nodes_convex() {
    Invariant invariant = named("nodes are convex", length_ + header_.max_deviation);
    for (std::uint32_t n = 0; n < header_.node_count; ++n) {
      const fdcg_node_info node = fdcg_get_node(&graph_, n);
      for (std::uint32_t k = 0; k < node.side_count; ++k) {
        const Vec3 out = cross(direction(fdcg_get_side(&graph_, n, k)), vec3(node.normal));
        measure(invariant, n, std::max(0.0, dot(out, plus(start(n, (k + 2) % node.side_count), -1, start(n, k)))));
      }
    }
    return invariant;
  }

  // The connection's edge vector, along the winding of the side's node.
  [[nodiscard]] Vec3 direction(const fdcg_side_info& side) const {
    const Vec3 e = vec3(fdcg_get_connection(&graph_, side.connection).direction);
    return side.which == 0 ? e : Vec3{-e.x, -e.y, -e.z};
  }

  Invariant unit_vectors() {
    Invariant invariant = named("normals and edge vectors have length 1", epsilon_);
    for (std::uint32_t n = 0; n < header_.node_count; ++n) {
      measure(invariant, n, std::abs(length(vec3(fdcg_get_node(&graph_, n).normal)) - 1));
    }
    for (std::uint32_t c = 0; c < header_.connection_count; ++c) {
      measure(invariant, c, std::abs(length(vec3(fdcg_get_connection(&graph_, c).direction)) - 1));
    }
    return invariant;
  }

  [[nodiscard]] bool is_exact(std::uint32_t node) const {
    return (fdcg_get_node(&graph_, node).flags & FDCG_NODE_INEXACT) == 0;
  }

  // They hold their edge, and on an exactly planar face stand upright, pointing away from it.
  Invariant voronoi_planes() {
    Invariant invariant =
        named("Voronoi planes hold their edges and point out of their faces", length_ + header_.max_deviation);
    for (std::uint32_t n = 0; n < header_.node_count; ++n) {
      const fdcg_node_info node = fdcg_get_node(&graph_, n);
      for (std::uint32_t k = 0; k < node.side_count; ++k) {
        const fdcg_side_info side = fdcg_get_side(&graph_, n, k);
        const Vec3 m = vec3(side.voronoi_normal), out = cross(direction(side), vec3(node.normal));
        const double turned = is_exact(n) ? length(plus(m, -1, out)) * header_.extent : 0;
        const double off_edge = std::max(std::abs(dot(m, start(n, k)) + side.voronoi_offset),
                                         std::abs(dot(m, start(n, (k + 1) % node.side_count)) + side.voronoi_offset));
        measure(invariant, n, std::max(turned, off_edge));
      }
    }
    return invariant;
  }

  Invariant edges() {
    Invariant invariant = named("edges lead from corner to corner", length_);
    for (std::uint32_t c = 0; c < header_.connection_count; ++c) {
      const fdcg_connection_info connection = fdcg_get_connection(&graph_, c);
      const Vec3 from = point(connection.corner[0]), to = point(connection.corner[1]), e = vec3(connection.direction);
      measure(invariant, c, length(plus(plus(to, -1, from), -connection.length, e)));
    }
    return invariant;
  }

  // The bend s = (n_a x n_b).e speaks against convex below zero, against concave above zero, against coplanar off zero. What
  // rounding can do to two normals is no evidence, nor are the planes of faces that are only nearly flat: there the two source
  // faces at the edge decide.
  Invariant types() {
    Invariant invariant = named("types agree with the bend between exactly planar faces", epsilon_);
    for (std::uint32_t c = 0; c < header_.connection_count; ++c) {
      const fdcg_connection_info connection = fdcg_get_connection(&graph_, c);
      if (connection.type == FDCG_BOUNDARY || !is_exact(connection.node[0]) || !is_exact(connection.node[1])) continue;
      const Vec3 a = vec3(fdcg_get_node(&graph_, connection.node[0]).normal);
      const Vec3 b = vec3(fdcg_get_node(&graph_, connection.node[1]).normal);
      const double bend = dot(cross(a, b), vec3(connection.direction));
      const double against = connection.type == FDCG_CONVEX ? -bend : connection.type == FDCG_CONCAVE ? bend : std::abs(bend);
      measure(invariant, c, std::max(0.0, against));
    }
    return invariant;
  }

  const fdcg_graph& graph_;
  const fdcg_header& header_;
  double epsilon_;  // of a direction
  double length_;   // of a position, local units
  const bake::Progress& progress_;
  std::uint64_t measured_ = 0;
  double all_;  // measures, about
};

}  // namespace

std::vector<Invariant> check_invariants(const fdcg_graph& graph, const bake::Progress& progress) {
  std::vector<Invariant> invariants = Checker(graph, progress).run();
  const std::vector<Invariant> mass = check_mass(graph);
  invariants.insert(invariants.end(), mass.begin(), mass.end());
  return invariants;
}

}  // namespace fdcg::tools
