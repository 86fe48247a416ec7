// SPDX-License-Identifier: Apache-2.0
// Which points lie inside a closed mesh, exactly, and for most of them in constant time: a grid of cells that the surface does
// not meet, and for each of the others a point in it whose side is known. Made to be asked 10^9 times.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hip_walk.hpp"

namespace fdcg::test {

using Triangle = std::array<Hip, 3>;

class InsideGrid {
 public:
  enum class Where : std::uint8_t { outside, inside, surface };

  // Of a closed surface without self-intersection.
  explicit InsideGrid(std::vector<Triangle> triangles);

  // `surface` too where every way that is tried meets an edge or a corner.
  [[nodiscard]] Where where(const Hip& point) const;

  struct Crossing {
    bool is_through = false;  // passes through a face's inside: surely through the surface
    bool touches = false;     // meets an edge or a corner, or ends on a face's plane: perhaps, perhaps not
  };
  // Of a straight way, from anywhere to anywhere.
  [[nodiscard]] Crossing crossing(const Hip& from, const Hip& to) const;

  // Whether a way comes from outside, meets one edge or one corner exactly and nothing else, and ends outside.
  [[nodiscard]] bool grazes(const Hip& from, const Hip& to) const;

  // Whether the surface comes as near to a straight way as that, both ends of the way included. In long double.
  [[nodiscard]] bool comes_near(const Hip& from, const Hip& to, double near) const;

  // From a point to the nearest of the surface, in floating point, or less where the nearest is a sliver: its rim is taken a
  // little wider, so that no rounding lets a point fall between two. Looks at every triangle.
  [[nodiscard]] double distance_to_surface(const Hip& point) const;
  [[nodiscard]] double size() const { return size_; }  // of the bounds' longest side

  // How many triangles share a cell with a point: what a question there costs.
  [[nodiscard]] std::size_t crowd_at(const Hip& point) const;

 private:
  using Place = std::array<int, 3>;
  struct Parity {
    bool is_odd = false;  // of the triangles passed; means nothing where one was touched
    bool touches = false;
    bool ends_on_surface = false;  // touches it there
  };

  void place_triangles();
  void find_sides();
  void meet_row(const Triangle& t, const Hip& normal, std::uint32_t f, Place from, int to,
                std::vector<std::pair<std::uint32_t, std::uint32_t>>& met) const;
  [[nodiscard]] std::size_t index(const Place& p) const {
    return (static_cast<std::size_t>(p[2]) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(p[1])) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(p[0]);
  }
  [[nodiscard]] std::optional<Place> place_of(const Hip& point) const;  // none: outside of the grid
  [[nodiscard]] int clamped(std::size_t axis, double x) const;
  [[nodiscard]] bool has_triangles(std::size_t cell) const { return first_[cell + 1] > first_[cell]; }
  [[nodiscard]] Parity parity_between(std::size_t a, std::size_t b, const Hip& from, const Hip& to) const;
  // Calls visit(cell) for each cell with triangles that the way comes nearer to than `near`, some twice; until it says true.
  template <class Visit>
  bool any_cell_along(const Hip& from, const Hip& to, double near, const Visit& visit) const;
  void cross_cell(std::size_t cell, const Hip& from, const Hip& to, Crossing& result) const;

  std::vector<Triangle> triangles_;
  Hip low_{}, cell_{}, per_cell_{};
  std::array<int, 3> count_{};
  double size_ = 0;
  std::vector<std::uint32_t> first_, member_;  // of each cell: the triangles that meet it
  std::vector<Hip> known_point_;               // of each cell
  std::vector<Where> known_;                   // ... which is never on the surface; `surface` where none was found
};

}  // namespace fdcg::test
