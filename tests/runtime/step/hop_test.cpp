// SPDX-License-Identifier: Apache-2.0
// Slides from face to face in one go, onto edges, along and off them (step/hop.hpp, step/along_edge.hpp): contacts and results
// are the same bit for bit with and without.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "step/contact_internals.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

constexpr int kTicks = 8000;

fdcg_params params_of(double mu_static, double mu_dynamic, std::uint32_t edge_friction, std::uint32_t disabled) {
  fdcg_params params = contact_params(mu_static, mu_dynamic);
  params.edge_friction = edge_friction;
  params.disabled_optimizations = disabled;
  return params;
}

// Under the surface by a share of the size, along it at a speed that changes, in a direction that turns.
class Slide {
 public:
  Slide(double size, std::uint64_t seed) : size_(size), random_(seed) {}

  Hip next() {
    if (random_.chance(0.01)) speed_ = std::pow(10.0, random_.uniform(-4, 0));
    if (random_.chance(0.01)) depth_ = std::pow(10.0, random_.uniform(-6, -0.5));
    if (random_.chance(0.05)) turn_ = random_.direction();
    const double d[3] = {turn_.x, turn_.y, turn_.z};
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k)
      at_[k] += d[k] * speed_, length += at_[k] * at_[k];
    Hip hip;
    for (std::size_t k = 0; k < 3; ++k) {
      at_[k] /= std::sqrt(length);
      hip[k] = at_[k] * size_ * (lift() ? 1.5 : 0.5 * (1 - depth_));
    }
    ++tick_;
    return hip;
  }

 private:
  [[nodiscard]] bool lift() const { return tick_ % 500 < 3; }

  double size_;
  Random random_;
  Hip at_{0.3, 0.5, 0.8};
  fdcg::bake::Vec3 turn_{1, 0, 0};
  double speed_ = 1e-2, depth_ = 0.01;
  int tick_ = 0;
};

struct Tally {
  long sliding = 0, crossing = 0, far_crossing = 0, cut_short = 0, crossing_mixed = 0;
  long onto_edge = 0, along_edge = 0, off_edge = 0, landing = 0;
};

void compare(const PolygonSoup& soup, Precision precision, bool is_smooth, std::uint64_t seed, Tally* tally) {
  CompileOptions options;
  options.precision = precision;
  const CompiledMesh mesh(soup, options);
  const double mu_static = is_smooth ? 0 : 0.5, mu_dynamic = is_smooth ? 0 : 0.3;
  const std::uint32_t edge_friction = seed % 2 == 0 ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
  Contact with(mesh.view(), params_of(mu_static, mu_dynamic, edge_friction, 0));
  Contact without(mesh.view(), params_of(mu_static, mu_dynamic, edge_friction, FDCG_STEP_OPT_HOP));
  const bool has_mixed_sizes = mesh.view().node_offsets != nullptr;  // polygons of several numbers of sides
  Slide slide(extent(soup), seed);
  for (int i = 0; i < kTicks; ++i) {
    const Hip hip = slide.next();
    const bool was_on_face = with.state.state == FDCG_FACE, was_on_edge = with.state.state == FDCG_EDGE,
               was_free = with.state.state == FDCG_FREE;
    with.step(hip);
    without.step(hip);
    INFO(soup.name << ", seed " << seed << ", tick " << i << ": " << with.describe() << "; without: " << without.describe());
    REQUIRE(std::memcmp(&with.result, &without.result, sizeof with.result) == 0);
    REQUIRE(std::memcmp(&with.state, &without.state, sizeof with.state) == 0);
    tally->landing += was_free && with.result.state == FDCG_FACE && with.result.transitions > 2;
    tally->onto_edge += was_on_face && with.result.state == FDCG_EDGE;
    tally->along_edge += was_on_edge && with.result.state == FDCG_EDGE && with.result.transitions == 0;
    tally->off_edge += was_on_edge && with.result.state == FDCG_FACE;
    tally->cut_short += was_on_face && (with.result.flags & FDCG_RESULT_TRANSITION_BOUND) != 0;
    if (!was_on_face || with.result.state != FDCG_FACE) continue;
    tally->sliding += with.result.transitions == 0;
    tally->crossing += with.result.transitions == 2;
    tally->far_crossing += with.result.transitions > 2;
    tally->crossing_mixed += has_mixed_sizes && with.result.transitions != 0;
  }
}

}  // namespace

TEST_CASE("contacts are the same bit for bit with and without hops over edges") {
  Tally tally;
  std::uint64_t seed = 0;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const bool is_smooth : {false, true}) {
      for (const PolygonSoup& soup :
           {ico_sphere(3), ico_sphere(5), star_sphere(3, 0.3, 1), spiky_sphere(3, 0.5, 2), torus(40, 20), cone(300),
            scaled(ico_sphere(4), 1e-6), scaled(star_sphere(2, 0.3, 4), 1e6), needle_strip(200, 0.3, 2),
            rounded_to_float(transformed(grid_box(5, 5, 5, {1, 1, 1}), random_rotation(3))), prism(40), uv_sphere(24, 12),
            rounded_to_float(transformed(uv_sphere(30, 20), random_rotation(4)))})
        compare(soup, precision, is_smooth, ++seed, &tally);
    }
  }
  CHECK(tally.sliding > 100000);
  CHECK(tally.crossing > 5000);
  CHECK(tally.far_crossing > 5000);  // else hops were hardly tried
  CHECK(tally.crossing_mixed > 5000);
  CHECK(tally.onto_edge > 1000);
  CHECK(tally.along_edge > 5000);
  CHECK(tally.off_edge > 1000);
  CHECK(tally.landing > 200);
  CHECK(tally.cut_short > 500);  // where the work of a tick runs out after hops
}

// Each record that a crossing reads may be a cache miss: it reads faces alone, but at an end of the side that it crosses.
TEST_CASE("a slide over a convex body reads neither edges nor corners, but where it passes a corner") {
  const PolygonSoup soup = ico_sphere(4);
  const CompiledMesh mesh(soup, CompileOptions{});
  fdcg_graph graph = mesh.view();
  const std::vector<double> no_numbers(std::size_t{8} * (graph.header->connection_count + graph.header->corner_count),
                                       std::nan(""));
  graph.edges = graph.corners = no_numbers.data();
  Contact own(mesh.view(), contact_params(0.3, 0.2)), blind(graph, contact_params(0.3, 0.2));
  const double size = extent(soup);
  own.step(0, 0, 1.2 * size);
  long crossings = 0, at_corners = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double turn = 0.01 * i, away = 0.7 * std::sin(0.0137 * i) * size;
    const Hip hip = {away * std::cos(turn), away * std::sin(turn), 0.6 * size};
    blind.state = own.state;
    const bool was_on_face = own.state.state == FDCG_FACE;
    own.step(hip);
    if (!was_on_face || own.result.state != FDCG_FACE || own.result.transitions == 0) continue;
    blind.step(hip);
    ++(std::memcmp(&own.result, &blind.result, sizeof own.result) == 0 ? crossings : at_corners);
  }
  INFO(crossings << " ticks with crossings, " << at_corners << " past corners");
  CHECK(crossings > 1000);
  CHECK(at_corners * 100 < crossings);
}

TEST_CASE("around the neighbours of its face all is prefetched, once, in a graph that says it is large") {
  const PolygonSoup soup = ico_sphere(4);
  const CompiledMesh mesh(soup, CompileOptions{});
  const bool is_large = GENERATE(false, true);
  fdcg_header header = *mesh.view().header;
  if (is_large) header.file_bytes = 1'000'000'000;
  fdcg_graph graph = mesh.view();
  graph.header = &header;
  Contact contact(graph, contact_params(0, 0));
  const auto prefetched = [&contact] { return fdcg::internals_of(contact.state).near.prefetched; };
  const double size = extent(soup);
  contact.step(0.3 * size, 0.3 * size, 1.5 * size);
  contact.step(0.3 * size, 0.3 * size, 0.8 * size);
  REQUIRE(contact.state.state == FDCG_FACE);
  const std::uint32_t face = contact.state.feature;
  REQUIRE(face != 0);
  CHECK(prefetched() == 0);
  for (int tick = 1; tick <= 3; ++tick) {  // the first that slides
    contact.step((0.3 + 1e-6 * tick) * size, 0.3 * size, 0.8 * size);
    REQUIRE(contact.state.feature == face);
    CHECK(prefetched() == (is_large ? face : 0));
  }
  int over_one_edge = 0, others = 0, since = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::uint32_t before = contact.state.feature, prefetched_before = prefetched();
    contact.step((0.3 + 1e-3 * (tick % 400)) * size, (0.3 + 1e-3 * (tick / 400)) * size, 0.8 * size);
    const bool is_over_one_edge = contact.state.state == FDCG_FACE && contact.result.transitions == 2;
    if (!is_large) {
      CHECK(prefetched() == 0);
    } else if (is_over_one_edge && prefetched_before == before) {
      CHECK(prefetched() == contact.state.feature);
      ++over_one_edge;
    } else if (contact.result.transitions != 0) {
      CHECK(prefetched() == prefetched_before);
      ++others;
    } else if (contact.state.state == FDCG_FACE) {
      CHECK(prefetched() == contact.state.feature);
      ++since;
    }
  }
  if (!is_large) return;
  CHECK(over_one_edge > 20);
  CHECK(others > 5);
  CHECK(since > 1000);
}
