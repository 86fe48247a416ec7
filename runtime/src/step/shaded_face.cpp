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

// One step of Newton's method for the x to which the lean at x leads; at the present x the lean leads to `place` instead.
FDCG_HOT Flat improved(Flat x, Flat place, Flat p, Flat q) {
  const Flat miss = {place.p - x.p, place.q - x.q};
  const double pp = 1 - p.p, qq = 1 - q.q, size = pp * qq - q.p * p.q;
  if (!(size > kLeastBend)) return place;
  const double over = 1 / size;
  return {x.p + (miss.p * qq + q.p * miss.q) * over, x.q + (pp * miss.q + miss.p * p.q) * over};
}

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

// The spring is the god-object's place along the plane and the depth along its normal; the normal felt is the lean and 1.
void look_at_spot(const FaceFrame& frame, const NormalField& field, Vec3<double> hip, Vec3<double> spring, double depth,
                  double slack, ShadedSpot* spot) {
  spot->frame = &frame;
  const Vec3<double> at_foot = field.at(frame.flat(hip)), per_p = field.per_p, per_q = field.per_q;
  const Flat god_object = frame.flat(spring);
  const Lean lean = lean_at(at_foot, per_p, per_q, god_object);
  const double stretch2 = 1 + dot(lean.along, lean.along), over = 1 / stretch2, along = dot(god_object, lean.along) + depth;
  const double up = along * over, beside_p = god_object.p - lean.along.p * up, beside_q = god_object.q - lean.along.q * up;
  const double across2 = square(beside_p) + square(beside_q) + square(depth - up);
  spot->load = larger(up * root(stretch2), depth * kLeastLoadShare);
  spot->excess2 = larger(across2 * (1 - 2 * kShadingSlack) - square(kShadingSlack * spot->load + slack), 0);
  spot->at_foot = at_foot;
  spot->per_p = per_p;
  spot->per_q = per_q;
  spot->god_object = god_object;
  spot->depth = depth;
  spot->lean = lean;
}

// contact-model SHADE-3: from the god-object. A step whose miss is below the root of what counts as rest is the last: the next
// one's would be below it.
Vec3<double> slip_from(const ShadedSpot& spot, double mu) {
  const Vec3<double> at_foot = spot.at_foot, per_p = spot.per_p, per_q = spot.per_q;
  const double depth = spot.depth, enough2 = square(kShadingLastMiss * depth);
  Flat x = spot.god_object;
  Lean lean = spot.lean;
  for (int step = 0; step < kMostShadingSteps; ++step) {
    Flat place = {lean.along.p * depth, lean.along.q * depth}, p, q;
    const Flat was = x;
    if (mu > 0) {
      const Target target = target_for(spot.god_object, depth, lean.along, mu);
      const double pull_p = dot(target.pull, lean.per_p), pull_q = dot(target.pull, lean.per_q);
      place = target.place;
      p = {lean.per_p.p * target.swing + target.from_axis.p * pull_p,
           lean.per_p.q * target.swing + target.from_axis.q * pull_p};
      q = {lean.per_q.p * target.swing + target.from_axis.p * pull_q,
           lean.per_q.q * target.swing + target.from_axis.q * pull_q};
    } else {
      p = {lean.per_p.p * depth, lean.per_p.q * depth};
      q = {lean.per_q.p * depth, lean.per_q.q * depth};
    }
    x = improved(x, place, p, q);
    if (square(place.p - was.p) + square(place.q - was.q) <= enough2) break;
    const Lean next = lean_at(at_foot, per_p, per_q, x);
    if (!(next.up >= kLeastUp)) {
      x = place;
      break;
    }
    lean = next;
  }
  return spot.frame->normal * depth + spot.frame->along * x.p + spot.frame->across * x.q;
}

}  // namespace fdcg
#endif
