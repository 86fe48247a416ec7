/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/scene_state.h
 * The state of a scene as bytes: to go back to a moment, to carry on in another process or on another machine. On one screen:
 *
 *     uint64_t bytes = fdcg_scene_state_bytes(scene);                   between ticks; grows with what is touched
 *     void* state = malloc(bytes);
 *     fdcg_scene_save(scene, state, bytes, &error);
 *     ...
 *     fdcg_scene_restore(scene, state, bytes, &error);                  this scene, or another with the same objects
 *
 * From then on every tick gives the same bits as it would have given then. The state holds objects' poses, parameters with
 * their materials, what is switched off, fingers with their contacts, and all ids. It does not hold the graphs' bytes: the
 * scene that it is restored to must have, in the same places (fdcg_object_id.index), objects with the same graphs and surfaces.
 * Whoever adds and removes objects in the same order gets the same places. Fingers need not be there: those of the state come
 * back, others go.
 *
 * Bodies and piles (body.h, pile.h) are the caller's structs and are copied as such. A scene with a deformable mesh is refused,
 * since the mesh has its state in memory of its own; it goes back by copies of both memories, each to its own place.
 *
 * The bytes are little-endian and the same on every platform: docs/internals/scene-state.md says what stands where. They may
 * come from anywhere: those of another version, cut short, changed or of other objects are refused with the reason, and the
 * scene stays as it was. Bytes that are forged, with a checksum that fits, may put contacts where no hand has been, but lead to
 * no undefined behaviour.
 *
 * **Units, frames** as in scene.h; contacts in their graphs' local frames. **Threads.** Saving reads the scene, restoring
 * writes it: nothing else is in it meanwhile. **Ownership.** Nothing is kept of what is passed in. **Cost.** Linear in objects,
 * fingers and touches; nothing allocates.
 */
#ifndef FDCG_SCENE_STATE_H
#define FDCG_SCENE_STATE_H

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The bytes that fdcg_scene_save needs now; 0 for NULL. */
FDCG_API uint64_t fdcg_scene_state_bytes(const fdcg_scene* scene);

/** Writes the state of a scene to `state`, a multiple of 8, which has room for `bytes` bytes; fdcg_scene_state_bytes of them
 * are written. FDCG_E_ARGUMENT, and nothing is written, where they do not suffice or an object is a deformable mesh;
 * FDCG_E_ALIGNMENT. Call it between ticks. `error` may be NULL, here and below. */
FDCG_API fdcg_status fdcg_scene_save(const fdcg_scene* scene, void* state, uint64_t bytes, fdcg_error* error);

/** Puts a scene into a state, `bytes` bytes at `state`, a multiple of 8. Before anything is changed all of it is checked:
 * FDCG_E_MAGIC, FDCG_E_VERSION, FDCG_E_TRUNCATED, FDCG_E_CHECKSUM for the bytes; FDCG_E_ARGUMENT for a scene with other objects
 * or too little room; FDCG_E_GRAPH for an index or a number out of range. */
FDCG_API fdcg_status fdcg_scene_restore(fdcg_scene* scene, const void* state, uint64_t bytes, fdcg_error* error);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_SCENE_STATE_H */
