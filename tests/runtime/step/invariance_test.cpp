// SPDX-License-Identifier: Apache-2.0
// The same contact however a planar region is cut up, however the object is turned, moved and scaled.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

std::vector<Hip> hand_over_plane() {
  std::vector<Hip> path;
  Random random(17);
  Hip hip = {-0.3, -0.2, 0.05};
  for (int i = 0; i < 4000; ++i) {
    const double a = 0.013 * i;
    hip = {0.35 * std::sin(a) + 0.01 * random.unit(), 0.33 * std::sin(1.37 * a), -0.05 + 0.09 * std::sin(0.71 * a)};
    path.push_back(hip);
  }
  return path;
}

std::vector<Hip> run(const fdcg_graph& graph, const std::vector<Hip>& path, const fdcg_params& params,
                     std::uint64_t* contacts) {
  Contact contact(graph, params);
  std::vector<Hip> result;
  for (const Hip& hip : path) {
    contact.step(hip);
    *contacts += contact.result.state != FDCG_FREE;
    result.push_back(contact.god_object());
  }
  CHECK(contact.bound_hits == 0);
  return result;
}

double worst_difference(const std::vector<Hip>& a, const std::vector<Hip>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, distance(a[i], b[i]));
  return worst;
}

std::vector<Hip> turned(const std::vector<Hip>& path, const Rotation& rotation, double scale, const fdcg::bake::Vec3& shift) {
  std::vector<Hip> result;
  for (const Hip& p : path) {
    const fdcg::bake::Vec3 q = rotated(rotation, vec_of(p));
    result.push_back({q.x * scale + shift.x, q.y * scale + shift.y, q.z * scale + shift.z});
  }
  return result;
}

}  // namespace

TEST_CASE("the god-object's path does not depend on how a plane is cut up") {
  const std::vector<Hip> path = hand_over_plane();
  for (const auto& [mu_s, mu_d] : {std::pair(0.0, 0.0), std::pair(0.3, 0.2), std::pair(2.0, 1.0)}) {
    const fdcg_params params = contact_params(mu_s, mu_d);
    std::uint64_t contacts = 0, other_contacts = 0;
    const PlainGraph whole(plane_quad(), Precision::f64);
    const std::vector<Hip> expected = run(whole.view(), path, params, &contacts);
    CHECK(contacts > 1000);
    for (const PolygonSoup& cut : {triangulated(plane_quad()), plane_grid(7, 3), plane_grid(100, 50), plane_jittered(70, 4)}) {
      INFO(cut.name << " of " << cut.face_count() << ", mu " << mu_s << '/' << mu_d);
      const PlainGraph plain(cut, Precision::f64);
      other_contacts = 0;
      CHECK(worst_difference(expected, run(plain.view(), path, params, &other_contacts)) <= 1e-12);
      CHECK(other_contacts == contacts);
      for (const bool merge : {false, true}) {
        fdcg::bake::CompileOptions options;
        options.merge = merge;
        const CompiledMesh compiled(cut, options);
        other_contacts = 0;
        CHECK(worst_difference(expected, run(compiled.view(), path, params, &other_contacts)) <= 1e-12);
        CHECK(other_contacts == contacts);
      }
    }
  }
}

TEST_CASE("the god-object's path does not depend on how a block's faces are cut up") {
  std::vector<Hip> path;
  for (int i = 0; i < 5000; ++i) {
    const double a = 0.011 * i;
    path.push_back({0.52 * std::sin(a), 0.51 * std::sin(1.31 * a + 1), 0.53 * std::sin(0.77 * a + 2)});
  }
  for (const auto& [mu_s, mu_d] : {std::pair(0.0, 0.0), std::pair(0.3, 0.2), std::pair(1.0, 1.0)}) {
    const fdcg_params params = contact_params(mu_s, mu_d);
    std::uint64_t contacts = 0, other = 0;
    const PlainGraph whole(cube(), Precision::f64);
    const std::vector<Hip> expected = run(whole.view(), path, params, &contacts);
    CHECK(contacts > 1000);
    for (const PolygonSoup& cut :
         {triangulated(cube()), grid_box(4, 8, 2, {1, 1, 1}), subdivided(cube()), subdivided(subdivided(cube()))}) {
      INFO(cut.name << " of " << cut.face_count() << ", mu " << mu_s << '/' << mu_d);
      const PlainGraph plain(cut, Precision::f64);
      CHECK(worst_difference(expected, run(plain.view(), path, params, &other)) <= 1e-12);
    }
  }
}

TEST_CASE("contact is invariant under rotation, translation by a million sizes, and scale") {
  const PolygonSoup body = star_sphere(2, 0.25, 6);
  std::vector<Hip> path;
  for (int i = 0; i < 3000; ++i) {
    const double a = 0.017 * i, r = 1 + 0.25 * std::sin(0.63 * a);
    path.push_back({r * std::cos(a), r * std::sin(a) * std::cos(0.3 * a), r * std::sin(a) * std::sin(0.3 * a)});
  }
  const fdcg_params params = contact_params(0.6, 0.4);
  std::uint64_t contacts = 0, other = 0;
  const CompiledMesh here(body);
  const std::vector<Hip> expected = run(here.view(), path, params, &contacts);
  CHECK(contacts > 1000);
  SECTION("turned") {
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Rotation r = random_rotation(seed);
      const CompiledMesh there(transformed(body, r));
      other = 0;
      CHECK(worst_difference(turned(expected, r, 1, {}), run(there.view(), turned(path, r, 1, {}), params, &other)) < 1e-12);
      CHECK(other == contacts);
    }
  }
  SECTION("scaled by powers of two, bit for bit") {
    for (const double s : {0x1p-20, 0x1p20}) {
      const Rotation same = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      const CompiledMesh there(scaled(body, s));
      other = 0;
      CHECK(worst_difference(turned(expected, same, s, {}), run(there.view(), turned(path, same, s, {}), params, &other)) == 0);
      CHECK(other == contacts);
    }
  }
  SECTION("a million sizes away") {
    // Coordinates there have a spacing of 1.2e-10: the body and the path are first rounded to it, so that both are the same.
    const Vec3 shift = {1048576, -2097152, 1048576};
    const auto at_spacing = [](double c) { return std::round(c * 0x1p30) * 0x1p-30; };
    PolygonSoup near = body;
    for (Vec3& p : near.points)
      p = {at_spacing(p.x), at_spacing(p.y), at_spacing(p.z)};
    std::vector<Hip> near_path = path, far_path = path;
    for (std::size_t i = 0; i < path.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        near_path[i][k] = at_spacing(path[i][k]);
      far_path[i] = {near_path[i][0] + shift.x, near_path[i][1] + shift.y, near_path[i][2] + shift.z};
    }
    const CompiledMesh near_mesh(near), far_mesh(moved(near, shift));
    Contact near_contact(near_mesh.view(), params), far_contact(far_mesh.view(), params);
    double worst = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      near_contact.step(near_path[i]);
      far_contact.step(far_path[i]);
      INFO("tick " << i << "\nnear " << near_contact.describe() << "\nfar " << far_contact.describe());
      REQUIRE(near_contact.result.state == far_contact.result.state);
      REQUIRE(near_contact.result.slipping == far_contact.result.slipping);
      worst = std::max(worst, distance(near_contact.force(), far_contact.force()));
    }
    // Forces are k (GO - HIP), k = 1,000: positions agree to 1e-12 where nothing was lost.
    CHECK(worst < 1e-9);
  }
}
