/* SPDX-License-Identifier: Apache-2.0 */
/* A cube of 1 cm falls onto the ground and comes to rest; then a finger pushes it along. */
#include <stdio.h>
#include <stdlib.h>

#include "fdcg/pile.h"

static void check(fdcg_status status, const fdcg_error* error) {
  if (status == FDCG_OK) return;
  fprintf(stderr, "%s\n", error->message);
  exit(1);
}

int main(void) {
  static uint64_t scene_memory[16 * 1024], pile_memory[16 * 1024];
  const fdcg_scene_config scene_config = fdcg_make_scene_config();
  const fdcg_pile_config pile_config = fdcg_make_pile_config();
  const fdcg_params params = fdcg_make_params();
  const double up[3] = {0, 0, 1};
  fdcg_graph cube;
  fdcg_scene* scene;
  fdcg_pile* pile;
  fdcg_finger_id finger;
  fdcg_scene_body bodies[1];
  fdcg_reaction reactions[1];
  fdcg_mass mass;
  fdcg_error error;
  fdcg_body_config config = fdcg_make_body_config();
  fdcg_pose pose = fdcg_make_identity_pose();
  double points[20][3], hip_m[3] = {-0.005, 0.005, 0.005};
  uint32_t count;
  pose.translation_m[2] = 0.01;

  check(fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &cube, &error), &error);
  check(fdcg_scene_create(scene_memory, sizeof scene_memory, &scene_config, &scene, &error), &error);
  check(fdcg_scene_add_object(scene, &cube, &params, &pose, &bodies[0].object, &error), &error);
  check(fdcg_scene_add_finger(scene, hip_m, &finger, &error), &error);

  check(fdcg_get_mass(&cube, &mass, &error), &error);
  check(fdcg_body_set_mass(&config, &mass, 7850, pose.scale, &error), &error); /* steel; 0: the density in the file */
  check(fdcg_body_init(&bodies[0].body, &config, &pose, &error), &error);

  check(fdcg_pile_create(pile_memory, sizeof pile_memory, &pile_config, &pile, &error), &error);
  check(fdcg_pile_set_ground(pile, up, 0, &params, &error), &error);
  check(fdcg_pick_points(&cube, points, 20, &count, &error), &error);
  check(fdcg_pile_add(pile, scene, bodies[0].object, (const double(*)[3])points, count, &error), &error);

  for (int tick = 0; tick <= 2000; ++tick) { /* at 1 kHz */
    if (tick > 1000) hip_m[0] += 0.00001;
    check(fdcg_scene_move_finger(scene, finger, hip_m, &error), &error);
    check(fdcg_scene_step_pile(scene, pile, bodies, 1, 1, 0.001, reactions, 1, &error), &error);
    if (tick % 400 == 0) {
      const fdcg_body* body = &bodies[0].body;
      printf("%.1f s: centre at %.4f %.4f m, asleep %u\n", tick / 1000.0, body->centre_m[0], body->centre_m[2],
             body->is_asleep);
    }
  }
  fdcg_close(&cube);
  return 0;
}
