// SPDX-License-Identifier: Apache-2.0
#include "step/shaded_face.hpp"

#include "base/config.hpp"

#if FDCG_WITH_SHADING
namespace fdcg {
namespace {

inline double square(double a) {
  return a * a;
}
inline double dot(Flat x, Flat y) {
  return x.p * y.p + x.q * y.q;
}

// A direction: so much along the face for one unit along its normal, and how that changes with a place.
struct Lean {
  Flat along, per_p, per_q;
  double up;  // the sum's part along the normal
};

FDCG_HOT Lean lean_at(Vec3<double> at_foot, Vec3<double> per_p, Vec3<double> per_q, Flat x) {
  const Vec3<double> sum = at_foot + per_p * x.p + per_q * x.q;
  const double over = 1 / sum.z, p = sum.x * over, q = sum.y * over;
  return {{p, q},
          {(per_p.x - p * per_p.z) * over, (per_p.y - q * per_p.z) * over},
          {(per_q.x - p * per_q.z) * over, (per_q.y - q * per_q.z) * over},
          sum.z};
}

// Where a slip would end if the normal leant so everywhere, and how that changes with the lean (contact-model SHADE-3): from
// the axis, by `share` of the god-object's distance from it; a change of lean moves it by `swing` of that, and by `from_axis`
// times `pull` of it.
struct Target {
  Flat place;
  double swing;
  Flat from_axis, pull;
};

// Of a spot with friction; f from the HIP to a place on the way has f.N = mu |f - (f.N) N| about N = (lean, 1)/stretch.
FDCG_HOT Target target_for(Flat god_object, double depth, Flat lean, double mu) {
  const Flat axis = {lean.p * depth, lean.q * depth}, from_axis = {god_object.p - axis.p, god_object.q - axis.q};
  const double stretch2 = 1 + dot(lean, lean), tilt = dot(from_axis, lean), far2 = dot(from_axis, from_axis);
  const double across = root(larger(far2 * stretch2 - square(tilt), 0)), load = mu * depth * stretch2;
  const double left = across - mu * tilt;
  if (!(left > load)) return {god_object, 0, {0, 0}, {0, 0}};
  const double over = 1 / left, share = load * over, per_across = share * over / across;
  // Of `left` by lean, times share / left: far2 lean - depth stretch2 from_axis - tilt (from_axis - axis) is `across` times
  // that of `across`.
  const double by_lean = 2 * mu * depth * over - far2 * per_across, by_tilt = tilt * per_across + mu * share * over;
  const double by_far = depth * stretch2 * per_across;
  return {{axis.p + from_axis.p * share, axis.q + from_axis.q * share},
          depth * (1 - share),
          from_axis,
          {lean.p * by_lean + from_axis.p * by_far + (from_axis.p - axis.p) * by_tilt,
           lean.q * by_lean + from_axis.q * by_far + (from_axis.q - axis.q) * by_tilt}};
}
FDCG_HOT Target target_of(const ShadedSpot& spot, Flat lean, double mu) {
  if (mu > 0) return target_for(spot.god_object, spot.depth, lean, mu);
  return {{lean.p * spot.depth, lean.q * spot.depth}, spot.depth, {0, 0}, {0, 0}};
}

// One step of Newton's method for the x to which the lean at x leads; at the present x the lean leads to `place` instead.
FDCG_HOT Flat improved(Flat x, const Target& target, const Lean& lean) {
  const double pull_p = dot(target.pull, lean.per_p), pull_q = dot(target.pull, lean.per_q);
  const Flat p = {lean.per_p.p * target.swing + target.from_axis.p * pull_p,
                  lean.per_p.q * target.swing + target.from_axis.q * pull_p};
  const Flat q = {lean.per_q.p * target.swing + target.from_axis.p * pull_q,
                  lean.per_q.q * target.swing + target.from_axis.q * pull_q};
  const Flat place = target.place, miss = {place.p - x.p, place.q - x.q};
  const double pp = 1 - p.p, qq = 1 - q.q, size = pp * qq - q.p * p.q;
  if (!(size > kLeastBend)) return place;
  const double over = 1 / size;
  return {x.p + (miss.p * qq + q.p * miss.q) * over, x.q + (pp * miss.q + miss.p * p.q) * over};
}

inline double squared_miss(Flat x, Flat place) {
  return square(place.p - x.p) + square(place.q - x.q);
}

// A place x where a slip with a coefficient ends, and how far it is from that: on the cone about the sum S(x), |f x S| = mu f.S
// with f = (x, depth), and on the line from the god-object to the axis; both without a root or a division, in squared lengths.
struct SlipMiss {
  double off_cone, off_line;
};
struct SlipEquations {
  Vec3<double> sum, per_p, per_q;
  Flat god_object;
  double depth, grip;  // 1 + mu^2

  struct Place {
    Vec3<double> way, sum;
    double size2, far2, push, turn;
    Flat back;  // from the god-object
  };
  [[nodiscard]] FDCG_HOT Place at(Flat x) const {
    const Vec3<double> way = {x.p, x.q, depth}, here = sum + per_p * x.p + per_q * x.q;
    return {way,
            here,
            dot(here, here),
            dot(way, way),
            dot(way, here),
            x.p * god_object.q - x.q * god_object.p,
            {x.p - god_object.p, x.q - god_object.q}};
  }
  [[nodiscard]] FDCG_HOT SlipMiss miss(const Place& at) const {
    return {at.far2 * at.size2 - grip * (at.push * at.push),
            at.sum.z * at.turn - depth * (at.back.p * at.sum.y - at.back.q * at.sum.x)};
  }
  // How the misses change with x; `along`: x.p or x.q, `across`: 1 along p and -1 along q.
  [[nodiscard]] FDCG_HOT SlipMiss change(const Place& at, Vec3<double> per, double along, Flat unit) const {
    const double cone = along * at.size2 + at.far2 * dot(at.sum, per) -
                        grip * at.push * ((unit.p * at.sum.x + unit.q * at.sum.y) + dot(at.way, per));
    const double line = (unit.p * god_object.q - unit.q * god_object.p) * at.sum.z + per.z * at.turn -
                        depth * ((unit.p * at.sum.y - unit.q * at.sum.x) + (at.back.p * per.y - at.back.q * per.x));
    return {2 * cone, line};
  }
};

}  // namespace

bool make_field(const FaceFrame& frame, const Vec3<double> (&corner)[3], const fdcg_node_normals& normals, NormalField* field) {
  const Flat edge = frame.flat(corner[1] - corner[0]), far = frame.flat(corner[2] - corner[0]);
  const double twice_area = edge.p * far.q;
  if (!(twice_area >= kLeastArea)) return false;
  const Vec3<double> first = frame.in_frame(normal_at_corner(normals, 0, frame.normal));
  const Vec3<double> second = frame.in_frame(normal_at_corner(normals, 1, frame.normal));
  const Vec3<double> third = frame.in_frame(normal_at_corner(normals, 2, frame.normal));
  const double over = 1 / twice_area;
  field->per_p = (second - first) * (far.q * over);
  field->per_q = ((third - first) - field->per_p * far.p) * (edge.p * over);
  const Flat start = frame.flat(corner[0]);
  field->at_zero = first - field->per_p * start.p - field->per_q * start.q;
  return true;
}

Vec3<double> normal_at(const FaceFrame& frame, const NormalField& field, Vec3<double> x) {
  const Vec3<double> sum = field.at(frame.flat(x));
  const Vec3<double> found = frame.along * sum.x + frame.across * sum.y + frame.normal * sum.z;
  return found * (1 / norm(found));
}

void look_at_spot(const FaceFrame& frame, const NormalField& field, const Vec3<double>& hip, const Vec3<double>& spring,
                  double depth, double slack, ShadedSpot* spot) {
  const Vec3<double> at_foot = field.at(frame.flat(hip));
  const Flat god_object = frame.flat(spring);
  const Vec3<double> way = {god_object.p, god_object.q, depth};
  const Vec3<double> sum = at_foot + field.per_p * god_object.p + field.per_q * god_object.q, across = cross(way, sum);
  const double size2 = dot(sum, sum), size = root(size2);
  const double load = larger(dot(way, sum), depth * kLeastLoadShare * size);
  spot->at_foot = by_parts(at_foot);
  spot->god_object.p = god_object.p;
  spot->god_object.q = god_object.q;
  spot->depth = depth;
  spot->size2 = size2;
  spot->load = load;
  spot->excess2 = larger(dot(across, across) * (1 - 2 * kShadingSlack) - square(kShadingSlack * load + slack * size), 0);
}

bool slips_near(const ShadedSpot& spot, const NormalField& field, Flat last, double was_depth, double mu, Flat* place) {
  const double depth = spot.depth;
  if (!(kMostDeeper * was_depth >= depth)) return false;
  const double deeper = depth / was_depth;
  const Flat gone = {depth * (last.p - spot.god_object.p), depth * (last.q - spot.god_object.q)};
  const Flat near = {last.p * deeper + (field.per_p.x * gone.p + field.per_q.x * gone.q),
                     last.q * deeper + (field.per_p.y * gone.p + field.per_q.y * gone.q)};
  const SlipEquations equations = {by_parts(spot.at_foot),
                                   by_parts(field.per_p),
                                   by_parts(field.per_q),
                                   {spot.god_object.p, spot.god_object.q},
                                   depth,
                                   1 + mu * mu};
  const SlipEquations::Place at = equations.at(near);
  const SlipMiss miss = equations.miss(at), p = equations.change(at, field.per_p, near.p, {1, 0}),
                 q = equations.change(at, field.per_q, near.q, {0, 1});
  const double size = p.off_cone * q.off_line - q.off_cone * p.off_line;
  if (!(absolute(size) >= kLeastBend * ((mu * depth) * (mu * depth)))) return false;
  const double over = 1 / size;
  const auto step = [&](SlipMiss by) {
    return Flat{(q.off_cone * by.off_line - q.off_line * by.off_cone) * over,
                (p.off_line * by.off_cone - p.off_cone * by.off_line) * over};
  };
  const Flat first = step(miss);
  const double first2 = first.p * first.p + first.q * first.q, enough = kShadingLeftWithFriction * mu * (depth * depth);
  if (!(first2 <= depth * depth)) return false;
  Flat x = {near.p + first.p, near.q + first.q};
  for (int more = 0; more < kMostStepsAtOnce; ++more) {
    const SlipEquations::Place then = equations.at(x);
    const Flat by = step(equations.miss(then));
    const double by2 = by.p * by.p + by.q * by.q;
    if (!(by2 <= first2)) return false;
    x = {x.p + by.p, x.q + by.q};
    // the next one would be less by about the first's share of the circle
    if (!(first2 * by2 <= enough * enough)) continue;
    *place = {x.p, x.q};
    // Between the axis and the god-object, all in the sum's length.
    const double w = then.sum.z;
    const Flat axis = {depth * then.sum.x, depth * then.sum.y}, from_axis = {w * x.p - axis.p, w * x.q - axis.q};
    const Flat whole = {w * spot.god_object.p - axis.p, w * spot.god_object.q - axis.q};
    const double share = from_axis.p * whole.p + from_axis.q * whole.q, all = whole.p * whole.p + whole.q * whole.q;
    const int is_between = share > 0, is_short = share < all, is_high = w >= 2 * kLeastUp;
    return (is_between & is_short & is_high) != 0;
  }
  return false;
}

Flat slip_from_there(const FaceFrame& frame, const NormalField& field, Vec3<double> hip, Vec3<double> spring, double depth,
                     double mu) {
  ShadedSpot spot;
  look_at_spot(frame, field, hip, spring, depth, 0, &spot);
  return slip_from(spot, field, spot.god_object, mu);
}

// contact-model SHADE-3. A step whose miss is below the root of what counts as rest is the last: the next one's would be below
// it.
Flat slip_from(const ShadedSpot& spot, const NormalField& field, Flat near, double mu) {
  const double enough2 = square(kShadingLastMiss * spot.depth);
  Flat x = near;
  Lean lean = lean_at(spot.at_foot, field.per_p, field.per_q, x);
  for (int step = 0; step < kMostShadingSteps; ++step) {
    const Target target = target_of(spot, lean.along, mu);
    const double miss2 = squared_miss(x, target.place);
    x = improved(x, target, lean);
    if (miss2 <= enough2) break;
    lean = lean_at(spot.at_foot, field.per_p, field.per_q, x);
    if (!(lean.up >= kLeastUp)) return target.place;
  }
  return x;
}

}  // namespace fdcg
#endif
