// SPDX-License-Identifier: Apache-2.0
// Each law of fdcg/effect.h against its formula, conditions, limits, and what is refused. Over 400 lines: a case for each law.
#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "band.hpp"
#include "catch.hpp"
#include "contact_rig.hpp"
#include "effect/waves.hpp"
#include "fdcg/effect.h"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double kTick_s = 0.001, kTurn = 2 * std::numbers::pi;

// A hand over the plane z = 0, which it touches below.
struct Over {
  fdcg_effect effect;
  fdcg_effect_state state{};
  fdcg_effect_facts facts{};
  double stiffness_n_per_m = 1000;

  explicit Over(const fdcg_effect& of) : effect(of) {
    facts.tick_s = kTick_s;
    facts.normal[2] = 1;
    facts.material = FDCG_NONE;
    facts.has_surface = 1;
    fdcg_error error{};
    INFO(error.message);
    REQUIRE(fdcg_check_effect(&effect, kTick_s, &error) == FDCG_OK);
  }
  Hip at(double x, double y, double z, bool slips = false) {
    facts.hip_m[0] = facts.surface_m[0] = x;
    facts.hip_m[1] = facts.surface_m[1] = y;
    facts.hip_m[2] = z;
    facts.is_touching = z < 0;
    facts.is_slipping = slips && z < 0;
    facts.spring_n[2] = z < 0 ? -stiffness_n_per_m * z : 0;
    double force_n[3] = {0, 0, 0};
    fdcg_effect_step(&effect, &facts, &state, force_n);
    return {force_n[0], force_n[1], force_n[2]};
  }
};

// Without an account's limit.
fdcg_effect free_of_account(fdcg_effect effect) {
  effect.reserve_j = 1e6;
  return effect;
}

std::string refusal(const fdcg_effect& effect) {
  fdcg_error error{};
  return fdcg_check_effect(&effect, kTick_s, &error) == FDCG_OK ? std::string() : error.message;
}

}  // namespace

TEST_CASE("sine, decay and noise of effects are what they are called") {
  for (int i = -1000; i <= 1000; ++i) {
    const double turns = i / 1000.0;
    CHECK(std::fabs(sine_of_turns(turns) - std::sin(kTurn * turns)) < 2e-15);
    const double other = 0.7 - turns;
    const SinesCosines two = sines_cosines_of_turns(Two{turns, other});
    CHECK(std::fabs(two.sine[0] - std::sin(kTurn * turns)) < 2e-9);
    CHECK(std::fabs(two.cosine[0] - std::cos(kTurn * turns)) < 2e-9);
    CHECK(std::fabs(two.sine[1] - std::sin(kTurn * other)) < 2e-9);
    CHECK(std::fabs(two.cosine[1] - std::cos(kTurn * other)) < 2e-9);
  }
  for (double x = 0; x < 30; x += 0.01)
    CHECK(std::fabs(decay(x) / std::exp(-x) - 1) < 1e-12);
  CHECK(decay(1e9) == 0);
  std::uint64_t state = first_noise(3);
  double sum = 0, square = 0, product = 0, last = 0;
  constexpr int kCount = 400'000;
  for (int i = 0; i < kCount; ++i) {
    const double x = next_noise(&state);
    REQUIRE(std::fabs(x) < 3.5);
    sum += x, square += x * x, product += x * last;
    last = x;
  }
  CHECK(std::fabs(sum / kCount) < 0.01);
  CHECK(square / kCount == Approx(1).epsilon(0.01));
  CHECK(std::fabs(product / kCount) < 0.01);
}

TEST_CASE("a magnet draws by its formula, most at a third of its reach, and not beyond it") {
  Over over(free_of_account(fdcg_make_magnet(2, 0.009)));
  over.at(0, 0, 0.1);
  CHECK(over.at(0, 0, 0.003)[2] == Approx(-2));
  for (const double z : {0.0005, 0.002, 0.0071, 0.0089}) {
    const double s = z / 0.009;
    CHECK(over.at(0, 0, z)[2] == Approx(-2 * 6.75 * s * (1 - s) * (1 - s)).epsilon(1e-12));
  }
  CHECK(over.at(0, 0, 0.0091)[2] == 0);
  CHECK(over.at(0, 0, -0.001)[2] == 0);
  CHECK(fdcg_get_effect_stiffness(&over.effect, kTick_s) == Approx(6.75 * 2 / 0.009));
}

TEST_CASE("viscosity is against the velocity, on a surface along it") {
  Over on(free_of_account(fdcg_make_viscosity(2)));
  on.at(0, 0, -0.001);
  const Hip along = on.at(0.0001, -0.0002, -0.0012);
  CHECK(along[0] == Approx(-0.2));
  CHECK(along[1] == Approx(0.4));
  CHECK(along[2] == 0);
  CHECK(norm(on.at(0.0002, 0, 0.001)) == 0);
  fdcg_effect ambient = free_of_account(fdcg_make_viscosity(2));
  ambient.when = FDCG_WHEN_ALWAYS;
  Over in(ambient);
  in.at(0, 0, 0.1);
  CHECK(in.at(0, 0, 0.1001)[2] == Approx(-0.2));
  CHECK(fdcg_get_effect_stiffness(&ambient, kTick_s) == Approx(4000));
  CHECK(norm(in.at(1, 0, 0)) == Approx(5));  // its limit
}

TEST_CASE("stick-slip pulls back like a spring up to its force, lets go, and sticks anew") {
  Over over(free_of_account(fdcg_make_stick_slip(500, 0.5)));
  over.at(0, 0, -0.001);
  int slips = 0;
  double anchor = 0;
  for (int i = 1; i <= 60; ++i) {
    const double x = 1e-4 * i;
    const double pulled = over.at(x, 0, -0.001 - 1e-5 * i)[0];
    if (500 * (x - anchor) > 0.5) {
      CHECK(pulled == 0);
      anchor = x;
      ++slips;
    } else {
      CHECK(pulled == Approx(-500 * (x - anchor)).margin(1e-12));
    }
  }
  CHECK(slips == 5);
}

TEST_CASE("a tone has its amplitude and frequency, and none from half the tick rate on") {
  fdcg_effect tone = free_of_account(fdcg_make_vibration(0.5, 237));
  tone.ramp_s = 0;
  Over over(tone);
  for (int i = 0; i < 2000; ++i)
    CHECK(over.at(0, 0, -0.001)[2] == Approx(0.5 * std::sin(kTurn * 237 * i * kTick_s)).margin(1e-10));
  CHECK(over.at(0, 0, 0.001)[2] == 0);
  over.facts.tick_s = 0.0022;  // 237 Hz are above half of 454
  CHECK(over.at(0, 0, -0.001)[2] == 0);
  Over slow(free_of_account(fdcg_make_vibration(0.5, 250)));
  for (int i = 0; i < 5; ++i)  // faded in over 5 ms
    CHECK(std::fabs(slow.at(0, 0, -0.001)[2]) <= 0.5 * (i + 1) / 5 + 1e-12);
}

TEST_CASE("a tone points along the normal, the motion or an axis") {
  fdcg_effect tone = free_of_account(fdcg_make_vibration(0.5, 250));
  tone.ramp_s = 0;
  tone.along = FDCG_ALONG_MOTION;
  Over moving(tone);
  moving.at(0, 0, -0.001);
  CHECK(moving.at(0, -1e-4, -0.001)[1] == Approx(-0.5));
  CHECK(norm(moving.at(0, -1e-4, -0.001)) < 1e-12);
  tone.along = FDCG_ALONG_AXIS;
  tone.axis[0] = 0.6, tone.axis[1] = 0, tone.axis[2] = 0.8;
  Over fixed(tone);
  fixed.at(0, 0, -0.001);
  CHECK(fixed.at(0, 0, -0.001)[0] == Approx(0.3));
}

TEST_CASE("noise has its root mean square and its band") {
  fdcg_effect noise = free_of_account(fdcg_make_noise(0.9, 60, 250));
  noise.ramp_s = 0;
  Over over(noise);
  std::vector<double> felt;
  double square = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double force = over.at(0, 0, -0.001)[2];
    square += force * force;
    if (i < 8000) felt.push_back(force);
  }
  CHECK(std::sqrt(square / 200'000) == Approx(0.3).epsilon(0.03));
  // 10 Hz wide pieces: within the band, and an octave and more below it
  CHECK(band_power(felt, 1000, 3, 13) < 0.1 * band_power(felt, 1000, 120, 130));
  fdcg_effect low = noise;
  low.low_hz = 0;
  low.frequency_hz = 20;
  Over slow(low);
  double slow_square = 0;
  for (int i = 0; i < 400'000; ++i) {
    const double force = slow.at(0, 0, -0.001)[2];
    slow_square += force * force;
  }
  CHECK(std::sqrt(slow_square / 400'000) == Approx(0.3).epsilon(0.05));
}

TEST_CASE("a tap rings by the speed of impact, and dies away") {
  const fdcg_effect tap = free_of_account(fdcg_make_tap(1.5, 200, 0.01));
  Over over(tap);
  over.at(0, 0, 1e-4);
  for (int i = 0; i < 50; ++i) {
    const double expected = 1.5 * 0.3 * std::exp(-i * kTick_s / 0.01) * std::sin(kTurn * 200 * i * kTick_s);
    CHECK(over.at(0, 0, -2e-4)[2] == Approx(expected).margin(1e-12));
  }
  Over hard(tap);
  hard.at(0, 0, 0.1);
  hard.at(0, 0, -0.1);
  CHECK(hard.at(0, 0, -0.1)[2] == Approx(3 * std::exp(-0.1) * std::sin(kTurn * 0.2)));
  Over sunk(tap);  // the surface came up under a hand that rests
  sunk.at(0, 0, -1e-4);
  CHECK(sunk.at(0, 0, -1e-4)[2] == 0);
}

TEST_CASE("a pulse is half a wave, again after its period, or when it is triggered") {
  Over over(free_of_account(fdcg_make_pulse(0.8, 0.02, 0.05)));
  for (int i = 0; i < 220; ++i) {
    const double t = (i % 50) * kTick_s;
    CHECK(over.at(0, 0, -0.001)[2] == Approx(t < 0.0199 ? 0.8 * std::sin(kTurn / 2 * t / 0.02) : 0).margin(1e-9));
  }
  fdcg_effect click = free_of_account(fdcg_make_pulse(0.8, 0.02, 0));
  click.when = FDCG_WHEN_TRIGGERED;
  Over button(click);
  int pushed = 0;
  for (int i = 0; i < 300; ++i) {
    if (i == 100 || i == 200) fdcg_trigger_effect(&button.state);
    pushed += norm(button.at(0, 0, -0.001)) > 0;
    if (i == 99) CHECK(pushed == 0);
    if (i == 150) CHECK(pushed == 19);
  }
  CHECK(pushed == 38);
}

TEST_CASE("a model of a texture becomes reflection coefficients, and one that is not stable is refused") {
  // (1 - 0.5 z^-1)(1 + 0.25 z^-1): a = -0.25, -0.125
  const double stable[2] = {-0.25, -0.125}, unstable[2] = {-2.1, 1.1};
  double reflection[2];
  fdcg_error error{};
  REQUIRE(fdcg_get_reflection(stable, 2, reflection, &error) == FDCG_OK);
  CHECK(reflection[1] == Approx(-0.125));
  CHECK(reflection[0] == Approx(-0.25 / (1 - 0.125)));
  CHECK(fdcg_get_reflection(unstable, 2, reflection, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("not stable"));
  const double nothing[1] = {std::numeric_limits<double>::quiet_NaN()};
  CHECK(fdcg_get_reflection(nothing, 1, reflection, &error) == FDCG_E_ARGUMENT);
}

namespace {

// Two models of order 2, at 0.05 and 0.15 m/s and at one force.
struct Models {
  double speed[2] = {0.05, 0.15}, force[1] = {1}, deviation[2] = {2, 6}, reflection[4] = {};
  double coefficients[4] = {-1.2, 0.8, 0.3, 0.5};
  fdcg_texture texture{};

  Models() {
    for (int i = 0; i < 2; ++i)
      REQUIRE(fdcg_get_reflection(coefficients + 2 * i, 2, reflection + 2 * i, nullptr) == FDCG_OK);
    texture.rate_hz = 1000;
    texture.order = 2;
    texture.speed_count = 2;
    texture.force_count = 1;
    texture.speed_m_per_s = speed;
    texture.force_n = force;
    texture.reflection = reflection;
    texture.deviation_m_per_s2 = deviation;
  }
};

// Felt at a speed and a depth, from 50 ms on.
std::vector<double> stroke(const fdcg_effect& effect, double speed_m_per_s, double depth_m, int ticks) {
  Over over(effect);
  std::vector<double> felt;
  double x = 0;
  for (int i = 0; i < ticks + 50; ++i) {
    const Hip force = over.at(x += speed_m_per_s * kTick_s, 0, -depth_m, true);
    if (i >= 50) felt.push_back(force[2]);
  }
  return felt;
}

double mean_square(const std::vector<double>& felt) {
  double square = 0;
  for (const double x : felt)
    square += x * x;
  return square / static_cast<double>(felt.size());
}

// |deviation / A(f)|^2 of a model of order 2, over a band of a signal at 1 kHz.
double power_of_model(const double a[2], double deviation, double low_hz, double high_hz) {
  double power = 0;
  for (double hz = low_hz; hz < high_hz; hz += 0.1) {
    const std::complex<double> z = std::polar(1.0, -kTurn * hz * kTick_s);
    power += 0.1 * 2 * kTick_s * deviation * deviation / std::norm(1.0 + a[0] * z + a[1] * z * z);
  }
  return power;
}

}  // namespace

TEST_CASE("a texture has the variance and the spectrum of its models") {
  const Models models;
  fdcg_effect effect = free_of_account(fdcg_make_texture(&models.texture, 0.05));
  effect.force_n = 100;
  for (int i = 0; i < 2; ++i) {
    const double* const a = models.coefficients + 2 * i;
    const std::vector<double> felt = stroke(effect, models.speed[i], 0.002, 200'000);
    CHECK(mean_square(felt) == Approx(0.05 * 0.05 * power_of_model(a, models.deviation[i], 0, 500)).epsilon(0.05));
    const std::vector<double> piece(felt.begin(), felt.begin() + 16000);
    for (double hz = 50; hz < 480; hz += 100)
      CHECK(band_power(piece, 1000, hz, hz + 50) ==
            Approx(0.0025 * power_of_model(a, models.deviation[i], hz, hz + 50)).epsilon(0.25));
  }
  // below the first speed and force it fades in proportion, at rest it is silent; beyond the last it stays
  const double first = mean_square(stroke(effect, 0.05, 0.001, 100'000));
  CHECK(mean_square(stroke(effect, 0.025, 0.001, 100'000)) == Approx(first / 4).epsilon(0.05));
  CHECK(mean_square(stroke(effect, 0.05, 0.0005, 100'000)) == Approx(first / 4).epsilon(0.05));
  CHECK(mean_square(stroke(effect, 0, 0.001, 1000)) == 0);
  CHECK(mean_square(stroke(effect, 0.3, 0.001, 100'000)) ==
        Approx(mean_square(stroke(effect, 0.15, 0.001, 100'000))).epsilon(0.05));
  // and a servo of another rate than the models'
  Over fast(effect);
  fast.facts.tick_s = 0.00025;
  double square = 0, x = 0;
  for (int i = 0; i < 400'200; ++i) {
    const double force = fast.at(x += 0.05 * 0.00025, 0, -0.002, true)[2];
    if (i >= 200) square += force * force / 400'000;
  }
  CHECK(square < mean_square(stroke(effect, 0.05, 0.002, 100'000)));
  CHECK(square > 0.3 * mean_square(stroke(effect, 0.05, 0.002, 100'000)));
}

TEST_CASE("an effect works on its material, in its region, under its condition, and when it is on") {
  fdcg_effect effect = free_of_account(fdcg_make_viscosity(1));
  const auto felt = [](const fdcg_effect& of, double x, double y, std::uint32_t material, bool slips) {
    Over over(of);
    over.facts.material = material;
    over.at(x, y, -0.001, slips);
    return norm(over.at(x + 1e-4, y, -0.001, slips)) > 0;
  };
  CHECK(felt(effect, 0, 0, FDCG_NONE, false));
  effect.material = 2;
  CHECK(felt(effect, 0, 0, 2, false));
  CHECK(!felt(effect, 0, 0, 3, false));
  CHECK(!felt(effect, 0, 0, FDCG_NONE, false));
  effect.material = FDCG_NONE;
  effect.when = FDCG_WHEN_SLIPPING;
  CHECK(!felt(effect, 0, 0, 0, false));
  CHECK(felt(effect, 0, 0, 0, true));
  effect.region = FDCG_IN_BALL;
  effect.region_m[0] = 0.1;
  effect.region_half_m[0] = 0.02;
  CHECK(felt(effect, 0.09, 0.01, 0, true));
  CHECK(!felt(effect, 0.09, 0.02, 0, true));
  effect.region = FDCG_IN_BOX;
  effect.region_half_m[1] = effect.region_half_m[2] = 0.03;
  CHECK(felt(effect, 0.09, 0.02, 0, true));
  CHECK(!felt(effect, 0.09, 0.04, 0, true));
  effect.is_off = 1;
  CHECK(!felt(effect, 0.09, 0.02, 0, true));
}

namespace {

void push_by_context(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state, double force_n[3]) {
  force_n[0] = *static_cast<const double*>(effect->context);
  force_n[1] = facts->spring_n[2];
  state->memory[0] += 1;
}

}  // namespace

TEST_CASE("a law of one's own gets the facts and its context, and is limited") {
  double context = 0.25;
  Over over(free_of_account(fdcg_make_own_effect(push_by_context, &context, 3)));
  const Hip felt = over.at(0, 0, -0.001);
  CHECK(felt[0] == 0.25);
  CHECK(felt[1] == Approx(1));
  CHECK(norm(over.at(0, 0, -0.02)) == Approx(3));
  context = std::numeric_limits<double>::infinity();
  CHECK(norm(over.at(0, 0, -0.001)) == 0);
  CHECK(over.state.memory[0] == 3);
}

TEST_CASE("facts that are no numbers give no force, and the effect begins anew") {
  Over over(free_of_account(fdcg_make_viscosity(1)));
  over.at(0, 0, -0.001);
  CHECK(norm(over.at(std::numeric_limits<double>::quiet_NaN(), 0, -0.001)) == 0);
  CHECK(norm(over.at(0.1, 0, -0.001)) == 0);
  CHECK(over.at(0.1001, 0, -0.001)[0] == Approx(-0.1));
  over.facts.tick_s = 0;
  CHECK(norm(over.at(0.1002, 0, -0.001)) == 0);
}

TEST_CASE("an effect out of range is refused by the name of its field") {
  fdcg_effect effect = fdcg_make_vibration(1, 500);
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.frequency_hz is 500"));
  effect = fdcg_make_vibration(0, 100);
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.force_n is 0"));
  effect = fdcg_make_magnet(1, 0);
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.reserve_j is 0"));
  effect.reserve_j = 1;
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.distance_m is 0"));
  CHECK_THAT(refusal(fdcg_make_viscosity(-1)), ContainsSubstring("effect.viscosity_n_s_per_m is"));
  CHECK_THAT(refusal(fdcg_make_noise(1, 300, 200)), ContainsSubstring("effect.low_hz is 300"));
  CHECK_THAT(refusal(fdcg_make_tap(1, 100, 0)), ContainsSubstring("effect.decay_s is 0"));
  CHECK_THAT(refusal(fdcg_make_pulse(1, 0.02, 0.01)), ContainsSubstring("effect.period_s is"));
  CHECK_THAT(refusal(fdcg_make_texture(nullptr, 1)), ContainsSubstring("effect.texture"));
  CHECK_THAT(refusal(fdcg_make_own_effect(nullptr, nullptr, 1)), ContainsSubstring("effect.law"));
  Models models;
  models.reflection[1] = 1;
  CHECK_THAT(refusal(fdcg_make_texture(&models.texture, 1)), ContainsSubstring("texture.reflection is 1"));
  models.speed[1] = 0.05;
  CHECK_THAT(refusal(fdcg_make_texture(&models.texture, 1)), ContainsSubstring("texture.speed_m_per_s is"));
  effect = fdcg_make_viscosity(1);
  effect.struct_bytes = 16;
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.struct_bytes"));
  effect = fdcg_make_viscosity(1);
  effect.along = FDCG_ALONG_AXIS;
  effect.axis[2] = 2;
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.axis's length is 2"));
  effect = fdcg_make_viscosity(1);
  effect.region = FDCG_IN_BALL;
  CHECK_THAT(refusal(effect), ContainsSubstring("effect.region_half_m is 0"));
  CHECK(fdcg_check_effect(nullptr, kTick_s, nullptr) == FDCG_E_ARGUMENT);
}

TEST_CASE("the facts of a contact are its surface, normal, material and nearest place") {
  const CompiledMesh mesh(cube());  // of side 1, about the origin
  Contact contact(mesh.view(), contact_params(0.5, 0.3));
  fdcg_effect_facts facts;
  fdcg_error error{};
  const Hip above = {0.1, 0.2, 0.6}, below = {0.1, 0.2, 0.49};
  contact.step(above);
  REQUIRE(fdcg_get_effect_facts(&mesh.view(), &contact.result, above.data(), 0, kTick_s, &facts, &error) == FDCG_OK);
  CHECK(facts.has_surface == 0);
  REQUIRE(fdcg_get_effect_facts(&mesh.view(), &contact.result, above.data(), 0.2, kTick_s, &facts, &error) == FDCG_OK);
  CHECK(facts.has_surface == 1);
  CHECK(facts.is_touching == 0);
  CHECK(facts.surface_m[2] == Approx(0.5));
  CHECK(facts.normal[2] == 1);
  contact.step(below);
  REQUIRE(fdcg_get_effect_facts(&mesh.view(), &contact.result, below.data(), 0.2, kTick_s, &facts, &error) == FDCG_OK);
  CHECK(facts.is_touching == 1);
  CHECK(facts.surface_m[2] == Approx(0.5));
  CHECK(facts.spring_n[2] == contact.result.force_n[2]);
  CHECK(facts.material == FDCG_NONE);
  CHECK(fdcg_get_effect_facts(&mesh.view(), &contact.result, nullptr, 0, kTick_s, &facts, &error) == FDCG_E_ARGUMENT);
}
