// SPDX-License-Identifier: Apache-2.0
// Materials of two bodies in contact: of faces, on edges and corners too; and the friction curve on the ground.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kGravity = 9.80665, kMass_kg = 0.05;
const fdcg_material kOwn = {0.64, 0.49, 4000};  // of the body
// Rubber and ice; the default material, not used by these tests, has no friction.
const fdcg_material kTable[2] = {{0.9, 0.8, 2000}, {0.2, 0.1, 800}};

double coefficient(double a, double b) {
  return std::sqrt(a * b);
}
double stiffness(const fdcg_material& a, const fdcg_material& b) {
  return 1 / (1 / a.stiffness_n_per_m + 1 / b.stiffness_n_per_m);
}

fdcg_params with_table() {
  fdcg_params params = friction(0, 0, 5000);
  params.friction_flags = FDCG_FRICTION_MATERIALS;
  params.materials = kTable;
  params.material_count = 2;
  return params;
}

// Each face's material by its middle.
template <class Choose>
bake::PolygonSoup painted(bake::PolygonSoup soup, Choose choose) {
  soup.materials = {"rubber", "ice"};
  for (std::size_t f = 0; f + 1 < soup.face_first.size(); ++f) {
    Place middle = {0, 0, 0};
    const std::uint32_t first = soup.face_first[f], count = soup.face_first[f + 1] - first;
    for (std::uint32_t c = first; c < first + count; ++c) {
      const bake::Vec3& p = soup.points[soup.corners[c]];
      middle = middle + Place{p.x, p.y, p.z} * (1.0 / count);
    }
    soup.face_material.push_back(choose(middle) ? std::uint16_t{0} : std::uint16_t{1});
  }
  return soup;
}

// A body that touches with its centre alone, so nothing turns it, above a solid that stays.
class Bead {
 public:
  Bead(const bake::PolygonSoup& solid, const Place& at) {
    rig_.add_fixed(rig_.shape(solid), with_table(), fdcg_make_identity_pose());
    fdcg_body_config config = fdcg_make_body_config();
    config.sleep_after_s = 0;
    rig_.add_body(rig_.box(0.02, 0.02, 0.02), kMass_kg, friction(kOwn.mu_static, kOwn.mu_dynamic, kOwn.stiffness_n_per_m),
                  posed(at), config, 8);
    const double centre[1][3] = {{0, 0, 0}};
    fdcg_error error;
    REQUIRE(fdcg_pile_add(rig_.pile(), rig_.scene().get(), rig_.object(0), centre, 1, &error) == FDCG_OK);
  }
  void pull(const Place& acceleration) {
    for (std::size_t k = 0; k < 3; ++k)
      rig_.body(0).config.gravity_m_per_s2[k] = acceleration[k];
  }
  void pull_slowly(const Place& from, const Place& to) {
    constexpr int kTicks = 20000;
    for (int tick = 1; tick <= kTicks; ++tick) {
      const double x = tick / double{kTicks}, share = x * x * x * (10 + x * (6 * x - 15));  // no swing, no damper that pulls
      pull(from + (to - from) * share);
      rig_.tick();
    }
  }
  void push(const Place& speed) {
    const double none[3] = {0, 0, 0};
    fdcg_error error;
    REQUIRE(fdcg_body_set_motion(&rig_.body(0), speed.data(), none, &error) == FDCG_OK);
  }
  void ticks(int count) { rig_.ticks(count); }
  [[nodiscard]] fdcg_pile_touch touch() const {
    const auto touches = rig_.touches();
    REQUIRE(touches.size() == 1);
    return touches[0];
  }
  [[nodiscard]] double speed() const { return norm(rig_.velocity(0)); }
  [[nodiscard]] PileRig& rig() { return rig_; }

 private:
  PileRig rig_;
};

}  // namespace

TEST_CASE("a body in a groove of two materials is held by both, weighted by load, and its oscillation decays") {
  constexpr double kOpening = 1.3;
  const bake::PolygonSoup groove = painted(v_groove(kOpening), [](const Place& middle) { return middle[1] < 0; });
  for (const double lean : {-0.4, 0.0, 0.25}) {
    // the pull is left n_left + right n_right, of the normals (+-cos half, sin half) in the y-z plane
    const double half = kOpening / 2, both = std::cos(lean) / std::sin(half), more = -std::sin(lean) / std::cos(half);
    const double left = (both + more) / 2, right = (both - more) / 2;
    const double holds = kGravity * (left * coefficient(0.9, 0.64) + right * coefficient(0.2, 0.64));
    for (const double share : {0.999, 1.001}) {
      Bead bead(groove, {0, 0, 0.001});
      bead.ticks(600);
      const Place down = {0, kGravity * std::sin(lean), -kGravity * std::cos(lean)};
      bead.pull_slowly({0, 0, -kGravity}, down);
      bead.pull_slowly(down, down + Place{holds * share, 0, 0});
      CAPTURE(lean, share, bead.speed());
      bead.ticks(600);
      CHECK((bead.speed() < 1e-6) == (share < 1));
      CHECK((bead.speed() > 1e-2) == (share > 1));
      if (share > 1) continue;
      CHECK(bead.touch().state == FDCG_EDGE);
      CHECK(bead.touch().stiffness_n_per_m == Approx(stiffness(kTable[1], kOwn)));  // of the softer one
    }
    Bead bead(groove, {0, 0, 0.001});
    bead.ticks(600);
    bead.push({0.005, 0, 0});  // not so fast that it would slip
    bead.ticks(30);
    CHECK(bead.touch().slipping == 0);
    bead.ticks(300);
    CHECK(bead.speed() < 1e-6);
  }
}

TEST_CASE("at a corner of faces with materials, their materials apply") {
  // the pit's corner upwards: its three faces look along +x, +y, +z
  const bake::PolygonSoup pit = painted(corner_pit(), [](const Place& middle) { return middle[2] < 0; });
  Bead bead(pit, {0.002, 0.002, 0.002});
  bead.pull({-6, -6, -6});
  bead.ticks(800);
  CHECK(bead.touch().state == FDCG_VERTEX);
  const double found = bead.touch().stiffness_n_per_m;
  const bool is_of_either = found == Approx(stiffness(kTable[0], kOwn)) || found == Approx(stiffness(kTable[1], kOwn));
  CHECK(is_of_either);
  bead.push({0.002, -0.002, 0});
  bead.ticks(300);
  CHECK(bead.speed() < 1e-6);
}

TEST_CASE("sliding onto another material uses its friction and stiffness and gains no energy") {
  for (const bool begins_on_ice : {false, true}) {
    const bake::PolygonSoup floor = painted(moved(grid_box(2, 1, 1, {2, 1, 0.1}), {0, 0, -0.05}),
                                            [begins_on_ice](const Place& middle) { return (middle[0] < 0) != begins_on_ice; });
    const fdcg_material &first = kTable[begins_on_ice ? 1 : 0], &second = kTable[begins_on_ice ? 0 : 1];
    Bead bead(floor, {-0.05, 0, 0.001});
    bead.ticks(600);
    CHECK(bead.touch().stiffness_n_per_m == Approx(stiffness(first, kOwn)));
    bead.push({1.5, 0, 0});
    const auto energy = [&] {
      return fdcg_body_get_kinetic_energy_j(&bead.rig().body(0)) + kMass_kg * kGravity * bead.rig().centre(0)[2];
    };
    const double first_energy = energy();
    double most = 0;
    for (int tick = 0; tick < 150; ++tick) {
      bead.ticks(1);
      most = std::max(most, energy());
    }
    CHECK(most < first_energy);
    CAPTURE(begins_on_ice, bead.rig().centre(0)[0], bead.speed());
    REQUIRE(bead.rig().centre(0)[0] > 0.01);
    CHECK(bead.touch().stiffness_n_per_m == Approx(stiffness(second, kOwn)));
    const double before = bead.speed();
    bead.ticks(20);
    CHECK((before - bead.speed()) / 0.02 == Approx(kGravity * coefficient(second.mu_dynamic, kOwn.mu_dynamic)).epsilon(0.02));
  }
}

TEST_CASE("the ground has no faces: a table of materials is not kept, and changes no bit") {
  std::vector<Place> ends;
  for (const bool has_table : {false, true}) {
    PileRig rig;
    fdcg_params params = friction(0.5, 0.4);
    {
      std::vector<fdcg_material> table = {{0.1, 0.1, 100}};
      if (has_table) {
        params.friction_flags = FDCG_FRICTION_MATERIALS | FDCG_FRICTION_PRESLIDING | FDCG_FRICTION_FINGER;
        params.materials = table.data();
        params.material_count = 1;
      }
      rig.ground({0, 0, 1}, 0, params);
      const std::uint64_t address = reinterpret_cast<std::uintptr_t>(table.data());
      CHECK(std::count(rig.memory().begin(), rig.memory().end(), address) == 0);
      table[0] = {NAN, NAN, NAN};
    }
    rig.add_body(rig.box(0.08, 0.08, 0.01), kMass_kg, friction(0.5, 0.4), posed({0, 0, 0.006}));
    const double speed[3] = {0.4, 0.1, 0}, spin[3] = {0, 0, 2};
    fdcg_error error;
    REQUIRE(fdcg_body_set_motion(&rig.body(0), speed, spin, &error) == FDCG_OK);
    rig.ticks(400);
    ends.push_back(rig.centre(0));
  }
  CHECK(ends[0] == ends[1]);
  CHECK(ends[0][0] > 0.01);
}

TEST_CASE("a block slides to rest on the ground as the friction curve has it") {
  struct Curve {
    std::uint32_t friction_flags;
    double stribeck_m_per_s, viscous_s_per_m, lag_s;
  };
  for (const Curve& curve :
       {Curve{FDCG_FRICTION_VISCOUS, 1, 0.3, 0}, Curve{FDCG_FRICTION_STRIBECK | FDCG_FRICTION_LAG, 0.1, 0, 0.02},
        Curve{FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG, 0.3, 0.2, 0.001}}) {
    for (const std::uint32_t substeps : {1U, 4U}) {
      constexpr double kStatic = 0.5, kDynamic = 0.3, kFirst = 1;
      fdcg_params params = friction(kStatic, kDynamic);
      params.friction_flags = curve.friction_flags;
      params.stribeck_m_per_s = curve.stribeck_m_per_s;
      params.viscous_s_per_m = curve.viscous_s_per_m;
      params.friction_lag_s = curve.lag_s;
      params.unique_solution_depth_m = 0.001;
      PileRig rig;
      rig.ground({0, 0, 1}, 0, params);
      fdcg_body_config config = fdcg_make_body_config();
      config.sleep_after_s = 0;
      rig.add_body(rig.box(0.08, 0.08, 0.01), kMass_kg, friction(kStatic, kDynamic), posed({0, 0, 0.005}), config, 8);
      rig.ticks(400, substeps);
      const double speed[3] = {kFirst, 0, 0}, spin[3] = {0, 0, 0};
      fdcg_error error;
      REQUIRE(fdcg_body_set_motion(&rig.body(0), speed, spin, &error) == FDCG_OK);
      rig.ticks(50, substeps);  // it pitches at first
      double expected = rig.velocity(0)[0], lagged = expected, worst = 0;
      for (int tick = 0; tick < 250 && expected > 0.1; ++tick) {
        for (int piece = 0; piece < 100; ++piece) {
          const double x = lagged / curve.stribeck_m_per_s;
          double mu = kDynamic;
          if ((curve.friction_flags & FDCG_FRICTION_STRIBECK) != 0) mu += (kStatic - kDynamic) / (1 + x * x);
          if ((curve.friction_flags & FDCG_FRICTION_VISCOUS) != 0) mu += curve.viscous_s_per_m * lagged;
          expected -= kGravity * mu * 1e-5;
          lagged += (curve.friction_flags & FDCG_FRICTION_LAG) != 0 ? (expected - lagged) * 1e-5 / (curve.lag_s + 1e-5)
                                                                    : expected - lagged;
        }
        rig.tick(substeps);
        worst = std::max(worst, std::abs(rig.velocity(0)[0] - expected));
      }
      CAPTURE(curve.friction_flags, substeps, worst);
      CHECK(worst < 0.01 * kFirst);
      rig.ticks(400, substeps);
      CHECK(norm(rig.velocity(0)) < 1e-6);
    }
  }
}
