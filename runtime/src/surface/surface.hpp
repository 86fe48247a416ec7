// SPDX-License-Identifier: Apache-2.0
// What the surfaces without a mesh have in common: the contact within one step, the way through free space, friction on a plane
// and on a circle. surface_slide.hpp has the slide over a curved piece; surface_round.hpp, surface_torus.hpp, surface_box.hpp
// and surface_cone.hpp hold the shapes; surface_step.cpp drives them. Each shape has
//
//   bool is_outside(x)                  in free space, the surface included; one expression wherever it is asked
//   Entry enter(from, to, begins_outside)    what a way meets first from its front; `from` may be on the surface
//   bool is_clear(x, way)               in free space and farther than that from the surface
//   Decision rule(walk)                 as contact-model FACE-1, EDGE-1, CORNER-1 and on, at walk.active
//   bool slide_quickly(face, touch)     on a face, what a tick most often is: the god-object rests, moved or not; false where
//                                       the rules must say
//   Point normal(feature, x, hip)       away from the material; of the HIP a direction from x is enough, at an apex
//   static bool kIsConvex               the solid, or the cavity, is convex
//   double sign                         1 solid, -1 hollow
//   double extent                       no coordinate of a place on it is larger, nor much smaller than the largest
#pragma once

#include "fdcg/surface.h"
#include "step/walk.hpp"

namespace fdcg {

using Point = Vec3<double>;

inline constexpr double kEps = RealLimits<double>::kEpsilon;

inline double squared(Point a) {
  return dot(a, a);
}
// Distance from the z axis.
inline double from_axis(Point p) {
  return root(p.x * p.x + p.y * p.y);
}

// 1 / sqrt(a), with root and division at once.
FDCG_HOT double inverse_root(double a) {
  return root(a) * (1 / a);
}

// 1 / sqrt(1 + e), and without the latency of root and division where e is small: a move's, or only rounding.
FDCG_HOT double inverse_root_near_1(double e) {
  constexpr double kSmall = 0x1p-10, kSmaller = 0x1p-18, kTiny = 0x1p-27;
  const double size = absolute(e);
  if (size < kTiny) return 1 - e * 0.5;
  if (size < kSmaller) return 1 - e * (0.5 - e * 0.375);
  if (size < kSmall) return 1 - e * (0.5 - e * (0.375 - e * (0.3125 - e * (0.2734375 - e * 0.24609375))));
  return 1 / root(1 + e);
}

// 1 / sqrt(a), where that is most often near `guess`.
FDCG_HOT double inverse_root_near(double a, double guess) {
  const double e = a * guess * guess - 1;
  return absolute(e) < 0.5 ? guess * inverse_root_near_1(e) : 1 / root(a);
}

// One contact on one feature within one step.
struct Touch {
  Friction<double> friction;
  Point hip, god_object;
};
// ... within the whole step.
struct SurfaceWalk : Touch {
  Feature active;
  uint32_t moves_left;
};

// What a way through free space met first.
struct Entry {
  bool is_met;
  Point point;  // on the surface
  Feature feature;
};
inline constexpr Entry kNoEntry = {false, {0, 0, 0}, kFree};

// Whether what is at a squared distance from the middle of a ball, or of a tube, is farther than `way` from its surface, and
// free.
FDCG_HOT bool is_clear_of_ball(double sign, double distance2, double radius, double way) {
  const double least = radius + sign * way;
  return sign > 0 ? distance2 > least * least : least > 0 && distance2 < least * least;
}

// ---- ways ---------------------------------------------------------------------------------------------------------------

// The part of a straight line that is inside a convex body, by t in from + way * t, and the pieces through which it enters and
// leaves. Empty unless in < out.
struct Span {
  double in, out;
  uint32_t piece_in, piece_out;

  [[nodiscard]] bool is_empty() const { return !(in < out); }
  void cut_before(double t, uint32_t piece) {
    if (t > in) in = t, piece_in = piece;
  }
  void cut_after(double t, uint32_t piece) {
    if (t < out) out = t, piece_out = piece;
  }
};
inline constexpr double kNever = 1e300;
inline constexpr Span kWholeLine = {-kNever, kNever, 0, 0};
inline constexpr Span kNoSpan = {kNever, -kNever, 0, 0};

// a / b, or kNever in its sign where that would be larger.
inline double bounded_ratio(double a, double b) {
  const bool is_number = absolute(b) >= 1 || absolute(a) < absolute(b) * kNever;
  return is_number ? a / b : ((a < 0) == (b < 0) ? kNever : -kNever);
}

// Keeps what lies between two parallel planes, x in -half to half; the pieces are `low` and low + 1.
inline void cut_slab(double x, double way, double half, uint32_t low, Span* span) {
  if (way == 0) {
    if (!(absolute(x) < half)) *span = kNoSpan;  // along a plane nothing is entered
    return;
  }
  const double minus = bounded_ratio(-half - x, way), plus = bounded_ratio(half - x, way);
  span->cut_before(way > 0 ? minus : plus, way > 0 ? low : low + 1);
  span->cut_after(way > 0 ? plus : minus, way > 0 ? low + 1 : low);
}

// What lies in a ball around the origin, from the line's middle in it: nothing cancels.
[[gnu::noinline]] inline Span ball_span(Point from, Point way, double radius) {
  const double length2 = squared(way);
  if (!(length2 > 0)) return kNoSpan;
  const double middle = bounded_ratio(-dot(from, way), length2);
  const double left2 = radius * radius - squared(from + way * middle);
  if (!(left2 > 0)) return kNoSpan;
  const double half = root(bounded_ratio(left2, length2));
  return {middle - half, middle + half, 0, 0};
}

struct Way {
  Point from, to;
};

// A way that begins or ends far off, cut to the part near the surface: far away the spacing of numbers exceeds the surface's
// size. Nothing within four extents of the origin is cut off.
[[gnu::noinline]] inline Way near_part(Point from, Point to, double extent) {
  constexpr double kFar = 16, kKept = 4;  // extents
  const double from1 = norm1(from), to1 = norm1(to);
  if (from1 <= kFar * extent && to1 <= kFar * extent) return {from, to};
  const Point way = to - from;
  const double length = norm(way);
  if (!(length > 0)) return {from, to};
  const Point along = way * (1 / length);
  const Point base = from1 < to1 ? from : to;  // the nearer end, where numbers are finer
  const Point middle = base - along * dot(base, along);
  const double before = dot(from, along), after = dot(to, along);
  Way near = {from, to};
  if (before < -kKept * extent) near.from = middle - along * (after < -kKept * extent ? -after : kKept * extent);
  if (after > kKept * extent) near.to = middle + along * (before > kKept * extent ? before : kKept * extent);
  return near;
}

// What a way meets first of a convex solid, or of the wall of a convex cavity. Where the signs at both ends say that it must
// have met something, a place is returned, whatever the rounding of the way between. Shape: span(from, way), land(piece,
// point).
template <class Shape>
[[gnu::noinline]] Entry enter_convex(const Shape& shape, Point from, Point to, bool begins_outside) {
  const bool ends_outside = shape.is_outside(to);
  const bool is_solid = shape.sign > 0;
  if (is_solid ? !begins_outside : ends_outside) return kNoEntry;
  const Way near = near_part(from, to, shape.extent);
  const Point way = near.to - near.from;
  const Span span = shape.span(near.from, way);
  if (span.is_empty()) return ends_outside || !begins_outside ? kNoEntry : shape.land(shape.piece_near(to), to);
  if (is_solid) {
    const bool is_on_way = span.in <= 1 && span.out > 0;
    if (!is_on_way) return ends_outside ? kNoEntry : shape.land(shape.piece_near(to), to);
    return shape.land(span.piece_in, near.from + way * (span.in > 0 ? span.in : 0));
  }
  if (!begins_outside && !(span.in > 0 && span.out < 1)) return kNoEntry;  // within the wall
  const double out = span.out < 0 ? 0 : (span.out > 1 ? 1 : span.out);
  return shape.land(span.piece_out, near.from + way * out);
}

// ---- planes -------------------------------------------------------------------------------------------------------------

enum class Slid { kRests, kSlides, kLeaves, kCrosses, kIsCut };

// What the rules make of a slide; a piece that ends goes on at `next`.
inline Decision decide(Slid slid, Feature next) {
  if (slid == Slid::kLeaves) return go_to(kFree);
  return slid == Slid::kCrosses ? go_to(next) : rest();
}

// The god-object on a plane, which the HIP is `load` below; `across` is the part in the plane of the way from the HIP to the
// god-object. Where it slides, *shrink is what becomes of that part.
FDCG_HOT Slid slide_on_plane(Touch& touch, Point across, double load, double* shrink) {
  if (!(load > 0)) return Slid::kLeaves;
  const double across2 = squared(across);
  const Slip<double> slip = touch.friction.slip(touch.god_object, across2, load);
  if (slip.is_rest) return Slid::kRests;
  *shrink = slip.gap > 0 ? slip.gap / root(across2) : 0;
  return Slid::kSlides;
}

// ---- circles ------------------------------------------------------------------------------------------------------------

// Where on a circle friction stops a slide: the HIP, `reach` off the axis, pulls with reach * sin(angle) and presses with
// base - lift * cos(angle); angle is that from the HIP to the god-object and shrinks. Stops where the pull is mu times the
// load. False where no load is left before.
struct Arc {
  double sine, cosine;
};
inline bool stop_on_circle(double reach, double base, double lift, double mu, Arc* stop) {
  const double drop = mu * lift, size = root(reach * reach + drop * drop);
  double sine = mu * base / size;
  if (!(sine >= -1)) return false;
  sine = sine < 1 ? sine : 1;
  const double cosine = root((1 - sine) * (1 + sine));
  *stop = {(sine * reach - cosine * drop) / size, (cosine * reach + sine * drop) / size};
  return stop->sine >= 0 && base - lift * stop->cosine > 0;
}

// A god-object is placed where its pull is that of friction but for this share. Half of it is left for rounding.
inline constexpr double kPlaced = 0x1p-41;
// Of pull_rounding(): a slide that has moved it ends with this much pull too many, or too few.
inline constexpr double kRestShare = 0.0625;

// The rounding error of a pull, from the god-object's place and the normal there. A smaller pull does not move it.
inline double pull_rounding(const Touch& touch) {
  return 4 * kEps * (norm1(touch.god_object) + norm1(touch.hip));
}

}  // namespace fdcg
