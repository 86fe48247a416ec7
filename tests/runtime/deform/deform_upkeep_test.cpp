// SPDX-License-Identifier: Apache-2.0
// Deformable meshes: lazy updates give the bits of a full computation.
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include "deform_rig.hpp"
#include "fp_trap.hpp"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

bool are_same_bits(const fdcg_result& a, const fdcg_result& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::string said(const fdcg_result& r) {
  std::ostringstream text;
  text.precision(17);
  text << "state " << r.state << " feature " << r.feature << " flags " << r.flags << " transitions " << r.transitions << " at "
       << r.god_object_m[0] << " " << r.god_object_m[1] << " " << r.god_object_m[2];
  return text.str();
}

// Wobbles a share of the vertices about their places.
void wobble(DeformableMesh& mesh, const bake::PolygonSoup& rest, double share, double amplitude, Random& random) {
  const auto count = static_cast<std::uint32_t>(rest.points.size());
  const auto moving = static_cast<std::uint32_t>(share * count) + 1;
  for (std::uint32_t i = 0; i < moving; ++i) {
    const std::uint32_t v = random.below(count);
    mesh.move(v, rest.points[v] + random.uniform(0, amplitude) * random.direction());
  }
}

}  // namespace

TEST_CASE("a deformed mesh has the planes, types and normals that the compiler gives the mesh as it now is") {
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    const bake::PolygonSoup rest = rounded_to_float(ico_sphere(3));
    DeformableMesh mesh(rest, triangle_options(precision));
    bake::PolygonSoup moved = rest;
    Random random(11);
    for (std::size_t v = 0; v < moved.points.size(); ++v) {
      const auto out = static_cast<float>(random.uniform(0.8, 1.2));
      const bake::Vec3& p = rest.points[v];
      moved.points[v] = {static_cast<float>(p.x * out), static_cast<float>(p.y * out), static_cast<float>(p.z * out)};
      mesh.move(v, moved.points[v]);
    }
    bake::CompileOptions options = triangle_options(precision);
    options.coplanar.kind = bake::Coplanar::Kind::exact;
    const CompiledMesh expected(moved, options);
    const fdcg_graph &e = expected.view(), &a = mesh.updated();
    REQUIRE(std::memcmp(e.header->origin, a.header->origin, sizeof e.header->origin) == 0);
    std::vector<std::uint32_t> expected_connection(a.header->connection_count);
    std::uint32_t normals = 0;
    for (std::uint32_t f = 0; f < rest.face_count(); ++f) {
      const std::uint32_t there = e.source_map[f], here = a.source_map[f];
      const fdcg_node_info plane_there = fdcg_get_node(&e, there), plane_here = fdcg_get_node(&a, here);
      REQUIRE(std::memcmp(&plane_there, &plane_here, sizeof plane_here) == 0);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const fdcg_side_info side_there = fdcg_get_side(&e, there, k), side_here = fdcg_get_side(&a, here, k);
        if (side_there.which == side_here.which) {  // seen from one end the edge's numbers are the same
          REQUIRE(std::memcmp(side_there.voronoi_normal, side_here.voronoi_normal, sizeof side_here.voronoi_normal) == 0);
          REQUIRE(side_there.voronoi_offset == side_here.voronoi_offset);
        }
        REQUIRE(fdcg_get_connection(&e, side_there.connection).type == fdcg_get_connection(&a, side_here.connection).type);
        const fdcg_corner_info corner_there = fdcg_get_corner(&e, side_there.corner);
        const fdcg_corner_info corner_here = fdcg_get_corner(&a, side_here.corner);
        REQUIRE(std::memcmp(corner_there.point, corner_here.point, sizeof corner_here.point) == 0);
        normals += std::memcmp(corner_there.normal, corner_here.normal, sizeof corner_here.normal) == 0;
      }
    }
    CHECK(normals >= 0.98 * 3 * static_cast<double>(rest.face_count()));  // the sum's order: where the fan starts
  }
}

TEST_CASE("a deformable mesh stays within its memory, aligned to a cache line at any start address") {
  const CompiledMesh sheet(rounded_to_float(ico_sphere(1)), triangle_options());
  const std::uint64_t bytes = fdcg_deform_bytes(&sheet.view());
  constexpr std::size_t kMost = 8, kMargin = 8;  // eights of bytes
  constexpr std::uint64_t kUntouched = 0x5A5A5A5A5A5A5A5A;
  const fdcg_deform_config config = fdcg_make_deform_config();
  for (std::size_t first = kMargin; first < kMargin + kMost; ++first) {
    std::vector<std::uint64_t> room(bytes / 8 + 2 * kMargin + kMost, kUntouched);
    fdcg_deform* deform = nullptr;
    fdcg_error error;
    REQUIRE(bytes % 8 == 0);
    CHECK(fdcg_deform_create(&room[first], bytes - 1, &sheet.view(), &config, &deform, &error) == FDCG_E_ARGUMENT);
    REQUIRE(fdcg_deform_create(&room[first], bytes, &sheet.view(), &config, &deform, &error) == FDCG_OK);
    CHECK(reinterpret_cast<std::uintptr_t>(deform) % 64 == 0);
    (void)fdcg_deform_get_graph(deform);
    for (std::size_t i = 0; i < room.size(); ++i) {
      if (i < first || i >= first + bytes / 8) CHECK(room[i] == kUntouched);
    }
  }
}

TEST_CASE("lazy steps are those on a mesh computed anew as a whole, bit for bit") {
  const std::uint64_t steps = steps_or(4000);
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    for (const bake::PolygonSoup& rest : {star_sphere(3, 0.2, 5), bumpy_patch(24, 0.1, 3), uv_sphere(48, 12)}) {
      INFO(rest.name);
      DeformableMesh lazy(triangulated(rest), triangle_options(precision)),
          whole(triangulated(rest), triangle_options(precision));
      Random motion(3), same_motion(3), choice(7);
      HipWalk walk(rest, 9);
      const fdcg_params params = contact_params(0.5, 0.3);
      fdcg_deform_contact contact = {}, contact_whole = {}, second = {}, second_whole = {};
      Hip god_object = {0, 0, 2};
      for (std::uint64_t i = 0; i < steps; ++i) {
        if (choice.chance(0.7)) {
          const double share = choice.chance(0.1) ? 0.3 : 0.01;
          wobble(lazy, rest, share, 0.02, motion);
          wobble(whole, rest, share, 0.02, same_motion);
        }
        (void)fdcg_deform_get_graph(whole.deform());
        const Hip hip = walk.next(god_object);
        const FpTrap trap(hip.data());
        const fdcg_result result = lazy.step(params, &contact, hip);
        const fdcg_result result_whole = whole.step(params, &contact_whole, hip);
        INFO("step " << i << ": " << said(result) << " against " << said(result_whole));
        REQUIRE(are_same_bits(result, result_whole));
        const Hip other = {-hip[0], hip[2], hip[1]};  // a second finger looks elsewhere
        REQUIRE(are_same_bits(lazy.step(params, &second, other), whole.step(params, &second_whole, other)));
        god_object = {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]};
      }
      REQUIRE(bytes_of(lazy.updated()) == bytes_of(whole.updated()));
      DeformableMesh fresh(triangulated(rest), triangle_options(precision));
      for (std::size_t v = 0; v < rest.points.size(); ++v)
        fresh.move(v, lazy.points()[v]);
      CHECK(bytes_of(fresh.updated()) == bytes_of(lazy.updated()));
    }
  }
}

TEST_CASE("a deformed mesh at rest behaves like any other") {
  const bake::PolygonSoup rest = star_sphere(3, 0.2, 5);
  DeformableMesh mesh(rest);
  Random random(3);
  wobble(mesh, rest, 1, 0.02, random);
  DeformableMesh looked_at(rest);
  for (std::size_t v = 0; v < rest.points.size(); ++v)
    looked_at.move(v, mesh.points()[v]);
  const fdcg_graph& graph = looked_at.updated();
  const fdcg_params params = contact_params(0.5, 0.3);
  HipWalk walk(rest, 21);
  fdcg_deform_contact contact = {};
  fdcg_contact rigid = {};
  Hip god_object = {0, 0, 2};
  for (std::uint64_t i = 0; i < steps_or(20000); ++i) {
    const Hip hip = walk.next(god_object);
    fdcg_result expected;
    fdcg_step(&graph, &params, &rigid, hip.data(), &expected);
    const fdcg_result result = mesh.step(params, &contact, hip);
    REQUIRE(are_same_bits(result, expected));
    god_object = {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]};
  }
}
