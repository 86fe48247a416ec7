// SPDX-License-Identifier: Apache-2.0
// Whether records of four numbers hold a unit vector and a number in a range: the most frequent question of verification. Two
// records at a time, without a branch.
#pragma once

#include "base/lanes.hpp"

namespace fdcg {

#if FDCG_HAS_VECTORS
template <class Real>
struct Vectors;
template <>
struct Vectors<double> {
  using Reals = double __attribute__((vector_size(16)));
};
template <>
struct Vectors<float> {
  using Reals = float __attribute__((vector_size(16)));
};
#endif

// Of a stored unit vector's squared length.
template <class Real>
struct UnitRange {
  static constexpr Real kTolerance = sizeof(Real) == 8 ? Real(1e-9) : Real(1e-4);
  static constexpr Real kLeast = 1 - kTolerance, kMost = 1 + kTolerance;
};

template <class Real>
class UnitCheck : UnitRange<Real> {
  using UnitRange<Real>::kLeast, UnitRange<Real>::kMost;

 public:
  // The fourth number is to be above `above` and at most `most`. False for NaN too.
  UnitCheck(Real above, Real most);

  void look_at(const Real* a, const Real* b);
  [[nodiscard]] bool holds() const;

#if FDCG_HAS_VECTORS
 private:
  using Reals = typename Vectors<Real>::Reals;
  // Of comparisons, whatever the numbers: GCC 12 takes masks of doubles apart where they are combined.
  using Masks = int32_t __attribute__((vector_size(16)));

  static Reals load(const Real* from) {
    Reals reals;
    memcpy(&reals, from, sizeof reals);
    return reals;
  }

  static Masks within(Reals x, Reals above, Reals most) {
    return reinterpret_cast<Masks>(x > above) & reinterpret_cast<Masks>(x <= most);
  }

  Reals above_, most_;
  Masks holds_ = Masks{} == Masks{};  // no bit of a lane where something was wrong
#else
 private:
  void look_at_one(const Real* a) {
    const Real length2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    holds_ = holds_ && length2 > kLeast && length2 <= kMost && a[3] > above_ && a[3] <= most_;
  }

  Real above_, most_;
  bool holds_ = true;
#endif
};

#if FDCG_HAS_VECTORS

template <>
inline UnitCheck<double>::UnitCheck(double above, double most) : above_{above, above}, most_{most, most} {}
template <>
inline UnitCheck<float>::UnitCheck(float above, float most)
    : above_{kLeast, kLeast, above, above}, most_{kMost, kMost, most, most} {}

template <>
inline void UnitCheck<double>::look_at(const double* a, const double* b) {
  const Reals a0 = load(a), a1 = load(a + 2), b0 = load(b), b1 = load(b + 2);
  const Reals x = __builtin_shufflevector(a0, b0, 0, 2), y = __builtin_shufflevector(a0, b0, 1, 3);
  const Reals z = __builtin_shufflevector(a1, b1, 0, 2), fourth = __builtin_shufflevector(a1, b1, 1, 3);
  const Reals length2 = x * x + y * y + z * z;
  const Reals least = {kLeast, kLeast}, longest = {kMost, kMost};
  holds_ &= within(length2, least, longest) & within(fourth, above_, most_);
}
template <>
inline void UnitCheck<float>::look_at(const float* a, const float* b) {
  const Reals u = load(a), v = load(b), u2 = u * u, v2 = v * v;
  const Reals xy = __builtin_shufflevector(u2, v2, 0, 4, 1, 5), y = __builtin_shufflevector(xy, xy, 2, 3, 2, 3);
  const Reals z = __builtin_shufflevector(u2, v2, 2, 6, 2, 6), length2 = xy + y + z;
  const Reals fourth = __builtin_shufflevector(u, v, 3, 7, 3, 7);
  const Reals judged = __builtin_shufflevector(length2, fourth, 0, 1, 4, 5);
  holds_ &= within(judged, above_, most_);
}
template <class Real>
bool UnitCheck<Real>::holds() const {
  uint64_t words[2];
  memcpy(words, &holds_, sizeof words);
  return ~(words[0] & words[1]) == 0;
}

#else

template <class Real>
UnitCheck<Real>::UnitCheck(Real above, Real most) : above_(above), most_(most) {}
template <class Real>
void UnitCheck<Real>::look_at(const Real* a, const Real* b) {
  look_at_one(a);
  if (a != b) look_at_one(b);
}
template <class Real>
bool UnitCheck<Real>::holds() const {
  return holds_;
}

#endif

}  // namespace fdcg
