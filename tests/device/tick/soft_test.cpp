// SPDX-License-Identifier: Apache-2.0
// Soft sheets: the distribution of a load, and passivity (a hand gains no work).
#include "tick/soft.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::dev;
using namespace fdcg::test;

namespace {

// Corners and edges of a soup; all places in metres.
struct Mesh {
  CornerNeighbours corners;
  std::vector<double> place_m;

  explicit Mesh(const bake::PolygonSoup& soup) {
    std::vector<std::vector<std::uint32_t>> beside(soup.points.size());
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
      if (std::find(beside[a].begin(), beside[a].end(), b) == beside[a].end()) beside[a].push_back(b);
    };
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      const Polygon face = face_corners(soup, f);
      for (std::size_t i = 0; i < face.size(); ++i) {
        const std::uint32_t a = face[i], b = face[(i + 1) % face.size()];
        join(a, b);
        join(b, a);
      }
    }
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
      corners.neighbour.insert(corners.neighbour.end(), beside[v].begin(), beside[v].end());
      corners.first.push_back(static_cast<std::uint32_t>(corners.neighbour.size()));
      place_m.insert(place_m.end(), {soup.points[v].x, soup.points[v].y, soup.points[v].z});
    }
  }
  [[nodiscard]] std::uint32_t nearest(double x, double y) const {
    std::uint32_t best = 0;
    for (std::uint32_t c = 0; c < corners.count(); ++c)
      if (distance(c, x, y) < distance(best, x, y)) best = c;
    return best;
  }
  [[nodiscard]] double distance(std::uint32_t c, double x, double y) const {
    return std::hypot(place_m[3 * std::size_t{c}] - x, place_m[3 * std::size_t{c} + 1] - y);
  }
};

std::vector<double> shares(SoftLoad& load, const Mesh& mesh, std::uint32_t corner) {
  const double unit[3] = {0, 0, 1};
  load.press(corner, unit, 1);
  load.spread();
  std::vector<double> share;
  for (std::uint32_t c = 0; c < mesh.corners.count(); ++c)
    share.push_back(load.force_n(c)[2]);
  load.clear();
  return share;
}

// A sheet of 1 m in a scene with fingers.
struct Rig {
  bake::Compiled compiled;
  fdcg_graph graph;
  SoftObject sheet;
  SceneRig scene;
  fdcg_params params = fdcg_make_params();
  std::vector<fdcg_finger_id> fingers;
  fdcg_object_id object;

  static bake::CompileOptions triangles() {
    bake::CompileOptions options;
    options.triangles = true;
    return options;
  }
  static fdcg_scene_config config() {
    fdcg_scene_config config = fdcg_make_scene_config();
    config.has_deforms = 1;
    return config;
  }
  Rig(int n, const SoftConfig& soft, double mu, const fdcg_pose& pose = fdcg_make_identity_pose())
      : compiled(compile_whole(plane_grid(n, n), triangles())), scene(config()) {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    REQUIRE(sheet.begin(graph, soft, pose) == "");
    params.mu_static = params.mu_dynamic = mu;
    REQUIRE(fdcg_scene_add_deform(scene.get(), sheet.deform(), &params, &pose, &object, &error) == FDCG_OK);
  }
  ~Rig() { fdcg_close(&graph); }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  void step() {
    scene.step();
    for (const fdcg_finger_id finger : fingers) {
      const fdcg_finger_result felt = scene.result(finger);
      for (std::uint32_t t = 0; t < felt.touch_count; ++t)
        sheet.press(felt.touches[t]);
    }
    sheet.relax(0.001);
  }
  // The largest slope of the sheet.
  double steepest() {
    const fdcg_graph& now = *fdcg_deform_get_graph(sheet.deform());
    double least = 1;
    for (std::uint32_t n = 0; n < now.header->node_count; ++n)
      least = std::min(least, fdcg_get_node(&now, n).normal[2]);
    return std::tan(std::acos(least));
  }
};

}  // namespace

TEST_CASE("spread load: shares sum to one, are not negative, and extend to the radius") {
  for (const bake::PolygonSoup& soup : {plane_grid(24, 24), plane_jittered(24, 3), geodesic_sphere(12)}) {
    const Mesh mesh(soup);
    SoftLoad load;
    for (const double radius_m : {0.0, 0.02, 0.08, 0.15}) {
      INFO(soup.name << " radius " << radius_m);
      REQUIRE(load.begin(mesh.corners, mesh.place_m, 1, radius_m) == "");
      const std::uint32_t middle = mesh.nearest(0.01, 0.02);
      const std::vector<double> share = shares(load, mesh, middle);
      CHECK(std::accumulate(share.begin(), share.end(), 0.0) == Approx(1).epsilon(1e-13));
      CHECK(*std::min_element(share.begin(), share.end()) >= 0);
      double square = 0;
      for (std::uint32_t c = 0; c < mesh.corners.count(); ++c) {
        double apart = 0;
        for (std::size_t k = 0; k < 3; ++k)
          apart += std::pow(mesh.place_m[3 * std::size_t{c} + k] - mesh.place_m[3 * std::size_t{middle} + k], 2);
        square += share[c] * apart;
      }
      // below an edge's length, four edges of a corner or eight make more of a difference
      CHECK(std::sqrt(square) == Approx(radius_m).epsilon(radius_m < 0.05 ? 0.35 : 0.15));
      CHECK(shares(load, mesh, middle) == share);  // nothing is left of the load before
    }
  }
}

TEST_CASE("spread load: the shares are symmetric with a positive diagonal") {
  for (const bake::PolygonSoup& soup : {plane_jittered(12, 8), ico_sphere(2), star_sphere(2, 0.3, 1)}) {
    const Mesh mesh(soup);
    SoftLoad load;
    REQUIRE(load.begin(mesh.corners, mesh.place_m, 1, std::nullopt) == "");
    const std::uint32_t count = mesh.corners.count();
    std::vector<std::vector<double>> share;
    for (std::uint32_t c = 0; c < count; ++c)
      share.push_back(shares(load, mesh, c));
    for (std::uint32_t a = 0; a < count; ++a)
      for (std::uint32_t b = 0; b < count; ++b)
        REQUIRE(std::fabs(share[a][b] - share[b][a]) < 1e-15);
    // of any load the work on the places that it goes to: never negative
    Random random(4);
    for (int i = 0; i < 200; ++i) {
      std::vector<double> push(count);
      for (double& x : push)
        x = random.uniform(-1, 1);
      double work = 0;
      for (std::uint32_t a = 0; a < count; ++a)
        for (std::uint32_t b = 0; b < count; ++b)
          work += push[a] * share[a][b] * push[b];
      REQUIRE(work > 0);
    }
  }
}

TEST_CASE("spread load: a radius too large for the mesh is refused with the limit") {
  const Mesh mesh(plane_grid(24, 24));
  SoftLoad load;
  const std::string problem = load.begin(mesh.corners, mesh.place_m, 0.1, 0.1);
  INFO(problem);
  CHECK(problem.find("radius_m is 0.1, and a load can be spread over 0.03") == 0);
  CHECK(problem.find("give a coarser mesh") != std::string::npos);
  REQUIRE(load.begin(mesh.corners, mesh.place_m, 0.1, std::nullopt) == "");
  CHECK(load.radius_m() == Approx(2 * 0.1 / 24 * (2 + std::sqrt(2.0)) / 3).epsilon(0.02));
  // where very many edges meet the standard radius takes what is allowed
  const Mesh fan(cone(1000));
  REQUIRE(load.begin(fan.corners, fan.place_m, 1, std::nullopt) == "");
  CHECK(load.radius_m() > 0);
}

TEST_CASE("soft sheet: a finger makes a wide dent, not a deep pit") {
  double steepest[2], deepest[2];
  for (const int spread : {0, 1}) {
    SoftConfig soft;
    if (spread == 0) soft.radius_m = 0;
    Rig rig(24, soft, 0.5);
    rig.fingers.push_back(rig.scene.add({0.02, 0.01, 0.1}));
    rig.step();
    for (int tick = 0; tick < 3000; ++tick) {
      rig.scene.move(rig.fingers[0], {0.02, 0.01, std::max(0.1 - 1e-4 * tick, -0.01)});
      rig.step();
    }
    CHECK(rig.scene.result(rig.fingers[0]).touch_count == 1);
    steepest[spread] = rig.steepest();
    deepest[spread] = rig.sheet.deepest_m();
  }
  WARN("steepest " << steepest[0] << " of a load on three corners, " << steepest[1] << " spread; dents " << deepest[0] << " m, "
                   << deepest[1] << " m");
  CHECK(steepest[1] < 0.5 * steepest[0]);
  CHECK(deepest[1] > 0.003);
}

TEST_CASE("soft sheet: wandering hands gain no work") {
  for (const double mu : {0.0, 0.4}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      SoftConfig soft;
      soft.stiffness_n_per_m = seed % 2 == 0 ? 5 : 300;
      soft.tension_n_per_m = seed % 3 == 0 ? 20 : 400;
      soft.damping_n_s_per_m = 3;  // three hands of 1,000 N/m at 1 kHz
      const double scale = seed < 3 ? 1 : 0.5;
      Rig rig(16, soft, mu, posed({0, 0, 0.1}, {0, 1, 0}, 0.3, scale));
      const double k = rig.params.stiffness_n_per_m;
      Random random(seed);
      struct Hand {
        Place at, speed;
        double force_n[3] = {}, stored_j = 0;
        bool was_on = false;
      };
      std::vector<Hand> hands(3);
      for (Hand& hand : hands) {
        hand.at = {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.4};
        rig.fingers.push_back(rig.scene.add(hand.at));
      }
      double work_j = 0, bound_j = 0, least_margin_j = 1e9;
      int on = 0;
      for (int tick = 0; tick < 6000; ++tick) {
        for (std::size_t f = 0; f < hands.size(); ++f) {
          Hand& hand = hands[f];
          double step2 = 0;
          for (std::size_t i = 0; i < 3; ++i) {
            const double aim =
                i == 2 ? 0.08 + 0.06 * std::sin(0.01 * tick + double(f)) : 0.15 * std::sin(0.003 * tick * double(f + 1));
            const double to = hand.at[i] + 0.05 * (aim - hand.at[i]) + 3e-4 * random.uniform(-1, 1);
            work_j += hand.force_n[i] * (to - hand.at[i]);
            step2 += (to - hand.at[i]) * (to - hand.at[i]);
            hand.at[i] = to;
          }
          if (hand.was_on) bound_j += k * step2 / 2;
          rig.scene.move(rig.fingers[f], hand.at);
        }
        rig.step();
        for (std::size_t f = 0; f < hands.size(); ++f) {
          Hand& hand = hands[f];
          const fdcg_finger_result felt = rig.scene.result(rig.fingers[f]);
          const bool is_on = felt.touch_count == 1;
          on += is_on;
          std::copy_n(felt.force_n, 3, hand.force_n);
          if (is_on && !hand.was_on) {
            const double force2 =
                felt.force_n[0] * felt.force_n[0] + felt.force_n[1] * felt.force_n[1] + felt.force_n[2] * felt.force_n[2];
            bound_j += force2 / (2 * k);
          }
          hand.was_on = is_on;
        }
        least_margin_j = std::min(least_margin_j, bound_j - work_j);
        REQUIRE(std::isfinite(work_j));
      }
      INFO("mu " << mu << " seed " << seed << ": work " << work_j << " J, bound " << bound_j);
      CHECK(on > 3000);
      CHECK(least_margin_j >= 0);
      CHECK(work_j < 0);  // the thick stuff takes some
      // left alone it comes back
      for (std::size_t f = 0; f < hands.size(); ++f)
        rig.scene.move(rig.fingers[f], {0, 0, 2});
      for (int tick = 0; tick < 30000 && rig.sheet.deepest_m() > 0; ++tick)
        rig.step();
      CHECK(rig.sheet.deepest_m() < 1e-6);
    }
  }
}
