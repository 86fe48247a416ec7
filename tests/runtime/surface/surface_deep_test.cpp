// SPDX-License-Identifier: Apache-2.0
// Slides of a hand deep in the material, beyond an axis or a centre of curvature, where there are several places at which
// friction would hold the god-object, or none near by. FDCG_STEPS in the environment sets the hands of each kind.
#include <cmath>
#include <cstdlib>

#include "catch.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;

namespace {

struct Cone {
  Long load, ratio;  // of the pull to the load
};
Cone cone_of(const SurfaceContact& contact, const Place& hip) {
  const LongPlace at = wide(contact.result.god_object_m), spring = minus(at, wide(hip));
  const LongPlace n = face_normal(contact.surface(), contact.result.feature, at);
  const Long load = dot(spring, n);
  return {load, length(minus(spring, {n[0] * load, n[1] * load, n[2] * load})) / load};
}

Place somewhere(double reach, Random& random) {
  return {reach * random.uniform(-1, 1), reach * random.uniform(-1, 1), reach * random.uniform(-1, 1)};
}

struct Count {
  int slides = 0, deep = 0, jumps = 0;
};

// One hand that touches a surface of about 1 m, goes in anywhere and wanders there.
void wander(const SurfaceContact& given, Random& random, Count* count) {
  SurfaceContact contact = given;
  const fdcg_surface& surface = contact.surface();
  const double extent = extent_of(surface), mu_s = contact.params().mu_static, mu_d = contact.params().mu_dynamic;
  Place hip = somewhere(1.3 * extent, random);
  for (int i = 0; i < 50 && outside_distance(surface, wide(hip)) < 0; ++i)
    hip = somewhere(1.3 * extent, random);
  contact.step(hip);
  for (int i = 0; i < 12; ++i) {
    const Place move = somewhere(extent * std::pow(10, random.uniform(-3, 0)), random);
    for (std::size_t k = 0; k < 3; ++k)
      hip[k] = i == 0 ? hip[k] * random.uniform(-0.3, 0.9) : hip[k] + 0.7 * move[k];
    const fdcg_result before = contact.result;
    contact.step(hip);
    const fdcg_result& felt = contact.result;
    if (felt.state != FDCG_FACE || felt.flags != 0) continue;
    if (surface.kind == FDCG_SURFACE_CONE && std::hypot(felt.god_object_m[0], felt.god_object_m[1]) < 0.02 * extent) continue;
    const Cone cone = cone_of(contact, hip);
    if (!(cone.load > 0.01 * extent)) continue;  // its rounding is that of places
    INFO(describe(surface) << " mu " << mu_s << " " << mu_d << " HIP " << hip[0] << " " << hip[1] << " " << hip[2]
                           << " after GO " << before.god_object_m[0] << " " << before.god_object_m[1] << " "
                           << before.god_object_m[2]);
    if (felt.slipping == 0) {
      REQUIRE(cone.ratio <= mu_s * (1 + 1e-12L));
      continue;
    }
    // What friction holds within the bound of contact-model FRIC-4 still counts as slipping; what it has moved is on the cone.
    const bool has_moved =
        before.state == FDCG_FACE && felt.transitions == 0 &&
        contact.god_object() != Place{before.god_object_m[0], before.god_object_m[1], before.god_object_m[2]};
    REQUIRE(cone.ratio <= mu_d * (1 + 1e-12L));
    REQUIRE(cone.ratio >= mu_d * (1 - (has_moved ? 1e-12L : 0x1p-20L)));
    count->slides += has_moved;
    count->deep += has_moved && cone.load > 0.6L * extent;
    count->jumps += has_moved && length(minus(wide(felt.god_object_m), wide(before.god_object_m))) > 0.3L * extent;
  }
}

}  // namespace

TEST_CASE("a slide ends where the pull is mu_d times the load, however deep the hand is") {
  const char* const asked = std::getenv("FDCG_STEPS");
  const int hands = asked != nullptr ? std::atoi(asked) : 3000;
  for (std::uint32_t kind = FDCG_SURFACE_SPHERE; kind <= FDCG_SURFACE_ELLIPSOID; ++kind) {
    for (const bool is_hollow : {false, true}) {
      Random random(2 * kind + (is_hollow ? 1 : 0));
      Count count;
      for (int i = 0; i < hands; ++i) {
        const fdcg_surface surface = random_surface(kind, is_hollow, 1, 5, random);
        const double mu_d = random.uniform(0.05, 1.5), mu_s = random.chance(0.5) ? mu_d : 1.3 * mu_d;
        wander(SurfaceContact(surface, mu_s, mu_d), random, &count);
      }
      INFO(name_of(kind) << " hollow " << is_hollow << ": " << count.slides << " slides, " << count.deep << " deep, "
                         << count.jumps << " far");
      CHECK(count.slides > hands / 10);
      CHECK(count.jumps > 0);
      if (is_hollow) continue;
      CHECK(count.deep > hands / 200);
      CHECK(count.jumps > hands / 50);
    }
  }
}

TEST_CASE("a hand beyond a cylinder's axis slides the god-object to its cone") {
  SurfaceContact contact(fdcg_make_cylinder(0.03, 0.1), 0.4, 0.4);
  contact.step({0.045, 0, 0});
  contact.step({-0.00417188, 0, 0});
  const Place hip = {-0.00417188, 0.00803284, -0.0397993};
  contact.step(hip);
  CHECK(contact.result.slipping == 1);
  CHECK(std::abs(cone_of(contact, hip).ratio - 0.4L) < 1e-12L);
}

TEST_CASE("a slide that turns back rests at once, and counts as slipping while friction holds it by a hair") {
  SurfaceContact contact(fdcg_make_box(0.03, 0.03, 0.03), 0.4, 0.4);
  contact.step({0.045, 0, 0});
  Place before = {};
  int moved = 0, hair = 0;
  for (int i = 0; i < 1500; ++i) {
    const Place hip = {0.0295 * std::cos(1e-3 * i), 0.0295 * std::sin(1e-3 * i), 0};
    contact.step(hip);
    const Long ratio = cone_of(contact, hip).ratio, below = 1 - ratio / 0.4L;
    if (contact.god_object() != before && contact.result.slipping != 0) {
      ++moved;
      REQUIRE(std::abs(below) < 1e-12L);
    } else if (contact.result.slipping != 0) {
      ++hair;
      REQUIRE(below < 0x1p-20L);
    } else {
      REQUIRE(below >= -1e-12L);
    }
    before = contact.god_object();
  }
  CHECK(moved > 1000);
  CHECK(hair > 0);
  CHECK(contact.result.slipping == 0);
}
