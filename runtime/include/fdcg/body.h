/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/body.h
 * Rigid bodies: what the fingers of a scene lift, turn and let fall. On one screen:
 *
 *     fdcg_body_config config = fdcg_make_body_config();             gravity along -z, no damping
 *     fdcg_get_mass(&graph, &mass, &error);
 *     fdcg_body_set_mass(&config, &mass, 0, pose.scale, &error);     what the file says it weighs, or a density of yours
 *     fdcg_body_init(&bodies[0].body, &config, &pose, &error);
 *     bodies[0].object = object;                                     the scene's, with the same graph and pose
 *     each tick:
 *       fdcg_scene_move_finger(scene, finger, hip_world_m, &error);
 *       fdcg_scene_step_bodies(scene, bodies, 1, substeps, 0.001, reactions, reaction_count, &error);
 *
 * or, with forces from elsewhere, fdcg_body_step(&body, force_n, torque_n_m, dt_s) alone.
 *
 * **The integrator.** Forces are taken where the body is at the start of a step, half of them before the motion and half after
 * it (velocity Verlet). The free turn in between is the implicit midpoint rule with a Cayley update of the attitude: it keeps
 * the energy and the angular momentum of a free body of any shape to rounding. Second order in dt, also with forces that depend
 * on the place; gravity alone is followed exactly. Undamped springs keep their energy in bounds while
 * dt * sqrt(stiffness * (1 / mass + reach^2 / least inertia)) is below 2, and run away above: see fdcg_body_get_substeps.
 *
 * **Frames, units, handedness.** SI units. The world and the object's frame are right-handed; each field says which it is in.
 * Tensors of inertia are xx, yy, zz, xy, xz, yz, where xy is minus the integral of x y over the mass.
 *
 * **Ownership.** A body is a plain struct: copy it and it is a snapshot. Arrays are the caller's and are not kept.
 *
 * **Threads.** One thread at a time steps a body; fdcg_scene_step_bodies is in its scene alone. Nothing here allocates, locks
 * or reads a clock; every loop has a fixed bound.
 */
#ifndef FDCG_BODY_H
#define FDCG_BODY_H

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_BODY_MAX_SUBSTEPS 64u /**< substeps of one tick, at most */

/** What a body weighs, and what acts on it. */
typedef struct fdcg_body_config {
  uint32_t struct_bytes;        /**< the caller's sizeof(fdcg_body_config); fdcg_make_body_config sets it */
  uint32_t reserved;            /**< 0 */
  double mass_kg;               /**< > 0 */
  double centre_m[3];           /**< of mass, in the object's frame, before the pose's scale */
  double inertia_kg_m2[6];      /**< tensor about it, axes of the object's frame: xx, yy, zz, xy, xz, yz */
  double gravity_m_per_s2[3];   /**< world */
  double linear_damping_per_s;  /**< share of the velocity lost in a second, for short times; 0: none */
  double angular_damping_per_s; /**< of the angular momentum */
  double sleep_after_s;         /**< asleep after so long below the next two speeds, with gravity balanced; 0: never */
  double sleep_speed_m_per_s;   /**< of the centre of mass */
  double sleep_turn_rad_per_s;  /**< of the body */
  double wake_m_per_s2; /**< a change of force, as an acceleration, that wakes it; torques by the same measure over the body's
                           radius of gyration */
} fdcg_body_config;

/** Sets the first `struct_bytes` bytes of *config: 1 kg, a ball's inertia of radius 0.1 m, gravity -9.80665 along z, no
 * damping, asleep after 0.5 s below 1e-5 m/s and 1e-4 rad/s, awake at 1e-3 m/s^2. */
FDCG_API void fdcg_body_config_init(fdcg_body_config* config, uint32_t struct_bytes);
/** The default config of fdcg_body_config_init. */
FDCG_INLINE fdcg_body_config fdcg_make_body_config(void) {
  fdcg_body_config config;
  fdcg_body_config_init(&config, (uint32_t)sizeof config);
  return config;
}

/** Fills in mass, centre and inertia of a graph's solid at a density, or at the file's own where density_kg_per_m3 is 0; for an
 * object of this scale in the scene. FDCG_E_ARGUMENT, and *config stays, where neither says what it weighs, or where what comes
 * of it is none that fdcg_body_init takes. */
FDCG_API fdcg_status fdcg_body_set_mass(fdcg_body_config* config, const fdcg_mass* mass, double density_kg_per_m3, double scale,
                                        fdcg_error* error);

/** A body and its motion. Read the fields; set them through the functions. All zero is no body. */
typedef struct fdcg_body {
  fdcg_body_config config;         /**< as given to fdcg_body_init */
  double rotation_xyzw[4];         /**< world, unit, real part last */
  double centre_m[3];              /**< of mass, world */
  double velocity_m_per_s[3];      /**< of the centre of mass, world */
  double angular_momentum[3];      /**< kg m^2/s about the centre of mass, world: of a free body the same bits for ever */
  double spin_rad_per_s[3];        /**< angular velocity in the middle of the last step, axes of the object */
  double predicted_impulse_n_s[3]; /**< impulse that the last step applied in advance, assuming constant forces */
  double given_n_m_s[3];           /**< the same of torque */
  double rest_force_n[3];          /**< under which it fell asleep */
  double rest_torque_n_m[3];       /**< likewise */
  double push_n[3];                /**< of fdcg_body_set_push: a force at the centre of mass, world */
  double push_n_m[3];              /**< likewise a torque */
  double quiet_s;                  /**< how long it has been slow enough to sleep */
  double scale;                    /**< of the pose */
  uint32_t is_asleep;              /**< 1: it is not stepped until the force on it changes */
  uint32_t has_given;              /**< the two impulses above are those of the step before */
  uint64_t refused_steps;          /**< force, torque or time was no usable number: nothing moved */
  uint64_t unsolved_steps;         /**< it turned too fast for the bounded number of iterations: momentum kept, energy not */
} fdcg_body;

/** Makes a body at rest at a pose, awake. FDCG_E_ARGUMENT unless every number is in range and the inertia is a solid's. `error`
 * may be NULL.
 */
FDCG_API fdcg_status fdcg_body_init(fdcg_body* body, const fdcg_body_config* config, const fdcg_pose* pose, fdcg_error* error);

/** Sets it in motion: velocity of the centre of mass and angular velocity, world. Wakes it. FDCG_E_ARGUMENT where they are not
 * finite or beyond 1e6. */
FDCG_API fdcg_status fdcg_body_set_motion(fdcg_body* body, const double velocity_m_per_s[3], const double angular_rad_per_s[3],
                                          fdcg_error* error);

/** Lets a force at the centre of mass and a torque act on it, world, in every tick of a scene or a pile until they are set
 * anew; beside gravity, fingers and touches. Zero to begin with. A change wakes it as any other change of force does.
 * FDCG_E_ARGUMENT where they are not finite or beyond 1e12. fdcg_body_step alone takes no notice of them. */
FDCG_API fdcg_status fdcg_body_set_push(fdcg_body* body, const double force_n[3], const double torque_n_m[3],
                                        fdcg_error* error);

/** Moves it on by dt_s (1e-9 to 1) under a force and a torque about the centre of mass, world, gravity beside them. Some 0.2 us
 * where it turns by less than half a radian a step; at most 64 times that. Asleep: a comparison, unless the force has changed.
 */
FDCG_API void fdcg_body_step(fdcg_body* body, const double force_n[3], const double torque_n_m[3], double dt_s);

/** The pose of its object: for fdcg_scene_set_pose. */
FDCG_API fdcg_pose fdcg_body_get_pose(const fdcg_body* body);

/** Its angular velocity now, world. */
FDCG_API void fdcg_body_get_angular_velocity(const fdcg_body* body, double angular_rad_per_s[3]);

/** Its kinetic energy, of motion and turn together. */
FDCG_API double fdcg_body_get_kinetic_energy_j(const fdcg_body* body);

/** How many steps a tick of tick_s takes so that springs of this stiffness in all, at points no farther than reach_m from the
 * centre of mass, stay at half of the bound above: 1 to FDCG_BODY_MAX_SUBSTEPS; 0 where more would be needed. */
FDCG_API uint32_t fdcg_body_get_substeps(const fdcg_body* body, double stiffness_n_per_m, double reach_m, double tick_s);

/* ---- bodies in a scene ------------------------------------------------------------------------------------------------- */

/** A body of a scene. */
typedef struct fdcg_scene_body {
  fdcg_object_id object; /**< of the scene, with the body's graph and pose */
  fdcg_body body;        /**< its motion */
} fdcg_scene_body;

/** A tick of the scene and its bodies: `substeps` times (1 to FDCG_BODY_MAX_SUBSTEPS) a fdcg_scene_step, the reactions to the
 * fingers' forces, each body moved on by tick_s / substeps, its pose handed to the scene. `reactions`: room for one entry by
 * object index, of at least the largest index among the bodies and one; zeroed or left half done where the call fails. No
 * object is that of two bodies, and each stands where its body does: FDCG_E_ARGUMENT where the caller has set another pose for
 * it, or has moved the body by fdcg_body_step. tick_s / substeps: 1e-9 to 1. A finger goes an equal part of its way in each
 * substep; its result is that of the last one. Stops with the
 * scene's own status where a pose is refused: a body that flew beyond 1e12 m, or an object removed. */
FDCG_API fdcg_status fdcg_scene_step_bodies(fdcg_scene* scene, fdcg_scene_body* bodies, uint32_t body_count, uint32_t substeps,
                                            double tick_s, fdcg_reaction* reactions, uint32_t reaction_count,
                                            fdcg_error* error);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_BODY_H */
