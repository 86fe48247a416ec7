// SPDX-License-Identifier: Apache-2.0
// The implicit bounding-volume tree over the nodes in file order (format.h, fdcg_box).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/format.h"
#include "graph.hpp"

namespace fdcg::bake {

// Boxes on each level, the root's level first: ..., one for every two below, one for every FDCG_LEAF_NODES nodes.
[[nodiscard]] std::vector<std::uint32_t> hierarchy_levels(std::uint32_t node_count);

// Fills `boxes` (as many as the levels add up to). Each holds its nodes' corners, nodes off their plane widened by
// `max_deviation`, rounded outwards to float. Linear.
void build_hierarchy(const Graph& graph, double max_deviation, std::span<fdcg_box> boxes, unsigned jobs);

}  // namespace fdcg::bake
