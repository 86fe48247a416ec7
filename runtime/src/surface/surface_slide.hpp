// SPDX-License-Identifier: Apache-2.0
// The slide over a curved piece of a surface: down the steepest descent of the distance from the HIP, to where friction holds.
#pragma once

#include "surface/surface.hpp"

namespace fdcg {

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

// One move of a slide, on a parabola.
struct Move {
  Point step, bend;
  bool is_near;   // what it leaves may be below what set_right() sets right
  bool is_last;   // what it leaves is below rounding
  bool has_none;  // friction holds the god-object after all

  // From its start, after a share of it.
  [[nodiscard]] Point after(double share) const { return step * share - bend * (share * (1 - share)); }
  [[nodiscard]] Move part(double share) const { return {after(share), bend * (share * share), false, false, false}; }
};
inline Move straight_move(Point step) {
  return {step, {0, 0, 0}, false, false, false};
}

// Where the surface bends sharply, the rounding of a place turns the normal, and the load multiplies that error. `bent`: how
// the normal turns along the pull.
FDCG_HOT double pull_doubt(Point at, double load, double pull, double bent, double rounding, bool has_moved) {
  return has_moved ? rounding * kRestShare : 2 * rounding + 8 * kEps * norm1(at) * bent * (load + pull) + kPlaced * pull;
}
inline constexpr double kLargestTurn = 0.25;  // of the normal, in a move
inline constexpr Move kNoMove = {{0, 0, 0}, {0, 0, 0}, false, true, true};

// With friction, from outside the cone.
template <class Piece, class Spot>
FDCG_HOT Move next_move(const Piece& piece, const Spot& spot, const Press& press, double mu, double rounding, bool has_moved) {
  constexpr double kLargestSwing = 0.25, kLeastFall = 0x1p-20;
  const double load = press.load, pull = root(press.pull2), held = mu * load;
  const Bend bend = bend_of(piece, spot, press.across);
  const double turn1 = norm1(bend.turned), per_pull2 = 1 / press.pull2, per_pull = pull * per_pull2;
  if (pull - held <= pull_doubt(spot.at, load, pull, turn1 * per_pull, rounding, has_moved)) return kNoMove;
  const double curvature = bend.along * per_pull2;
  const Course course = course_of(press, bend, mu, 2 * bend.turn2 - curvature * bend.along, per_pull2);
  const double left = course.fall * course.fall - course.bow * course.excess;
  // The descent's direction changes, since the load turns the pull: a move follows it to second order where it is small.
  const Point aside = bend.turned - press.across * curvature;
  const double most = larger(turn1 * (1 / kLargestTurn), load * norm1(aside) * per_pull * (1 / kLargestSwing));
  const double stop = course.excess / (course.fall + (left > 0 ? root(left) : 0));
  const bool is_near = course.fall > kLeastFall && stop * most <= 1;
  const double length = is_near ? stop : 1 / most;
  const Point bow = aside * (0.5 * load * length * length);
  return {press.across * -length - bow, bow * -1.0, is_near, false, false};
}

// Without friction, towards where there is no pull: a Newton step in each principal direction, downhill. 1 - load S says how
// the pull changes, where S says how the normal turns; its trace and determinant are the sum and the product of the principal
// curvatures. Where the HIP is nearly a centre of curvature, one direction's step is far larger than the other's.
template <class Piece, class Spot>
[[gnu::noinline]] Move move_to_minimum(const Piece& piece, const Spot& spot, const Press& press, double rounding,
                                       bool has_moved) {
  constexpr double kLeast = 0x1p-10, kAlike = 0x1p-20;
  const double load = press.load, pull = root(press.pull2);
  const Point across = press.across, turned = piece.turn(spot, across);
  const double bent = norm1(turned) / pull;
  if (pull <= pull_doubt(spot.at, load, pull, bent, rounding, has_moved)) return kNoMove;
  const double sum = piece.curvature_sum(spot), product = piece.curvature_product(spot);
  const double trace = 2 - load * sum, determinant = 1 - load * (sum - load * product),
               apart2 = trace * trace - 4 * determinant;
  const double apart = apart2 > square(kAlike * trace) ? root(apart2) : 0;
  const double changes[2] = {0.5 * (trace + apart), 0.5 * (trace - apart)};
  const Point first = apart > 0 ? (across - turned * load - across * changes[1]) * (1 / apart) : across;
  const Point parts[2] = {first, across - first};
  Point step = {0, 0, 0};
  bool is_cut = false;
  for (int k = 0; k < 2; ++k) {
    if (!(norm1(parts[k]) > rounding)) continue;  // none
    const double change = absolute(changes[k]), turns = absolute(1 - changes[k]) * norm1(parts[k]) / (load * kLargestTurn);
    is_cut = is_cut || !(changes[k] > kLeast && turns <= change);
    if (change > 0 || turns > 0) step = step - parts[k] * (1 / larger(change, turns));
  }
  const double length = norm1(step);
  const bool is_last = !is_cut && 1024 * length * length * (1 / pull + bent * (1 + bent * (load + pull))) <= rounding;
  return {step, {0, 0, 0}, false, is_last, false};
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

// A place on a piece, and what the spring does there.
template <class Spot>
struct Held {
  Spot spot;
  Press press;

  [[nodiscard]] double excess(double mu) const { return root(press.pull2) - mu * press.load; }
};

// Puts the god-object where friction ends a move on its way: it is outside the cone at `from`, and inside at `to`. kIsCut where
// the moves are used up first; it is at a place outside then.
template <class Piece, class Spot>
[[gnu::noinline]] Slid stop_on_way(const Piece& piece, const Held<Spot>& from, const Move& move, const Held<Spot>& to,
                                   SurfaceWalk& walk) {
  const double mu = walk.friction.mu_dynamic, placed = pull_rounding(walk) * kRestShare;
  double low = 0, high = 1, at_low = from.excess(mu), at_high = to.excess(mu);
  Point outside = from.spot.at, inside = to.spot.at;
  bool was_outside = false;
  walk.god_object = inside;
  if (absolute(at_high) <= placed) return Slid::kRests;
  for (uint32_t i = 1; walk.moves_left > 0; ++i, --walk.moves_left) {
    // By chords; halving now and then, so that it ends whatever the surface is.
    const double part = i % 4 != 0 ? at_low / (at_low - at_high) : 0.5, t = low + (high - low) * part;
    walk.god_object = inside;
    if (!(low < t && t < high)) return Slid::kRests;
    Spot spot = piece.project(from.spot.at + move.after(t), from.spot);
    Feature next;
    piece.cross(from.spot, &spot, &next);  // a way round a curve may be past an end in its middle
    const Held<Spot> at = {spot, press_at(spot, walk.hip)};
    const double excess = at.excess(mu);
    walk.god_object = spot.at;
    if (absolute(excess) <= placed) return Slid::kRests;
    const bool is_outside = excess > 0, is_same = i > 1 && is_outside == was_outside;  // a chord whose one end stays is slow
    if (is_outside) {
      low = t, at_low = excess, outside = spot.at;
      if (is_same) at_high = at_high * 0.5;
    } else {
      high = t, at_high = excess, inside = spot.at;
      if (is_same) at_low = at_low * 0.5;
    }
    was_outside = is_outside;
  }
  walk.god_object = outside;
  return Slid::kIsCut;
}

// The way of steepest descent over a curved piece, to the first place where friction holds the god-object: pull = mu * load,
// both of them parts of the spring's force where the god-object then is. There may be several such places, and none near by,
// where the HIP is deeper than the surface's centre of curvature. Each move is a Newton step of that equation, along the
// direction that the descent has in the middle of the move (from the piece's curvature), so that the way is right to second
// order; no move turns the normal by more than a quarter of a radian. A move that ends inside the cone has passed the place,
// which is then looked for on its way: a slide never ends where friction holds more than it must. Piece:
//
//   Spot spot(x, hip)            a place on it: `at`, `normal`, and what the other functions need
//   Spot project(p, spot)        the place near p, which is near the spot
//   Point turn(spot, v)          how the normal changes along the tangent v; linear in it
//   double turn_rate(spot, v, along)   how `along` = dot(v, turn(v)) changes on a geodesic along v
//   curvature_sum, _product      of the spot's principal curvatures
//   bool bends_alike(spot, spot) false where the curvature may be quite another
//   bool cross(from, &to, &next) whether the piece ends on the way; `to` is put on its end, `next` is what is there
template <class Piece>
[[gnu::noinline]] Slid slide_on_piece(const Piece& piece, SurfaceWalk& walk, Feature* next) {
  const Point start = walk.god_object - walk.hip;
  const double rounding = pull_rounding(walk);
  const double start2 = squared(start) + 0.5 * norm1(start) * rounding;  // but for the rounding of both places
  const auto look = [&](const auto& spot) { return Held<decltype(piece.spot(start, start))>{spot, press_at(spot, walk.hip)}; };
  auto from = look(piece.spot(walk.god_object, walk.hip));
  if (!(from.press.load > 0)) return Slid::kLeaves;
  if (walk.friction.slip(walk.god_object, from.press.pull2, from.press.load).is_rest) return Slid::kRests;
  const double mu = walk.friction.mu_dynamic;
  double share = 1;
  bool is_near = false;
  for (bool has_moved = false; walk.moves_left > 0; --walk.moves_left) {
    if (!(from.press.pull2 > rounding * rounding)) return Slid::kRests;
    if (is_near && set_right(piece, from.spot, from.press, mu, &walk.god_object)) return Slid::kRests;
    const Move move = mu > 0 ? next_move(piece, from.spot, from.press, mu, rounding, has_moved)
                             : move_to_minimum(piece, from.spot, from.press, rounding, has_moved);
    if (move.has_none) return Slid::kRests;
    auto end = piece.project(from.spot.at + move.after(share), from.spot);
    bool is_farther = squared(end.at - walk.hip) > start2;  // a piece that bends sharply ahead
    const bool has_crossed = !is_farther && piece.cross(from.spot, &end, next), is_smooth = piece.bends_alike(from.spot, end);
    const auto to = look(end);
    is_near = share == 1 && is_smooth && !has_crossed && move.is_near;
    walk.god_object = end.at;
    if (!is_farther && to.press.load > 0 && to.press.pull2 < square(mu * to.press.load)) {  // friction has held it on the way
      if (is_near && set_right(piece, to.spot, to.press, mu, &walk.god_object)) return Slid::kRests;
      const Move way = has_crossed ? straight_move(end.at - from.spot.at) : move.part(share);
      const Slid slid = stop_on_way(piece, from, way, to, walk);
      is_farther = squared(walk.god_object - walk.hip) > start2;
      if (!is_farther) return slid;
    }
    if (is_farther) {
      walk.god_object = from.spot.at;
      share = share * 0.25;
      if (!(norm1(move.step) * share > rounding)) return Slid::kRests;
      continue;
    }
    if (has_crossed) return Slid::kCrosses;
    if (!(to.press.load > 0)) return Slid::kLeaves;
    if (move.is_last && share == 1 && is_smooth) return Slid::kRests;
    share = share < 0.25 ? share * 4 : 1;
    has_moved = true;
    from = to;
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

}  // namespace fdcg
