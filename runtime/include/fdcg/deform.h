/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/deform.h
 * A deformable mesh: the caller moves its vertices, fingers feel it where it is. On one screen:
 *
 *     fdcg_graph graph;  fdcg_open_file("sheet.fdcg", ...);              compiled with --triangles: every node one triangle
 *     void* memory = malloc(fdcg_deform_bytes(&graph));                  or a static array: it never asks for more
 *     fdcg_deform_create(memory, bytes, &graph, &config, &deform, &error);
 *     for each vertex of the mesh:
 *       fdcg_deform_find(deform, vertex_m[v], &corner_of[v], &error);
 *     fdcg_deform_contact contact = {0};
 *     each tick:
 *       fdcg_deform_move(deform, corner_of[v], position_m, &error);      for each vertex that moves, or
 *       fdcg_deform_move_corners(deform, corners, positions_m, count, &error);       for all that move
 *       fdcg_deform_step(deform, &params, &contact, hip_object_m, &result);          ->  result.force_n
 *
 * or as an object of a scene, beside graphs and surfaces:
 * fdcg_scene_add_deform(scene, deform, &params, &pose, &object, &error).
 *
 * **Frames, units, handedness.** SI units; positions in the object's right-handed frame, as in fdcg.h.
 *
 * **Ownership.** The mesh lives in the caller's memory and points to its graph, which must outlive it; it must not be moved.
 *
 * **What is computed when.** What depends on the corners' places - planes, edges, types, corner normals, boxes - is brought up
 * to date when a step looks at it, and not before: a tick costs what it moves and what it touches, whatever the mesh. Nothing
 * old is ever looked at. An edge's type is the exact sign of its four corners as they are; a triangle's plane has the bits that
 * fdcg compile gives a triangle with a plane of its own. Compile, with --triangles too, also takes an edge for flat, and lets
 * its triangles share a plane, where that is so within what the mesh's coordinates are rounded to: there types and normals may
 * differ from the file's, from the start on.
 *
 * **What a finger feels.** A god-object in contact rides on its feature: at the same place of its triangle, edge or corner. A
 * free HIP that a face passes over is caught by it, however far the vertices moved in the tick, and whether or not the HIP
 * moves: each triangle's way from where the last tick left it is three tetrahedra (its corners move in the order of their
 * numbers), and exact signs say whether the HIP lay in one. There is no crack between the ways of two neighbours. Then the
 * HIP's own way is swept on the mesh as it now is.
 *
 * **What it does not see**: parts of the mesh that move through one another, and a part that moves over a god-object in contact
 * with another part. A contact should be stepped at least once between two ticks' moves: of a motion that it missed it sees
 * only where it ended, and FDCG_DEFORM_MISSED is set.
 *
 * Any triangle may be squeezed to a line or a point, and comes back: while it is less than 8 epsilons of the extent high it
 * takes the plane of the neighbour across its longest side that has one, and no god-object stays on it. Two faces that lie on
 * one another exactly are a fold: their edge keeps the type that it had when a step last looked at it.
 *
 * **Threads.** One at a time. Steps write too (what they bring up to date).
 *
 * **Cost** (busy machine, tests/bench/deform_bench.cpp): moving a vertex 10 to 13 ns, in one call for all 10 to 17 wherever
 * they lie; scattered over a mesh larger than the cache and in a call each, 19 to 25: one wait for memory. On a sheet of 10^5
 * triangles of which a hundredth moves each tick a step in contact takes 1.7 to 2.7 times the rigid one, the dearest where all
 * of it moves around the finger; one of a free HIP 1.3 to 3.2 times. While no box of what moves reaches it, a free HIP costs
 * nothing more, however far the surface moves in its boxes: the mesh watches over the clear balls of 16 contacts, others look
 * anew. A HIP so near that they do reach it looks once a tick for faces that passed over it: 0.3 to 0.9 us at 1 to 2 mm over
 * waves of 0.5 to 3 mm, 2 to 5 times as over waves that stand still.
 *
 * What a step brings up to date is bounded as its other work is (some 90,000 instructions): where that is spent, a sweep goes
 * on in the next tick. Not bounded is the look for faces that passed over a HIP: by the triangles in whose boxes it lies.
 * Memory, for each triangle: some 177 bytes (f64), 141 (f32).
 */
#ifndef FDCG_DEFORM_H
#define FDCG_DEFORM_H

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Edges at a corner of a deformable mesh, at most. */
#define FDCG_DEFORM_MOST_FAN 256u

/** A deformable mesh, in memory of the caller's: not to be copied or moved. It points to the graph, which must outlive
 * it. There is nothing to destroy. */
typedef struct fdcg_deform fdcg_deform;

/** How far vertices may be moved. */
typedef struct fdcg_deform_config {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_deform_config); fdcg_make_deform_config sets it */
  uint32_t reserved;     /**< 0 */
  double margin_m; /**< how far beyond the graph's bounds, along each axis, a vertex may be moved; 0, the default: as far as the
                      bounds' largest side. It adds to the extent, which scales rounding */
} fdcg_deform_config;

/** Sets the first `struct_bytes` bytes of *config: the default margin. */
FDCG_API void fdcg_deform_config_init(fdcg_deform_config* config, uint32_t struct_bytes);
/** The default config of fdcg_deform_config_init. */
FDCG_INLINE fdcg_deform_config fdcg_make_deform_config(void) {
  fdcg_deform_config config;
  fdcg_deform_config_init(&config, (uint32_t)sizeof config);
  return config;
}

/** The bytes that fdcg_deform_create needs; 0 if the graph cannot be deformed (fdcg_deform_create says why). */
FDCG_API uint64_t fdcg_deform_bytes(const fdcg_graph* graph);

/** Makes a deformable mesh in `memory`, a multiple of 8 (*deform is the next multiple of 64), with every vertex where the graph
 * has it. FDCG_E_GRAPH unless every node is a triangle and no corner has more than FDCG_DEFORM_MOST_FAN edges. `error` may be
 * NULL, here and below. Cost: linear in the graph. */
FDCG_API fdcg_status fdcg_deform_create(void* memory, uint64_t bytes, const fdcg_graph* graph, const fdcg_deform_config* config,
                                        fdcg_deform** deform, fdcg_error* error);

/** Finds the corner at a place: of those nearer than 2^-20 of the extent the nearest, of equally near ones the lowest.
 * FDCG_E_ABSENT where there is none, however far away; FDCG_E_ARGUMENT for a place that is not finite. Ask before vertices
 * move: a mesh's vertex has the place that its file says, in metres in the object's frame. Vertices that the compiler welded
 * are one corner. Cost: the boxes around the place. */
FDCG_API fdcg_status fdcg_deform_find(const fdcg_deform* deform, const double position_object_m[3], uint32_t* corner,
                                      fdcg_error* error);

/** Moves a corner. FDCG_E_ARGUMENT, and it stays where it was, for a place that is not finite or beyond the margin, or a number
 * that no corner has. Moved more than once between two steps it counts as moved straight from the first place to the last. */
FDCG_API fdcg_status fdcg_deform_move(fdcg_deform* deform, uint32_t corner, const double position_object_m[3],
                                      fdcg_error* error);

/** Moves many corners, each as fdcg_deform_move does: corners[i] to the three numbers at positions_object_m + 3 i. Stops at the
 * first that is refused, whose number the error says: those before it have been moved. Faster by some nanoseconds each. */
FDCG_API fdcg_status fdcg_deform_move_corners(fdcg_deform* deform, const uint32_t* corners, const double* positions_object_m,
                                              uint64_t count, fdcg_error* error);

/** Reads where a corner is: the place it was moved to, rounded to the file's precision. FDCG_E_ARGUMENT for a number that none
 * has.
 */
FDCG_API fdcg_status fdcg_deform_place(const fdcg_deform* deform, uint32_t corner, double position_object_m[3],
                                       fdcg_error* error);

/** One contact point on one deformable mesh. All zero: not yet started. Copy it freely. */
typedef struct fdcg_deform_contact {
  fdcg_contact contact; /**< as on a rigid graph */
  double travel;        /**< of the mesh, when the contact was last stepped */
  uint64_t tick;        /**< the mesh's, likewise */
  uint32_t
      halvings;  /**< a sweep that ran out of work cannot go on on a mesh that has moved: so often its way was halved since */
  uint32_t ball; /**< where the mesh watches over the contact's clear ball, if it does */
} fdcg_deform_contact;

/** In fdcg_result.flags, beside fdcg_result_flag: the vertices have moved more than once since this contact's last step. */
#define FDCG_DEFORM_MISSED 0x10000u
/** In fdcg_result.flags: a face passed over the free HIP, and has caught it. */
#define FDCG_DEFORM_CAUGHT 0x20000u

/** Steps a contact as fdcg_step does, on the mesh as it is now. The first step after vertices have moved begins a tick. */
FDCG_API void fdcg_deform_step(fdcg_deform* deform, const fdcg_params* params, fdcg_deform_contact* contact,
                               const double hip_object_m[3], fdcg_result* result);

/** Shares a result's force out among the corners that bear it, to hand it back to a simulation: corners[k], of which as many as
 * the feature has (three, two, one) are not FDCG_NONE, with weights that add up to 1. In free space all are FDCG_NONE and 0.
 * FDCG_E_ARGUMENT for a feature that the mesh does not have. */
FDCG_API fdcg_status fdcg_deform_share(const fdcg_deform* deform, const fdcg_result* result, uint32_t corners[3],
                                       double weights[3], fdcg_error* error);

/** Brings the whole mesh up to date, to look at: fdcg_get_node and its like. Good until a vertex is moved. Not for fdcg_step
 * where a triangle has no area. Not to be closed. Cost: linear in the mesh. */
FDCG_API const fdcg_graph* fdcg_deform_get_graph(fdcg_deform* deform);

/** Adds a deformable mesh to a scene, as fdcg_scene_add_object does a graph; the mesh must outlive the scene, and stays where
 * it was created. FDCG_E_ARGUMENT unless the scene was created with config.has_deforms. All else of scene.h takes the object as
 * any other, poses too: then it moves as a whole, and its vertices in its frame. Vertices are moved between the scene's steps,
 * by one thread that is in the scene; every finger that is within the mesh's bounds and margin is stepped on it in every tick,
 * from its first step on, touching or not, and takes one of its touches_per_finger there. Of a mesh just added or enabled again
 * a finger sees the motion from the next step on. fdcg_touch.flags says FDCG_DEFORM_MISSED and FDCG_DEFORM_CAUGHT too. Several
 * objects may be one mesh, and a copy of the scene's memory goes on with the same. Bodies of a pile do not meet it:
 * fdcg_pile_add refuses it. Cost: brings the whole mesh up to date, once. */
FDCG_API fdcg_status fdcg_scene_add_deform(fdcg_scene* scene, fdcg_deform* deform, const fdcg_params* params,
                                           const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_DEFORM_H */
