// SPDX-License-Identifier: Apache-2.0
// A plane through a growing cloud of corners.
#pragma once

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The moments of a set of triangles about a fixed point, from which a plane is fitted by least squares of the heights over
// it. Sums only: adding costs the same however many there are, and no eigenvalue is sought.
class PlaneFit {
 public:
  explicit PlaneFit(const Vec3& about) : about_(about) {}

  void add(const Vec3& a, const Vec3& b, const Vec3& c);

  struct Fitted {
    Vec3 normal, point;  // `point` lies on the plane
  };
  // Tilts `normal` to fit. Where the corners span no plane (all on a line) it stays as it is.
  [[nodiscard]] Fitted fit(const Vec3& normal) const;

  // The unit of the sum of the triangles' area vectors.
  [[nodiscard]] Vec3 mean_normal() const;
  [[nodiscard]] Vec3 centre() const;

 private:
  Vec3 about_;
  double count_ = 0;
  Vec3 sum_, area_;
  Vec3 squares_, products_;  // xx, yy, zz and yz, zx, xy
};

}  // namespace fdcg::bake
