// SPDX-License-Identifier: Apache-2.0
// Which corners of a deformable mesh bear a force.
#include <cmath>
#include <vector>

#include "compiled.hpp"
#include "fdcg/deform.h"
#include "meshes.hpp"

using namespace fdcg;
using namespace fdcg::test;

TEST_CASE("a deformable mesh's force is shared out among the corners that bear it, where they are") {
  bake::CompileOptions options;
  options.triangles = true;
  const bake::Compiled compiled = compile_whole(plane_grid(4, 4), options);
  fdcg_graph graph;
  fdcg_error error;
  REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  std::vector<std::uint64_t> memory(fdcg_deform_bytes(&graph) / 8 + 8);
  const fdcg_deform_config config = fdcg_make_deform_config();
  fdcg_deform* deform = nullptr;
  REQUIRE(fdcg_deform_create(memory.data(), memory.size() * 8, &graph, &config, &deform, &error) == FDCG_OK);
  const fdcg_params params = fdcg_make_params();
  fdcg_deform_contact contact = {};
  fdcg_result result = {};
  std::uint32_t corners[3];
  double weights[3];
  REQUIRE(fdcg_deform_share(deform, &result, corners, weights, &error) == FDCG_OK);
  CHECK(corners[0] == FDCG_NONE);
  std::uint32_t states = 0;
  for (int tick = 0; tick < 400; ++tick) {
    for (std::uint32_t c = 0; c < graph.header->corner_count; ++c) {  // a wave runs through the sheet
      double at[3];
      REQUIRE(fdcg_deform_place(deform, c, at, &error) == FDCG_OK);
      at[2] = 0.02 * std::sin(7 * at[0] + 0.05 * tick);
      REQUIRE(fdcg_deform_move(deform, c, at, &error) == FDCG_OK);
    }
    const double hip[3] = {0.002 * tick - 0.4, 0.1, tick == 0 ? 0.1 : -0.05};
    fdcg_deform_step(deform, &params, &contact, hip, &result);
    REQUIRE(fdcg_deform_share(deform, &result, corners, weights, &error) == FDCG_OK);
    if (result.state == FDCG_FREE) continue;
    states |= 1u << result.state;
    double sum = 0, at[3] = {0, 0, 0};
    for (int k = 0; k < 3 && corners[k] != FDCG_NONE; ++k) {
      CHECK(weights[k] >= 0);
      sum += weights[k];
      double place[3];
      REQUIRE(fdcg_deform_place(deform, corners[k], place, &error) == FDCG_OK);
      for (int j = 0; j < 3; ++j)
        at[j] += weights[k] * place[j];
    }
    CHECK(sum == Approx(1));
    for (int j = 0; j < 3; ++j)
      CHECK(at[j] == Approx(result.god_object_m[j]).margin(1e-9));
  }
  CHECK((states & 1u << FDCG_FACE) != 0);
  result.state = FDCG_FACE;
  result.feature = 1u << 20;
  CHECK(fdcg_deform_share(deform, &result, corners, weights, &error) == FDCG_E_ARGUMENT);
}
