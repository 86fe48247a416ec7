/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/pile.h
 * Bodies that meet: on the ground, on fixed objects, on one another. On one screen, after a scene and its bodies (body.h):
 *
 *     fdcg_pile_config config = fdcg_make_pile_config();                how many objects, points and touches at most
 *     void* memory = malloc(fdcg_pile_bytes(&config));                  or a static array: the pile never asks for more
 *     fdcg_pile_create(memory, bytes, &config, &pile, &error);
 *     fdcg_pile_set_ground(pile, normal, 0, &params, &error);           the half-space below normal . x = 0
 *     fdcg_pick_points(&graph, points, 20, &count, &error);             where a body touches: corners, edges
 *     fdcg_pile_add(pile, scene, object, points, count, &error);        a body; 0 points: it is only touched
 *     each tick, in place of fdcg_scene_step_bodies:
 *       fdcg_scene_step_pile(scene, pile, bodies, body_count, substeps, 0.001, reactions, reaction_count, &error);
 *
 * **Points.** A body touches with its points: each is a contact point with a friction-cone god-object in the frame of what it
 * touches, the same step that a finger makes (fdcg.h), so what rests does not creep. Where two bodies meet, the points of each
 * are tested against the other. Where an edge crosses an edge between the points of both, nothing is felt: so points stand
 * along edges too. A member of the pile that is not among the bodies of a step is fixed, or moved by fdcg_scene_set_pose alone;
 * then it carries along what lies on it.
 *
 * **What acts between two**: the parameters of both objects (fdcg_scene_add_object), combined by fdcg_combine_materials. Of the
 * object touched those of the faces' materials count where its flags say so (FDCG_FRICTION_MATERIALS), on edges and corners by
 * the step's own rules (fdcg.h); of the point's object the general ones. The friction curve counts on graphs and on the ground,
 * not on surfaces (surface.h). A touch keeps the stiffness that it began with; where faces have materials it follows them. The
 * stiffness is that of both springs in series, k1 k2 / (k1 + k2), but no stiffer than an eighth of the bound of the step,
 * 1 / (8 h^2 w), where w says how easily the place moves (1/kg, over three directions): so no pile runs away while fewer than
 * 32 touches pull at two bodies that meet. fdcg_pile_get_substeps says how many substeps spare all touches that bound; those
 * that meet it are counted and flagged. The other parameters (edge_friction, ...) are those of the object touched;
 * damping_n_s_per_m is for fingers only.
 *
 * **Damping**: of the approach by damping_ratio of the critical value for the mass that this contact moves, of the way back out
 * by leaving_ratio of it, so that what falls does not bounce; of what sticks, sideways, by twice damping_ratio. Dampers are
 * solved implicitly, one after the other: none adds energy at any step. A contact never pulls, and what a damper adds sideways
 * stays inside the cone. Slipping is damped by friction alone: the god-object's cone is measured by the spring, whose push is
 * the load once the approach is over. Each point has its own cone, and all points between two
 * members share their static friction: while one of them rests, the others give way at mu_static, and what they cannot bear
 * goes to those that can; once all slip, mu_dynamic holds for each until all rest again. (Where friction flags are set, and
 * with the ninth member that one touches and further ones, each point is judged by itself.)
 *
 * **Impacts.** A spring of the stiffness asked may not stop what comes fast before it is through. So the approach is also
 * damped as far as it takes to keep a point no deeper than a quarter of the smaller of the two bodies' least widths.
 *
 * **Cost.** Two bodies far apart cost nothing until they have used up the distance last measured (then 1 to 2 ns an object);
 * near one another, some 5 ns a point that is out of the other's box; a touch 0.1 to 0.2 us with its damper. What lies still is
 * not stepped: a body asleep among still ones costs some 5 ns a touch. Memory: an object or a touch 0.4 KB, a point 32 bytes.
 * Nothing here allocates, locks, recurses or reads a clock; every loop is bounded by the capacities.
 *
 * **Frames, units, handedness.** SI units, right-handed frames; points are in the frame of their object, all else in the world.
 *
 * **Ownership.** A pile lives in the caller's memory and keeps no pointer; points and params are copied in.
 *
 * **Threads.** One thread at a time is in a pile and its scene.
 */
#ifndef FDCG_PILE_H
#define FDCG_PILE_H

#include "fdcg/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A pile, in memory of the caller's. Holds no pointer, so a copy of the whole is a snapshot. Goes with one scene. */
typedef struct fdcg_pile fdcg_pile;

/** What a pile does not do where it cannot matter. Each can be switched off: every motion stays the same, bit for bit. */
typedef enum fdcg_pile_optimization {
  FDCG_PILE_OPT_FAR = 1,   /**< in between only nearby objects are tested */
  FDCG_PILE_OPT_STILL = 2, /**< touches between two that have not moved keep their forces */
  FDCG_PILE_OPT_ALL = 3    /**< every one */
} fdcg_pile_optimization;

/** What a pile has room for, and its damping. */
typedef struct fdcg_pile_config {
  uint32_t struct_bytes;           /**< the caller's sizeof(fdcg_pile_config); fdcg_make_pile_config sets it */
  uint32_t object_capacity;        /**< 1 to 1,000,000: the scene's objects of smaller index can be in the pile */
  uint32_t point_capacity;         /**< 1 to 1,000,000, of all bodies together */
  uint32_t touch_capacity;         /**< 1 to 1,000,000: points on, or within the box of, something, at once */
  double damping_ratio;            /**< 0 to 1,000; 1: critical for each contact by itself */
  double leaving_ratio;            /**< the same for the way out */
  uint32_t disabled_optimizations; /**< fdcg_pile_optimization bits that are off; 0: all are on */
  uint32_t reserved;               /**< 0 */
} fdcg_pile_config;

/** Sets the first `struct_bytes` bytes of *config: 64 objects, 128 points, 128 touches, ratios 1 and 4; some 75 KB. */
FDCG_API void fdcg_pile_config_init(fdcg_pile_config* config, uint32_t struct_bytes);
/** The default config of fdcg_pile_config_init. */
FDCG_INLINE fdcg_pile_config fdcg_make_pile_config(void) {
  fdcg_pile_config config;
  fdcg_pile_config_init(&config, (uint32_t)sizeof config);
  return config;
}

/** The bytes that fdcg_pile_create needs; 0 if the config is out of range (fdcg_pile_create says why). */
FDCG_API uint64_t fdcg_pile_bytes(const fdcg_pile_config* config);

/** Makes an empty pile without ground at `memory`, a multiple of 8. `error` may be NULL, here and below. */
FDCG_API fdcg_status fdcg_pile_create(void* memory, uint64_t bytes, const fdcg_pile_config* config, fdcg_pile** pile,
                                      fdcg_error* error);

/** Sets the ground: solid where normal . x < offset_m, world; a normal of unit length within 1e-3 (made exactly so). params
 * NULL takes it away. Of them, what counts are the two coefficients, the stiffness and the friction curve
 * (FDCG_FRICTION_STRIBECK, _VISCOUS, _LAG); it has no edges, no faces with materials, and no presliding. A point that begins
 * below it is pushed out. */
FDCG_API fdcg_status fdcg_pile_set_ground(fdcg_pile* pile, const double normal[3], double offset_m, const fdcg_params* params,
                                          fdcg_error* error);

/** Adds an object of the scene: `point_count` points in its own frame, before the pose's scale, up to 1e12 m; none for one
 * that is only touched. Called again for the same object: with other points, letting go of what it touched. FDCG_E_ARGUMENT
 * where the capacities do not suffice. Cost: the points and the touches. (C before C23, asked to be pedantic, warns of points
 * that are not const: the cast is (const double(*)[3])points.) */
FDCG_API fdcg_status fdcg_pile_add(fdcg_pile* pile, const fdcg_scene* scene, fdcg_object_id object, const double (*points_m)[3],
                                   uint32_t point_count, fdcg_error* error);
/** Takes an object out. One that left the scene leaves by itself. */
FDCG_API fdcg_status fdcg_pile_remove(fdcg_pile* pile, fdcg_object_id object, fdcg_error* error);

/** Picks points for a graph's body, in the object's frame, `capacity` (1 to 256) of them or fewer. First corners: for each of
 * 64 * capacity directions spread over the sphere the one farthest that way, each once, in the order found: all corners of a
 * box's hull, and of others but the most pointed among very many; where there are more than `capacity`, the thinning is even in
 * direction. In the room that is left, points along the edges (those whose faces turn by more than 26 degrees), each where the
 * pieces are the longest; a box at 8 has its corners, at 20 the middles of its edges too, which two boxes turned against each
 * other need. Each is drawn in by 1/1024 of its way from the corners' mean: boxes that lie flush, edge over edge, then stand on
 * one another. For set-up: reads the graph's corners 64 * capacity times (20 ms for 10^4 corners and 32 points); 12 KB of
 * stack. */
FDCG_API fdcg_status fdcg_pick_points(const fdcg_graph* graph, double (*points_m)[3], uint32_t capacity, uint32_t* count,
                                      fdcg_error* error);

/** Makes a tick like fdcg_scene_step_bodies (body.h: arguments, errors), where the pile's members meet as well, in every
 * substep. `reactions` are those to the fingers. A body that is no member meets nothing but fingers. */
FDCG_API fdcg_status fdcg_scene_step_pile(fdcg_scene* scene, fdcg_pile* pile, fdcg_scene_body* bodies, uint32_t body_count,
                                          uint32_t substeps, double tick_s, fdcg_reaction* reactions, uint32_t reaction_count,
                                          fdcg_error* error);

/** How many substeps a tick of tick_s takes so that no touch between any two of the pile's members, or with the ground, is made
 * softer than their parameters ask: 1 to FDCG_BODY_MAX_SUBSTEPS; 0 where more would be needed. `bodies`: those of the ticks.
 * For set-up: the square of the members, times their points. */
FDCG_API uint32_t fdcg_pile_get_substeps(const fdcg_pile* pile, const fdcg_scene* scene, const fdcg_scene_body* bodies,
                                         uint32_t body_count, double tick_s);

/** One point that presses on something. */
typedef struct fdcg_pile_touch {
  fdcg_object_id object; /**< whose point */
  fdcg_object_id on;     /**< all zero: the ground */
  double force_n[3]; /**< world, on the point's object, damping included, in the last substep that looked at it; what it lies
                        on gets the opposite */
  double god_object_m[3];   /**< world */
  double normal[3];         /**< world, unit, along which the load is measured */
  double load_n;            /**< of the spring */
  double stiffness_n_per_m; /**< of the spring */
  uint32_t point;           /**< its number among the object's points */
  uint32_t state;           /**< fdcg_state, on what it touches */
  uint32_t feature;         /**< on what it touches */
  uint32_t slipping;        /**< 1: it moves at the limit of its friction */
  uint32_t softened;        /**< 1: the step bears no more stiffness here than this (fdcg_pile_get_substeps) */
  uint32_t reserved;        /**< 0 */
} fdcg_pile_touch;

/** Copies at most `capacity` touches, by object and point, and returns how many there are. Cost: the points. */
FDCG_API uint32_t fdcg_pile_get_touches(const fdcg_pile* pile, fdcg_pile_touch* touches, uint32_t capacity);

/** What happened since the pile was made. */
typedef struct fdcg_pile_counts {
  uint64_t overflowed_contacts; /**< points that met something while touch_capacity was used up, and were not felt */
  uint64_t broadphase_updates;  /**< measurements from a body to all objects */
  uint64_t steps;               /**< steps of touches */
  uint64_t softened_steps;      /**< those of them with less stiffness than was asked for */
} fdcg_pile_counts;
/** Reads the counts. */
FDCG_API fdcg_pile_counts fdcg_pile_get_counts(const fdcg_pile* pile);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_PILE_H */
