// SPDX-License-Identifier: Apache-2.0
// The bound on the rules: where a jump crosses more features than one tick has work for, the rest is carried over with the
// god-object on the surface and ever nearer to the HIP, and without friction it ends, bit for bit, where an unbounded step
// does.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::PolygonSoup;
using fdcg::bake::Precision;

// servo_step.cpp again, with an unlimited work budget.
extern "C" void fdcg_step_unbounded(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                                    const double hip_object_m[3], fdcg_result* result);

namespace {

constexpr std::uint32_t kCarried = FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND;

struct Jumps {
  int carried = 0;     // jumps that took more than one tick
  int most_ticks = 0;  // of one jump
};

// Jumps about the body; each HIP is held until the step is done with it.
Jumps jump_about(const PolygonSoup& soup, const CompileOptions& options, double mu, std::uint64_t seed, int jumps) {
  constexpr int kMostTicks = 3000;
  const CompiledMesh mesh(soup, options);
  const double size = extent(soup), eps = options.precision == Precision::f64 ? 0x1p-52 : 0x1p-23;
  const fdcg_params params = contact_params(mu, mu);
  Random random(seed);
  Jumps seen;
  fdcg_contact bounded = {}, unbounded = {};
  fdcg_result result, expected;
  for (int i = 0; i < jumps; ++i) {
    Hip hip;
    for (double& x : hip)
      x = random.uniform(-0.9, 0.9) * size;
    if (i % 3 == 1 && result.state != FDCG_FREE) {  // along the surface, below it
      for (int k = 0; k < 3; ++k)
        hip[k] = result.god_object_m[k] + random.uniform(-0.3, 0.3) * size;
    }
    const fdcg_contact start = bounded;
    if (mu == 0) {
      unbounded = bounded;
      fdcg_step_unbounded(&mesh.view(), &params, &unbounded, hip.data(), &expected);
      REQUIRE((expected.flags & kCarried) == 0);
    }
    double gap = 4 * size;
    int ticks = 0;
    do {
      fdcg_step(&mesh.view(), &params, &bounded, hip.data(), &result);
      INFO(soup.name << ", mu " << mu << ", seed " << seed << ", jump " << i << ", tick " << ticks);
      REQUIRE(++ticks < kMostTicks);
      if (result.state == FDCG_FREE) continue;
      const Hip god_object = {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]};
      REQUIRE(distance(closest_point(soup, god_object), god_object) <= 64 * eps * size);
      const double now = distance(god_object, hip);
      if (start.state != FDCG_FREE || ticks > 1) REQUIRE(now <= gap + 16 * eps * size);
      gap = now;
    } while ((result.flags & kCarried) != 0);
    seen.carried += ticks > 1;
    seen.most_ticks = std::max(seen.most_ticks, ticks);
    if (mu == 0) {
      INFO(soup.name << ", seed " << seed << ", jump " << i << ", ticks " << ticks);
      CHECK(result.state == expected.state);
      CHECK(result.feature == expected.feature);
      CHECK(std::memcmp(result.god_object_m, expected.god_object_m, sizeof expected.god_object_m) == 0);
    }
  }
  return seen;
}

}  // namespace

TEST_CASE("a jump across many features is carried over, ever nearer, and ends where an unbounded step does") {
  const PolygonSoup bodies[] = {
      needle_strip(800, 0.3, 2), star_sphere(3, 0.4, 3), spiky_sphere(3, 1.5, 3), prism(500), ico_sphere(4), cone(500)};
  int carried = 0;
  for (const PolygonSoup& soup : bodies) {
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      CompileOptions options;
      options.precision = precision;
      for (const double mu : {0.0, 0.3}) {
        const Jumps seen = jump_about(soup, options, mu, 7, 60);
        carried += seen.carried;
      }
    }
  }
  CHECK(carried > 50);
}

// In floats, from 10^9 sizes away, no move on the object changes the rounded distance: that is no circle.
TEST_CASE("a god-object crosses any number of faces towards a HIP that is too far away for its distance to change") {
  constexpr int kStrips = 18;  // 36 features, within one tick's work
  CompileOptions options;
  options.precision = Precision::f32;
  options.merge = false;
  const CompiledMesh mesh(grid_box(kStrips, 1, 1, {1, 1, 1}), options);
  Contact contact(mesh.view(), contact_params(0, 0));
  contact.step(-0.49, 0.01, 0.6);
  contact.step(-0.49, 0.01, 0.45);
  REQUIRE(contact.result.state == FDCG_FACE);
  contact.step(1e9, 0.01, -1e9);
  INFO(contact.describe());
  CHECK(contact.result.transitions > 2 * (kStrips - 1));
  CHECK(contact.result.state == FDCG_FREE);  // past the far rim
  CHECK(norm(contact.force()) == 0);
}

// In floats a god-object near the corner of a long pit goes over thousands of faces, by less than changes the distance of a far
// HIP. The tick that ends on its way says so: else it would be a rest, with force in free air, that the next tick leaves.
TEST_CASE("a walk around the corner of a long pit is carried over, however far away the HIP is") {
  constexpr int kWalks = 200, kMostTicks = 2000;
  const Rotation turn = random_rotation(3);
  const auto placed = [&](const Hip& p) {  // in the pit's frame, before it is turned and made long
    PolygonSoup one;
    one.points = {{p[0], p[1], p[2]}};
    const fdcg::bake::Vec3 at = transformed(one, turn).points[0];
    return Hip{1000 * at.x, at.y, at.z};
  };
  PolygonSoup pit = transformed(triangulated(cone_pit(10'000)), turn);
  for (fdcg::bake::Vec3& p : pit.points)
    p.x *= 1000;
  CompileOptions options;
  options.precision = Precision::f32;
  const CompiledMesh mesh(pit, options);
  Random random(4);
  int carried = 0, left = 0;
  for (int i = 0; i < kWalks; ++i) {
    Contact contact(mesh.view(), contact_params(0, 0));
    contact.step(placed({0, 0, 0.05}));
    contact.step(placed({random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), -1e-3}));
    if (contact.result.state == FDCG_FREE) continue;
    const Hip far = {random.uniform(-1, 1), random.uniform(-200, 200), random.uniform(-200, 200)};
    int ticks = 0;
    do
      contact.step(far);
    while ((contact.result.flags & kCarried) != 0 && ++ticks < kMostTicks);
    carried += ticks > 0;
    const Hip rest = contact.god_object();
    contact.step(far);
    left += distance(contact.god_object(), rest) > 0;
  }
  CHECK(carried > 10);
  CHECK(left == 0);
}
