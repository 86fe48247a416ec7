// SPDX-License-Identifier: Apache-2.0
// The runtime against the brute-force reference: every mesh kind, four pairs of friction coefficients, both precisions.
#include <algorithm>
#include <vector>

#include "catch.hpp"
#include "lockstep.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "reference_walker.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

constexpr std::uint64_t kSteps = 2000;  // a walk, unless FDCG_STEPS says otherwise; the full run is 1,000,000
constexpr double kMu[4][2] = {{0, 0}, {0.3, 0.2}, {1, 1}, {2, 1}};
constexpr double kTieShareOffFeatures = 0.002;
constexpr double kTieShare = 0.12;
constexpr double kGrowthInEps = 16;

Rotation tilt() {
  return random_rotation(20);
}

std::vector<PolygonSoup> meshes() {
  return {cube(),
          transformed(triangulated(cube()), tilt()),
          l_prism(),
          corner_pit(),
          transformed(triangulated(corner_pit()), tilt()),
          v_groove(1.5707963267948966),
          v_groove(0.17),
          wedge(0.1),
          cone(12),
          cone(500),
          cone_pit(12),
          saddle_block(),
          prism(500),
          ico_sphere(2),
          uv_sphere(20, 10),
          star_sphere(2, 0.3, 1),
          spiky_sphere(2, 1, 1),
          torus(20, 10),
          thin_plate(1e-6),
          triangulated(thin_plate(1e-6, 3)),
          bumpy_patch(6, 0.2, 1),
          needle_strip(100, 0.1, 1),
          plane_grid(8, 8),
          rounded_to_float(transformed(triangulated(grid_box(3, 3, 3, {1, 1, 1})), tilt()))};
}

void check(const fdcg_graph& graph, const PolygonSoup& soup, double mu_static, double mu_dynamic, std::uint64_t seed) {
  const std::uint64_t steps = step_count(kSteps);
  const Lockstep run = run_lockstep(graph, soup, contact_params(mu_static, mu_dynamic), steps, seed);
  INFO(soup.name << ", mu " << mu_static << '/' << mu_dynamic << ", f" << 8 * graph.header->real_bytes << ", seed " << seed
                 << ": " << run.contact_steps << " contact steps, ties " << run.ties << " (off features "
                 << run.ties_off_features << "), slip ties " << run.slip_ties << ", drifts " << run.drifts << ", carried "
                 << run.bound_hits << ", god-objects apart " << run.worst_god_object << ", growth " << run.worst_growth
                 << " eps\n"
                 << run.first_failure << '\n'
                 << run.first_growth);
  const double n = static_cast<double>(run.steps);
  CHECK(run.failures == 0);
  CHECK(run.worst_growth <= kGrowthInEps);
  CHECK(run.bound_hits == 0);
  constexpr std::uint64_t kStepsForShares = 2000;  // of a walk cut short by FDCG_STEPS shares say nothing
  if (run.steps < kStepsForShares) return;
  CHECK(run.contact_steps > run.steps / 50);
  CHECK(static_cast<double>(run.ties) <= kTieShare * n);
  CHECK(static_cast<double>(run.ties_off_features) <= kTieShareOffFeatures * n + 2);
  CHECK(static_cast<double>(run.slip_ties + run.drifts) <= kTieShare * n);
}

void check_all(Precision precision) {
  std::uint64_t seed = 1000;
  for (const PolygonSoup& soup : meshes()) {
    const PlainGraph graph(soup, precision);
    for (const auto& mu : kMu)
      check(graph.view(), soup, mu[0], mu[1], ++seed);
  }
}

void check_all_compiled(Precision precision, bool merge) {
  std::uint64_t seed = 2000;
  for (const PolygonSoup& soup : meshes()) {
    fdcg::bake::CompileOptions options;
    options.precision = precision;
    options.merge = merge;
    options.allow = {"boundary-edge"};
    const CompiledMesh compiled(merge ? soup : triangulated(soup), options);
    for (const auto& mu : kMu)
      check(compiled.view(), soup, mu[0], mu[1], ++seed);
  }
}

}  // namespace

TEST_CASE("runtime agrees with the reference on plain f64 graphs") {
  check_all(Precision::f64);
}
TEST_CASE("runtime agrees with the reference on plain f32 graphs") {
  check_all(Precision::f32);
}
TEST_CASE("runtime agrees with the reference on compiled triangles, f64") {
  check_all_compiled(Precision::f64, false);
}
TEST_CASE("runtime agrees with the reference on compiled triangles, f32") {
  check_all_compiled(Precision::f32, false);
}
TEST_CASE("runtime agrees with the reference on merged meshes, f64") {
  check_all_compiled(Precision::f64, true);
}
TEST_CASE("runtime agrees with the reference on merged meshes, f32") {
  check_all_compiled(Precision::f32, true);
}

TEST_CASE("runtime agrees with the reference under the paper's edge friction") {
  for (const PolygonSoup& soup : {v_groove(1.5707963267948966), v_groove(0.17), corner_pit(), star_sphere(2, 0.3, 1)}) {
    const PlainGraph graph(soup, Precision::f64);
    const Lockstep run = run_lockstep(graph.view(), soup, contact_params(0.6, 0.4, FDCG_EDGE_PAPER), step_count(kSteps), 7);
    INFO(soup.name << ": " << run.first_failure);
    CHECK(run.failures == 0);
    CHECK(run.contact_steps > run.steps / 50);
  }
}

TEST_CASE("without a hierarchy the step is the same") {
  const PolygonSoup soup = star_sphere(2, 0.3, 1);
  const PlainGraph graph(soup, Precision::f64, false);
  check(graph.view(), soup, 0.3, 0.2, 5);
}

TEST_CASE("the reference in long double agrees with itself at 150 digits") {
  for (const PolygonSoup& soup : {corner_pit(), star_sphere(1, 0.3, 1), saddle_block(), bumpy_patch(3, 0.2, 1)}) {
    const PlainGraph graph(soup, Precision::f64);
    const ReferenceSurface<long double> surface(graph.view());
    const ReferenceSurface<HighPrecision> exact_surface(graph.view());
    CHECK(exact_surface.wrong_types().empty());
    ReferenceWalker<long double> walker(surface, {0.6, 0.4});
    ReferenceWalker<HighPrecision> exact(exact_surface, {0.6, 0.4});
    HipWalk walk(soup, 11);
    std::uint64_t differences = 0, contacts = 0;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto& go = walker.contact.god_object;
      const Hip hip = walk.next({static_cast<double>(go.x), static_cast<double>(go.y), static_cast<double>(go.z)});
      const ReferenceStep a = walker.step(hip), b = exact.step(hip);
      const Hip ga = {static_cast<double>(go.x), static_cast<double>(go.y), static_cast<double>(go.z)};
      const auto& ge = exact.contact.god_object;
      const double apart = distance(ga, {static_cast<double>(ge.x), static_cast<double>(ge.y), static_cast<double>(ge.z)});
      contacts += exact.contact.state != FDCG_FREE;
      if (walker.contact.state == exact.contact.state && walker.contact.feature == exact.contact.feature &&
          walker.contact.is_slipping == exact.contact.is_slipping && apart < 1e-14 * b.amplification) {
        worst = std::max(worst, apart / b.amplification);
        continue;
      }
      INFO(soup.name << " step " << i << ": " << describe(b));
      CHECK(std::min(a.margin, b.margin) < 1e-17);
      ++differences;
      walker.contact = {};
      exact.contact = {};
    }
    INFO(soup.name);
    CHECK(contacts > 100);
    CHECK(differences < 60);
  }
}
