// SPDX-License-Identifier: Apache-2.0
// The set of wrenches that the contacts of a grasp can exert on the object, given by its support function. Friction cones are
// not linearised: a contact pressing with 1 N gives an ellipse (hard finger) or ellipsoid (soft finger) of wrenches.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fdcg/grasp.hpp"

namespace fdcg::grasp {

inline constexpr std::size_t kDimensions = 6;
using Vec6 = std::array<double, kDimensions>;  // force, then torque over the torque scale

inline double dot(const Vec6& a, const Vec6& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kDimensions; ++k)
    sum += a[k] * b[k];
  return sum;
}
inline void add_scaled(Vec6& to, double factor, const Vec6& v) {
  for (std::size_t k = 0; k < kDimensions; ++k)
    to[k] += factor * v[k];
}
double norm(const Vec6& v);
Vec6 scaled(double factor, const Vec6& v);
inline Vec6 unit(const Vec6& v) {
  return scaled(1 / norm(v), v);
}

// The wrenches of one contact at a normal force of 1 N: centre + sum of x_k spread[k] over |x| <= 1.
struct UnitWrenches {
  Vec6 centre{};
  std::array<Vec6, 3> spread{};  // two tangents, torsion; zero where there is no friction
  double spread_norm = 0;        // at least the largest singular value of the three

  // The three products spread[k].u, and their length.
  [[nodiscard]] std::array<double, 3> slip(const Vec6& u, double& length) const;
  // The support function: the largest product of u with one of these wrenches.
  [[nodiscard]] double support(const Vec6& u) const;
};

// The wrench at which the support function attains its value.
struct SupportPoint {
  double value = 0;
  Vec6 wrench{};
};

// All sums of the contacts' wrenches with normal forces of at most caps_n[i] each and total_n together.
// must_press: normal forces of exactly total_n together, so that the set need not contain the origin; caps are ignored.
struct Body {
  std::vector<UnitWrenches> contacts;
  std::vector<double> caps_n;
  double total_n = 1;
  bool must_press = false;
  std::size_t dimensions = kDimensions;  // coordinates above are zero throughout

  [[nodiscard]] SupportPoint support(const Vec6& u) const;
  [[nodiscard]] double value(const Vec6& u) const { return support(u).value; }
  // The normal force of each contact at the support point of u.
  [[nodiscard]] std::vector<double> presses_n(const Vec6& u) const;
};

// The wrench set of the grasp's contacts for a total of 1 N, without caps.
Body unit_body(const Grasp& grasp);

// One contact's force and moment about its own point, from coordinates x within the unit ball and its normal force.
ContactForce contact_force(const Contact& contact, double press_n, const std::array<double, 3>& x);

// Two unit vectors that complete a unit normal to a right-handed frame.
std::array<Vec3, 2> tangents(const Vec3& normal);

}  // namespace fdcg::grasp
