// SPDX-License-Identifier: Apache-2.0
// Shared by the ticks of bodies with fingers only (body_scene.cpp) and of piles (pile_step.cpp).
#pragma once

#include "body/body_math.hpp"

namespace fdcg {

// Checks the arguments of a tick. Overwrites the reactions.
fdcg_status check_bodies(const fdcg_scene* scene, const fdcg_scene_body* bodies, uint32_t body_count, uint32_t substeps,
                         double tick_s, fdcg_reaction* reactions, uint32_t reaction_count, fdcg_error* error);

// The scene's torque is about the origin of the object's frame, the body's about its centre of mass.
fdcg_reaction about_centre(const fdcg_body& body, const fdcg_reaction& reaction);

// Advances the body under a force and a torque about the centre of mass, and sets its new pose in the scene.
fdcg_status move_body(fdcg_scene* scene, fdcg_scene_body* body, const fdcg_reaction& push, double dt_s, fdcg_error* error);

// Ways of the fingers in a tick of several substeps: begin_ways, move_fingers before each substep (from 0), end_ways. A finger
// goes the same part of its way in each.
void begin_ways(fdcg_scene* scene);
void move_fingers(fdcg_scene* scene, uint32_t step, uint32_t substeps);
void end_ways(fdcg_scene* scene);

}  // namespace fdcg
