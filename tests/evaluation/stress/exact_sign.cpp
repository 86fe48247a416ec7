// SPDX-License-Identifier: Apache-2.0
// Stage by stage, each dearer than the one before, after Shewchuk (1997, "Adaptive precision floating-point arithmetic"): the
// rounded determinant; that of the rounded differences, exactly; where those were not exact, with what they lost to first
// order; CGAL. HIPs on planes, edges and corners end in the second, but for one in a few hundred.
#include "exact_sign.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fdcg::test {
namespace {

// Of the products' absolute sum: what rounding may move the determinant by (his bounds A; B and C a little wider).
constexpr double kUnit = 0x1p-53, kBoundA = (7 + 56 * kUnit) * kUnit, kBoundB = (4 + 64 * kUnit) * kUnit,
                 kBoundC = (32 + 256 * kUnit) * kUnit * kUnit;
constexpr double kLeast = 1e-200, kMost = 1e90;  // products of three neither underflow nor overflow

struct Pair {  // high + low, exactly
  double high, low;
};
Pair exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a, of_a = sum - of_b;
  return {sum, (a - of_a) + (b - of_b)};
}
Pair exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}
double lost_by_difference(double a, double b, double difference) {
  const double of_b = a - difference, of_a = difference + of_b;
  return (a - of_a) + (of_b - b);
}

// A number as a sum of doubles that do not overlap, the smallest first: its sign is that of the last.
template <int kCapacity>
struct Sum {
  std::array<double, kCapacity> part;
  int count = 0;

  // Exact while there is room.
  void add(double x) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const Pair pair = exact_sum(x, part[static_cast<std::size_t>(i)]);
      x = pair.high;
      if (pair.low != 0) part[static_cast<std::size_t>(kept++)] = pair.low;
    }
    if (x != 0) part[static_cast<std::size_t>(kept++)] = x;
    count = kept;
  }
  [[nodiscard]] double rounded() const {
    double sum = 0;
    for (int i = 0; i < count; ++i)
      sum += part[static_cast<std::size_t>(i)];
    return sum;
  }
  [[nodiscard]] int sign() const { return count == 0 ? 0 : part[static_cast<std::size_t>(count - 1)] > 0 ? 1 : -1; }
};

// a b - c d
Sum<4> exact_minor(double a, double b, double c, double d) {
  const Pair ab = exact_product(a, b), cd = exact_product(c, d);
  Sum<4> sum;
  for (const double x : {ab.low, -cd.low, ab.high, -cd.high})
    sum.add(x);
  return sum;
}

void add_product(const Sum<4>& minor, double factor, Sum<24>& total) {
  for (int i = 0; i < minor.count; ++i) {
    const Pair product = exact_product(minor.part[static_cast<std::size_t>(i)], factor);
    total.add(product.low);
    total.add(product.high);
  }
}

int by_interval_and_exactly(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  return CGAL::orientation(Point(a[0], a[1], a[2]), Point(b[0], b[1], b[2]), Point(c[0], c[1], c[2]), Point(d[0], d[1], d[2]));
}

// `size`: the products' absolute sum.
[[gnu::noinline]] int by_expansion(const Hip& a, const Hip& b, const Hip& c, const Hip& d, double size) {
  if (a == d || b == d || c == d || a == b || b == c || a == c) return 0;
  double far = 0, near = kMost;  // of the differences and what they lost, zeros aside
  const auto note = [&](double x) {
    far = std::max(far, std::abs(x));
    if (x != 0) near = std::min(near, std::abs(x));
  };
  Hip u, v, w, u_lost, v_lost, w_lost;
  bool is_whole = true;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i], v[i] = c[i] - a[i], w[i] = d[i] - a[i];
    u_lost[i] = lost_by_difference(b[i], a[i], u[i]);
    v_lost[i] = lost_by_difference(c[i], a[i], v[i]);
    w_lost[i] = lost_by_difference(d[i], a[i], w[i]);
    for (const double x : {u[i], v[i], w[i]})
      note(x);
    is_whole = is_whole && u_lost[i] == 0 && v_lost[i] == 0 && w_lost[i] == 0;
  }
  constexpr double kLeastFactor = 1e-45;  // a product of three loses no bit below the smallest normal number
  if (far > kMost || near < kLeastFactor) return by_interval_and_exactly(a, b, c, d);
  Sum<24> total;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    add_product(exact_minor(u[j], v[k], u[k], v[j]), w[i], total);
  }
  if (is_whole) return total.sign();
  const double det = total.rounded();
  if (std::abs(det) > kBoundB * size) return det > 0 ? 1 : -1;
  double lost = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    lost += w[i] * ((u[j] * v_lost[k] + v[k] * u_lost[j]) - (u[k] * v_lost[j] + v[j] * u_lost[k]));
    lost += w_lost[i] * (u[j] * v[k] - u[k] * v[j]);
  }
  const double corrected = det + lost;
  if (std::abs(corrected) > kBoundC * size + 4 * kUnit * std::abs(det)) return corrected > 0 ? 1 : -1;
  return by_interval_and_exactly(a, b, c, d);
}

}  // namespace

int exact_sign(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  const double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
  const double x0 = uy * vz, x1 = uz * vy, y0 = uz * vx, y1 = ux * vz, z0 = ux * vy, z1 = uy * vx;
  const double sum = (x0 - x1) * wx + (y0 - y1) * wy + (z0 - z1) * wz;
  const double size = (std::abs(x0) + std::abs(x1)) * std::abs(wx) + (std::abs(y0) + std::abs(y1)) * std::abs(wy) +
                      (std::abs(z0) + std::abs(z1)) * std::abs(wz);
  if (size > kLeast && std::abs(sum) > kBoundA * size) return sum > 0 ? 1 : -1;
  return by_expansion(a, b, c, d, size);
}

}  // namespace fdcg::test
