// SPDX-License-Identifier: Apache-2.0
// Every allowance that the step makes for rounding, each with its reason; docs/internals/contact-model.md has them as a table.
// All scale with the object or with the numbers that are rounded; none is a length in metres. What is exact needs none:
// docs/internals/exactness.md.
//
// eps: the spacing of the file's numbers at 1. |x|: the sum of a place's coordinates, each without its sign. E: the extent.
// delta: header.max_deviation, how far corners of merged faces lie off their planes.
#pragma once

#include "fdcg/fdcg.h"
#include "shared/vec.hpp"

namespace fdcg {

// ---- A place and a plane

// B(x), SIDE-1: beyond this distance from a face's plane, rounding cannot have changed the sign of Plane::distance at x: the
// stored normal is good to two units in the last place, the offset to one, the sum to three.
template <class Graph, class Real = typename Graph::Real>
FDCG_ONE_COPY Real plane_rounding_bound(const Graph& graph, const Vec3<Real>& x) {
  return 8 * RealLimits<Real>::kEpsilon * (norm1(x) + 2 * static_cast<Real>(graph.header()->extent));
}

// LEAVE-3: the same for one plane, where it matters that it is no more than that: by the products, each good to two units in
// its own last place, and not by the object. `plane.offset`: those of a corner, summed in size; their sum may have cancelled.
template <class Real, class Plane>
inline Real own_plane_rounding(const Plane& plane, Vec3<Real> x) {
  const Vec3<Real> terms = {plane.normal.x * x.x, plane.normal.y * x.y, plane.normal.z * x.z};
  return 8 * RealLimits<Real>::kEpsilon * (norm1(terms) + absolute(plane.offset));
}

// LEAVE-3: of it the rounding of a mesh's corners alone, which puts one behind a plane that it would be in.
template <class Real>
inline constexpr Real kCornersShare = Real(1) / 8;

// FACE-5: a place so near to a plane is on it, where both were computed: the plane's offset may have cancelled
// to 0, and then is good to a unit of the extent's last place, not of its own.
template <class Real>
FDCG_ONE_COPY Real on_plane_rounding(const Vec3<Real>& x, Real extent) {
  return 4 * RealLimits<Real>::kEpsilon * (norm1(x) + extent);
}

// FREE-8: a way so near to a busy corner passes it. Real: the file's numbers; or the doubles in which it is asked, and then how
// far the way is from the corner is not known.
template <class Real>
inline double at_corner_rounding(Vec3<double> corner, double extent) {
  return 4.0 * RealLimits<Real>::kEpsilon * (norm1(corner) + extent);
}

// FACE-1: a god-object so near to a Voronoi plane sits on it: the rounding of its own place and of that plane's distance; in a
// graph with inexact nodes `delta` is added.
template <class Real>
inline Real rim_rounding(const Vec3<Real>& god_object, Real extent) {
  return 8 * RealLimits<Real>::kEpsilon * (norm1(god_object) + extent);
}

// FREE-3, GRAPH-4: how far behind a plane a way may begin that still enters the node: its corners lie off it by delta, and the
// distance is rounded. `bound`: plane_rounding_bound of the way's beginning.
template <class Real>
inline Real slab_depth(double deviation, Real bound) {
  return Real(deviation) * (1 + 4 * RealLimits<Real>::kEpsilon) + bound;
}

// FREE-9: so near to a node's plane and its sides, from either side, a way may have come in that does not enter it. `bound`: as
// of slab_depth, of which the actual rounding is at most a quarter; the god-object is moved no farther to meet the node.
template <class Real>
inline Real missed_reach(double deviation, Real bound) {
  return slab_depth(2 * deviation, bound / 4);
}

// ---- A place on an edge, or at its end

// FACE-6, EDGE-6: a place so near to an end of an edge is the vertex: more than the rounding of a place on the edge's line, so
// that none beside it is left that the corner's faces would hand around.
template <class Real>
inline Real end_rounding(Real extent) {
  return 10 * RealLimits<Real>::kEpsilon * extent;
}

// TICK-5: a god-object that goes in a circle this near to a corner is on it; two merged faces may lie off it, on either side.
// FACE-5, FACE-6: sides of a face are in one line if their corners are so near to it; those of a merged face lie off it within
// its plane as they lie off that plane.
template <class Real>
inline Real corner_rounding(Real extent, Real deviation) {
  return end_rounding(extent) + 4 * deviation;
}

// ---- A way

// FREE-3: where rounding may move a way's point of entry by more than this share of its fall, the point is clipped to the part
// of the way that is over the face.
template <class Real>
inline constexpr Real kGrazing = Real(1) / 1024;

// FREE-3: the actual rounding of a distance is at most a quarter of plane_rounding_bound at each of a way's ends, so much may
// a Voronoi plane be off.
template <class Real>
inline Real side_rounding(Real from_bound, Real to_bound) {
  return (from_bound + to_bound) / 4;
}

// FREE-3: a way that is all beyond a side's Voronoi plane by more passes outside of the side's edge: the rounding of both
// planes and of the place where it comes in, `bound`; where it may begin in a slab, behind the plane, it came in as far before.
template <class Real>
inline Real beside_rounding(Real bound, bool is_slab) {
  return bound * (is_slab ? 1 / kGrazing<Real> : Real(2));
}

// The sweep's orientations, before they are asked exactly: of each of the six products of three differences, three differences,
// two products and the sums, half an epsilon each.
template <class Real>
inline Real orientation_rounding(Vec3<Real> v, Vec3<Real> w, Vec3<Real> way) {
  return 8 * RealLimits<Real>::kEpsilon * (norm1(v) * norm1(w) * norm1(way)) + RealLimits<Real>::kTiny;
}

// FREE-4, FREE-5, TICK-2: beyond so many extents the rounding of the HIP itself nears the object's size.
inline constexpr int kNearExtents = 16;

// FREE-5: whether a place this far out has numbers coarser than the object.
template <class Real>
inline bool are_coarse(Real size, Real extent) {
  return 8 * RealLimits<Real>::kEpsilon * size > extent;
}

// FACE-4: a target that the rounding of a far HIP takes off its plane by more than this share of the extent is no place to go.
template <class Real>
inline constexpr Real kMostOffPlane = Real(1) / 1024;

// LEAVE-2: the least step clear of a face, as a share of eps E: less than a rounding, since a slit may be narrower than one.
template <class Real>
inline Real least_step_clear(double extent) {
  return RealLimits<Real>::kEpsilon * Real(extent) / 4096;
}

// CORNER-3: where corners lie off their planes, a feature at a corner that does not hold the god-object is the nearest for sure
// where its squared distance from the HIP is less than this share of that of all that hold it.
template <class Real>
inline constexpr Real kClearlyNearer2 = Real(1) / (1 << 20);
// ... Where none holds it, it would rest on the corner: of the corner's squared distance this share.
template <class Real>
inline constexpr Real kNearerThanApex2 = Real(1) / 4;

// CORNER-3: of the product with a corner's normal, which is stored in 16 bits a coordinate.
template <class Real>
inline Real stored_normal_rounding(const Vec3<Real>& t) {
  return norm1(t) / FDCG_NORMAL_SCALE;
}

// ---- A busy corner

// CORNER-4, CORNER-7: directions that reach so nearly as far tie: the rounding of boxes and directions, of the file's numbers,
// is under half of it. `reach`: what the directions are multiplied by.
template <class Real, class Wide>
inline Wide fan_rounding(Vec3<Wide> reach) {
  return Wide(64 * RealLimits<Real>::kEpsilon) * norm1(reach);
}

// CORNER-4: of the normal of a plane through a corner, a HIP and an edge's other end, in double: of differences and products.
inline double plane_of_way_rounding(Vec3<double> to_hip, Vec3<double> along) {
  return 64 * RealLimits<double>::kEpsilon * norm1(to_hip) * norm1(along);
}

// FREE-8: of a way as an arc, seen from a busy corner. A stored direction is good to kDirectionRounding; the arc's plane to
// kArcRounding over the sine of the angle between its ends, in double.
template <class Real>
inline constexpr Real kDirectionRounding = 8 * RealLimits<Real>::kEpsilon;
inline constexpr double kArcRounding = 8 * RealLimits<double>::kEpsilon;
// Of the way: a face entered later than another by no more is looked at all the same.
template <class Real>
inline constexpr Real kLaterEntry = Real(1) / 256;

// ---- Friction

// FRIC-3: a contact that slips sticks again within this share of the circle in which it would have stuck: rounding must not
// toss a coin every tick. Far above rounding, far below what a hand can tell.
inline constexpr double kStickAgainShare = 1 - 0x1p-20;

// FRIC-4: a slipping god-object so near to its circle stays: half a unit of its place, and the circle's own rounding.
// `epsilon`: of the graph's numbers, where friction is computed in double.
template <class Real>
inline Real circle_rounding(Vec3<Real> god_object, Real gap, Real epsilon = RealLimits<Real>::kEpsilon) {
  return epsilon * (norm1(god_object) / 2 + 4 * gap);
}

// CURVE-2: a slip that the next step of Newton's changes by no more than this share of the gap is the solution.
inline constexpr double kSlipSolved = 2 * RealLimits<double>::kEpsilon;

// EDGE-4: in a groove the two faces together press harder than the distance from the edge says, by 1 / sin(opening / 2). At
// most this factor is allowed: an opening of 0.11 degrees.
inline constexpr int kMaxWedgeFactor = 1024;

// CURVE-5: how far behind a face's second concave edge an offset may end: that edge's plane, in double.
template <class Real>
inline double wall_rounding(double extent) {
  return 8 * RealLimits<Real>::kEpsilon * extent;
}

// ---- Numbers that arrive

// TICK-4: a coordinate smaller than this share of the extent is zero: no hand can tell, and exact signs need not look at bits
// that stand further apart than a few machine words hold.
inline constexpr double kLeastShare = 0x1p-70;

// TICK-2: a HIP farther away than this is nowhere near any graph (load.cpp limits scale and origin), and its arithmetic might
// overflow before it is found out.
inline constexpr double kFarthestHip_m = 1e110;

// ---- Boxes

// By how much a box test may be off, in tree units. `near_size`: |x| + |y| + |z| of the ends of the way as floats have it,
// added up; the rounding of the ends to float and of the sums and products in touched_boxes come to 5/8 of this part at most.
// `rounding`: the same of the whole way times the spacing at 1 of the numbers that it was given in.
template <class Real>
constexpr Real tree_rounding(Real near_size, Real rounding) {
  return Real(1) / Real(1 << 21) * (4 + near_size) + 8 * rounding;
}

// FREE-7: what a clear ball keeps of the distance found, more than its rounding; and it is smaller by so many tree roundings
// than the nearest box, more than a sweep inside the ball could err by.
template <class Real>
inline constexpr Real kClearShare = Real(1) - Real(1) / Real(512);
inline constexpr int kClearMargins = 5;

// contact-model SHADE-1: the least cosine between a corner's normal and the node's: 60 degrees, and the rounding of its code.
inline constexpr double kLeastLean = 0.499;
// SHADE-4: how far two faces' normals at a corner may be apart and be one; the code of one is off by up to 5e-5.
inline constexpr double kSmoothAcross = 0x1p-12;
// SHADE-3: a step that misses by less than this share of the depth is the last, since the next would miss by about its square;
// a god-object is not moved for less than the slack; a bulge as round as the god-object is deep, but for kLeastBend, has no
// stable place. Beyond a side the sum of normals may turn over: so much along the face's normal must be left of it.
inline constexpr double kShadingLastMiss = 0x1p-20, kShadingSlack = 0x1p-34, kLeastBend = 1.0 / 16, kLeastUp = 0.25;
// SHADE-7: the short ways' last steps leave less than mu times this of the depth, and without friction less than this share of
// the way from the HIP's foot.
inline constexpr double kShadingLeftWithFriction = 0x1p-36, kShadingLeftAtOnce = 0x1p-32;
inline constexpr int kMostStepsAtOnce = 4, kMostDeeper = 4;  // than in the last tick
// SHADE-2: where the normal leans away from the force the load counts as this share of the depth.
inline constexpr double kLeastLoadShare = 0.25;
inline constexpr int kMostShadingSteps = 16;
// Of a face, twice: no compiler writes a smaller one, and its inverse is a number.
inline constexpr double kLeastArea = 1e-280;

}  // namespace fdcg
