// SPDX-License-Identifier: Apache-2.0
// Static friction of a body on several points, judged for all of them together: on a ramp with mu_s above mu_d it holds up to
// mu_s, whatever share of its weight each point bears.
#include <cmath>

#include "catch.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kGravity = 9.80665, kMass_kg = 0.05, kMuStatic = 0.3, kMuDynamic = 0.22;

fdcg_body_config wakeful() {
  fdcg_body_config config = fdcg_make_body_config();
  config.sleep_after_s = 0;
  return config;
}

struct Block {
  const char* name;
  bake::PolygonSoup soup;
  double height_m;  // of its frame's origin above its base
};

std::vector<Block> blocks() {
  return {{"slab", grid_box(1, 1, 1, {0.08, 0.08, 0.01}), 0.005},
          {"cube", grid_box(1, 1, 1, {0.04, 0.04, 0.04}), 0.02},
          {"tower", grid_box(1, 1, 1, {0.04, 0.04, 0.08}), 0.04},
          {"bar", grid_box(1, 1, 1, {0.02, 0.12, 0.02}), 0.01},
          {"hexagon", scaled(prism(6), 0.02), 0.02},
          {"bridge", scaled(voxels("bridge", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}}), 0.02), 0}};
}

// On z = 0, or on a block of stone, with gravity leaning so that +x is downhill.
class Ramp {
 public:
  Ramp(const Block& block, bool is_graph) {
    const auto params = friction(kMuStatic, kMuDynamic, 2000);
    const auto shape = rig_.shape(block.soup);
    if (is_graph) {
      rig_.add_fixed(rig_.box(20, 1, 0.1), params, posed({0, 0, -0.05}));
    } else {
      rig_.ground({0, 0, 1}, 0, params);
    }
    rig_.add_body(shape, kMass_kg, params, posed({-5, 0, block.height_m}), wakeful(), 20);
    rig_.ticks(600);
  }
  void lean(double slope, int ticks) {
    const double from = angle_rad_, to = std::atan(slope);
    for (int tick = 1; tick <= ticks; ++tick) {
      angle_rad_ = from + (to - from) * (0.5 - 0.5 * std::cos(M_PI * tick / ticks));
      rig_.body(0).config.gravity_m_per_s2[0] = kGravity * std::sin(angle_rad_);
      rig_.body(0).config.gravity_m_per_s2[2] = -kGravity * std::cos(angle_rad_);
      rig_.tick();
    }
  }
  void ticks(int count) { rig_.ticks(count); }
  [[nodiscard]] double x() { return rig_.centre(0)[0]; }
  [[nodiscard]] double speed() { return rig_.velocity(0)[0]; }

 private:
  PileRig rig_;
  double angle_rad_ = 0;
};

}  // namespace

TEST_CASE("a block holds to 99.9 % of mu_s and slides from 100.1 %, at mu_d's acceleration, where mu_s is above mu_d") {
  for (const Block& block : blocks()) {
    for (const bool is_graph : {false, true}) {
      CAPTURE(block.name, is_graph);
      Ramp holding(block, is_graph);
      holding.lean(0.999 * kMuStatic, 1500);
      holding.ticks(1000);
      const double from = holding.x();
      holding.ticks(1000);
      CHECK(std::abs(holding.x() - from) < 1e-9);
      CHECK(std::abs(holding.speed()) < 1e-9);

      Ramp sliding(block, is_graph);
      sliding.lean(1.001 * kMuStatic, 1500);
      sliding.ticks(500);
      const double start = sliding.x(), before = sliding.speed();
      sliding.ticks(100);
      const double angle = std::atan(1.001 * kMuStatic);
      const double expected = kGravity * (std::sin(angle) - kMuDynamic * std::cos(angle));
      CAPTURE(sliding.x() - start, sliding.speed());
      CHECK(sliding.x() - start > 1e-3);
      CHECK((sliding.speed() - before) / 0.1 == Approx(expected).epsilon(1e-3));
    }
  }
}
