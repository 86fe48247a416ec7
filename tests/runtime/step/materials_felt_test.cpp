// SPDX-License-Identifier: Apache-2.0
// Materials in the step: by place, combined as the header specifies, and no change of stiffness does work on the hand.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "catch.hpp"
#include "fdcg/scene.h"
#include "materials_rig.hpp"
#include "random.hpp"
#include "step/contact_internals.hpp"

using fdcg::internals_of;
using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

fdcg_params with_table(const std::vector<fdcg_material>& table) {
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_MATERIALS;
  params.materials = table.data();
  params.material_count = static_cast<std::uint32_t>(table.size());
  fdcg_error error = {};
  const fdcg_status status = fdcg_check_params(&params, &error);
  INFO(error.message);
  REQUIRE(status == FDCG_OK);
  return params;
}

}  // namespace

TEST_CASE("friction changes at the seam, in the very tick that crosses it") {
  const CompiledMesh mesh(imported(kStrip));
  const std::vector<fdcg_material> table = {{0.9, 0.8, 1000}, {0.2, 0.1, 1000}};
  Contact contact(mesh.view(), with_table(table));
  const double depth = 0.01;
  contact.step(-1.5, 0, depth);
  for (int tick = 0; tick < 1400; ++tick) {
    contact.step(-1.5 + 0.002 * tick, 0.3, -depth);
    if (tick < 20) continue;
    REQUIRE(contact.result.state == FDCG_FACE);
    const double ratio = -contact.force()[0] / contact.force()[2];
    REQUIRE(ratio ==
            Approx(contact.god_object()[0] < -1e-12 ? 0.8 : 0.1).epsilon(0.02).margin(contact.god_object()[0] < 0 ? 0 : 0.001));
  }
  CHECK(contact.god_object()[0] > 1);
}

TEST_CASE("on a groove between two materials each wall's coefficient counts by its load") {
  const double opening = 1.3;
  const bake::PolygonSoup soup = painted(v_groove(opening), {"left", "right"}, [](std::size_t, const Hip& middle, const Hip&) {
    return middle[1] < 0 ? std::uint16_t{0} : std::uint16_t{1};
  });
  const CompiledMesh mesh(soup);
  const std::vector<fdcg_material> table = {{0.9, 0.5, 700}, {0.3, 0.2, 2000}};
  for (const double lean : {-0.4, -0.1, 0.0, 0.25, 0.45}) {  // within the half of pi - opening that keeps both walls loaded
    Contact contact(mesh.view(), with_table(table));
    const double h = 0.02, y = h * std::sin(lean), z = -h * std::cos(lean);
    contact.step(-0.5, 0, 0.2);
    contact.step(-0.5, 0, -h);
    contact.step(-0.5, y, z);
    REQUIRE(contact.result.state == FDCG_EDGE);
    // -(y, z) = left n_left + right n_right, with normals (cos half, sin half) and (-cos half, sin half) in the y-z plane.
    const double half = opening / 2, both = -z / std::sin(half), more = -y / std::cos(half);
    const double left = (both + more) / 2, right = (both - more) / 2;
    REQUIRE(left > 0);
    REQUIRE(right > 0);
    const double rest = contact.god_object()[0];
    contact.step(rest + (0.9 * left + 0.3 * right) * (1 - 1e-9), y, z);
    CHECK(contact.result.slipping == 0);
    contact.step(rest + (0.9 * left + 0.3 * right) * (1 + 1e-9), y, z);
    CHECK(contact.result.slipping == 1);
    CHECK(norm(contact.force()) == Approx(700 * distance(contact.god_object(), {rest + (0.9 * left + 0.3 * right), y, z})));
  }
}

TEST_CASE("stiffness falls at once, rises by what sliding loses, and never pushes the hand") {
  const CompiledMesh mesh(imported(kStrip));
  const double depth = 0.01;
  const auto slide = [&](double mu, double from, double step, int ticks) {
    static std::vector<fdcg_material> table;  // the params point to it
    table = {{mu, mu, 400}, {mu, mu, 2000}};
    std::vector<double> normal;
    Contact contact(mesh.view(), with_table(table));
    contact.step(from, 0, depth);
    for (int tick = 0; tick < ticks; ++tick) {
      contact.step(from + step * tick, 0, -depth);
      normal.push_back(contact.force()[2]);
    }
    return normal;
  };
  const std::vector<double> soft_to_hard = slide(0.5, -1, 0.001, 2000);
  CHECK(soft_to_hard[500] == Approx(400 * depth));
  CHECK(soft_to_hard[1990] == Approx(2000 * depth));
  CHECK(std::is_sorted(soft_to_hard.begin(), soft_to_hard.end()));
  const std::vector<double> hard_to_soft = slide(0.5, 1, -0.001, 2000);
  CHECK(hard_to_soft[500] == Approx(2000 * depth));
  CHECK(std::count_if(hard_to_soft.begin(), hard_to_soft.end(),
                      [&](double f) { return f < 1999 * depth && f > 401 * depth; }) == 0);
  // Without friction nothing pays for more but the sampling's term, 10^-6 of the energy a tick here.
  const std::vector<double> slippery = slide(0, -0.001, 1e-5, 20000);
  CHECK(slippery.back() > 400 * depth);
  CHECK(slippery.back() < 410 * depth);
}

TEST_CASE("with any materials and terms, stored energy grows by at most the hand's work") {
  Random random(12);
  const Rotation tilt = random_rotation(5);
  const std::vector<PolygonSoup> bodies = {transformed(triangulated(corner_pit()), tilt), v_groove(1.2), saddle_block(),
                                           star_sphere(2, 0.3, 8), grid_box(4, 4, 4, {1, 1, 1})};
  for (const PolygonSoup& body : bodies) {
    const bake::PolygonSoup soup = painted(body, {"a", "b", "c"}, [&](std::size_t f, const Hip&, const Hip&) {
      return static_cast<std::uint16_t>(f * 7919 % 4 == 3 ? 0xFFFF : f * 7919 % 4);
    });
    const CompiledMesh mesh(soup);
    const std::vector<fdcg_material> table = {{0.9, 0.5, 200}, {0.2, 0.1, 5000}, {0, 0, 1000}};
    for (const std::uint32_t terms : {0u, unsigned{FDCG_FRICTION_PRESLIDING}, unsigned{FDCG_FRICTION_ALL}}) {
      fdcg_params params = with_table(table);
      params.friction_flags |= terms;
      params.presliding_n_per_m = 4000;
      const double kp = params.presliding_n_per_m;
      Contact contact(mesh.view(), params);
      HipWalk walk(soup, 3);
      Hip hip = walk.next({0, 0, 3}), last_hip = hip;
      contact.step(hip);
      // The force is k (GO - HIP); the second spring keeps k_p / k of the material that is felt, scaled as k is held back.
      const auto stored = [&](const Hip& at) {
        if (contact.result.state == FDCG_FREE) return 0.0;
        const Hip anchor = {contact.state.god_object[0], contact.state.god_object[1], contact.state.god_object[2]};
        const double gap = distance(contact.god_object(), at), yielded = distance(contact.god_object(), anchor);
        const double k = gap > 0 ? norm(contact.force()) / gap : internals_of(contact.state).stiffness_n_per_m;
        double whole = k;  // of the material
        if ((terms & FDCG_FRICTION_PRESLIDING) != 0 && yielded > 0) {
          if (contact.result.state == FDCG_FACE) {
            const std::uint32_t m = fdcg_get_node_material(&mesh.view(), contact.result.feature);
            fdcg_material own = m < 3 ? table[m] : fdcg_material{params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
            if ((terms & FDCG_FRICTION_FINGER) != 0) own = fdcg_combine_materials(&own, &params.finger);
            whole = own.stiffness_n_per_m;
          } else {
            const fdcg_connection_info edge = fdcg_get_connection(&mesh.view(), contact.result.feature);
            whole = 1e300;
            for (const std::uint32_t n : edge.node) {
              if (n == FDCG_NONE) continue;
              const std::uint32_t m = fdcg_get_node_material(&mesh.view(), n);
              fdcg_material own =
                  m < 3 ? table[m] : fdcg_material{params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
              if ((terms & FDCG_FRICTION_FINGER) != 0) own = fdcg_combine_materials(&own, &params.finger);
              whole = std::min(whole, own.stiffness_n_per_m);
            }
          }
        }
        return (k * gap * gap + kp * (k / whole) * yielded * yielded) / 2;
      };
      double before = 0;
      int touched = 0;
      for (int i = 0; i < 15000; ++i) {
        hip = walk.next(contact.god_object());
        const bool was_free = contact.result.state == FDCG_FREE;
        const Hip way = difference(hip, last_hip);
        const double k = internals_of(contact.state).stiffness_n_per_m;
        const double allowed = before - dot(contact.force(), way) + k * dot(way, way) / 2;
        contact.step(hip);
        const double now = stored(hip);
        if (!was_free && contact.result.state != FDCG_FREE && contact.result.flags == 0) {
          ++touched;
          INFO(soup.name << " terms " << terms << ", step " << i << ": " << contact.describe());
          REQUIRE(now <= allowed + 1e-8 * 5000 * extent(soup) * extent(soup));
        }
        before = now;
        last_hip = hip;
      }
      CHECK(touched > 1000);
    }
  }
}

TEST_CASE("a finger's material is combined with what it touches: geometric mean, springs in series") {
  const CompiledMesh mesh(imported(kStrip));
  const std::vector<fdcg_material> table = {{0.9, 0.8, 1000}, {0.2, 0.1, 500}};
  const fdcg_material finger = {0.5, 0.2, 3000};
  fdcg_params params = with_table(table);
  // By hand, and in a scene at a scale of 3: stiffness and speeds are those of the world.
  for (const bool in_scene : {false, true}) {
    double felt[2] = {0, 0};
    const double depth = 0.01;
    if (!in_scene) {
      params.friction_flags |= FDCG_FRICTION_FINGER;
      params.finger = finger;
      Contact contact(mesh.view(), params);
      contact.step(1, 0, depth);
      for (int tick = 0; tick < 100; ++tick)
        contact.step(1 + 0.001 * tick, 0, -depth);
      felt[0] = -contact.force()[0], felt[1] = contact.force()[2];
    } else {
      params.friction_flags = FDCG_FRICTION_MATERIALS;
      fdcg_scene_config config = fdcg_make_scene_config();
      std::vector<std::uint64_t> memory(fdcg_scene_bytes(&config) / 8 + 1);
      fdcg_scene* scene = nullptr;
      fdcg_error error = {};
      REQUIRE(fdcg_scene_create(memory.data(), memory.size() * 8, &config, &scene, &error) == FDCG_OK);
      fdcg_pose pose = fdcg_make_identity_pose();
      pose.scale = 3;
      fdcg_object_id object;
      fdcg_finger_id id;
      REQUIRE(fdcg_scene_add_object(scene, &mesh.view(), &params, &pose, &object, &error) == FDCG_OK);
      const double start[3] = {3, 0, depth};
      REQUIRE(fdcg_scene_add_finger(scene, start, &id, &error) == FDCG_OK);
      const fdcg_material bad = {0.1, 0.2, 100};
      CHECK(fdcg_scene_set_finger_material(scene, id, &bad, &error) == FDCG_E_ARGUMENT);
      CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("material.mu_static is"));
      REQUIRE(fdcg_scene_set_finger_material(scene, id, &finger, &error) == FDCG_OK);
      fdcg_scene_step(scene);
      for (int tick = 0; tick < 100; ++tick) {
        const double hip[3] = {3 + 0.001 * tick, 0, -depth};
        fdcg_scene_move_finger(scene, id, hip, &error);
        fdcg_scene_step(scene);
      }
      fdcg_finger_result result;
      REQUIRE(fdcg_scene_get_result(scene, id, &result, &error) == FDCG_OK);
      felt[0] = -result.force_n[0], felt[1] = result.force_n[2];
    }
    CHECK(felt[1] == Approx(depth * 500 * 3000 / 3500).epsilon(1e-9));
    CHECK(felt[0] / felt[1] == Approx(std::sqrt(0.1 * 0.2)).epsilon(1e-9));
  }
}

TEST_CASE("the curve's speeds are those in the world, whatever the object's scale") {
  const CompiledMesh mesh(imported(kStrip));
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG;
  for (const double scale : {0.25, 1.0, 50.0}) {
    fdcg_scene_config config = fdcg_make_scene_config();
    std::vector<std::uint64_t> memory(fdcg_scene_bytes(&config) / 8 + 1);
    fdcg_scene* scene = nullptr;
    fdcg_error error = {};
    REQUIRE(fdcg_scene_create(memory.data(), memory.size() * 8, &config, &scene, &error) == FDCG_OK);
    fdcg_pose pose = fdcg_make_identity_pose();
    pose.scale = scale;
    fdcg_object_id object;
    fdcg_finger_id id;
    REQUIRE(fdcg_scene_add_object(scene, &mesh.view(), &params, &pose, &object, &error) == FDCG_OK);
    const double speed = 0.15, depth = 0.005, x = -0.2;
    const double start[3] = {x, 0, depth};
    REQUIRE(fdcg_scene_add_finger(scene, start, &id, &error) == FDCG_OK);
    fdcg_scene_step(scene);
    for (int tick = 0; tick < 2400; ++tick) {
      const double hip[3] = {x + speed * 0.001 * tick, 0, -depth};
      fdcg_scene_move_finger(scene, id, hip, &error);
      fdcg_scene_step(scene);
    }
    fdcg_finger_result result;
    REQUIRE(fdcg_scene_get_result(scene, id, &result, &error) == FDCG_OK);
    const double expected = 0.4 + 0.2 / (1 + 9) + 0.1 * speed;
    CHECK(-result.force_n[0] / result.force_n[2] == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("an invalid material table is refused with the row") {
  std::vector<fdcg_material> table = {{0.9, 0.8, 1000}, {0.2, 0.3, 500}};
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_MATERIALS;
  params.materials = table.data();
  params.material_count = 2;
  fdcg_error error = {};
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("params.materials[1].mu_static is 0.2"));
  table[1] = {0.2, 0.1, std::nan("")};
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("params.materials[1].stiffness_n_per_m"));
  params.materials = nullptr;
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  table[1].stiffness_n_per_m = 500;
  params.materials = table.data();
  CHECK(fdcg_check_params(&params, &error) == FDCG_OK);
}
