// SPDX-License-Identifier: Apache-2.0
// The convex surfaces without an edge: plane, sphere, capsule, ellipsoid.
#pragma once

#include "surface.hpp"

namespace fdcg {

inline constexpr Feature kOnlyFace = {FDCG_FACE, 0};

// z = 0, solid below.
struct PlaneSurface {
  static constexpr bool kIsConvex = true;
  static constexpr double sign = 1, extent = 1;

  explicit PlaneSurface(const fdcg_surface&) {}
  [[nodiscard]] bool is_outside(Point x) const { return x.z >= 0; }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    if (!begins_outside || is_outside(to)) return kNoEntry;
    const double t = from.z / (from.z - to.z);
    return {true, {from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t, 0}, kOnlyFace};
  }
  Decision rule(SurfaceWalk& walk) const {
    const Point across = {walk.god_object.x - walk.hip.x, walk.god_object.y - walk.hip.y, 0};
    double shrink = 0;
    const Slid slid = slide_on_plane(walk, across, -walk.hip.z, &shrink);
    if (slid == Slid::kSlides) walk.god_object = {walk.hip.x + across.x * shrink, walk.hip.y + across.y * shrink, 0};
    return decide(slid, kFree);
  }
  [[nodiscard]] Point normal(Feature, Point) const { return {0, 0, 1}; }
};

struct Sphere {
  static constexpr bool kIsConvex = true;
  double sign, radius, extent;

  explicit Sphere(const fdcg_surface& s) : sign(s.is_hollow != 0 ? -1 : 1), radius(s.radius_m), extent(radius) {}
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(x) - radius * radius) >= 0; }
  [[nodiscard]] Span span(Point from, Point way) const { return ball_span(from, way, radius); }
  [[nodiscard]] uint32_t piece_near(Point) const { return 0; }
  [[nodiscard]] Entry land(uint32_t, Point at) const {
    const double length = norm(at);
    return {length > 0, at * (length > 0 ? radius / length : 0), kOnlyFace};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }
  // The descent is a great circle towards the HIP: its end has a closed form.
  Decision rule(SurfaceWalk& walk) const {
    const Point up = walk.god_object * (1 / norm(walk.god_object));
    const double height = dot(walk.hip, up), load = sign * (radius - height);
    if (!(load > 0)) return go_to(kFree);
    const Point towards = walk.hip - up * height;
    const double pull2 = squared(towards);
    const Slip<double> slip = walk.friction.slip(walk.god_object, pull2, load);
    if (slip.is_rest) return rest();
    const double pull = root(pull2), reach = root(height * height + pull2), mu = slip.gap / load;
    if (!(pull - mu * load > pull_rounding(walk))) return rest();
    Arc stop;
    if (!stop_on_circle(reach, sign * radius, sign * reach, mu, &stop)) return go_to(kFree);
    const double sine = pull / reach, cosine = height / reach;
    const Point ahead = towards * (radius * (sine * stop.cosine - cosine * stop.sine) / pull);
    walk.god_object = up * (radius * (cosine * stop.cosine + sine * stop.sine)) + ahead;
    return rest();
  }
  [[nodiscard]] Point normal(Feature, Point x) const { return x * (sign / norm(x)); }
};

// What is within `radius` of a segment of the z axis.
struct Capsule {
  static constexpr bool kIsConvex = true;
  double sign, radius, half, extent;

  struct Spot {
    Point normal;
    bool is_on_side;
  };

  explicit Capsule(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1), radius(s.radius_m), half(s.length_m / 2), extent(radius + half) {}
  [[nodiscard]] double nearest_z(Point x) const { return x.z > half ? half : (x.z < -half ? -half : x.z); }
  [[nodiscard]] Point from_segment(Point x) const { return {x.x, x.y, x.z - nearest_z(x)}; }
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(from_segment(x)) - radius * radius) >= 0; }
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

  [[nodiscard]] Spot spot(Point x, Point) const {
    const Point arm = from_segment(x);
    return {arm * (sign / norm(arm)), absolute(x.z) <= half};
  }
  [[nodiscard]] Point turn(const Spot& spot, Point e) const {
    Point along = e;
    if (spot.is_on_side) along.z = 0;
    return along * (sign / radius);
  }
  [[nodiscard]] Point project(Point p, const Spot&) const {
    const Point arm = from_segment(p);
    const double stretch = radius / norm(arm);
    return {arm.x * stretch, arm.y * stretch, arm.z * stretch + nearest_z(p)};
  }
  [[nodiscard]] bool bends_alike(const Spot& spot, Point x) const { return spot.is_on_side == (absolute(x.z) <= half); }
  bool cross(Point, Point*, Feature*) const { return false; }
  Decision rule(SurfaceWalk& walk) const {
    Feature none;
    const Slid slid = slide_on_piece(*this, walk, &none);
    walk.active = feature_at(walk.god_object);
    return decide(slid, none);
  }
  [[nodiscard]] Point normal(Feature, Point x) const { return spot(x, x).normal; }
};

struct Ellipsoid {
  static constexpr bool kIsConvex = true;
  double sign, extent;
  Point half, inverse;  // semi-axes and their inverses

  struct Spot {
    Point normal;
    double steepness;  // |gradient| of the sum of (x / half)^2, halved
  };

  explicit Ellipsoid(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1), half(vec(s.half_m)), inverse{1 / half.x, 1 / half.y, 1 / half.z} {
    extent = half.x > half.y ? half.x : half.y;
    extent = half.z > extent ? half.z : extent;
  }
  static Point scaled(Point x, Point by) { return {x.x * by.x, x.y * by.y, x.z * by.z}; }
  [[nodiscard]] Point gradient(Point x) const { return scaled(scaled(x, inverse), inverse); }
  [[nodiscard]] bool is_outside(Point x) const { return sign * (squared(scaled(x, inverse)) - 1) >= 0; }
  [[nodiscard]] Span span(Point from, Point way) const { return ball_span(scaled(from, inverse), scaled(way, inverse), 1); }
  [[nodiscard]] uint32_t piece_near(Point) const { return 0; }
  [[nodiscard]] Entry land(uint32_t, Point at) const {
    const double length = norm(scaled(at, inverse));
    return {length > 0, at * (length > 0 ? 1 / length : 0), kOnlyFace};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }

  [[nodiscard]] Spot spot(Point x, Point) const {
    const Point g = gradient(x);
    const double length = norm(g);
    return {g * (sign / length), length};
  }
  [[nodiscard]] Point turn(const Spot& spot, Point e) const {
    const Point bent = gradient(e);
    return (bent - spot.normal * dot(bent, spot.normal)) * (sign / spot.steepness);
  }
  // Along the gradient, then what is left along the ray: that is of second order, and exact to rounding.
  [[nodiscard]] Point project(Point p, const Spot&) const {
    const Point g = gradient(p);
    const double over = dot(p, g) - 1;
    const Point near = p - g * (over / (2 * squared(g)));
    const double length = norm(scaled(near, inverse));
    return near * (1 / length);
  }
  [[nodiscard]] bool bends_alike(const Spot&, Point) const { return true; }
  bool cross(Point, Point*, Feature*) const { return false; }
  Decision rule(SurfaceWalk& walk) const {
    Feature none;
    return decide(slide_on_piece(*this, walk, &none), none);
  }
  [[nodiscard]] Point normal(Feature, Point x) const { return spot(x, x).normal; }
};

}  // namespace fdcg
