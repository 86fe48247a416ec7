// SPDX-License-Identifier: Apache-2.0
// Three numbers of the graph's real type, and what the step does with them. Order of operations is part of the contract: the
// same bits everywhere.
#pragma once

#include <float.h>
#include <math.h>
#include <stdint.h>

// Of the way that a servo loop takes most: worth its copies, but where the library is built for size.
#ifdef __OPTIMIZE_SIZE__
#define FDCG_HOT inline
#else
#define FDCG_HOT [[gnu::always_inline]] inline
#endif

// Of small functions whose arguments are in memory anyway: where the library is built for size, one copy serves all.
#ifdef __OPTIMIZE_SIZE__
#define FDCG_ONE_COPY [[gnu::noinline]] inline
#else
#define FDCG_ONE_COPY inline
#endif

namespace fdcg {

// How numbers are given that stand in a file and do not change: as a copy, in registers; where the library is built for size,
// as they stand there.
#ifdef __OPTIMIZE_SIZE__
inline constexpr bool kGivesInPlace = true;
template <class Numbers>
using Given = const Numbers&;
#else
inline constexpr bool kGivesInPlace = false;
template <class Numbers>
using Given = Numbers;
#endif

template <class Real>
struct Vec3 {
  Real x, y, z;
};

// The same, copied number by number. Numbers that were stored one by one, and are then copied two at once, make the processor
// wait until they have left its store buffer.
template <class Real>
inline Vec3<Real> by_parts(Vec3<Real> a) {
  return {a.x, a.y, a.z};
}
template <class Real>
inline Vec3<Real> vec(const Real (&a)[3]) {
  return {a[0], a[1], a[2]};
}
template <class Real>
inline Given<Vec3<Real>> given_vec(const Real (&a)[3]) {
  if constexpr (kGivesInPlace) {
    return *reinterpret_cast<const Vec3<Real>*>(a);
  } else {
    return vec(a);
  }
}
template <class Real, class Stored>
inline void store(Vec3<Real> from, Stored (&to)[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}
template <class Real>
inline Vec3<Real> operator+(Vec3<Real> a, Vec3<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
inline Vec3<Real> operator-(Vec3<Real> a, Vec3<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
inline Vec3<Real> operator*(Vec3<Real> a, Real s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
inline Real dot(Vec3<Real> a, Vec3<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
inline Vec3<Real> cross(Vec3<Real> a, Vec3<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double absolute(double a) {
  return fabs(a);
}
inline float absolute(float a) {
  return fabsf(a);
}
inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double smaller(double a, double b) {
  return a < b ? a : b;
}
inline double root(double a) {
  return sqrt(a);
}
inline float root(float a) {
  return sqrtf(a);
}

template <class Real>
FDCG_HOT Real norm(Vec3<Real> a) {
  return root(dot(a, a));
}
// |x| + |y| + |z|: an upper bound of the length that costs no root.
template <class Real>
inline Real norm1(Vec3<Real> a) {
  return absolute(a.x) + absolute(a.y) + absolute(a.z);
}
// The spacing of the numbers at 1; the smallest normal one; a distance that is no more than a sign, far below the rounding of
// the smallest object and yet large enough that its square is normal (denormal numbers take a hundred times as long); and a
// coordinate whose products of three still are numbers.
template <class Real>
struct RealLimits;
template <>
struct RealLimits<double> {
  static constexpr double kEpsilon = DBL_EPSILON, kTiny = DBL_MIN, kSignOnly = 1e-150, kFar = 1e70;
};
template <>
struct RealLimits<float> {
  static constexpr float kEpsilon = FLT_EPSILON, kTiny = FLT_MIN, kSignOnly = 1e-18F, kFar = 1e10F;
};

// Neither NaN nor infinite nor so far away that the step's arithmetic would overflow.
template <class Real>
inline bool is_usable(Vec3<Real> a) {
  return norm1(a) <= RealLimits<Real>::kFar;
}

}  // namespace fdcg
