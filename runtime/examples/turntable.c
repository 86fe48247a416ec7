/* SPDX-License-Identifier: Apache-2.0 */
/* A scene: a still finger on a cube that turns like a turntable carries the god-object round until friction gives way; then a
 * second cube, on the same graph, drives into the finger. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fdcg/scene.h"

static void check(fdcg_status status, const fdcg_error* error) {
  if (status == FDCG_OK) return;
  fprintf(stderr, "%s\n", error->message);
  exit(1);
}

int main(void) {
  static uint64_t memory[16 * 1024]; /* the scene's, 128 KB: it never asks for more */
  const double hip_m[3] = {0.006, 0.004, 0.009};
  fdcg_graph cube;
  fdcg_error error;
  fdcg_scene* scene;
  fdcg_object_id table, block;
  fdcg_finger_id finger;
  const fdcg_scene_config config = fdcg_make_scene_config();
  const fdcg_params params = fdcg_make_params();
  fdcg_pose table_pose = fdcg_make_identity_pose(), block_pose = fdcg_make_identity_pose();
  table_pose.translation_m[2] = -0.002; /* it is a centimetre high: its top begins 1 mm below the finger */
  block_pose.translation_m[0] = 0.020;

  check(fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &cube, &error), &error);
  check(fdcg_scene_create(memory, sizeof memory, &config, &scene, &error), &error);
  check(fdcg_scene_add_object(scene, &cube, &params, &table_pose, &table, &error), &error);
  check(fdcg_scene_add_object(scene, &cube, &params, &block_pose, &block, &error), &error);
  check(fdcg_scene_add_finger(scene, hip_m, &finger, &error), &error);

  for (int tick = 0; tick < 8; ++tick) {
    fdcg_finger_result felt;
    const double angle = tick < 2 ? 0 : 0.05 * (tick < 6 ? tick - 1 : 4);
    table_pose.translation_m[2] = tick < 1 ? -0.002 : 0; /* it rises to 1 mm above the finger */
    table_pose.rotation_xyzw[2] = sin(angle / 2);        /* then turns about its corner at the origin */
    table_pose.rotation_xyzw[3] = cos(angle / 2);
    if (tick > 5) block_pose.translation_m[0] -= 0.0075;
    check(fdcg_scene_set_pose(scene, table, &table_pose, &error), &error);
    check(fdcg_scene_set_pose(scene, block, &block_pose, &error), &error);
    fdcg_scene_step(scene);
    check(fdcg_scene_get_result(scene, finger, &felt, &error), &error);
    printf("tick %d: touches %u, force %.3f %.3f %.3f N\n", tick, felt.touch_count, felt.force_n[0], felt.force_n[1],
           felt.force_n[2]);
  }
  fdcg_close(&cube);
  return 0;
}
