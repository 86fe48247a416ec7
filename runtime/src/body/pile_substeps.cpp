// SPDX-License-Identifier: Apache-2.0
// How many substeps a pile needs so that no touch meets the bound on its stiffness (pile_touch.cpp).
#include "body/pile_memory.hpp"

namespace fdcg {
namespace {

// What counts of a member: the largest inverse effective mass at its surface, over three directions, and the stiffness.
struct Lightness {
  bool is_used, has_points;
  double looseness_per_kg;
  double stiffness_n_per_m;
};

// Over the directions u, the sum of (r x u) M (r x u) is |r|^2 tr M - r M r.
double looseness_at(const fdcg_body_config& config, const Matrix& inverse_inertia, World arm) {
  const double trace = inverse_inertia.row[0].x + inverse_inertia.row[1].y + inverse_inertia.row[2].z;
  return 3 / config.mass_kg + dot(arm, arm) * trace - dot(arm, inverse_inertia * arm);
}

double looseness_of(const fdcg_pile& pile, const PileMember& member, const Object& object, const fdcg_body& body) {
  const fdcg_body_config& config = body.config;
  const Matrix inverse = inverse_of(tensor_of(config.inertia_kg_m2));
  const World centre = vec(config.centre_m);
  double most = 0;
  for (uint32_t p = 0; p < member.point_count; ++p) {
    const World arm = (vec(pile.points()[member.first_point + p].at) - centre) * body.scale;
    most = larger(most, looseness_at(config, inverse, arm));
  }
  if (member.point_count > 0 || object.bounds.is_endless) return most;
  for (int corner = 0; corner < 8; ++corner) {  // touched anywhere: its box holds the surface, and the measure is convex
    const World half = object.bounds.half;
    const World at = {(corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y,
                      (corner & 4) != 0 ? half.z : -half.z};
    most = larger(most, looseness_at(config, inverse, (object.bounds.centre + at - centre) * body.scale));
  }
  return most;
}

double stiffness_of(const fdcg_params& params) {
  double most = params.stiffness_n_per_m;
  if ((params.friction_flags & FDCG_FRICTION_MATERIALS) == 0) return most;
  for (uint32_t i = 0; i < params.material_count; ++i)
    most = larger(most, params.materials[i].stiffness_n_per_m);
  return most;
}

Lightness lightness_of(const fdcg_pile& pile, const fdcg_scene& scene, uint32_t index, const fdcg_scene_body* bodies,
                       uint32_t body_count) {
  const PileMember& member = pile.members()[index];
  if (member.is_used == 0) return {};
  const Object& object = scene.objects()[index];
  Lightness found = {true, false, 0, stiffness_of(object.params)};
  for (uint32_t i = 0; i < body_count; ++i) {
    if (bodies[i].object.index != index || bodies[i].object.generation != member.object.generation) continue;
    found.has_points = member.point_count > 0;
    found.looseness_per_kg = looseness_of(pile, member, object, bodies[i].body);
  }
  return found;
}

// The stiffness of two in series, times the looseness of both.
double product_of(const Lightness& a, const Lightness& b) {
  if (!a.is_used || !b.is_used || !(a.has_points || b.has_points)) return 0;
  const double stiffness = 1 / (1 / a.stiffness_n_per_m + 1 / b.stiffness_n_per_m);
  return stiffness * (a.looseness_per_kg + b.looseness_per_kg);
}

}  // namespace
}  // namespace fdcg

extern "C" uint32_t fdcg_pile_get_substeps(const fdcg_pile* pile, const fdcg_scene* scene, const fdcg_scene_body* bodies,
                                           uint32_t body_count, double tick_s) {
  using namespace fdcg;
  if (pile == nullptr || scene == nullptr || (bodies == nullptr && body_count > 0)) return 0;
  if (pile->member_end > scene->object_end) return 0;
  settle_place(const_cast<fdcg_scene*>(scene));
  const Lightness ground = {pile->has_ground != 0, false, 0, pile->ground_params.stiffness_n_per_m};
  double most = 0;
  for (uint32_t m = 0; m < pile->member_end; ++m) {
    const Lightness one = lightness_of(*pile, *scene, m, bodies, body_count);
    most = larger(most, product_of(one, ground));
    for (uint32_t n = 0; n < m && one.is_used; ++n)
      most = larger(most, product_of(one, lightness_of(*pile, *scene, n, bodies, body_count)));
  }
  const double steps = tick_s * root(most / kMostPileStiffness);
  if (!(steps >= 0 && steps <= FDCG_BODY_MAX_SUBSTEPS)) return 0;
  const auto whole = static_cast<uint32_t>(steps);
  return whole < steps || whole == 0 ? whole + 1 : whole;
}
