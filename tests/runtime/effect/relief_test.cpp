// SPDX-License-Identifier: Apache-2.0
// Heights that are felt on flat faces: the force against the formula, the band, the flank under friction, the energy.
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "hip_loop.hpp"
#include "meshes.hpp"
#include "relief_rig.hpp"

using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double kTick_s = kReliefTick_s, kTurn = 2 * std::numbers::pi, kStiffness = kReliefStiffness;
constexpr double kHeight_m = 1e-4, kWave_m = 1e-3, kAlongX[3] = {1, 0, 0};

const CompiledMesh& block() {  // of side 1 m: the top is z = 0.5
  static const CompiledMesh mesh(cube());
  return mesh;
}

}  // namespace

TEST_CASE("a wave of 0.1 mm and 1 mm at 0.1 m/s is felt at 100 Hz with the analytic amplitude") {
  const fdcg_waves waves = fdcg_make_ridges(kHeight_m, kWave_m, kAlongX);
  Felt felt(fdcg_make_relief(&waves), block().view(), relief_params(0, 0));
  const std::vector<Hip> forces = stroke(felt, 0.1, 1000);
  const double normal_n = std::abs(amplitude_at(forces, 2, 100)), along_n = std::abs(amplitude_at(forces, 0, 100));
  CHECK(normal_n == Approx(kStiffness * kHeight_m).epsilon(0.01));
  CHECK(along_n == Approx(kStiffness * 0.0015 * kHeight_m * kTurn / kWave_m).epsilon(0.01));
  for (double hz = 10; hz < 500; hz += 10) {
    if (hz != 100) CHECK(std::abs(amplitude_at(forces, 2, hz)) < 0.001 * normal_n);
  }
  // and each tick by itself
  double x = -0.3 + 50 * 1e-4;
  for (const Hip& force : forces) {
    x += 1e-4;
    const double load = kStiffness * (0.0015 + kHeight_m * std::sin(kTurn * x / kWave_m));
    CHECK(force[2] == Approx(load).epsilon(1e-6));
    CHECK(force[0] == Approx(-load * kHeight_m * kTurn / kWave_m * std::cos(kTurn * x / kWave_m)).margin(1e-5));
  }
}

TEST_CASE("what passes faster than half the tick rate is not felt, and nothing is felt at another frequency than its own") {
  const fdcg_waves waves = fdcg_make_ridges(kHeight_m, kWave_m, kAlongX);
  for (const double speed : {0.05, 0.2, 0.25, 0.3, 0.4, 0.499, 0.5, 0.7, 1.0, 1.3, 2.0, 5.0}) {
    Felt felt(fdcg_make_relief(&waves), block().view(), relief_params(0, 0));
    const std::vector<Hip> forces = stroke(felt, speed, speed > 1 ? 100 : 400);
    const double hz = speed / kWave_m, share = hz < 250 ? 1 : std::max(0.0, (500 - hz) / 250);
    double square = 0;
    for (const Hip& force : forces)
      square += (force[2] - 1.5) * (force[2] - 1.5) / static_cast<double>(forces.size());
    INFO(speed << " m/s");
    if (hz >= 500) CHECK(square == Approx(0).margin(1e-20));
    if (hz < 499) CHECK(std::sqrt(2 * square) == Approx(share * kStiffness * kHeight_m).epsilon(0.02).margin(1e-6));
  }
}

TEST_CASE("contact begins and ends on the flat surface, and the force grows from there without a jump") {
  const fdcg_waves waves = fdcg_make_bumps(kHeight_m, kWave_m);
  for (const double x : {0.0, 0.00025, 0.0005, 0.00075}) {
    Felt felt(fdcg_make_relief(&waves), block().view(), relief_params(0, 0));
    double last = 0;
    for (int i = -20; i < 1000; ++i) {
      const double depth = 1e-6 * i;
      felt.at({x, 0.0003, 0.5 - depth});
      CHECK((felt.force[2] > 0) == (depth > 0));
      CHECK(felt.force[2] - last >= 0);
      CHECK(felt.force[2] - last <= 3 * kStiffness * 1e-6);
      last = felt.force[2];
    }
  }
}

// On a flank that rises by 0.3 along x, with friction 0.5: down it slips at 0.2 times the load, up at 0.8.
TEST_CASE("a contact sticks and slips on the flank of a bump") {
  const fdcg_waves waves = fdcg_make_ridges(kHeight_m, kTurn * kHeight_m / 0.3, kAlongX);
  for (const double side : {-1.0, 1.0}) {
    Felt felt(fdcg_make_relief(&waves), block().view(), relief_params(0.5, 0.5));
    const double x = 0;
    felt.at({x, 0.01, 0.51});
    for (int i = 0; i < 20; ++i)
      felt.at({x, 0.01, 0.5 - 0.003});
    Hip held{};
    double way = 0;
    while (felt.contact.result.slipping == 0 && way < 0.005) {
      held = felt.force;
      felt.at({x + side * (way += 1e-6), 0.01, 0.5 - 0.003});
    }
    REQUIRE(way < 0.005);
    const double slope = 0.3 * std::cos(way * 0.3 / kHeight_m);
    CHECK(held[0] / held[2] == Approx(-side * 0.5 - slope).margin(0.005));
  }
}

TEST_CASE("grain has its root mean square, and is the same for a seed") {
  const fdcg_waves waves = fdcg_make_grain(2e-5, 3e-4, 5e-3, 1, 7), same = fdcg_make_grain(2e-5, 3e-4, 5e-3, 1, 7),
                   other = fdcg_make_grain(2e-5, 3e-4, 5e-3, 1, 8);
  CHECK(std::memcmp(&waves, &same, sizeof waves) == 0);
  CHECK(std::memcmp(&waves, &other, sizeof waves) != 0);
  const fdcg_relief relief = fdcg_make_relief(&waves);
  Random random(4);
  double square = 0, worst_slope = 0;
  constexpr int kPlaces = 200'000;
  for (int i = 0; i < kPlaces; ++i) {
    const fdcg_relief_place place = {
        {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, {0, 0, 0}, FDCG_NONE, 0};
    double height, slope[3], beside, ignored[3];
    relief.law(&relief, &place, &height, slope);
    square += height * height / kPlaces;
    REQUIRE(std::fabs(height) <= relief.most_m);
    if (i > 1000) continue;
    const double step = 1e-8;
    fdcg_relief_place next = place;
    next.place_m[0] += step;
    relief.law(&relief, &next, &beside, ignored);
    worst_slope = std::max(worst_slope, std::fabs((beside - height) / step - slope[0]));
  }
  CHECK(std::sqrt(square) == Approx(2e-5).epsilon(0.02));
  CHECK(worst_slope <= relief.curvature_per_m * 1e-8);
  double longest = 0, shortest = 1;
  for (const auto& per_m : waves.per_m) {
    const double length = 1 / std::hypot(per_m[0], per_m[1], per_m[2]);
    longest = std::max(longest, length), shortest = std::min(shortest, length);
  }
  CHECK(longest <= 5e-3);
  CHECK(shortest >= 3e-4);
  CHECK(longest / shortest > 10);
}

TEST_CASE("over closed loops a relief gives the step's work, and no more beyond it than its account allows") {
  const fdcg_waves ridges = fdcg_make_ridges(kHeight_m, 4e-3, kAlongX), grain = fdcg_make_grain(3e-5, 1e-3, 1e-2, 1, 3);
  const double kSize = 0.05;
  const CompiledMesh meshes[3] = {CompiledMesh(scaled(cube(), kSize)), CompiledMesh(scaled(ico_sphere(3), kSize)),
                                  CompiledMesh(scaled(saddle_block(), 0.5 * kSize))};
  Random random(9);
  double most = -1, spent = 0;
  for (int loop = 0; loop < 100'000; ++loop) {
    const fdcg_relief relief = fdcg_make_relief(loop % 2 == 0 ? &ridges : &grain);
    const fdcg_params params = relief_params(loop % 3 * 0.25, loop % 3 * 0.2);
    const std::vector<Hip> hips = elliptic_loop(random, kSize, 40 + loop % 60);
    Felt felt(relief, meshes[loop / 6 % 3].view(), params);
    Hip held{}, last = hips[0];
    double work_j = 0, longest_m = 0, strongest_n = 0;
    for (const Hip& hip : hips) {
      const Hip way = difference(hip, last);
      work_j += dot(held, way);
      longest_m = std::max(longest_m, norm(way));
      held = felt.at(hip);
      strongest_n = std::max(strongest_n, norm(held));
      last = hip;
    }
    const double allowed = relief.reserve_j + relief.power_w * kTick_s * static_cast<double>(hips.size());
    INFO("loop " << loop);
    REQUIRE(felt.state.given_j <= allowed + 2 * strongest_n * longest_m);
    most = std::max(most, felt.state.given_j);
    spent = std::max(spent, felt.state.given_j / allowed);
    (void)work_j;
  }
  INFO("most " << most << " J, of what is allowed " << spent);
  CHECK(most > 0);
}

// On a flat face the terms that are left are of second order in the way of a tick.
TEST_CASE("on a flat face what a relief gives beyond the step falls with the way of a tick") {
  const fdcg_waves waves = fdcg_make_ridges(kHeight_m, 4e-3, kAlongX);
  double last = 0;
  for (const int ticks : {500, 1000, 2000, 4000}) {
    fdcg_relief relief = fdcg_make_relief(&waves);
    relief.reserve_j = 1e6;  // the account limits nothing
    Felt felt(relief, block().view(), relief_params(0, 0));
    double bound = 0;
    Hip before{};
    for (int i = 0; i <= ticks; ++i) {
      const double a = kTurn * i / ticks, depth = 0.002 * (1 - std::cos(a)) - 0.0005;
      const Hip hip = {0.01 * std::sin(a), 0.005 * std::sin(2 * a), 0.5 - depth};
      if (i > 0) {
        const Hip way = difference(hip, before);
        const double load = kStiffness * std::max(0.0, depth + kHeight_m + norm(way));
        // curvature along the surface, and that of growing in, 6 over the knee squared, and of both together
        const double knee = 8 * kHeight_m, curvature = relief.curvature_per_m + kHeight_m * 6 / (knee * knee) +
                                                       2 * 1.5 / knee * kHeight_m * kTurn / 4e-3;
        bound += load * curvature / 2 * dot(way, way);
      }
      before = hip;
      felt.at(hip);
    }
    INFO(ticks);
    CHECK(std::fabs(felt.state.given_j) <= bound);
    if (last > 0) CHECK(std::fabs(felt.state.given_j) < 0.7 * last);
    last = std::fabs(felt.state.given_j);
  }
}

TEST_CASE("a relief works on its material, and when it is on") {
  const fdcg_waves waves = fdcg_make_ridges(kHeight_m, kWave_m, kAlongX);
  fdcg_relief relief = fdcg_make_relief(&waves);
  relief.material = 1;
  Felt other(relief, block().view(), relief_params(0, 0));
  for (const Hip& force : stroke(other, 0.1, 50))
    CHECK(force[0] == 0);
  relief.material = FDCG_NONE;
  relief.is_off = 1;
  Felt off(relief, block().view(), relief_params(0, 0));
  for (const Hip& force : stroke(off, 0.1, 50))
    CHECK(force[0] == 0);
}

TEST_CASE("a relief out of range is refused by the name of its field") {
  fdcg_waves waves = fdcg_make_ridges(kHeight_m, kWave_m, kAlongX);
  const auto said = [](const fdcg_relief& relief) {
    fdcg_error error{};
    return fdcg_check_relief(&relief, &error) == FDCG_OK ? std::string() : std::string(error.message);
  };
  fdcg_relief relief = fdcg_make_relief(&waves);
  CHECK(said(relief).empty());
  relief.most_m = 0;
  CHECK_THAT(said(relief), ContainsSubstring("relief.most_m is 0"));
  relief = fdcg_make_relief(&waves);
  relief.law = nullptr;
  CHECK_THAT(said(relief), ContainsSubstring("relief.law"));
  waves.phase_turns[0] = 2;
  CHECK_THAT(said(fdcg_make_relief(&waves)), ContainsSubstring("waves.phase_turns is 2"));
  waves = fdcg_make_ridges(kHeight_m, kWave_m, nullptr);
  CHECK_THAT(said(fdcg_make_relief(&waves)), ContainsSubstring("waves.per_m's length is 0"));
  waves.count = 17;
  CHECK_THAT(said(fdcg_make_relief(&waves)), ContainsSubstring("waves.count is 17"));
  CHECK(fdcg_check_relief(nullptr, nullptr) == FDCG_E_ARGUMENT);
  const fdcg_relief sound = fdcg_make_relief(&waves);
  CHECK(fdcg_get_relief_stiffness(&sound, 2) == 2 * sound.curvature_per_m);
}
