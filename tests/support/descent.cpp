// SPDX-License-Identifier: Apache-2.0
#include "descent.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace fdcg::test {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactVector = Exact::Vector_3;
using Long = std::array<long double, 3>;

Long way(const Hip& from, const Hip& to) {
  Long d;
  for (std::size_t i = 0; i < 3; ++i)
    d[i] = static_cast<long double>(to[i]) - from[i];
  return d;
}
long double dot(const Long& a, const Long& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Long cross(const Long& a, const Long& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

ExactVector exact_way(const Hip& from, const Hip& to) {
  return Exact::Point_3(to[0], to[1], to[2]) - Exact::Point_3(from[0], from[1], from[2]);
}

// What is met first when a way is turned about `axis`, which is square to it, by less than half a turn.
class FirstMet {
 public:
  FirstMet(const ExactVector& t, const ExactVector& axis) : t_(t), axis_(axis), up_(CGAL::cross_product(axis, t)) {}

  // False: the axis is a bad choice, since a side of the wing lies in the plane.
  bool look_at(const ExactVector& a, const ExactVector& b) {
    const Exact::FT at_a = axis_ * a, at_b = axis_ * b;
    if (at_a == 0 || at_b == 0) return false;
    if ((at_a > 0) == (at_b > 0)) return true;
    const ExactVector ray = a * CGAL::abs(at_b) + b * CGAL::abs(at_a);
    const Exact::FT along = ray * t_, across = ray * up_;
    if (across == 0 && along > 0) is_on_surface_ = true;
    if (across <= 0 || (has_met_ && along * across_ <= along_ * across)) return true;
    along_ = along, across_ = across, has_met_ = true;
    is_outside_ = CGAL::cross_product(a, b) * t_ > 0;  // never 0: the wing's plane holds the ray, and not the way
    return true;
  }
  [[nodiscard]] bool has_met() const { return has_met_ || is_on_surface_; }
  [[nodiscard]] bool is_outside() const { return is_outside_ || is_on_surface_; }

 private:
  ExactVector t_, axis_, up_;
  Exact::FT along_, across_;  // of the ray met first
  bool has_met_ = false, is_outside_ = false, is_on_surface_ = false;
};

}  // namespace

Descent::Descent(const std::vector<std::array<Hip, 3>>& triangles) {
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      fans_[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
  }
}

const std::vector<Descent::Wing>& Descent::fan_at(const Hip& corner) const {
  const auto found = fans_.find(corner);
  if (found == fans_.end()) throw std::runtime_error("a corner of the graph is no point of its source");
  return found->second;
}

double Descent::reach(const Hip& corner, const Hip& hip) const {
  const Long t = way(corner, hip);
  long double most = 0;
  for (const auto& [left, right] : fan_at(corner)) {
    const Long a = way(corner, left), b = way(corner, right);
    most = std::max(most, dot(t, a) / std::sqrt(dot(a, a)));
    const Long n = cross(a, b);
    if (!(dot(cross(n, a), t) > 0 && dot(cross(b, n), t) > 0)) continue;
    const long double height = dot(n, t) / dot(n, n);
    const Long in_plane = {t[0] - n[0] * height, t[1] - n[1] * height, t[2] - n[2] * height};
    most = std::max(most, std::sqrt(dot(in_plane, in_plane)));
  }
  return static_cast<double>(most);
}

bool Descent::begins_outside(const Hip& corner, const Hip& hip) const {
  const std::vector<Wing>& fan = fan_at(corner);
  ExactVector t = exact_way(corner, hip);
  if (t == CGAL::NULL_VECTOR) return true;
  for (const Wing& wing : fan) {
    const ExactVector a = exact_way(corner, wing.first);
    if (CGAL::cross_product(a, t) != CGAL::NULL_VECTOR) continue;
    if (a * t > 0) return true;
    // No plane that holds the way is in general position: another way so near that nothing lies between.
    t = t + ExactVector(3, 5, 7) * Exact::FT(CGAL::abs(a.x()) + CGAL::abs(a.y()) + CGAL::abs(a.z())) * Exact::FT(0x1p-300);
    break;
  }
  // Almost any plane will do that holds the way and passes across a face, or nearly: faces may all lie in one plane with the
  // way.
  for (std::size_t i = 0; i < 1000; ++i) {
    const Wing& met = fan[i * 7919 % fan.size()];
    const ExactVector a = exact_way(corner, met.first), b = exact_way(corner, met.second);
    const Exact::FT off = CGAL::abs(a.x()) + CGAL::abs(a.y()) + CGAL::abs(a.z());
    const ExactVector any(static_cast<double>(i % 7) - 3, static_cast<double>(i % 11) - 5, static_cast<double>(i % 13) - 6);
    const ExactVector across =
        a * Exact::FT(1.0 + static_cast<double>(i % 5)) + b + any * (off * std::exp2(-static_cast<double>(i % 40)));
    const ExactVector axis = CGAL::cross_product(t, across);
    if (axis == CGAL::NULL_VECTOR) continue;
    FirstMet first(t, axis);
    const bool is_good = std::all_of(fan.begin(), fan.end(), [&](const Wing& wing) {
      return first.look_at(exact_way(corner, wing.first), exact_way(corner, wing.second));
    });
    if (is_good && first.has_met()) return first.is_outside();
  }
  throw std::runtime_error("no plane through the way meets the corner's faces in general position");
}

}  // namespace fdcg::test
