// SPDX-License-Identifier: Apache-2.0
#include "mass.hpp"

#include <gmp.h>
#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <mutex>

#include "parallel.hpp"
#include "vec.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kGrain = 1u << 12;
constexpr int kMantissaBits = std::numeric_limits<double>::digits;

// An mpz_t that frees itself.
class Integer {
 public:
  Integer() { mpz_init(z_); }
  ~Integer() { mpz_clear(z_); }
  Integer(const Integer&) = delete;
  Integer& operator=(const Integer&) = delete;
  [[nodiscard]] int sign() const { return mpz_sgn(z_); }
  operator mpz_ptr() { return z_; }           // NOLINT(google-explicit-constructor)
  operator mpz_srcptr() const { return z_; }  // NOLINT(google-explicit-constructor)

 private:
  mpz_t z_;
};

// The exponent of the lowest bit that is set; x is not 0.
int lowest_bit(double x) {
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(x), &exponent);
  return exponent - kMantissaBits + std::countr_zero(static_cast<std::uint64_t>(std::ldexp(fraction, kMantissaBits)));
}

// z = x / 2^grid, where that is an integer.
void set(Integer& z, double x, int grid) {
  int exponent = 0;
  mpz_set_d(z, std::ldexp(std::frexp(x, &exponent), kMantissaBits));
  const int shift = exponent - kMantissaBits - grid;
  if (shift > 0) {
    mpz_mul_2exp(z, z, static_cast<mp_bitcnt_t>(shift));
  } else {
    mpz_tdiv_q_2exp(z, z, static_cast<mp_bitcnt_t>(-shift));  // the bits that go are zeros
  }
}

using Triple = std::array<Integer, 3>;

constexpr int kFirstOf[6] = {0, 1, 2, 0, 0, 1};  // xx, yy, zz, xy, xz, yz
constexpr int kSecondOf[6] = {0, 1, 2, 1, 2, 2};

// Over the tetrahedra between the origin and the triangles, in grid units: 6 times the volume, 24 times the first moments, 120
// times the second.
struct Moments {
  Integer volume;
  Triple first;
  std::array<Integer, 6> second;

  void add(const Moments& other) {
    mpz_add(volume, volume, other.volume);
    for (std::size_t k = 0; k < 3; ++k)
      mpz_add(first[k], first[k], other.first[k]);
    for (std::size_t k = 0; k < 6; ++k)
      mpz_add(second[k], second[k], other.second[k]);
  }
};

// Adds triangles up; keeps its integers from one to the next, so that nothing is allocated.
class Adder {
 public:
  explicit Adder(int grid) : grid_(grid) {}

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    read(a, a_);
    read(b, b_);
    read(c, c_);
    mpz_set_ui(determinant_, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      mpz_mul(product_, b_[i], c_[j]);
      mpz_submul(product_, b_[j], c_[i]);
      mpz_addmul(determinant_, a_[k], product_);
      mpz_add(sum_[k], a_[k], b_[k]);
      mpz_add(sum_[k], sum_[k], c_[k]);
    }
    mpz_add(moments_.volume, moments_.volume, determinant_);
    for (std::size_t k = 0; k < 3; ++k)
      mpz_addmul(moments_.first[k], determinant_, sum_[k]);
    for (std::size_t n = 0; n < 6; ++n) {
      const auto k = static_cast<std::size_t>(kFirstOf[n]), l = static_cast<std::size_t>(kSecondOf[n]);
      mpz_mul(product_, sum_[k], sum_[l]);
      mpz_addmul(product_, a_[k], a_[l]);
      mpz_addmul(product_, b_[k], b_[l]);
      mpz_addmul(product_, c_[k], c_[l]);
      mpz_addmul(moments_.second[n], determinant_, product_);
    }
  }
  [[nodiscard]] const Moments& moments() const { return moments_; }

 private:
  void read(const Vec3& point, Triple& to) const {
    for (int k = 0; k < 3; ++k)
      set(to[static_cast<std::size_t>(k)], component(point, k), grid_);
  }

  int grid_;
  Triple a_, b_, c_, sum_;
  Integer determinant_, product_;
  Moments moments_;
};

// numerator / denominator * 2^exponent, to the nearest double.
double rounded(const Integer& numerator, const Integer& denominator, long exponent) {
  mpq_t ratio;
  mpq_init(ratio);
  mpz_set(mpq_numref(ratio), numerator);
  mpz_set(mpq_denref(ratio), denominator);
  mpq_canonicalize(ratio);
  mpfr_t number;
  mpfr_init2(number, kMantissaBits);
  mpfr_set_q(number, ratio, MPFR_RNDN);
  mpfr_mul_2si(number, number, exponent, MPFR_RNDN);
  const double result = mpfr_get_d(number, MPFR_RNDN);
  mpfr_clear(number);
  mpq_clear(ratio);
  return result;
}

// 480 V' times the covariance about the centroid, V' = 6 V: for second moment P' = 120 P and first ones M' = 24 M,
// P - M M / V = P' / 120 - M' M' / (96 V') = (4 P' V' - 5 M' M') / (480 V').
void set_covariance(const Moments& of, std::array<Integer, 6>& covariance) {
  Integer product;
  for (std::size_t n = 0; n < 6; ++n) {
    mpz_mul(product, of.first[static_cast<std::size_t>(kFirstOf[n])], of.first[static_cast<std::size_t>(kSecondOf[n])]);
    mpz_mul_ui(product, product, 5);
    mpz_mul(covariance[n], of.second[n], of.volume);
    mpz_mul_ui(covariance[n], covariance[n], 4);
    mpz_sub(covariance[n], covariance[n], product);
  }
}

// Every leading minor is positive: the second moment about every plane through the centroid is.
bool is_positive_definite(const std::array<Integer, 6>& m) {
  Integer minor, product, determinant;
  mpz_mul(minor, m[0], m[1]);
  mpz_submul(minor, m[3], m[3]);
  mpz_mul(determinant, minor, m[2]);
  mpz_mul(product, m[3], m[4]);  // 2 xy xz yz - xx yz yz - yy xz xz
  mpz_mul_ui(product, product, 2);
  mpz_addmul(determinant, product, m[5]);
  mpz_mul(product, m[0], m[5]);
  mpz_submul(determinant, product, m[5]);
  mpz_mul(product, m[1], m[4]);
  mpz_submul(determinant, product, m[4]);
  return m[0].sign() > 0 && minor.sign() > 0 && determinant.sign() > 0;
}

MassProperties properties(const Moments& of, const std::array<Integer, 6>& covariance, int grid) {
  MassProperties mass;
  Integer denominator, sum;
  mpz_set_ui(denominator, 6);
  mass.volume = rounded(of.volume, denominator, 3L * grid);
  mpz_mul_ui(denominator, of.volume, 4);
  mass.centroid = {rounded(of.first[0], denominator, grid), rounded(of.first[1], denominator, grid),
                   rounded(of.first[2], denominator, grid)};
  mpz_mul_ui(denominator, of.volume, 480);
  for (std::size_t k = 0; k < 3; ++k) {
    mpz_add(sum, covariance[(k + 1) % 3], covariance[(k + 2) % 3]);
    mass.inertia[k] = rounded(sum, denominator, 5L * grid);
  }
  for (std::size_t k = 3; k < 6; ++k)
    mass.inertia[k] = 0 - rounded(covariance[k], denominator, 5L * grid);  // 0 - 0 is +0
  return mass;
}

std::string open_edges(const Mesh& mesh, const Topology& topology) {
  std::uint64_t open = 0;
  std::size_t first = 0;
  for (std::size_t slot = 0; slot < topology.twin.size(); ++slot) {
    if (+topology.twin[slot] < topology.twin.size()) continue;
    if (open++ == 0) first = slot;
  }
  if (open == 0) return {};
  const auto corner = [&](HalfedgeId h) { return std::to_string(mesh.source_point[+mesh.corners[+h]]); };
  const HalfedgeId h{static_cast<std::uint32_t>(first)};
  return "the mesh is not closed: " + std::to_string(open) + (open == 1 ? " edge has" : " edges have") +
         " no sound face on the other side, the first from vertex " + corner(h) + " to " +
         corner(next(mesh, topology.face(h), h)) + "; close it (fdcg validate lists them under boundary-edge)";
}

// Of the points that triangles use.
int grid_of(const Mesh& mesh) {
  constexpr int kNoBits = std::numeric_limits<int>::max();
  int grid = kNoBits;
  for (const VertexId corner : mesh.corners) {
    for (int k = 0; k < 3; ++k) {
      if (const double x = component(mesh.points[+corner], k); x != 0) grid = std::min(grid, lowest_bit(x));
    }
  }
  return grid == kNoBits ? 0 : grid;
}

}  // namespace

Solid measure_solid(const Mesh& mesh, const Topology& topology, unsigned jobs) {
  if (std::string reason = open_edges(mesh, topology); !reason.empty()) return {{}, std::move(reason)};
  const int grid = grid_of(mesh);
  Moments total;
  std::mutex lock;
  parallel_for(jobs, mesh.face_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    Adder adder(grid);
    const auto corner = [&](std::size_t slot) { return mesh.points[+mesh.corners[slot]]; };
    for (std::size_t f = begin; f < end; ++f)
      adder.add(corner(3 * f), corner(3 * f + 1), corner(3 * f + 2));
    const std::lock_guard<std::mutex> guard(lock);
    total.add(adder.moments());  // exact: the order does not matter
  });
  Integer six;
  mpz_set_ui(six, 6);
  if (total.volume.sign() <= 0) {
    const double volume = rounded(total.volume, six, 3L * grid);
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", volume);
    return {{},
            std::string("the mesh encloses a volume of ") + text.data() +
                " cubic units, which must be above 0; turn it with --orient"};
  }
  std::array<Integer, 6> covariance;
  set_covariance(total, covariance);
  if (!is_positive_definite(covariance))
    return {{}, "the mesh is wound the other way in parts, and what it encloses is no solid; turn those with --orient"};
  return {properties(total, covariance, grid), {}};
}

double deviation_from_regions(const Mesh& mesh, const Regions& regions) {
  double largest = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t region = regions.of(FaceId{f});
    if (region == kNone || regions.list[region].is_exact) continue;
    const Plane& plane = regions.list[region].plane;
    for (std::size_t slot = 3 * std::size_t{f}; slot < 3 * std::size_t{f} + 3; ++slot)
      largest = std::max(largest, std::fabs(dot(plane.normal, mesh.points[+mesh.corners[slot]]) + plane.offset));
  }
  return largest;
}

}  // namespace fdcg::bake
