// SPDX-License-Identifier: Apache-2.0
// Cylinder, cone and frustum: a side between two rims, a disc at each end that is not an apex.
#pragma once

#include "surface/surface_revolved.hpp"

namespace fdcg {

struct ConeSurface {
  static constexpr bool kIsConvex = true;
  static constexpr uint32_t kSide = 0;  // the discs are 1 and 2: 1 + end
  double sign, extent, half;
  double radius[2];         // at -half and at half
  double per_radius;        // of a cylinder; else 0
  double length;            // of the side, from rim to rim
  double along_r, along_z;  // the side's unit direction from -half to half, in a plane of the axis: distance from it, height

  struct Spot {
    Point at, normal;
    Point outward;        // unit, from the axis
    double off, per_off;  // distance from the axis, and its inverse; both 0 at an apex
  };

  explicit ConeSurface(const fdcg_surface& s) : sign(s.is_hollow != 0 ? -1 : 1), half(s.length_m / 2) {
    radius[0] = s.radius_m;
    radius[1] = s.kind == FDCG_SURFACE_CYLINDER ? s.radius_m : s.top_radius_m;
    const double grows = radius[1] - radius[0], rises = s.length_m;
    if (grows == 0) {
      length = rises;
      per_radius = 1 / radius[0];
      along_r = 0;
      along_z = 1;
    } else {
      const double length2 = grows * grows + rises * rises, per_length2 = 1 / length2;
      length = root(length2);
      per_radius = 0;
      along_r = grows * (length * per_length2);
      along_z = rises * (length * per_length2);
    }
    extent = larger(radius[0], radius[1]) + half;
  }
  // The side's normal in a plane of the axis is (along_z, -along_r) * sign.
  [[nodiscard]] double above_side(double off, double z) const { return along_z * (off - radius[0]) - along_r * (z + half); }
  [[nodiscard]] bool is_outside(Point x) const {
    const double side = above_side(from_axis(x), x.z), disc = absolute(x.z) - half;
    return sign > 0 ? side >= 0 || disc >= 0 : side <= 0 && disc <= 0;
  }
  // Between the discs' planes, and there where x^2 + y^2 is below the square of the side's radius at that height.
  [[nodiscard]] Span span(Point from, Point way) const {
    Span span = kWholeLine;
    cut_slab(from.z, way.z, half, 1, &span);
    if (span.is_empty()) return kNoSpan;
    const double grows = along_r / along_z, wide = (radius[0] + radius[1]) / 2 + grows * from.z, widens = grows * way.z;
    const double flat2 = way.x * way.x + way.y * way.y;
    const double a = flat2 - widens * widens, b = from.x * way.x + from.y * way.y - wide * widens;
    const double c = from.x * from.x + from.y * from.y - wide * wide, left = b * b - a * c;
    if (!(absolute(a) > kEps * (flat2 + widens * widens))) {  // along a line of the side
      if (b > 0) span.cut_after(bounded_ratio(-c, 2 * b), kSide);
      if (b < 0) span.cut_before(bounded_ratio(-c, 2 * b), kSide);
      return b != 0 || c < 0 ? span : kNoSpan;
    }
    if (!(left > 0)) return a > 0 ? kNoSpan : span;
    const double q = -(b + (b < 0 ? -root(left) : root(left)));
    const double r = bounded_ratio(q, a), s = bounded_ratio(c, q), low = r < s ? r : s, high = r < s ? s : r;
    if (a > 0) {
      span.cut_before(low, kSide);
      span.cut_after(high, kSide);
      return span;
    }
    Span before = span, after = span;  // the way passes through both halves of the double cone; one is within the planes
    before.cut_after(low, kSide);
    after.cut_before(high, kSide);
    return before.out - before.in > after.out - after.in ? before : after;
  }
  [[nodiscard]] uint32_t piece_near(Point x) const {
    const double side = above_side(from_axis(x), x.z), disc = absolute(x.z) - half;
    return side > disc ? kSide : (x.z > 0 ? 2 : 1);
  }
  [[nodiscard]] Entry land(uint32_t piece, Point at) const {
    const double off = from_axis(at);
    const Point outward = off > 0 ? Point{at.x / off, at.y / off, 0} : Point{1, 0, 0};
    if (piece == kSide) return {true, on_side(outward, side_parameter(off, at.z)), {FDCG_FACE, kSide}};
    const double most = radius[piece - 1], z = piece == 1 ? -half : half;
    if (most == 0) return {true, {0, 0, z}, {FDCG_VERTEX, piece - 1}};
    if (off <= most) return {true, {at.x, at.y, z}, {FDCG_FACE, piece}};
    return {true, {outward.x * most, outward.y * most, z}, {FDCG_FACE, piece}};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }

  // ---- the side, as a piece to slide on

  [[nodiscard]] double side_parameter(double off, double z) const { return along_r * (off - radius[0]) + along_z * (z + half); }
  [[nodiscard]] Point on_side(Point outward, double u) const {
    if (!(u > 0)) return rim_point(outward, 0);
    if (!(u < length)) return rim_point(outward, 1);
    const double off = radius[0] + u * along_r;
    return {outward.x * off, outward.y * off, u * along_z - half};
  }
  [[nodiscard]] Point rim_point(Point outward, uint32_t end) const {
    return {outward.x * radius[end], outward.y * radius[end], end == 0 ? -half : half};
  }
  // At an apex the plane of the axis is that of the HIP.
  [[nodiscard]] static Point outward_at(Point x, Point hip) {
    const double off = from_axis(x);
    if (off > 0) return {x.x / off, x.y / off, 0};
    const double hip_off = from_axis(hip);
    return hip_off > 0 ? Point{hip.x / hip_off, hip.y / hip_off, 0} : Point{1, 0, 0};
  }
  // The side's normal in a plane of the axis that has this direction.
  [[nodiscard]] Point normal_of(Point outward) const {
    const double out = sign * along_z;
    return {outward.x * out, outward.y * out, -sign * along_r};
  }
  // Of a cylinder the distance from the axis is known: at x, or where x is brought to it.
  [[nodiscard]] FDCG_HOT Spot on_cylinder(Point x, Point at, bool is_moved) const {
    const Point near = {x.x * per_radius, x.y * per_radius, 0};
    const Point outward = near * inverse_root_near_1(squared(near) - 1);
    if (is_moved) at = {outward.x * radius[0], outward.y * radius[0], x.z};
    return {at, normal_of(outward), outward, radius[0], per_radius};
  }
  [[nodiscard]] FDCG_HOT Spot spot(Point x, Point hip) const {
    if (along_r == 0) return on_cylinder(x, x, false);
    const double off = from_axis(x);
    if (!(off > 32 * kEps * extent)) {  // an apex, or so near that its direction from the axis is rounding
      const Point outward = outward_at({0, 0, x.z}, hip);
      return {x, normal_of(outward), outward, 0, 0};
    }
    const double per_off = 1 / off;
    const Point outward = {x.x * per_off, x.y * per_off, 0};
    return {x, normal_of(outward), outward, off, per_off};
  }
  // On the side's line through the axis's plane of p, beyond its ends too, but not beyond the axis.
  [[nodiscard]] FDCG_HOT Spot project(Point p, const Spot& spot) const {
    if (along_r == 0 && (p.x != 0 || p.y != 0)) return on_cylinder(p, p, true);
    const double off2 = p.x * p.x + p.y * p.y;
    if (!(off2 > kEps * extent * kEps * extent)) return on_line(spot.outward, root(off2), p.z);
    const double ahead = p.x * spot.outward.x + p.y * spot.outward.y;
    if (spot.off > 0 && !(ahead > 0)) return on_line(spot.outward, ahead, p.z);  // past the narrow end
    const double per_off = inverse_root_near(off2, spot.per_off);
    return on_line({p.x * per_off, p.y * per_off, 0}, off2 * per_off, p.z);
  }
  [[nodiscard]] FDCG_HOT Spot on_line(Point outward, double off, double z) const {
    const double u = side_parameter(off, z), at_off = radius[0] + u * along_r;
    if (!(at_off > kEps * extent)) return {rim_point(outward, along_r < 0 ? 1 : 0), normal_of(outward), outward, 0, 0};
    return {{outward.x * at_off, outward.y * at_off, u * along_z - half}, normal_of(outward), outward, at_off, 1 / at_off};
  }
  [[nodiscard]] FDCG_HOT Point turn(const Spot& spot, Point v) const {
    const Point round = {-spot.outward.y, spot.outward.x, 0};
    return round * ((v.x * round.x + v.y * round.y) * curvature_sum(spot));
  }
  [[nodiscard]] FDCG_HOT static double turn_rate(const Spot& spot, Point v, double along) {
    return -3 * along * (dot(v, spot.outward) * spot.per_off);
  }
  [[nodiscard]] double curvature_sum(const Spot& spot) const { return sign * along_z * spot.per_off; }
  [[nodiscard]] static double curvature_product(const Spot&) { return 0; }
  [[nodiscard]] static bool bends_alike(const Spot&, const Spot&) { return true; }
  bool cross(const Spot& from, Spot* to, Feature* next) const {
    const uint32_t end = to->at.z > 0 ? 1 : 0;
    const double before = half - absolute(to->at.z);
    if (before > 0 && !(radius[end] == 0 && before <= 8 * kEps * extent * along_z)) return false;  // an apex is met nearby too
    const double left = end == 0 ? half + from.at.z : half - from.at.z, went = absolute(to->at.z - from.at.z);
    const Point at = left > 0 && went > left ? from.at + (to->at - from.at) * (left / went) : to->at;
    to->outward = outward_at(at, to->outward);
    to->normal = normal_of(to->outward);
    to->at = rim_point(to->outward, end);
    *next = rim_feature(end);
    return true;
  }
  [[nodiscard]] Feature rim_feature(uint32_t end) const {
    return {static_cast<uint32_t>(radius[end] > 0 ? FDCG_EDGE : FDCG_VERTEX), end};
  }

  // ---- rules

  Decision rule(SurfaceWalk& walk) const {
    if (walk.active.state == FDCG_EDGE) return rim_rule(walk);
    if (walk.active.state == FDCG_VERTEX) return apex_rule(walk);
    if (walk.active.index != kSide) return disc_rule(walk);
    Feature next;
    return decide(slide_on_piece(*this, walk, &next), next);
  }
  Decision disc_rule(SurfaceWalk& walk) const {
    const uint32_t end = walk.active.index - 1;
    const Point from = walk.god_object, hip = walk.hip;
    const Point across = {from.x - hip.x, from.y - hip.y, 0};
    double shrink = 0;
    const Slid slid = slide_on_plane(walk, across, sign * (end == 0 ? half + hip.z : half - hip.z), &shrink);
    if (slid != Slid::kSlides) return decide(slid, kFree);
    const Point to = {hip.x + across.x * shrink, hip.y + across.y * shrink, from.z};
    if (from_axis(to) <= radius[end]) {
      walk.god_object = to;
      return rest();
    }
    const Span within = ball_span({from.x, from.y, 0}, {to.x - from.x, to.y - from.y, 0}, radius[end]);
    const double t = within.out > 0 && within.out < 1 ? within.out : (within.out > 0 ? 1 : 0);
    walk.god_object = rim_point(outward_at(from + (to - from) * t, to), end);
    return go_to(rim_feature(end));
  }
  // The HIP against a rim's two faces, in the plane of the axis through the god-object. `beyond` is how far it lies past the
  // rim, seen from the face.
  struct RimSides {
    double side, disc;  // signed distances to the faces
    double beyond_side, beyond_disc;
  };
  [[nodiscard]] RimSides rim_sides(uint32_t end, double off, double z) const {
    const double out = off - radius[end], up = end == 0 ? z + half : z - half, towards = end == 0 ? -1 : 1;
    return {sign * (along_z * out - along_r * up), sign * towards * up, towards * (along_r * out + along_z * up), out};
  }
  // contact-model EDGE-3, round a circle.
  Decision rim_rule(SurfaceWalk& walk) const {
    const uint32_t end = walk.active.index;
    const Decision here = leave_rim(walk, end);
    if (here != rest() || sign > 0 || !slide_on_rim(walk, end)) return here;
    return leave_rim(walk, end);  // elsewhere on the rim the HIP may be behind a face alone
  }
  // Rest where the rim holds the god-object.
  [[nodiscard]] Decision leave_rim(const SurfaceWalk& walk, uint32_t end) const {
    const RimSides at = rim_sides(end, dot(walk.hip, outward_at(walk.god_object, walk.hip)), walk.hip.z);
    const bool is_behind_side = at.side < 0, is_behind_disc = at.disc < 0;
    if (sign > 0 ? !is_behind_side || !is_behind_disc : !is_behind_side && !is_behind_disc) return go_to(kFree);
    const bool may_be_side = is_behind_side && at.beyond_side < 0, may_be_disc = is_behind_disc && at.beyond_disc < 0;
    if (may_be_side && !(may_be_disc && at.beyond_disc < at.beyond_side)) return go_to({FDCG_FACE, kSide});
    return may_be_disc ? go_to({FDCG_FACE, 1 + end}) : rest();
  }
  // The loads of both faces together are base - lift * cos(angle), by contact-model EDGE-4.
  // True where the god-object was moved.
  bool slide_on_rim(SurfaceWalk& walk, uint32_t end) const {
    const Point outward = outward_at(walk.god_object, walk.hip), round = {-outward.y, outward.x, 0};
    const double off = dot(walk.hip, outward);
    const double reach = from_axis(walk.hip), across = dot(walk.hip, round);
    const double up = end == 0 ? walk.hip.z + half : walk.hip.z - half, out = off - radius[end];
    const double sum_r = -along_z, sum_z = along_r + (end == 0 ? 1 : -1);  // of the two normals, into the cavity
    const double per_load = -2 / (sum_r * sum_r + sum_z * sum_z);
    double base = per_load * (sum_z * up - sum_r * radius[end]), lift = -per_load * sum_r * reach;
    double load = per_load * (sum_r * out + sum_z * up);
    if (!walk.friction.has_wedge) {
      const double distance = root(out * out + up * up), share = load > 0 ? distance / load : 0;
      base *= share, lift *= share, load = distance;
    }
    const Slip<double> slip = walk.friction.slip(walk.god_object, across * across, load);
    const bool is_placed = absolute(absolute(across) - slip.gap) <= pull_rounding(walk);
    if (slip.is_rest || is_placed) return false;
    Arc stop;
    if (!stop_on_circle(reach, base, lift, load > 0 ? slip.gap / load : 0, &stop)) stop = {0, 1};
    const Point towards = {walk.hip.x / reach, walk.hip.y / reach, 0};
    const double turn = across > 0 ? -stop.sine : stop.sine;  // the god-object is to the right of the HIP, or to the left
    walk.god_object =
        rim_point({towards.x * stop.cosine - towards.y * turn, towards.y * stop.cosine + towards.x * turn, 0}, end);
    return true;
  }
  // contact-model CORNER-1: the steepest line of the side is the one in the HIP's plane.
  Decision apex_rule(SurfaceWalk& walk) const {
    const uint32_t end = walk.active.index;
    const RimSides at = rim_sides(end, from_axis(walk.hip), walk.hip.z);
    if (at.side >= 0) return go_to(kFree);
    if (at.beyond_side < 0) return go_to({FDCG_FACE, kSide});
    return sign > 0 ? go_to(kFree) : rest();
  }
  [[nodiscard]] Point normal(Feature feature, Point x, Point hip) const {
    const Point side = spot(x, hip).normal, up = {0, 0, 1};
    if (feature.state == FDCG_FACE && feature.index == kSide) return side;
    if (feature.state == FDCG_VERTEX) return up * (feature.index == 0 ? -sign : sign);
    const bool is_low = feature.state == FDCG_FACE ? feature.index == 1 : feature.index == 0;
    const Point disc = up * (is_low ? -sign : sign);
    if (feature.state == FDCG_FACE) return disc;
    const Point sum = side + disc;
    return sum * (1 / norm(sum));
  }
};

// What most ticks on a cone need: its side's normal, with few operations.
struct QuickCone {
  double sign, half, extent;
  LineProfile side;

  explicit QuickCone(const fdcg_surface& s) : sign(s.is_hollow != 0 ? -1 : 1), half(s.length_m / 2) {
    const double grows = s.top_radius_m - s.radius_m, rises = s.length_m,
                 per_length = inverse_root(grows * grows + rises * rises);
    side = {s.radius_m, half, sign * rises * per_length, -(sign * grows) * per_length};
    extent = larger(s.radius_m, s.top_radius_m) + half;
  }
  [[nodiscard]] bool is_clear(Point x, double way) const {
    const double above = side.above(from_axis(x), x.z), beyond = sign * (absolute(x.z) - half);
    return sign > 0 ? above > way || beyond > way : above > way && beyond > way;
  }
  FDCG_HOT bool slide_quickly(uint32_t face, Touch& touch) const {
    return face == ConeSurface::kSide && slide_round(side, touch);
  }
};
// ... on a cylinder.
struct QuickCylinder {
  double sign, radius, per_radius, half, extent;

  explicit QuickCylinder(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1),
        radius(s.radius_m),
        per_radius(1 / radius),
        half(s.length_m / 2),
        extent(radius + half) {}
  [[nodiscard]] bool is_clear(Point x, double way) const {
    const double side = from_axis(x) - radius, disc = absolute(x.z) - half;
    return sign > 0 ? side > way || disc > way : side < -way && disc < -way;
  }
  FDCG_HOT bool slide_quickly(uint32_t face, Touch& touch) const {
    return face == ConeSurface::kSide && slide_round(CylinderProfile{sign, radius, per_radius, half}, touch);
  }
};

}  // namespace fdcg
