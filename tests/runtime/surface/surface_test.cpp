// SPDX-License-Identifier: Apache-2.0
// The rules of the contact model on every surface, under a hand that does all that a hand should not. FDCG_STEPS in the
// environment sets the steps of each walk.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "catch.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;

namespace {

constexpr Long kEps = std::numeric_limits<double>::epsilon();

int steps_of_a_walk(int usual) {
  const char* const asked = std::getenv("FDCG_STEPS");
  return asked != nullptr ? std::atoi(asked) : usual;
}

struct Friction {
  double mu_static, mu_dynamic;
};
constexpr Friction kFrictions[] = {{0, 0}, {0.3, 0.2}, {0.8, 0.5}, {3, 2.5}};

// The inverse of the least radius of curvature; of a cone that of its wider end.
Long sharpest_bend(const fdcg_surface& s) {
  if (s.kind == FDCG_SURFACE_PLANE || s.kind == FDCG_SURFACE_BOX) return 0;
  if (s.kind == FDCG_SURFACE_TORUS) return 1 / Long(s.tube_radius_m);
  if (s.kind != FDCG_SURFACE_ELLIPSOID) return 1 / Long(std::max(s.radius_m, s.top_radius_m));
  const Long least = std::min({s.half_m[0], s.half_m[1], s.half_m[2]});
  return extent_of(s) / (least * least);
}

// Judges one step after another.
class Judge {
 public:
  explicit Judge(const SurfaceContact& contact) : contact_(contact), extent_(extent_of(contact.surface())) {}

  void look(const Place& hip_given) {
    const fdcg_result& felt = contact_.result;
    const LongPlace hip = wide(hip_given), god_object = wide(felt.god_object_m);
    INFO(describe(contact_.surface()) << ", step " << steps_++ << " HIP " << hip_given[0] << " " << hip_given[1] << " "
                                      << hip_given[2] << " GO " << felt.god_object_m[0] << " " << felt.god_object_m[1] << " "
                                      << felt.god_object_m[2] << " state " << felt.state << " feature " << felt.feature
                                      << " slipping " << felt.slipping << " transitions " << felt.transitions << " flags "
                                      << felt.flags << " last state " << last_.state << " " << last_.feature);
    const Long far = std::max<Long>(extent_, length(hip));
    if (felt.state == FDCG_FREE) {
      // Nobody falls through: who was outside or in contact is outside.
      const Long outside = outside_distance(contact_.surface(), hip);
      if (is_in_front_) REQUIRE(outside >= -16 * kEps * far);
      is_in_front_ = outside >= 0 || (is_in_front_ && outside >= -16 * kEps * far);
      REQUIRE(felt.force_n[0] == 0);
      REQUIRE(felt.slipping == 0);
    } else {
      is_in_front_ = true;
      ++touches_;
      look_at_contact(hip, god_object);
    }
    bounds_ += felt.flags != 0;
    if (last_.state != FDCG_FREE && felt.state != FDCG_FREE && felt.transitions == 0) {
      const Long before = length(minus(wide(last_.god_object_m), hip)), after = length(minus(god_object, hip));
      REQUIRE(after <= before + 8 * kEps * far);
    }
    last_ = felt;
  }
  [[nodiscard]] int touches() const { return touches_; }
  [[nodiscard]] int bounds() const { return bounds_; }
  [[nodiscard]] Long worst_off() const { return worst_off_; }

 private:
  void look_at_contact(const LongPlace& hip, const LongPlace& god_object) {
    const fdcg_result& felt = contact_.result;
    const fdcg_surface& surface = contact_.surface();
    const Long off = std::abs(outside_distance(surface, god_object));
    const Long reach = surface.kind == FDCG_SURFACE_PLANE ? std::max<Long>(1, length(god_object)) : extent_;
    worst_off_ = std::max(worst_off_, off / (kEps * reach));
    REQUIRE(off <= 8 * kEps * reach);
    const LongPlace spring = minus(god_object, hip);
    for (int k = 0; k < 3; ++k)
      REQUIRE(std::abs(felt.force_n[k] - contact_.params().stiffness_n_per_m * spring[k]) <=
              4 * kEps * contact_.params().stiffness_n_per_m * (length(spring) + length(hip)));
    const LongPlace normal = wide(contact_.normal());
    const Long load = dot(spring, normal);
    const Long rounding = 16 * kEps * std::max<Long>(extent_, length(hip));
    REQUIRE(load >= -rounding);                                                              // never pulls
    if (felt.state != FDCG_FACE || felt.flags != 0 || length(hip) > 1000 * extent_) return;  // of a far HIP nothing is left
    // Beside an apex by rounding the side's normal is rounding too; the place, and so the force, is right.
    if (surface.kind == FDCG_SURFACE_CONE && std::hypot(god_object[0], god_object[1]) < 64 * kEps * extent_) return;
    const Long pull = length(minus(spring, {normal[0] * load, normal[1] * load, normal[2] * load}));
    // The normal turns over the rounding of a place, by what the surface bends; a HIP far below makes much of it.
    const Long doubt = 8 * rounding * (1 + sharpest_bend(surface) * (load + pull));
    REQUIRE(pull <= contact_.params().mu_static * load + doubt);
    if (felt.slipping == 0) return;
    const Long held = contact_.params().mu_dynamic * load;
    REQUIRE(pull <= held * (1 + 1e-12L) + doubt);
    REQUIRE(pull >= held * (1 - 0x1p-20L) - doubt);  // what friction holds by less slips no more
  }

  const SurfaceContact& contact_;
  double extent_;
  fdcg_result last_{};
  bool is_in_front_ = false;
  int touches_ = 0, bounds_ = 0, steps_ = 0;
  Long worst_off_ = 0;
};

void walk_about(const fdcg_surface& surface, const Friction& friction, std::uint64_t seed, int steps, int* touches,
                int* bounds) {
  SurfaceContact contact(surface, friction.mu_static, friction.mu_dynamic);
  SurfaceHand hand(extent_of(surface), seed);
  Judge judge(contact);
  INFO(describe(surface) << ", seed " << seed << " mu " << friction.mu_static << " " << friction.mu_dynamic);
  for (int i = 0; i < steps; ++i) {
    const Place hip = hand.next();
    contact.step(hip);
    judge.look(hip);
    if (i % 16 != 0 || contact.result.flags != 0) continue;
    // A still HIP moves nothing.
    const fdcg_result before = contact.result;
    INFO("still after step " << i << " transitions " << before.transitions << " state " << before.state << " feature "
                             << before.feature << " HIP " << hip[0] << " " << hip[1] << " " << hip[2] << " GO "
                             << before.god_object_m[0] << " " << before.god_object_m[1] << " " << before.god_object_m[2]);
    contact.step(hip);
    judge.look(hip);
    REQUIRE(std::memcmp(before.god_object_m, contact.result.god_object_m, sizeof before.god_object_m) == 0);
    REQUIRE(contact.result.state == before.state);
  }
  *touches += judge.touches();
  *bounds += judge.bounds();
}

}  // namespace

TEST_CASE("on every surface the god-object stays on it, approaches the HIP, respects the friction cone, and is not lost") {
  for (std::uint32_t kind = FDCG_SURFACE_PLANE; kind <= FDCG_SURFACE_ELLIPSOID; ++kind) {
    for (const bool is_hollow : {false, true}) {
      int touches = 0, bounds = 0, steps = 0;
      for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Random random(seed * 31 + kind);
        const double size = seed % 4 == 0 ? 1e-6 : (seed % 4 == 1 ? 1e6 : 1);
        const fdcg_surface surface = random_surface(kind, is_hollow, size, size == 1 && seed % 3 == 0 ? 1000 : 5, random);
        fdcg_error error;
        if (fdcg_check_surface(&surface, &error) != FDCG_OK) FAIL(error.message);
        const int count = steps_of_a_walk(1000);
        walk_about(surface, kFrictions[seed % 4], seed, count, &touches, &bounds);
        steps += count;
      }
      INFO(name_of(kind) << " hollow " << is_hollow << ": " << touches << " of " << steps << " steps in contact, " << bounds
                         << " at a bound");
      CHECK(touches > steps / 20);
      CHECK(bounds < steps / 100);
    }
  }
}
