// SPDX-License-Identifier: Apache-2.0
// Deformable meshes: clear balls of any contact do not change forces; the tick count may pass 2^32.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "deform/deform_upkeep.hpp"
#include "deform_rig.hpp"
#include "fp_trap.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "step/contact_internals.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

// A wave that runs through a sheet, and now and then a great one.
class Waves {
 public:
  Waves(const bake::PolygonSoup& rest, std::uint64_t seed) : rest_(&rest), random_(seed) {}

  void move(DeformableMesh& sheet) {
    ++tick_;
    if (random_.chance(0.01)) height_ = random_.chance(0.3) ? 0.1 : random_.uniform(0, 0.01);
    const auto count = static_cast<std::uint32_t>(rest_->points.size());
    for (std::uint32_t i = 0; i < count / 20; ++i) {
      const std::size_t v = random_.below(count);
      const bake::Vec3& p = rest_->points[v];
      sheet.move(v, {p.x, p.y, height_ * std::sin(9 * p.x + 0.02 * tick_) * std::cos(7 * p.y - 0.013 * tick_)});
    }
  }

 private:
  const bake::PolygonSoup* rest_;
  Random random_;
  double height_ = 0.003;
  int tick_ = 0;
};

struct Finger {
  Hip hip;
  fdcg_deform_contact contact = {}, looking = {};  // with clear balls, and without
};

void move_finger(Finger* finger, Random& random) {
  if (random.chance(0.2)) return;
  const double size = random.chance(0.02) ? 0.1 : 0.001;
  for (std::size_t k = 0; k < 3; ++k)
    finger->hip[k] = std::min(std::max(finger->hip[k] + random.uniform(-size, size), k < 2 ? -0.4 : -0.02), k < 2 ? 0.4 : 0.06);
}

}  // namespace

// More fingers than the mesh watches balls of; some are copied over others.
TEST_CASE("clear balls over a moving sheet do not change any force") {
  constexpr int kFingers = 20;
  const std::uint64_t steps = steps_or(6000);
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    const bake::PolygonSoup rest = plane_grid(40, 40);
    DeformableMesh sheet(rest, triangle_options(precision));
    Waves waves(rest, 41);
    Random random(43);
    const fdcg_params params = contact_params(0.5, 0.3);
    fdcg_params looks = params;
    looks.disabled_optimizations = FDCG_STEP_OPT_CLEAR_BALL;
    std::vector<Finger> fingers(kFingers);
    for (Finger& finger : fingers)
      finger.hip = {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0.01, 0.06)};
    std::uint64_t in_ball = 0, caught = 0, touched = 0, missed = 0;
    for (std::uint64_t i = 0; i < steps; ++i) {
      if (random.chance(0.9)) waves.move(sheet);
      if (random.chance(0.05)) fingers[random.below(kFingers)] = fingers[random.below(kFingers)];
      for (Finger& finger : fingers) {
        if (random.chance(0.01)) continue;  // and misses the tick
        move_finger(&finger, random);
        const FpTrap trap(finger.hip.data());
        const fdcg_result felt = sheet.step(params, &finger.contact, finger.hip);
        const fdcg_result looked = sheet.step(looks, &finger.looking, finger.hip);
        INFO("step " << i << " state " << felt.state << " against " << looked.state << " flags " << felt.flags << " against "
                     << looked.flags << " at " << finger.hip[0] << " " << finger.hip[1] << " " << finger.hip[2]);
        REQUIRE(std::memcmp(&felt, &looked, sizeof felt) == 0);
        in_ball += internals_of(finger.contact.contact).clear_ball.radius2 > 0;
        caught += (felt.flags & FDCG_DEFORM_CAUGHT) != 0;
        missed += (felt.flags & FDCG_DEFORM_MISSED) != 0;
        touched += felt.state != FDCG_FREE;
      }
    }
    const std::uint64_t all = steps * kFingers;
    INFO(in_ball << " in a ball, " << caught << " caught, " << touched << " in touch, " << missed << " missed of " << all);
    CHECK(in_ball > all / 5);
    CHECK(caught > all / 2000);
    CHECK(touched > all / 20);
    CHECK(missed > all / 2000);
  }
}

// Regression: with a 32-bit tick number, state counted from tick to tick was lost at the wrap.
TEST_CASE("a contact is not affected when the tick count passes 2^32") {
  const bake::PolygonSoup rest = plane_grid(12, 12);
  DeformableMesh young(rest), old(rest);
  constexpr std::uint64_t kBefore = 40;
  old.deform()->tick = (std::uint64_t{1} << 32) - kBefore;
  Waves waves(rest, 3), same_waves(rest, 3);
  Random random(5);
  const fdcg_params params = contact_params(0.5, 0.3);
  Finger there, here;
  there.hip = {0.1, 0.05, 0.02};
  std::uint64_t caught = 0;
  for (std::uint64_t i = 0; i < 4 * kBefore; ++i) {
    waves.move(young);
    same_waves.move(old);
    if (i + 1 == kBefore) {  // the sheet jumps over the finger in the very tick
      for (std::size_t v = 0; v < rest.points.size(); ++v) {
        young.move(v, {rest.points[v].x, rest.points[v].y, 0.2});
        old.move(v, {rest.points[v].x, rest.points[v].y, 0.2});
      }
    }
    move_finger(&there, random);
    if (i + 5 > kBefore && i < kBefore) there.hip[2] = 0.15;
    const fdcg_result a = young.step(params, &there.contact, there.hip), b = old.step(params, &here.contact, there.hip);
    INFO("step " << i);
    REQUIRE(std::memcmp(&a, &b, sizeof a) == 0);
    REQUIRE((b.flags & FDCG_DEFORM_MISSED) == 0);
    caught += (b.flags & FDCG_DEFORM_CAUGHT) != 0;
  }
  CHECK(caught >= 1);
  CHECK(old.deform()->tick > std::uint64_t{1} << 32);
  CHECK(bytes_of(old.updated()) == old.bytes_anew());
}
