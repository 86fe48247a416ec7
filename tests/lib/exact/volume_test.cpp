// SPDX-License-Identifier: Apache-2.0
#include "exact/volume.hpp"

#include <gmp.h>

#include <cmath>
#include <limits>
#include <random>

#include "catch.hpp"

using namespace fdcg::bake;

namespace {

// The same sum in rationals.
class Rational {
 public:
  Rational() { mpq_init(sum_); }
  Rational(const Rational&) = delete;
  Rational& operator=(const Rational&) = delete;
  ~Rational() { mpq_clear(sum_); }
  void add_product(double a, double b, double c, bool negative) {
    mpq_t x, y;
    mpq_init(x);
    mpq_init(y);
    mpq_set_d(x, a);
    mpq_set_d(y, b);
    mpq_mul(x, x, y);
    mpq_set_d(y, negative ? -c : c);
    mpq_mul(x, x, y);
    mpq_add(sum_, sum_, x);
    mpq_clear(x);
    mpq_clear(y);
  }
  [[nodiscard]] int sign() const { return mpq_sgn(sum_); }

 private:
  mpq_t sum_;
};

double random_double(std::mt19937_64& rng, int range) {
  const double mantissa = std::ldexp(static_cast<double>(rng() >> 11), -53) * 2 - 1;
  return std::ldexp(mantissa, static_cast<int>(rng() % (2 * range + 1)) - range);
}

}  // namespace

TEST_CASE("the exact sum has the sign of the sum in rationals, over the whole range of doubles") {
  std::mt19937_64 rng(17);
  for (const int range : {0, 3, 60, 400, 1020}) {
    for (int round = 0; round < 300; ++round) {
      ExactSum sum;
      Rational rational;
      double factors[3]{};
      for (int term = 0; term < 12; ++term) {
        // Every second product takes the last one away but for a unit in the last place of one factor.
        if (term % 2 == 0) {
          for (double& f : factors)
            f = random_double(rng, range);
        } else {
          factors[1] = std::nextafter(factors[1], rng() % 2 == 0 ? 0 : factors[1]);
        }
        sum.add_product(factors[0], factors[1], factors[2], term % 2 == 1);
        rational.add_product(factors[0], factors[1], factors[2], term % 2 == 1);
        CHECK(sum.sign() == rational.sign());
      }
    }
  }
}

TEST_CASE("the exact sum neither overflows nor underflows") {
  constexpr double kHuge = std::numeric_limits<double>::max(), kTiny = std::numeric_limits<double>::denorm_min();
  ExactSum sum;
  CHECK(sum.sign() == 0);
  sum.add_product(kTiny, -kTiny, kTiny, false);
  CHECK(sum.sign() == -1);
  for (int i = 0; i < 1000; ++i)
    sum.add_product(kHuge, kHuge, kHuge, false);
  CHECK(sum.sign() == 1);
  for (int i = 0; i < 1000; ++i)
    sum.add_product(kHuge, -kHuge, kHuge, false);
  CHECK(sum.sign() == -1);
  sum.add_product(kTiny, kTiny, kTiny, false);
  CHECK(sum.sign() == 0);
}

TEST_CASE("the determinant of a right-handed frame is positive") {
  ExactSum sum;
  sum.add_determinant({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  CHECK(sum.sign() == 1);
  sum.add_determinant({0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  CHECK(sum.sign() == 0);
  sum.add_determinant({0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9 + 1e-15});
  Rational rational;
  const double m[3][3]{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9 + 1e-15}};
  for (int i = 0; i < 3; ++i) {
    rational.add_product(m[0][i], m[1][(i + 1) % 3], m[2][(i + 2) % 3], false);
    rational.add_product(m[0][i], m[1][(i + 2) % 3], m[2][(i + 1) % 3], true);
  }
  CHECK(sum.sign() == rational.sign());
}
