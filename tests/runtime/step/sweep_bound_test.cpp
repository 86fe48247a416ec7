// SPDX-License-Identifier: Apache-2.0
// The bound on the free-space sweep: where thousands of faces share a point the work is carried over from tick to tick, gets on
// in each of them, and ends where an unbounded sweep would have.
#include <cmath>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "drilled_plate.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "step/contact_internals.hpp"

using fdcg::internals_of;
using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

constexpr int kFaces = 10000;

struct Arrival {
  int ticks = 0;  // until the sweep was done
  fdcg_result result{};
};

// Starts at `from`, goes to `to` in one tick and stays there until the sweep is done.
Arrival arrive(const fdcg_graph& graph, const Hip& from, const Hip& to) {
  constexpr int kMostTicks = 20000;
  Contact contact(graph, contact_params(0.5, 0.5));
  contact.step(from);
  Arrival arrival;
  do {
    const fdcg_contact before = contact.state;
    contact.step(to);
    ++arrival.ticks;
    INFO("tick " << arrival.ticks << ": " << contact.describe());
    REQUIRE(arrival.ticks < kMostTicks);
    if ((contact.result.flags & FDCG_RESULT_SWEEP_BOUND) == 0) break;
    REQUIRE(contact.result.state == FDCG_FREE);
    REQUIRE(norm(contact.force()) == 0);
    REQUIRE(internals_of(contact.state).sweep.is_carried == 1);
    // The god-object stays where its way begins, unless that way is done and the next begins.
    const Hip stood = {before.god_object[0], before.god_object[1], before.god_object[2]};
    const bool is_same_way = distance(stood, contact.god_object()) == 0;
    if (internals_of(before).sweep.is_carried != 0 && is_same_way)
      REQUIRE(internals_of(contact.state).sweep.next_leaf > internals_of(before).sweep.next_leaf);
  } while (true);
  REQUIRE(internals_of(contact.state).sweep.is_carried == 0);
  REQUIRE(contact.state.sweep_bound_ticks == static_cast<std::uint64_t>(arrival.ticks - 1));
  arrival.result = contact.result;
  return arrival;
}

// A closed body of `needles` thin pyramids whose tips all stand at the origin: a cone's floor below, its mantle of needles.
PolygonSoup needle_cone(int needles, double radius) {
  PolygonSoup soup = cone(needles);
  for (auto& point : soup.points) {
    point.x *= radius;
    point.y *= radius;
    point.z -= 1;
  }
  return soup;
}

}  // namespace

TEST_CASE("a sweep through the apex of ten thousand faces terminates") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    CompileOptions options;
    options.precision = precision;
    const CompiledMesh mesh(cone(kFaces), options);
    const struct {
      Hip from, to;
      bool is_met;
    } ways[] = {
        {{0, 0, 1.5}, {0, 0, 0.5}, true},                // down the axis
        {{0.5, 0.2, 1}, {-0.5, -0.2, 1}, false},         // across the apex, level: never behind a face that it passes
        {{0.1, 0.04, 1.5}, {-0.02, -0.008, 0.9}, true},  // slantwise through it, into the body
        {{0, 1e-9, 1.5}, {0, 1e-9, 0.5}, true},          // beside it
        {{3, 3, 3}, {0.0003, 0.0001, 0.9}, true},
    };
    for (const auto& way : ways) {
      const Arrival arrival = arrive(mesh.view(), way.from, way.to);
      INFO("to " << way.to[0] << ' ' << way.to[1] << ' ' << way.to[2] << ", " << arrival.ticks << " ticks");
      CHECK((arrival.result.state != FDCG_FREE) == way.is_met);
      CHECK(arrival.ticks < 2000);
    }
  }
}

TEST_CASE("a hand that meets a plate of needles feels it in the same tick") {
  constexpr double kSize = 0.05, kFastest = 1;  // m, m/s at 1 kHz
  constexpr int kTurns = 5, kWays = 200;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    CompileOptions options;
    options.precision = precision;
    Random random(3);
    int met = 0, late = 0;
    for (int i = 0; i < kTurns; ++i) {
      const CompiledMesh mesh(transformed(scaled(drilled_plate(512), kSize), random_rotation(random.bits())), options);
      for (int k = 0; k < kWays; ++k) {
        const auto out = random.direction(), aim = random.direction();
        const double tick = 1e-3 * kFastest * std::pow(10, -2 * random.unit()), far = 0.7 * kSize * (1 + random.unit());
        const Hip from = {far * out.x, far * out.y, far * out.z}, to = {kSize * aim.x, kSize * aim.y, kSize * aim.z};
        const double ticks = distance(from, to) / tick;
        Contact contact(mesh.view(), contact_params(0, 0));
        for (int t = 0; t < ticks && contact.result.state == FDCG_FREE; ++t) {
          contact.step(from[0] + (to[0] - from[0]) * t / ticks, from[1] + (to[1] - from[1]) * t / ticks,
                       from[2] + (to[2] - from[2]) * t / ticks);
          late += (contact.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;
        }
        met += contact.result.state != FDCG_FREE;
      }
    }
    INFO(met << " hands met the plate");
    CHECK(met > 200);
    CHECK(late <= (precision == Precision::f64 ? 0 : met / 50));  // in floats more needles are within rounding of a way
  }
}

TEST_CASE("ten thousand needles with one tip neither block a sweep forever nor let it pass") {
  const CompiledMesh mesh(needle_cone(kFaces, 1e-3));
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const double tilt = i < 10 ? 0.0 : 1e-4 * random.unit();
    const Arrival arrival = arrive(mesh.view(), {tilt, 0, 0.1}, {0, 1e-5 * random.unit(), -0.2});
    INFO(i << ": " << arrival.ticks << " ticks");
    CHECK(arrival.result.state != FDCG_FREE);
  }
}

TEST_CASE("with and without a hierarchy a bounded sweep ends on the same feature") {
  CompileOptions bare;
  bare.without = {"hierarchy"};
  const PolygonSoup soup = spiky_sphere(3, 0.8, 3);  // 1,280 faces
  const CompiledMesh with(soup), without(soup, bare);
  Random random(9);
  int bounded = 0;
  for (int i = 0; i < 300; ++i) {
    const auto out = random.direction(), in = random.direction();
    const Hip from = {3 * out.x, 3 * out.y, 3 * out.z};
    const Hip to = i % 2 == 0 ? Hip{0.3 * in.x, 0.3 * in.y, 0.3 * in.z} : Hip{3 * in.x, 3 * in.y, 3 * in.z};
    const Arrival a = arrive(with.view(), from, to), b = arrive(without.view(), from, to);
    INFO("seed 9, way " << i);
    CHECK(a.result.state == b.result.state);
    CHECK(a.result.feature == b.result.feature);
    CHECK(a.result.god_object_m[0] == b.result.god_object_m[0]);
    bounded += b.ticks > 1;
  }
  CHECK(bounded > 0);
}

TEST_CASE("a HIP that moves on during a carried sweep contacts where it crossed the surface") {
  const CompiledMesh mesh(cone(kFaces));
  Contact contact(mesh.view(), contact_params(0.2, 0.2));
  contact.step(0, 0, 1.5);
  contact.step(0, 0, 0.5);
  int ticks = 1;
  for (double z = 0.5; (contact.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0; z -= 1e-4, ++ticks) {
    REQUIRE(ticks < 2000);
    contact.step(0, 0, z);
  }
  INFO(contact.describe());
  CHECK(contact.result.state != FDCG_FREE);
  contact.step(0, 0, 3);
  while ((contact.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0)
    contact.step(0, 0, 3);
  CHECK(contact.result.state == FDCG_FREE);
  CHECK(distance(contact.god_object(), {0, 0, 3}) == 0);
}

TEST_CASE("a reset contact drops its carried sweep") {
  CompileOptions bare;
  bare.without = {"hierarchy"};
  const CompiledMesh mesh(spiky_sphere(3, 0.8, 3), bare);
  Contact contact(mesh.view(), contact_params(0.5, 0.5));
  contact.step(3, 0, 0);
  contact.step(-3, 0, 0);
  REQUIRE((contact.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0);
  contact.state.started = 0;  // as a caller may do who puts the contact elsewhere
  contact.step(0, 3, 0);
  CHECK(contact.result.flags == 0);
  CHECK(distance(contact.god_object(), {0, 3, 0}) == 0);
}
