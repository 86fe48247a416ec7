// SPDX-License-Identifier: Apache-2.0
#include "graph/moment_sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <mutex>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "exact/limbs.hpp"
#include "graph/moment_grids.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kMomentGrain = 1u << 12;
constexpr std::size_t kVertexGrain = 1u << 14;
constexpr int kDoubleBits = std::numeric_limits<double>::digits;

BitExtent extent_of(const Mesh& mesh, unsigned jobs) {
  BitExtent total;
  std::mutex lock;
  parallel_for(jobs, mesh.points.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
    BitExtent part;
    for (std::size_t v = begin; v < end; ++v) {  // a vertex of no triangle only makes the grids wider
      const Vec3& p = mesh.points[v];
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) part.add(p);
    }
    const std::lock_guard<std::mutex> guard(lock);
    total.add(part);
  });
  if (total.low_bit > total.high_bit) total.low_bit = total.high_bit = 0;
  return total;
}

// z = x / 2^grid, where that is an integer.
void set_scaled(Integer& z, double x, int grid) {
  int exponent = 0;
  mpz_set_d(z, std::ldexp(std::frexp(x, &exponent), kDoubleBits));
  const int shift = exponent - kDoubleBits - grid;
  if (shift > 0) {
    mpz_mul_2exp(z, z, static_cast<mp_bitcnt_t>(shift));
  } else {
    mpz_tdiv_q_2exp(z, z, static_cast<mp_bitcnt_t>(-shift));  // the bits that go are zeros
  }
}

// to += (positive - negative) * 2^shift.
template <std::size_t N>
void add_limbs_to(Integer& to, const Limbs<N>& positive, const Limbs<N>& negative, int shift) {
  Integer number, other;
  mpz_import(number, N, -1, sizeof(std::uint64_t), 0, 0, positive.data());
  mpz_import(other, N, -1, sizeof(std::uint64_t), 0, 0, negative.data());
  mpz_sub(number, number, other);
  mpz_mul_2exp(number, number, static_cast<mp_bitcnt_t>(shift));
  mpz_add(to, to, number);
}

// A sum of products of limbs without carrying from one limb to the next: each column has room for 2^64 terms.
template <std::size_t N>
class Columns {
 public:
  void add(std::size_t at, std::uint64_t limb) { columns_[at] += limb; }
  void add_product(std::size_t at, std::uint64_t a, std::uint64_t b) {
    const DoubleLimb product = DoubleLimb{a} * b;
    columns_[at] += static_cast<std::uint64_t>(product);
    columns_[at + 1] += static_cast<std::uint64_t>(product >> 64);
  }
  [[nodiscard]] Limbs<N + 1> value() const {
    Limbs<N + 1> limbs{};
    DoubleLimb carry = 0;
    for (std::size_t i = 0; i < N; ++i) {
      carry += columns_[i];  // below 2^128: fewer than 2^63 terms were added
      limbs[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    limbs[N] = static_cast<std::uint64_t>(carry);
    return limbs;
  }

 private:
  std::array<DoubleLimb, N> columns_{};
};

// Low and high limb. GCC takes the product with a limb that was shifted out of a longer number for one of 128 bits by 128.
std::array<std::uint64_t, 2> halves(DoubleLimb x) {
  const auto limbs = std::bit_cast<std::array<std::uint64_t, 2>>(x);
  if constexpr (std::endian::native == std::endian::big) return {limbs[1], limbs[0]};
  return limbs;
}

// Triangles on the grid of 60 bits. With coordinates below 2^61 a minor is within 2^122, the determinant, three products of
// three less three others, within 3 * 2^183 < 2^185; the square factor of the second moments is below 12 * 2^122 < 2^126.
class NarrowAdder {
 public:
  explicit NarrowAdder(const Grids& grids) : reader_(grids, grids.narrow), shift_(grids.narrow - grids.all) {}

  // False, and nothing added, where a corner is not on the grid.
  bool add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    bool is_on_grid = reader_.is_in_range();
    const Triple p = reader_.read(a, is_on_grid), q = reader_.read(b, is_on_grid), r = reader_.read(c, is_on_grid);
    if (!is_on_grid) return false;
    DoubleLimb low = 0;  // the determinant is high * 2^64 + low
    SignedDoubleLimb high = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const SignedDoubleLimb minor = SignedDoubleLimb{q[i]} * r[j] - SignedDoubleLimb{q[j]} * r[i];
      low += DoubleLimb{static_cast<std::uint64_t>(minor)} * static_cast<std::uint64_t>(p[k]);
      high += SignedDoubleLimb{static_cast<std::int64_t>(minor >> 64)} * p[k];
    }
    high += static_cast<SignedDoubleLimb>(low >> 64);
    add_multiples(static_cast<std::uint64_t>(low), high, p, q, r);
    return true;
  }

  void add_to(Moments& total) const {
    add_limbs_to(total.volume, sums_[0].volume.value(), sums_[1].volume.value(), 3 * shift_);
    for (std::size_t k = 0; k < 3; ++k)
      add_limbs_to(total.first[k], sums_[0].first[k].value(), sums_[1].first[k].value(), 4 * shift_);
    for (std::size_t n = 0; n < 6; ++n)
      add_limbs_to(total.second[n], sums_[0].second[n].value(), sums_[1].second[n].value(), 5 * shift_);
  }

 private:
  using Triple = std::array<std::int64_t, 3>;
  struct Sums {
    Columns<3> volume;
    std::array<Columns<4>, 3> first;
    std::array<Columns<5>, 6> second;
  };

  void add_multiples(std::uint64_t low, SignedDoubleLimb high, const Triple& p, const Triple& q, const Triple& r) {
    const bool is_negative = high < 0;
    if (is_negative) {
      low = 0 - low;
      high = ~high + (low == 0 ? 1 : 0);
    }
    const auto [middle, top] = halves(static_cast<DoubleLimb>(high));
    const std::uint64_t determinant[3] = {low, middle, top};
    Sums& to = sums_[is_negative ? 1 : 0];
    std::uint64_t sum[3];
    for (std::size_t k = 0; k < 3; ++k)
      sum[k] = static_cast<std::uint64_t>(p[k] + q[k] + r[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      to.volume.add(i, determinant[i]);
      for (std::size_t k = 0; k < 3; ++k)
        to.first[k].add_product(i, determinant[i], sum[k]);
    }
    for (std::size_t n = 0; n < 6; ++n) {
      const auto k = static_cast<std::size_t>(kFirstOfMoment[n]), l = static_cast<std::size_t>(kSecondOfMoment[n]);
      const auto product = [](std::int64_t x, std::int64_t y) {
        return DoubleLimb{static_cast<std::uint64_t>(x)} * static_cast<std::uint64_t>(y);
      };
      const DoubleLimb square = DoubleLimb{sum[k]} * sum[l] + product(p[k], p[l]) + product(q[k], q[l]) + product(r[k], r[l]);
      const auto [square_low, square_high] = halves(square);
      for (std::size_t i = 0; i < 3; ++i) {
        to.second[n].add_product(i, determinant[i], square_low);
        to.second[n].add_product(i + 1, determinant[i], square_high);
      }
    }
  }

  Reader<std::int64_t> reader_;
  int shift_;
  std::array<Sums, 2> sums_{};  // of positive and of negative determinants
};

// Triangles on the grid of 124 bits: coordinates are below 2^125, the determinant within 3 * 2^375 < 2^383, the square factor
// below 12 * 2^250 < 2^256. 2^32 triangles add 32 bits to each sum.
class WideAdder {
 public:
  explicit WideAdder(const Grids& grids) : reader_(grids, grids.wide), shift_(grids.wide - grids.all) {}

  bool add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    bool is_on_grid = reader_.is_in_range();
    const Triple p = read(a, is_on_grid), q = read(b, is_on_grid), r = read(c, is_on_grid);
    if (!is_on_grid) return false;
    Limbs<6> signed_determinant{};
    Triple sum = p;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      Limbs<4> minor = product(q[i], r[j]);
      subtract<0>(minor, product(q[j], r[i]));
      add<0>(signed_determinant, product(p[k], minor));  // as if unsigned: 2^256 p[k] too much where the minor is negative
      subtract<4>(signed_determinant, p[k], sign_mask(minor));
      add<0>(sum[k], q[k]);
      add<0>(sum[k], r[k]);
    }
    const std::uint64_t mask = sign_mask(signed_determinant);
    const Limbs<6> determinant = magnitude(signed_determinant, mask);
    Sums& to = sums_[mask & 1u];
    add<0>(to.volume, determinant);
    for (std::size_t k = 0; k < 3; ++k)
      add<0>(to.first[k], product(determinant, sum[k]));
    for (std::size_t n = 0; n < 6; ++n) {
      const auto k = static_cast<std::size_t>(kFirstOfMoment[n]), l = static_cast<std::size_t>(kSecondOfMoment[n]);
      Limbs<4> square = product(sum[k], sum[l]);
      add<0>(square, product(p[k], p[l]));
      add<0>(square, product(q[k], q[l]));
      add<0>(square, product(r[k], r[l]));
      add<0>(to.second[n], product(determinant, square));
    }
    return true;
  }

  void add_to(Moments& total) const {
    add_limbs_to(total.volume, sums_[0].volume, sums_[1].volume, 3 * shift_);
    for (std::size_t k = 0; k < 3; ++k)
      add_limbs_to(total.first[k], sums_[0].first[k], sums_[1].first[k], 4 * shift_);
    for (std::size_t n = 0; n < 6; ++n)
      add_limbs_to(total.second[n], sums_[0].second[n], sums_[1].second[n], 5 * shift_);
  }

 private:
  using Triple = std::array<Limbs<2>, 3>;
  struct Sums {
    Limbs<7> volume{};
    std::array<Limbs<9>, 3> first{};
    std::array<Limbs<11>, 6> second{};
  };

  [[nodiscard]] Triple read(const Vec3& p, bool& is_on_grid) const {
    Triple triple;
    const std::array<SignedDoubleLimb, 3> values = reader_.read(p, is_on_grid);
    for (std::size_t k = 0; k < 3; ++k)
      triple[k] = {static_cast<std::uint64_t>(values[k]), static_cast<std::uint64_t>(values[k] >> 64)};
    return triple;
  }

  Reader<SignedDoubleLimb> reader_;
  int shift_;
  std::array<Sums, 2> sums_{};
};

// Triangles on the grid of all.
class AnyAdder {
 public:
  explicit AnyAdder(const Grids& grids) : grid_(grids.all) {
    for (std::size_t k = 0; k < 3; ++k) {
      mpz_set_si(from_[k], grids.from[k]);
      mpz_mul_2exp(from_[k], from_[k], static_cast<mp_bitcnt_t>(grids.narrow - grids.all));
    }
  }

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    read(a, a_);
    read(b, b_);
    read(c, c_);
    mpz_set_ui(determinant_, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      mpz_mul(square_, b_[i], c_[j]);
      mpz_submul(square_, b_[j], c_[i]);
      mpz_addmul(determinant_, a_[k], square_);
      mpz_add(sum_[k], a_[k], b_[k]);
      mpz_add(sum_[k], sum_[k], c_[k]);
    }
    mpz_add(sums_.volume, sums_.volume, determinant_);
    for (std::size_t k = 0; k < 3; ++k)
      mpz_addmul(sums_.first[k], determinant_, sum_[k]);
    for (std::size_t n = 0; n < 6; ++n) {
      const auto k = static_cast<std::size_t>(kFirstOfMoment[n]), l = static_cast<std::size_t>(kSecondOfMoment[n]);
      mpz_set_ui(square_, 0);
      for (const Triple* factors : {&sum_, &a_, &b_, &c_})
        mpz_addmul(square_, (*factors)[k], (*factors)[l]);
      mpz_addmul(sums_.second[n], determinant_, square_);
    }
  }
  void add_to(Moments& total) const {
    mpz_add(total.volume, total.volume, sums_.volume);
    for (std::size_t k = 0; k < 3; ++k)
      mpz_add(total.first[k], total.first[k], sums_.first[k]);
    for (std::size_t n = 0; n < 6; ++n)
      mpz_add(total.second[n], total.second[n], sums_.second[n]);
  }

 private:
  using Triple = std::array<Integer, 3>;

  void read(const Vec3& point, Triple& to) const {
    for (int k = 0; k < 3; ++k) {
      Integer& coordinate = to[static_cast<std::size_t>(k)];
      set_scaled(coordinate, component(point, k), grid_);
      mpz_sub(coordinate, coordinate, from_[static_cast<std::size_t>(k)]);
    }
  }

  int grid_;
  Triple from_;
  Triple a_, b_, c_, sum_;  // kept from one triangle to the next, so that nothing is allocated
  Integer square_, determinant_;
  Moments sums_;
};

}  // namespace

// Coordinates near zero have lower bits than others, and of large meshes there are few: so each triangle is added on the
// coarsest of three grids that it fits.
void sum_moments(const Mesh& mesh, unsigned jobs, Moments& sums) {
  const Grids grids = grids_of(extent_of(mesh, jobs));
  sums.grid = grids.all;
  for (std::size_t k = 0; k < 3; ++k) {
    mpz_set_si(sums.from[k], grids.from[k]);
    mpz_mul_2exp(sums.from[k], sums.from[k], static_cast<mp_bitcnt_t>(grids.narrow - grids.all));
  }
  std::mutex lock;
  parallel_for(jobs, mesh.face_count(), kMomentGrain, [&](std::size_t begin, std::size_t end) {
    NarrowAdder narrow(grids);
    WideAdder wide(grids);
    AnyAdder any(grids);
    const auto corner = [&](std::size_t slot) { return mesh.points[+mesh.corners[slot]]; };
    for (std::size_t f = begin; f < end; ++f) {
      const Vec3 a = corner(3 * f), b = corner(3 * f + 1), c = corner(3 * f + 2);
      if (!narrow.add_triangle(a, b, c) && !wide.add_triangle(a, b, c)) any.add_triangle(a, b, c);
    }
    const std::lock_guard<std::mutex> guard(lock);
    narrow.add_to(sums);
    wide.add_to(sums);
    any.add_to(sums);
  });
}

}  // namespace fdcg::bake
