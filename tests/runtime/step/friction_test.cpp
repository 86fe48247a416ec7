// SPDX-License-Identifier: Apache-2.0
// Coulomb's law on a plane and in a groove, to rounding.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

// A direction's part of a force along the normal, and across it.
struct Split {
  double normal, tangential;
};
Split split(const Hip& force, const Hip& normal) {
  const double n = dot(force, normal);
  const Hip t = {force[0] - n * normal[0], force[1] - n * normal[1], force[2] - n * normal[2]};
  return {n, norm(t)};
}

Hip along(const Hip& p, const Hip& d, double s) {
  return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]};
}

}  // namespace

TEST_CASE("on a plane the tangential force breaks away at mu_s and slides at mu_d, in every orientation") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PolygonSoup soup = transformed(plane_quad(), tilt);
    const PlainGraph graph(triangulated(soup), Precision::f64);
    const Hip normal = point_of(rotated(tilt, {0, 0, 1})), side = point_of(rotated(tilt, {0.8, 0.6, 0}));
    const double mu_s = 0.7, mu_d = 0.45;
    for (const double depth : {5e-4, 1e-2, 0.1}) {  // from 1e-3 of the extent
      Contact contact(graph.view(), contact_params(mu_s, mu_d));
      const Hip start = along(along({0, 0, 0}, side, -0.2), normal, -depth);
      contact.step(along(start, normal, 2 * depth));
      contact.step(start);
      REQUIRE(contact.result.state == FDCG_FACE);
      // Just below the static limit it rests, just beyond it slides, and the dynamic ratio holds in that same tick.
      contact.step(along(start, side, mu_s * depth * (1 - 1e-9)));
      REQUIRE(contact.result.slipping == 0);
      const Split held = split(contact.force(), normal);
      CHECK(std::abs(held.tangential / held.normal - mu_s) < 1e-8);
      contact.step(along(start, side, mu_s * depth * (1 + 1e-9)));
      REQUIRE(contact.result.slipping == 1);
      for (int tick = 0; tick < 50; ++tick) {
        const Split sliding = split(contact.force(), normal);
        REQUIRE(std::abs(sliding.tangential / sliding.normal - mu_d) < 1e-12);
        REQUIRE(contact.result.slipping == 1);
        contact.step(along(start, side, mu_s * depth + 0.004 * (tick + 1)));
      }
    }
  }
}

TEST_CASE("friction along a groove follows the chosen rule: wedge or paper") {
  constexpr double kDegree = std::numbers::pi / 180;
  for (const double opening : {30 * kDegree, 60 * kDegree, 90 * kDegree, 150 * kDegree}) {
    const PlainGraph graph(v_groove(opening), Precision::f64);
    for (const std::uint32_t rule : {FDCG_EDGE_WEDGE, FDCG_EDGE_PAPER}) {
      for (const double lean : {0.0, 0.2}) {  // HIP off the groove's middle plane, still behind both walls
        const double mu_s = 0.6, mu_d = 0.4, h = 0.05;
        Contact contact(graph.view(), contact_params(mu_s, mu_d, rule));
        const double angle = lean * (std::numbers::pi - opening);  // the walls' normals span pi - opening
        const double y = h * std::sin(angle), z = -h * std::cos(angle);
        contact.step(-0.5, 0, 0.3);
        contact.step(-0.5, 0, -h);
        contact.step(-0.5, y, z);
        INFO("opening " << opening / kDegree << ", rule " << rule << ", lean " << lean << ": " << contact.describe());
        REQUIRE(contact.result.state == FDCG_EDGE);
        // Two walls carry the load: N_a + N_b from the balance of forces in the cross-section.
        const double half = opening / 2;
        const double wedge_load = -z / std::sin(half);
        const double load = rule == FDCG_EDGE_WEDGE ? wedge_load : h;
        const double rest = contact.god_object()[0];
        contact.step(rest + mu_s * load * (1 - 1e-9), y, z);
        CHECK(contact.god_object()[0] == rest);
        CHECK(contact.result.slipping == 0);
        contact.step(rest + mu_s * load * (1 + 1e-9), y, z);
        CHECK(contact.result.slipping == 1);
        for (int tick = 1; tick < 40; ++tick) {
          const double x = rest + mu_s * load + 0.005 * tick;
          contact.step(x, y, z);
          REQUIRE(contact.result.state == FDCG_EDGE);
          REQUIRE(std::abs((x - contact.god_object()[0]) - mu_d * load) < 1e-13);
        }
      }
    }
  }
}

// A million sizes away the corners are rounded to 1e-10 of the size; the walls are merged over that and lie off their corners.
TEST_CASE("groove friction is borne by its two walls, also where faces are off their corners") {
  const Vec3 offset = {7e5, -6e5, 4e5};
  int inexact = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const CompiledMesh mesh(triangulated(transformed(v_groove(std::numbers::pi / 3), tilt, 1, offset)));
    const auto place = [&](double x, double z) {
      const Vec3 p = rotated(tilt, {x, 0, z});
      return Hip{p.x + offset.x, p.y + offset.y, p.z + offset.z};
    };
    const double mu_s = 0.6, mu_d = 0.4, depth = 2e-3;
    Contact contact(mesh.view(), contact_params(mu_s, mu_d));
    contact.step(place(-0.9, 0.2));
    for (int tick = 0; tick < 40; ++tick) {
      contact.step(place(-0.9 + 0.04 * tick, -depth));
      if (tick < 2) continue;
      REQUIRE(contact.result.state == FDCG_EDGE);
      REQUIRE(contact.result.slipping == 1);
      const fdcg_connection_info edge = fdcg_get_connection(&mesh.view(), contact.result.feature);
      const fdcg_node_info a = fdcg_get_node(&mesh.view(), edge.node[0]), b = fdcg_get_node(&mesh.view(), edge.node[1]);
      inexact += ((a.flags | b.flags) & FDCG_NODE_INEXACT) != 0;
      const Hip sum = {a.normal[0] + b.normal[0], a.normal[1] + b.normal[1], a.normal[2] + b.normal[2]};
      const Hip direction = {edge.direction[0], edge.direction[1], edge.direction[2]};
      const double held = dot(contact.force(), direction);
      const double load = 2 * dot(along(contact.force(), direction, -held), sum) / dot(sum, sum);
      REQUIRE(std::abs(std::abs(held) / load - mu_d) < 1e-12);
    }
  }
  CHECK(inexact > 0);
}

TEST_CASE("the wedge rule never gives more than 1,024 times the distance from the edge") {
  const PlainGraph graph(v_groove(1e-4), Precision::f64);  // the balance of forces would ask for 20,000 times
  Contact contact(graph.view(), contact_params(0.001, 0.001));
  contact.step(-0.5, 0, 0.4);
  contact.step(-0.5, 0, -0.05);
  REQUIRE(contact.result.state == FDCG_EDGE);
  const double start = contact.god_object()[0];
  const double limit = 0.001 * 1024 * 0.05;
  contact.step(start + limit * 0.999, 0, -0.05);
  CHECK(contact.god_object()[0] == start);
  contact.step(start + 0.2, 0, -0.05);
  CHECK(std::abs(start + 0.2 - limit - contact.god_object()[0]) < 1e-12);
}
