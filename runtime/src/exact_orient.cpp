// SPDX-License-Identifier: Apache-2.0
#include "exact_orient.hpp"

namespace fdcg {
namespace {

// A sum of doubles, smallest first, none of which overlaps the next: its value is exact, its sign that of the last part.
template <int kCapacity>
struct Expansion {
  double part[kCapacity];
  int count = 0;

  void append(double p) {
    if (p != 0) part[count++] = p;
  }
  [[nodiscard]] int sign() const {
    if (count == 0) return 0;
    return part[count - 1] > 0 ? 1 : -1;
  }
};

struct TwoParts {
  double high, low;  // high + low is exact
};

TwoParts two_sum(double a, double b) {
  const double s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

TwoParts split(double a) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1: halves of 26 bits, whose products are exact
  const double t = kSplitter * a, high = t - (t - a);
  return {high, a - high};
}

TwoParts two_product(double a, double b) {
  const double p = a * b;
  const TwoParts x = split(a), y = split(b);
  return {p, x.low * y.low - (((p - x.high * y.high) - x.low * y.high) - x.high * y.low)};
}

Expansion<2> difference(double a, double b) {
  const TwoParts d = two_sum(a, -b);
  Expansion<2> e;
  e.append(d.low);
  e.append(d.high);
  return e;
}

// Adds one number to a growing expansion (Shewchuk's GROW-EXPANSION, zeros dropped).
template <int kCapacity>
void grow(Expansion<kCapacity>& e, double b) {
  double q = b;
  int kept = 0;
  for (int i = 0; i < e.count; ++i) {
    const TwoParts s = two_sum(q, e.part[i]);
    q = s.high;
    if (s.low != 0) e.part[kept++] = s.low;
  }
  e.count = kept;
  e.append(q);
}

template <int A, int B>
Expansion<A + B> sum(const Expansion<A>& a, const Expansion<B>& b, double sign_of_b) {
  Expansion<A + B> e;
  for (int i = 0; i < a.count; ++i)
    e.part[i] = a.part[i];
  e.count = a.count;
  for (int i = 0; i < b.count; ++i)
    grow(e, sign_of_b * b.part[i]);
  return e;
}

template <int A, int B>
Expansion<2 * A * B> product(const Expansion<A>& a, const Expansion<B>& b) {
  Expansion<2 * A * B> e;
  for (int i = 0; i < a.count; ++i) {
    for (int j = 0; j < b.count; ++j) {
      const TwoParts p = two_product(a.part[i], b.part[j]);
      if (p.low != 0) grow(e, p.low);
      grow(e, p.high);
    }
  }
  return e;
}

int exact_sign(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, const Vec3<double>& d) {
  const auto ux = difference(b.x, a.x), uy = difference(b.y, a.y), uz = difference(b.z, a.z);
  const auto vx = difference(c.x, a.x), vy = difference(c.y, a.y), vz = difference(c.z, a.z);
  const auto wx = difference(d.x, a.x), wy = difference(d.y, a.y), wz = difference(d.z, a.z);
  const auto nx = sum(product(uy, vz), product(uz, vy), -1.0);
  const auto ny = sum(product(uz, vx), product(ux, vz), -1.0);
  const auto nz = sum(product(ux, vy), product(uy, vx), -1.0);
  return sum(sum(product(nx, wx), product(ny, wy), 1.0), product(nz, wz), 1.0).sign();
}

}  // namespace

int orient3d_sign(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, const Vec3<double>& d) {
  const Vec3<double> u = b - a, v = c - a, w = d - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
  const double det = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double size = (fabs(yz) + fabs(zy)) * fabs(w.x) + (fabs(zx) + fabs(xz)) * fabs(w.y) + (fabs(xy) + fabs(yx)) * fabs(w.z);
  // Three differences, two products and three sums, each off by half an epsilon at most: under 7/2 epsilon of the size.
  constexpr double kErrorBound = 4 * DBL_EPSILON;
  if (det > kErrorBound * size) return 1;
  if (det < -kErrorBound * size) return -1;
  return exact_sign(a, b, c, d);
}

}  // namespace fdcg
