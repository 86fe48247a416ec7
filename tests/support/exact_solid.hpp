// SPDX-License-Identifier: Apache-2.0
// A closed mesh of triangles as the graph stores its points, judged exactly: what a segment crosses, on which side a point is.
// Written apart from the runtime; signs by CGAL's exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "hip_walk.hpp"

namespace fdcg::test {

class ExactSolid {
 public:
  // `soup`: triangles, closed and free of self-intersection; `header`: of the graph compiled from it.
  ExactSolid(const bake::PolygonSoup& soup, const fdcg_header& header);

  struct Crossing {
    int proper = 0;        // faces passed through their inside, from one side to the other: surely through the surface
    bool touches = false;  // an edge, a corner or an end on a face's plane: perhaps, perhaps not
  };
  [[nodiscard]] Crossing crossing(const Hip& from, const Hip& to) const;

  enum class Where { outside, inside, surface };
  // `surface` too where every way to the point meets an edge or a corner.
  [[nodiscard]] Where where(const Hip& point) const;

  // From a point to the surface, in floating point.
  [[nodiscard]] double distance_to_surface(const Hip& point) const;

  // Points as stored, local.
  [[nodiscard]] const std::vector<std::array<Hip, 3>>& triangles() const { return triangles_; }
  [[nodiscard]] const Hip& low() const { return low_; }
  [[nodiscard]] const Hip& high() const { return high_; }
  [[nodiscard]] double size() const { return size_; }  // of the bounds' longest side

 private:
  static constexpr std::size_t kFarPoints = 6;

  std::vector<std::array<Hip, 3>> triangles_;
  std::array<Hip, kFarPoints> far_points_{};  // far outside, in no special direction
  Hip low_{}, high_{};
  double size_ = 0;
};

}  // namespace fdcg::test
