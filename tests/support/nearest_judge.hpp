// SPDX-License-Identifier: Apache-2.0
// The distance of points from a closed triangle mesh, and on which side they are, by CGAL: the nearest triangle by its AABB
// tree, the distance from that in exact arithmetic, the side by its exact predicates.
#pragma once

#include <memory>

#include "fdcg/bake.hpp"

namespace fdcg::test {

class NearestJudge {
 public:
  // Triangles alone.
  explicit NearestJudge(const bake::PolygonSoup& soup);
  ~NearestJudge();
  NearestJudge(const NearestJudge&) = delete;
  NearestJudge& operator=(const NearestJudge&) = delete;

  [[nodiscard]] double distance(const bake::Vec3& point) const;
  [[nodiscard]] bool is_inside(const bake::Vec3& point) const;  // of a closed mesh; on it counts as outside

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace fdcg::test
