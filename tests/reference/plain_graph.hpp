// SPDX-License-Identifier: Apache-2.0
// A graph made the plain way, one node a polygon (of more sides than a node may have: several), nothing merged or reordered: a
// second maker beside the compiler, so that the runtime can be tested without it. Its faces must be convex, planar (to
// rounding) and consistently wound; every edge has at most two faces, every vertex one fan.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::test {

class PlainGraph {
 public:
  PlainGraph(const bake::PolygonSoup& whole, bake::Precision precision, bool with_hierarchy = true);
  PlainGraph(const PlainGraph&) = delete;
  PlainGraph& operator=(const PlainGraph&) = delete;

  [[nodiscard]] const fdcg_graph& view() const { return view_; }

 private:
  template <class Traits>
  void build(const bake::PolygonSoup& soup);
  void build_hierarchy();

  fdcg_header header_{};
  std::vector<std::uint64_t> nodes_, edges_, corners_;  // raw storage, aligned for every record
  std::vector<fdcg_connection> connections_;
  std::vector<fdcg_busy_corner> busy_corners_;
  std::vector<std::uint32_t> node_offsets_, fans_, face_of_piece_;
  struct NodeBox {
    std::array<double, 3> low{}, high{};
  };
  std::vector<fdcg_box8> boxes_;     // root first
  std::vector<NodeBox> node_boxes_;  // of single nodes
  fdcg_graph view_{};
};

}  // namespace fdcg::test
