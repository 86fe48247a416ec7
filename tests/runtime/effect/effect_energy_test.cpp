// SPDX-License-Identifier: Apache-2.0
// What effects give to the hand, over closed loops of all sorts: those that are passive no more than a spring of their
// stiffness gives by being held for a tick; all of them no more than their accounts allow.
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/effect.h"
#include "hip_loop.hpp"
#include "meshes.hpp"

using namespace fdcg::test;

namespace {

constexpr double kTick_s = 0.001, kSize = 0.05;
constexpr int kLoops = 100'000, kTicks = 40;

struct Given {
  double to_hand_j = 0, ways2_m2 = 0, longest_m = 0;
};

// A loop of the hand over a body, from and to a place out of every reach; every fifth shakes to and fro meanwhile.
std::vector<Hip> loop_of(Random& random, int number) {
  const fdcg::bake::Vec3 out = random.direction(), side = random.direction();
  const double height = kSize * random.uniform(1.3, 1.6), down = kSize * random.uniform(0.1, 1.1),
               wide = kSize * random.uniform(0.05, 0.8), shake = number % 5 == 0 ? 0.02 * kSize : 0;
  std::vector<Hip> hips;
  for (int i = 0; i <= kTicks; ++i) {
    const double a = i == kTicks ? 0 : 2 * std::numbers::pi * i / kTicks;
    const double r = height - down * (1 - std::cos(a)) / 2 + (i > 0 && i < kTicks ? shake * (i % 2 == 0 ? 1 : -1) : 0);
    const double s = wide * std::sin(a);
    hips.push_back({out.x * r + side.x * s, out.y * r + side.y * s, out.z * r + side.z * s});
  }
  return hips;
}

Given felt_over(const fdcg_graph& graph, const fdcg_effect& effect, const std::vector<Hip>& hips, fdcg_effect_state* state) {
  Contact contact(graph, contact_params(0.5, 0.3));
  Given given;
  Hip last{}, held{};
  fdcg_effect_facts facts;
  const double reach_m = effect.kind == FDCG_EFFECT_MAGNET ? effect.distance_m : 0;
  for (std::size_t i = 0; i < hips.size(); ++i) {
    const Hip& hip = hips[i];
    if (i > 0) {
      const Hip way = difference(hip, last);
      given.to_hand_j += dot(held, way);
      given.ways2_m2 += dot(way, way);
      given.longest_m = std::max(given.longest_m, norm(way));
    }
    contact.step(hip);
    REQUIRE(fdcg_get_effect_facts(&graph, &contact.result, hip.data(), reach_m, kTick_s, &facts, nullptr) == FDCG_OK);
    double force_n[3] = {0, 0, 0};
    fdcg_effect_step(&effect, &facts, state, force_n);
    held = {force_n[0], force_n[1], force_n[2]};
    last = hip;
  }
  return given;
}

// The greediest law that there is: it always pushes where the hand goes.
void push_along(const fdcg_effect*, const fdcg_effect_facts*, fdcg_effect_state* state, double force_n[3]) {
  for (int k = 0; k < 3; ++k)
    force_n[k] = 1e3 * state->velocity_m_per_s[k];
}

const std::vector<PolygonSoup>& bodies() {
  static const std::vector<PolygonSoup> all = {scaled(cube(), kSize), scaled(ico_sphere(2), kSize),
                                               scaled(saddle_block(), 0.5 * kSize)};
  return all;
}

}  // namespace

TEST_CASE("magnets, viscosity and stick-slip give no more over a closed loop than being held for a tick gives") {
  std::vector<fdcg_effect> laws = {fdcg_make_magnet(2, 0.2 * kSize), fdcg_make_viscosity(2), fdcg_make_viscosity(2),
                                   fdcg_make_stick_slip(400, 0.5), fdcg_make_stick_slip(400, 0.5)};
  laws[2].when = laws[4].when = FDCG_WHEN_ALWAYS;
  laws[2].smoothing_s = 0.003;
  const CompiledMesh meshes[3] = {CompiledMesh(bodies()[0]), CompiledMesh(bodies()[1]), CompiledMesh(bodies()[2])};
  for (fdcg_effect& law : laws) {
    law.reserve_j = 1e6;  // its account limits nothing
    const double stiffness = fdcg_get_effect_stiffness(&law, kTick_s);
    Random random(11);
    double worst = -1e9;
    for (int i = 0; i < kLoops / static_cast<int>(laws.size()); ++i) {
      fdcg_effect_state state{};
      const Given given = felt_over(meshes[i % 3].view(), law, loop_of(random, i), &state);
      const double bound = stiffness / 2 * given.ways2_m2;
      INFO("kind " << law.kind << " when " << law.when << ", loop " << i);
      REQUIRE(given.to_hand_j <= bound * (1 + 1e-9));
      REQUIRE(state.given_j == Approx(given.to_hand_j).margin(1e-15));
      worst = std::max(worst, given.to_hand_j / bound);
    }
    CHECK(worst < 1);
  }
}

TEST_CASE("no effect gives more than its account allows, whatever the hand does") {
  static const double speed[1] = {0.1}, force[1] = {0.5}, reflection[1] = {-0.5}, deviation[1] = {20};
  fdcg_texture texture{};
  texture.rate_hz = 1000;
  texture.order = texture.speed_count = texture.force_count = 1;
  texture.speed_m_per_s = speed;
  texture.force_n = force;
  texture.reflection = reflection;
  texture.deviation_m_per_s2 = deviation;
  std::vector<fdcg_effect> effects = {fdcg_make_magnet(2, 0.2 * kSize),
                                      fdcg_make_viscosity(2),
                                      fdcg_make_stick_slip(400, 0.5),
                                      fdcg_make_vibration(1, 150),
                                      fdcg_make_noise(1, 50, 300),
                                      fdcg_make_tap(2, 200, 0.01),
                                      fdcg_make_pulse(1, 0.02, 0.03),
                                      fdcg_make_texture(&texture, 0.05),
                                      fdcg_make_own_effect(push_along, nullptr, 2)};
  effects.back().when = FDCG_WHEN_ALWAYS;
  const CompiledMesh meshes[3] = {CompiledMesh(bodies()[0]), CompiledMesh(bodies()[1]), CompiledMesh(bodies()[2])};
  for (const fdcg_effect& effect : effects) {
    REQUIRE(fdcg_check_effect(&effect, kTick_s, nullptr) == FDCG_OK);
    Random random(23);
    fdcg_effect_state state{};  // one account over all loops, and over the jumps between them
    double most_m = 0, spent = 0;
    for (int i = 0; i < kLoops / static_cast<int>(effects.size()); ++i) {
      const std::vector<Hip> hips = loop_of(random, i);
      if (i > 0) most_m = std::max(most_m, distance(hips[0], Hip{state.hip_m[0], state.hip_m[1], state.hip_m[2]}));
      most_m = std::max(most_m, felt_over(meshes[i % 3].view(), effect, hips, &state).longest_m);
      const double allowed = effect.reserve_j + effect.power_w * (i + 1) * (kTicks + 1) * kTick_s;
      INFO("kind " << effect.kind << ", loop " << i);
      REQUIRE(state.given_j <= allowed + effect.force_n * most_m);
      spent = std::max(spent, state.given_j / allowed);
    }
    if (effect.kind == FDCG_EFFECT_OWN) CHECK(spent > 0.5);  // the greedy one takes what it may
  }
}
