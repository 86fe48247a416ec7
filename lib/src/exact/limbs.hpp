// SPDX-License-Identifier: Apache-2.0
// Whole numbers of a fixed width: several times as fast as arbitrary precision while they are short.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fdcg::bake {

// N digits of 64 bits, lowest first; arithmetic is modulo 2^(64 N). Where a number is signed, that is two's complement.
template <std::size_t N>
using Limbs = std::array<std::uint64_t, N>;

__extension__ using DoubleLimb = unsigned __int128;
__extension__ using SignedDoubleLimb = __int128;

// All ones where the signed number is below zero.
template <std::size_t N>
inline std::uint64_t sign_mask(const Limbs<N>& a) {
  return 0 - (a[N - 1] >> 63);
}

// to += what * 2^(64 At).
template <std::size_t At, std::size_t N, std::size_t M>
inline void add(Limbs<N>& to, const Limbs<M>& what) {
  static_assert(At + M <= N);
  std::uint64_t carry = 0;
  for (std::size_t i = At; i < N; ++i) {
    const DoubleLimb sum = DoubleLimb{to[i]} + (i - At < M ? what[i - At] : 0) + carry;
    to[i] = static_cast<std::uint64_t>(sum);
    carry = static_cast<std::uint64_t>(sum >> 64);
  }
}

// from -= (what & mask) * 2^(64 At).
template <std::size_t At, std::size_t N, std::size_t M>
inline void subtract(Limbs<N>& from, const Limbs<M>& what, std::uint64_t mask = ~std::uint64_t{0}) {
  static_assert(At + M <= N);
  std::uint64_t borrow = 0;
  for (std::size_t i = At; i < N; ++i) {
    const DoubleLimb difference = DoubleLimb{from[i]} - (i - At < M ? what[i - At] & mask : 0) - borrow;
    from[i] = static_cast<std::uint64_t>(difference);
    borrow = static_cast<std::uint64_t>(difference >> 64) & 1u;
  }
}

// |a|, given sign_mask(a).
template <std::size_t N>
inline Limbs<N> magnitude(const Limbs<N>& a, std::uint64_t mask) {
  Limbs<N> result{};
  std::uint64_t carry = mask & 1u;
  for (std::size_t i = 0; i < N; ++i) {
    const DoubleLimb sum = DoubleLimb{a[i] ^ mask} + carry;
    result[i] = static_cast<std::uint64_t>(sum);
    carry = static_cast<std::uint64_t>(sum >> 64);
  }
  return result;
}

// a * b, unsigned.
template <std::size_t A, std::size_t B>
inline Limbs<A + B> product(const Limbs<A>& a, const Limbs<B>& b) {
  Limbs<A + B> result{};
  for (std::size_t i = 0; i < A; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < B; ++j) {
      const DoubleLimb sum = DoubleLimb{a[i]} * b[j] + result[i + j] + carry;  // below 2^128
      result[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    result[i + B] = carry;
  }
  return result;
}

}  // namespace fdcg::bake
