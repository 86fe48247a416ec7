// SPDX-License-Identifier: Apache-2.0
// Links every kind of surface, for a program that does not name the kind where it makes a surface.
#include "fdcg/surface.h"

extern "C" const uint32_t* const fdcg_linked_surfaces[8] = {&fdcg_linked_plane,   &fdcg_linked_sphere,   &fdcg_linked_cylinder,
                                                            &fdcg_linked_capsule, &fdcg_linked_box,      &fdcg_linked_cone,
                                                            &fdcg_linked_torus,   &fdcg_linked_ellipsoid};
