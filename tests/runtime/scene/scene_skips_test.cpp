// SPDX-License-Identifier: Apache-2.0
// Optimizations of a scene do not change results: logs of scenes full of events are the same bit for bit for every combination
// of flags.
#include "scene_play.hpp"

using namespace fdcg::test;

TEST_CASE("every combination of optimizations gives the same forces") {
  const Place here = {0, 0, 0};
  const Play plays[] = {
      {1, 1, 4, 3, 0.2, 0, here, false, false},                    // one finger, one still object
      {1, 2, 1, 4, 0.3, 1, here, true, false},                     // fast
      {40, 3, 4, 6, 0.02, 0.2, here, false, false},                // a tray
      {40, 3, 2, 2, 0.1, 0.5, here, true, true},                   // crowded
      {150, 8, 8, 9, 0.3, 1, here, true, true},                    // more than one run of the scan
      {20, 2, 4, 4, 0.1, 0.5, {1e6, -2e6, 3e5}, false, true},      // far from the world's origin
      {20, 2, 4, 4, 0.1, 0.5, {1e11, 1e11, 1e11}, false, false}};  // ... where rounding is 1e-5 of the objects
  const PlayMeshes meshes;
  std::uint64_t crowded = 0, several = 0;
  int number = 0;
  for (const Play& play : plays) {
    const std::size_t ticks = ticks_of_a_run(play.objects > 100 ? 300 : 1500);
    const std::uint64_t seed = 41 + static_cast<std::uint64_t>(number);
    const Outcome all = Performance(play, meshes.graphs, 0, seed).run(ticks);
    INFO("play " << number++ << ", seed " << seed << ": " << all.touches << " touches, " << all.crowded << " crowded, "
                 << all.broadphase_updates << " broadphase updates in " << all.steps << " steps");
    CHECK(all.touches > all.steps / 100);
    CHECK(all.broadphase_updates < all.steps);
    crowded += all.crowded;
    several += all.several;
    for (std::uint32_t disabled = 1; disabled <= FDCG_OPT_ALL; ++disabled) {
      const Outcome some = Performance(play, meshes.graphs, disabled, seed).run(ticks);
      CAPTURE(disabled);
      CHECK(some.hash == all.hash);
      if ((disabled & FDCG_OPT_OUT_OF_REACH) != 0) CHECK(some.broadphase_updates > all.broadphase_updates);
    }
  }
  CHECK(crowded > 0);
  CHECK(several > 0);
}
