// SPDX-License-Identifier: Apache-2.0
#include "descent.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bounded.hpp"

namespace fdcg::test {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel::FT;
template <class Number>
using Triple = std::array<Number, 3>;
using Long = Triple<long double>;

Long way(const Hip& from, const Hip& to) {
  Long d;
  for (std::size_t i = 0; i < 3; ++i)
    d[i] = static_cast<long double>(to[i]) - from[i];
  return d;
}
template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Number>
Number size_of(const Triple<Number>& a) {
  return abs(a[0]) + abs(a[1]) + abs(a[2]);
}

int sign_of(const Exact& a) {
  return static_cast<int>(CGAL::sign(a));
}
Triple<Exact> exact_way(const Hip& from, const Hip& to) {
  return {Exact(to[0]) - from[0], Exact(to[1]) - from[1], Exact(to[2]) - from[2]};
}
Triple<Bounded> bounded_way(const Hip& from, const Hip& to) {
  return {bounded_difference(to[0], from[0]), bounded_difference(to[1], from[1]), bounded_difference(to[2], from[2])};
}

// What is met first when a way is turned about an axis, which is square to it, by less than half a turn.
template <class Number>
class FirstMet {
 public:
  FirstMet(const Triple<Number>& t, const Triple<Number>& axis) : t_(t), axis_(axis), up_(cross(axis, t)) {}

  // False: the axis is a bad choice, since a side of the wing lies in the plane; or a sign is doubtful.
  bool look_at(const Triple<Number>& a, const Triple<Number>& b) {
    const Number at_a = dot(axis_, a), at_b = dot(axis_, b);
    const int side_a = sign_of(at_a), side_b = sign_of(at_b);
    if (side_a == 0 || side_b == 0 || side_a == kDoubtful || side_b == kDoubtful) return false;
    if (side_a == side_b) return true;
    const Number of_a = abs(at_b), of_b = abs(at_a);
    const Triple<Number> ray = {a[0] * of_a + b[0] * of_b, a[1] * of_a + b[1] * of_b, a[2] * of_a + b[2] * of_b};
    const Number along = dot(ray, t_), across = dot(ray, up_);
    const int is_up = sign_of(across);
    if (is_up == kDoubtful) return false;
    if (is_up == 0 && sign_of(along) > 0) is_on_surface_ = true;
    if (is_up <= 0) return true;
    const int is_before = has_met_ ? sign_of(Number(along * across_ - along_ * across)) : 1;
    if (is_before == kDoubtful) return false;
    if (is_before <= 0) return true;
    along_ = along, across_ = across, has_met_ = true;
    facing_ = sign_of(dot(cross(a, b), t_));  // never 0: the wing's plane holds the ray, and not the way
    return facing_ != kDoubtful;
  }
  [[nodiscard]] bool has_met() const { return has_met_ || is_on_surface_; }
  [[nodiscard]] bool is_outside() const { return facing_ > 0 || is_on_surface_; }

 private:
  Triple<Number> t_, axis_, up_;
  Number along_{}, across_{};  // of the ray met first
  int facing_ = 0;
  bool has_met_ = false, is_on_surface_ = false;
};

// A direction across one of the fan's faces, or nearly: another at each trial.
template <class Number>
Triple<Number> direction_across(std::size_t trial, const Triple<Number>& a, const Triple<Number>& b, const Number& off) {
  const int any[3] = {static_cast<int>(trial % 7) - 3, static_cast<int>(trial % 11) - 5, static_cast<int>(trial % 13) - 6};
  const double share = std::exp2(-static_cast<double>(trial % 40));
  Triple<Number> across;
  for (std::size_t i = 0; i < 3; ++i)
    across[i] = a[i] * Number{1.0 + static_cast<double>(trial % 5)} + b[i] + off * Number{share * any[i]};
  return across;
}
std::size_t face_tried(std::size_t trial, std::size_t faces) {
  return trial * 7919 % faces;
}

// Whether the way begins outside of the faces that meet at the corner, by doubles; none where they do not tell: on the surface
// they never do.
std::optional<bool> told_in_doubles(const std::vector<std::pair<Hip, Hip>>& fan, const Hip& corner, const Hip& hip) {
  const Triple<Bounded> t = bounded_way(corner, hip);
  for (const auto& wing : fan) {
    const Triple<Bounded> apart = cross(bounded_way(corner, wing.first), t);
    if (sign_of(apart[0]) == kDoubtful && sign_of(apart[1]) == kDoubtful && sign_of(apart[2]) == kDoubtful) return std::nullopt;
  }
  constexpr std::size_t kTrials = 4;
  for (std::size_t i = 0; i < kTrials; ++i) {
    const auto& [left, right] = fan[face_tried(i, fan.size())];
    const Triple<Bounded> a = bounded_way(corner, left), b = bounded_way(corner, right);
    const Triple<Bounded> across = direction_across(i, a, b, size_of(a));
    FirstMet<Bounded> first(t, cross(t, across));
    const bool is_good = std::all_of(fan.begin(), fan.end(), [&](const auto& wing) {
      return first.look_at(bounded_way(corner, wing.first), bounded_way(corner, wing.second));
    });
    if (is_good && first.has_met()) return first.is_outside();
  }
  return std::nullopt;
}

struct LongWing {
  Long left, right, normal;  // from the corner; the normal is of any length
  explicit LongWing(const Hip& corner, const std::pair<Hip, Hip>& wing)
      : left(way(corner, wing.first)), right(way(corner, wing.second)), normal(cross(left, right)) {}
};

// Whether a foot and a place, both from the corner, are no farther apart than that.
bool is_near(const Long& foot, const Long& place, double so_near) {
  const Long apart = {foot[0] - place[0], foot[1] - place[1], foot[2] - place[2]};
  return dot(apart, apart) <= static_cast<long double>(so_near) * so_near;
}

// Whether a place is no farther in a direction of any length than that.
bool is_within(const Long& place, const Long& direction, long double so_near) {
  return dot(place, direction) <= so_near * std::sqrt(dot(direction, direction));
}

// All from the corner. A foot so near to where the face ends is on it.
bool rests_on_face(const LongWing& face, const Long& place, double so_near, const Long& t) {
  const Long& n = face.normal;
  const long double height = dot(n, t) / dot(n, n);
  if (!(height < 0)) return false;
  const Long foot = {t[0] - n[0] * height, t[1] - n[1] * height, t[2] - n[2] * height};
  const Long across = {face.right[0] - face.left[0], face.right[1] - face.left[1], face.right[2] - face.left[2]};
  const Long from_left = {foot[0] - face.left[0], foot[1] - face.left[1], foot[2] - face.left[2]};
  const bool is_over = is_within(foot, cross(face.left, n), so_near) && is_within(foot, cross(n, face.right), so_near) &&
                       is_within(from_left, cross(across, n), so_near);
  return is_over && is_near(foot, place, so_near);
}

// On the edge between two faces: to the left of `a` and to the right of `b`. A foot so near to an end is on it; and a HIP is
// not over a face that would not be below it, were its third corner so far off its plane.
bool rests_on_edge(const LongWing& a, const LongWing& b, const Long& place, double so_near, const Long& t) {
  const Long& edge = a.left;
  const long double share = dot(t, edge) / dot(edge, edge), slack = so_near / std::sqrt(dot(edge, edge));
  if (!(share >= -slack && share <= 1 + slack)) return false;
  const bool is_behind_a = dot(a.normal, t) < 0, is_behind_b = dot(b.normal, t) < 0;
  const bool is_groove = dot(a.normal, b.left) > 0;
  if (is_groove ? !is_behind_a && !is_behind_b : !is_behind_a || !is_behind_b) return false;
  const long double deep = std::sqrt(dot(t, t) * dot(edge, edge));
  const auto is_beside = [&](const LongWing& face, const Long& across) {
    return is_within(t, across, so_near * (1 + deep / std::sqrt(dot(face.normal, face.normal))));
  };
  if (is_behind_a && !is_beside(a, cross(a.normal, edge))) return false;
  if (is_behind_b && !is_beside(b, cross(edge, b.normal))) return false;
  return is_near({edge[0] * share, edge[1] * share, edge[2] * share}, place, so_near);
}

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

bool Descent::rests_beside(const Hip& corner, const Hip& place, double so_near, const Hip& hip) const {
  const std::vector<Wing>& fan = fan_at(corner);
  const Long t = way(corner, hip), at = way(corner, place);
  return std::any_of(fan.begin(), fan.end(), [&](const Wing& wing) {
    const LongWing face(corner, wing);
    if (rests_on_face(face, at, so_near, t)) return true;
    return std::any_of(fan.begin(), fan.end(), [&](const Wing& other) {
      return other.second == wing.first && rests_on_edge(face, LongWing(corner, other), at, so_near, t);
    });
  });
}

bool Descent::begins_outside(const Hip& corner, const Hip& hip) const {
  const std::vector<Wing>& fan = fan_at(corner);
  if (corner == hip) return true;
  if (const std::optional<bool> told = told_in_doubles(fan, corner, hip)) return *told;
  Triple<Exact> t = exact_way(corner, hip);
  for (const Wing& wing : fan) {
    const Triple<Exact> a = exact_way(corner, wing.first), apart = cross(a, t);
    if (apart[0] != 0 || apart[1] != 0 || apart[2] != 0) continue;
    if (dot(a, t) > 0) return true;
    // No plane that holds the way is in general position: another way so near that nothing lies between.
    const Exact beside = size_of(a) * Exact(0x1p-300);
    t = {t[0] + beside * 3, t[1] + beside * 5, t[2] + beside * 7};
    break;
  }
  // Almost any plane will do that holds the way and passes across a face, or nearly: faces may all lie in one plane with the
  // way.
  for (std::size_t i = 0; i < 1000; ++i) {
    const Wing& met = fan[face_tried(i, fan.size())];
    const Triple<Exact> a = exact_way(corner, met.first), b = exact_way(corner, met.second);
    const Triple<Exact> axis = cross(t, direction_across<Exact>(i, a, b, size_of(a)));
    if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0) continue;
    FirstMet<Exact> first(t, axis);
    const bool is_good = std::all_of(fan.begin(), fan.end(), [&](const Wing& wing) {
      return first.look_at(exact_way(corner, wing.first), exact_way(corner, wing.second));
    });
    if (is_good && first.has_met()) return first.is_outside();
  }
  throw std::runtime_error("no plane through the way meets the corner's faces in general position");
}

}  // namespace fdcg::test
