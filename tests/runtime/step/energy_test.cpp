// SPDX-License-Identifier: Apache-2.0
// Passivity: at a fixed HIP the spring energy never rises, a closed loop gives the user no more energy than sampling allows,
// and a contact at rest does not change by a bit.
#include <limits>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "hip_loop.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

std::vector<PolygonSoup> bodies() {
  const Rotation tilt = random_rotation(31);
  return {cube(),
          transformed(triangulated(corner_pit()), tilt),
          v_groove(1.2),
          cone_pit(12),
          saddle_block(),
          star_sphere(2, 0.3, 8),
          spiky_sphere(2, 1, 2),
          thin_plate(1e-3)};
}
constexpr double kMu[4][2] = {{0, 0}, {0.3, 0.2}, {1, 1}, {2, 1}};

}  // namespace

TEST_CASE("at a fixed HIP the stored energy never rises and the contact comes to rest") {
  const double eps = std::numeric_limits<double>::epsilon();
  for (const PolygonSoup& soup : bodies()) {
    const PlainGraph graph(soup, Precision::f64);
    for (const auto& mu : kMu) {
      Contact contact(graph.view(), contact_params(mu[0], mu[1]));
      HipWalk walk(soup, 77);
      for (int i = 0; i < 1500; ++i) {
        const Hip hip = walk.next(contact.god_object());
        contact.step(hip);
        double before = distance(contact.god_object(), hip);
        for (int hold = 0; hold < 4; ++hold) {
          contact.step(hip);
          const double now = distance(contact.god_object(), hip);
          INFO(soup.name << " mu " << mu[0] << ", step " << i << ": " << contact.describe());
          REQUIRE(now <= before + 16 * eps * extent(soup));
          before = now;
        }
      }
    }
  }
}

TEST_CASE("a closed loop of HIP gives no more work than the sampling's term") {
  for (const PolygonSoup& soup : bodies()) {
    const PlainGraph graph(soup, Precision::f64);
    for (const auto& mu : kMu) {
      Random random(5);
      int closed = 0;
      for (int loop = 0; loop < 60; ++loop) {
        const std::vector<Hip> hips = elliptic_loop(random, extent(soup), 400);
        const LoopAccount account = account_of(graph.view(), contact_params(mu[0], mu[1]), hips);
        INFO(soup.name << " mu " << mu[0] << ", loop " << loop);
        // Where friction or a spike still holds the god-object, what the spring stores was not given back.
        REQUIRE(account.work_j <= account.bound_j * (1 + 1e-9));
        closed += account.is_closed && account.has_touched();
      }
      INFO(soup.name << " mu " << mu[0]);
      CHECK(closed >= 5);
    }
  }
}

// Straight down into a plane by n steps of d / n and straight up again: on the way up the hand gets k d^2 / 2 (1 + 1 / n) back,
// for k d^2 / 2 (1 - 1 / n) that it gave.
TEST_CASE("the energy balance of a press and release equals the analytic one") {
  const PlainGraph graph(scaled(plane_quad(), 2), Precision::f64);
  fdcg_params params = contact_params(0, 0);
  params.stiffness_n_per_m = 800;
  const double d = 0.125;
  const int n = 16;
  std::vector<Hip> hips = {{0, 0, 1}, {0, 0, 0}};
  for (int i = 1; i <= 2 * n; ++i)
    hips.push_back({0, 0, -d * (i <= n ? i : 2 * n - i) / n});
  hips.push_back({0, 0, 1});
  const LoopAccount account = account_of(graph.view(), params, hips);
  const double stored = 800 * d * d / 2;
  CHECK(account.is_closed);
  CHECK(account.work_j == Approx(stored * 2 / n).epsilon(1e-12));
  // 2 n - 1 intervals begin in contact, the first contact is d / n deep
  CHECK(account.bound_j == Approx(stored * (2 * n - 1 + 1) / n / n).epsilon(1e-12));
  CHECK(account.contact_ticks == 2 * n - 1);
}

TEST_CASE("a contact at rest is still to the last bit over 100,000 ticks") {
  for (const PolygonSoup& soup : bodies()) {
    const PlainGraph graph(soup, Precision::f64);
    for (const auto& mu : kMu) {
      Contact contact(graph.view(), contact_params(mu[0], mu[1]));
      HipWalk walk(soup, 19);
      int held = 0;
      for (int i = 0; i < 3000 && held < 3; ++i) {
        const Hip hip = walk.next(contact.god_object());
        contact.step(hip);
        if (contact.result.state == FDCG_FREE || i % 40 != 0) continue;
        ++held;
        // Two ticks to settle: GO may stop on the circle it slipped to.
        contact.step(hip);
        contact.step(hip);
        const fdcg_result still = contact.result;
        const int ticks = held == 1 ? 100000 : 1000;
        for (int tick = 0; tick < ticks; ++tick) {
          contact.step(hip);
          const bool is_same = contact.result.god_object_m[0] == still.god_object_m[0] &&
                               contact.result.god_object_m[1] == still.god_object_m[1] &&
                               contact.result.god_object_m[2] == still.god_object_m[2] && contact.result.state == still.state &&
                               contact.result.feature == still.feature && contact.result.slipping == still.slipping;
          if (is_same) continue;
          INFO(soup.name << " mu " << mu[0] << ", tick " << tick << ": " << contact.describe());
          REQUIRE(is_same);
        }
      }
      CHECK(held == 3);
    }
  }
}
