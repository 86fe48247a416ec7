// SPDX-License-Identifier: Apache-2.0
// Force shading (contact-model SHADE-1 to SHADE-6) on bodies with normals at their corners.
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "band.hpp"
#include "catch.hpp"
#include "contact_rig.hpp"
#include "hip_loop.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "shaded_normal.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Normals;
using fdcg::bake::Precision;

namespace {

CompileOptions with_normals(Precision precision = Precision::f64) {
  CompileOptions options;
  options.normals = Normals::faces;
  options.precision = precision;
  return options;
}

fdcg_params shaded(double mu_static, double mu_dynamic) {
  fdcg_params params = contact_params(mu_static, mu_dynamic);
  params.friction_flags = FDCG_FRICTION_SHADING;
  return params;
}

Hip scaled(const Hip& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

// On a great circle through u and v (orthonormal), `depth_m` below a sphere of radius_m; from outside in the first 50 ticks.
struct Circle {
  Hip u, v;
  double radius_m, depth_m, way_m;  // a tick

  [[nodiscard]] Hip at(int tick) const {
    const double angle = tick * way_m / radius_m;
    const double radius = tick < 50 ? radius_m + 1e-3 - (depth_m + 1e-3) * tick / 50 : radius_m - depth_m;
    Hip hip;
    for (std::size_t c = 0; c < 3; ++c)
      hip[c] = radius * (u[c] * std::cos(angle) + v[c] * std::sin(angle));
    return hip;
  }
};

Circle circle(Random& random, double radius_m, double depth_m) {
  const Hip u = point_of(random.direction());
  Hip v = point_of(random.direction());
  const double along = dot(u, v);
  for (std::size_t c = 0; c < 3; ++c)
    v[c] -= along * u[c];
  return {u, scaled(v, 1 / norm(v)), radius_m, depth_m, 1e-4};
}

double angle_between(const Hip& a, const Hip& b) {
  const double cosine = dot(a, b) / (norm(a) * norm(b));
  return std::acos(std::min(1.0, cosine));
}

struct Slide {
  double worst_direction = 0, most_turn = 0;  // rad: of the force from the true normal, and from one tick to the next
  double vibration_n = 0;                     // RMS, 80 to 450 Hz
};

Slide slide_over_sphere(const fdcg_graph& graph, const fdcg_params& params, double radius_m, double depth_m) {
  Random random(3);
  Slide slide;
  double sum = 0;
  constexpr int kWays = 3;
  for (int way = 0; way < kWays; ++way) {
    const Circle path = circle(random, radius_m, depth_m);
    Contact contact(graph, params);
    std::array<std::vector<double>, 3> force;
    Hip last{};
    for (int tick = 0; tick < 1100; ++tick) {
      const Hip hip = path.at(tick);
      contact.step(hip);
      if (tick < 100) continue;
      const Hip f = contact.force();
      REQUIRE(norm(f) > 0);
      slide.worst_direction = std::max(slide.worst_direction, angle_between(f, hip));
      if (tick > 100) slide.most_turn = std::max(slide.most_turn, angle_between(f, last));
      for (std::size_t c = 0; c < 3; ++c)
        force[c].push_back(f[c]);
      last = f;
    }
    for (const std::vector<double>& component : force)
      sum += band_power(component, 1000, 80, 450);
  }
  slide.vibration_n = std::sqrt(sum / kWays);
  return slide;
}

// Down to one depth, along the surface, up from another: what a turned force that is not held would give work for.
std::vector<Hip> shallow_loop(Random& random, double size, int ticks) {
  const Hip out = point_of(random.direction()), side = point_of(random.direction());
  const double down = size * random.uniform(0.02, 0.3), up = size * random.uniform(0.02, 0.3),
               way = size * random.uniform(0.05, 0.5);
  std::vector<Hip> hips;
  for (int i = 0; i <= ticks; ++i) {
    const double a = i == ticks ? 0 : 2 * std::numbers::pi * i / ticks, s = std::sin(a);
    Hip hip;
    for (std::size_t c = 0; c < 3; ++c)
      hip[c] = out[c] * (1.6 * size - (0.6 * size + (2 * i < ticks ? down : up)) * s * s) + side[c] * way * (1 - std::cos(a));
    hips.push_back(hip);
  }
  return hips;
}

constexpr int kLoops = 6700;                       // of each of 15 cases: 100,500
constexpr double kRadius = 0.05, kDepth = 1.5e-3;  // 1.5 N

}  // namespace

TEST_CASE("shading takes the facets out of what is felt on a sphere") {
  double last_direction = 0;
  for (const int level : {2, 3, 4}) {
    const CompiledMesh mesh(scaled(ico_sphere(level), kRadius), with_normals());
    REQUIRE(mesh.view().normals != nullptr);
    const Slide facets = slide_over_sphere(mesh.view(), contact_params(0, 0), kRadius, kDepth);
    const Slide smooth = slide_over_sphere(mesh.view(), shaded(0, 0), kRadius, kDepth);
    INFO("level " << level << ": facets " << facets.vibration_n << " N, shaded " << smooth.vibration_n << " N, direction off "
                  << smooth.worst_direction << " rad, turn " << smooth.most_turn << " rad");
    CHECK(smooth.vibration_n <= 0.1 * facets.vibration_n);
    if (level > 2) CHECK(smooth.vibration_n <= 2e-3);
    CHECK(smooth.most_turn <= 1.2 * 1e-4 / kRadius);
    constexpr double kCode = 1e-4;  // of the normals in the file
    if (last_direction > 0) CHECK(smooth.worst_direction <= last_direction / 3 + kCode);
    last_direction = smooth.worst_direction;
  }
}

TEST_CASE("on convex and concave edges of a torus the force turns as the surface does") {
  const CompiledMesh mesh(scaled(torus(48, 24), kRadius), with_normals());
  const double tube = 0.4 * kRadius, inner = kRadius - (tube - kDepth);
  for (const bool is_around_tube : {true, false}) {  // else along the inner side, where all edges across the way are concave
    for (const double phase : {0.0, 0.013, 0.04, 0.7}) {
      Contact contact(mesh.view(), shaded(0, 0));
      Hip last{};
      double worst = 0;
      const double radius = is_around_tube ? tube : inner;
      for (int tick = -50; tick < static_cast<int>(2 * std::numbers::pi * radius / 1e-4); ++tick) {
        const double turn = std::max(tick, 0) * 1e-4 / radius, r = tube - kDepth - std::min(tick, 0) * 1e-4;
        const double a = is_around_tube ? turn + phase : std::numbers::pi + phase, b = is_around_tube ? phase : turn;
        contact.step({(kRadius + r * std::cos(a)) * std::cos(b), (kRadius + r * std::cos(a)) * std::sin(b), r * std::sin(a)});
        if (tick < 0) continue;
        REQUIRE(contact.result.state != FDCG_FREE);
        if (tick > 0) worst = std::max(worst, angle_between(contact.force(), last));
        last = contact.force();
      }
      INFO((is_around_tube ? "around the tube" : "inside") << ", phase " << phase << ": " << worst << " rad in 0.1 mm");
      CHECK(worst <= 1.2 * 1e-4 / radius);
    }
  }
}

TEST_CASE(
    "while it slips the ratio about the interpolated normal is the dynamic coefficient, and it breaks away at the static") {
  const CompiledMesh mesh(scaled(star_sphere(3, 0.15, 4), kRadius), with_normals());
  for (const auto& mu : std::array<std::array<double, 2>, 3>{{{0.3, 0.2}, {0.6, 0.4}, {1.2, 1.0}}}) {
    Random random(9);
    int slipping = 0, sticking = 0;
    double least_break = 1e9, most_stick = 0;
    for (int way = 0; way < 6; ++way) {
      const Circle path = circle(random, kRadius * 0.95, 0);
      Contact contact(mesh.view(), shaded(mu[0], mu[1]));
      bool was_slipping = false;
      for (int tick = 0; tick < 1500; ++tick) {
        const int there = tick % 400 < 300 ? tick % 400 : 600 - tick % 400;  // turns round, which makes it stick
        contact.step(path.at(50 + tick / 400 * 200 + there));
        const bool is_slipping = contact.result.slipping != 0;
        if (contact.result.state == FDCG_FACE && contact.result.flags == 0) {
          const Hip normal = shaded_normal(mesh.view(), contact.result.feature, contact.god_object()), f = contact.force();
          const double load = dot(f, normal), ratio = std::sqrt(std::max(0.0, dot(f, f) - load * load)) / load;
          INFO("mu " << mu[0] << " " << mu[1] << " way " << way << " tick " << tick << ": " << contact.describe());
          if (is_slipping) REQUIRE(std::fabs(ratio - mu[1]) <= 1e-9);
          if (!is_slipping) REQUIRE(ratio <= mu[0] * (1 + 1e-9));
          slipping += is_slipping;
          sticking += !is_slipping;
          if (!is_slipping) most_stick = std::max(most_stick, ratio);
          if (is_slipping && !was_slipping) least_break = std::min(least_break, ratio);
        }
        was_slipping = is_slipping;
      }
    }
    CHECK(slipping > 1000);
    CHECK(sticking > 50);
    CHECK(most_stick > 0.9 * mu[0]);  // it holds up to the static coefficient
    CHECK(std::fabs(least_break - mu[1]) <= 1e-9);
  }
}

TEST_CASE("planes that are derived in the step leave every bit of a shaded slide") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    CompileOptions stored = with_normals(precision), derived = stored;
    derived.store_planes = false;
    const CompiledMesh with(scaled(ico_sphere(3), kRadius), stored), without(scaled(ico_sphere(3), kRadius), derived);
    for (const double mu : {0.0, 0.4}) {
      Random random(5);
      std::uint32_t crossed = 0;
      for (int way = 0; way < 20; ++way) {
        const Circle path = circle(random, kRadius, kDepth);
        Contact one(with.view(), shaded(1.2 * mu, mu)), other(without.view(), shaded(1.2 * mu, mu));
        for (int tick = 0; tick < 500; ++tick) {
          const fdcg_result expected = one.step(path.at(tick)), got = other.step(path.at(tick));
          REQUIRE(std::memcmp(&expected, &got, sizeof got) == 0);
          crossed += got.transitions;
        }
      }
      CHECK(crossed > 200);
    }
  }
}

TEST_CASE("a shaded contact at rest does not change by a bit") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const CompiledMesh mesh(scaled(star_sphere(2, 0.2, 7), kRadius), with_normals(precision));
    Random random(21);
    for (int place = 0; place < 40; ++place) {
      const double mu = place % 4 * 0.3;
      Contact contact(mesh.view(), shaded(1.5 * mu, mu));
      const Circle path = circle(random, kRadius, 1e-3 * (1 + place % 5));
      for (int tick = 0; tick < 200 + 7 * place; ++tick)
        contact.step(path.at(tick));
      const Hip hip = path.at(200 + 7 * place);
      for (int settle = 0; settle < 20; ++settle)
        contact.step(hip);
      const fdcg_contact at_rest = contact.state;
      const fdcg_result felt = contact.result;
      const int ticks = place == 1 ? 1'000'000 : 5'000;
      for (int tick = 0; tick < ticks; ++tick)
        contact.step(hip);
      INFO("place " << place << " mu " << mu << ": " << contact.describe());
      CHECK(std::memcmp(at_rest.god_object, contact.state.god_object, sizeof at_rest.god_object) == 0);
      CHECK(std::memcmp(felt.force_n, contact.result.force_n, sizeof felt.force_n) == 0);
    }
  }
}

// A mass of 0.1 kg with a damper, pushed against a sphere and held over one place by a weak spring; its force is held for a
// tick. Whether it comes to rest.
static bool comes_to_rest(const fdcg_graph& graph, fdcg_params params, const Hip& out, double damping_n_s_per_m) {
  constexpr double kMass_kg = 0.1, kPush_n = 1.5, kTether_n_per_m = 30;
  constexpr int kSubsteps = 16;
  Contact contact(graph, params);
  Hip x = scaled(out, kRadius * 1.01), v{};
  double early = 0, late = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    contact.step(x);
    const Hip force = contact.force();
    for (int substep = 0; substep < kSubsteps; ++substep) {
      const double along = dot(x, out);
      for (std::size_t c = 0; c < 3; ++c) {
        const double f = force[c] - damping_n_s_per_m * v[c] - kPush_n * out[c] - kTether_n_per_m * (x[c] - along * out[c]);
        v[c] += f / kMass_kg * (1e-3 / kSubsteps);
        x[c] += v[c] * (1e-3 / kSubsteps);
      }
    }
    if (!(dot(v, v) < 1e4)) return false;
    if (tick >= 1000) (tick < 2000 ? early : late) = std::max(tick < 2000 ? early : late, dot(v, v));
  }
  return late < 1e-6 || late < 0.8 * early;
}

static double stable_stiffness(const fdcg_graph& graph, fdcg_params params, const Hip& out, double damping_n_s_per_m) {
  double low = 100, high = 40000;
  for (int halving = 0; halving < 10; ++halving) {
    params.stiffness_n_per_m = std::sqrt(low * high);
    (comes_to_rest(graph, params, out, damping_n_s_per_m) ? low : high) = params.stiffness_n_per_m;
  }
  return low;
}

TEST_CASE("a simulated hand bears as much stiffness with shading as without") {
  const CompiledMesh mesh(scaled(ico_sphere(2), kRadius), with_normals());
  Random random(17);
  for (int place = 0; place < 6; ++place) {
    const Hip out = point_of(random.direction());
    const double mu = place % 2 * 0.3, damping = place % 3 == 0 ? 3 : 1;
    const double facets = stable_stiffness(mesh.view(), contact_params(mu, mu), out, damping);
    const double smooth = stable_stiffness(mesh.view(), shaded(mu, mu), out, damping);
    INFO("place " << place << ": facets " << facets << " N/m, shaded " << smooth << " N/m");
    CHECK(smooth >= 0.9 * facets);
  }
}

TEST_CASE("a closed loop over a shaded body gives no more work than the sampling's term") {
  const PolygonSoup bodies[] = {ico_sphere(1), star_sphere(2, 0.3, 8), torus(16, 8), prism(24), spiky_sphere(2, 0.3, 2)};
  constexpr double kMu[3][2] = {{0, 0}, {0.3, 0.2}, {1, 1}};
  for (const PolygonSoup& soup : bodies) {
    CompileOptions options = with_normals();
    options.crease_rad = 1.2;
    const CompiledMesh mesh(soup, options);
    REQUIRE(mesh.view().normals != nullptr);
    for (const auto& mu : kMu) {
      Random random(5);
      int closed = 0;
      for (int loop = 0; loop < kLoops; ++loop) {
        const std::vector<Hip> hips =
            loop % 2 == 0 ? elliptic_loop(random, extent(soup), 200) : shallow_loop(random, extent(soup), 200);
        const LoopAccount account = account_of(mesh.view(), shaded(mu[0], mu[1]), hips);
        INFO(soup.name << " mu " << mu[0] << ", loop " << loop);
        REQUIRE(account.work_j <= account.bound_j * (1 + 1e-9) + account.rounding_j);
        closed += account.is_closed && account.has_touched();
      }
      INFO(soup.name << " mu " << mu[0]);
      CHECK(closed >= kLoops / 20);
    }
  }
}
