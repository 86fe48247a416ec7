// SPDX-License-Identifier: Apache-2.0
// Friction beyond two coefficients: the curve over slip speed, presliding, and materials (fdcg_friction_flag; contact-model
// CURVE-1 to CURVE-7). What a tick knows of them; the rules ask it through Friction::slip. Lengths in the graph's units, in
// double precision whatever the graph's.
#pragma once

#include "fdcg/fdcg.h"
#include "graph/tolerances.hpp"
#include "shared/vec.hpp"

namespace fdcg {

// A god-object that slides until its gap is `gap`, or rests.
struct TermSlip {
  bool is_rest;
  double gap;
};

struct FrictionTerms {
  const fdcg_params* params;
  const fdcg_graph* graph;  // null: the ground of a pile, which has no nodes
  fdcg_material material;   // of the feature selected last
  double unit_m;
  double held_stiffness;  // of the contact, N/m; 0: a new one, or of no matter
  double lagged;          // what is left of the speed before this tick, units a second
  double per_way;         // and what one unit of way in this tick adds to it
  double way;             // of the god-object in this tick, up to `last`
  Vec3<double> last;      // its position at the last call
  bool has_last;
  Vec3<double> yielded;  // in the end: from the remembered place to the god-object that is felt

  [[nodiscard]] bool has(uint32_t term) const { return (params->friction_flags & term) != 0; }
  // Whether what the contact stores may change but by the hand: see settle() in presliding.hpp.
  [[nodiscard]] bool has_springs() const { return has(FDCG_FRICTION_MATERIALS | FDCG_FRICTION_PRESLIDING) || shades(); }
  [[nodiscard]] bool shades() const { return has(FDCG_FRICTION_SHADING) && graph != nullptr && graph->normals != nullptr; }
  // What presliding makes of a cone: the remembered place may be so much further from the surface point.
  [[nodiscard]] double give() const {
    return has(FDCG_FRICTION_PRESLIDING) ? 1 + material.stiffness_n_per_m / params->presliding_n_per_m : 1;
  }

  void select_material_of_face(uint32_t node);
  // `share`: of the load that node a bears.
  void select_material_of_edge(uint32_t a, uint32_t b, double share);
  // Friction::slip with terms. Cost: a few hundred instructions, at most kMostSolveSteps times some 50.
  TermSlip slip(const Vec3<double>& god_object, double gap2, double load, double epsilon, bool* is_slipping);
  void go_on_to(const Vec3<double>& god_object);
  // The coefficient at a speed, and how fast it falls there; `stribeck` is that of the depth at hand.
  [[nodiscard]] double mu(double speed, double stribeck) const;
  [[nodiscard]] double fall(double speed, double stribeck) const;

 private:
  double stribeck_at(double load) const;
  double solve(double gap, double reach, double from, double stribeck) const;
  fdcg_material material_of(uint32_t node) const;
};

inline constexpr int kMostSolveSteps = 120;

FrictionTerms terms_of(const fdcg_params& params, const fdcg_graph* graph, const fdcg_contact& contact);

// On an edge, `across` from the foot to the HIP is -(load_a n_a + load_b n_b) and something along the edge; load_a's share. The
// sum of the loads is -2 S.across / S.S with S = n_a + n_b (contact-model EDGE-4), their difference the same with n_a - n_b.
[[gnu::cold]] inline double share_of_load(Vec3<double> n_a, Vec3<double> n_b, Vec3<double> across) {
  const Vec3<double> sum = n_a + n_b, difference = n_a - n_b;
  const double both = dot(sum, across) * dot(difference, difference), more = dot(difference, across) * dot(sum, sum);
  if (!(both < 0)) return 0.5;
  return more < both ? 1 : more > -both ? 0 : (1 + more / both) / 2;
}

// The steepest that the curve falls on this material, and may, in seconds a metre.
struct Steepness {
  double fall, limit;
};
Steepness steepness_of(const fdcg_params& params, const fdcg_material& material);

}  // namespace fdcg
