// SPDX-License-Identifier: Apache-2.0
#include "graph/solid_mass.hpp"

#include <gmp.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/vec3.hpp"
#include "graph/moment_sums.hpp"

namespace fdcg::bake {
namespace {

constexpr int kMantissaBits = std::numeric_limits<double>::digits;

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
    mpz_mul(product, of.first[static_cast<std::size_t>(kFirstOfMoment[n])],
            of.first[static_cast<std::size_t>(kSecondOfMoment[n])]);
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

MassProperties properties(const Moments& of, const std::array<Integer, 6>& covariance) {
  const int grid = of.grid;
  MassProperties mass;
  Integer denominator, sum;
  mpz_set_ui(denominator, 6);
  mass.volume = rounded(of.volume, denominator, 3L * grid);
  mpz_mul_ui(denominator, of.volume, 4);
  std::array<double, 3> centroid{};
  for (std::size_t k = 0; k < 3; ++k) {
    mpz_set(sum, of.first[k]);
    mpz_addmul(sum, denominator, of.from[k]);
    centroid[k] = rounded(sum, denominator, grid);
  }
  mass.centroid = {centroid[0], centroid[1], centroid[2]};
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

}  // namespace

Solid measure_solid(const Mesh& mesh, const Topology& topology, unsigned jobs) {
  if (std::string reason = open_edges(mesh, topology); !reason.empty()) return {{}, std::move(reason)};
  Moments total;
  sum_moments(mesh, jobs, total);
  Integer six;
  mpz_set_ui(six, 6);
  if (total.volume.sign() <= 0) {
    const double volume = rounded(total.volume, six, 3L * total.grid);
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
  return {properties(total, covariance), {}};
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
