/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/surface.h
 * Surfaces that need no mesh: plane, sphere, cylinder, capsule, box, cone and frustum, torus, ellipsoid. On one screen:
 *
 *     fdcg_surface ball = fdcg_make_sphere(0.05);                                            metres
 *     fdcg_check_surface(&ball, &error);
 *     fdcg_contact contact = {0};
 *     each tick:  fdcg_surface_step(&ball, &params, &contact, hip_object_m, &result);      ->  result.force_n
 *
 * or as an object of a scene, beside graphs: fdcg_scene_add_surface(scene, &ball, &params, &pose, &object, &error).
 *
 * **Frames, units, handedness.** SI units; right-handed frames, the object's own for a step, the world in a scene.
 * **Ownership.** Surfaces are plain structs; a scene copies them. **Threads.** A surface is only read; one contact is stepped
 * by one thread at a time. Nothing allocates, locks or reads a clock.
 *
 * Every surface is centred in its frame and, where it has an axis, that is z. What is solid is the inside, and below the plane.
 * With is_hollow it is the other way round: a cavity in endless material, for a hand that is inside; its wall is felt from
 * inside only. (A shell that is felt from both sides is two surfaces.) As with graphs, a finger that starts in the material
 * passes out of it freely.
 *
 * The contact, the result and what they mean are those of fdcg_step: the god-object goes down the steepest descent of its
 * distance from the HIP, over the closed outside, and friction holds it while the part of the spring's force in the tangent
 * plane is at most mu times the part along the normal. `state` and `feature` say where it is:
 *
 *     plane, sphere, torus, ellipsoid   FDCG_FACE 0
 *     capsule                           FDCG_FACE 0 the side, 1 the cap at -z, 2 the one at +z
 *     cylinder, cone                    FDCG_FACE 0 the side, 1 the disc at -z, 2 the one at +z
 *                                       FDCG_EDGE 0 the rim at -z, 1 at +z
 *                                       FDCG_VERTEX 0 the apex at -z, 1 at +z
 *     box                               FDCG_FACE 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z: 2 axis + 1 for plus
 *                                       FDCG_EDGE 4 axis + 1, + 2 for the plus sides of the other two axes
 *                                       FDCG_VERTEX x + 2 y + 4 z, each 1 for plus
 *
 * The god-object rests on edges and vertices of cavities only; on convex ones it is on its way. Cost of a tick that slides 1 mm
 * deep at 0.1 m/s and 1 kHz with friction on surfaces of hand's size, at 3.6 GHz (tests/bench/surface_bench.cpp; alone, and in
 * a row): plane 24 and 16 ns, sphere 39 and 25, box 32 and 19, cylinder and capsule 60 and 50, cone and torus 72 and
 * 63, ellipsoid 140 and 130; at rest, free or without friction less. Slides so long, so deep or so near to an edge or an apex
 * that one move and one correction do not do take two to four times that. A jump halfway round a surface takes at most
 * FDCG_SURFACE_MAX_MOVES moves of some 60 ns, and what is left then is carried to the next tick (FDCG_RESULT_TRANSITION_BOUND)
 * with a valid god-object.
 *
 * A slide follows the descent to the first place where friction holds: the pull is mu_dynamic times the load there, within
 * 1e-12 and the rounding of places, however deep the hand is. Beyond an axis or a centre of curvature there may be several such
 * places and none near by, so that a small move of the hand may end in a large one of the god-object. In a large move the way
 * over a curved surface that friction ends is followed in pieces of a quarter of a radian; one that passes by a place at which
 * friction would just hold it may then be held there, or the other way round. A god-object that friction holds again by less
 * than a part in 2^20 still counts as slipping, as on graphs.
 */
#ifndef FDCG_SURFACE_H
#define FDCG_SURFACE_H

#include <string.h>

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_SURFACE_MAX_MOVES 64u /**< moves of one tick, at most */

/** Which surface, and which sizes it has. */
typedef enum fdcg_surface_kind {
  FDCG_SURFACE_PLANE = 0,    /**< z = 0, without end, solid below; it has no sizes and is not hollow */
  FDCG_SURFACE_SPHERE = 1,   /**< radius_m */
  FDCG_SURFACE_CYLINDER = 2, /**< radius_m, length_m along z */
  FDCG_SURFACE_CAPSULE = 3,  /**< radius_m, length_m along z, between the centres of its caps; may be 0 */
  FDCG_SURFACE_BOX = 4,      /**< half_m */
  FDCG_SURFACE_CONE = 5,     /**< radius_m at -length_m / 2, top_radius_m at +length_m / 2; one of them may be 0 */
  FDCG_SURFACE_TORUS = 6,    /**< radius_m from the axis to the middle of the tube, tube_radius_m below it */
  FDCG_SURFACE_ELLIPSOID = 7 /**< half_m: the semi-axes */
} fdcg_surface_kind;

/** A surface. Fields that the kind does not name are 0. */
typedef struct fdcg_surface {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_surface); the makers below set it */
  uint32_t kind;         /**< fdcg_surface_kind */
  uint32_t is_hollow;    /**< 1: the hand is inside */
  uint32_t reserved;     /**< 0 */
  double radius_m;       /**< as the kind says, here and below */
  double top_radius_m;   /**< cone */
  double tube_radius_m;  /**< torus */
  double length_m;       /**< cylinder, capsule, cone */
  double half_m[3];      /**< box, ellipsoid */
} fdcg_surface;

/** FDCG_SURFACE_PLANE; the eight constants like it stand beside the code for their kind. A program links the kinds that it
 * makes and no others: the makers below read these, and fdcg_surface_init and fdcg_make_surface, which do not know the kind,
 * link all. Of a surface that was made by none of them and whose kind is not linked, fdcg_check_surface says so, and the step
 * feels nothing. */
FDCG_API extern const uint32_t fdcg_linked_plane;
FDCG_API extern const uint32_t fdcg_linked_sphere;    /**< FDCG_SURFACE_SPHERE */
FDCG_API extern const uint32_t fdcg_linked_cylinder;  /**< FDCG_SURFACE_CYLINDER */
FDCG_API extern const uint32_t fdcg_linked_capsule;   /**< FDCG_SURFACE_CAPSULE */
FDCG_API extern const uint32_t fdcg_linked_box;       /**< FDCG_SURFACE_BOX */
FDCG_API extern const uint32_t fdcg_linked_cone;      /**< FDCG_SURFACE_CONE */
FDCG_API extern const uint32_t fdcg_linked_torus;     /**< FDCG_SURFACE_TORUS */
FDCG_API extern const uint32_t fdcg_linked_ellipsoid; /**< FDCG_SURFACE_ELLIPSOID */
/** All kinds, by fdcg_surface_kind. */
FDCG_API extern const uint32_t* const fdcg_linked_surfaces[8];

/** Sets the first `struct_bytes` bytes of *surface: a plane, which is all zero except for struct_bytes. */
FDCG_INLINE void fdcg_surface_init(fdcg_surface* surface, uint32_t struct_bytes) {
  if (surface == NULL) return;
  memset((void*)surface, 0, struct_bytes);
  surface->struct_bytes = struct_bytes;
  surface->kind = *fdcg_linked_surfaces[FDCG_SURFACE_PLANE];
}
/** A surface of one of the kinds above; what the makers share. */
FDCG_INLINE fdcg_surface fdcg_make_linked_surface(uint32_t linked_kind, double radius_m, double length_m) {
  fdcg_surface surface;
  memset((void*)&surface, 0, sizeof surface);
  surface.struct_bytes = (uint32_t)sizeof surface;
  surface.kind = linked_kind;
  surface.radius_m = radius_m;
  surface.length_m = length_m;
  return surface;
}
/** A surface of a kind that is known when the program runs, with a radius and a length; set other sizes in its fields. */
FDCG_INLINE fdcg_surface fdcg_make_surface(fdcg_surface_kind kind, double radius_m, double length_m) {
  fdcg_surface surface = fdcg_make_linked_surface(*fdcg_linked_surfaces[FDCG_SURFACE_PLANE], radius_m, length_m);
  surface.kind = (uint32_t)kind;
  return surface;
}
/** The plane z = 0, solid below. */
FDCG_INLINE fdcg_surface fdcg_make_plane(void) {
  return fdcg_make_linked_surface(fdcg_linked_plane, 0, 0);
}
/** A ball. */
FDCG_INLINE fdcg_surface fdcg_make_sphere(double radius_m) {
  return fdcg_make_linked_surface(fdcg_linked_sphere, radius_m, 0);
}
/** A cylinder along z. */
FDCG_INLINE fdcg_surface fdcg_make_cylinder(double radius_m, double length_m) {
  return fdcg_make_linked_surface(fdcg_linked_cylinder, radius_m, length_m);
}
/** A cylinder along z between two half balls, whose centres are length_m apart. */
FDCG_INLINE fdcg_surface fdcg_make_capsule(double radius_m, double length_m) {
  return fdcg_make_linked_surface(fdcg_linked_capsule, radius_m, length_m);
}
/** A cone or frustum along z: radius_m at the bottom, top_radius_m at the top. */
FDCG_INLINE fdcg_surface fdcg_make_cone(double radius_m, double top_radius_m, double length_m) {
  fdcg_surface surface = fdcg_make_linked_surface(fdcg_linked_cone, radius_m, length_m);
  surface.top_radius_m = top_radius_m;
  return surface;
}
/** A ring about z. */
FDCG_INLINE fdcg_surface fdcg_make_torus(double radius_m, double tube_radius_m) {
  fdcg_surface surface = fdcg_make_linked_surface(fdcg_linked_torus, radius_m, 0);
  surface.tube_radius_m = tube_radius_m;
  return surface;
}
/** A box with half its sides given. */
FDCG_INLINE fdcg_surface fdcg_make_box(double half_x_m, double half_y_m, double half_z_m) {
  fdcg_surface surface = fdcg_make_linked_surface(fdcg_linked_box, 0, 0);
  surface.half_m[0] = half_x_m;
  surface.half_m[1] = half_y_m;
  surface.half_m[2] = half_z_m;
  return surface;
}
/** An ellipsoid with its semi-axes given. */
FDCG_INLINE fdcg_surface fdcg_make_ellipsoid(double half_x_m, double half_y_m, double half_z_m) {
  fdcg_surface surface = fdcg_make_linked_surface(fdcg_linked_ellipsoid, 0, 0);
  surface.half_m[0] = half_x_m;
  surface.half_m[1] = half_y_m;
  surface.half_m[2] = half_z_m;
  return surface;
}

/** Checks every field. FDCG_E_ARGUMENT, with the field, its value and its limit in the message, unless every field is in range:
 * sizes of 1e-9 to 1e9 m, none less than 1e-4 of the largest (a tube's radius at most 1 - 1e-4 of the torus'), and no field set
 * that the kind does not name; a capsule's length may be 0, and so may one radius of a cone. The step does not check. */
FDCG_API fdcg_status fdcg_check_surface(const fdcg_surface* surface, fdcg_error* error);

/** Moves the contact to the HIP of this tick and computes what the hand should feel: fdcg_step for a surface. Of *params
 * neither disabled_optimizations nor `terms` count: friction is that of the two coefficients. */
FDCG_API void fdcg_surface_step(const fdcg_surface* surface, const fdcg_params* params, fdcg_contact* contact,
                                const double hip_object_m[3], fdcg_result* result);

/** Reads the unit normal, away from the material, at result->god_object_m; on an edge or a vertex the direction of the sum of
 * those of its faces. Zero where the result is FDCG_FREE. */
FDCG_API void fdcg_surface_get_normal(const fdcg_surface* surface, const fdcg_result* result, double normal[3]);

/** Computes volume, centroid and inertia in closed form; the density is the caller's (fdcg_body_set_mass). FDCG_E_ABSENT for a
 * plane and for what is hollow: they have no end. */
FDCG_API fdcg_status fdcg_surface_get_mass(const fdcg_surface* surface, fdcg_mass* mass, fdcg_error* error);

/** Adds a surface to a scene, as fdcg_scene_add_object does a graph; the scene keeps a copy of the surface. All else of scene.h
 * takes the object as any other. A plane is in reach of every finger near it or below it, and takes one of its
 * touches_per_finger there; a plane that is turned, or the like, makes every finger look at all objects. */
FDCG_API fdcg_status fdcg_scene_add_surface(fdcg_scene* scene, const fdcg_surface* surface, const fdcg_params* params,
                                            const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_SURFACE_H */
