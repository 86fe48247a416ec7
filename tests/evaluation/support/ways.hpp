// SPDX-License-Identifier: Apache-2.0
// Ways for a HIP to go on and through a body: the same for everything that is compared on it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ground.hpp"

namespace fdcg::test {

enum class WayKind { hand, edge_slide, corner_dive, fan_orbit, tremor, quantised, teleport };

struct WayName {
  WayKind kind;
  const char* name;
  const char* what;
};

// Each but the last is one motion in time: a higher rate samples the same motion more finely, and more ticks go on with it.
constexpr WayName kWays[] = {
    {WayKind::hand, "hand",
     "presses, slides, lifts: a B-spline of 50 knots a second, so band-limited to some 10 Hz, never over 0.5 m/s"},
    {WayKind::edge_slide, "edge_slide", "from corner to corner along edges, under them and now and then above them"},
    {WayKind::corner_dive, "corner_dive", "straight into a sharp corner and out again, then through the air to another"},
    {WayKind::fan_orbit, "fan_orbit", "5 turns a second around the corners with the most edges, 0.02 to 2 mm from them"},
    {WayKind::tremor, "tremor", "0.2 mm at 8 to 12 Hz while held in a corner, a concave one where there is one"},
    {WayKind::quantised, "quantised", "hand, every coordinate rounded to an encoder's quantum"},
    {WayKind::teleport, "teleport", "a place anywhere in 1.2 times the bounds, held for `hold_ticks`, then another at once"},
};
const char* name_of(WayKind kind);
// Throws std::invalid_argument, listing the names.
WayKind way_named(const std::string& name);

struct WayOptions {
  WayKind kind = WayKind::hand;
  double rate_hz = 1000;
  std::uint32_t ticks = 10'000;
  double depth_m = 1e-3;  // of the HIP below the surface, most of the time
  std::uint64_t seed = 1;
  double quantum_m = 3e-5;       // of `quantised`: the nominal resolution of common desktop devices, 0.03 mm
  std::uint32_t hold_ticks = 1;  // of `teleport`
};

using Way = std::vector<std::array<double, 3>>;  // HIP in metres in the body's frame, one a tick

// Starts outside the body. Deterministic from the options, but for the last bits of sine, cosine and arc cosine. Some 500
// questions to the ground a second of motion. Throws std::invalid_argument where the rate is not positive.
Way make_way(const Ground& ground, const WayOptions& options);

}  // namespace fdcg::test
