// SPDX-License-Identifier: Apache-2.0
// Without friction the god-object may rest at a corner only if no way out of the corner leads nearer to the HIP. Bodies that
// are flat or long have corners where rules of thumb fail: a wall that is far from the HIP may face it all the same.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "descent.hpp"
#include "exact_solid.hpp"
#include "pointed_bodies.hpp"
#include "random.hpp"
#include "squashed.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

struct Counts {
  int in_contact = 0, at_vertices = 0, too_far = 0, in_free_air = 0;
};

// A hand that jumps about in the body's bounds and a little beyond.
void step_about(const PolygonSoup& soup, Precision precision, std::uint64_t seed, Counts& counts) {
  constexpr double kMost_eps = 64;
  fdcg::bake::CompileOptions options;
  options.precision = precision;
  options.coplanar.kind = fdcg::bake::Coplanar::Kind::exact;
  const CompiledMesh mesh(soup, options);
  const ExactSolid solid(soup, *mesh.view().header);
  const Descent descent(solid.triangles());
  const fdcg_header& header = *mesh.view().header;
  Contact contact(mesh.view(), contact_params(0, 0));
  Random random(seed);
  for (int i = 0; i < 400; ++i) {
    Hip hip;
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = (solid.low()[k] + solid.high()[k]) / 2, half = (solid.high()[k] - solid.low()[k]) / 2;
      hip[k] = middle + 1.3 * half * random.uniform(-1, 1) + header.origin[k];
    }
    contact.step(hip);
    counts.in_contact += contact.result.state != FDCG_FREE;
    if (contact.result.state != FDCG_VERTEX || contact.result.flags != 0) continue;
    ++counts.at_vertices;
    const fdcg_corner_info corner = fdcg_get_corner(&mesh.view(), contact.result.feature);
    const Hip point = {corner.point[0], corner.point[1], corner.point[2]};
    const Hip local = {contact.state.hip[0], contact.state.hip[1], contact.state.hip[2]};
    const double epsilon = precision == Precision::f64 ? 0x1p-52 : 0x1p-23;
    counts.too_far += descent.reach(point, local) > kMost_eps * epsilon * header.extent;
    counts.in_free_air += descent.begins_outside(point, local);
  }
}

// From one to the other corner of a triangle that has the tip as its third; zero of all others.
Vec3 side_across(const PolygonSoup& soup, std::size_t face, const Hip& tip) {
  const std::uint32_t* const corners = &soup.corners[3 * face];
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &p = soup.points[corners[k]], &a = soup.points[corners[(k + 1) % 3]], &b = soup.points[corners[(k + 2) % 3]];
    if (p.x == tip[0] && p.y == tip[1] && p.z == tip[2]) return {b.x - a.x, b.y - a.y, b.z - a.z};
  }
  return {0, 0, 0};
}

}  // namespace

// A millionth of the way from the corner, what the solid says of a place is what its faces there say of the way.
TEST_CASE("a way from a corner begins where the solid says of places right beside the corner") {
  int told[3] = {0, 0, 0};
  for (const PolygonSoup& shape :
       {corner_pit(), saddle_block(), cube(), fan_block(7, 0, 0.5, -0.5), fan_block(64, 0, 0.5, 1)}) {
    const PolygonSoup soup = rounded_to_float(triangulated(shape));
    const CompiledMesh mesh(soup);
    const fdcg_header& header = *mesh.view().header;
    const ExactSolid solid(soup, header);
    const Descent descent(solid.triangles());
    Random random(5);
    for (std::uint32_t c = 0; c < header.corner_count; ++c) {
      const fdcg_corner_info info = fdcg_get_corner(&mesh.view(), c);
      const Hip corner = {info.point[0], info.point[1], info.point[2]};
      for (int i = 0; i < 40; ++i) {
        // Anywhere, and by few bits in planes, along edges and on both sides of them.
        const Hip& other = solid.triangles()[random.below(static_cast<std::uint32_t>(solid.triangles().size()))][i % 3];
        Hip way;
        for (std::size_t k = 0; k < 3; ++k) {
          const double step = std::ldexp(std::round(std::ldexp(random.uniform(-1, 1), 8)), -8);
          way[k] = i < 15 ? step : i < 30 ? other[k] - corner[k] : static_cast<double>(random.below(3)) - 1;
        }
        const Hip hip = {corner[0] + way[0], corner[1] + way[1], corner[2] + way[2]};
        Hip near;
        bool is_exact = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const long double whole = static_cast<long double>(hip[k]) - corner[k], part = std::ldexp(whole, -20);
          near[k] = static_cast<double>(corner[k] + part);
          is_exact = is_exact && whole == way[k] && static_cast<long double>(near[k]) - corner[k] == part;
        }
        if (!is_exact) continue;
        const ExactSolid::Where where = solid.where(near);
        ++told[static_cast<int>(where)];
        INFO(soup.name << " corner " << c << " way " << way[0] << ' ' << way[1] << ' ' << way[2]);
        CHECK(descent.begins_outside(corner, hip) == (where != ExactSolid::Where::inside));
      }
    }
  }
  CHECK(std::min({told[0], told[1], told[2]}) > 100);
}

// What the mesh's own faces and edges say of a rest, and what the step does on them.
TEST_CASE("a rest on a face or an edge is one on the mesh, and a place beside it is none") {
  int rests[2] = {0, 0};
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const PolygonSoup soup =
        rounded_to_float(seed % 3 == 0 ? triangulated(v_groove(1.5), seed) : double_fan(3 + static_cast<int>(seed % 11), seed));
    const CompiledMesh mesh(soup);
    const fdcg_graph& graph = mesh.view();
    const ExactSolid solid(soup, *graph.header);
    const Descent descent(solid.triangles());
    Contact contact(graph, contact_params(0, 0));
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      Hip hip;
      for (std::size_t k = 0; k < 3; ++k)
        hip[k] = random.uniform(solid.low()[k], solid.high()[k]) + graph.header->origin[k];
      contact.step(hip);
      const bool is_edge = contact.result.state == FDCG_EDGE;
      if ((!is_edge && contact.result.state != FDCG_FACE) || contact.result.flags != 0) continue;
      const Hip local = {contact.state.hip[0], contact.state.hip[1], contact.state.hip[2]};
      const Hip god_object = {contact.state.god_object[0], contact.state.god_object[1], contact.state.god_object[2]};
      const std::uint32_t corner = is_edge ? fdcg_get_connection(&graph, contact.result.feature).corner[0]
                                           : fdcg_get_side(&graph, contact.result.feature, 0).corner;
      const fdcg_corner_info info = fdcg_get_corner(&graph, corner);
      const Hip point = {info.point[0], info.point[1], info.point[2]};
      const double near = 1e-9 * graph.header->extent;
      ++rests[is_edge ? 1 : 0];
      CHECK(descent.rests_beside(point, god_object, near, local));
      const Hip beside = {god_object[0] + 2 * near, god_object[1], god_object[2]};
      CHECK_FALSE(descent.rests_beside(point, beside, near, local));
      CHECK_FALSE(descent.rests_beside(point, local, near, god_object));
    }
  }
  CHECK(rests[0] > 1000);
  CHECK(rests[1] > 100);
}

TEST_CASE("no rest at a corner of a flat or long body that is no least place") {
  Counts counts;
  std::uint64_t seed = 0;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const double factor : {1e-1, 1e-2, 1e-3, 1e-6, 1e1, 1e2, 1e3, 1e6}) {
      if (precision == Precision::f32 && (factor < 1e-3 || factor > 1e3)) continue;  // as thin as its numbers are coarse
      for (int i = 0; i < 100; ++i, ++seed) {
        const PolygonSoup body = double_fan(3 + static_cast<int>(seed % 11), seed);
        step_about(stretched(body, static_cast<int>(seed % 3), factor), precision, seed, counts);
      }
    }
  }
  CHECK(counts.in_contact > 10'000);
  CHECK(counts.too_far == 0);
  CHECK(counts.in_free_air == 0);
}

// Fans whose walls alternate: pits, in which a god-object may rest, and saddles, on which it may not.
TEST_CASE("no rest at a corner of many walls that is no least place") {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const int sides = 4 + 2 * static_cast<int>(seed % 30);
    const PolygonSoup fan = triangulated(fan_block(sides, 0, 0.9, seed % 2 == 0 ? 0.2 : -0.5), seed);
    step_about(stretched(transformed(fan, random_rotation(seed)), static_cast<int>(seed % 3), 0.1), Precision::f64, seed,
               counts);
  }
  CHECK(counts.in_contact > 1000);
  CHECK(counts.at_vertices > 20);
  CHECK(counts.too_far == 0);
  CHECK(counts.in_free_air == 0);
}

// Ways through the tip of a cone of thousands of sides, which end beside it in the plane of a face, and so near to the planes
// of hundreds: whether such a way begins outside has to be told all the same.
TEST_CASE("no rest at a fine tip with the HIP beside it in the plane of a face") {
  for (const PointedKind kind : {PointedKind::needle, PointedKind::cone, PointedKind::flat}) {
    const PointedBody body = pointed_body(kind, 10'000, random_rotation(21));
    const Hip& tip = body.tips[0].point;
    fdcg::bake::CompileOptions options;
    options.precision = Precision::f32;
    options.coplanar.kind = fdcg::bake::Coplanar::Kind::exact;
    options.jobs = 1;
    const CompiledMesh mesh(body.soup, options);
    const Descent descent(ExactSolid(body.soup, *mesh.view().header).triangles());
    Contact contact(mesh.view(), contact_params(0, 0));
    int met = 0, rests = 0;
    for (std::size_t face = 0; face < body.soup.face_count(); ++face) {
      const Vec3 side = side_across(body.soup, face, tip);
      const double length = std::sqrt(side.x * side.x + side.y * side.y + side.z * side.z);
      if (!(length > 0)) continue;
      const double off = 5e-5 / length, up = 1e-5 * static_cast<double>(static_cast<int>(face % 11) - 5);
      const Hip& axis = body.tips[0].outwards;
      const Hip way = {off * side.x + up * axis[0], off * side.y + up * axis[1], off * side.z + up * axis[2]};
      contact.step({tip[0] - way[0], tip[1] - way[1], tip[2] - way[2]});
      contact.step({tip[0] + way[0], tip[1] + way[1], tip[2] + way[2]});
      met += contact.result.transitions > 0;
      if (contact.result.state != FDCG_VERTEX) continue;
      const Hip point = {contact.state.god_object[0], contact.state.god_object[1], contact.state.god_object[2]};
      const Hip local = {contact.state.hip[0], contact.state.hip[1], contact.state.hip[2]};
      rests += descent.begins_outside(point, local);
    }
    INFO(name_of(kind));
    CHECK(met > 100);
    CHECK(rests == 0);
  }
}
