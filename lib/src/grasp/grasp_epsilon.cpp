// SPDX-License-Identifier: Apache-2.0
// A cone of directions with corners g_1 .. g_n (unit vectors) is pruned when the body has one wrench w whose product with each
// corner is at least the best value known: a unit vector u of the cone is a sum of corners with weights that sum to 1 or more,
// so the support at u is at least w.u, which is at least the best value. Else the cone is bisected at the midpoint of its
// longest side. Cones with a common side share its corners, so the gaps between them are only the rounding of the midpoints
// (1e-16, far below the tolerance).
#include "grasp/grasp_epsilon.hpp"

#include <algorithm>
#include <queue>

#include "grasp/grasp_game.hpp"

namespace fdcg::grasp {
namespace {

struct Cell {
  double lower = -std::numeric_limits<double>::infinity();  // lower bound of the support over the unit directions in it
  std::array<std::uint32_t, kDimensions> corners{};
  Vec6 wrench{};  // proves `lower`; start value for the cells cut from it
};
struct HigherFirst {
  bool operator()(const Cell& a, const Cell& b) const { return a.lower > b.lower; }
};

constexpr std::uint64_t kReportEvery = 1024;  // cells, of which a split adds two

class Search {
 public:
  Search(const Body& body, const LocalMinimum& start) : body_(body), n_(body.dimensions), best_(start) {}
  LeastSupport run(std::uint64_t max_cells, const bake::Progress& progress);

 private:
  void begin();  // the orthants
  void look_at(Cell cell);
  void split(const Cell& cell);
  [[nodiscard]] double enough() const { return best_.value - kTolerance / 2; }

  const Body& body_;
  std::size_t n_;
  LocalMinimum best_;
  std::vector<Vec6> corners_;
  std::priority_queue<Cell, std::vector<Cell>, HigherFirst> open_;
  std::uint64_t cells_ = 0;
};

void Search::look_at(Cell cell) {
  ++cells_;
  std::array<Vec6, kDimensions> directions{};
  for (std::size_t j = 0; j < n_; ++j)
    directions[j] = corners_[cell.corners[j]];
  GameOptions options;
  options.prune_above = options.open_below = enough();
  const GameResult game = play(body_, {directions.data(), n_}, cell.wrench, {}, options);
  if (game.lower >= enough()) return;
  if (game.lower > cell.lower) {
    cell.lower = game.lower;
    cell.wrench = game.wrench;
  }
  const Vec6 lowest = unit(game.direction);
  if (body_.value(lowest) < enough()) {
    const LocalMinimum found = descend(body_, lowest);
    if (found.value < best_.value) best_ = found;
  }
  open_.push(cell);
}

void Search::split(const Cell& cell) {
  std::size_t a = 0, b = 1;
  double least = 2;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = i + 1; j < n_; ++j) {
      const double cosine = dot(corners_[cell.corners[i]], corners_[cell.corners[j]]);
      if (cosine < least) least = cosine, a = i, b = j;
    }
  }
  Vec6 middle = corners_[cell.corners[a]];
  add_scaled(middle, 1, corners_[cell.corners[b]]);
  corners_.push_back(unit(middle));
  for (const std::size_t j : {a, b}) {
    Cell child = cell;
    child.corners[j] = static_cast<std::uint32_t>(corners_.size() - 1);
    look_at(child);
  }
}

void Search::begin() {
  for (std::size_t k = 0; k < n_; ++k) {
    for (const double sign : {1.0, -1.0}) {
      Vec6 axis{};
      axis[k] = sign;
      corners_.push_back(axis);
    }
  }
  for (std::uint32_t orthant = 0; orthant < 1U << n_; ++orthant) {
    Cell cell;
    Vec6 middle{};
    for (std::size_t k = 0; k < n_; ++k) {
      cell.corners[k] = static_cast<std::uint32_t>(2 * k + (orthant >> k & 1));
      add_scaled(middle, 1, corners_[cell.corners[k]]);
    }
    cell.wrench = body_.support(middle).wrench;
    look_at(cell);
  }
}

LeastSupport Search::run(std::uint64_t max_cells, const bake::Progress& progress) {
  begin();
  while (!open_.empty() && open_.top().lower < enough() && cells_ < max_cells && best_.value > kTolerance) {
    const Cell cell = open_.top();
    open_.pop();
    split(cell);
    if (progress && cells_ % kReportEvery < 2)
      progress("search for epsilon", static_cast<double>(cells_) / static_cast<double>(max_cells));
  }
  // Pruned cones have at least enough() of a best value that has only decreased since.
  return {best_, open_.empty() ? enough() : std::min(enough(), open_.top().lower), cells_};
}

}  // namespace

LeastSupport least_support(const Body& body, const LocalMinimum& start, std::uint64_t max_cells,
                           const bake::Progress& progress) {
  return Search(body, start).run(max_cells, progress);
}

}  // namespace fdcg::grasp
