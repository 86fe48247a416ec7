// SPDX-License-Identifier: Apache-2.0
// A tick's slide round a surface of revolution whose section is a line or an arc, where it is as short as a hand's are: numbers
// of the half plane through the axis in place of vectors, one move and one correction. What it cannot do, slide_on_piece() in
// surface.hpp does. The order of operations follows what is known first: each root and division waits for little, and the
// next tick for nothing but the god-object.
#pragma once

#include "surface_slide.hpp"

namespace fdcg {

// The surface in the half plane of the axis through a place: distance from the axis, height. The place is base + raised normal,
// where `raised` is 0 on a line and the signed radius of an arc around its base.
struct Section {
  double base_r, base_z;
  double n_r, n_z;  // the normal, away from the material
};
// From the axis to a place.
struct Outward {
  double x, y;          // unit, but for `lack`
  double off, per_off;  // the distance and its inverse
  double lack;          // x^2 + y^2 - 1: rounding
};
inline Outward outward_of(Point at, double off2) {
  const double off = root(off2), per_off = inverse_root(off2);
  return {at.x * per_off, at.y * per_off, off, per_off, 0};
}
// Profile:
//
//   bool kIsLine
//   double raised, bend           the arc's radius and its inverse, negative where hollow; both 0 of a line
//   Outward outward(at, off2)     of a place at the square of this distance from the axis
//   Section section(off, z)       at a place; the normal may lack rounding of its length 1
//   Section moved(section, way)   after a way in the direction (-n_z, n_r); the normal's length is 1. (way * bend)^2 is at most
//                                 kMostTurn2
//   bool nearest(from, off, z, &to)   the place nearest to this one, which is in the material; false where it is not near
//   `from` bool is_within(z)             whether it goes on there

// A line that begins at (start_r, -half) in a unit direction and rises: of a cylinder, a cone.
struct LineProfile {
  static constexpr bool kIsLine = true;
  static constexpr double raised = 0, bend = 0;
  double sign, start_r, half, along_r, along_z;
  double per_start;  // of a cylinder

  [[nodiscard]] FDCG_HOT Outward outward(Point at, double off2) const {
    if (along_r != 0) return outward_of(at, off2);
    const double x = at.x * per_start, y = at.y * per_start;
    return {x, y, start_r, per_start, x * x + y * y - 1};
  }
  [[nodiscard]] Section at(double u) const {
    return {start_r + u * along_r, u * along_z - half, sign * along_z, -sign * along_r};
  }
  [[nodiscard]] double parameter(double off, double z) const { return along_r * (off - start_r) + along_z * (z + half); }
  [[nodiscard]] FDCG_HOT Section section(double off, double z) const { return at(parameter(off, z)); }
  [[nodiscard]] FDCG_HOT Section moved(const Section& from, double way) const {
    return {from.base_r - from.n_z * way, from.base_z + from.n_r * way, from.n_r, from.n_z};
  }
  [[nodiscard]] FDCG_HOT bool nearest(const Section&, double off, double z, Section* to) const {
    *to = section(off, z);
    return sign * (along_z * (off - start_r) - along_r * (z + half)) < 0;
  }
  // Off the ends: on an apex, or beside it by rounding, the side has no normal.
  [[nodiscard]] bool is_within(double z) const { return absolute(z) < half * (1 - 0x1p-40); }
};

// 1 / sqrt(1 + e + rounding) for 0 <= e <= 2^-11.
FDCG_HOT double inverse_root_of_turn(double e, double rounding) {
  const double e2 = e * e;
  return ((1 - 0.5 * rounding) - 0.5 * e) + e2 * ((0.375 - 0.3125 * e) + 0.2734375 * e2);
}
inline constexpr double kMostTurn2 = 0x1p-12;  // of a move, as a tangent's square

// The HIP from the half plane through the god-object: its parts in that plane, across it, along the axis.
struct Sight {
  double out, round, up;
};
// The spring, by its stiffness: its parts along the normal, across the half plane, in the direction (-n_z, n_r).
struct Tug {
  double load, round, along;
  double pull2;  // of the latter two
};
template <class Profile>
FDCG_HOT Tug tug_at(const Profile& profile, const Section& s, const Sight& hip) {
  const double out = hip.out - s.base_r, up = hip.up - s.base_z, against = s.n_r * out + s.n_z * up;
  const double load = Profile::kIsLine ? -against : profile.raised - against, along = s.n_z * out - s.n_r * up;
  return {load, -hip.round, along, hip.round * hip.round + along * along};
}

// Without friction the descent ends at the point nearest to the HIP, which is in the HIP's half plane. False where that is not
// near.
template <class Profile>
FDCG_HOT bool slide_to_nearest(const Profile& profile, const Section& from, const Sight& seen, Touch& touch) {
  const Point hip = touch.hip;
  const double off2 = hip.x * hip.x + hip.y * hip.y;
  if (!(seen.out > 0 && 16 * seen.round * seen.round <= off2)) return false;
  const double off = root(off2), per_off = inverse_root(off2);
  Section to;
  if (!profile.nearest(from, off, hip.z, &to)) return false;
  const double at = to.base_r + profile.raised * to.n_r, z = to.base_z + profile.raised * to.n_z;
  if (!profile.is_within(z)) return false;
  touch.god_object = {hip.x * (at * per_off), hip.y * (at * per_off), z};
  return true;
}

// A move and its turns: a tangent round the axis, a way along the section.
struct RoundMove {
  double tangent, way;
  double length;  // by the pull's at its start
  double second;  // at its start: of what the excess still is, 1 / 4 bow / fall^2
  bool is_short;
};

// To where the course of the excess says that friction stops it, as next_move() has it; `both` is 1 + mu^2. What depends on the
// pull's inverse comes last.
template <class Profile>
FDCG_HOT RoundMove next_round_move(const Profile& profile, const Tug& tug, const Section& from, double per_off, double excess,
                                   double both) {
  constexpr double kLeast = 0.25;
  const double load = tug.load, pull2 = tug.pull2, per_pull2 = 1 / pull2, bothload = both * load;
  const double round2 = tug.round * tug.round, k1 = from.n_r * per_off, narrows = -from.n_z * per_off;
  const double on_ring = k1 * round2, half = 0.5 * load;
  double bent = on_ring, turn2 = k1 * on_ring, rate = -3 * narrows * on_ring * tug.along;
  if constexpr (!Profile::kIsLine) {
    const double on_section = profile.bend * (tug.along * tug.along);
    bent = on_ring + on_section;
    turn2 = turn2 + profile.bend * on_section;
    rate = 3 * narrows * (profile.bend * round2 - on_ring) * tug.along;
  }
  const double taken = load * bent, fall = pull2 - both * taken, turned = bothload * load * (bent * bent);
  const double bow = (pull2 - taken - both * (bent * bent + taken)) + bothload * (2 * load * turn2 - rate) - turned * per_pull2;
  const double left = fall * fall - bow * excess;
  if (!(fall > kLeast * pull2 && bow > kLeast * pull2 && left > 0)) return {0, 0, 0, 0, false};
  const double length = (fall - root(left)) * (1 / bow), curvature = bent * per_pull2;
  const double aside = half * (k1 - curvature) + narrows * tug.along;
  const double more = half * (profile.bend - curvature) * tug.along - 0.5 * narrows * round2;
  const double tangent = -(tug.round * per_off) * length * (1 + aside * length), way = -length * (tug.along + more * length);
  const double pressed = load * curvature, second = 0.25 * (1 - pressed) / ((pull2 - excess) * (1 - both * pressed));
  const bool is_short = Profile::kIsLine || square(way * profile.bend) <= kMostTurn2;
  return {tangent, way, length, second, tangent * tangent <= kMostTurn2 && is_short};
}

// Round by the move, and on by what is left of the excess there. False where that is too much.
template <class Profile>
FDCG_HOT bool go_round(const Profile& profile, const Section& from, const Outward& outward, const Sight& seen, const Tug& tug,
                       const RoundMove& move, double mu2, Touch& touch) {
  constexpr double kMostSet = 0x1p-20;  // of the normal's turn: its cube is nothing
  const Section to = profile.moved(from, move.way);
  const double tangent = move.tangent, cosine = inverse_root_of_turn(tangent * tangent, outward.lack);
  const Sight sees = {(seen.out + tangent * seen.round) * cosine, (seen.round - tangent * seen.out) * cosine, touch.hip.z};
  const Tug last = tug_at(profile, to, sees);
  // The place, and the bend and the fall times the distance from the axis: one division for both.
  const double both = 1 + mu2, load2 = last.load * last.load, excess = last.pull2 - mu2 * load2;
  double off = to.base_r, z = to.base_z, bent = to.n_r * (last.round * last.round), bends = absolute(to.n_r * outward.per_off);
  if constexpr (!Profile::kIsLine) {
    off = off + profile.raised * to.n_r;
    z = z + profile.raised * to.n_z;
    bent = bent + (profile.bend * off) * (last.along * last.along);
    bends = bends + absolute(profile.bend);
  }
  const double fall = last.pull2 * off - (both * last.load) * bent;
  // The second order of what is left: from where the move began it is known well enough.
  const double more = 1 + move.second * excess;
  const double set = (excess * (0.5 * off)) * more * (1 / fall), size = absolute(set);
  const double pressed = both * last.load * bends;
  // What `more` does not know: the third order, how the bend changes, how the load did.
  const double old2 = tug.load * tug.load, unknown = 4 * size + pressed * (pressed + move.length * move.length);
  if (!(last.load > 0 && fall > 0 && size * size * (unknown * old2 + absolute(load2 - old2)) <= kPlaced / 2 * old2))
    return false;
  if (!(size * pressed <= kMostSet && last.pull2 + load2 <= tug.pull2 + old2)) return false;
  const double x = (outward.x - tangent * outward.y) * cosine, y = (outward.y + tangent * outward.x) * cosine;
  const double radial = -to.n_z * last.along, drop = (0.5 * bent) * (1 / off) * (set * set);
  const double end_z = z - to.n_r * last.along * set - to.n_z * drop;
  if (!profile.is_within(end_z)) return false;
  touch.god_object = {x * off - (x * radial - y * last.round) * set - x * to.n_r * drop,
                      y * off - (y * radial + x * last.round) * set - y * to.n_r * drop, end_z};
  return true;
}

// True where the god-object rests, moved or not.
template <class Profile>
FDCG_HOT bool slide_round(const Profile& profile, Touch& touch) {
  constexpr double kNear2 = 16;
  const Point at = touch.god_object, hip = touch.hip;
  const double off2 = at.x * at.x + at.y * at.y;
  if (!(off2 > 0)) return false;  // an apex
  const Outward outward = profile.outward(at, off2);
  const Section from = profile.section(outward.off, at.z);
  const Sight seen = {(hip.x * at.x + hip.y * at.y) * outward.per_off, (hip.y * at.x - hip.x * at.y) * outward.per_off, hip.z};
  const Tug tug = tug_at(profile, from, seen);
  if (!(tug.load > 0 && tug.load * tug.load + tug.pull2 < kNear2 * off2)) return false;
  const Slip<double> slip = touch.friction.slip(at, tug.pull2, tug.load);
  const double rounding = pull_rounding(touch);
  if (slip.is_rest || !(tug.pull2 > rounding * rounding)) return true;
  const double mu = touch.friction.mu_dynamic, mu2 = mu * mu, held = mu * tug.load;
  const double excess = tug.pull2 - held * held;
  const double bent = absolute(from.n_r * outward.per_off) + (Profile::kIsLine ? 0 : absolute(profile.bend));
  const double doubt = 2 * rounding + 8 * kEps * norm1(at) * bent * (tug.load + held) + kPlaced * held;  // see next_move()
  if (excess <= doubt * larger(doubt, 2 * held)) return true;
  if (mu == 0) return slide_to_nearest(profile, from, seen, touch);
  const RoundMove move = next_round_move(profile, tug, from, outward.per_off, excess, 1 + mu2);
  return move.is_short && go_round(profile, from, outward, seen, tug, move, mu2, touch);
}

}  // namespace fdcg
