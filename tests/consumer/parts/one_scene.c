/* SPDX-License-Identifier: Apache-2.0 */
/* A graph that is part of the program, an object of a scene: a finger goes into it from above. Returns 0 if it feels something.
 */
#include "block.h"
#include "fdcg/scene.h"

int main(void) {
  static uint64_t memory[6 * 1024];
  fdcg_graph graph;
  fdcg_scene* scene;
  fdcg_object_id object;
  fdcg_finger_id finger;
  fdcg_finger_result felt;
  const fdcg_params params = fdcg_make_params();
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_scene_config config = fdcg_make_scene_config();
  double hip_m[3];
  int k;
  config.object_capacity = config.finger_capacity = 1;
  if (fdcg_open_trusted(block, sizeof block, &graph, NULL) != FDCG_OK) return 1;
  for (k = 0; k < 3; ++k)
    hip_m[k] = ((graph.header->bounds_min[k] + graph.header->bounds_max[k]) * 0.5 + graph.header->origin[k]) *
               graph.header->metres_per_unit;
  if (fdcg_scene_create(memory, sizeof memory, &config, &scene, NULL) != FDCG_OK) return 2;
  if (fdcg_scene_add_object(scene, &graph, &params, &pose, &object, NULL) != FDCG_OK) return 3;
  hip_m[2] += 10;
  if (fdcg_scene_add_finger(scene, hip_m, &finger, NULL) != FDCG_OK) return 4;
  fdcg_scene_step(scene);
  hip_m[2] -= 10;
  if (fdcg_scene_move_finger(scene, finger, hip_m, NULL) != FDCG_OK) return 5;
  fdcg_scene_step(scene);
  if (fdcg_scene_get_result(scene, finger, &felt, NULL) != FDCG_OK) return 6;
  return felt.touch_count == 1 && felt.force_n[2] > 0 ? 0 : 7;
}
