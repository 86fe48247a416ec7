// SPDX-License-Identifier: Apache-2.0
// Exact integrals over the solid that a closed mesh of triangles encloses.
#pragma once

#include <gmp.h>

#include <array>

#include "base/mesh.hpp"

namespace fdcg::bake {

// An mpz_t that frees itself.
class Integer {
 public:
  Integer() { mpz_init(z_); }
  ~Integer() { mpz_clear(z_); }
  Integer(const Integer&) = delete;
  Integer& operator=(const Integer&) = delete;
  [[nodiscard]] int sign() const { return mpz_sgn(z_); }
  operator mpz_ptr() { return z_; }           // NOLINT(google-explicit-constructor)
  operator mpz_srcptr() const { return z_; }  // NOLINT(google-explicit-constructor)

 private:
  mpz_t z_;
};

// Over the tetrahedra between one point and the triangles, by the divergence theorem, in units of 2^grid: 6 times the volume,
// 24 times the first moments, 120 times the second (xx, yy, zz, xy, xz, yz), about `from`, a point on the grid.
struct Moments {
  int grid = 0;
  std::array<Integer, 3> from;
  Integer volume;
  std::array<Integer, 3> first;
  std::array<Integer, 6> second;
};

inline constexpr int kFirstOfMoment[6] = {0, 1, 2, 0, 0, 1};
inline constexpr int kSecondOfMoment[6] = {0, 1, 2, 1, 2, 2};

// Of finite corners. Nothing is rounded, so that the order of the triangles does not matter. Linear.
void sum_moments(const Mesh& mesh, unsigned jobs, Moments& sums);

}  // namespace fdcg::bake
