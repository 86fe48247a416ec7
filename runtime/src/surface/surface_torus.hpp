// SPDX-License-Identifier: Apache-2.0
// The torus: the one surface here that is convex from neither side, so that a god-object that leaves it may meet it again.
#pragma once

#include "surface/surface_revolved.hpp"
#include "surface/surface_round.hpp"

namespace fdcg {

// c[0] + c[1] t + ... of degree 4 and less.
template <int kDegree>
struct Polynomial {
  double c[kDegree + 1];

  [[nodiscard]] double operator()(double t) const {
    double value = c[kDegree];
    for (int k = kDegree - 1; k >= 0; --k)
      value = value * t + c[k];
    return value;
  }
  [[nodiscard]] Polynomial<kDegree - 1> derivative() const {
    Polynomial<kDegree - 1> d;
    for (int k = 1; k <= kDegree; ++k)
      d.c[k - 1] = k * c[k];
    return d;
  }
};

// The root between a and b, at which the signs differ: Newton's steps, halvings where one would leave the bracket.
template <int kDegree>
[[gnu::noinline]] double bracketed_root(const Polynomial<kDegree>& f, double a, double b) {
  constexpr int kMost = 80;
  const Polynomial<kDegree - 1> slope = f.derivative();
  const bool is_low_at_a = f(a) < 0;
  double t = (a + b) / 2;
  for (int i = 0; i < kMost && a < t && t < b; ++i) {
    const double value = f(t);
    if (value == 0) return t;
    ((value < 0) == is_low_at_a ? a : b) = t;
    const double s = slope(t);
    const double middle = (a + b) / 2, next = absolute(s) > 0 ? t - bounded_ratio(value, s) : middle;
    if (absolute(next - t) <= kEps / 4) return next;
    t = a < next && next < b ? next : middle;
  }
  return t;
}

// Places in 0 to 1, ascending, both ends among them.
struct Marks {
  double t[5];
  int count;
};

// The ends and the roots of f between marks among which it is monotonic.
template <int kDegree>
Marks roots_between(const Polynomial<kDegree>& f, const Marks& marks) {
  Marks roots = {{0}, 1};
  for (int i = 1; i < marks.count; ++i) {
    const double a = marks.t[i - 1], b = marks.t[i];
    if ((f(a) < 0) != (f(b) < 0)) roots.t[roots.count++] = bracketed_root(f, a, b);
  }
  roots.t[roots.count++] = 1;
  return roots;
}

// The ends and the roots of a quadratic.
inline Marks quadratic_marks(const Polynomial<2>& f) {
  Marks marks = {{0}, 1};
  const double a = f.c[2], b = f.c[1] / 2, c = f.c[0], left = b * b - a * c;
  if (left > 0) {
    const double q = -(b + (b < 0 ? -root(left) : root(left)));
    const double r = a == 0 ? -1 : bounded_ratio(q, a), s = q == 0 ? -1 : bounded_ratio(c, q);
    const double low = r < s ? r : s, high = r < s ? s : r;
    if (low > 0 && low < 1) marks.t[marks.count++] = low;
    if (high > low && high > 0 && high < 1) marks.t[marks.count++] = high;
  }
  marks.t[marks.count++] = 1;
  return marks;
}

// The first t in 0 to 1 at which f falls below zero from above; 2 where there is none. Between the marks, found from the second
// derivative up, f is monotonic: no root is passed over. What begins above up to rounding error, and falls, falls at 0.
[[gnu::noinline]] inline double first_fall(const Polynomial<4>& f, bool begins_above) {
  const Polynomial<3> slope = f.derivative();
  const Marks marks = roots_between(slope, quadratic_marks(slope.derivative()));
  for (int i = 1; i < marks.count; ++i) {
    const double a = marks.t[i - 1], b = marks.t[i];
    if (!(f(b) < 0)) continue;
    if (f(a) >= 0) return bracketed_root(f, a, b);
    if (i == 1 && begins_above && f(b) < f(a)) return 0;
  }
  return 2;
}

// The tube's circle.
struct TubeProfile {
  static constexpr bool kIsLine = false;
  double ring, raised, bend;

  [[nodiscard]] static Outward outward(Point at, double off2) { return outward_of(at, off2); }
  [[nodiscard]] static double per_off(double off) { return 1 / off; }
  [[nodiscard]] FDCG_HOT Section<double> section(double off, double z) const {
    return {ring, 0, (off - ring) * bend, z * bend};
  }
  [[nodiscard]] FDCG_HOT bool nearest(const Section<double>& from, double off, double z, Section<double>* to) const {
    const double out = off - ring, distance2 = out * out + z * z;
    if (!(distance2 > 0)) return false;
    const double distance = root(distance2), scale = (raised > 0 ? 1 : -1) / distance;
    *to = {ring, 0, out * scale, z * scale};
    return from.n_r * to->n_r + from.n_z * to->n_z > 0.96875 && (raised > 0 ? distance < raised : distance > -raised);
  }
  [[nodiscard]] static bool is_within(double) { return true; }
};

struct Torus {
  static constexpr bool kIsConvex = false;
  double sign, ring, tube, per_tube, extent;

  struct Spot {
    Point at, normal;
    Point outward;        // unit, from the axis
    double off, per_off;  // distance from the axis, and its inverse
    double out;           // how much of the normal is outward, as seen from the solid
  };

  explicit Torus(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1), ring(s.radius_m), tube(s.tube_radius_m), per_tube(1 / tube), extent(ring + tube) {}

  [[nodiscard]] bool is_outside(Point x) const {
    const double out = from_axis(x) - ring;
    return sign * (out * out + x.z * x.z - tube * tube) >= 0;
  }
  [[nodiscard]] bool is_clear(Point x, double way) const {
    const double out = from_axis(x) - ring;
    return is_clear_of_ball(sign, out * out + x.z * x.z, tube, way);
  }
  // (|x|^2 + ring^2 - tube^2)^2 - 4 ring^2 (x^2 + y^2) along a way: negative within the tube.
  [[nodiscard]] Polynomial<4> along(Point from, Point way) const {
    const double a = squared(way), b = 2 * dot(from, way), c = squared(from) + (ring - tube) * (ring + tube);
    const double four = 4 * ring * ring;
    const double fa = way.x * way.x + way.y * way.y, fb = 2 * (from.x * way.x + from.y * way.y);
    const double fc = from.x * from.x + from.y * from.y;
    Polynomial<4> f = {{c * c - four * fc, 2 * b * c - four * fb, b * b + 2 * a * c - four * fa, 2 * a * b, a * a}};
    for (double& coefficient : f.c)
      coefficient = coefficient * sign;
    return f;
  }
  // Of the place nearest to x on the tube.
  [[nodiscard]] Entry land(Point x) const {
    const double off = from_axis(x);
    const Point outward = off > 0 ? Point{x.x / off, x.y / off, 0} : Point{1, 0, 0};
    const double out = off - ring, length = root(out * out + x.z * x.z);
    if (!(length > 0)) return kNoEntry;
    const double stretch = tube / length;
    const double at = ring + out * stretch;
    return {true, {outward.x * at, outward.y * at, x.z * stretch}, kOnlyFace};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    const bool must_meet = begins_outside && !is_outside(to);
    const Way near = near_part(from, to, extent);
    const Point way = near.to - near.from;
    if (!must_meet && is_far_from(near.from, way)) return kNoEntry;
    const double t = first_fall(along(near.from, way), begins_outside);
    if (t <= 1) return land(near.from + way * t);
    return must_meet ? land(to) : kNoEntry;
  }
  // Whether the tube's surface is farther away than the way is long.
  [[nodiscard]] bool is_far_from(Point from, Point way) const {
    constexpr double kHeldBack = 1 - 0x1p-20;
    const double out = from_axis(from) - ring;
    const double distance = absolute(root(out * out + from.z * from.z) - tube) * kHeldBack - 8 * kEps * extent;
    return distance > 0 && distance * distance > squared(way);
  }

  [[nodiscard]] FDCG_HOT Spot spot(Point x, Point) const {
    const double off = from_axis(x);
    return spot_of(x, off, 1 / off, x, false);
  }
  [[nodiscard]] FDCG_HOT Spot project(Point p, const Spot& spot) const {
    const double off2 = p.x * p.x + p.y * p.y;
    if (!(off2 > kEps * ring * kEps * ring)) return spot_of({spot.outward.x, spot.outward.y, p.z}, 0, 1, p, true);
    const double per_off = inverse_root_near(off2, spot.per_off);
    return spot_of(p, off2 * per_off, per_off, p, true);
  }
  // On the tube at x, or where x is brought onto it.
  [[nodiscard]] FDCG_HOT Spot spot_of(Point x, double off, double per_off, Point at, bool is_moved) const {
    const Point outward = {x.x * per_off, x.y * per_off, 0};
    const double out = (off - ring) * per_tube, up = x.z * per_tube;
    const double stretch = inverse_root_near_1(out * out + up * up - 1);
    const double unit_out = out * stretch, unit_up = up * stretch;
    if (is_moved) {
      off = ring + tube * unit_out;
      per_off = 1 / off;
      at = {outward.x * off, outward.y * off, tube * unit_up};
    }
    const double signed_out = sign * unit_out;
    return {at, {outward.x * signed_out, outward.y * signed_out, sign * unit_up}, outward, off, per_off, unit_out};
  }
  // Around the tube by 1 / tube, around the axis by what the normal has of `outward`.
  [[nodiscard]] FDCG_HOT Point turn(const Spot& spot, Point v) const {
    const Point round = {-spot.outward.y, spot.outward.x, 0};
    const double on_ring = v.x * round.x + v.y * round.y;
    return (v - round * on_ring) * (sign * per_tube) + round * (on_ring * sign * spot.out * spot.per_off);
  }
  [[nodiscard]] FDCG_HOT double turn_rate(const Spot& spot, Point v, double) const {
    const double on_ring = v.y * spot.outward.x - v.x * spot.outward.y;
    return 3 * sign * (per_tube - spot.out * spot.per_off) * (on_ring * on_ring) * (dot(v, spot.outward) * spot.per_off);
  }
  [[nodiscard]] double curvature_sum(const Spot& spot) const { return sign * (per_tube + spot.out * spot.per_off); }
  [[nodiscard]] double curvature_product(const Spot& spot) const { return per_tube * spot.out * spot.per_off; }
  [[nodiscard]] static bool bends_alike(const Spot&, const Spot&) { return true; }
  static bool cross(const Spot&, Spot*, Feature*) { return false; }
  FDCG_HOT bool slide_quickly(uint32_t, Touch& touch) const {
    return slide_round(TubeProfile{ring, sign * tube, sign * per_tube}, touch);
  }
  Decision rule(SurfaceWalk& walk) const {
    Feature none;
    return decide(slide_on_piece(*this, walk, &none), none);
  }
  [[nodiscard]] Point normal(Feature, Point x, Point) const { return spot(x, x).normal; }
};

}  // namespace fdcg
