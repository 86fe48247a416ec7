// SPDX-License-Identifier: Apache-2.0
// Stages of the orientation test. A floating-point filter decides where rounding cannot matter. Otherwise equal points, and
// four points with a common coordinate, are coplanar. For others the determinant is evaluated in double-double arithmetic,
// which decides unless the points are within 2^-98 of their size of a plane. For those, the twelve coordinates are integer
// multiples of one small unit, and the determinant is evaluated in integers: of machine size where the coordinates are of
// similar magnitude, else of as many limbs as needed.
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

// From the largest coordinate that a step accepts (vec.hpp, kFar: 2^233) down to the last bit of the smallest double, with
// two bits for the difference of two.
constexpr int kLargestBits = 234 + 1074 + 2;
constexpr int kLimbs = kLargestBits / kLimbBits + 1;

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

// An integer: sign and magnitude, lowest limb first, no leading zero limb. Where its limbs are is its owner's business (Room),
// so that one routine serves all sizes.
struct Whole {
  Limb* const limb;
  int count = 0;
  bool is_negative = false;

  explicit Whole(Limb* limbs) : limb(limbs) {}
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;
  void trim() {
    while (count > 0 && limb[count - 1] == 0)
      --count;
  }
};
template <int kCapacity>
struct Room : Whole {
  Limb limbs[kCapacity];

  Room() : Whole(limbs) {}
};

// A double as mantissa * 2^exponent, the mantissa odd or zero.
struct Parts {
  uint64_t mantissa;
  int exponent;
  bool is_negative;
};

[[gnu::cold]] Parts parts_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  const int biased = static_cast<int>(bits >> 52 & 0x7FF);
  uint64_t mantissa = bits & ((uint64_t{1} << 52) - 1);
  if (biased != 0) mantissa |= uint64_t{1} << 52;
  if (mantissa == 0) return {0, 0, false};
  const int zeros = __builtin_ctzll(mantissa);
  return {mantissa >> zeros, (biased != 0 ? biased : 1) - 1075 + zeros, bits >> 63 != 0};
}

// parts / 2^unit, which is an integer.
[[gnu::cold]] void read_whole(const Parts& parts, int unit, Whole& w) {
  w.count = 0;
  w.is_negative = parts.is_negative;
  if (parts.mantissa == 0) return;
  const int shift = parts.exponent - unit;
  int bit = shift % kLimbBits;
  for (; w.count < shift / kLimbBits; ++w.count)
    w.limb[w.count] = 0;
  for (uint64_t rest = parts.mantissa; rest != 0; bit = 0) {
    w.limb[w.count++] = static_cast<Limb>(rest << bit);
    const int taken = kLimbBits - bit;
    rest = taken < 64 ? rest >> taken : 0;
  }
}

// The sign of |a| - |b|.
[[gnu::cold]] int compare_sizes(const Whole& a, const Whole& b) {
  if (a.count != b.count) return a.count < b.count ? -1 : 1;
  for (int i = a.count; i-- > 0;) {
    if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
  }
  return 0;
}

// r = a - b: limb by limb the larger size plus or minus the smaller. r has room for one limb more than either, and is neither.
[[gnu::cold]] void subtract(const Whole& a, const Whole& b, Whole& r) {
  const bool is_sum = a.is_negative != b.is_negative, is_a_larger = compare_sizes(a, b) >= 0;
  const Whole &large = is_a_larger ? a : b, &small = is_a_larger ? b : a;
  const Limb flip = is_sum ? 0 : ~Limb{0};
  TwoLimbs carry = is_sum ? 0 : 1;  // a difference is a sum with the complement, and one
  r.is_negative = is_a_larger ? a.is_negative : !b.is_negative;
  for (r.count = 0; r.count < large.count; ++r.count) {
    carry += static_cast<TwoLimbs>(large.limb[r.count]) + ((r.count < small.count ? small.limb[r.count] : Limb{0}) ^ flip);
    r.limb[r.count] = static_cast<Limb>(carry);
    carry >>= kLimbBits;
  }
  if (is_sum && carry != 0) r.limb[r.count++] = static_cast<Limb>(carry);
  r.trim();
}

// r = a b; r has room for both, and is neither.
[[gnu::cold]] void multiply(const Whole& a, const Whole& b, Whole& r) {
  r.is_negative = a.is_negative != b.is_negative;
  r.count = a.count + b.count;
  for (int i = 0; i < r.count; ++i)
    r.limb[i] = 0;
  for (int i = 0; i < a.count; ++i) {
    TwoLimbs carry = 0;
    for (int j = 0; j < b.count; ++j) {
      carry += static_cast<TwoLimbs>(a.limb[i]) * b.limb[j] + r.limb[i + j];
      r.limb[i + j] = static_cast<Limb>(carry);
      carry >>= kLimbBits;
    }
    r.limb[i + b.count] = static_cast<Limb>(carry);
  }
  r.trim();
}

// Four points, where they are.
using FourPoints = const Vec3<double>* const (&)[4];

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
    const double x[3] = {point[p]->x, point[p]->y, point[p]->z};
    for (int k = 0; k < 3; ++k) {
      const Parts part = m.part[p][k] = parts_of(x[k]);
      if (part.mantissa == 0) continue;
      const int end = part.exponent + 64 - __builtin_clzll(part.mantissa);
      if (part.exponent < m.unit) m.unit = part.exponent;
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

[[gnu::noinline, gnu::cold]] int sign_in_limbs(const Multiples& m) {
  constexpr int kEdge = kLimbs + 1, kMinor = 2 * kEdge + 1, kProduct = kMinor + kEdge;
  Room<kEdge> edge[3][3];  // from the first point to each other
  for (int k = 0; k < 3; ++k) {
    Room<kLimbs> first, other;
    read_whole(m.part[0][k], m.unit, first);
    for (int p = 0; p < 3; ++p) {
      read_whole(m.part[p + 1][k], m.unit, other);
      subtract(other, first, edge[p][k]);
    }
  }
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  Room<kProduct + 1> sum[2];  // in turns
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    Room<2 * kEdge> first, second;
    Room<kMinor> minor;
    Room<kProduct> term;
    multiply(u[i], v[j], first);
    multiply(u[j], v[i], second);
    subtract(second, first, minor);
    multiply(minor, w[k], term);
    subtract(sum[k & 1], term, sum[1 - (k & 1)]);
  }
  const Whole& determinant = sum[1];
  if (determinant.count == 0) return 0;
  return determinant.is_negative ? -1 : 1;
}

// The determinant, with an error of at most 2^-98 of the size of its products.
[[gnu::noinline, gnu::cold]] double determinant_in_pairs(FourPoints point) {
  Split edge[3][3];
  for (int p = 0; p < 3; ++p) {
    const Vec3<double>&to = *point[p + 1], &from = *point[0];
    edge[p][0] = exact_sum(to.x, -from.x);
    edge[p][1] = exact_sum(to.y, -from.y);
    edge[p][2] = exact_sum(to.z, -from.z);
  }
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  Split sum = {0, 0};
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    sum = sum + (u[i] * v[j] - u[j] * v[i]) * w[k];
  }
  return sum.value;
}

inline bool are_same(double a, double b, double c, double d) {
  return a == b && a == c && a == d;
}

// Trivially coplanar points: a segment that begins in a corner touches all its edges there, and meshes have axis-aligned
// planes.
inline bool is_plainly_flat(FourPoints point) {
  const auto &a = *point[0], &b = *point[1], &c = *point[2], &d = *point[3];
  for (int i = 1; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      if (point[i]->x == point[j]->x && point[i]->y == point[j]->y && point[i]->z == point[j]->z) return true;
    }
  }
  return are_same(a.x, b.x, c.x, d.x) || are_same(a.y, b.y, c.y, d.y) || are_same(a.z, b.z, c.z, d.z);
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
