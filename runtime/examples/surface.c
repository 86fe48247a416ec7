/* SPDX-License-Identifier: Apache-2.0 */
/* A ball without a mesh: a finger comes down on it beside its top, sticks, and slides down its side. */
#include <stdio.h>
#include <stdlib.h>

#include "fdcg/surface.h"

static void check(fdcg_status status, const fdcg_error* error) {
  if (status == FDCG_OK) return;
  fprintf(stderr, "%s\n", error->message);
  exit(1);
}

int main(void) {
  static uint64_t memory[16 * 1024];
  const fdcg_scene_config config = fdcg_make_scene_config();
  const fdcg_params params = fdcg_make_params();
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_scene* scene;
  fdcg_object_id object;
  fdcg_finger_id finger;
  fdcg_error error;
  double hip_m[3] = {0, 0, 0.032};

  check(fdcg_scene_create(memory, sizeof memory, &config, &scene, &error), &error);
  fdcg_surface ball = fdcg_make_sphere(0.03);
  check(fdcg_check_surface(&ball, &error), &error);
  check(fdcg_scene_add_surface(scene, &ball, &params, &pose, &object, &error), &error);
  check(fdcg_scene_add_finger(scene, hip_m, &finger, &error), &error);

  for (int tick = 0; tick < 6; ++tick) {
    fdcg_finger_result felt;
    check(fdcg_scene_move_finger(scene, finger, hip_m, &error), &error);
    fdcg_scene_step(scene);
    check(fdcg_scene_get_result(scene, finger, &felt, &error), &error);
    printf("tick %d: touches %u, force %.3f %.3f %.3f N\n", tick, felt.touch_count, felt.force_n[0], felt.force_n[1],
           felt.force_n[2]);
    hip_m[0] += 0.0005;
    hip_m[2] = 0.0285;
  }
  return 0;
}
