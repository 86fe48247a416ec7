// SPDX-License-Identifier: Apache-2.0
// turntable.c with C++ manners: the memory is a span, results and touches are values.
#include <array>
#include <cmath>
#include <cstdio>

#include "fdcg/fdcg.hpp"

int main() {
  static std::array<std::byte, 128 * 1024> memory;  // the scene's: it never asks for more
  const std::array<double, 3> hip_m = {0.006, 0.004, 0.009};
  const fdcg_params params = fdcg_make_params();
  fdcg_pose table_pose = fdcg_make_identity_pose(), block_pose = fdcg_make_identity_pose();
  table_pose.translation_m[2] = -0.002;
  block_pose.translation_m[0] = 0.020;

  fdcg::Graph cube;
  fdcg::Scene scene;
  fdcg_object_id table, block;
  fdcg_finger_id finger;
  fdcg_error why;
  if (!cube.open_file("cube.fdcg", &why) || !scene.create(memory, fdcg_make_scene_config(), &why) ||
      !scene.add_object(cube, params, table_pose, &table, &why) || !scene.add_object(cube, params, block_pose, &block, &why) ||
      !scene.add_finger(hip_m, &finger, &why)) {
    std::fprintf(stderr, "%s\n", why.message);
    return 1;
  }
  for (int tick = 0; tick < 8; ++tick) {
    const double angle = tick < 2 ? 0 : 0.05 * (tick < 6 ? tick - 1 : 4);
    table_pose.translation_m[2] = tick < 1 ? -0.002 : 0;
    table_pose.rotation_xyzw[2] = std::sin(angle / 2);
    table_pose.rotation_xyzw[3] = std::cos(angle / 2);
    if (tick > 5) block_pose.translation_m[0] -= 0.0075;
    if (!scene.set_pose(table, table_pose, &why) || !scene.set_pose(block, block_pose, &why)) return 1;
    scene.step();
    const fdcg_finger_result felt = scene.result(finger);
    std::printf("tick %d: touches %u, force %.3f %.3f %.3f N\n", tick, felt.touch_count, felt.force_n[0], felt.force_n[1],
                felt.force_n[2]);
  }
}
