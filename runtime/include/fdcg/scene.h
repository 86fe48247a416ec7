/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/scene.h
 * A scene: objects with poses, and fingers that feel all of them. On one screen:
 *
 *     fdcg_scene_config config = fdcg_make_scene_config();                how many objects and fingers at most
 *     void* memory = malloc(fdcg_scene_bytes(&config));                   or a static array: the scene never asks for more
 *     fdcg_scene_create(memory, bytes, &config, &scene, &error);
 *     fdcg_scene_add_object(scene, &graph, &params, &pose, &object, &error);
 *     fdcg_scene_add_finger(scene, hip_world_m, &finger, &error);
 *     each tick:
 *       fdcg_scene_set_pose(scene, object, &pose, &error);                where something moves it
 *       fdcg_scene_move_finger(scene, finger, hip_world_m, &error);
 *       fdcg_scene_step(scene);
 *       fdcg_scene_get_result(scene, finger, &result, &error);            ->  result.force_n, in the world
 *
 * An object is a graph (any number of objects may share one), a surface (surface.h) or a deformable mesh (deform.h), with
 * parameters and a pose: rotation, translation, uniform scale. A finger is one contact point. It has a contact (fdcg_contact)
 * with each object that it touches, in that object's frame, so a moving and turning object carries its god-objects.
 *
 * What is swept each tick is the relative motion: from where the HIP was in the object's frame at the last tick, with the
 * object's pose of that tick, straight to where it is now. So an object that moves onto a still finger is met as surely as the
 * other way round. In a turn of w radians a tick the straight path cuts the arc by a share of 1 - cos(w / 2) of its radius:
 * 0.03 % at 10 revolutions a second and 1 kHz. An object whose bounding sphere the finger does not reach, measured from the
 * moving centre of the sphere, is not met, however fast it spins.
 *
 * **Frames, units, handedness.** The world and the objects' frames are right-handed. Lengths are metres, forces newtons on the
 * hand, torques newton metres. At a scale of s the god-object's distance in the world is s times the one in the object;
 * stiffness and damping act on the distance in the world; friction does not depend on scale, and speeds of its curve are those
 * in the world.
 *
 * **Ownership.** The scene lives in the caller's memory. Graphs' views, params with their tables of materials, poses and
 * surfaces are copied in, and may go or move; the bytes that a graph views, and deformable meshes, must outlive the scene.
 *
 * **Cost.** A free finger out of reach of every object costs a comparison (some 10 ns), however many objects there are. When
 * its own motion and the objects' largest together have used up the distance that it last measured, it measures again to all of
 * them (2 to 3 ns each: 2.5 us for 1,000). An object that it may have met costs a fdcg_step and two changes of frame; so a
 * finger's step is at most one such measurement and touches_per_finger steps. Memory: 0.2 KB a finger and, for each of
 * touches_per_finger, 0.3 KB; 0.9 KB an object. Nothing allocates, locks, recurses or reads a clock; every loop is bounded by
 * the capacities in the config.
 *
 * **Threads.** The scene holds no lock. fdcg_scene_step is fdcg_scene_advance, then fdcg_scene_step_finger for every finger.
 * After an advance, different fingers may be stepped, moved and asked for results by different threads at once, and at the same
 * time one thread may set poses, which the next advance takes in. For everything else one thread at a time is in the scene.
 * Results do not depend on the order of fingers or on threads. Fingers of a scene with a deformable mesh are stepped by one
 * thread at a time: a step on such a mesh brings it up to date.
 */
#ifndef FDCG_SCENE_H
#define FDCG_SCENE_H

#include "fdcg/fdcg.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A scene, in memory of the caller's. Copied as a whole, to another multiple of 8, it is an independent snapshot, in which the
 * same ids name the same objects and fingers. There is nothing to destroy. */
typedef struct fdcg_scene fdcg_scene;

/** Names an object by value; all zeros name none. What was removed is not found again under its old name, and ids of another
 * scene name nothing: their numbers begin elsewhere. */
typedef struct fdcg_object_id {
  uint32_t index;      /**< its place; fdcg_reaction arrays are by it */
  uint32_t generation; /**< one more for each time that the place was used, from a number that differs from scene to scene */
} fdcg_object_id;
/** Names a finger by value, likewise. */
typedef struct fdcg_finger_id {
  uint32_t index;      /**< its place */
  uint32_t generation; /**< likewise */
} fdcg_finger_id;

/** Where an object is: world = R (scale * object) + translation, and back: object = (R^T (world - translation)) / scale, where
 * R is the rotation matrix of the quaternion; the three products of a row are added from the first to the third. So a contact
 * stepped by hand with fdcg_step gives the scene's bits. */
typedef struct fdcg_pose {
  double rotation_xyzw[4]; /**< unit quaternion, real part last; within 1e-3 of unit length, made exactly unit by the scene */
  double translation_m[3]; /**< up to 1e12 */
  double scale;            /**< 1e-9 to 1e9 */
} fdcg_pose;

/** A pose of no rotation, no translation, scale 1. */
FDCG_API fdcg_pose fdcg_make_identity_pose(void);

/** What a scene does not do where it cannot matter. Each can be switched off in the config: every force stays the same, bit
 * for bit, and the difference in time is what it saves. */
typedef enum fdcg_scene_optimization {
  FDCG_OPT_OUT_OF_REACH = 1, /**< no object is measured to until one could be reached */
  FDCG_OPT_FAR_OBJECTS = 2,  /**< in between only nearby objects are tested, others by their bounding sphere only */
  FDCG_OPT_STILL = 4,        /**< an object that was not moved: no new rotation matrix, centre, inverse */
  FDCG_OPT_ROTATION = 8,     /**< an object that is not turned or scaled: no rotation, no division */
  FDCG_OPT_RENEWAL = 16,     /**< a near object's free contact is kept from tick to tick, not made anew */
  FDCG_OPT_ALL = 31          /**< every one */
} fdcg_scene_optimization;

/** What a scene has room for. */
typedef struct fdcg_scene_config {
  uint32_t struct_bytes;           /**< the caller's sizeof(fdcg_scene_config); fdcg_make_scene_config sets it */
  uint32_t object_capacity;        /**< 1 to 1,000,000 */
  uint32_t finger_capacity;        /**< 1 to 10,000,000 */
  uint32_t touches_per_finger;     /**< 1 to 32: objects that one finger can touch, or have within its reach, at once */
  uint32_t disabled_optimizations; /**< fdcg_scene_optimization bits that are off; 0: all are on */
  uint32_t has_soft_fingers;       /**< 1: room for fingers that resist being turned (soft_finger.h), 0.1 KB a touch; else 0 */
  uint32_t has_deforms;       /**< 1: room for objects that are deformable meshes (deform.h), some 24 bytes a touch; else 0 */
  uint32_t material_capacity; /**< rows of fdcg_params.materials, of all objects together, 24 bytes each; 0: 64 */
} fdcg_scene_config;

/** Sets the first `struct_bytes` bytes of *config: 64 objects, 8 fingers, 4 touches a finger, every optimization on; some 69
 * KB. */
FDCG_API void fdcg_scene_config_init(fdcg_scene_config* config, uint32_t struct_bytes);
/** The default config of fdcg_scene_config_init. */
FDCG_INLINE fdcg_scene_config fdcg_make_scene_config(void) {
  fdcg_scene_config config;
  fdcg_scene_config_init(&config, (uint32_t)sizeof config);
  return config;
}

/** The bytes that fdcg_scene_create needs; 0 if the config is out of range (fdcg_scene_create says why). */
FDCG_API uint64_t fdcg_scene_bytes(const fdcg_scene_config* config);

/** Makes an empty scene at `memory`, a multiple of 8. `error` may be NULL, here and below. */
FDCG_API fdcg_status fdcg_scene_create(void* memory, uint64_t bytes, const fdcg_scene_config* config, fdcg_scene** scene,
                                       fdcg_error* error);

/* ---- objects ----------------------------------------------------------------------------------------------------------- */

/** Adds an object, a graph at a pose. A finger that is inside the object when it is added passes out of it freely. Cost: the
 * graph's header. */
FDCG_API fdcg_status fdcg_scene_add_object(fdcg_scene* scene, const fdcg_graph* graph, const fdcg_params* params,
                                           const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error);
/** Removes an object: every finger lets go of it. Cost: the fingers. */
FDCG_API fdcg_status fdcg_scene_remove_object(fdcg_scene* scene, fdcg_object_id object, fdcg_error* error);

/** Moves an object, from the next advance on: the tick between sweeps from the old pose to the new one. FDCG_E_ARGUMENT, and
 * the old pose stays, unless every number is in range. */
FDCG_API fdcg_status fdcg_scene_set_pose(fdcg_scene* scene, fdcg_object_id object, const fdcg_pose* pose, fdcg_error* error);
/** Changes an object's parameters, from the next step on. FDCG_E_ARGUMENT, and the old ones stay, unless fdcg_check_params
 * takes them. */
FDCG_API fdcg_status fdcg_scene_set_params(fdcg_scene* scene, fdcg_object_id object, const fdcg_params* params,
                                           fdcg_error* error);

/** Gives an object another graph, a mesh compiled anew: fingers that touch go on at the nearest place of it, with the friction
 * that they had; others start anew. The graph before may be closed then. FDCG_E_ARGUMENT for surfaces and deformable meshes.
 * Cost: the fingers, and a search (query.h) for each that touches; not for the servo thread. */
FDCG_API fdcg_status fdcg_scene_replace_graph(fdcg_scene* scene, fdcg_object_id object, const fdcg_graph* graph,
                                              fdcg_error* error);

/** Switches an object off (0) or on. A disabled object is not felt; enabled again it is as if just added, where its pose is. */
FDCG_API fdcg_status fdcg_scene_enable_object(fdcg_scene* scene, fdcg_object_id object, int is_enabled, fdcg_error* error);

/* ---- fingers ----------------------------------------------------------------------------------------------------------- */

/** Adds a finger. It begins, free, where it is when it is stepped for the first time: nothing on the way there is met. From
 * then on its motion is swept. */
FDCG_API fdcg_status fdcg_scene_add_finger(fdcg_scene* scene, const double hip_world_m[3], fdcg_finger_id* finger,
                                           fdcg_error* error);
/** Removes a finger. */
FDCG_API fdcg_status fdcg_scene_remove_finger(fdcg_scene* scene, fdcg_finger_id finger, fdcg_error* error);

/** Says where a finger's HIP is in the next step. Not moved, it stays. Any number is taken: one that is not finite or beyond
 * 1e100 is found by the step, which then leaves the HIP where it was, gives no force and counts it. */
FDCG_API fdcg_status fdcg_scene_move_finger(fdcg_scene* scene, fdcg_finger_id finger, const double hip_world_m[3],
                                            fdcg_error* error);

/** Says what a finger is made of, combined with what it touches (fdcg_combine_materials); NULL: nothing of its own. From the
 * next step on. FDCG_E_ARGUMENT, and the old one stays, unless 0 <= mu_dynamic <= mu_static and the stiffness is above 0. A
 * library built without FDCG_WITH_FRICTION_TERMS does it too: faces have no materials of their own there, and the object's are
 * combined. */
FDCG_API fdcg_status fdcg_scene_set_finger_material(fdcg_scene* scene, fdcg_finger_id finger, const fdcg_material* material,
                                                    fdcg_error* error);

/** Lets go of everything and starts anew at a place, as if just added: nothing on the way there is met. */
FDCG_API fdcg_status fdcg_scene_reset_finger(fdcg_scene* scene, fdcg_finger_id finger, const double hip_world_m[3],
                                             fdcg_error* error);

/* ---- step -------------------------------------------------------------------------------------------------------------- */

/** A tick: takes in the poses that were set, steps every finger. */
FDCG_API void fdcg_scene_step(fdcg_scene* scene);

/** First half of fdcg_scene_step, for fingers on threads of their own: begins a tick and takes in the poses that were set. */
FDCG_API void fdcg_scene_advance(fdcg_scene* scene);
/** Second half, for one finger. It may be stepped several times in a tick (a device faster than the objects) but should be at
 * least once: of a tick that it missed it does not see the motion of objects that it did not touch, and
 * FDCG_FINGER_MISSED_TICK is set. */
FDCG_API fdcg_status fdcg_scene_step_finger(fdcg_scene* scene, fdcg_finger_id finger, fdcg_error* error);

/** What was special about a finger's step. */
typedef enum fdcg_finger_flag {
  FDCG_FINGER_NON_FINITE = 1,       /**< the HIP was no usable number: it stood still, no force */
  FDCG_FINGER_CONTACT_OVERFLOW = 2, /**< more objects in reach than touches_per_finger: touched and nearest ones felt */
  FDCG_FINGER_MISSED_TICK = 4,      /**< it was not stepped in the tick before */
  FDCG_FINGER_BOUNDED = 8           /**< some contact carries work over to the next tick: see fdcg_touch.flags */
} fdcg_finger_flag;

/** One object that a finger touches. */
typedef struct fdcg_touch {
  fdcg_object_id object;  /**< what is touched */
  double force_n[3];      /**< world, on the finger */
  double god_object_m[3]; /**< world */
  uint32_t state;         /**< fdcg_state; FDCG_FREE only while a sweep is carried over */
  uint32_t feature;       /**< of the object's graph or surface, by state */
  uint32_t slipping;      /**< 1: dynamic friction holds */
  uint32_t transitions;   /**< changes of state in this step */
  uint32_t flags;         /**< fdcg_result_flag */
  uint32_t reserved;      /**< 0 */
} fdcg_touch;

/** What a finger felt in its last step. */
typedef struct fdcg_finger_result {
  double force_n[3];           /**< world, on the user's hand: the touches' sum in their order */
  uint32_t flags;              /**< fdcg_finger_flag, of the last step */
  uint32_t touch_count;        /**< entries of `touches` */
  const fdcg_touch* touches;   /**< ascending object index; in the scene's memory, good until the finger's next step */
  uint64_t non_finite_steps;   /**< since the finger was added */
  uint64_t overflowed_steps;   /**< steps with FDCG_FINGER_CONTACT_OVERFLOW */
  uint64_t missed_ticks;       /**< ticks without a step */
  uint64_t broadphase_updates; /**< measurements to all objects: what FDCG_OPT_OUT_OF_REACH keeps few */
} fdcg_finger_result;

/** Reads what a finger felt in its last step. */
FDCG_API fdcg_status fdcg_scene_get_result(const fdcg_scene* scene, fdcg_finger_id finger, fdcg_finger_result* result,
                                           fdcg_error* error);

/** What the fingers do to an object. */
typedef struct fdcg_reaction {
  double force_n[3];    /**< world, on the object */
  double torque_n_m[3]; /**< world, about the origin of the object's frame */
} fdcg_reaction;
/** What the fingers do to the objects. Zeroes `reactions` and adds the fingers' last results up, in ascending order. `count`
 * entries by object index; objects beyond are left out. Cost: the fingers. */
FDCG_API void fdcg_scene_get_reactions(const fdcg_scene* scene, fdcg_reaction* reactions, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_SCENE_H */
