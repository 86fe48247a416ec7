// SPDX-License-Identifier: Apache-2.0
// Sphere, cylinder, torus and cone by formula, and their tessellations with every corner on the true surface. Of the smooth
// shape everything is known: the god-object of a HIP at a depth without friction is the point of the surface straight above it.
#pragma once

#include <string>
#include <vector>

#include "meshes.hpp"
#include "vector.hpp"

namespace fdcg::test {

using SmoothPoint = Vector<long double>;

struct SurfacePoint {
  SmoothPoint point, normal;  // metres; of unit length, outward
};

class SmoothShape {
 public:
  virtual ~SmoothShape() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  // Where a curve on the surface is that crosses its parameter lines; it stays clear of rims and apex.
  [[nodiscard]] virtual SurfacePoint curve(long double t) const = 0;
  // Signed, positive outside; near the part of the surface that the curve goes along.
  [[nodiscard]] virtual long double distance(const SmoothPoint& x) const = 0;
  // The least radius of curvature along the curve: depths are shares of it.
  [[nodiscard]] virtual double curvature_radius_m() const = 0;
  // Level 0 .. kLevels - 1, each with edges half as long as the one before.
  [[nodiscard]] virtual PolygonSoup tessellated(int level) const = 0;

  static constexpr int kLevels = 8;
};

// All four live as long as the program.
std::vector<const SmoothShape*> smooth_shapes();

}  // namespace fdcg::test
