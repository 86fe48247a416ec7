// SPDX-License-Identifier: Apache-2.0
// Integers of a fixed width in two's complement: several times as fast as arbitrary precision while they are short.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace fdcg::bake {

// N limbs of 64 bits, lowest first. Overflow is not checked: the caller ensures that the numbers fit.
template <std::size_t N>
struct Wide {
  std::array<std::uint64_t, N> limb{};

  [[nodiscard]] std::uint64_t sign_mask() const { return 0 - (limb[N - 1] >> 63); }  // all ones below zero
};

__extension__ using DoubleLimb = unsigned __int128;

// to += (what & mask) * 2^(64 at), or to -= it; the limbs of `what` beyond its own are its sign.
template <std::size_t At, bool Negative, std::size_t N, std::size_t M>
inline void add_limbs(Wide<N>& to, const Wide<M>& what, std::uint64_t mask, std::uint64_t beyond) {
  std::uint64_t carry = Negative ? 1 : 0;
  for (std::size_t i = At; i < N; ++i) {
    const std::uint64_t digit = (i - At < M ? what.limb[i - At] : beyond) & mask;
    const DoubleLimb sum = DoubleLimb{to.limb[i]} + (Negative ? ~digit : digit) + carry;
    to.limb[i] = static_cast<std::uint64_t>(sum);
    carry = static_cast<std::uint64_t>(sum >> 64);
  }
}

template <std::size_t N, std::size_t M>
inline void add(Wide<N>& to, const Wide<M>& what) {
  static_assert(N >= M);
  add_limbs<0, false>(to, what, ~std::uint64_t{0}, what.sign_mask());
}
template <std::size_t N, std::size_t M>
inline void subtract(Wide<N>& from, const Wide<M>& what) {
  static_assert(N >= M);
  add_limbs<0, true>(from, what, ~std::uint64_t{0}, what.sign_mask());
}

template <std::size_t A, std::size_t B>
inline Wide<A + B> product(const Wide<A>& a, const Wide<B>& b) {
  Wide<A + B> result;
  for (std::size_t i = 0; i < A; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < B; ++j) {
      const DoubleLimb sum = DoubleLimb{a.limb[i]} * b.limb[j] + result.limb[i + j] + carry;
      result.limb[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    result.limb[i + B] = carry;
  }
  // Correction for negative factors: read as unsigned, each is 2^(64 limbs) too large.
  add_limbs<A, true>(result, b, a.sign_mask(), 0);
  add_limbs<B, true>(result, a, b.sign_mask(), 0);
  return result;
}

template <std::size_t N, std::size_t A, std::size_t B>
inline void add_product(Wide<N>& to, const Wide<A>& a, const Wide<B>& b) {
  add(to, product(a, b));
}
template <std::size_t N, std::size_t A, std::size_t B>
inline void subtract_product(Wide<N>& from, const Wide<A>& a, const Wide<B>& b) {
  subtract(from, product(a, b));
}
template <std::size_t N>
inline void set_zero(Wide<N>& number) {
  number = {};
}

// x / 2^grid, where that is an integer of at most 64 N - 1 bits.
template <std::size_t N>
inline void set_scaled(Wide<N>& to, double x, int grid) {
  constexpr int kMantissaBits = 53;
  int exponent = 0;
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(x), &exponent), kMantissaBits));
  int shift = exponent - kMantissaBits - grid;
  if (x == 0) shift = 0;
  if (shift < 0) {
    mantissa >>= -shift;  // zeros
    shift = 0;
  }
  Wide<N> magnitude;
  const auto first = static_cast<std::size_t>(shift / 64);
  const int within = shift % 64;
  magnitude.limb[first] = mantissa << within;
  if (first + 1 < N && within != 0) magnitude.limb[first + 1] = mantissa >> (64 - within);
  to = {};
  if (std::signbit(x)) {
    subtract(to, magnitude);
  } else {
    to = magnitude;
  }
}

}  // namespace fdcg::bake
