// SPDX-License-Identifier: Apache-2.0
// One rigid body: conservation, order of convergence, stability, sleep, refusals.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include "catch.hpp"
#include "fdcg/body.h"

namespace {

using Triple = std::array<double, 3>;

constexpr double kNothing[3] = {0, 0, 0};

double length(const Triple& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
Triple triple(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

fdcg_body_config weightless() {
  fdcg_body_config config = fdcg_make_body_config();
  config.gravity_m_per_s2[2] = 0;
  config.sleep_after_s = 0;
  return config;
}

// Asymmetric, its tensor not diagonal.
fdcg_body_config lopsided() {
  fdcg_body_config config = weightless();
  const double inertia[6] = {3e-4, 5e-4, 7e-4, -0.5e-4, 0.3e-4, 0.8e-4};
  std::copy(std::begin(inertia), std::end(inertia), config.inertia_kg_m2);
  config.mass_kg = 0.4;
  config.centre_m[0] = 0.01;
  config.centre_m[2] = -0.03;
  return config;
}

fdcg_body made(const fdcg_body_config& config, const Triple& velocity, const Triple& spin) {
  fdcg_body body;
  fdcg_error error;
  const fdcg_pose pose = fdcg_make_identity_pose();
  REQUIRE(fdcg_body_init(&body, &config, &pose, &error) == FDCG_OK);
  REQUIRE(fdcg_body_set_motion(&body, velocity.data(), spin.data(), &error) == FDCG_OK);
  return body;
}

// How far two attitudes are apart, in radians for small angles.
double apart(const fdcg_body& a, const fdcg_body& b) {
  double same = 0, opposite = 0;
  for (int k = 0; k < 4; ++k) {
    same += std::pow(a.rotation_xyzw[k] - b.rotation_xyzw[k], 2);
    opposite += std::pow(a.rotation_xyzw[k] + b.rotation_xyzw[k], 2);
  }
  return 2 * std::sqrt(std::min(same, opposite));
}

std::string refusal(const std::function<void(fdcg_body_config&, fdcg_pose&)>& change) {
  fdcg_body_config config = weightless();
  fdcg_pose pose = fdcg_make_identity_pose();
  change(config, pose);
  fdcg_body body;
  fdcg_error error = {};
  CHECK(fdcg_body_init(&body, &config, &pose, &error) == FDCG_E_ARGUMENT);
  return error.message;
}

}  // namespace

TEST_CASE("a free asymmetric body keeps energy and angular momentum over 10^6 ticks") {
  for (const Triple& spin : {Triple{20, 1, -3}, Triple{0.01, 30, 0.01}, Triple{-4, 2, 60}, Triple{300, -200, 400}}) {
    fdcg_body body = made(lopsided(), {0.3, -0.1, 0.2}, spin);
    const double energy = fdcg_body_get_kinetic_energy_j(&body);
    const Triple momentum = triple(body.angular_momentum);
    double worst = 0;
    for (int tick = 0; tick < 1000000; ++tick) {
      fdcg_body_step(&body, kNothing, kNothing, 1e-3);
      if (tick % 1000 == 999) worst = std::max(worst, std::abs(fdcg_body_get_kinetic_energy_j(&body) / energy - 1));
    }
    CAPTURE(spin);
    WARN("energy off by at most " << worst << " of itself");
    CHECK(worst < 1e-9);
    CHECK(triple(body.angular_momentum) == momentum);  // world frame: not one bit
    CHECK(triple(body.velocity_m_per_s) == Triple{0.3, -0.1, 0.2});
    CHECK(body.centre_m[0] == Approx(0.01 + 300).epsilon(1e-9));
    CHECK(body.unsolved_steps == 0);
  }
}

TEST_CASE("a free turn, a heavy top and a spring are followed at second order") {
  struct Way {
    const char* name;
    std::function<void(const fdcg_body&, double (&)[3], double (&)[3])> act;
  };
  const Way ways[] = {{"free", [](const fdcg_body&, double(&)[3], double(&)[3]) {}},
                      {"top",
                       [](const fdcg_body& body, double(&)[3], double(&torque)[3]) {
                         const fdcg_pose pose = fdcg_body_get_pose(&body);  // hung at the object's origin, by its weight of 4 N
                         const double x = body.centre_m[0] - pose.translation_m[0],
                                      y = body.centre_m[1] - pose.translation_m[1];
                         torque[0] = -4 * y, torque[1] = 4 * x;
                       }},
                      {"spring", [](const fdcg_body& body, double(&force)[3], double(&)[3]) {
                         for (int k = 0; k < 3; ++k)
                           force[k] = -40 * body.centre_m[k];
                       }}};
  for (const Way& way : ways) {
    const auto after_a_second = [&way](int steps) {
      fdcg_body body = made(lopsided(), {0.3, -0.1, 0.2}, {5, 12, -3});
      for (int i = 0; i < steps; ++i) {
        double force[3] = {}, torque[3] = {};
        way.act(body, force, torque);
        fdcg_body_step(&body, force, torque, 1.0 / steps);
      }
      return body;
    };
    const fdcg_body fine = after_a_second(256000);
    double last_turn = 0, last_place = 0;
    for (const int steps : {500, 1000, 2000, 4000}) {
      CAPTURE(way.name, steps);
      const fdcg_body body = after_a_second(steps);
      double place = 0;
      for (int k = 0; k < 3; ++k)
        place = std::max(place, std::abs(body.centre_m[k] - fine.centre_m[k]));
      const double turn = apart(body, fine);
      if (last_turn != 0) CHECK(last_turn / turn == Approx(4).epsilon(0.05));
      if (last_turn != 0 && way.name == std::string("spring")) CHECK(last_place / place == Approx(4).epsilon(0.05));
      last_turn = turn;
      last_place = place;
    }
  }
}

TEST_CASE("gravity is exact up to rounding error, damping has its rate") {
  fdcg_body_config config = lopsided();
  config.gravity_m_per_s2[2] = -9.80665;
  fdcg_body falling = made(config, {1, 0, 2}, {0, 0, 0});
  for (int tick = 0; tick < 1000; ++tick)
    fdcg_body_step(&falling, kNothing, kNothing, 1e-3);
  CHECK(std::abs(falling.centre_m[0] - 1.01) < 1e-12);
  CHECK(std::abs(falling.centre_m[2] - (2 - 9.80665 / 2 - 0.03)) < 1e-12);
  CHECK(std::abs(falling.velocity_m_per_s[2] - (2 - 9.80665)) < 1e-12);

  config = lopsided();
  config.linear_damping_per_s = 3;
  config.angular_damping_per_s = 5;
  fdcg_body slowing = made(config, {1, 0, 0}, {0, 0, 10});
  const double momentum = length(triple(slowing.angular_momentum));
  for (int tick = 0; tick < 1000; ++tick)
    fdcg_body_step(&slowing, kNothing, kNothing, 1e-3);
  CHECK(slowing.velocity_m_per_s[0] == Approx(std::exp(-3)).epsilon(1e-5));
  CHECK(length(triple(slowing.angular_momentum)) / momentum == Approx(std::exp(-5)).epsilon(1e-5));

  config.linear_damping_per_s = 1e9;  // far beyond what a step can follow: it must slow all the same
  fdcg_body stopping = made(config, {1, 0, 0}, {0, 0, 0});
  for (int tick = 0; tick < 10000; ++tick)
    fdcg_body_step(&stopping, kNothing, kNothing, 1e-3);
  CHECK(std::abs(stopping.velocity_m_per_s[0]) <= 1);
}

TEST_CASE("a spring is stable up to the stated bound and not beyond; substeps keep to half of it") {
  const auto farthest = [](double h_omega) {
    fdcg_body_config config = weightless();
    const double stiffness = config.mass_kg * h_omega * h_omega / 1e-6;
    fdcg_body body = made(config, {0.001, 0, 0}, {0, 0, 0});
    double most = 0;
    for (int tick = 0; tick < 100000 && most < 1; ++tick) {
      const double force[3] = {-stiffness * body.centre_m[0], 0, 0};
      fdcg_body_step(&body, force, kNothing, 1e-3);
      most = std::max(most, std::abs(body.centre_m[0]));
    }
    return most;
  };
  CHECK(farthest(1) < 2e-6);
  CHECK(farthest(1.99) < 2e-5);
  CHECK(farthest(2.01) >= 1);

  const fdcg_body body = made(weightless(), {0, 0, 0}, {0, 0, 0});  // 1 kg, 0.004 kg m^2
  CHECK(fdcg_body_get_substeps(&body, 1000, 0, 1e-3) == 1);
  CHECK(fdcg_body_get_substeps(&body, 1e6, 0, 1e-3) == 1);
  CHECK(fdcg_body_get_substeps(&body, 4.1e6, 0, 1e-3) == 3);
  CHECK(fdcg_body_get_substeps(&body, 1e6, 0.2, 1e-3) == 4);  // sqrt(1 + 0.04 / 0.004) = 3.3
  CHECK(fdcg_body_get_substeps(&body, 1e12, 0, 1e-3) == 0);
  CHECK(fdcg_body_get_substeps(&body, std::nan(""), 0, 1e-3) == 0);
}

TEST_CASE("a body at rest falls asleep, does not move by a bit, and wakes when the force changes") {
  fdcg_body_config config = lopsided();
  config.gravity_m_per_s2[2] = -10;
  config.sleep_after_s = 0.1;
  const double held[3] = {0, 0, 4};
  fdcg_body body = made(config, {0, 0, 0}, {0, 0, 0});
  for (int tick = 0; tick < 99; ++tick)
    fdcg_body_step(&body, held, kNothing, 1e-3);
  CHECK(body.is_asleep == 0);
  for (int tick = 0; tick < 3; ++tick)
    fdcg_body_step(&body, held, kNothing, 1e-3);
  REQUIRE(body.is_asleep == 1);
  const fdcg_body asleep = body;
  const double nearly[3] = {0, 0, 4 + 1e-4};
  for (int tick = 0; tick < 1000; ++tick)
    fdcg_body_step(&body, nearly, kNothing, 1e-3);
  CHECK(std::memcmp(&body, &asleep, sizeof body) == 0);
  const double torque[3] = {1e-3, 0, 0};
  fdcg_body twisted = body;
  fdcg_body_step(&twisted, held, torque, 1e-3);
  CHECK(twisted.is_asleep == 0);
  CHECK(twisted.angular_momentum[0] > 0);
  fdcg_body_step(&body, kNothing, kNothing, 1e-3);
  CHECK(body.is_asleep == 0);
  CHECK(body.velocity_m_per_s[2] < 0);

  fdcg_body thrown = made(config, {0, 0, 0.5}, {0, 0, 0});  // hangs still for no longer than a moment at the top
  for (int tick = 0; tick < 200; ++tick)
    fdcg_body_step(&thrown, kNothing, kNothing, 1e-3);
  CHECK(thrown.is_asleep == 0);
}

TEST_CASE("a step with NaN or infinity moves nothing and is counted") {
  fdcg_body body = made(lopsided(), {1, 0, 0}, {1, 2, 3});
  fdcg_body before = body;
  const double nan[3] = {0, std::nan(""), 0}, huge[3] = {0, 0, 1e300};
  fdcg_body_step(&body, nan, kNothing, 1e-3);
  fdcg_body_step(&body, kNothing, huge, 1e-3);
  fdcg_body_step(&body, kNothing, kNothing, 0);
  fdcg_body_step(&body, kNothing, kNothing, std::nan(""));
  CHECK(body.refused_steps == 4);
  before.refused_steps = 4;
  CHECK(std::memcmp(&body, &before, sizeof body) == 0);
}

TEST_CASE("a body that rotates too fast for its step keeps its momentum and unit quaternion") {
  fdcg_body body = made(lopsided(), {0, 0, 0}, {1e6, -3e5, 2e5});
  const Triple momentum = triple(body.angular_momentum);
  for (int tick = 0; tick < 1000; ++tick)
    fdcg_body_step(&body, kNothing, kNothing, 0.1);
  CHECK(triple(body.angular_momentum) == momentum);
  double square = 0;
  for (const double q : body.rotation_xyzw)
    square += q * q;
  CHECK(std::abs(square - 1) < 1e-14);
}

TEST_CASE("invalid bodies are refused with field, value and limit") {
  CHECK(refusal([](auto& config, auto&) { config.mass_kg = 0; }).find("config.mass_kg is 0, allowed 1e-12 to 1e12") == 0);
  CHECK(refusal([](auto& config, auto&) { config.mass_kg = std::nan(""); }).find("config.mass_kg") == 0);
  CHECK(refusal([](auto& config, auto&) { config.linear_damping_per_s = -1; }).find("linear_damping_per_s") !=
        std::string::npos);
  CHECK(refusal([](auto& config, auto&) { config.inertia_kg_m2[1] = 1; }).find("no solid's") != std::string::npos);
  CHECK(refusal([](auto& config, auto&) { config.inertia_kg_m2[4] = 0.005; }).find("no solid's") != std::string::npos);
  CHECK(refusal([](auto&, auto& pose) { pose.rotation_xyzw[0] = 1; }).find("rotation_xyzw") != std::string::npos);
  CHECK(refusal([](auto&, auto& pose) { pose.scale = 0; }).find("pose.scale is 0") == 0);
  CHECK(refusal([](auto& config, auto&) { config.struct_bytes += 8; }).find("struct_bytes") != std::string::npos);
  CHECK(refusal([](auto& config, auto&) { config.gravity_m_per_s2[1] = HUGE_VAL; }) ==
        "config.gravity_m_per_s2[1] is infinite, allowed -1e6 to 1e6");
  CHECK(refusal([](auto&, auto& pose) { pose.translation_m[2] = 2e12; }) ==
        "pose.translation_m[2] is 2e12, allowed -1e12 to 1e12");
  CHECK(refusal([](auto& config, auto&) { config.reserved = 7; }).find("config.reserved is 7, allowed 0 to 0") == 0);
  CHECK(refusal([](auto&, auto& pose) { pose.rotation_xyzw[3] = 2; }) ==
        "pose.rotation_xyzw's length is 2, allowed 0.999 to 1.001");
}

TEST_CASE("mass from a file becomes a body's, by density, by mass and by scale") {
  fdcg_mass mass{};
  mass.volume_m3 = 2;
  mass.centroid_m[1] = 0.5;
  for (int k = 0; k < 3; ++k)
    mass.inertia_per_density_m5[k] = 0.25;
  fdcg_body_config config = fdcg_make_body_config();
  fdcg_error error = {};
  CHECK(fdcg_body_set_mass(&config, &mass, 0, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("--density") != std::string::npos);
  REQUIRE(fdcg_body_set_mass(&config, &mass, 10, 2, &error) == FDCG_OK);
  CHECK(config.mass_kg == 160);
  CHECK(config.inertia_kg_m2[0] == 80);
  CHECK(config.centre_m[1] == 0.5);
  mass.density_kg_per_m3 = 3, mass.mass_kg = 6;
  REQUIRE(fdcg_body_set_mass(&config, &mass, 0, 1, &error) == FDCG_OK);
  CHECK(config.mass_kg == 6);

  const fdcg_body_config before = config;
  const struct {
    std::function<void(fdcg_mass&)> spoil;
    double density;
    const char* words;
  } refused[] = {
      {[](fdcg_mass& m) { m = {}; }, 1000, "the body's mass_kg is 0, allowed 1e-12 to 1e12; check the density, the scale"},
      {[](fdcg_mass& m) { m.volume_m3 = std::nan(""); }, 1000, "the body's mass_kg is NaN"},
      {[](fdcg_mass& m) { m.mass_kg = -1; }, 0, "the body's mass_kg is -1"},
      {[](fdcg_mass& m) { m.density_kg_per_m3 = std::nan(""); }, 0, "the body's inertia_kg_m2[0] is NaN"},
      {[](fdcg_mass& m) { m.centroid_m[2] = std::nan(""); }, 1000, "the body's centre_m[2] is NaN"},
      {[](fdcg_mass& m) { m.inertia_per_density_m5[1] = HUGE_VAL; }, 1000, "the body's inertia_kg_m2[1] is infinite"},
      {[](fdcg_mass& m) { m.inertia_per_density_m5[5] = std::nan(""); }, 1000, "the body's inertia_kg_m2 is no solid's"},
      {[](fdcg_mass& m) { m.inertia_per_density_m5[0] = 9; }, 1000, "the body's inertia_kg_m2 is no solid's"},
  };
  for (const auto& one : refused) {
    fdcg_mass spoilt = mass;
    one.spoil(spoilt);
    CHECK(fdcg_body_set_mass(&config, &spoilt, one.density, 1, &error) == FDCG_E_ARGUMENT);
    CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring(one.words));
    CHECK(std::memcmp(&config, &before, sizeof config) == 0);
  }

  fdcg_pose pose = {{0, 0, std::sqrt(0.5), std::sqrt(0.5)}, {1, 2, 3}, 2};  // a quarter turn about z
  fdcg_body body;
  REQUIRE(fdcg_body_init(&body, &config, &pose, &error) == FDCG_OK);
  CHECK(body.centre_m[0] == Approx(0).margin(1e-15));
  CHECK(body.centre_m[1] == Approx(2));
  const fdcg_pose back = fdcg_body_get_pose(&body);
  for (int k = 0; k < 3; ++k)
    CHECK(back.translation_m[k] == Approx(pose.translation_m[k]));
}
