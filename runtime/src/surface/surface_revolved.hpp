// SPDX-License-Identifier: Apache-2.0
// A tick's slide round a surface of revolution whose section is a line or an arc, where it is as short as a hand's are: numbers
// of the half plane through the axis in place of vectors, one move and one correction. Other slides are
// left to slide_on_piece() in surface_slide.hpp. The order of operations keeps chains of roots and divisions short; between two
// ticks only the god-object depends on the one before.
#pragma once

#include "surface/surface_slide.hpp"

namespace fdcg {

// A constant 0, which the compiler removes: for a cylinder, for a straight section.
struct Nought {};
inline Nought operator-(Nought) {
  return {};
}
inline Nought operator*(Nought, Nought) {
  return {};
}
inline Nought operator*(Nought, double) {
  return {};
}
inline Nought operator*(double, Nought) {
  return {};
}
inline Nought operator-(Nought, Nought) {
  return {};
}
inline double operator+(double a, Nought) {
  return a;
}
inline Nought operator+(Nought, Nought) {
  return {};
}
inline double operator+(Nought, double a) {
  return a;
}
inline double operator-(double a, Nought) {
  return a;
}
inline double operator-(Nought, double a) {
  return -a;
}
inline Nought absolute(Nought) {
  return {};
}

// The surface in the half plane of the axis through a place: distance from the axis, height. The place is base + raised normal,
// where `raised` is 0 on a line and the signed radius of an arc around its base.
template <class Number>
struct Section {
  double base_r, base_z;
  double n_r;  // the normal, away from the material
  Number n_z;
};
// From the axis to a place.
struct Outward {
  double x, y;          // unit
  double off, per_off;  // the distance and its inverse
};
inline Outward outward_of(Point at, double off2) {
  const double off = root(off2), per_off = inverse_root(off2);
  return {at.x * per_off, at.y * per_off, off, per_off};
}
// Profile:
//
//   bool kIsLine
//   raised, bend                  the arc's radius and its inverse, negative where hollow; of a line 0 and none
//   Outward outward(at, off2)     of a place at the square of this distance from the axis
//   Section section(off, z)       at a place; the normal may lack rounding of its length 1
//   double per_off(off)           its inverse
//   bool nearest(from, off, z, &to)   the place nearest to this one, which is in the material; false where it is not near
//   `from` bool is_within(z)             whether it goes on there

// A cylinder's side.
struct CylinderProfile {
  static constexpr bool kIsLine = true;
  static constexpr double raised = 0;
  static constexpr Nought bend = {};
  double sign, radius, per_radius, half;

  [[nodiscard]] FDCG_HOT Outward outward(Point at, double off2) const {
    const double scale = per_radius * (1.5 - 0.5 * (off2 * per_radius * per_radius));  // no rounding adds up
    return {at.x * scale, at.y * scale, radius, per_radius};
  }
  [[nodiscard]] double per_off(double) const { return per_radius; }
  [[nodiscard]] FDCG_HOT Section<Nought> section(double, double z) const { return {radius, z, sign, {}}; }
  [[nodiscard]] FDCG_HOT bool nearest(const Section<Nought>&, double off, double z, Section<Nought>* to) const {
    *to = section(off, z);
    return sign * (off - radius) < 0;
  }
  [[nodiscard]] bool is_within(double z) const { return absolute(z) < half; }
};

// A line that begins at (start_r, -half) and rises: of a cone. Its normal is unit, away from the material.
struct LineProfile {
  static constexpr bool kIsLine = true;
  static constexpr double raised = 0;
  static constexpr Nought bend = {};
  double start_r, half, n_r, n_z;

  [[nodiscard]] static Outward outward(Point at, double off2) { return outward_of(at, off2); }
  [[nodiscard]] static double per_off(double off) { return 1 / off; }
  [[nodiscard]] double above(double off, double z) const { return n_r * (off - start_r) + n_z * (z + half); }
  [[nodiscard]] FDCG_HOT Section<double> section(double off, double z) const {
    const double along = n_r * (z + half) - n_z * (off - start_r);
    return {start_r - along * n_z, along * n_r - half, n_r, n_z};
  }
  [[nodiscard]] FDCG_HOT bool nearest(const Section<double>&, double off, double z, Section<double>* to) const {
    *to = section(off, z);
    return above(off, z) < 0;
  }
  // Off the ends: on an apex, or beside it by rounding, the side has no normal.
  [[nodiscard]] bool is_within(double z) const { return absolute(z) < half * (1 - 0x1p-40); }
};

inline constexpr double kMostTurn2 = 0x1p-14;  // of a move, as the square of a sine

// (1 - cosine) / sine^2, of the square of a sine that is no larger.
FDCG_HOT double versine_by_square(double sine2) {
  return (0.5 + 0.125 * sine2) + 0.0625 * (sine2 * sine2);
}

// The HIP from the half plane through the god-object: its parts in that plane, and across it.
struct Sight {
  double out, round;
};
// The spring, by its stiffness: its parts along the normal, across the half plane, in the direction (-n_z, n_r).
struct Tug {
  double load, round, along;
  double pull2;  // of the latter two
};
inline Tug tug_of(double load, double round, double along) {
  return {load, round, along, round * round + along * along};
}

// Without friction the descent ends at the point nearest to the HIP, which is in the HIP's half plane. False where that is not
// near.
template <class Profile, class From>
FDCG_HOT bool slide_to_nearest(const Profile& profile, const From& from, const Outward& outward, const Sight& seen,
                               Touch& touch) {
  constexpr double kOffAxis = 0x1p-30;
  const Point hip = touch.hip;
  const double off2 = hip.x * hip.x + hip.y * hip.y;
  if (!(seen.out > kOffAxis * outward.off && 16 * seen.round * seen.round <= off2)) return false;
  const double off = root(off2), per_off = inverse_root(off2);
  From to;
  if (!profile.nearest(from, off, hip.z, &to)) return false;
  const double at = to.base_r + profile.raised * to.n_r, z = to.base_z + profile.raised * to.n_z;
  if (!profile.is_within(z)) return false;
  touch.god_object = {hip.x * (at * per_off), hip.y * (at * per_off), z};
  return true;
}

// A move: the sine of its turn round the axis, its way along the section.
struct RoundMove {
  double sine, way;
  double length;  // by the pull's at its start
  double second;  // at its start: of what the excess still is, 1 / 4 bow / fall^2
  bool is_short;
};

// To where the course of the excess says that friction stops it, as next_move() has it; `held` is mu * load. On a plane that is
// at 1 - held / pull; `later` is what the surface's bend adds, to second order. What depends on the pull's root comes last.
template <class Profile, class From>
FDCG_HOT RoundMove next_round_move(const Profile& profile, const Tug& tug, const From& from, double per_off, double held,
                                   double mu2) {
  constexpr double kLeast = 0.25, kMostLater = 0.125;
  const double load = tug.load, pull2 = tug.pull2, pull = root(pull2), per_pull2 = 1 / pull2, both = 1 + mu2;
  const auto narrows = -from.n_z * per_off;
  const double round2 = tug.round * tug.round, along2 = tug.along * tug.along, k1 = from.n_r * per_off, half = 0.5 * load;
  const double bothload = both * load, fall = pull2 - ((bothload * k1) * round2 + (bothload * profile.bend) * along2);
  if (!(fall > kLeast * pull2)) return {0, 0, 0, 0, false};
  const double per_fall = 1 / fall, per_held = 1 / held;
  const auto on_section = profile.bend * along2;
  const double on_ring = k1 * round2, bent = on_ring + on_section, turn2 = k1 * on_ring + profile.bend * on_section;
  const auto rate = narrows * (profile.bend * round2 - on_ring) * (3 * tug.along);
  const double taken = load * bent, curvature = bent * per_pull2, pressed = taken * per_pull2;
  const double bow =
      (mu2 * taken + both * (load * (2 * load * turn2 - rate) - bent * bent)) - (both * (1 + both) * taken) * pressed;
  const double later = (bow * (0.5 * per_held)) * (pull * per_fall), length = (pull2 - held * pull) * per_fall;
  const double aside = (half * (k1 - curvature) + narrows * tug.along) + later;
  const double more = (half * (profile.bend - curvature) * tug.along - narrows * (0.5 * round2)) + later * tug.along;
  const double sine = (-(tug.round * per_off) * length) * (1 + aside * length), way = -length * (tug.along + more * length);
  const double second = 0.25 * (1 - pressed) * (per_held * per_held) * (pull2 * per_fall);
  bool is_short = sine * sine <= kMostTurn2 && absolute(later) * length <= kMostLater;
  if constexpr (!Profile::kIsLine) is_short = is_short && square(profile.bend * way) <= kMostTurn2;
  return {sine, way, length, second, is_short};
}

// The section and the tug after a move; `turned` has the load and the part along the section as the turn round the axis leaves
// them.
template <class From>
struct Moved {
  From to;
  double off, z;
  Tug tug;
};
template <class Profile, class From>
FDCG_HOT Moved<From> moved_along(const Profile& profile, const From& from, const Tug& turned, double way) {
  if constexpr (Profile::kIsLine) {
    const double off = from.base_r - from.n_z * way, z = from.base_z + from.n_r * way;
    return {from, off, z, tug_of(turned.load, turned.round, turned.along + way)};
  } else {
    const double sine = way * profile.bend, less = sine * sine * versine_by_square(sine * sine),
                 towards = profile.raised - turned.load;
    const double unit = 1.5 - 0.5 * (from.n_r * from.n_r + from.n_z * from.n_z), n_r = from.n_r * unit, n_z = from.n_z * unit;
    const From to = {from.base_r, from.base_z, n_r - n_r * less - n_z * sine, n_z - n_z * less + n_r * sine};
    const double load = turned.load + towards * less + turned.along * sine,
                 along = turned.along + towards * sine - turned.along * less;
    return {to, to.base_r + profile.raised * to.n_r, profile.raised * to.n_z, tug_of(load, turned.round, along)};
  }
}

// Round by the move, and on by what is left of the excess there. False where that is too much.
template <class Profile, class From>
FDCG_HOT bool go_round(const Profile& profile, const From& from, const Outward& outward, const Sight& seen, const Tug& tug,
                       const RoundMove& move, double mu2, double bends, Touch& touch) {
  constexpr double kMostSet = 0x1p-20;  // of the normal's turn: its cube is nothing
  const double sine = move.sine, sine2 = sine * sine, more2 = versine_by_square(sine2), cosine = 1 - sine2 * more2;
  const double round = seen.round * cosine - seen.out * sine;
  // The HIP comes nearer to the axis by out (1 - cosine) - round sine.
  const double load = (tug.load - (from.n_r * seen.round) * sine) + ((from.n_r * seen.out) * sine2) * more2;
  const double along = (tug.along + (from.n_z * seen.round) * sine) - ((from.n_z * seen.out) * sine2) * more2;
  const Tug turned = {load, -round, along, 0};
  const Moved<From> moved = moved_along(profile, from, turned, move.way);
  const From& to = moved.to;
  const Tug& last = moved.tug;
  const double off = moved.off;
  // The bend and the fall times the distance from the axis: one division for both.
  const double both = 1 + mu2, load2 = last.load * last.load, excess = last.pull2 - mu2 * load2;
  const double bent = to.n_r * (last.round * last.round) + profile.bend * off * (last.along * last.along);
  const double fall = last.pull2 * off - (both * last.load) * bent;
  // The second order of what is left: from where the move began it is known well enough.
  const double more = 1 + move.second * excess;
  const double set = (excess * (0.5 * off)) * more * (1 / fall), size = absolute(set);
  const double pressed = both * last.load * bends;
  // What `more` leaves out: the third order, how the bend changes, how the load did.
  const double old2 = tug.load * tug.load, unknown = 4 * size + pressed * (pressed + move.length * move.length);
  if (!(last.load > 0 && fall > 0 && size * size * (unknown * old2 + absolute(load2 - old2)) <= kPlaced / 2 * old2))
    return false;
  if (!(size * pressed <= kMostSet && last.pull2 + load2 <= tug.pull2 + old2)) return false;
  const double aside = last.round * set, drop = (0.5 * bent) * profile.per_off(off) * (set * set);
  const double end_r = off + to.n_z * (last.along * set) - to.n_r * drop;
  const double end_z = moved.z - to.n_r * (last.along * set) - to.n_z * drop;
  if (!profile.is_within(end_z)) return false;
  const double ahead = cosine * end_r + sine * aside, left = sine * end_r - cosine * aside;  // from where the move began
  touch.god_object = {outward.x * ahead - outward.y * left, outward.y * ahead + outward.x * left, end_z};
  return true;
}

// True where the god-object rests, moved or not.
template <class Profile>
FDCG_HOT bool slide_round(const Profile& profile, Touch& touch) {
  constexpr double kNear2 = 16, kLeastHeld2 = 0x1p-40;
  const Point at = touch.god_object, gap = at - touch.hip;
  const double off2 = at.x * at.x + at.y * at.y;
  if (!(off2 > 0)) return false;  // an apex
  const Outward outward = profile.outward(at, off2);
  const auto from = profile.section(outward.off, at.z);
  const double gap_r = (gap.x * at.x + gap.y * at.y) * outward.per_off, round = (gap.y * at.x - gap.x * at.y) * outward.per_off;
  const Tug tug = tug_of(from.n_r * gap_r + from.n_z * gap.z, round, from.n_r * gap.z - from.n_z * gap_r);
  if (!(tug.load > 0 && tug.load * tug.load + tug.pull2 < kNear2 * off2)) return false;
  const Slip<double> slip = touch.friction.slip(at, tug.pull2, tug.load);
  if (slip.is_rest) return true;
  const double mu = touch.friction.mu_dynamic, mu2 = mu * mu, held = mu * tug.load;
  const double held2 = held * held, excess = tug.pull2 - held2;
  const double bent = absolute(from.n_r * outward.per_off) + absolute(profile.bend);
  const double doubt =
      2 * pull_rounding(touch) + 8 * kEps * norm1(at) * bent * (tug.load + held) + kPlaced * held;  // see pull_doubt()
  if (excess <= doubt * larger(doubt, 2 * held)) return true;
  const Sight seen = {outward.off - gap_r, -round};
  if (!(held2 > kLeastHeld2 * tug.pull2)) return mu == 0 && slide_to_nearest(profile, from, outward, seen, touch);
  const RoundMove move = next_round_move(profile, tug, from, outward.per_off, held, mu2);
  return move.is_short && go_round(profile, from, outward, seen, tug, move, mu2, bent, touch);
}

}  // namespace fdcg
