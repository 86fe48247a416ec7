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

// Records in double precision, whatever the file stores, with what it says in two places said in one. Sides are counted over
// all nodes.
struct WalkedNode {
  fdcg_plane_f64 plane;
  std::uint32_t first_side, side_count;
  std::uint16_t flags;
};
struct WalkedConnection {
  double edge[3], length;  // 0 where the file has no edges
  std::uint32_t corner[2], node[2], side[2];
  std::uint8_t type, flatness;
};
struct WalkedCorner {
  double point[3], normal[3];
  std::uint32_t first_fan, fan_count;
  bool is_open, is_busy;
};

// A file as it stands. Fans are walked where they are not stored.
struct WalkedGraph {
  fdcg_header header{};
  std::vector<WalkedNode> nodes;
  std::vector<std::uint32_t> sides;        // connection << 1 | which
  std::vector<std::uint32_t> side_corner;  // at which each starts
  std::vector<std::uint32_t> side_across;  // the node beyond it, or FDCG_NONE
  std::vector<fdcg_plane_f64> voronoi;     // empty: not in the file
  std::vector<WalkedConnection> connections;
  std::vector<WalkedCorner> corners;
  std::vector<std::uint32_t> fans;  // of all corners, connection << 1 | end
  std::vector<fdcg_busy_corner> busy_corners;
  std::vector<std::uint32_t> stored_fans;  // of the busy ones
  std::uint64_t node_bytes = 0;            // of the section, without padding
  std::vector<fdcg_box8> boxes;
  std::vector<std::uint32_t> source_map;
  std::string info;
  std::vector<std::string> layout_faults;  // met while reading

  [[nodiscard]] std::uint32_t corner_of_side(std::uint32_t side) const { return side_corner[side]; }
  [[nodiscard]] std::uint32_t across(std::uint32_t side) const { return side_across[side]; }
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
