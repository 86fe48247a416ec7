// SPDX-License-Identifier: Apache-2.0
// The quantum: an upper bound on how far rounding in the input file may have moved a vertex.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/mesh.hpp"
#include "base/vec3.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A point counts as lying on a plane or a line when it is within kQuantumReach quanta of it. Four: a plane through three
// corners of a parallelogram passes the fourth within the sum of four displacements.
inline constexpr double kQuantumReach = 4;

struct Quantum {
  double relative = 0;        // of |source coordinate|
  double absolute = 0;        // source units
  double local_relative = 0;  // of |local coordinate|: rounding added by storing floats; 0 in f64
  Vec3 origin;                // of the local frame

  // An upper bound on the distance (source units) between the stored point `local` and the intended point.
  [[nodiscard]] double at(const Vec3& local) const {
    constexpr double kSqrt3 = 1.7320508075688772;  // three coordinates, each with an error of one quantum
    return kSqrt3 *
           (std::max(relative * largest_component(local + origin), absolute) + local_relative * largest_component(local));
  }
};

// The quanta of a mesh that weld_points made from the soup.
inline Quantum quantum_of(const PolygonSoup& soup, const Mesh& mesh, Precision precision) {
  constexpr double kHalfUlpOfFloat = 0x1p-24;
  return {soup.relative_quantum, soup.absolute_quantum, precision == Precision::f32 ? kHalfUlpOfFloat : 0, mesh.origin};
}

}  // namespace fdcg::bake
