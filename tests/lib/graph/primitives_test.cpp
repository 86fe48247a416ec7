// SPDX-License-Identifier: Apache-2.0
// Cylinders, cones, discs, tubes and gears as modelling programs write them: every number of sides from 3 to 200, caps as one
// polygon or as a fan around a centre, along each of the three axes. Flat caps merge, and are cut again where a node would get
// too many sides.
#include <algorithm>
#include <functional>

#include "compiled.hpp"
#include "ring_bodies.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

constexpr std::uint32_t kFewestSides = 3, kMostSides = 200;
constexpr std::uint32_t kMostSidesOfANode = 16;

using Family = std::function<RingBody(std::uint32_t sides)>;

// Compiles to a sound file of the same shape, whose flat faces are merged into nodes of a bounded number of sides.
void check_family(const Family& family, int euler_characteristic) {
  for (std::uint32_t sides = kFewestSides; sides <= kMostSides; ++sides) {
    const RingBody body = family(sides);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const WalkedGraph graph = compile_sound(body.along(axis));
      CAPTURE(sides, axis);
      CHECK(graph.euler_characteristic() == euler_characteristic);
      const auto is_too_large = [](const WalkedNode& node) { return node.side_count > kMostSidesOfANode; };
      CHECK(std::none_of(graph.nodes.begin(), graph.nodes.end(), is_too_large));
    }
  }
}

}  // namespace

TEST_CASE("cylinders of 3 to 200 sides compile, their caps fans around a centre") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::fan, 1.6); }, 2);
}

TEST_CASE("prisms of 3 to 200 sides compile, their caps polygons") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::polygon, 1.6); }, 2);
}

TEST_CASE("closed discs of 3 to 200 sides compile, with and without centres") {
  check_family([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::fan : Cap::polygon, 1e-3); }, 2);
  check_family([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::polygon : Cap::fan, 1e-3); }, 2);
}

TEST_CASE("gears of 3 to 200 corners compile, with centres") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::fan, 0.2, 0.35); }, 2);
}

TEST_CASE("cones of 3 to 200 sides compile, with and without a centre of the base") {
  check_family([](std::uint32_t sides) { return pointed(sides, Cap::fan); }, 2);
  check_family([](std::uint32_t sides) { return pointed(sides, Cap::polygon); }, 2);
}

TEST_CASE("tubes of 3 to 200 sides compile, open ones and ones with a wall") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::none, 1.6); }, 0);
  check_family([](std::uint32_t sides) { return pipe(sides, sides % 2 == 0); }, 0);
}
