// SPDX-License-Identifier: Apache-2.0
// Reads an FDCG file's bytes by format.h alone and tells every rule of the format that it breaks. Written apart from the
// compiler and from the runtime's verification.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/format.h"

namespace fdcg::test {

// A file in double precision, whatever it stores. Planes, corners and boxes as they stand there.
struct WalkedGraph {
  fdcg_header header{};
  std::vector<fdcg_node_f64> nodes;
  std::vector<std::uint32_t> sides;
  std::vector<fdcg_plane_f64> voronoi;  // empty: not in the file
  std::vector<fdcg_connection_f64> connections;
  std::vector<fdcg_corner_f64> corners;
  std::vector<std::uint32_t> fans;
  std::vector<fdcg_box8> boxes;
  std::vector<std::uint32_t> source_map;
  std::string info;

  [[nodiscard]] std::uint32_t corner_of_side(std::uint32_t side) const {
    return connections[sides[side] >> 1].corner[sides[side] & 1u];
  }
  [[nodiscard]] std::uint32_t across(std::uint32_t side) const {
    return connections[sides[side] >> 1].node[1u - (sides[side] & 1u)];
  }
  [[nodiscard]] long euler_characteristic() const {
    return static_cast<long>(corners.size()) - static_cast<long>(connections.size()) + static_cast<long>(nodes.size());
  }
  [[nodiscard]] double area() const;
};

WalkedGraph read_graph(const std::vector<std::byte>& bytes);

// What is wrong, a sentence each; empty where nothing is. At most 20.
std::vector<std::string> defects_of(const WalkedGraph& graph);
// The same as one text, for a test's message.
std::string defects_text(const std::vector<std::byte>& bytes);

}  // namespace fdcg::test
