// SPDX-License-Identifier: Apache-2.0
// The convex problem behind closure, epsilon and margin: maximise over the wrenches w of a body the smallest product w . g_j
// with directions g_1 .. g_n. By duality its value is the least support of the body over the simplex of the g_j.
//
// Solved as a linear programme over the body's infinitely many wrenches, by the simplex method with column generation (the dual
// of Kelley's cutting planes). Both bounds are recomputed from their certificates, a wrench and a direction.
#pragma once

#include <span>

#include "grasp/grasp_body.hpp"

namespace fdcg::grasp {

// A wrench of the body with its weight in the solution.
struct Column {
  Vec6 wrench{};
  Vec6 at{};          // the direction that it was made for; of the start wrench: zero
  double weight = 0;  // >= 0, all together 1
};

struct GameOptions {
  double prune_above = std::numeric_limits<double>::infinity();  // stop when the lower bound reaches it
  double open_below = -std::numeric_limits<double>::infinity();  // stop when the upper bound is below it
  double gap = 1e-13;                                            // stop when the bounds differ by no more
  int max_pivots = 400;
};

struct GameResult {
  double lower = 0;  // the least product of `wrench` with a direction: proved by it
  double upper = 0;  // the body's support at `direction`: proved by it
  Vec6 wrench{};     // sum of the columns
  Vec6 direction{};  // sum of shares[j] g_j
  std::array<double, kDimensions + 1> shares{};
  std::array<Column, kDimensions + 1> columns{};
  std::size_t column_count = 0;
};

// directions: 1 to 6. start: a wrench of the body; start_at: as Column::at.
GameResult play(const Body& body, std::span<const Vec6> directions, const Vec6& start, const Vec6& start_at,
                const GameOptions& options);

// Directions d + reach s_j, where the s_j are corners of a regular simplex at right angles to the unit vector d: the least
// support over them is the length at which the ray along d leaves the body, where the body's normal there is within the reach.
std::array<Vec6, kDimensions> around(const Vec6& unit_direction, double reach, std::size_t dimensions);

}  // namespace fdcg::grasp
