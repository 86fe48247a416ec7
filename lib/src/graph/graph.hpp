// SPDX-License-Identifier: Apache-2.0
// The finished faces put in the order of the file: nodes along a space-filling curve, then those of busy corners
// (fan_runs.hpp), everything else by first use.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "graph/classify.hpp"
#include "graph/fan_runs.hpp"
#include "graph/regions.hpp"

namespace fdcg::bake {

// The content of the file except for derived floating-point numbers. Indices are those of the file: node, side (counted over
// all nodes), connection, corner.
struct Graph {
  std::vector<Vec3> points;                 // of each corner
  std::vector<std::uint32_t> first_side;    // node n: sides first_side[n] .. first_side[n + 1] - 1
  std::vector<std::uint32_t> node_of_side;  // empty where every node is a triangle (then side / 3)
  std::vector<std::uint32_t> corner;        // of each side: where it starts
  std::vector<std::uint32_t> twin;          // of each side: the side across, or kNone on a boundary
  std::vector<EdgeClass> edges;             // of each side
  std::vector<std::uint32_t> connection;    // of each side: connection << 1 | which
  std::vector<std::uint32_t> region;        // of each node, or kNone; empty where no node has one
  std::vector<Region> regions;
  std::vector<std::uint32_t> fan_start;         // of each corner: the side that its fan starts with
  std::vector<std::uint32_t> first_fan;         // corner c: fan entries first_fan[c] .. first_fan[c + 1] - 1
  std::vector<std::uint32_t> node_of_face;      // of each face of the mesh that this was made of
  std::vector<std::uint32_t> corner_of_vertex;  // of each vertex of that mesh, or kNone: no face has it; empty: not asked for
  std::vector<FanRun> fan_runs;                 // in ascending order; `vertex` is a corner of the graph
  std::uint32_t connection_count = 0;
  std::uint32_t largest_fan = 0;

  [[nodiscard]] std::uint32_t node_count() const { return static_cast<std::uint32_t>(first_side.size() - 1); }
  [[nodiscard]] std::uint32_t side_count() const { return static_cast<std::uint32_t>(corner.size()); }
  [[nodiscard]] std::uint32_t corner_count() const { return static_cast<std::uint32_t>(points.size()); }
  [[nodiscard]] std::uint32_t node(std::uint32_t side) const { return node_of_side.empty() ? side / 3 : node_of_side[side]; }
  [[nodiscard]] std::uint32_t region_of(std::uint32_t node) const { return region.empty() ? kNone : region[node]; }
  // Whether two nodes have the same plane, bit for bit.
  [[nodiscard]] bool is_one_plane(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t r = region_of(a), s = region_of(b);
    return r != kNone && s != kNone && (r == s || (regions[r].whole != kNone && regions[r].whole == regions[s].whole));
  }
  // The side of the same node that ends where `side` starts.
  [[nodiscard]] std::uint32_t previous(std::uint32_t side) const {
    const std::uint32_t n = node(side);
    return side > first_side[n] ? side - 1 : first_side[n + 1] - 1;
  }
  [[nodiscard]] std::uint32_t next(std::uint32_t side) const {
    const std::uint32_t n = node(side);
    return side + 1 < first_side[n + 1] ? side + 1 : first_side[n];
  }
};

// Orders faces, connections and corners. The mesh is manifold and oriented, its faces are convex, its twins are half-edges or
// kBoundary; vertices of no face are dropped. A polygon starts at the corner whose triangle with the two next corners is the
// largest (and strictly counter-clockwise). Near linear; the order does not depend on `jobs`. `names_vertices`: fills
// corner_of_vertex.
[[nodiscard]] Graph order_graph(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions, unsigned jobs,
                                bool names_vertices = false);

}  // namespace fdcg::bake
