// SPDX-License-Identifier: Apache-2.0
// contact-model CURVE-2: a slip with terms is an equation: of the gap r that the god-object has, it goes a way s at a speed
// u(s), and
//   r - s = reach mu(u(s)),   u(s) = lagged + per_way (way + s),   reach = load, or a little more where presliding gives.
// Its left side falls by 1 for each unit of s, its right side by less as long as reach per_way times the curve's steepest fall
// is below 1: so there is one solution, it lies between 0 and r, and it changes continuously with all that goes in. At s = 0 it
// is the bound of sticking. Steady sliding at speed V asks r = gap + V T of it and gets the gap reach mu(V) back, whatever the
// lag. An error e of the lagged speed becomes e (1 - a - a b) / (1 - a b) in a tick, a = per_way T the lag's share of a tick
// and b = reach fall / T: with b <= lag / T + 1/4 that is -e / 3 at worst, and never larger than e.
#include "step/friction_terms.hpp"

#include "base/config.hpp"
#include "step/contact_internals.hpp"

#if FDCG_WITH_FRICTION_TERMS
namespace fdcg {
namespace {

constexpr double kSteepest = 0.6495190528383290;  // 3 sqrt(3) / 8: of 1 / (1 + x^2), at x = 1 / sqrt(3)

// How steeply the curve may fall for one solution down to unique_solution_depth_m, in seconds a metre.
double steepest_allowed(const fdcg_params& params, const fdcg_material& material) {
  const auto has = [&](uint32_t term) { return (params.friction_flags & term) != 0; };
  const double give = has(FDCG_FRICTION_PRESLIDING) ? 1 + material.stiffness_n_per_m / params.presliding_n_per_m : 1;
  const double time_s = (has(FDCG_FRICTION_LAG) ? params.friction_lag_s : 0) + params.tick_s / 4;
  return time_s / (give * params.unique_solution_depth_m);
}

fdcg_material own_material(const fdcg_params& params) {
  return {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
}

}  // namespace

FrictionTerms terms_of(const fdcg_params& params, const fdcg_graph* graph, const fdcg_contact& contact) {
  FrictionTerms terms = {};
  terms.params = &params;
  terms.graph = graph;
  terms.unit_m = graph != nullptr ? graph->header->metres_per_unit : 1;
  terms.material = own_material(params);
  if (terms.has(FDCG_FRICTION_FINGER)) terms.material = fdcg_combine_materials(&terms.material, &params.finger);
  if (terms.has_springs()) terms.held_stiffness = internals_of(contact).stiffness_n_per_m;
  const double share = terms.has(FDCG_FRICTION_LAG) ? params.tick_s / (params.tick_s + params.friction_lag_s) : 1;
  terms.per_way = share / params.tick_s;
  terms.lagged = terms.has(FDCG_FRICTION_LAG) ? (1 - share) * internals_of(contact).slip_m_per_s / terms.unit_m : 0;
  return terms;
}

fdcg_material FrictionTerms::material_of(uint32_t node) const {
  fdcg_material found = own_material(*params);
  const bool has_own = graph->node_materials != nullptr && node != FDCG_NONE;
  if (has_own && graph->node_materials[node] < params->material_count) found = params->materials[graph->node_materials[node]];
  return has(FDCG_FRICTION_FINGER) ? fdcg_combine_materials(&found, &params->finger) : found;
}

void FrictionTerms::select_material_of_face(uint32_t node) {
  if (has(FDCG_FRICTION_MATERIALS)) material = material_of(node);
}

void FrictionTerms::select_material_of_edge(uint32_t a, uint32_t b, double share) {
  if (!has(FDCG_FRICTION_MATERIALS)) return;
  material = material_of(a);
  if (b == FDCG_NONE) return;
  const fdcg_material other = material_of(b);
  material.mu_static = share * material.mu_static + (1 - share) * other.mu_static;
  material.mu_dynamic = share * material.mu_dynamic + (1 - share) * other.mu_dynamic;
  material.stiffness_n_per_m = smaller(material.stiffness_n_per_m, other.stiffness_n_per_m);
}

double FrictionTerms::mu(double speed, double stribeck) const {
  double sum = material.mu_dynamic;
  if (has(FDCG_FRICTION_STRIBECK)) {
    const double x = speed / stribeck;
    sum += (material.mu_static - material.mu_dynamic) / (1 + x * x);
  }
  return has(FDCG_FRICTION_VISCOUS) ? sum + params->viscous_s_per_m * unit_m * speed : sum;
}

double FrictionTerms::fall(double speed, double stribeck) const {
  double sum = 0;
  if (has(FDCG_FRICTION_STRIBECK)) {
    const double x = speed / stribeck, y = 1 + x * x;
    sum = (material.mu_static - material.mu_dynamic) * 2 * x / (y * y * stribeck);
  }
  return has(FDCG_FRICTION_VISCOUS) ? sum - params->viscous_s_per_m * unit_m : sum;
}

// Newton's steps, kept between bounds that hold the solution; should they ever be slow, every other step halves these.
double FrictionTerms::solve(double gap, double reach, double from, double stribeck) const {
  constexpr int kPlainSteps = 8;
  double low = 0, high = gap, s = larger(0, smaller(gap, gap - reach * mu(from, stribeck)));
  for (int step = 0; step < kMostSolveSteps; ++step) {
    const double speed = from + per_way * s;
    const double over = gap - s - reach * mu(speed, stribeck);
    (over > 0 ? low : high) = s;
    const double slope = 1 - reach * per_way * fall(speed, stribeck);
    double next = s + over / slope;
    if (!(next >= low && next <= high) || (step > kPlainSteps && step % 2 == 0)) next = low + (high - low) / 2;
    const bool is_there = absolute(next - s) <= kSlipSolved * gap;
    s = next;
    if (is_there) break;
  }
  return s;
}

void FrictionTerms::go_on_to(const Vec3<double>& god_object) {
  if (has_last) way += norm(god_object - last);
  last = god_object;
  has_last = true;
}

// No smaller than has one solution at this depth, whatever two materials come to.
double FrictionTerms::stribeck_at(double load) const {
  if (!has(FDCG_FRICTION_STRIBECK)) return 1;
  const double limit = steepest_allowed(*params, material) + (has(FDCG_FRICTION_VISCOUS) ? params->viscous_s_per_m : 0);
  const double least = kSteepest * (material.mu_static - material.mu_dynamic) / limit;
  return larger(params->stribeck_m_per_s, least) / unit_m * larger(1, load * unit_m / params->unique_solution_depth_m);
}

TermSlip FrictionTerms::slip(const Vec3<double>& god_object, double gap2, double load, double epsilon, bool* is_slipping) {
  go_on_to(god_object);
  const double reach = load * give(), gap = root(gap2), from = lagged + per_way * way;
  const double stribeck = stribeck_at(load);
  if (has(FDCG_FRICTION_STRIBECK)) {
    *is_slipping = gap > reach * mu(from, stribeck);
  } else {
    const double dynamic = mu(from, stribeck), more = larger(0, material.mu_static - material.mu_dynamic);
    *is_slipping = *is_slipping ? gap > kStickAgainShare * reach * dynamic : gap > reach * (dynamic + more);
  }
  double left = gap;
  bool is_rest = !*is_slipping;
  if (*is_slipping) {
    left = reach * mu(from + per_way * solve(gap, reach, from, stribeck), stribeck);
    is_rest = gap <= left + circle_rounding(god_object, left, epsilon);
  }
  if (has(FDCG_FRICTION_STRIBECK) && way > 0) *is_slipping = true;
  return {is_rest, left};
}

Steepness steepness_of(const fdcg_params& params, const fdcg_material& material) {
  const auto has = [&](uint32_t term) { return (params.friction_flags & term) != 0; };
  double fall = 0;
  if (has(FDCG_FRICTION_STRIBECK)) fall += kSteepest * (material.mu_static - material.mu_dynamic) / params.stribeck_m_per_s;
  if (has(FDCG_FRICTION_VISCOUS)) fall -= params.viscous_s_per_m;
  return {fall, steepest_allowed(params, material)};
}

}  // namespace fdcg
#endif

extern "C" fdcg_material fdcg_combine_materials(const fdcg_material* surface, const fdcg_material* finger) {
  const double a = surface->stiffness_n_per_m, b = finger->stiffness_n_per_m;
  return {fdcg::root(surface->mu_static * finger->mu_static), fdcg::root(surface->mu_dynamic * finger->mu_dynamic),
          a > 0 && b > 0 ? a * (b / (a + b)) : 0};
}
