// SPDX-License-Identifier: Apache-2.0
// The convex surfaces without an edge: plane, sphere, capsule, ellipsoid.
#pragma once

#include "surface/surface_revolved.hpp"

namespace fdcg {

inline constexpr Feature kOnlyFace = {FDCG_FACE, 0};

// z = 0, solid below.
struct PlaneSurface {
  static constexpr bool kIsConvex = true;
  static constexpr double sign = 1, extent = 1;

  explicit PlaneSurface(const fdcg_surface&) {}
  [[nodiscard]] bool is_outside(Point x) const { return x.z >= 0; }
  [[nodiscard]] static bool is_clear(Point x, double way) { return x.z > way; }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    if (!begins_outside || is_outside(to)) return kNoEntry;
    const double t = from.z / (from.z - to.z);
    return {true, {from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t, 0}, kOnlyFace};
  }
  FDCG_HOT Slid slide(Touch& touch) const {
    const Point hip = touch.hip, across = {touch.god_object.x - hip.x, touch.god_object.y - hip.y, 0};
    double shrink = 0;
    const Slid slid = slide_on_plane(touch, across, -hip.z, &shrink);
    if (slid == Slid::kSlides) touch.god_object = {hip.x + across.x * shrink, hip.y + across.y * shrink, 0};
    return slid;
  }
  FDCG_HOT bool slide_quickly(uint32_t, Touch& touch) const { return slide(touch) != Slid::kLeaves; }
  Decision rule(SurfaceWalk& walk) const { return decide(slide(walk), kFree); }
  [[nodiscard]] Point normal(Feature, Point, Point) const { return {0, 0, 1}; }
};

// On a ball whose centre is on the axis the descent is a great circle towards the HIP, and its end has a closed form: with the
// angle between god-object and HIP, the HIP pulls with reach * sin(angle) and presses with sign * (radius - reach *
// cos(angle)), and it stops where the pull is mu times the load. The stop's angle is the HIP's alone; the god-object says in
// which plane.
FDCG_HOT Slid slide_on_ball(Touch& touch, double centre_z, double radius, double sign) {
  const Point at = {touch.god_object.x, touch.god_object.y, touch.god_object.z - centre_z};
  const Point hip = {touch.hip.x, touch.hip.y, touch.hip.z - centre_z};
  const double per_radius = 1 / radius, level = dot(hip, at), load = sign * (radius - level * per_radius);
  if (!(load > 0)) return Slid::kLeaves;
  const double pull2 = squared(hip - at * (level * per_radius * per_radius));
  const Slip<double> slip = touch.friction.slip(touch.god_object, pull2, load);
  const double mu = touch.friction.mu_dynamic, held = mu * load;
  const double doubt = 8 * kEps * (norm1(touch.god_object) * per_radius) * (load + held);  // the rounding of a place, as a turn
  const double most = held + pull_rounding(touch) + doubt;
  if (slip.is_rest || !(pull2 > most * most)) return Slid::kRests;
  const double reach2 = squared(hip), per_reach2 = 1 / reach2, less = 1 / root(1 + mu * mu), share = mu * less;
  const double free2 = reach2 - share * share * (radius * radius), rest = free2 > 0 ? root(free2) : 0;
  // In units of the reach: the stop's sine and cosine.
  const double sine = sign * share * (radius * less - rest), cosine = rest * less + share * share * radius;
  if (!(sine >= 0 && sign * (radius - cosine) > 0)) return Slid::kLeaves;
  const Point aside = at - hip * (level * per_reach2);
  const double both2 = reach2 * squared(aside), per_both = inverse_root(both2);
  const double up = radius * cosine * per_reach2, out = radius * sine * per_both;
  touch.god_object = {hip.x * up + aside.x * out, hip.y * up + aside.y * out, hip.z * up + aside.z * out + centre_z};
  return Slid::kRests;
}

struct Sphere {
  static constexpr bool kIsConvex = true;
  double sign, radius, extent;

  explicit Sphere(const fdcg_surface& s) : sign(s.is_hollow != 0 ? -1 : 1), radius(s.radius_m), extent(radius) {}
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(x) - radius * radius) >= 0; }
  [[nodiscard]] bool is_clear(Point x, double way) const { return is_clear_of_ball(sign, squared(x), radius, way); }
  [[nodiscard]] Span span(Point from, Point way) const { return ball_span(from, way, radius); }
  [[nodiscard]] uint32_t piece_near(Point) const { return 0; }
  [[nodiscard]] Entry land(uint32_t, Point at) const {
    const double length = norm(at);
    return {length > 0, at * (length > 0 ? radius / length : 0), kOnlyFace};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }
  FDCG_HOT bool slide_quickly(uint32_t, Touch& touch) const { return slide_on_ball(touch, 0, radius, sign) == Slid::kRests; }
  Decision rule(SurfaceWalk& walk) const { return decide(slide_on_ball(walk, 0, radius, sign), kFree); }
  // x is on the sphere up to rounding error.
  [[nodiscard]] Point normal(Feature, Point x, Point) const {
    const Point near = x * (1 / radius);
    return near * (sign * inverse_root_near_1(squared(near) - 1));
  }
};

// What is within `radius` of a segment of the z axis.
struct Capsule {
  static constexpr bool kIsConvex = true;
  double sign, radius, per_radius, half, extent;

  struct Spot {
    Point at, normal;
    bool is_on_side;
  };

  explicit Capsule(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1),
        radius(s.radius_m),
        per_radius(1 / radius),
        half(s.length_m / 2),
        extent(radius + half) {}
  [[nodiscard]] double nearest_z(Point x) const { return x.z > half ? half : (x.z < -half ? -half : x.z); }
  [[nodiscard]] Point from_segment(Point x) const { return {x.x, x.y, x.z - nearest_z(x)}; }
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(from_segment(x)) - radius * radius) >= 0; }
  [[nodiscard]] bool is_clear(Point x, double way) const {
    return is_clear_of_ball(sign, squared(from_segment(x)), radius, way);
  }
  // The side's span and those of the caps' balls together: a convex body's.
  [[nodiscard]] Span span(Point from, Point way) const {
    Span all = kWholeLine;
    const Point flat_from = {from.x, from.y, 0}, flat_way = {way.x, way.y, 0};
    if (squared(flat_way) > 0) {
      all = ball_span(flat_from, flat_way, radius);
    } else if (!(squared(flat_from) < radius * radius)) {
      all = kNoSpan;
    }
    cut_slab(from.z, way.z, half, 0, &all);
    if (all.is_empty()) all = kNoSpan;
    const double centres[] = {-half, half};
    for (const double z : centres) {
      const Span ball = ball_span({from.x, from.y, from.z - z}, way, radius);
      if (ball.is_empty()) continue;
      all = {ball.in < all.in ? ball.in : all.in, ball.out > all.out ? ball.out : all.out, 0, 0};
    }
    return all;
  }
  [[nodiscard]] uint32_t piece_near(Point) const { return 0; }
  [[nodiscard]] Feature feature_at(Point x) const { return {FDCG_FACE, x.z > half ? 2u : (x.z < -half ? 1u : 0u)}; }
  [[nodiscard]] Entry land(uint32_t, Point at) const {
    const Point arm = from_segment(at);
    const double length = norm(arm);
    if (!(length > 0)) return kNoEntry;
    const Point point = {arm.x * (radius / length), arm.y * (radius / length), arm.z * (radius / length) + nearest_z(at)};
    return {true, point, feature_at(point)};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }

  [[nodiscard]] Point outward(Point x) const {
    const Point near = from_segment(x) * per_radius;
    return near * inverse_root_near_1(squared(near) - 1);
  }
  [[nodiscard]] FDCG_HOT Spot spot(Point x, Point) const { return {x, outward(x) * sign, absolute(x.z) <= half}; }
  [[nodiscard]] FDCG_HOT Spot project(Point p, const Spot&) const {
    const Point out = outward(p);
    const double z = nearest_z(p);
    return {{out.x * radius, out.y * radius, out.z * radius + z}, out * sign, absolute(p.z) <= half};
  }
  [[nodiscard]] FDCG_HOT Point turn(const Spot& spot, Point v) const {
    const Point along = {v.x, v.y, spot.is_on_side ? 0 : v.z};
    return along * (sign * per_radius);
  }
  [[nodiscard]] static double turn_rate(const Spot&, Point, double) { return 0; }
  [[nodiscard]] double curvature_sum(const Spot& spot) const { return sign * per_radius * (spot.is_on_side ? 1 : 2); }
  [[nodiscard]] double curvature_product(const Spot& spot) const { return spot.is_on_side ? 0 : per_radius * per_radius; }
  [[nodiscard]] static bool bends_alike(const Spot& a, const Spot& b) { return a.is_on_side == b.is_on_side; }
  static bool cross(const Spot&, Spot*, Feature*) { return false; }
  // Where it stays on the side, or on a cap.
  FDCG_HOT bool slide_quickly(uint32_t, Touch& touch) const {
    const double z = touch.god_object.z;
    if (absolute(z) <= half) return slide_round(CylinderProfile{sign, radius, per_radius, half}, touch);
    Touch on_cap = touch;
    const bool is_rest = slide_on_ball(on_cap, z > 0 ? half : -half, radius, sign) == Slid::kRests;
    if (!is_rest || !(z > 0 ? on_cap.god_object.z > half : on_cap.god_object.z < -half)) return false;
    touch = on_cap;
    return true;
  }
  Decision rule(SurfaceWalk& walk) const {
    Feature none;
    const Slid slid = slide_on_piece(*this, walk, &none);
    walk.active = feature_at(walk.god_object);
    return decide(slid, none);
  }
  [[nodiscard]] Point normal(Feature, Point x, Point) const { return spot(x, x).normal; }
};

struct Ellipsoid {
  static constexpr bool kIsConvex = true;
  double sign, extent;
  Point half, inverse, inverse2;  // semi-axes, their inverses and the squares of these
  double per_volume2;             // the product of inverse2

  struct Spot {
    Point at, normal;
    double per_steepness;  // 1 / |gradient| of the sum of (x / half)^2, halved
  };

  explicit Ellipsoid(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1), half(vec(s.half_m)), inverse{1 / half.x, 1 / half.y, 1 / half.z} {
    inverse2 = scaled(inverse, inverse);
    per_volume2 = inverse2.x * inverse2.y * inverse2.z;
    extent = half.x > half.y ? half.x : half.y;
    extent = half.z > extent ? half.z : extent;
  }
  static Point scaled(Point x, Point by) { return {x.x * by.x, x.y * by.y, x.z * by.z}; }
  [[nodiscard]] Point gradient(Point x) const { return scaled(x, inverse2); }
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(scaled(x, inverse)) - 1) >= 0; }
  [[nodiscard]] bool is_clear(Point x, double way) const {
    return is_clear_of_ball(sign, squared(scaled(x, inverse)), 1, way * larger(inverse.x, larger(inverse.y, inverse.z)));
  }
  [[nodiscard]] Span span(Point from, Point way) const { return ball_span(scaled(from, inverse), scaled(way, inverse), 1); }
  [[nodiscard]] uint32_t piece_near(Point) const { return 0; }
  [[nodiscard]] Entry land(uint32_t, Point at) const {
    const double length = norm(scaled(at, inverse));
    return {length > 0, at * (length > 0 ? 1 / length : 0), kOnlyFace};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }

  [[nodiscard]] FDCG_HOT Spot spot(Point x, Point) const {
    const Point g = gradient(x);
    const double per_length = inverse_root(squared(g));
    return {x, g * (sign * per_length), per_length};
  }
  // Along the gradient, then what is left along the ray: that is of third order, and exact to rounding.
  [[nodiscard]] FDCG_HOT Spot project(Point p, const Spot& spot) const {
    const Point g = gradient(p);
    const Point near = p - g * ((dot(p, g) - 1) * (0.5 * spot.per_steepness * spot.per_steepness));
    return this->spot(near * inverse_root_near_1(squared(scaled(near, inverse)) - 1), near);
  }
  [[nodiscard]] FDCG_HOT Point turn(const Spot& spot, Point v) const {
    const Point bent = gradient(v);
    return (bent - spot.normal * dot(bent, spot.normal)) * (sign * spot.per_steepness);
  }
  [[nodiscard]] FDCG_HOT double turn_rate(const Spot& spot, Point v, double along) const {
    return -3 * sign * spot.per_steepness * along * dot(gradient(v), spot.normal);
  }
  [[nodiscard]] double curvature_sum(const Spot& spot) const {
    const double along = dot(gradient(spot.normal), spot.normal);
    return sign * (inverse2.x + inverse2.y + inverse2.z - along) * spot.per_steepness;
  }
  [[nodiscard]] double curvature_product(const Spot& spot) const {
    const double per_steepness2 = spot.per_steepness * spot.per_steepness;
    return per_volume2 * (per_steepness2 * per_steepness2);
  }
  [[nodiscard]] static bool bends_alike(const Spot&, const Spot&) { return true; }
  static bool cross(const Spot&, Spot*, Feature*) { return false; }
  FDCG_HOT bool slide_quickly(uint32_t, Touch& touch) const {
    return touch.friction.mu_dynamic == 0 ? slide_to_nearest(touch) : slide_in_one(*this, touch);
  }
  // Without friction the descent ends at a nearest place: x with hip = x + t gradient(x) (Eberly's secular equation in t, in
  // the form whose Newton steps are nearly exact). False where that is not near.
  FDCG_HOT bool slide_to_nearest(Touch& touch) const {
    constexpr double kLeast = 0x1p-6, kDone = 0x1p-26, kMostBent2 = 0x1p-4;
    const Point hip = touch.hip, squares = scaled(half, half);
    const Spot from = spot(touch.god_object, hip);
    const Press press = press_at(from, hip);
    if (!(press.load > 0)) return false;
    if (touch.friction.slip(touch.god_object, press.pull2, press.load).is_rest) return true;
    const double most = larger(inverse.x, larger(inverse.y, inverse.z)), bend = extent * most * most;  // the sharpest
    const double doubt = 2 * pull_rounding(touch) + 8 * kEps * norm1(touch.god_object) * bend * press.load;
    if (!(press.pull2 > doubt * doubt)) return true;
    double t = -sign * press.load * from.per_steepness;
    for (int i = 0; i < 4; ++i) {
      const Point lower = {squares.x + t, squares.y + t, squares.z + t};
      if (!(lower.x > kLeast * squares.x && lower.y > kLeast * squares.y && lower.z > kLeast * squares.z)) return false;
      const Point per = {1 / lower.x, 1 / lower.y, 1 / lower.z}, q = scaled(scaled(hip, half), per);
      const Point q2 = scaled(q, q);
      const double e = q2.x + q2.y + q2.z - 1;
      if (!(absolute(e) < 0.125)) return false;
      const double per_fall = 1 / dot(q2, per), step = 0.5 * e * per_fall;
      const double change = absolute(step) * larger(per.x, larger(per.y, per.z));
      if (absolute(e) <= kDone && change <= kDone) {  // what is left is of second order, but for the ray
        const Point unit = {q.x * (1 - step * per.x), q.y * (1 - step * per.y), q.z * (1 - step * per.z)};
        const Point to = scaled(unit, half) * inverse_root_near_1(squared(unit) - 1);
        if (!(squared(to - touch.god_object) * (bend * bend) <= kMostBent2 && sign * t < 0)) return false;
        touch.god_object = to;
        return true;
      }
      t = t + e * (0.5 + e * (0.375 - e * 0.0625)) * per_fall;
    }
    return false;
  }
  Decision rule(SurfaceWalk& walk) const {
    Feature none;
    return decide(slide_on_piece(*this, walk, &none), none);
  }
  [[nodiscard]] Point normal(Feature, Point x, Point) const { return spot(x, x).normal; }
};

}  // namespace fdcg
