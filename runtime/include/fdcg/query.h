/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/query.h
 * Questions to a graph: the nearest point, inside or outside, a ray; what a contact is on; a whole path in one call.
 *
 *     fdcg_surface_hit hit = fdcg_make_surface_hit();
 *     fdcg_find_nearest(&graph, point_object_m, HUGE_VAL, &hit, &error);      ->  hit.point_m, hit.distance_m, hit.side
 *     fdcg_cast_ray(&graph, from_object_m, direction, 0.5, &hit, &error);     ->  FDCG_E_ABSENT: nothing within 0.5 m
 *
 *     fdcg_contact_info info = fdcg_make_contact_info();
 *     fdcg_get_contact_info(&graph, NULL, &before, &result, 0.001, &info, &error);   ->  info.normal, info.slip_m_per_s
 *     if (fdcg_get_contact_events(&before, &result) & FDCG_EVENT_BEGAN) play_a_click();
 *
 * **The surface** that is asked is that of the graph's nodes: the mesh's own, but for faces that fdcg compile has merged, which
 * it takes for flat up to header->max_deviation.
 *
 * **Exactness.** In the precision of the graph's file: eps is 2^-52 or 2^-23, E the largest coordinate (header->extent). A
 * distance is good to 4 eps E, or of itself where larger. The side is exact where the nearest point is inside a face; on edges
 * and at corners it may be wrong for points nearer than 4 eps E. Whether a ray meets a face is decided by exact signs of its
 * ends and the face's corners: it slips through no edge and no corner of a watertight mesh. Where it meets the face is good to
 * 8 eps (E + its length).
 *
 * **Cost.** A search of the stored hierarchy, nearest boxes first: 1 to 2 us for points within a hundredth of E of a mesh of a
 * million faces, 5 us for a ray; some 0.3 ms for points as far away as the mesh is large, since many of its faces are about as
 * near as the nearest. A point as far from everything as a sphere's centre, and one from beyond 64 E, looks at all nodes. Not
 * bounded as a step is: not for the servo thread, but for fdcg_get_contact_info and fdcg_get_contact_events (0.1 us).
 *
 * **Frames, units, handedness.** SI units in the object's right-handed frame, as in fdcg.h. **Ownership.** Nothing is kept.
 * **Threads.** A graph is only read.
 */
#ifndef FDCG_QUERY_H
#define FDCG_QUERY_H

#include "fdcg/fdcg.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A place on a graph's surface. Make it by fdcg_make_surface_hit: it may grow. */
typedef struct fdcg_surface_hit {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_surface_hit); fdcg_make_surface_hit sets it */
  uint32_t state;        /**< fdcg_state: inside a face, on an edge, at a vertex. Of a ray always FDCG_FACE */
  uint32_t feature;      /**< its number: node, connection or corner */
  uint32_t node;         /**< a node there: the feature itself, or one beside it */
  int32_t side;          /**< of the point, or of the ray's start at what it meets: 1 in front, -1 behind, 0 on the surface */
  uint32_t reserved;     /**< 0 */
  double point_m[3];     /**< the place */
  double normal[3];      /**< unit, outward: of the face; of an edge the direction of its faces' sum; of a vertex to 1e-4 */
  double distance_m;     /**< from the point; or along the ray */
} fdcg_surface_hit;
/** Sets the first `struct_bytes` bytes of *hit: zeros, and the size. */
FDCG_API void fdcg_surface_hit_init(fdcg_surface_hit* hit, uint32_t struct_bytes);
/** An empty hit of fdcg_surface_hit_init. */
FDCG_INLINE fdcg_surface_hit fdcg_make_surface_hit(void) {
  fdcg_surface_hit hit;
  fdcg_surface_hit_init(&hit, (uint32_t)sizeof hit);
  return hit;
}

/** Finds the place of the surface that is nearest to a point, no farther than reach_m (may be infinite). FDCG_E_ABSENT: there
 * is none so near. FDCG_E_ARGUMENT for a point that is not finite or beyond 1e60 E, and for a reach below 0. `error` may be
 * NULL, here and below. */
FDCG_API fdcg_status fdcg_find_nearest(const fdcg_graph* graph, const double point_object_m[3], double reach_m,
                                       fdcg_surface_hit* hit, fdcg_error* error);

/** The distance from the surface: positive in front of it, negative behind, in a closed mesh inside. Errors as above. */
FDCG_API fdcg_status fdcg_get_signed_distance(const fdcg_graph* graph, const double point_object_m[3], double* distance_m,
                                              fdcg_error* error);

/** Whether a point is behind the surface: *is_inside 1 or 0. On it counts as outside. Of an open mesh it says which side of the
 * nearest place the point is on. Errors as above. */
FDCG_API fdcg_status fdcg_is_inside(const fdcg_graph* graph, const double point_object_m[3], int32_t* is_inside,
                                    fdcg_error* error);

/** Finds what a ray meets first, from either side of faces, no farther than reach_m (may be infinite). `direction`: of any
 * length but 0. A ray that starts on the surface meets it at once; one that lies in the plane of a face meets the faces around
 * it. FDCG_E_ABSENT: it meets nothing. FDCG_E_ARGUMENT for numbers that are not usable. */
FDCG_API fdcg_status fdcg_cast_ray(const fdcg_graph* graph, const double from_object_m[3], const double direction[3],
                                   double reach_m, fdcg_surface_hit* hit, fdcg_error* error);

/* ---- contacts ---------------------------------------------------------------------------------------------------------- */

/** What a contact is on. Make it by fdcg_make_contact_info: it may grow. */
typedef struct fdcg_contact_info {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_contact_info); fdcg_make_contact_info sets it */
  uint32_t node;         /**< the face, or one beside the edge or vertex */
  uint32_t corners[3];   /**< of a triangle of that face with the god-object; on an edge its two ends; FDCG_NONE where fewer */
  uint32_t source_face;  /**< the lowest face of the mesh file that became the node; FDCG_NONE: not asked, or not in the file */
  uint32_t material;     /**< fdcg_get_node_material of the node */
  uint32_t events;       /**< fdcg_get_contact_events */
  double weights[3];     /**< barycentric, of the corners: at least 0, and they add up to 1 */
  double normal[3];      /**< unit, outward; on an edge the direction of its faces' sum; at a vertex to 1e-4. 0 where free */
  double slip_m_per_s[3]; /**< velocity of the god-object over the surface; 0 while it sticks or was not in contact before */
} fdcg_contact_info;
/** Sets the first `struct_bytes` bytes of *info: zeros, and the size. */
FDCG_API void fdcg_contact_info_init(fdcg_contact_info* info, uint32_t struct_bytes);
/** An empty info of fdcg_contact_info_init. */
FDCG_INLINE fdcg_contact_info fdcg_make_contact_info(void) {
  fdcg_contact_info info;
  fdcg_contact_info_init(&info, (uint32_t)sizeof info);
  return info;
}

/** Says what a contact is on, from its result on this graph and that of the tick before, tick_s earlier (NULL: none; then it
 * begins now). `source_of_node`: what fdcg_invert_source_map filled, or NULL. In free space node and corners are FDCG_NONE, and
 * all else but the events is 0. FDCG_E_ARGUMENT for a feature that the graph does not have and a tick_s that is not above 0. */
FDCG_API fdcg_status fdcg_get_contact_info(const fdcg_graph* graph, const uint32_t* source_of_node, const fdcg_result* before,
                                           const fdcg_result* now, double tick_s, fdcg_contact_info* info, fdcg_error* error);

/** Fills source_of_node[node] with the lowest face of the mesh file that became the node; FDCG_NONE for none. `count`: its
 * entries, at least header->node_count. FDCG_E_ABSENT where the file has no source map. Cost: linear in the mesh, once. */
FDCG_API fdcg_status fdcg_invert_source_map(const fdcg_graph* graph, uint32_t* source_of_node, uint32_t count,
                                            fdcg_error* error);

/** What has changed from one tick to the next. */
typedef enum fdcg_contact_event {
  FDCG_EVENT_BEGAN = 1,      /**< touches, and did not */
  FDCG_EVENT_ENDED = 2,      /**< does not touch, and did */
  FDCG_EVENT_SLIP_BEGAN = 4, /**< slips, and did not */
  FDCG_EVENT_SLIP_ENDED = 8, /**< sticks or is free, and slipped */
  FDCG_EVENT_FEATURE = 16    /**< touches another face, edge or vertex than it did */
} fdcg_contact_event;
/** fdcg_contact_event bits between two results of one contact. `before` NULL: it was free. */
FDCG_API uint32_t fdcg_get_contact_events(const fdcg_result* before, const fdcg_result* now);

/* ---- many at once ------------------------------------------------------------------------------------------------------ */

/** Steps one contact along a path: `count` ticks, hips_object_m + 3 i to results[i]. The same bits as as many calls of
 * fdcg_step. */
FDCG_API void fdcg_step_path(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                             const double* hips_object_m, fdcg_result* results, uint64_t count);

/** One tick of `count` contacts on one graph: contacts[i] at hips_object_m + 3 i to results[i]. */
FDCG_API void fdcg_step_many(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contacts,
                             const double* hips_object_m, fdcg_result* results, uint64_t count);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_QUERY_H */
