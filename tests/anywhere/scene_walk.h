/* SPDX-License-Identifier: Apache-2.0 */
/* Part of step_hash.c: every graph as an object of one scene, turning, wandering and growing, and fingers among them. Only the
 * four operations and the scene's own square roots, so that the way itself is the same everywhere. */
#ifndef FDCG_TEST_SCENE_WALK_H
#define FDCG_TEST_SCENE_WALK_H

enum { kSceneTicks = 3000, kSceneObjects = 16, kSceneFingers = 3, kSceneBytes = 32768 };

static uint64_t scene_memory[kSceneBytes / 8];

/* Every object is about one unit large and wanders about the origin; a turn is a quaternion made nearly unit by hand. */
static void pose_at(const fdcg_graph* graph, uint32_t object, int32_t tick, uint64_t* random, fdcg_pose* pose) {
  const fdcg_header* header = graph->header;
  double size = 0, turn[4], length2 = 0;
  for (int k = 0; k < 3; ++k)
    size += (header->bounds_max[k] - header->bounds_min[k]) * header->metres_per_unit;
  if (tick % 200 == 0) pose->scale = (0.5 + uniform(random)) / size;
  for (int k = 0; k < 3; ++k) {
    const double centre = (header->bounds_min[k] + header->bounds_max[k]) * 0.5 + header->origin[k];
    const double wander = tick % 400 < 200 ? tick % 200 * 0.005 - 0.5 : 0.5 - tick % 200 * 0.005;
    pose->translation_m[k] =
        (k == (int)(object % 3) ? wander : 0.1 * object - 0.4) - centre * header->metres_per_unit * pose->scale;
  }
  for (int k = 0; k < 4; ++k) { /* turns on by a little; one step of Newton's keeps its length */
    turn[k] = pose->rotation_xyzw[k] + (object % 4 == 0 ? 0 : 0.01 * (uniform(random) - 0.5));
    length2 += turn[k] * turn[k];
  }
  for (int k = 0; k < 4; ++k)
    pose->rotation_xyzw[k] = turn[k] * (1.5 - 0.5 * length2);
}

static int step_through_scene(const fdcg_graph* graphs_of_scene, uint32_t count, hash_t* hash) {
  fdcg_scene_config config = fdcg_make_scene_config();
  fdcg_scene* scene;
  fdcg_error error;
  fdcg_object_id objects[kSceneObjects];
  fdcg_finger_id fingers[kSceneFingers];
  fdcg_pose poses[kSceneObjects];
  double hip[kSceneFingers][3] = {{0.7, 0, 0}, {0, 0.6, 0.1}, {-0.5, 0, 0.7}};
  uint64_t random = 88172645463325252u;
  uint32_t touches = 0;
  fdcg_params params = fdcg_make_params();
  params.damping_n_s_per_m = 1;
  config.object_capacity = count;
  config.finger_capacity = kSceneFingers;
  if (fdcg_scene_create(scene_memory, sizeof scene_memory, &config, &scene, &error) != FDCG_OK) return 4;
  for (uint32_t i = 0; i < count; ++i) {
    poses[i] = fdcg_make_identity_pose();
    pose_at(&graphs_of_scene[i], i, 0, &random, &poses[i]);
    if (fdcg_scene_add_object(scene, &graphs_of_scene[i], &params, &poses[i], &objects[i], &error) != FDCG_OK) return 5;
  }
  for (int f = 0; f < kSceneFingers; ++f) {
    if (fdcg_scene_add_finger(scene, hip[f], &fingers[f], &error) != FDCG_OK) return 6;
  }
  for (int32_t tick = 0; tick < kSceneTicks; ++tick) {
    for (uint32_t i = 0; i < count; ++i) {
      pose_at(&graphs_of_scene[i], i, tick, &random, &poses[i]);
      if (fdcg_scene_set_pose(scene, objects[i], &poses[i], &error) != FDCG_OK) return 7;
    }
    for (int f = 0; f < kSceneFingers; ++f) {
      for (int k = 0; k < 3; ++k)
        hip[f][k] += (uniform(&random) - 0.5) * 0.05 - 0.01 * hip[f][k];
      fdcg_scene_move_finger(scene, fingers[f], hip[f], &error);
    }
    fdcg_scene_step(scene);
    for (int f = 0; f < kSceneFingers; ++f) {
      fdcg_finger_result felt;
      if (fdcg_scene_get_result(scene, fingers[f], &felt, &error) != FDCG_OK) return 8;
      for (int k = 0; k < 3; ++k)
        absorb_real(hash, felt.force_n[k]);
      absorb(hash, felt.touch_count | (uint64_t)felt.flags << 32);
      touches += felt.touch_count;
    }
  }
  return touches > kSceneTicks / 10 ? 0 : 9; /* else the hash says little */
}

#endif
