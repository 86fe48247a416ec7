// SPDX-License-Identifier: Apache-2.0
// Least-squares plane of a growing set of triangles.
#pragma once

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The moments of a set of triangles about a fixed point. The plane is fitted by least squares of the heights over it. Only sums
// are kept: adding a triangle takes constant time, and no eigenvalue problem is solved.
class PlaneFit {
 public:
  explicit PlaneFit(const Vec3& about) : about_(about) {}

  void add(const Vec3& a, const Vec3& b, const Vec3& c);

  struct Fitted {
    Vec3 normal, point;  // `point` lies on the plane
  };
  // Tilts `normal` to the least-squares fit. Where the corners are collinear it is left unchanged.
  [[nodiscard]] Fitted fit(const Vec3& normal) const;

  // The normalised sum of the triangles' area vectors.
  [[nodiscard]] Vec3 mean_normal() const;
  [[nodiscard]] Vec3 centre() const;

 private:
  Vec3 about_;
  double count_ = 0;
  Vec3 sum_, area_;
  Vec3 squares_, products_;  // xx, yy, zz and yz, zx, xy
};

}  // namespace fdcg::bake
