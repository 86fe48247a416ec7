/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/soft_finger.h
 * Soft fingers: touches that resist being turned about their normal. On one screen:
 *
 *     config.has_soft_fingers = 1;                                      before fdcg_scene_create: 0.1 KB more a touch
 *     fdcg_scene_set_finger_radius(scene, finger, 0.004, &error);       a touch like a pad of 4 mm radius
 *     each tick:
 *       fdcg_scene_move_finger(scene, finger, hip_world_m, &error);
 *       fdcg_scene_set_finger_rotation(scene, finger, rotation_xyzw, &error);   where the fingertip points
 *       fdcg_scene_step(scene);                                         or a tick of bodies (body.h, pile.h)
 *       fdcg_scene_get_finger_torque(scene, finger, torque_n_m, &error);        beside force_n
 *
 * A touch remembers how finger and object stood to each other when it began. When they are turned against each other about the
 * normal by an angle, a spring of stiffness_n_per_m * radius_m^2 resists with the torque T. T is limited together with the
 * tangential force F by the ellipsoid
 *
 *     (F / (mu N))^2 + (T / (mu N radius_m))^2 <= 1
 *
 * with the load N along the normal (Howe and Cutkosky 1996). Beyond it with mu_static both slip at once, each by the same
 * share, to the ellipsoid of mu_dynamic; they stick again as a god-object does (contact-model FRIC-1 to FRIC-5). What sticks
 * does not creep; a slip only takes energy from the springs. The angle is measured as 2 tan(angle / 2), of the turn's part
 * about the normal. Where the contact goes on to another feature the twist goes with it, about the new normal. On an edge or a
 * corner of a graph the normal is the spring's direction.
 *
 * The object gets the opposite torque (fdcg_scene_get_reactions). Friction is that of the object's mu_static and mu_dynamic.
 * For an object with friction flags (fdcg_friction_flag) the tangential force keeps its own limit, and the torque gets what
 * that leaves.
 *
 * **Cost.** A touch of a soft finger some 0.2 us more; other fingers a comparison a touch.
 *
 * **Frames, units, handedness.** SI units, the right-handed world; quaternions x, y, z, w. **Ownership and threads** as in
 * scene.h: nothing is kept of what is passed in, and fingers of different threads may be turned and asked at once.
 */
#ifndef FDCG_SOFT_FINGER_H
#define FDCG_SOFT_FINGER_H

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Gives a finger's touches a radius: 1e-9 to 1e3 m of the world; for a pad of pressure p over an area A it is the integral
 * p r dA / N, which is 2/3 of its radius where the pressure is even. The torque's limit for each newton of load is mu radius_m,
 * which `fdcg grasp` calls torsion; its --pad-radius is this radius. 0: a point again. FDCG_E_ARGUMENT where the scene has no
 * room for soft fingers. `error` may be NULL, here and below. */
FDCG_API fdcg_status fdcg_scene_set_finger_radius(fdcg_scene* scene, fdcg_finger_id finger, double radius_m, fdcg_error* error);

/** Says where a finger points in the next step: world, a unit quaternion within 1e-3, real part last. At first 0, 0, 0, 1.
 * Not called, it stays. It must turn by less than half a turn from tick to tick. */
FDCG_API fdcg_status fdcg_scene_set_finger_rotation(fdcg_scene* scene, fdcg_finger_id finger, const double rotation_xyzw[4],
                                                    fdcg_error* error);

/** Reads the torque on a finger, world: the sum over its touches in the last step. Zero for a finger that is not soft. */
FDCG_API fdcg_status fdcg_scene_get_finger_torque(const fdcg_scene* scene, fdcg_finger_id finger, double torque_n_m[3],
                                                  fdcg_error* error);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_SOFT_FINGER_H */
