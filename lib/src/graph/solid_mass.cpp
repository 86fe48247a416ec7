// SPDX-License-Identifier: Apache-2.0
#include "graph/solid_mass.hpp"

#include <gmp.h>
#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <mutex>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "exact/wide.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kFaceGrain = 1u << 12;
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
void set_scaled(Integer& z, double x, int grid) {
  int exponent = 0;
  mpz_set_d(z, std::ldexp(std::frexp(x, &exponent), kMantissaBits));
  const int shift = exponent - kMantissaBits - grid;
  if (shift > 0) {
    mpz_mul_2exp(z, z, static_cast<mp_bitcnt_t>(shift));
  } else {
    mpz_tdiv_q_2exp(z, z, static_cast<mp_bitcnt_t>(-shift));  // the bits that go are zeros
  }
}
void set_zero(Integer& z) {
  mpz_set_ui(z, 0);
}
void add(Integer& to, const Integer& what) {
  mpz_add(to, to, what);
}
void add_product(Integer& to, const Integer& a, const Integer& b) {
  mpz_addmul(to, a, b);
}
void subtract_product(Integer& from, const Integer& a, const Integer& b) {
  mpz_submul(from, a, b);
}

template <std::size_t N>
void add(Integer& to, const Wide<N>& what) {
  Wide<N> magnitude;
  const bool is_negative = what.sign_mask() != 0;
  if (is_negative) {
    subtract(magnitude, what);
  } else {
    magnitude = what;
  }
  Integer number;
  mpz_import(number, N, -1, sizeof(std::uint64_t), 0, 0, magnitude.limb.data());
  if (is_negative) mpz_neg(number, number);
  mpz_add(to, to, number);
}

// Numbers for coordinates of so many bits. Widths, with b bits a coordinate: a minor of two rows takes 2 b + 1, a determinant
// 3 b + 3, a sum of three coordinates b + 2, of four products of those 2 b + 5; 2^32 triangles add 32 bits to each sum. So
// 64 N - kSpareBits bits a coordinate are few enough.
constexpr int kSpareBits = 4;
template <std::size_t N>
struct WideNumbers {
  using Coordinate = Wide<N>;
  using Square = Wide<2 * N>;
  using Determinant = Wide<3 * N>;
  using VolumeSum = Wide<3 * N + 1>;
  using FirstSum = Wide<4 * N + 1>;
  using SecondSum = Wide<5 * N + 1>;
};
struct AnyNumbers {
  using Coordinate = Integer;
  using Square = Integer;
  using Determinant = Integer;
  using VolumeSum = Integer;
  using FirstSum = Integer;
  using SecondSum = Integer;
};

constexpr int kFirstOf[6] = {0, 1, 2, 0, 0, 1};  // xx, yy, zz, xy, xz, yz
constexpr int kSecondOf[6] = {0, 1, 2, 1, 2, 2};

// Over the tetrahedra between the origin and the triangles, in grid units: 6 times the volume, 24 times the first moments, 120
// times the second.
struct Moments {
  Integer volume;
  std::array<Integer, 3> first;
  std::array<Integer, 6> second;
};

// Adds triangles up; keeps its integers from one to the next, so that nothing is allocated.
template <class Numbers>
class Adder {
 public:
  explicit Adder(int grid) : grid_(grid) {}

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    read(a, a_);
    read(b, b_);
    read(c, c_);
    set_zero(determinant_);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      set_zero(square_);
      add_product(square_, b_[i], c_[j]);
      subtract_product(square_, b_[j], c_[i]);
      add_product(determinant_, a_[k], square_);
      set_zero(sum_[k]);
      for (const Triple* corner : {&a_, &b_, &c_})
        add(sum_[k], (*corner)[k]);
    }
    add(volume_, determinant_);
    for (std::size_t k = 0; k < 3; ++k)
      add_product(first_[k], determinant_, sum_[k]);
    for (std::size_t n = 0; n < 6; ++n) {
      const auto k = static_cast<std::size_t>(kFirstOf[n]), l = static_cast<std::size_t>(kSecondOf[n]);
      set_zero(square_);
      for (const Triple* factors : {&sum_, &a_, &b_, &c_})
        add_product(square_, (*factors)[k], (*factors)[l]);
      add_product(second_[n], determinant_, square_);
    }
  }
  void add_to(Moments& total) const {
    add(total.volume, volume_);
    for (std::size_t k = 0; k < 3; ++k)
      add(total.first[k], first_[k]);
    for (std::size_t n = 0; n < 6; ++n)
      add(total.second[n], second_[n]);
  }

 private:
  using Triple = std::array<typename Numbers::Coordinate, 3>;

  void read(const Vec3& point, Triple& to) const {
    for (int k = 0; k < 3; ++k)
      set_scaled(to[static_cast<std::size_t>(k)], component(point, k), grid_);
  }

  int grid_;
  Triple a_, b_, c_, sum_;
  typename Numbers::Square square_;
  typename Numbers::Determinant determinant_;
  typename Numbers::VolumeSum volume_;
  std::array<typename Numbers::FirstSum, 3> first_;
  std::array<typename Numbers::SecondSum, 6> second_;
};

template <class Numbers>
void add_up(const Mesh& mesh, int grid, unsigned jobs, Moments& total) {
  std::mutex lock;
  parallel_for(jobs, mesh.face_count(), kFaceGrain, [&](std::size_t begin, std::size_t end) {
    Adder<Numbers> adder(grid);
    const auto corner = [&](std::size_t slot) { return mesh.points[+mesh.corners[slot]]; };
    for (std::size_t f = begin; f < end; ++f)
      adder.add_triangle(corner(3 * f), corner(3 * f + 1), corner(3 * f + 2));
    const std::lock_guard<std::mutex> guard(lock);
    adder.add_to(total);  // exact: the order does not matter
  });
}

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

// Of the coordinates that triangles use: the exponents of the lowest bit that any has, and of the bit above the highest.
struct BitRange {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
};
BitRange bits_of(const Mesh& mesh) {
  BitRange bits;
  for (const VertexId corner : mesh.corners) {
    for (int k = 0; k < 3; ++k) {
      const double x = component(mesh.points[+corner], k);
      if (x == 0) continue;
      bits.low = std::min(bits.low, lowest_bit(x));
      bits.high = std::max(bits.high, std::ilogb(x) + 1);
    }
  }
  return bits.low > bits.high ? BitRange{0, 0} : bits;
}

}  // namespace

Solid measure_solid(const Mesh& mesh, const Topology& topology, unsigned jobs) {
  if (std::string reason = open_edges(mesh, topology); !reason.empty()) return {{}, std::move(reason)};
  const BitRange bits = bits_of(mesh);
  const int grid = bits.low, width = bits.high - bits.low;
  Moments total;
  if (width <= 64 - kSpareBits) {
    add_up<WideNumbers<1>>(mesh, grid, jobs, total);
  } else if (width <= 128 - kSpareBits) {
    add_up<WideNumbers<2>>(mesh, grid, jobs, total);
  } else {
    add_up<AnyNumbers>(mesh, grid, jobs, total);
  }
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
