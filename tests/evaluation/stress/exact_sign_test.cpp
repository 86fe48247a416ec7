// SPDX-License-Identifier: Apache-2.0
#include "exact_sign.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <array>
#include <cmath>

#include "catch.hpp"
#include "random.hpp"

using namespace fdcg::test;

namespace {

// Worked out in rational numbers.
int sign_in_rationals(const std::array<Hip, 4>& p) {
  using Number = CGAL::Exact_predicates_exact_constructions_kernel::FT;
  Number e[3][3];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t i = 0; i < 3; ++i)
      e[r][i] = Number(p[r + 1][i]) - Number(p[0][i]);
  }
  return CGAL::sign(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                    e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]));
}

// In one plane up to rounding error, or exactly; far away, small, of few bits, or as they come.
std::array<Hip, 4> nearly_flat(Random& random) {
  std::array<Hip, 4> p;
  const double size = std::exp2(random.uniform(-40, 40)),
               away = random.chance(0.5) ? 0 : size * std::exp2(random.uniform(0, 40));
  const bool is_coarse = random.chance(0.3);
  for (std::size_t k = 0; k < 3; ++k) {
    for (double& x : p[k])
      x = away + size * (is_coarse ? random.below(33) / 16.0 - 1 : random.uniform(-1, 1));
  }
  const double a = random.below(17) / 16.0, b = random.chance(0.4) ? 0 : random.unit();
  for (std::size_t i = 0; i < 3; ++i) {
    p[3][i] = p[0][i] + a * (p[1][i] - p[0][i]) + b * (p[2][i] - p[0][i]);
    for (std::uint32_t n = random.chance(0.5) ? random.below(3) : 0; n > 0; --n)
      p[3][i] = std::nextafter(p[3][i], random.chance(0.5) ? INFINITY : -INFINITY);
  }
  if (random.chance(0.1)) p[3] = p[random.below(3)];
  return p;
}

}  // namespace

TEST_CASE("the judge's sign of four points is that of rational numbers") {
  Random random(11);
  int flat = 0, turned = 0;
  for (int i = 0; i < 40'000; ++i) {
    std::array<Hip, 4> p = nearly_flat(random);
    std::swap(p[random.below(4)], p[random.below(4)]);
    const int sign = sign_in_rationals(p);
    INFO(i);
    REQUIRE(exact_sign(p[0], p[1], p[2], p[3]) == sign);
    ++(sign == 0 ? flat : turned);
  }
  CHECK(flat > 2'000);
  CHECK(turned > 2'000);
}

TEST_CASE("the judge's sign holds where products would fall below the normal numbers") {
  constexpr double kLeast = 5e-324;
  CHECK(exact_sign({0, 0, 0}, {1e-120, 0, 0}, {0, 1e-120, 0}, {1, 1, kLeast}) == 1);
  CHECK(exact_sign({0, 0, 0}, {1e-120, 0, 0}, {0, 1e-120, 0}, {1, 1, -kLeast}) == -1);
  CHECK(exact_sign({0, 0, 0}, {kLeast, 0, 0}, {0, kLeast, 0}, {0, 0, -kLeast}) == -1);
  CHECK(exact_sign({1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1e150, -1e150, 1}) == 0);
}
