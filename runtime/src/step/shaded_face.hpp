// SPDX-License-Identifier: Apache-2.0
// The normals that shading interpolates over one face, and a slip about them (contact-model SHADE-1 to SHADE-3), in double
// precision whatever the graph's.
#pragma once

#include "graph/node_normals.hpp"
#include "step/normal_field.hpp"

namespace fdcg {

// `corner`: in the order of the node's sides. False: no face to interpolate over.
bool make_field(const FaceFrame& frame, const Vec3<double> (&corner)[3], const fdcg_node_normals& normals, NormalField* field);
// The unit normal at x, on the face's plane or near it.
Vec3<double> normal_at(const FaceFrame& frame, const NormalField& field, Vec3<double> x);

// A direction: so much along the face for one unit along its normal, and how that changes with a place.
struct Lean {
  Flat along, per_p, per_q;
  double up;  // the sum's part along the normal
};

// A HIP below a face, and a god-object on it; places are given from the HIP's foot.
struct ShadedSpot {
  const FaceFrame* frame;
  Vec3<double> at_foot, per_p, per_q;  // as of NormalField
  Flat god_object;
  double depth;
  Lean lean;       // at the god-object
  double excess2;  // of its distance from the cone's axis, squared, without what SHADE-2 leaves to rounding
  double load;     // along the normal
};

// `spring`: from the HIP to the god-object; `slack`: of the god-object's own rounding. Keeps the frame's address.
void look_at_spot(const FaceFrame& frame, const NormalField& field, Vec3<double> hip, Vec3<double> spring, double depth,
                  double slack, ShadedSpot* spot);
// Where a slip with this coefficient ends, from the HIP. Cost: some 150 instructions, at most kMostShadingSteps times 80.
Vec3<double> slip_from(const ShadedSpot& spot, double mu);

}  // namespace fdcg
