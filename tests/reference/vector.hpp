// SPDX-License-Identifier: Apache-2.0
// Three-vectors over any real number type.
#pragma once

#include <cmath>

namespace fdcg::test {

template <class Real>
struct Vector {
  Real x{0}, y{0}, z{0};

  friend Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(const Vector& a, const Real& s) { return {a.x * s, a.y * s, a.z * s}; }
};

template <class Real>
Real dot(const Vector<Real>& a, const Vector<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vector<Real> cross(const Vector<Real>& a, const Vector<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
Real length(const Vector<Real>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

}  // namespace fdcg::test
