// SPDX-License-Identifier: Apache-2.0
// press_and_slide.c with C++ manners: the graph closes itself, the contact is a value, the hand is a span.
#include <array>
#include <cstdio>

#include "fdcg/fdcg.hpp"

int main() {
  fdcg::Graph graph;
  if (fdcg_error why; !graph.open_file("cube.fdcg", &why)) {
    std::fprintf(stderr, "%s\n", why.message);
    return 1;
  }
  const fdcg_params params = fdcg_make_params();
  fdcg::Contact contact;
  for (int tick = 0; tick < 6; ++tick) {
    const std::array<double, 3> hip_m = {0.004 + 0.0003 * tick, 0.005, tick == 0 ? 0.011 : 0.009};
    const fdcg_result result = contact.step(graph, params, hip_m);
    std::printf("tick %d: state %u, slip %u, force %.3f %.3f %.3f N\n", tick, result.state, result.slipping, result.force_n[0],
                result.force_n[1], result.force_n[2]);
  }
}
