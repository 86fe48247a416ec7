// SPDX-License-Identifier: Apache-2.0
// What verification asks most often, in vectors of 32 bytes: of four records of four numbers at a time, of the three sides of a
// triangle, of four connections, of a point. It tells that nothing is wrong; where something may be, the plain passes judge,
// and say what it is.
#pragma once

#include "base/avx2.hpp"
#include "base/lanes.hpp"
#include "fdcg/format.h"
#include "graph/connection_words.hpp"
#include "graph/unit_check.hpp"

#define FDCG_HAS_WIDE_CHECKS (FDCG_HAS_VECTORS && FDCG_MAY_HAVE_AVX2)

#if FDCG_HAS_WIDE_CHECKS
#define FDCG_WIDE FDCG_AVX2, gnu::always_inline

namespace fdcg {

template <class Real>
struct WideVectors;
template <>
struct WideVectors<double> {
  using Reals = double __attribute__((vector_size(32)));
  using Pair = double __attribute__((vector_size(16)));
  using Masks = int64_t __attribute__((vector_size(32)));
};
template <>
struct WideVectors<float> {
  using Reals = float __attribute__((vector_size(16)));
  using Pair = float __attribute__((vector_size(8)));
  using Masks = int32_t __attribute__((vector_size(16)));
};

// UnitCheck of four records at a time.
template <class Real>
class WideUnitCheck {
  using Reals = typename WideVectors<Real>::Reals;
  using Masks = typename WideVectors<Real>::Masks;

 public:
  [[FDCG_WIDE]] WideUnitCheck(Real above, Real most) : above_(Reals{} + above), most_(Reals{} + most) {}

  [[FDCG_WIDE]] void look_at(const Real* a, const Real* b, const Real* c, const Real* d) {
    const Reals ac01 = pair(a, c), ac23 = pair(a + 2, c + 2), bd01 = pair(b, d), bd23 = pair(b + 2, d + 2);
    const Reals x = evens(ac01, bd01), y = odds(ac01, bd01), z = evens(ac23, bd23), fourth = odds(ac23, bd23);
    const Reals length2 = x * x + y * y + z * z;
    holds_ &= (length2 > Reals{} + UnitRange<Real>::kLeast) & (length2 <= Reals{} + UnitRange<Real>::kMost) &
              (fourth > above_) & (fourth <= most_);
  }
  [[FDCG_WIDE]] bool holds() const { return (holds_[0] & holds_[1] & holds_[2] & holds_[3]) == -1; }

 private:
  [[FDCG_WIDE]] static Reals pair(const Real* a, const Real* b) {
    typename WideVectors<Real>::Pair first, second;
    memcpy(&first, a, sizeof first);
    memcpy(&second, b, sizeof second);
    return __builtin_shufflevector(first, second, 0, 1, 2, 3);
  }
  // In whatever order takes one instruction, the same for all four numbers.
  [[FDCG_WIDE]] static Reals evens(Reals a, Reals b) {
    if constexpr (sizeof(Real) == 8) return __builtin_shufflevector(a, b, 0, 4, 2, 6);
    return __builtin_shufflevector(a, b, 0, 2, 4, 6);
  }
  [[FDCG_WIDE]] static Reals odds(Reals a, Reals b) {
    if constexpr (sizeof(Real) == 8) return __builtin_shufflevector(a, b, 1, 5, 3, 7);
    return __builtin_shufflevector(a, b, 1, 3, 5, 7);
  }

  Reals above_, most_;
  Masks holds_ = Masks{} == Masks{};  // no bit of a lane where something was wrong
};

// Of `count` records that follow one another. Prefetches as many that follow.
template <class Real>
[[FDCG_AVX2, gnu::noinline]] bool are_units(const Real* numbers, uint64_t count, Real above, Real most) {
  constexpr uint64_t kLineReals = 64 / sizeof(Real);
  WideUnitCheck<Real> check(above, most);
  uint64_t left = count;
  for (; left >= 4; left -= 4, numbers += 16) {
    for (uint64_t line = 0; line < 16; line += kLineReals)
      prefetch(numbers + 4 * count + line);
    check.look_at(numbers, numbers + 4, numbers + 8, numbers + 12);
  }
  if (left != 0) {
    const Real* const last = numbers + 4 * (left - 1);
    check.look_at(numbers, left > 1 ? numbers + 4 : last, last, last);
  }
  return check.holds();
}

// The sides of triangles, of node `n` and those after it.
class TriangleCheck {
 public:
  [[FDCG_WIDE]] TriangleCheck(uint32_t n, const fdcg_connection* connections, uint32_t connection_count, uint32_t corner_count,
                              uint32_t node_count)
      : connections_(connections), node_count_(node_count) {
    // link, corner, across of each side; the last across is not in the vector
    const uint32_t links = connection_count > UINT32_MAX / 2 ? UINT32_MAX : 2 * connection_count - 1;
    const uint32_t corners = corner_count - 1, nodes = node_count - 1;
    const auto number = [](uint32_t x) { return static_cast<int>(x); };
    largest_ = _mm256_setr_epi32(number(links), number(corners), number(nodes), number(links), number(corners), number(nodes),
                                 number(links), number(corners));
    // as a connection's word has them: k as side of node 0 and of node 1; and node n
    side_ = _mm256_setr_epi32(0, 0, 0, 0x101, 0, 0x202, 0, 0);
    node_ = _mm256_add_epi32(side_, _mm256_setr_epi32(number(n), 0, number(n), 0, number(n), 0, 0, 0));
  }

  // False: not all sides lead to nodes, or something is out of range; they are left out then, for another to judge.
  [[FDCG_WIDE]] bool look_at(const fdcg_side (&sides)[3]) {
    const __m256i words = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&sides[0].link));
    const __m256i from_corner = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&sides[0].corner));
    const __m256i excess = _mm256_xor_si256(words, _mm256_min_epu32(words, largest_));
    const __m256i here = node_;
    node_ = _mm256_add_epi32(node_, _mm256_setr_epi32(1, 0, 1, 0, 1, 0, 0, 0));
    if (!_mm256_testz_si256(excess, excess) || sides[2].across >= node_count_) return false;
    // Side k in the k-th 64 bits from here on. Its link in the upper half, whose lowest bit tells which of the connection's
    // sides it is.
    const __m256i links = _mm256_permutevar8x32_epi32(words, _mm256_setr_epi32(0, 0, 3, 3, 6, 6, 7, 7));
    const __m256i is_second = _mm256_cmpgt_epi64(_mm256_setzero_si256(), _mm256_slli_epi32(links, 31));
    const __m256i across = _mm256_permutevar8x32_epi32(from_corner, _mm256_setr_epi32(1, 1, 4, 4, 7, 7, 0, 0));
    const __m256i expected = blend(here, _mm256_blend_epi32(across, side_, 0xAA), is_second);
    const __m256i compared = blend(_mm256_setr_epi32(-1, 0xFF, -1, 0xFF, -1, 0xFF, 0, 0),
                                   _mm256_setr_epi32(-1, 0xFF00, -1, 0xFF00, -1, 0xFF00, 0, 0), is_second);
    const __m256i connections =
        _mm256_setr_epi64x(connection_of(sides[0]), connection_of(sides[1]), connection_of(sides[2]), 0);
    faults_ = _mm256_or_si256(faults_, _mm256_and_si256(_mm256_xor_si256(connections, expected), compared));
    boundaries_ = _mm256_or_si256(boundaries_, _mm256_and_si256(connections, _mm256_srli_epi64(connections, 1)));
    seconds_ = _mm256_sub_epi64(seconds_, is_second);
    return true;
  }
  [[FDCG_WIDE]] bool holds() const {
    const __m256i boundary = _mm256_set1_epi64x(int64_t{1} << kTypeAt);
    return _mm256_testz_si256(faults_, faults_) && _mm256_testz_si256(boundaries_, boundary);
  }
  // Sides that their connections run against.
  [[FDCG_WIDE]] uint32_t seconds() const {
    uint64_t lanes[4];
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes), seconds_);
    return static_cast<uint32_t>(lanes[0] + lanes[1] + lanes[2]);
  }

 private:
  [[FDCG_WIDE]] static __m256i blend(__m256i first, __m256i second, __m256i is_second) {
    return _mm256_castpd_si256(
        _mm256_blendv_pd(_mm256_castsi256_pd(first), _mm256_castsi256_pd(second), _mm256_castsi256_pd(is_second)));
  }
  [[FDCG_WIDE]] int64_t connection_of(const fdcg_side& side) const {
    int64_t word;
    memcpy(&word, connections_ + (side.link >> 1), sizeof word);
    return word;
  }

  const fdcg_connection* connections_;
  uint32_t node_count_;
  __m256i largest_, side_, node_;
  __m256i faults_ = {}, boundaries_ = {}, seconds_ = {};
};

// look_at_words() of four connections at a time.
class WideWords {
  using Words = uint64_t __attribute__((vector_size(32)));

 public:
  [[FDCG_WIDE]] void look_at(const void* connections) {
    Words words;
    memcpy(&words, connections, sizeof words);
    sums_.look_at(words);
  }
  [[FDCG_WIDE]] ConnectionWords result(uint64_t count) const {
    return connection_words(any_of(sums_.any), any_of(sums_.pairs), sum_of(sums_.types), sum_of(sums_.uppers),
                            sum_of(sums_.boundaries), count);
  }

 private:
  [[FDCG_WIDE]] static uint64_t any_of(Words words) { return words[0] | words[1] | words[2] | words[3]; }
  [[FDCG_WIDE]] static uint64_t sum_of(Words words) { return words[0] + words[1] + words[2] + words[3]; }

  ConnectionSums<Words> sums_;
};

[[FDCG_AVX2]] inline ConnectionWords look_at_words_wide(const fdcg_connection* connections, uint64_t count) {
  WideWords words;
  uint64_t i = 0;
  for (; i + 4 <= count; i += 4) {
    prefetch(connections + i + count);
    words.look_at(connections + i);
  }
  fdcg_connection last[4] = {};
  memcpy(last, connections + i, (count - i) * sizeof *last);
  words.look_at(last);
  return words.result(count);
}

// Whether points lie within bounds.
class WidePointCheck {
 public:
  [[FDCG_WIDE]] WidePointCheck(const double (&low)[3], const double (&high)[3])
      : low_(_mm256_setr_pd(low[0], low[1], low[2], 0)), high_(_mm256_setr_pd(high[0], high[1], high[2], 0)) {}

  // Reads the record's next number too, whatever it is.
  [[FDCG_WIDE]] void look_at(const double* point) { look_at(_mm256_loadu_pd(point)); }
  [[FDCG_WIDE]] void look_at(const float* point) { look_at(_mm256_cvtps_pd(_mm_loadu_ps(point))); }
  [[FDCG_WIDE]] bool holds() const { return (_mm256_movemask_pd(holds_) & 7) == 7; }

 private:
  [[FDCG_WIDE]] void look_at(__m256d point) {
    holds_ =
        _mm256_and_pd(holds_, _mm256_and_pd(_mm256_cmp_pd(point, low_, _CMP_GE_OQ), _mm256_cmp_pd(point, high_, _CMP_LE_OQ)));
  }

  __m256d low_, high_, holds_ = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
};

}  // namespace fdcg

#endif
