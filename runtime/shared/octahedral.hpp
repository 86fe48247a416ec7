// SPDX-License-Identifier: Apache-2.0
// Unit vectors in 2 x 16 bits: the octahedron |x| + |y| + |z| = 1 unfolded onto a square, as sections of corner normals have
// them (schemas/fdcg-v1.md). Off by at most 5e-5 rad.
#pragma once

#include "shared/vec.hpp"

namespace fdcg {

inline constexpr double kOctahedralScale = 32767;

inline double with_sign_of(double size, double sign) {
  return sign < 0 ? -size : size;
}

// Of any two numbers a unit vector.
inline Vec3<double> octahedral_decoded(const uint16_t (&code)[2]) {
  constexpr double kStep = 1 / kOctahedralScale;
  const double u = code[0] * kStep - 1, v = code[1] * kStep - 1;
  const double z = 1 - absolute(u) - absolute(v);
  const Vec3<double> point =
      z < 0 ? Vec3<double>{with_sign_of(1 - absolute(v), u), with_sign_of(1 - absolute(u), v), z} : Vec3<double>{u, v, z};
  return point * (1 / norm(point));
}

// Of a vector other than 0; each number is at most 65534.
inline void octahedral_encode(Vec3<double> vector, uint16_t (&code)[2]) {
  const Vec3<double> p = vector * (1 / norm1(vector));
  const double u = p.z < 0 ? with_sign_of(1 - absolute(p.y), p.x) : p.x;
  const double v = p.z < 0 ? with_sign_of(1 - absolute(p.x), p.y) : p.y;
  code[0] = static_cast<uint16_t>((u + 1) * kOctahedralScale + 0.5);
  code[1] = static_cast<uint16_t>((v + 1) * kOctahedralScale + 0.5);
}

}  // namespace fdcg
