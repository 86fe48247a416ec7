// SPDX-License-Identifier: Apache-2.0
// Eight floats at once: two SIMD vectors of four, where the processor has them (FDCG_HAS_VECTORS). Every operation is the IEEE
// one on each lane, so that the bits do not depend on the implementation.
#pragma once

#include <stdint.h>
#include <string.h>

#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector) && __has_builtin(__builtin_convertvector) && \
    (defined(__SSE2__) || defined(__ARM_NEON)) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
#define FDCG_HAS_VECTORS 1
#endif
#endif
#ifndef FDCG_HAS_VECTORS
#define FDCG_HAS_VECTORS 0
#endif

namespace fdcg {

inline constexpr uint32_t kLanes = 8;

#if FDCG_HAS_VECTORS

struct Lanes {
  using Floats = float __attribute__((vector_size(16)));
  using Words = int32_t __attribute__((vector_size(16)));
  using Halves = uint16_t __attribute__((vector_size(16)));
  using Bytes = uint8_t __attribute__((vector_size(16)));
  using Doublewords = uint64_t __attribute__((vector_size(16)));

  Floats low, high;

  static Lanes all(float x) { return {Floats{x, x, x, x}, Floats{x, x, x, x}}; }
  static Lanes of(const uint8_t (&numbers)[kLanes]) {
    uint64_t word;  // by way of an integer: a partial store to a vector in memory would stall the load
    memcpy(&word, numbers, sizeof word);
    const Bytes bytes = reinterpret_cast<Bytes>(Doublewords{word, 0}), none = {};
    const Halves halves =
        reinterpret_cast<Halves>(__builtin_shufflevector(bytes, none, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
    const Halves no_halves = {};
    const Halves first = __builtin_shufflevector(halves, no_halves, 0, 8, 1, 9, 2, 10, 3, 11);
    const Halves last = __builtin_shufflevector(halves, no_halves, 4, 12, 5, 13, 6, 14, 7, 15);
    return {__builtin_convertvector(reinterpret_cast<Words>(first), Floats),
            __builtin_convertvector(reinterpret_cast<Words>(last), Floats)};
  }
  void store(float (&to)[kLanes]) const { memcpy(to, this, sizeof to); }

  friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
  friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
#if defined(__SSE2__)  // these instructions give b too where the two compare equal
  friend Lanes greater(Lanes a, Lanes b) {
    return {__builtin_ia32_maxps(a.low, b.low), __builtin_ia32_maxps(a.high, b.high)};
  }
  friend Lanes lesser(Lanes a, Lanes b) {
    return {__builtin_ia32_minps(a.low, b.low), __builtin_ia32_minps(a.high, b.high)};
  }
#else
  friend Lanes greater(Lanes a, Lanes b) {
    return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
  }
  friend Lanes lesser(Lanes a, Lanes b) {
    return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
  }
#endif
  // A bit for each lane in which a <= b.
  friend uint32_t where_at_most(Lanes a, Lanes b) {
    const Words low_words = a.low <= b.low, high_words = a.high <= b.high;
#if defined(__SSE2__)
    return static_cast<uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Floats>(low_words)) |
                                 __builtin_ia32_movmskps(reinterpret_cast<Floats>(high_words)) << 4);
#else
    const Words bits = (low_words & Words{1, 2, 4, 8}) | (high_words & Words{16, 32, 64, 128});
    return static_cast<uint32_t>(bits[0] | bits[1] | bits[2] | bits[3]);
#endif
  }
};

#endif

}  // namespace fdcg
