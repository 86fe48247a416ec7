// SPDX-License-Identifier: Apache-2.0
// Stages of the orientation test. A floating-point filter decides where rounding cannot matter. Otherwise equal points, and
// four points with a common coordinate, are coplanar. For others the determinant is evaluated in double-double arithmetic,
// which decides unless the points are within 2^-98 of their size of a plane. For those, the twelve coordinates are integer
// multiples of one small unit, and the determinant is evaluated in integers: of machine size where the coordinates are of
// similar magnitude, else as sums of products in as many limbs as needed.
#include "exact/exact_orient.hpp"

#include <string.h>

#include "base/mutation.hpp"
#include "base/work.hpp"
#include "shared/error_free.hpp"

namespace fdcg {
namespace {

// Bound on the underflow error of products, times a coordinate of 1e70: under 1e-252.
constexpr double kUnderflow = 1e-250;

#ifdef __SIZEOF_INT128__
using Limb = uint64_t;
__extension__ using TwoLimbs = unsigned __int128;
#else
using Limb = uint32_t;
using TwoLimbs = uint64_t;
#endif
constexpr int kLimbBits = 8 * sizeof(Limb);

// Products and sums of Splits err by 2^-101 of the terms' sizes at most, where no part falls below the normal numbers.
inline Split joined(double high, double low) {
  const double sum = high + low;
  return {sum, low - (sum - high)};
}

inline Split operator*(Split a, Split b) {
  const Split product = exact_product(a.value, b.value);
  return joined(product.value, product.rest + (a.value * b.rest + a.rest * b.value));
}
inline Split operator+(Split a, Split b) {
  const Split sum = exact_sum(a.value, b.value);
  return joined(sum.value, sum.rest + (a.rest + b.rest));
}
inline Split operator-(Split a, Split b) {
  return a + Split{-b.value, -b.rest};
}

// A double as mantissa * 2^exponent, the mantissa odd, or zero: then the exponent is not set.
struct Parts {
  uint64_t mantissa;
  int exponent;
  bool is_negative;
};

// Four points, where they are.
using FourPoints = const Vec3<double>* const (&)[4];

// To go through coordinates, by copies of the code where it is not made small.
#ifdef __OPTIMIZE_SIZE__
constexpr int kUnrolled = 1;
#else
constexpr int kUnrolled = 3;
#endif
static_assert(sizeof(Vec3<double>) == 3 * sizeof(double));
inline const double* numbers_of(const Vec3<double>& point) {
  return reinterpret_cast<const double*>(&point);
}

// Four points in multiples of 2^unit.
struct Multiples {
  Parts part[4][3];
  int unit;
  int bits;  // of the largest
};

[[gnu::noinline, gnu::cold]] Multiples multiples_of(FourPoints point) {
  Multiples m;
  m.unit = 4096;  // larger than any exponent
  int top = -4096;
  for (int p = 0; p < 4; ++p) {
    for (int k = 0; k < 3; ++k) {
      Parts& part = m.part[p][k];
      uint64_t bits;
      memcpy(&bits, numbers_of(*point[p]) + k, sizeof bits);
      int exponent = static_cast<int>(bits >> 52 & 0x7FF);
      part.is_negative = bits >> 63 != 0;
      part.mantissa = bits & ((uint64_t{1} << 52) - 1);
      if (exponent != 0) {
        part.mantissa |= uint64_t{1} << 52;
      } else {
        exponent = 1;
      }
      if (part.mantissa == 0) continue;
      const int zeros = __builtin_ctzll(part.mantissa);
      exponent += 64 - 1075;
      const int end = exponent - __builtin_clzll(part.mantissa);
      part.mantissa >>= zeros;
      part.exponent = exponent += zeros - 64;
      if (exponent < m.unit) m.unit = exponent;
      if (end > top) top = end;
    }
  }
  m.bits = top - m.unit;
  return m;
}

// With 60 bits a coordinate has, differences have 61, two-by-two minors 123, and the determinant 186: a sum of high and low
// halves, of at most 126 bits each. Work is counted by it on every processor, so that all reach a step's bound at one place.
constexpr int kWordBits = 60;

#ifdef __SIZEOF_INT128__
[[gnu::noinline, gnu::cold]] int sign_in_words(const Multiples& m) {
  __extension__ using Wide = __int128;
  int64_t edge[3][3];
  for (int k = 0; k < 3; ++k) {
    const auto whole = [&](int p) {
      const Parts& part = m.part[p][k];
      const auto size = static_cast<int64_t>(part.mantissa << (part.mantissa != 0 ? part.exponent - m.unit : 0));
      return part.is_negative ? -size : size;
    };
    for (int p = 0; p < 3; ++p)
      edge[p][k] = whole(p + 1) - whole(0);
  }
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  Wide high = 0, low = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    const Wide minor = static_cast<Wide>(u[i]) * v[j] - static_cast<Wide>(u[j]) * v[i];
    high += (minor >> 64) * w[k];
    low += static_cast<Wide>(static_cast<uint64_t>(minor)) * w[k];
  }
  high += low >> 64;
  if (high != 0) return high < 0 ? -1 : 1;
  return static_cast<uint64_t>(low) != 0 ? 1 : 0;
}
#endif

// Bits of a product of three coordinates, from the largest that a step accepts (vec.hpp, kFar: 2^233) down to the last bit of
// the smallest double, and of the sum of 24.
constexpr int kMostBits = 3 * (234 + 1074) + 5;
constexpr int kMantissaBits = 53;
constexpr unsigned limbs_of(unsigned bits) {
  return bits / kLimbBits + 1;
}

// to += a b: a of up to `count` limbs, lowest first, not zero. `to` has room for all of a b, and for the carry as far as it
// goes.
[[gnu::noinline, gnu::cold]] void add_product(const Limb* a, unsigned count, uint64_t b, Limb* to) {
  while (a[count - 1] == 0)
    --count;
  for (; b != 0; ++to) {
    TwoLimbs carry = 0;
    for (unsigned i = 0; i < count || carry != 0; ++i) {
      carry += to[i];
      if (i < count) carry += static_cast<TwoLimbs>(a[i]) * static_cast<Limb>(b);
      to[i] = static_cast<Limb>(carry);
      carry >>= kLimbBits;
    }
    b = kLimbBits < 64 ? b >> kLimbBits % 64 : 0;
  }
}

// The determinant of four rows (x, y, z, 1): x of one point times y of another times z of a third, in all 24 orders of the
// points. What is above zero and what is below is added up apart, and the two sums are compared.
[[gnu::noinline, gnu::cold]] int sign_in_limbs(const Multiples& m) {
  constexpr unsigned kFirst = limbs_of(kLimbBits - 1 + kMantissaBits), kSecond = limbs_of(kLimbBits - 1 + 2 * kMantissaBits);
  constexpr unsigned kThird = limbs_of(kLimbBits - 1 + 3 * kMantissaBits);
  Limb sum[2][limbs_of(kMostBits) + kThird];
  const unsigned count = limbs_of(3 * static_cast<unsigned>(m.bits) + 5) + kThird;
  for (unsigned i = 0; i < count; ++i)
    sum[0][i] = sum[1][i] = 0;
  const Parts* point[4] = {m.part[0], m.part[1], m.part[2], m.part[3]};
  for (unsigned n = 0; n < 24; ++n) {
    const Parts &x = point[0][0], &y = point[1][1], &z = point[2][2];
    if ((x.mantissa & y.mantissa & z.mantissa) != 0) {  // odd, each
      const unsigned shift = static_cast<unsigned>(x.exponent + y.exponent + z.exponent - 3 * m.unit);
      const Limb bit = Limb{1} << shift % kLimbBits;
      Limb first[kFirst] = {}, second[kSecond] = {};
      add_product(&bit, 1, x.mantissa, first);
      add_product(first, kFirst, y.mantissa, second);
      const unsigned is_above = (n ^ x.is_negative ^ y.is_negative ^ z.is_negative) & 1;
      add_product(second, kSecond, z.mantissa, sum[is_above] + shift / kLimbBits);
    }
    // The next order, by an exchange of neighbours ("plain changes"), which changes the sign.
    const unsigned at = 0x2486u >> 2 * (n % 8) & 3;  // 2, 1, 0, 2, 0, 1, 2, 0
    const Parts* const other = point[at];
    point[at] = point[at + 1];
    point[at + 1] = other;
  }
  for (unsigned i = count; i-- > 0;) {
    if (sum[0][i] != sum[1][i]) return sum[0][i] < sum[1][i] ? 1 : -1;
  }
  return 0;
}

// The determinant, with an error of at most 2^-98 of the size of its products.
[[gnu::noinline, gnu::cold]] double determinant_in_pairs(FourPoints point) {
  Split edge[3][3];
  for (int p = 0; p < 3; ++p) {
    const double *to = numbers_of(*point[p + 1]), *from = numbers_of(*point[0]);
#pragma GCC unroll kUnrolled
    for (int k = 0; k < 3; ++k)
      edge[p][k] = exact_sum(to[k], -from[k]);
  }
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  Split sum = {0, 0};
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    sum = sum + (u[i] * v[j] - u[j] * v[i]) * w[k];
  }
  return sum.value;
}

// Trivially coplanar points: a segment that begins in a corner touches all its edges there, and meshes have axis-aligned
// planes.
inline bool is_plainly_flat(FourPoints point) {
  for (int i = 1; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      if (point[i]->x == point[j]->x && point[i]->y == point[j]->y && point[i]->z == point[j]->z) return true;
    }
  }
#pragma GCC unroll kUnrolled
  for (int k = 0; k < 3; ++k) {
    const double first = numbers_of(*point[0])[k];
    if (first == numbers_of(*point[1])[k] && first == numbers_of(*point[2])[k] && first == numbers_of(*point[3])[k])
      return true;
  }
  return false;
}

// `bound`: of the filter, 4 epsilons of the products' size.
[[gnu::noinline, gnu::cold]] int exact_sign(FourPoints point, double bound, uint32_t* work_left) {
  if (is_plainly_flat(point)) return 0;
  if (work_left != nullptr) spend(work_left, kPairsWork);
  constexpr double kOfFilter = 0x1p-48;  // 2^-98 of the size
  const double det = determinant_in_pairs(point), least = kOfFilter * bound + kUnderflow;
  if (det > least) return 1;
  if (det < -least) return -1;
  const Multiples m = multiples_of(point);
  const bool is_narrow = m.bits <= kWordBits;
  if (work_left != nullptr) spend(work_left, is_narrow ? kExactWork : kLongExactWork);
#ifdef __SIZEOF_INT128__
  if (is_narrow) return sign_in_words(m);
#endif
  return sign_in_limbs(m);
}

}  // namespace

int orient3d_sign(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, const Vec3<double>& d,
                  uint32_t* work_left) {
  const Vec3<double> u = b - a, v = c - a, w = d - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
  const double det = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double size = (fabs(yz) + fabs(zy)) * fabs(w.x) + (fabs(zx) + fabs(xz)) * fabs(w.y) + (fabs(xy) + fabs(yx)) * fabs(w.z);
  // Three differences, two products and three sums, each with an error of half an epsilon: under 7/2 epsilon of the size.
  constexpr double kErrorBound = 4 * DBL_EPSILON;
  const double bound = kErrorBound * size + kUnderflow;
  if (det > bound) return 1;
  if (det < -bound) return -1;
  if (FDCG_MUTANT("watertight")) return det > 0 ? 1 : (det < 0 ? -1 : 0);
  return exact_sign({&a, &b, &c, &d}, bound, work_left);
}

}  // namespace fdcg
