// SPDX-License-Identifier: Apache-2.0
// The normals of a shaded face, as a function of the place on it (contact-model SHADE-1).
#pragma once

#include "shared/vec.hpp"

namespace fdcg {

// Two coordinates along a face.
struct Flat {
  double p, q;
};

// Axes of unit length: along side 0 of a face, across it into the face, and the face's normal.
struct FaceFrame {
  Vec3<double> along, across, normal;

  [[nodiscard]] Flat flat(Vec3<double> v) const { return {dot(along, v), dot(across, v)}; }
  [[nodiscard]] Vec3<double> in_frame(Vec3<double> v) const { return {dot(along, v), dot(across, v), dot(normal, v)}; }
};

// The sum of the corners' normals by shares, which is linear in a place; in the face's frame.
struct NormalField {
  Vec3<double> at_zero;  // at the foot of the graph's origin
  Vec3<double> per_p, per_q;

  [[nodiscard]] Vec3<double> at(Flat x) const { return at_zero + per_p * x.p + per_q * x.q; }
};

}  // namespace fdcg
