// SPDX-License-Identifier: Apache-2.0
// What a hand does on bodies of flat faces whose answer is known: over edges, along grooves, into corners, with friction and
// without.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hand_loop.hpp"

namespace fdcg::test {

// A body of 0.1 m, turned so that no face lies along an axis, and where the hand's target goes over it, tick by tick.
struct HandScene {
  std::string name, what;
  bake::PolygonSoup soup;
  double mu_static = 0, mu_dynamic = 0;
  std::vector<Point> targets_m;
  std::size_t held_from = 0, held_to = 0;  // ticks of a target that stands still under the surface
};
std::vector<HandScene> hand_scenes(double rate_hz);

// Places of which the stiffest stable contact is known: it stands along every axis along which the body holds, and is that of
// one axis.
struct HoldScene {
  std::string name;
  bake::PolygonSoup soup;
  Hold hold;
};
std::vector<HoldScene> hold_scenes();

// The contact model by brute force in long double, as a contender: what a loop should feel like.
std::unique_ptr<Contender> make_truth(const bake::PolygonSoup& soup);

}  // namespace fdcg::test
