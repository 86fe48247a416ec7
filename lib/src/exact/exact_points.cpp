// SPDX-License-Identifier: Apache-2.0
#include "exact/exact_points.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace made_points {  // not anonymous: ExactPoints::Exact, which the header names, is made of them

using Interval = CGAL::Interval_nt<true>;
using Fraction = CGAL::Exact_rational;

// Over doubles, intervals and fractions alike.
template <class Number>
struct Triple {
  Number x, y, z;
};
template <class Number>
Triple<Number> minus(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
Triple<Number> cross_of(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number>
Number dot_of(const Triple<Number>& a, const Triple<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Triple<Number> along(const Triple<Number>& from, const Number& share, const Triple<Number>& way) {
  return {from.x + share * way.x, from.y + share * way.y, from.z + share * way.z};
}
template <class Number>
const Number& part(const Triple<Number>& a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
template <class Number>
Number cross_along(const Triple<Number>& a, const Triple<Number>& b, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return part(a, u) * part(b, v) - part(a, v) * part(b, u);
}

enum class Made : std::uint8_t { given, on_plane, on_planes, on_lines, middle };

struct Definition {
  Made kind = Made::given;
  std::uint8_t axis = 0;
  std::array<PointId, 9> of{};
};

// The point that a definition describes; `point` gives the coordinates of those that it is made of.
template <class Number, class Point>
Triple<Number> point_of(const Definition& made, const Point& point) {
  const auto at = [&](std::size_t i) -> Triple<Number> { return point(made.of[i]); };
  switch (made.kind) {
    case Made::given:
      return at(0);
    case Made::on_plane: {
      const Triple<Number> p = at(0), r = at(2), way = minus(at(1), p);
      const Triple<Number> normal = cross_of(minus(at(3), r), minus(at(4), r));
      return along(p, Number(dot_of(normal, minus(r, p)) / dot_of(normal, way)), way);
    }
    case Made::on_planes: {  // about a corner of the first plane, so that its offset is nothing
      const Triple<Number> o = at(0), n = cross_of(minus(at(1), o), minus(at(2), o)), p = at(3),
                           k = cross_of(minus(at(4), p), minus(at(5), p)), q = at(6),
                           m = cross_of(minus(at(7), q), minus(at(8), q));
      const Triple<Number> mn = cross_of(m, n), nk = cross_of(n, k);
      const Number whole = dot_of(n, cross_of(k, m));
      const Number s = dot_of(k, minus(p, o)) / whole, t = dot_of(m, minus(q, o)) / whole;
      return along(along(o, s, mn), t, nk);
    }
    case Made::on_lines: {
      const Triple<Number> a = at(0), p = at(2), first = minus(at(1), a), second = minus(at(3), p);
      return along(a, Number(cross_along(minus(p, a), second, made.axis) / cross_along(first, second, made.axis)), first);
    }
    case Made::middle:
      break;
  }
  const Triple<Number> a = at(0), b = at(1), c = at(2);
  const Number third(3);
  return {(a.x + b.x + c.x) / third, (a.y + b.y + c.y) / third, (a.z + b.z + c.z) / third};
}

}  // namespace made_points

namespace {

using namespace made_points;

// A bound below which a difference of two products of differences may be rounding error. `radius`: of the coordinates.
struct Products {
  double value = 0, error = 0;
  Products(double a, double b, double c, double d, double radius) {  // a d - b c
    const double left = a * d, right = b * c;
    constexpr double kRounding = 1e-15;  // above 8 u
    value = left - right;
    error = kRounding * (std::fabs(left) + std::fabs(right)) +
            1.01 * radius * (std::fabs(a) + std::fabs(b) + std::fabs(c) + std::fabs(d) + 2 * radius) + 1e-300;
  }
};

int sign_of(double x) {
  return (x > 0) - (x < 0);
}

}  // namespace

struct ExactPoints::Exact {
  using Definition = made_points::Definition;
  using Fractions = made_points::Triple<made_points::Fraction>;
  std::vector<Vec3> near;
  std::vector<double> error;        // 0: given
  std::vector<std::uint32_t> made;  // of each point: the number of its definition, or kGiven
  std::vector<Definition> definitions;
  std::vector<std::unique_ptr<Fractions>> fractions;  // of each definition, once it was needed

  static constexpr std::uint32_t kGiven = 0xFFFFFFFFu;

  [[nodiscard]] bool are_given(PointId a, PointId b, PointId c) const {
    return made[a] == kGiven && made[b] == kGiven && made[c] == kGiven;
  }
  // By value: working out a fraction may move the others' places.
  Triple<Fraction> fraction(PointId p) {
    if (made[p] == kGiven) return {Fraction(near[p].x), Fraction(near[p].y), Fraction(near[p].z)};
    std::unique_ptr<Triple<Fraction>>& kept = fractions[made[p]];
    if (!kept) {
      kept = std::make_unique<Triple<Fraction>>(
          point_of<Fraction>(definitions[made[p]], [this](PointId q) { return fraction(q); }));
    }
    return *kept;
  }
  [[nodiscard]] Triple<Interval> interval(PointId p) const {
    const Vec3& c = near[p];
    if (made[p] == kGiven) return {Interval(c.x), Interval(c.y), Interval(c.z)};
    const Interval around(-error[p], error[p]);
    return {Interval(c.x) + around, Interval(c.y) + around, Interval(c.z) + around};
  }
  // Half of the width, and what rounding the middle adds.
  static void take(const Interval& value, double& middle, double& error) {
    middle = value.inf() + 0.5 * (value.sup() - value.inf());
    const double half = std::max(value.sup() - middle, middle - value.inf());
    error = std::max(error, half * (1 + 0x1p-50));
    if (!std::isfinite(middle) || !std::isfinite(half)) error = std::numeric_limits<double>::infinity();
  }
  PointId add(const Definition& definition) {
    const auto id = static_cast<PointId>(near.size());
    const Triple<Interval> about = point_of<Interval>(definition, [this](PointId q) { return interval(q); });
    Vec3 c;
    double bound = 0x1p-1000;  // never 0, which is that of given points
    take(about.x, c.x, bound);
    take(about.y, c.y, bound);
    take(about.z, c.z, bound);
    near.push_back(c);
    error.push_back(bound);
    made.push_back(static_cast<std::uint32_t>(definitions.size()));
    definitions.push_back(definition);
    fractions.emplace_back();
    constexpr double kLargest = 0x1p-44;  // of the coordinates: beyond it most predicates would need the fractions
    if (!(bound <= kLargest * largest_component(c))) refine(id);
    return id;
  }
  void refine(PointId id) {
    const Triple<Fraction> exact = fraction(id);
    Vec3& c = near[id];
    double bound = 0x1p-1000;
    const auto [xl, xh] = CGAL::to_interval(exact.x);
    const auto [yl, yh] = CGAL::to_interval(exact.y);
    const auto [zl, zh] = CGAL::to_interval(exact.z);
    take(Interval(xl, xh), c.x, bound);
    take(Interval(yl, yh), c.y, bound);
    take(Interval(zl, zh), c.z, bound);
    error[id] = bound;
  }
};

ExactPoints::ExactPoints(std::vector<Vec3> given) : exact_(std::make_unique<Exact>()) {
  exact_->error.assign(given.size(), 0);
  exact_->made.assign(given.size(), Exact::kGiven);
  exact_->near = std::move(given);
}

ExactPoints::~ExactPoints() = default;

PointId ExactPoints::add(const Vec3& given) {
  exact_->near.push_back(given);
  exact_->error.push_back(0);
  exact_->made.push_back(Exact::kGiven);
  return count() - 1;
}

PointId ExactPoints::on_plane(const PointEdge& line, const PointTriangle& plane) {
  return exact_->add({Made::on_plane, 0, {line[0], line[1], plane[0], plane[1], plane[2]}});
}

PointId ExactPoints::on_planes(const PointTriangle& a, const PointTriangle& b, const PointTriangle& c) {
  return exact_->add({Made::on_planes, 0, {a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]}});
}

PointId ExactPoints::on_lines(const PointEdge& a, const PointEdge& b, int axis) {
  return exact_->add({Made::on_lines, static_cast<std::uint8_t>(axis), {a[0], a[1], b[0], b[1]}});
}

PointId ExactPoints::middle(PointId a, PointId b, PointId c) {
  return exact_->add({Made::middle, 0, {a, b, c}});
}

std::uint32_t ExactPoints::count() const {
  return static_cast<std::uint32_t>(exact_->near.size());
}

const Vec3& ExactPoints::near(PointId p) const {
  return exact_->near[p];
}

double ExactPoints::error(PointId p) const {
  return exact_->error[p];
}

int ExactPoints::orient2d(PointId a, PointId b, PointId c, int axis) const {
  if (a == b || b == c || c == a) return 0;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Vec3 &p = near(a), &q = near(b), &r = near(c);
  const double radius = 2 * std::max({error(a), error(b), error(c)});
  const Products about(component(q, u) - component(p, u), component(q, v) - component(p, v), component(r, u) - component(p, u),
                       component(r, v) - component(p, v), radius);
  if (std::fabs(about.value) > about.error && std::isfinite(about.value)) return sign_of(about.value);
  if (exact_->are_given(a, b, c)) return exact::orient2d(p, q, r, axis);
  const Triple<Fraction> from = exact_->fraction(a);
  const Fraction value = cross_along(minus(exact_->fraction(b), from), minus(exact_->fraction(c), from), axis);
  return static_cast<int>(CGAL::sign(value));
}

int ExactPoints::compare(PointId a, PointId b, int axis) const {
  const double difference = component(near(a), axis) - component(near(b), axis);
  const double bound = error(a) + error(b);
  if (bound == 0) return sign_of(difference);
  if (std::fabs(difference) > 1.01 * bound + 1e-300) return sign_of(difference);
  return static_cast<int>(CGAL::compare(part(exact_->fraction(a), axis), part(exact_->fraction(b), axis)));
}

int ExactPoints::compare(PointId a, PointId b) const {
  if (a == b) return 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (const int order = compare(a, b, axis); order != 0) return order;
  }
  return 0;
}

int ExactPoints::side(const PointTriangle& plane, PointId p) const {
  const Vec3 &a = near(plane[0]), &b = near(plane[1]), &c = near(plane[2]), &d = near(p);
  if (exact_->made[p] == Exact::kGiven) return exact::orient3d(a, b, c, d);
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const Products x(ab.y, ab.z, ac.y, ac.z, 0), y(ab.z, ab.x, ac.z, ac.x, 0), z(ab.x, ab.y, ac.x, ac.y, 0);
  const double value = x.value * ad.x + y.value * ad.y + z.value * ad.z;
  const auto bound = [&](const Products& n, double way) {  // n.error is at most 1e-15 of its two products
    return 1e15 * n.error * (4e-15 * std::fabs(way) + 1.01 * error(p));
  };
  const double most = bound(x, ad.x) + bound(y, ad.y) + bound(z, ad.z);
  if (std::fabs(value) > most && std::isfinite(value) && std::isfinite(most)) return sign_of(value);
  const Triple<Fraction> from = exact_->fraction(plane[0]);
  const Triple<Fraction> normal = cross_of(minus(exact_->fraction(plane[1]), from), minus(exact_->fraction(plane[2]), from));
  return static_cast<int>(CGAL::sign(dot_of(normal, minus(exact_->fraction(p), from))));
}

}  // namespace fdcg::bake
