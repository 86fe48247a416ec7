// SPDX-License-Identifier: Apache-2.0
// The C API of deformable meshes: refusals, and a flat sheet whose contact has a closed form.
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "deform_rig.hpp"
#include "meshes.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

bool says(const fdcg_error& error, const char* what) {
  return std::string(error.message).find(what) != std::string::npos;
}

// The whole sheet, moved; x and y as at rest but for `aside`.
void lift(DeformableMesh& sheet, const bake::PolygonSoup& rest, double z, double aside = 0) {
  for (std::size_t v = 0; v < rest.points.size(); ++v)
    sheet.move(v, {rest.points[v].x + aside, rest.points[v].y, z});
}

}  // namespace

TEST_CASE("a graph with faces other than triangles, or a corner of too many faces, is refused with the remedy") {
  fdcg_deform* deform = nullptr;
  fdcg_error error;
  const fdcg_deform_config config = fdcg_make_deform_config();
  alignas(64) unsigned char memory[64];
  const CompiledMesh quads(cube());
  CHECK(fdcg_deform_bytes(&quads.view()) == 0);
  CHECK(fdcg_deform_create(memory, sizeof memory, &quads.view(), &config, &deform, &error) == FDCG_E_GRAPH);
  CHECK(says(error, "--triangles"));
  CHECK(deform == nullptr);
  const CompiledMesh busy(cone(300), triangle_options());
  CHECK(fdcg_deform_bytes(&busy.view()) == 0);
  CHECK(fdcg_deform_create(memory, sizeof memory, &busy.view(), &config, &deform, &error) == FDCG_E_GRAPH);
  CHECK(says(error, "256"));
  CHECK(fdcg_deform_bytes(nullptr) == 0);
}

TEST_CASE("memory and settings out of range are refused") {
  const CompiledMesh mesh(cube(), triangle_options());
  const std::uint64_t bytes = fdcg_deform_bytes(&mesh.view());
  REQUIRE(bytes > 0);
  std::vector<std::uint64_t> memory(bytes / 8 + 2);
  fdcg_deform* deform = nullptr;
  fdcg_error error;
  fdcg_deform_config config = fdcg_make_deform_config();
  CHECK(fdcg_deform_create(memory.data(), bytes - 1, &mesh.view(), &config, &deform, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_deform_create(reinterpret_cast<char*>(memory.data()) + 4, bytes, &mesh.view(), &config, &deform, &error) ==
        FDCG_E_ALIGNMENT);
  CHECK(fdcg_deform_create(nullptr, bytes, &mesh.view(), &config, &deform, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_deform_create(memory.data(), bytes, &mesh.view(), nullptr, &deform, &error) == FDCG_E_ARGUMENT);
  for (const double margin : {-1.0, kNan, kInfinity, 1e80}) {
    config.margin_m = margin;
    CHECK(fdcg_deform_create(memory.data(), bytes, &mesh.view(), &config, &deform, &error) == FDCG_E_ARGUMENT);
    CHECK(says(error, "margin_m"));
  }
  config = fdcg_make_deform_config();
  config.struct_bytes = 4;
  CHECK(fdcg_deform_create(memory.data(), bytes, &mesh.view(), &config, &deform, &error) == FDCG_E_ARGUMENT);
  config = fdcg_make_deform_config();
  CHECK(fdcg_deform_create(memory.data(), bytes, &mesh.view(), &config, &deform, nullptr) == FDCG_OK);
}

TEST_CASE("every vertex is found as its corner, and other places give none") {
  const bake::PolygonSoup rest = plane_grid(9, 7);
  DeformableMesh sheet(rest);
  std::set<std::uint32_t> corners;
  for (std::size_t v = 0; v < rest.points.size(); ++v)
    corners.insert(sheet.corner_of(v));
  CHECK(corners.size() == rest.points.size());
  fdcg_error error;
  std::uint32_t corner = 0;
  for (const double away : {0.01, 2.5, 1e9, -1e300}) {  // beside a corner, beyond the margin, far beyond all
    const double beside[3] = {0.01, away, 0.25};
    corner = 0;
    CHECK(fdcg_deform_find(sheet.deform(), beside, &corner, &error) == FDCG_E_ABSENT);
    CHECK(corner == FDCG_NONE);
    CHECK(says(error, "no corner within"));
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    const double nowhere[3] = {1e9, bad, 0};
    CHECK(fdcg_deform_find(sheet.deform(), nowhere, &corner, &error) == FDCG_E_ARGUMENT);
    CHECK(says(error, "position 1 is "));
    CHECK(says(error, "must be finite"));
    CHECK_FALSE(says(error, "margin_m"));
  }
}

TEST_CASE("moving a vertex to an invalid position is refused, and it does not move") {
  const bake::PolygonSoup rest = plane_grid(2, 2);
  DeformableMesh sheet(rest, triangle_options(), 0.5);
  const std::uint32_t corner = sheet.corner_of(4);
  fdcg_error error;
  for (const double bad : {kNan, kInfinity, -kInfinity, 0.51, -1e300}) {
    const double at[3] = {rest.points[4].x, rest.points[4].y, bad};
    CHECK(fdcg_deform_move(sheet.deform(), corner, at, &error) == FDCG_E_ARGUMENT);
    CHECK(says(error, "position 2 is "));
    CHECK(says(error, "margin_m") == std::isfinite(bad));
    CHECK(says(error, "must be finite") == !std::isfinite(bad));
  }
  const double fine[3] = {0, 0, 0};
  CHECK(fdcg_deform_move(sheet.deform(), 9, fine, &error) == FDCG_E_ARGUMENT);
  CHECK(says(error, "the mesh has 9"));
  CHECK(fdcg_deform_move(sheet.deform(), corner, nullptr, &error) == FDCG_E_ARGUMENT);
  double place[3];
  CHECK(fdcg_deform_place(sheet.deform(), 9, place, &error) == FDCG_E_ARGUMENT);
  REQUIRE(fdcg_deform_place(sheet.deform(), corner, place, &error) == FDCG_OK);
  CHECK(place[0] == rest.points[4].x);
  CHECK(place[2] == 0);
  const double high[3] = {0.5, -0.5, 0.5};
  CHECK(fdcg_deform_move(sheet.deform(), corner, high, &error) == FDCG_OK);
  REQUIRE(fdcg_deform_place(sheet.deform(), corner, place, &error) == FDCG_OK);
  CHECK(place[2] == 0.5);
}

TEST_CASE("many moves in one call are those of as many calls, up to the first that is refused") {
  const bake::PolygonSoup rest = plane_grid(20, 20);
  DeformableMesh sheet(rest, triangle_options(), 0.5), other(rest, triangle_options(), 0.5);
  std::vector<std::uint32_t> corners;
  std::vector<double> places;
  for (std::size_t i = 0; i < 2 * rest.points.size(); ++i) {  // each twice
    const std::size_t v = 7 * i % rest.points.size();
    const bake::Vec3 to = {rest.points[v].x, rest.points[v].y, 0.001 * static_cast<double>(i % 97)};
    corners.push_back(sheet.corner_of(v));
    places.insert(places.end(), {to.x, to.y, to.z});
    if (i < 500) other.move(v, to);
  }
  places[3 * 500 + 1] = kNan;
  fdcg_error error;
  CHECK(fdcg_deform_move_corners(sheet.deform(), corners.data(), places.data(), corners.size(), &error) == FDCG_E_ARGUMENT);
  CHECK(says(error, "move 500: corner "));
  CHECK(says(error, "position 1 is NaN m; it must be finite"));
  CHECK(bytes_of(sheet.updated()) == bytes_of(other.updated()));
  corners[0] = 441;
  CHECK(fdcg_deform_move_corners(sheet.deform(), corners.data(), places.data(), 3, &error) == FDCG_E_ARGUMENT);
  CHECK(says(error, "move 0: corner is 441, the mesh has 441"));
  CHECK(fdcg_deform_move_corners(sheet.deform(), corners.data(), nullptr, 3, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_deform_move_corners(sheet.deform(), nullptr, places.data(), 3, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_deform_move_corners(sheet.deform(), nullptr, nullptr, 0, &error) == FDCG_OK);
  CHECK(bytes_of(sheet.updated()) == bytes_of(other.updated()));
}

TEST_CASE("a sheet that rises over a still finger touches it, and releases it when it sinks") {
  const bake::PolygonSoup rest = plane_grid(8, 8);
  for (const double x : {0.013, 0.125}) {  // over a face, over the line between two
    DeformableMesh sheet(rest);
    const fdcg_params params = contact_params(0.5, 0.3);
    fdcg_deform_contact contact = {};
    const Hip hip = {x, 0.051, 0.05};
    for (int i = 0; i < 40; ++i)  // a clear ball is found, and must be given up
      CHECK(sheet.step(params, &contact, hip).state == FDCG_FREE);
    lift(sheet, rest, 0.125);
    fdcg_result felt = sheet.step(params, &contact, hip);
    CHECK((felt.flags & FDCG_DEFORM_CAUGHT) != 0);
    CHECK(felt.state != FDCG_FREE);
    CHECK(felt.god_object_m[2] == Approx(0.125).margin(1e-15));
    CHECK(felt.force_n[2] == Approx(params.stiffness_n_per_m * 0.075).epsilon(1e-12));
    CHECK(std::hypot(felt.force_n[0], felt.force_n[1]) <= 1e-9);
    lift(sheet, rest, 0.03125);
    felt = sheet.step(params, &contact, hip);
    CHECK(felt.state == FDCG_FREE);
    CHECK(felt.force_n[2] == 0);
  }
}

TEST_CASE("a god-object moves with the sheet while friction holds") {
  const bake::PolygonSoup rest = plane_grid(8, 8);
  DeformableMesh sheet(rest);
  const fdcg_params params = contact_params(0.5, 0.3);
  fdcg_deform_contact contact = {};
  (void)sheet.step(params, &contact, {0.013, 0.051, 0.05});
  const Hip hip = {0.013, 0.051, -0.05};
  REQUIRE(sheet.step(params, &contact, hip).state == FDCG_FACE);
  lift(sheet, rest, 0, 0.0078125);  // within the cone: 0.5 * 0.05
  fdcg_result felt = sheet.step(params, &contact, hip);
  CHECK(felt.slipping == 0);
  CHECK(felt.god_object_m[0] == Approx(0.013 + 0.0078125).margin(1e-15));
  CHECK(felt.god_object_m[1] == Approx(0.051).margin(1e-15));
  CHECK(felt.force_n[0] == Approx(params.stiffness_n_per_m * 0.0078125).epsilon(1e-12));
  lift(sheet, rest, 0, 0.03125);  // beyond it: it slips, to the dynamic circle
  felt = sheet.step(params, &contact, hip);
  CHECK(felt.slipping == 1);
  CHECK(felt.god_object_m[0] == Approx(0.013 + 0.3 * 0.05).margin(1e-15));
}

TEST_CASE("moves between two steps count as one straight way, and missed ticks are reported") {
  const bake::PolygonSoup rest = plane_grid(8, 8);
  DeformableMesh sheet(rest);
  const fdcg_params params = contact_params(0.5, 0.3);
  fdcg_deform_contact contact = {}, other = {};
  const Hip hip = {0.013, 0.051, 0.05};
  (void)sheet.step(params, &contact, hip);
  lift(sheet, rest, 0.25);  // over it and back below: no way at all
  lift(sheet, rest, 0.03125);
  CHECK(sheet.step(params, &contact, hip).state == FDCG_FREE);
  (void)sheet.step(params, &other, hip);
  lift(sheet, rest, 0.015625);
  CHECK((sheet.step(params, &contact, hip).flags & FDCG_DEFORM_MISSED) == 0);
  lift(sheet, rest, 0);
  CHECK((sheet.step(params, &contact, hip).flags & FDCG_DEFORM_MISSED) == 0);
  CHECK((sheet.step(params, &other, hip).flags & FDCG_DEFORM_MISSED) != 0);
  CHECK(sheet.step(params, &other, hip).flags == 0);
}

TEST_CASE("a HIP that is no number leaves a contact on a moving sheet valid") {
  const bake::PolygonSoup rest = plane_grid(8, 8);
  DeformableMesh sheet(rest);
  const fdcg_params params = contact_params(0.5, 0.3);
  fdcg_deform_contact contact = {};
  (void)sheet.step(params, &contact, {0.013, 0.051, 0.05});
  REQUIRE(sheet.step(params, &contact, {0.013, 0.051, -0.05}).state == FDCG_FACE);
  lift(sheet, rest, 0.125);
  const fdcg_result felt = sheet.step(params, &contact, {kNan, 0, 0});
  CHECK((felt.flags & FDCG_RESULT_NON_FINITE) != 0);
  CHECK(felt.force_n[2] == 0);
  CHECK(felt.god_object_m[2] == Approx(0.125).margin(1e-15));
  CHECK(sheet.step(params, &contact, {0.013, 0.051, -0.05}).force_n[2] ==
        Approx(params.stiffness_n_per_m * 0.175).epsilon(1e-12));
}

// Beside the line from -(1, 1/3) to (1, 1/3) by the rounding of a third of their x: exact signs tell them off it, and the
// products of their normals vanish. Each has the other across its longest side.
TEST_CASE("two neighbouring triangles without a normal do not recurse") {
  const double third = 1.0 / 3;
  const bake::PolygonSoup rest =
      make_soup("thin", {{1, third, 0}, {-1, -third, 0}, {0.5, -1, 0}, {-0.5, 1, 0}}, {{0, 1, 3}, {1, 0, 2}});
  DeformableMesh sheet(rest);
  const double x = std::ldexp(1.2345678901234567, -60);
  sheet.move(2, {x, x * third, 0});
  sheet.move(3, {-x, -x * third, 0});
  const fdcg_params params = contact_params(0.5, 0.3);
  fdcg_deform_contact contact = {};
  (void)sheet.step(params, &contact, {0, 0, 0.1});
  (void)sheet.step(params, &contact, {0, 0, -0.1});
  (void)sheet.updated();
  sheet.move(2, rest.points[2]);
  sheet.move(3, rest.points[3]);
  const fdcg_graph& again = sheet.updated();
  for (std::uint32_t node = 0; node < 2; ++node)
    CHECK(fdcg_get_node(&again, node).normal[2] == -1);  // wound clockwise, seen from above
}
