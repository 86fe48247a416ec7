// SPDX-License-Identifier: Apache-2.0
// The implicit bounding-volume tree over the nodes in file order (format.h, fdcg_box8).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/format.h"
#include "graph/graph.hpp"

namespace fdcg::bake {

// Records on each level, the root's level first: ..., one for every eight below, one for every eight leaves.
[[nodiscard]] std::vector<std::uint32_t> hierarchy_levels(std::uint32_t node_count);

// What the boxes are measured in, and widened by where a node's corners lie off its plane; units of the file.
struct HierarchyScale {
  double extent = 0;
  double max_deviation = 0;
};

// Fills `records` (as many as the levels add up to). Each box holds its nodes' corners. Linear.
void build_hierarchy(const Graph& graph, const HierarchyScale& scale, std::span<fdcg_box8> records, unsigned jobs);

}  // namespace fdcg::bake
