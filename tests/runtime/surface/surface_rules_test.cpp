// SPDX-License-Identifier: Apache-2.0
// What a contact on a surface does, case by case: cones, normals, edges, corners, apexes, jumps, numbers that are none.
#include <cmath>
#include <cstring>
#include <limits>

#include "catch.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// One of each kind, of hand's size.
const fdcg_surface kEach[] = {fdcg_make_plane(),
                              fdcg_make_sphere(0.05),
                              fdcg_make_cylinder(0.04, 0.2),
                              fdcg_make_capsule(0.03, 0.1),
                              fdcg_make_box(0.05, 0.04, 0.06),
                              fdcg_make_cone(0.06, 0.03, 0.15),
                              fdcg_make_torus(0.06, 0.02),
                              fdcg_make_ellipsoid(0.06, 0.04, 0.05)};

fdcg_surface hollow(fdcg_surface surface) {
  surface.is_hollow = 1;
  return surface;
}

// Free, out of the material, and on the way to the side of larger x (of the plane, below).
Place outside(const fdcg_surface& s) {
  if (s.kind == FDCG_SURFACE_PLANE) return {0, 0, 0.1};
  if (s.is_hollow != 0) return {s.kind == FDCG_SURFACE_TORUS ? s.radius_m : 0, 0.001, 0.002};
  return {0.2, 0.001, 0.002};
}

// Pulls the hand `deep` into the material at the side of larger x, moved along the surface by u and v.
Place pressed(const fdcg_surface& s, double deep, double u, double v) {
  if (s.kind == FDCG_SURFACE_PLANE) return {u, v, -deep};
  const Long way = s.is_hollow != 0 ? 1 : -1;  // of x, into the material
  Long low = s.kind == FDCG_SURFACE_TORUS ? s.radius_m : 0, high = 0.2;
  for (int i = 0; i < 100; ++i) {  // x where the surface is at u, v
    const Long middle = (low + high) / 2;
    (outside_distance(s, {middle, u, v}) * way > 0 ? low : high) = middle;
  }
  const Long x = (low + high) / 2;
  return {static_cast<double>(x + way * deep), u, v};
}

struct Split {
  Long load, pull;
};
Split split(const SurfaceContact& contact) {
  const LongPlace force = wide(contact.result.force_n);
  LongPlace n = wide(contact.normal());
  if (contact.result.state == FDCG_FACE)
    n = face_normal(contact.surface(), contact.result.feature, wide(contact.result.god_object_m));
  const Long load = dot(force, n);
  return {load, length(minus(force, {n[0] * load, n[1] * load, n[2] * load}))};
}

}  // namespace

TEST_CASE("a surface's friction breaks away at mu_s and slides at mu_d") {
  const double mu_s = 0.6, mu_d = 0.35;
  for (const bool is_hollow : {false, true}) {
    for (const fdcg_surface& solid : kEach) {
      if (is_hollow && solid.kind == FDCG_SURFACE_PLANE) continue;
      const fdcg_surface surface = is_hollow ? hollow(solid) : solid;
      INFO(describe(surface));
      for (const double deep : {1e-4, 1e-3, 5e-3}) {
        SurfaceContact contact(surface, mu_s, mu_d);
        contact.step(outside(surface));
        contact.step(pressed(surface, deep, 0.001, 0.002));
        REQUIRE(contact.result.state == FDCG_FACE);
        // Until it breaks away the pull grows up to mu_s times the load; from then on it is mu_d times it.
        const Place stuck = contact.god_object();
        int slides = 0;
        for (int i = 0; i < 2000; ++i) {
          const double a = 1e-5 * i;
          contact.step(pressed(surface, deep, 0.001 + 0.8 * a, 0.002 - 0.6 * a));
          REQUIRE(contact.result.state == FDCG_FACE);
          const Split felt = split(contact);
          if (slides == 0 && contact.result.slipping == 0) {
            REQUIRE(contact.god_object() == stuck);
            REQUIRE(felt.pull <= mu_s * felt.load * (1 + 1e-9));
            continue;
          }
          REQUIRE(contact.result.slipping == 1);
          REQUIRE(std::abs(felt.pull / felt.load - mu_d) < 1e-12);
          ++slides;
        }
        CHECK(slides > 100);
      }
    }
  }
}

TEST_CASE("a surface's normals are exact") {
  for (const bool is_hollow : {false, true}) {
    for (const fdcg_surface& solid : kEach) {
      if (is_hollow && solid.kind == FDCG_SURFACE_PLANE) continue;
      SurfaceContact contact(is_hollow ? hollow(solid) : solid, 0, 0);
      INFO(describe(contact.surface()));
      SurfaceHand hand(extent_of(solid), 77);
      int faces = 0;
      for (int i = 0; i < 20000; ++i) {
        contact.step(hand.next());
        if (contact.result.state != FDCG_FACE) continue;
        const LongPlace n = wide(contact.normal());
        if (length(wide(contact.result.god_object_m)) > 10) continue;  // of the plane
        ++faces;
        const Long off = std::hypot(contact.result.god_object_m[0], contact.result.god_object_m[1]);
        if (solid.kind == FDCG_SURFACE_CONE && off < 1e-3 * solid.radius_m) continue;
        // A tube's middle is a place computed: its rounding counts by ring over tube.
        const double bar = solid.kind == FDCG_SURFACE_TORUS ? 4 * solid.radius_m / solid.tube_radius_m : 4;
        REQUIRE(length(minus(n, face_normal(contact.surface(), contact.result.feature, wide(contact.result.god_object_m)))) <=
                bar * kEps);
      }
      CHECK(faces > 1000);
    }
  }
}

TEST_CASE("a tremor about a resting contact moves no god-object in a million ticks") {
  for (const fdcg_surface& surface : kEach) {
    INFO(describe(surface));
    SurfaceContact contact(surface, 0.5, 0.4);
    Random random(surface.kind);
    contact.step(outside(surface));
    contact.step(pressed(surface, 1e-3, 0.001, 0.002));
    const Place start = contact.god_object();
    const Place hip = pressed(surface, 1e-3, 0.001, 0.002);
    for (int i = 0; i < 1000000; ++i)
      contact.step({hip[0] + 1e-4 * random.uniform(-1, 1), hip[1] + 1e-4 * random.uniform(-1, 1),
                    hip[2] + 1e-4 * random.uniform(-1, 1)});
    CHECK(contact.result.state == FDCG_FACE);
    CHECK(contact.god_object() == start);
  }
}

TEST_CASE("after a slide a still hand causes no creep in a million ticks") {
  for (const fdcg_surface& surface : kEach) {
    INFO(describe(surface));
    SurfaceContact contact(surface, 0.5, 0.4);
    contact.step(outside(surface));
    for (int i = 0; i < 300; ++i)
      contact.step(pressed(surface, 1e-3, 0.001 + 1e-5 * i, 0.002 + 2e-5 * i));
    REQUIRE(contact.result.slipping == 1);
    const Place hip = pressed(surface, 1e-3, 0.004, 0.008);
    contact.step(hip);
    const Place start = contact.god_object();
    for (int i = 0; i < 1000000; ++i)
      contact.step(hip);
    CHECK(contact.god_object() == start);
  }
}

TEST_CASE("a jump across a whole surface is held where it came in, and a hand on the far side comes free") {
  for (const fdcg_surface& surface : kEach) {
    if (surface.kind == FDCG_SURFACE_PLANE) continue;
    INFO(describe(surface));
    SurfaceContact held(surface, 3, 2.5), smooth(surface, 0, 0);
    for (SurfaceContact* contact : {&held, &smooth}) {
      contact->step({0.2, 0.001, 0.0012});
      contact->step({-0.2, 0.001, 0.0012});
    }
    // Straight through: the pull is within the cone, and a frictionless one finds its way round.
    CHECK(held.result.state == FDCG_FACE);
    CHECK(held.result.god_object_m[0] > 0);
    if (surface.kind != FDCG_SURFACE_BOX && surface.kind != FDCG_SURFACE_CONE) {
      for (int i = 0; i < 20 && smooth.result.state != FDCG_FREE; ++i)
        smooth.step({-0.2, 0.001, 0.0012});
      CHECK(smooth.result.state == FDCG_FREE);
    }
  }
}

TEST_CASE("from inside a torus's tube the god-object never leaps to the other side of the ring") {
  const fdcg_surface torus = fdcg_make_torus(0.06, 0.02);
  for (const double mu : {0.0, 0.4}) {
    SurfaceContact contact(torus, mu, mu);
    contact.step({0.1, 0, 0.001});
    // Through the tube, through the hole, and into the far side of the ring.
    Place before = {0.08, 0, 0};
    for (int i = 0; i <= 4000; ++i) {
      const double x = 0.1 - 0.155 * i / 4000;
      contact.step({x, 0, 0.001});
      if (contact.result.state == FDCG_FREE) continue;
      const Place at = contact.god_object();
      if (i > 0 && contact.result.transitions == 0) REQUIRE(std::hypot(at[0] - before[0], at[1] - before[1]) < 0.05);
      before = at;
    }
    // Where friction is none the god-object has gone round the tube, been free in the hole and met the far side from there.
    if (mu == 0) CHECK(before[0] < -0.039);
    if (mu == 0) CHECK(contact.result.state == FDCG_FACE);
  }
}

TEST_CASE("in a hollow box the god-object goes along walls into edges and corners, and rests there") {
  SurfaceContact contact(hollow(fdcg_make_box(0.05, 0.04, 0.06)), 0, 0);
  contact.step({0, 0, 0});
  contact.step({0.06, 0.01, 0.02});
  CHECK(contact.result.state == FDCG_FACE);
  CHECK(contact.result.feature == 1);
  contact.step({0.06, 0.05, 0.02});
  CHECK(contact.result.state == FDCG_EDGE);
  CHECK(contact.result.feature == 4 * 2 + 1 + 2);
  CHECK(contact.god_object() == Place{0.05, 0.04, 0.02});
  contact.step({0.06, 0.05, -0.07});
  CHECK(contact.result.state == FDCG_VERTEX);
  CHECK(contact.result.feature == 1 + 2);
  CHECK(contact.god_object() == Place{0.05, 0.04, -0.06});
  contact.step({0.06, -0.05, -0.07});
  CHECK(contact.god_object() == Place{0.05, -0.04, -0.06});
  contact.step({0.04, -0.03, -0.05});
  CHECK(contact.result.state == FDCG_FREE);
}

TEST_CASE("on a hollow box's edge friction along it is that of both loads, or the paper's") {
  for (const std::uint32_t edge_friction : {FDCG_EDGE_WEDGE, FDCG_EDGE_PAPER}) {
    const fdcg_surface surface = hollow(fdcg_make_box(0.1, 0.1, 0.1));
    fdcg_params params = fdcg_make_params();
    params.mu_static = params.mu_dynamic = 0.3;
    params.edge_friction = edge_friction;
    fdcg_contact contact = {};
    fdcg_result result;
    const auto step = [&](double x, double y, double z) {
      const double hip[3] = {x, y, z};
      fdcg_surface_step(&surface, &params, &contact, hip, &result);
    };
    step(0, 0, 0);
    step(0.103, 0.104, 0);
    for (int i = 0; i < 20; ++i)
      step(0.103, 0.104, 0.002 * i);
    REQUIRE(result.state == FDCG_EDGE);
    const double load = edge_friction == FDCG_EDGE_WEDGE ? 0.003 + 0.004 : 0.005;
    CHECK(-result.force_n[2] / 1000 == Approx(-0.3 * load * -1).epsilon(1e-12));
  }
}

TEST_CASE("in a hollow cylinder the god-object rests in the rim, and in a hollow cone in the apex") {
  SurfaceContact cylinder(hollow(fdcg_make_cylinder(0.04, 0.2)), 0.2, 0.2);
  cylinder.step({0, 0, 0});
  cylinder.step({0.05, 0, 0.08});
  CHECK(cylinder.result.state == FDCG_FACE);
  cylinder.step({0.05, 0, 0.12});
  for (int i = 0; i < 5; ++i)
    cylinder.step({0.05, 0, 0.12});
  CHECK(cylinder.result.state == FDCG_EDGE);
  CHECK(cylinder.result.feature == 1);
  CHECK(cylinder.god_object() == Place{0.04, 0, 0.1});
  // Round the rim: the pull along it is mu times the sum of both loads.
  for (int i = 0; i <= 100; ++i) {
    const double a = 0.02 * i;
    cylinder.step({0.05 * std::cos(a), 0.05 * std::sin(a), 0.12});
  }
  REQUIRE(cylinder.result.state == FDCG_EDGE);
  const Place go = cylinder.god_object();
  const LongPlace out = {go[0] / 0.04L, go[1] / 0.04L, 0}, round = {-out[1], out[0], 0};
  const LongPlace force = wide(cylinder.result.force_n);
  CHECK(std::abs(dot(force, round)) / (-dot(force, out) - force[2]) == Approx(0.2).epsilon(1e-9));

  SurfaceContact cone(hollow(fdcg_make_cone(0.06, 0, 0.1)), 0, 0);
  cone.step({0, 0, 0});
  cone.step({0.001, 0.0005, 0.07});
  CHECK(cone.result.state == FDCG_VERTEX);
  CHECK(cone.result.feature == 1);
  CHECK(cone.god_object() == Place{0, 0, 0.05});
  cone.step({0, 0, 0.02});
  CHECK(cone.result.state == FDCG_FREE);
}

TEST_CASE("a jump that goes round a hollow cone's rim leaves it where one face alone holds the HIP") {
  SurfaceContact cone(hollow(fdcg_make_cone(0.931, 0.372, 0.722)), 0, 0);
  cone.step({0, 0, 0});
  for (int i = 0; i < 3; ++i)
    cone.step({-1.2, 0.48, -0.6});
  REQUIRE(cone.result.state == FDCG_EDGE);
  cone.step({0.0804, 1.0997, 0.6926});
  const Place at = cone.god_object();
  CHECK(cone.result.state == FDCG_FACE);
  cone.step({0.0804, 1.0997, 0.6926});
  CHECK(cone.god_object() == at);
}

TEST_CASE("a HIP that passes beside a surface, or touches it and no more, is not caught") {
  SurfaceContact sphere(fdcg_make_sphere(0.05), 1, 1), box(fdcg_make_box(0.05, 0.05, 0.05), 1, 1);
  for (SurfaceContact* contact : {&sphere, &box}) {
    contact->step({-0.2, 0.05, 0});  // along a tangent, along a face
    contact->step({0.2, 0.05, 0});
    CHECK(contact->result.state == FDCG_FREE);
  }
  box.step({0.2, -0.1, 0});  // over an edge
  box.step({-0.1, 0.2, 0});
  CHECK(box.result.state == FDCG_FREE);
  SurfaceContact torus(fdcg_make_torus(0.06, 0.02), 1, 1);
  torus.step({0.001, 0.002, 0.2});  // through the hole
  torus.step({0.002, 0.001, -0.2});
  CHECK(torus.result.state == FDCG_FREE);
}

TEST_CASE("a finger that starts in the material passes out of it") {
  for (const fdcg_surface& surface : kEach) {
    SurfaceContact contact(surface, 1, 1);
    INFO(describe(surface));
    contact.step(pressed(surface, 1e-3, 0.001, 0.002));
    CHECK(contact.result.state == FDCG_FREE);
    contact.step(outside(surface));
    CHECK(contact.result.state == FDCG_FREE);
    contact.step(pressed(surface, 1e-3, 0.001, 0.002));
    CHECK(contact.result.state == FDCG_FACE);
  }
}

TEST_CASE("a NaN HIP moves nothing, gives no force and is counted") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
  for (const fdcg_surface& surface : kEach) {
    SurfaceContact contact(surface, 0.5, 0.4);
    contact.step(outside(surface));
    const Place hip = pressed(surface, 1e-3, 0.001, 0.002);
    contact.step(hip);
    const fdcg_contact before = contact.state;
    std::uint64_t count = 0;
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e111}) {
      for (int k = 0; k < 3; ++k) {
        Place worse = hip;
        worse[k] = bad;
        contact.step(worse);
        CHECK(contact.result.flags == FDCG_RESULT_NON_FINITE);
        for (const double f : contact.result.force_n)
          CHECK(f == 0);
        CHECK(contact.state.non_finite_ticks == ++count);
      }
    }
    fdcg_contact after = contact.state;
    after.non_finite_ticks = before.non_finite_ticks;
    CHECK(std::memcmp(&before, &after, sizeof before) == 0);
  }
}

TEST_CASE("any bit pattern of a HIP keeps the contact valid") {
  for (const bool is_hollow : {false, true}) {
    for (const fdcg_surface& solid : kEach) {
      if (is_hollow && solid.kind == FDCG_SURFACE_PLANE) continue;
      SurfaceContact contact(is_hollow ? hollow(solid) : solid, 0.5, 0.4);
      INFO(describe(contact.surface()));
      Random random(solid.kind + 100);
      for (int i = 0; i < 20000; ++i) {
        Place hip;
        for (double& x : hip) {
          const std::uint64_t bits = random.bits();
          if (random.chance(0.5)) {
            std::memcpy(&x, &bits, sizeof x);
          } else {
            x = random.uniform(-0.1, 0.1);
          }
        }
        contact.step(hip);
        for (int k = 0; k < 3; ++k) {
          REQUIRE(std::isfinite(contact.state.god_object[k]));
          REQUIRE(std::isfinite(contact.result.force_n[k]));
        }
      }
    }
  }
}

TEST_CASE("a walk over every surface gives the same bits with every compiler") {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  const auto add = [&hash](const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i)
      hash = (hash ^ byte[i]) * 0x100000001B3u;
  };
  for (const bool is_hollow : {false, true}) {
    for (const fdcg_surface& solid : kEach) {
      if (is_hollow && solid.kind == FDCG_SURFACE_PLANE) continue;
      SurfaceContact contact(is_hollow ? hollow(solid) : solid, 0.5, 0.3);
      Random random(solid.kind);
      Place hip = outside(contact.surface());
      for (int i = 0; i < 4000; ++i) {
        const bool jumps = random.chance(0.02);
        for (double& x : hip)
          x = jumps ? random.uniform(-0.08, 0.08) : x * 0.999 + random.uniform(-0.002, 0.002);
        contact.step(hip);
        add(&contact.result, sizeof contact.result);
      }
    }
  }
  CHECK(hash == 0xd4c0f4b144305047u);
}
