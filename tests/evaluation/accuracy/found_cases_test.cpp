// SPDX-License-Identifier: Apache-2.0
// Ticks that the search of fdcg_bench_accuracy found beyond the limit of 64 ulps. All enter a face at a grazing angle, and
// friction keeps the god-object where it entered: inputs half an ulp off move the exact answer by thousands of ulps. What must
// hold is that the step is exact for inputs next to those it got.
#include <algorithm>
#include <vector>

#include "catch.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "replay.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

struct Found {
  PolygonSoup soup;
  double mu_static, mu_dynamic;
  std::vector<Hip> hips;
};

const std::vector<Found> kFound = {
    {saddle_block(),
     0.1,
     0.1,
     {{0x1.6a09f0ec9bbbap-1, -0x1.6a09e09bc3349p-1, -0x1.9999cb261b57ap-3},
      {-0x1.fffcecedbb9b8p-1, -0x1.0ded24a8261e9p-16, -0x1.08a52d53ad33fp-1}}},
    {star_sphere(2, 0.3, 1),
     0.6,
     0.6,
     {{-0x1.011855961a374p-2, 0x1.5a5f61a6aca47p-3, 0x1.e8321529d7b24p-1},
      {0x1.2c6ee776d2b3dp-1, 0x1.54d8345c78ae3p-3, -0x1.4033a52560a06p-1}}},
    {spiky_sphere(2, 1, 1),
     0.6,
     0.42,
     {{-0x1.046a479403d8ep-8, 0x1.6124a39f5d406p-3, 0x1.5ef35669f25ffp+0},
      {0x1.728877dc176fcp-1, 0x1.1096d6c324d6fp+0, -0x1.7a945024225dap+0},
      {0x1.ee2a1fb98d3eep-6, 0x1.0a6116cd06495p-1, 0x1.b88e41e85b6ap-1},
      {0x1.787a8f37426dcp+0, 0x1.a03983ca581ddp-2, 0x1.013db194acd5p-2},
      {-0x1.a1c81a2c6fc1fp+0, -0x1.7e31c51485925p+0, -0x1.14f9cf5c1b109p-1}}},
};

}  // namespace

TEST_CASE("what the search found beyond the limit is exact for inputs within an ulp or two") {
  constexpr double kMostBackward_ulps = 2, kLimit_ulps = 64;
  for (const Found& found : kFound) {
    const PlainGraph graph(found.soup, Precision::f64);
    Replay<Mpfr256> replay(graph.view(), contact_params(found.mu_static, found.mu_dynamic));
    double most_ulps = 0;
    for (const Hip& hip : found.hips) {
      replay.step(hip);
      const TickError& tick = replay.last();
      INFO(found.soup.name << ": " << tick.ulps << " ulps, conditioning " << tick.conditioning);
      CHECK(tick.verdict != TickError::Verdict::wrong);
      if (tick.ulps > kWorthACloserLook_ulps) CHECK(tick.ulps <= kMostBackward_ulps * tick.conditioning);
      most_ulps = std::max(most_ulps, tick.ulps);
    }
    INFO(found.soup.name << ": " << most_ulps);
    CHECK(most_ulps > kLimit_ulps);  // the case still is what it was found for
  }
}
