// SPDX-License-Identifier: Apache-2.0
// The clear ball of free space: results are the same bit for bit with and without it, and there is no face in it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "graph/graph_view.hpp"
#include "graph/rigid_geometry.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "step/clear_ball.hpp"
#include "step/contact_internals.hpp"

using fdcg::internals_of;
using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

int ticks() {
  const char* set = std::getenv("FDCG_STEPS");
  return set != nullptr ? std::atoi(set) : 4000;
}

fdcg_params with_skips(std::uint32_t disabled) {
  fdcg_params params = contact_params(0.4, 0.3);
  params.disabled_optimizations = disabled;
  return params;
}

// Drifts towards and along the surface at changing speed, with a jump now and then.
class Drift {
 public:
  Drift(double size, std::uint64_t seed) : size_(size), random_(seed) {}

  Hip next(const Hip& near) {
    if (random_.chance(0.003)) speed_ = std::pow(10.0, random_.uniform(-5, -0.7));
    if (random_.chance(0.02)) {
      const auto d = random_.direction();
      direction_ = {d.x, d.y, d.z};
    }
    if (random_.chance(0.002)) at_ = near;  // onto the surface, exactly
    for (std::size_t k = 0; k < 3; ++k) {
      at_[k] += direction_[k] * speed_ * size_;
      if (std::abs(at_[k]) > 1.7 * size_) direction_[k] = -std::copysign(direction_[k], at_[k]);
    }
    if (random_.chance(0.001)) at_ = {3 * size_, random_.uniform(-1, 1) * size_, 0};
    return at_;
  }

 private:
  double size_;
  Random random_;
  Hip at_{1.5, 1.4, 1.3}, direction_{0, 0, -1};
  double speed_ = 1e-3;
};

struct Tally {
  long free = 0, touching = 0, in_ball = 0, near_nodes = 0;
  long met_of_near = 0, met_of_all = 0;  // by sweeps in a ball: of its nodes alone, or of all
};

Tally compare(const PolygonSoup& soup, Precision precision, bool merges, std::uint64_t seed) {
  CompileOptions options;
  options.precision = precision;
  options.merge = merges;
  const CompiledMesh mesh(soup, options);
  Contact with(mesh.view(), with_skips(0)), without(mesh.view(), with_skips(FDCG_STEP_OPT_CLEAR_BALL));
  Drift drift(extent(soup), seed);
  Hip surface = point_of(soup.points[0]);
  Tally tally;
  for (int i = 0; i < ticks(); ++i) {
    const Hip hip = drift.next(surface);
    const fdcg::ClearBall ball = internals_of(with.state).clear_ball;
    const bool was_in_ball = ball.radius2 > 0;
    with.step(hip);
    without.step(hip);
    INFO(soup.name << ", seed " << seed << ", tick " << i << ": " << with.describe() << "; without: " << without.describe());
    REQUIRE(std::memcmp(&with.result, &without.result, sizeof with.result) == 0);
    REQUIRE(internals_of(without.state).clear_ball.radius2 == 0);
    const bool is_free = with.result.state == FDCG_FREE;
    if (!is_free) REQUIRE(internals_of(with.state).clear_ball.radius2 == 0);
    if (!is_free) surface = with.god_object();
    tally.free += is_free;
    tally.touching += !is_free;
    if (was_in_ball && !is_free && norm(fdcg::vec(with.state.hip) - fdcg::vec(ball.centre)) < std::sqrt(ball.radius2))
      ++(ball.lists_all != 0 ? tally.met_of_near : tally.met_of_all);
    tally.near_nodes += was_in_ball && internals_of(with.state).clear_ball.near_count > 0;
    tally.in_ball += was_in_ball && internals_of(with.state).clear_ball.radius2 > 0;
  }
  return tally;
}

// The graph's nodes as polygons, but for those that the contact's clear ball names as reaching into it: themselves where they
// are all, else each for all of its plane.
template <class Real>
PolygonSoup other_nodes(const fdcg_graph& raw, const fdcg_contact& contact) {
  const fdcg::GraphView<fdcg::RigidGeometry<Real>> graph(raw);
  const fdcg::ContactInternals& inner = internals_of(contact);
  const std::uint32_t* const first = inner.near.node;
  const std::uint32_t* const end = first + inner.clear_ball.near_count;
  PolygonSoup soup;
  for (std::uint32_t c = 0; c < raw.header->corner_count; ++c) {
    const auto local = fdcg::widen(graph.corner_point(c)) + fdcg::vec(raw.header->origin);
    soup.points.push_back({local.x, local.y, local.z});
  }
  soup.face_first.assign(1, 0);
  for (std::uint32_t n = 0; n < raw.header->node_count; ++n) {
    const auto is_named = [&](std::uint32_t named) {
      const auto node = graph.node(n), other = graph.node(named);
      return n == named || (inner.clear_ball.lists_all == 0 && node.plane().offset == other.plane().offset &&
                            fdcg::have_one_normal(node, other));
    };
    if (std::any_of(first, end, is_named)) continue;
    for (std::uint32_t k = 0; k < graph.node(n).side_count(); ++k)
      soup.corners.push_back(graph.node(n).corner(k));
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  return soup;
}

}  // namespace

TEST_CASE("forces and god-objects are the same bit for bit with and without the clear ball") {
  Tally sum;
  std::uint64_t seed = 0;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const PolygonSoup& soup :
         {ico_sphere(4), star_sphere(3, 0.3, 1), corner_pit(), thin_plate(1e-3, 6), torus(40, 20), needle_strip(200, 0.3, 2),
          scaled(spiky_sphere(3, 0.5, 2), 1e-6), scaled(star_sphere(2, 0.3, 4), 1e6), cone(300),
          rounded_to_float(transformed(grid_box(5, 5, 5, {1, 1, 1}), random_rotation(3)))}) {
      const Tally tally = compare(soup, precision, soup.name.rfind("grid", 0) != 0, ++seed);
      sum.free += tally.free;
      sum.touching += tally.touching;
      sum.in_ball += tally.in_ball;
      sum.near_nodes += tally.near_nodes;
      sum.met_of_near += tally.met_of_near;
      sum.met_of_all += tally.met_of_all;
    }
  }
  CHECK(sum.touching > sum.free / 100);
  CHECK(sum.in_ball > sum.free / 3);  // else the ball was hardly tried
  CHECK(sum.near_nodes > sum.free / 10);
  CHECK(sum.met_of_near > 20);
  CHECK(sum.met_of_all > 10);
}

TEST_CASE("no face reaches into a clear ball but those that it names") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const PolygonSoup& soup : {star_sphere(2, 0.4, 2), spiky_sphere(2, 1, 3), torus(20, 10), needle_strip(60, 0.3, 2),
                                    rounded_to_float(transformed(corner_pit(), random_rotation(5))), cone(60)}) {
      CompileOptions options;
      options.precision = precision;
      options.allow = {"boundary-edge"};
      const PolygonSoup stored = rounded_to_float(soup);  // what both precisions hold exactly
      const CompiledMesh mesh(stored, options);
      const double size = extent(stored);
      Random random(4);
      int balls = 0, near_balls = 0;
      for (int i = 0; i < 400; ++i) {
        const auto d = random.direction();
        const double radius = random.uniform(0.2, 2.5) * size, step = std::pow(10.0, random.uniform(-6, -1)) * size;
        Contact contact(mesh.view(), with_skips(0));
        contact.step(radius * d.x, radius * d.y, radius * d.z);
        const Hip hip = {radius * d.x + step, radius * d.y, radius * d.z};
        contact.step(hip);
        if (!(internals_of(contact.state).clear_ball.radius2 > 0)) continue;
        const PolygonSoup others = precision == Precision::f64 ? other_nodes<double>(mesh.view(), contact.state)
                                                               : other_nodes<float>(mesh.view(), contact.state);
        const double ball = std::sqrt(internals_of(contact.state).clear_ball.radius2),
                     surface = distance(closest_point(others, hip), hip);
        ++balls;
        near_balls += ball > surface / 2;
        INFO(soup.name << ", f" << 8 * mesh.view().header->real_bytes << ", direction " << i);
        REQUIRE(contact.result.state == FDCG_FREE);
        REQUIRE(ball < surface);
      }
      INFO(soup.name << ", f" << 8 * mesh.view().header->real_bytes << ": " << balls << " balls, " << near_balls
                     << " reach half way");
      CHECK(balls > 200);
      CHECK(near_balls > 20);
    }
  }
}

TEST_CASE("copied and reset contacts are independent, with their clear ball") {
  const CompiledMesh mesh(ico_sphere(3));
  Contact contact(mesh.view(), with_skips(0));
  contact.step(0.01, 0.02, 1.5);
  contact.step(0.01, 0.02, 1.499);
  REQUIRE(internals_of(contact.state).clear_ball.radius2 > 0);
  Contact copy = contact;
  copy.step(0.01, 0.02, 0.9);
  CHECK(copy.result.state != FDCG_FREE);
  contact.step(0.01, 0.02, 1.49);
  CHECK(contact.result.state == FDCG_FREE);
  CHECK(internals_of(contact.state).clear_ball.radius2 > 0);
  contact.step(NAN, 0, 0);
  CHECK(contact.result.flags == FDCG_RESULT_NON_FINITE);
  contact.state.started = 0;
  contact.step(0.01, 0.02, 0.5);  // starts inside
  CHECK(internals_of(contact.state).clear_ball.radius2 == 0);
  contact.step(0.01, 0.02, 1.5);
  contact.step(0.01, 0.02, 0.9);
  CHECK(contact.result.state != FDCG_FREE);
}

TEST_CASE("an unknown optimization flag is refused") {
  fdcg_params params = fdcg_make_params();
  CHECK(params.disabled_optimizations == 0);
  params.disabled_optimizations = FDCG_STEP_OPT_ALL;
  CHECK(fdcg_check_params(&params, nullptr) == FDCG_OK);
  params.disabled_optimizations = FDCG_STEP_OPT_ALL + 1;
  CHECK(fdcg_check_params(&params, nullptr) == FDCG_E_ARGUMENT);
}
