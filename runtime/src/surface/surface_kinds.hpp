// SPDX-License-Identifier: Apache-2.0
// The functions of each kind of surface. Each kind is a source, and an object of the library, by itself, which a program
// links when it makes such a surface: fdcg_make_sphere() reads fdcg_linked_sphere. The dispatch in surface_step.cpp links
// none of them: its references are weak, and null for a kind that the program does not link.
#pragma once

#include "fdcg/surface.h"

// Object formats other than ELF have no such references: there a program links all kinds.
#if defined(FDCG_SURFACE_DISPATCH) && defined(__ELF__)
#define FDCG_IF_LINKED [[gnu::weak]]
#else
#define FDCG_IF_LINKED
#endif

namespace fdcg {

using SurfaceStep = void(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3],
                         fdcg_result* result);
// Of a result that is not FDCG_FREE.
using SurfaceNormal = void(const fdcg_surface& surface, const fdcg_result& result, double normal[3]);

FDCG_IF_LINKED SurfaceStep step_plane, step_sphere, step_cylinder, step_capsule, step_box, step_cone, step_torus,
    step_ellipsoid;
FDCG_IF_LINKED SurfaceNormal normal_of_plane, normal_of_sphere, normal_of_cylinder, normal_of_capsule, normal_of_box,
    normal_of_cone, normal_of_torus, normal_of_ellipsoid;

// surface_step.cpp: whether the program links what surfaces of the kind are stepped by.
bool is_linked(uint32_t kind);

// A plane, and for the library's own use: fdcg_surface_init() would link all kinds.
inline void clear_surface(fdcg_surface* surface, uint32_t struct_bytes) {
  *surface = {};
  surface->struct_bytes = struct_bytes;
}

}  // namespace fdcg
