// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "bodies.hpp"
#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/bake.hpp"
#include "meshes.hpp"
#include "ways.hpp"

using namespace fdcg::test;

namespace {

using Point = Ground::Point;

double share_inside(const Ground& ground, const Way& way) {
  constexpr std::size_t kEvery = 20;  // a question to a funnel of needles takes half a millisecond
  double inside = 0;
  for (std::size_t i = 0; i < way.size(); i += kEvery)
    inside += ground.signed_distance(way[i]) < 0;
  return inside * kEvery / static_cast<double>(way.size());
}

}  // namespace

TEST_CASE("every body has the faces and the size that it says, and compiles") {
  for (const Body& body : bodies(25'000)) {
    const fdcg::bake::PolygonSoup soup = body.make();
    INFO(body.name);
    CHECK(soup.face_count() == body.faces);
    const Ground ground(soup);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, ground.high()[k] - ground.low()[k]);
    CHECK(longest == Approx(kBody_m).epsilon(1e-12));
    const auto compiled = fdcg::bake::compile(soup, {});
    REQUIRE(compiled.has_value());
    INFO(fdcg::bake::report_text(compiled->report, false));
    CHECK(!compiled->bytes.empty());
    CHECK(body_named(body.name).faces == body.faces);
  }
  CHECK_THROWS_AS(body_named("no such thing"), std::invalid_argument);
}

TEST_CASE("the ground tells inside from outside as the winding number does") {
  Random random(3);
  for (const char* name : {"corner_pit_tilted", "spiky", "saddle", "v_groove_tilted", "star_1k", "knife"}) {
    const Ground ground(body_named(name).make());
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
      Point p = ground.corner(random.below(static_cast<std::uint32_t>(ground.soup().points.size())));
      const Vec3 d = random.direction();
      const double away = std::pow(10, random.uniform(-6, -2));
      p = {p[0] + away * d.x, p[1] + away * d.y, p[2] + away * d.z};
      const bool is_inside = winding_number(ground.soup(), p) > 0.5;
      inside += is_inside;
      INFO(name << ", " << away);
      CHECK((ground.signed_distance(p) < 0) == is_inside);
      CHECK(ground.closest(p).distance == Approx(distance(closest_point(ground.soup(), p), p)).margin(1e-12));
    }
    CHECK(inside > 10);
    CHECK(inside < 490);
  }
}

TEST_CASE("a way starts outside, touches and leaves, and is the same again from its seed") {
  for (const char* name : {"cube_12", "star_1k", "corner_pit", "spiky", "fan_pit"}) {
    const Ground ground(body_named(name).make());
    for (const WayName& kind : kWays) {
      WayOptions options;
      options.kind = kind.kind;
      const Way way = make_way(ground, options);
      INFO(name << ", " << kind.name);
      REQUIRE(way.size() == options.ticks);
      CHECK(ground.signed_distance(way[0]) > 0);
      const double inside = share_inside(ground, way);
      CHECK(inside > 0.05);
      CHECK(inside < 0.97);
      CHECK(make_way(ground, options) == way);
      options.seed = 2;
      CHECK(make_way(ground, options) != way);
    }
  }
}

TEST_CASE("a higher rate samples the same motion more finely") {
  const Ground ground(body_named("star_1k").make());
  for (const WayName& kind : kWays) {
    if (kind.kind == WayKind::teleport) continue;
    WayOptions options;
    options.kind = kind.kind;
    options.ticks = 2000;
    const Way coarse = make_way(ground, options);
    options.rate_hz = 10'000;
    options.ticks = 20'000;
    const Way fine = make_way(ground, options);
    INFO(kind.name);
    double worst = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i)
      worst = std::max(worst, distance(coarse[i], fine[10 * i]));
    CHECK(worst <= (kind.kind == WayKind::quantised ? options.quantum_m * 2 : 1e-12));
  }
}

// Else numbers in float cannot tell whether it touches, and each tick finds and loses the surface.
TEST_CASE("a hand does not lie in the surface for longer than it takes to pass it") {
  constexpr double kNear_m = 1e-8;
  for (const char* name : {"cube_12", "drilled_plate", "v_groove_tilted", "corner_pit_tilted"}) {
    const Ground ground(body_named(name).make());
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      WayOptions options;
      options.ticks = 1000;
      options.seed = seed;
      const Way way = make_way(ground, options);
      const auto near = std::count_if(
          way.begin(), way.end(), [&](const Ground::Point& hip) { return std::abs(ground.signed_distance(hip)) < kNear_m; });
      INFO(name << ", seed " << seed);
      CHECK(near <= 2);
    }
  }
}

TEST_CASE("a hand keeps to 0.5 m/s and, by a Fourier transform, to 10 Hz") {
  for (const char* name : {"cube_12", "star_10k", "spiky"}) {
    const Ground ground(body_named(name).make());
    WayOptions options;
    options.ticks = 16'384;
    const Way way = make_way(ground, options);
    double fastest = 0, low = 0, high = 0;
    for (std::size_t i = 1; i < way.size(); ++i)
      fastest = std::max(fastest, distance(way[i], way[i - 1]) * options.rate_hz);
    INFO(name);
    CHECK(fastest <= 0.5);
    CHECK(fastest > 0.1);
    // the motion's energy below and above 10 Hz, of a Hann window; bins of 0.061 Hz, up to 50 Hz: the knots' rate
    const double n = static_cast<double>(way.size());
    for (std::size_t k = 0; k < 3; ++k) {
      for (int bin = 1; bin < 820; ++bin) {
        std::complex<double> sum = 0;
        const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * bin / n);
        std::complex<double> phase = 1;
        for (std::size_t i = 0; i < way.size(); ++i) {
          sum += (0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / n)) * way[i][k] * phase;
          phase *= turn;
        }
        (bin * options.rate_hz / n <= 10 ? low : high) += std::norm(sum);
      }
    }
    CHECK(high <= 1e-4 * low);
  }
}
