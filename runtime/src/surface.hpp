// SPDX-License-Identifier: Apache-2.0
// What the surfaces without a mesh have in common: the contact within one step, the way through free space, friction on a plane
// and the slide over a curved piece. surface_round.hpp, surface_torus.hpp, surface_box.hpp and surface_cone.hpp hold the
// shapes; surface_step.cpp drives them. Each shape has
//
//   bool is_outside(x)                  in free space, the surface included; one expression wherever it is asked
//   Entry enter(from, to, begins_outside)    what a way meets first from its front; `from` may be on the surface
//   bool is_clear(x, way)               in free space and farther than that from the surface
//   Decision rule(walk)                 the rules of contact-model sections 5 to 7 at walk.active
//   bool slide_quickly(face, touch)     on a face, what a tick most often is: the god-object rests, moved or not; false where
//                                       the rules must say
//   Point normal(feature, x, hip)       away from the material; of the HIP a direction from x is enough, at an apex
//   static bool kIsConvex               the solid, or the cavity, is convex
//   double sign                         1 solid, -1 hollow
//   double extent                       no coordinate of a place on it is larger, nor much smaller than the largest
#pragma once

#include "fdcg/surface.h"
#include "walk.hpp"

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

// A way that begins or ends far off, cut to what is near: out there numbers are coarser than the surface. Nothing is cut off
// that lies within four extents of the origin.
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
// have met something, it does, whatever rounding makes of the way between. Shape: span(from, way), land(piece, point).
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

// What rounding, of the god-object's place and of the normal there, makes of a pull. Less is no reason to place it anew.
inline double pull_rounding(const Touch& touch) {
  return 4 * kEps * (norm1(touch.god_object) + norm1(touch.hip));
}

// ---- curved pieces ------------------------------------------------------------------------------------------------------

// 1 / sqrt(1 + e), and without the latency of root and division where e is small: a move's, or only rounding.
FDCG_HOT double inverse_root_near_1(double e) {
  constexpr double kSmall = 0x1p-10, kSmaller = 0x1p-18, kTiny = 0x1p-27;
  const double size = absolute(e);
  if (size < kTiny) return 1 - e * 0.5;
  if (size < kSmaller) return 1 - e * (0.5 - e * 0.375);
  if (size < kSmall) return 1 - e * (0.5 - e * (0.375 - e * (0.3125 - e * (0.2734375 - e * 0.24609375))));
  return 1 / root(1 + e);
}

// The Newton step to where there is no pull, of a surface that the HIP is not too deep in: (1 - load S) step = -across, where S
// says how the normal turns (its trace and determinant are the sum and the product of the principal curvatures). False where
// the god-object is not near a minimum.
template <class Piece, class Spot>
FDCG_HOT bool step_to_minimum(const Piece& piece, const Spot& spot, Point across, Point turned, double load, Point* step) {
  constexpr double kLeast = 0x1p-10;
  const double sum = piece.curvature_sum(spot), product = piece.curvature_product(spot);
  const double trace = 2 - load * sum, determinant = 1 - load * (sum - load * product);
  if (!(trace > 0 && determinant > kLeast * (1 + load * load * absolute(product)))) return false;
  *step = (across * (1 - load * sum) + turned * load) * (-1 / determinant);
  return true;
}

// The spring's force at a place, by the stiffness: the part along the normal, and the one across it.
struct Press {
  Point across;
  double load, pull2;  // |across|^2
};
template <class Spot>
FDCG_HOT Press press_at(const Spot& spot, Point hip) {
  const Point gap = spot.at - hip;
  const double load = dot(gap, spot.normal);
  const Point across = gap - spot.normal * load;
  return {across, load, squared(across)};
}

// How a surface bends along a pull.
struct Bend {
  Point turned;         // how the normal changes along it
  double along, turn2;  // pull * turned; |turned|^2
  double rate;          // how `along` changes along a geodesic that begins with the pull
};

template <class Piece, class Spot>
FDCG_HOT Bend bend_of(const Piece& piece, const Spot& spot, Point pull) {
  const Point turned = piece.turn(spot, pull);
  const double along = dot(pull, turned);
  return {turned, along, squared(turned), piece.turn_rate(spot, pull, along)};
}

// What is left of (|pull|^2 - (mu load)^2) / |pull|^2 after a way of `length`, in units of the pull, to second order:
// excess - 2 fall length + bow length^2.
struct Course {
  double excess, fall, bow;
};
// `turn2`: |turned|^2 along a geodesic; along the steepest descent, which turns by what `turned` has across the pull, that
// again.
FDCG_HOT Course course_of(const Press& press, const Bend& bend, double mu, double turn2, double per_pull2) {
  const double load = press.load, held = mu * load, both = 1 + mu * mu, taken = load * bend.along;
  const double bent = bend.along * bend.along + taken - load * load * turn2 + load * bend.rate;
  return {1 - held * held * per_pull2, 1 - both * taken * per_pull2, 1 - (taken + both * bent) * per_pull2};
}

// One move of a slide.
struct Move {
  Point step;
  bool is_near;   // what it leaves may be below what set_right() sets right
  bool is_last;   // what it leaves is below rounding
  bool has_none;  // friction holds the god-object after all
};

// A god-object is placed where its pull is that of friction but for this share. Half of it is left for rounding.
inline constexpr double kPlaced = 0x1p-41;

template <class Piece, class Spot>
FDCG_HOT Move next_move(const Piece& piece, const Spot& spot, const Press& press, double mu, double rounding, bool has_moved) {
  constexpr double kLargestTurn = 0.25, kLeastFall = 0x1p-20, kLeastExcess = -64;
  const double load = press.load, pull = root(press.pull2), held = mu * load;
  const Bend bend = bend_of(piece, spot, press.across);
  const double turn1 = norm1(bend.turned), per_pull2 = 1 / press.pull2, per_pull = pull * per_pull2, bent = turn1 * per_pull;
  // Where the surface bends sharply, the rounding of a place is one of the normal that the load makes much of.
  const double doubt =
      has_moved ? rounding * 0.0625 : 2 * rounding + 8 * kEps * norm1(spot.at) * bent * (load + pull) + kPlaced * pull;
  if (absolute(pull - held) <= doubt) return {{0, 0, 0}, false, true, true};
  Point step;
  if (mu == 0 && step_to_minimum(piece, spot, press.across, bend.turned, load, &step) && norm1(step) * bent <= kLargestTurn) {
    const double length = norm1(step);
    return {step, false, 1024 * length * length * (per_pull + bent * (1 + bent * (load + pull))) <= rounding, false};
  }
  const double curvature = bend.along * per_pull2;
  const Course course = course_of(press, bend, mu, 2 * bend.turn2 - curvature * bend.along, per_pull2);
  if (!(course.fall > kLeastFall)) {
    if (pull < held) return {{0, 0, 0}, false, true, true};
    return {press.across * (-kLargestTurn / turn1), false, false, false};
  }
  const double excess = larger(course.excess, kLeastExcess), left = course.fall * course.fall - course.bow * excess;
  const double length = excess / (course.fall + (left > 0 ? root(left) : 0));
  if (!(absolute(length) * turn1 <= kLargestTurn)) {
    return {press.across * ((pull < held ? kLargestTurn : -kLargestTurn) / turn1), false, false, false};
  }
  // To second order: the descent's direction changes, since the load turns the pull.
  const double half = 0.5 * load * length;
  const bool is_small = half * half * bend.turn2 <= 0.25 * press.pull2;
  const Point aside = bend.turned - press.across * curvature;
  return {(press.across + aside * (is_small ? half : 0)) * -length, is_small, false, false};
}

// The last of a slide, where a move has left so little that the surface is a parabola there: without looking for it again.
// False where it is too much.
template <class Piece, class Spot>
FDCG_HOT bool set_right(const Piece& piece, const Spot& spot, const Press& press, double mu, Point* god_object) {
  constexpr double kNear2 = 1e60;        // the HIP; beyond, products of four are no numbers
  constexpr double kMostTurn = 0x1p-20;  // of the normal: its cube is nothing
  const double load = press.load, load2 = load * load, pull2 = press.pull2, both = 1 + mu * mu;
  if (!(pull2 < kNear2 && load2 < kNear2)) return false;
  const Bend bend = bend_of(piece, spot, press.across);
  const double taken = load * bend.along, turned2 = load2 * bend.turn2, fall = pull2 - both * taken;
  const double excess = pull2 - mu * mu * load2, per_fall = 1 / fall, first = 0.5 * excess * per_fall;
  const double bow = pull2 - taken - both * (bend.along * bend.along + taken - turned2 + load * bend.rate);
  const double length = first + first * first * (0.5 * bow * per_fall), size = absolute(length);
  const double bent = 1 + both * both * turned2 * absolute(per_fall);
  if (!(fall > 0.125 * pull2 && 4 * size * size * size * (bent * bent) <= kPlaced)) return false;
  if (!(size * norm1(bend.turned) <= kMostTurn)) return false;
  *god_object = spot.at - press.across * length - spot.normal * (0.5 * bend.along * length * length);
  return true;
}

// The way of steepest descent over a curved piece, to where friction stops it: pull = mu * load, both of them parts of the
// spring's force where the god-object then is. Each move is a Newton step of that equation, along the direction that the
// descent has in the middle of the move (from the piece's curvature), so that the way is right to second order; no move turns
// the normal by more than a quarter of a radian. Piece:
//
//   Spot spot(x, hip)            a place on it: `at`, `normal`, and what the others want to know
//   Spot project(p, spot)        the place near p, which is near the spot
//   Point turn(spot, v)          how the normal changes along the tangent v; linear in it
//   double turn_rate(spot, v, along)   how `along` = dot(v, turn(v)) changes on a geodesic along v
//   curvature_sum, _product      of the spot's principal curvatures
//   bool bends_alike(spot, spot) false where the curvature may be quite another
//   bool cross(from, &to, &next) whether the piece ends on the way; to->at is put on its end, `next` is what is there
template <class Piece>
[[gnu::noinline]] Slid slide_on_piece(const Piece& piece, SurfaceWalk& walk, Feature* next) {
  const Point start = walk.god_object - walk.hip;
  const double rounding = pull_rounding(walk);
  const double start2 = squared(start) + 2 * norm1(start) * rounding;  // but for the rounding of both places
  auto spot = piece.spot(walk.god_object, walk.hip);
  double mu = -1, share = 1;
  bool is_near = false;
  for (bool has_moved = false; walk.moves_left > 0; --walk.moves_left) {
    const Press press = press_at(spot, walk.hip);
    if (!(press.load > 0)) return Slid::kLeaves;
    if (mu < 0) {
      const Slip<double> slip = walk.friction.slip(walk.god_object, press.pull2, press.load);
      if (slip.is_rest) return Slid::kRests;
      mu = walk.friction.mu_dynamic;
    }
    if (!(press.pull2 > rounding * rounding)) return Slid::kRests;
    if (is_near && set_right(piece, spot, press, mu, &walk.god_object)) return Slid::kRests;
    const Move move = next_move(piece, spot, press, mu, rounding, has_moved);
    if (move.has_none) return Slid::kRests;
    auto to = piece.project(spot.at + move.step * share, spot);
    if (squared(to.at - walk.hip) > start2) {  // a piece that bends sharply ahead
      share = share * 0.25;
      if (!(norm1(move.step) * share > rounding)) return Slid::kRests;
      continue;
    }
    const bool has_crossed = piece.cross(spot, &to, next);
    walk.god_object = to.at;
    if (has_crossed) return Slid::kCrosses;
    const bool is_smooth = piece.bends_alike(spot, to);
    if (move.is_last && share == 1 && is_smooth) return Slid::kRests;
    is_near = share == 1 && is_smooth && move.is_near;
    share = share < 0.25 ? share * 4 : 1;
    has_moved = true;
    spot = to;
  }
  return Slid::kIsCut;
}

// The same where one move and one correction do, as most often. True where the god-object rests, moved or not.
template <class Piece>
FDCG_HOT bool slide_in_one(const Piece& piece, Touch& touch) {
  const double rounding = pull_rounding(touch), mu = touch.friction.mu_dynamic;
  const auto from = piece.spot(touch.god_object, touch.hip);
  const Press press = press_at(from, touch.hip);
  if (!(press.load > 0)) return false;
  const Slip<double> slip = touch.friction.slip(touch.god_object, press.pull2, press.load);
  if (slip.is_rest || !(press.pull2 > rounding * rounding)) return true;
  const Move move = next_move(piece, from, press, mu, rounding, false);
  if (move.has_none || !move.is_near) return move.has_none;
  const auto to = piece.project(from.at + move.step, from);
  const Press last = press_at(to, touch.hip);
  const bool is_nearer = last.pull2 + last.load * last.load <= press.pull2 + press.load * press.load;
  return is_nearer && last.load > 0 && set_right(piece, to, last, mu, &touch.god_object);
}

// What the rules make of a slide; a piece that ends goes on at `next`.
inline Decision decide(Slid slid, Feature next) {
  if (slid == Slid::kLeaves) return go_to(kFree);
  return slid == Slid::kCrosses ? go_to(next) : rest();
}

}  // namespace fdcg
