// SPDX-License-Identifier: Apache-2.0
#include "exact/outline.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "catch.hpp"
#include "exact/polygon_cut.hpp"

using namespace fdcg::bake;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

namespace {

using Loop = std::vector<Vec3>;

// CGAL's result for the loop in the plane z = 0, in either orientation.
bool is_simple_2(const Loop& loop) {
  std::vector<Kernel::Point_2> points;
  for (const Vec3& p : loop)
    points.emplace_back(p.x, p.y);
  return CGAL::is_simple_2(points.begin(), points.end(), Kernel());
}

// The loop out of the plane z = 0 into another, exactly: z = a x + b y.
Loop lifted(Loop loop, double a, double b) {
  for (Vec3& p : loop)
    p.z = a * p.x + b * p.y;
  return loop;
}

std::size_t ears_of(const Loop& loop) {
  const auto view = simple_view(loop);
  PolygonCutter cutter;
  return view ? cutter.cut(*view, loop).size() : 0;
}

// A comb of `teeth` teeth, leaning by `lean`.
Loop comb(std::uint32_t teeth, double lean) {
  Loop loop;
  for (std::uint32_t i = 0; i < teeth; ++i) {
    loop.push_back({2.0 * i, 0, 0});
    loop.push_back({2.0 * i + lean, double(teeth), 0});
  }
  loop.push_back({2.0 * teeth, -1, 0});
  loop.push_back({0, -1, 0});
  std::reverse(loop.begin(), loop.end());
  return loop;
}

}  // namespace

TEST_CASE("outline: simple as CGAL decides, in any plane, and then triangulable") {
  std::mt19937 rng(31);
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  int simple = 0, crossing = 0, inward = 0;
  for (int round = 0; round < 200000; ++round) {
    CAPTURE(round);
    const int n = 4 + below(6), size = 2 + below(5);
    Loop loop(static_cast<std::size_t>(n));
    if (round % 2 == 0) {  // thrown together
      for (Vec3& p : loop)
        p = {double(below(size)), double(below(size)), 0};
    } else {  // round a centre: mostly simple, with inward corners
      for (int i = 0; i < n; ++i) {
        const double r = 1 + below(8), angle = 6.283185307179586 * i / n;
        loop[static_cast<std::size_t>(i)] = {std::round(r * std::cos(angle)), std::round(r * std::sin(angle)), 0};
      }
    }
    const bool expected = is_simple_2(loop);
    (expected ? simple : crossing)++;
    const Loop tilted = lifted(loop, below(5) - 2, below(5) - 2);
    const auto view = simple_view(tilted);
    CHECK(view.has_value() == expected);
    if (!view) continue;
    CHECK(is_simple(*view, tilted));
    if (turns_of(*view, tilted).has_right) ++inward;
    CHECK(ears_of(tilted) == loop.size() - 2);
    const Loop backwards(tilted.rbegin(), tilted.rend());
    CHECK(ears_of(backwards) == loop.size() - 2);
  }
  CHECK(simple > 40000);
  CHECK(crossing > 40000);
  CHECK(inward > 20000);
}

TEST_CASE("outline: the result does not depend on rounding") {
  // The inward corner stands off the edge from 0 to 1 by one unit in the last place, on it, and beyond it.
  for (const double z : {0.0, 1.0}) {
    const double up = std::nextafter(0.1, 1), down = std::nextafter(0.1, 0);
    const auto loop = [&](double y) { return lifted({{0, 0.1, 0}, {3, 0.1, 0}, {3, 1, 0}, {1.5, y, 0}, {0, 1, 0}}, z, 0); };
    CHECK(simple_view(loop(up)));
    CHECK_FALSE(simple_view(loop(0.1)));
    CHECK_FALSE(simple_view(loop(down)));
  }
}

TEST_CASE("outline: a far from planar polygon is projected so that it is simple") {
  // Of a real mesh: crosses itself seen along z, where its area is largest, and not along y.
  const Loop folded{{-12.2318, 2.65882, -0.920534},
                    {-15.7188, 3.4787, -0.930416},
                    {-18.9035, 3.56942, -1.24089},
                    {-19.4249, 2.77456, -1.55163},
                    {-12.2318, 2.73999, -1.52108}};
  CHECK(ears_of(folded) == 3);
  // A bow tie that rounding has lifted out of its plane looks simple edge-on; that does not count.
  const Loop bow_tie{{0, 0, 1e-12}, {2, 2, 0}, {2, 0, 1e-12}, {0, 2, 3e-12}};
  CHECK_FALSE(simple_view(bow_tie));
  // Thinner than double can tell from its corners' differences, and simple.
  const Loop needle{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {2, 2, std::nextafter(2, 3)}};
  CHECK(simple_view(needle));
  // A frame so thin and so wide that its triangles all but cancel out.
  const Loop frame{{0, 0, 0},           {1, 0, 1e-7},    {1, 1, 0},           {0, 1, 1e-7},
                   {0, 1e-5, 0},        {1e-6, 1e-5, 0}, {1e-6, 1 - 1e-6, 0}, {1 - 1e-6, 1 - 1e-6, 0},
                   {1 - 1e-6, 1e-6, 0}, {0, 1e-6, 0}};
  CHECK(simple_view(frame));
}

TEST_CASE("outline: results are the same at extreme sizes") {
  for (const double scale : {1e-300, 1e-160, 1.0, 1e160, 1e300}) {
    CAPTURE(scale);
    const auto scaled = [&](Loop loop) {
      for (Vec3& p : loop)
        p = {p.x * scale, p.y * scale, p.z * scale};
      return loop;
    };
    CHECK(simple_view(scaled({{0, 0, 0}, {4, 0, 1}, {1, 1, 0.5}, {0, 4, 1}})));
    CHECK_FALSE(simple_view(scaled({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, -1, 0}})));
  }
}

TEST_CASE("outline: time is near linear up to 65,536 corners") {
  const auto start = std::chrono::steady_clock::now();
  for (const double lean : {0.0, 1.0, 30000.0}) {
    CAPTURE(lean);
    const Loop teeth = comb(32767, lean);
    CHECK(simple_view(teeth));
    Loop crossing = teeth;
    crossing[2000].y = -2;
    CHECK_FALSE(simple_view(crossing));
    const Loop fewer = comb(lean > 1 ? 1000 : 8000, lean);  // no corner of slanting teeth is level with few others
    CHECK(ears_of(fewer) == fewer.size() - 2);
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
}
