// SPDX-License-Identifier: Apache-2.0
// The step on a surface without a mesh: by its kind, of those that the program links.
#define FDCG_SURFACE_DISPATCH 1  // its references to the kinds are weak
#include "base/struct_bytes.hpp"
#include "step/admit.hpp"
#include "surface/surface_drive.hpp"

namespace fdcg {
namespace {

struct SurfaceKind {
  SurfaceStep* step;
  SurfaceNormal* normal;
};

const SurfaceKind& kind_of(uint32_t kind) {
  static constexpr SurfaceKind kKinds[] = {{step_plane, normal_of_plane},       {step_sphere, normal_of_sphere},
                                           {step_cylinder, normal_of_cylinder}, {step_capsule, normal_of_capsule},
                                           {step_box, normal_of_box},           {step_cone, normal_of_cone},
                                           {step_torus, normal_of_torus},       {step_ellipsoid, normal_of_ellipsoid}};
  return kKinds[kind <= FDCG_SURFACE_ELLIPSOID ? kind : 0];
}

}  // namespace

bool is_linked(uint32_t kind) {
  return kind_of(kind).step != nullptr;
}

}  // namespace fdcg

extern "C" void fdcg_surface_step(const fdcg_surface* surface, const fdcg_params* params, fdcg_contact* contact,
                                  const double hip_object_m[3], fdcg_result* result) {
  using namespace fdcg;
  using namespace fdcg::surface_drive;
  *result = {};
  fdcg_surface surface_room;
  fdcg_params params_room;
  const fdcg_surface& whole = in_full(*surface, &surface_room, clear_surface);
  const SurfaceKind& kind = kind_of(whole.kind);
  params = admitted(surface_mark_of(whole.kind, whole.is_hollow), *params, &params_room, contact, result);
  if (params == nullptr) return;
  if (kind.step != nullptr && is_usable_place(hip_object_m)) {
    kind.step(whole, *params, contact, hip_object_m, result);
  } else {
    if (kind.step != nullptr) ++contact->non_finite_ticks;
    result->flags = kind.step != nullptr ? FDCG_RESULT_NON_FINITE : 0;
    report(*contact, result);
  }
}

extern "C" void fdcg_surface_get_normal(const fdcg_surface* surface, const fdcg_result* result, double normal[3]) {
  using namespace fdcg;
  normal[0] = normal[1] = normal[2] = 0;
  if (result->state == FDCG_FREE) return;
  fdcg_surface room;
  const fdcg_surface& whole = in_full(*surface, &room, clear_surface);
  if (SurfaceNormal* const normal_of = kind_of(whole.kind).normal; normal_of != nullptr) normal_of(whole, *result, normal);
}
