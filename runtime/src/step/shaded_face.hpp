// SPDX-License-Identifier: Apache-2.0
// The normals that shading interpolates over one face, and a slip about them (contact-model SHADE-1 to SHADE-3), in double
// precision whatever the graph's.
#pragma once

#include "graph/node_normals.hpp"
#include "graph/tolerances.hpp"
#include "step/normal_field.hpp"

namespace fdcg {

// `corner`: in the order of the node's sides. False: no face to interpolate over.
bool make_field(const FaceFrame& frame, const Vec3<double> (&corner)[3], const fdcg_node_normals& normals, NormalField* field);
// The unit normal at x, on the face's plane or near it.
Vec3<double> normal_at(const FaceFrame& frame, const NormalField& field, Vec3<double> x);

// A HIP below a face, and a god-object on it; places are given from the HIP's foot. Load and excess are about the sum of
// normals at the god-object, times its length and its length squared, so that what rests costs no division.
struct ShadedSpot {
  Vec3<double> at_foot;  // the field's sum there
  Flat god_object;
  double depth;
  double size2;    // squared length of the sum
  double load;     // along the normal
  double excess2;  // of its distance from the cone's axis, squared, without what SHADE-2 leaves to rounding
};

// `spring`: from the HIP to the god-object; `slack`: of the god-object's own rounding.
void look_at_spot(const FaceFrame& frame, const NormalField& field, const Vec3<double>& hip, const Vec3<double>& spring,
                  double depth, double slack, ShadedSpot* spot);

// Two numbers along a face at once.
using Pair = double __attribute__((vector_size(16)));

FDCG_HOT Pair pair_of(Vec3<double> v) {
  return Pair{v.x, v.y};
}
FDCG_HOT double sum_of(Pair a) {
  return a[0] + a[1];
}

// Where a slip without friction ends, from the HIP's foot (contact-model SHADE-3). Where the sum is w high along the face's
// normal, the place is the solution of two linear equations, (w - d M) x = d b; steps of Newton's for w, from about where the
// slip ends. What is multiplied is so ordered that little waits for the division. False: a few steps do not do.
FDCG_HOT bool slips_at_once(const FaceFrame& frame, const NormalField& field, Vec3<double> hip, double depth, Flat* place) {
  const Pair per_p = pair_of(field.per_p), per_q = pair_of(field.per_q), rise = {field.per_p.z, field.per_q.z};
  const Pair foot = Pair{frame.along.x, frame.across.x} * hip.x + Pair{frame.along.y, frame.across.y} * hip.y +
                    Pair{frame.along.z, frame.across.z} * hip.z;
  const Pair down_p = per_p * depth, down_q = per_q * depth;                  // d M
  const auto turned = [&](Pair v) { return down_p * v[0] + down_q * v[1]; };  // d M v
  const Pair sum = pair_of(field.at_zero) + (per_p * foot[0] + per_q * foot[1]), bent = turned(sum);
  const double high = field.at_zero.z + sum_of(rise * foot), over_high = 2 - high;  // high is near 1
  const double spread = down_p[0] + down_q[1], area = down_p[0] * down_q[1] - down_q[0] * down_p[1];
  const double bend = (absolute(down_p[0]) + absolute(down_p[1])) + (absolute(down_q[0]) + absolute(down_q[1]));
  double w = high + (depth * over_high) * sum_of(rise * sum);
  for (int step = 0; step < kMostStepsAtOnce; ++step) {
    const double left = w - spread, size = w * left + area;
    const int is_high = w >= 2 * kLeastUp, is_stable = size >= 4 * kLeastBend * (w * w);
    if ((is_high & is_stable) == 0) return false;
    const double over = 1 / size;
    const Pair once = sum * left + bent, twice = once * left + turned(once);
    const double share = depth * over, share2 = share * over;
    // With x = share once, by a larger w it is less by share2 twice, and that is less by about over_high of it.
    const double miss = (high - w) + share * sum_of(rise * once), back = share2 * sum_of(rise * twice);
    const double more = miss * (1 - back * (1 - back));
    const Pair x = once * share - twice * (share2 * (more * (1 - more * over_high)));
    *place = {x[0], x[1]};
    // of the place, about this share is left
    if (absolute(miss) * (absolute(miss) * bend + absolute(back * back * back)) <= kShadingLeftAtOnce) return true;
    w += more;
  }
  return false;
}

// Where a slip with friction ends, if in the last tick, as seen from the HIP, it ended at `last`, `was_depth` above it: the
// axis has turned since, as the HIP has gone over the face. From there a step of Newton's, and some more by the same
// derivatives. False: a few do not do.
bool slips_near(const ShadedSpot& spot, const NormalField& field, Flat last, double was_depth, double mu, Flat* place);

// The same with any coefficient, from a place on the face. Cost: some 150 instructions, at most kMostShadingSteps times 80.
Flat slip_from(const ShadedSpot& spot, const NormalField& field, Flat near, double mu);
// The same from the god-object, where the spot has not been looked at.
[[gnu::cold]] Flat slip_from_there(const FaceFrame& frame, const NormalField& field, Vec3<double> hip, Vec3<double> spring,
                                   double depth, double mu);

}  // namespace fdcg
