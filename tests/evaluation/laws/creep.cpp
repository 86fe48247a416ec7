// SPDX-License-Identifier: Apache-2.0
// Creep: a god-object that static friction holds does not move by a bit, however long, with the HIP still or trembling inside
// the cone of friction.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "laws.hpp"
#include "parallel.hpp"
#include "pressed.hpp"
#include "ramp.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr int kAllTicks = 1'000'000, kQuickTicks = 20'000;
constexpr double kDepths[] = {1e-3, 5e-2};  // of the body's size
// A way that meets a corner within rounding needs exact signs for each of its faces, which the step may carry over several
// ticks.
constexpr int kMostSettlingTicks = 64;

// Where a HIP is held, in a body of unit size about the origin, where the feature is.
struct Site {
  std::string name;
  PolygonSoup soup;
  Vec3 outward;           // the HIP comes in from there, and is pressed the other way
  Vec3 lean;              // of the load, as a share of its depth, across `outward`
  double mu_static;       // the dynamic one is half of it
  double tremor;          // how far the HIP may go from its place inside the cone, as a share of the depth
  bool is_placed_smooth;  // pressed without friction first: from its entry the god-object slides to the bottom of a groove
};

PolygonSoup groove(double opening_deg) {
  return v_groove(opening_deg * kPi / 180);
}

// The margins of the cones: a face holds r <= mu d, so 0.4 mu / (1 + mu) remains of a lean of 0.5 mu; a groove's HIP must stay
// between the Voronoi planes of its walls too; an edge of a cube leans by 45 degrees and its corner by 54.7.
std::vector<Site> all_sites() {
  const double c = std::sqrt(0.5), s = 1 / std::sqrt(3.0);
  const PolygonSoup flat = triangulated(scaled(plane_grid(4, 4), 2));
  return {
      {"face",
       make_soup("face", {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}),
       {0, 0, 1},
       {0.15, 0.2, 0},
       0.5,
       0.12,
       false},
      {"corner of flat seams", flat, {0, 0, 1}, {0.15, 0.2, 0}, 0.5, 0.12, false},
      {"groove of 30 degrees", triangulated(groove(30)), {0, 0, 1}, {0.5, 0, 0}, 0.5, 0.1, true},
      {"groove of 90 degrees", triangulated(groove(90)), {0, 0, 1}, {0.3, 0, 0}, 0.5, 0.1, true},
      {"groove of 150 degrees", triangulated(groove(150)), {0, 0, 1}, {0.2, 0, 0}, 0.5, 0.05, true},
      {"concave corner", triangulated(corner_pit()), {s, s, s}, {0, 0, 0}, 0.5, 0.2, true},
      {"funnel of 12 faces", cone_pit(12), {0, 0, 1}, {0, 0, 0}, 0.5, 0.1, true},
      {"convex edge", moved(cube(), {0, 0.5, -0.5}), {0, -c, c}, {0.1, 0, 0}, 2, 0.1, false},
      {"convex corner", moved(cube(), {-0.5, -0.5, -0.5}), {s, s, s}, {0, 0, 0}, 2, 0.05, false},
  };
}

struct Hold {
  std::size_t site;
  int orientation;
  bake::Precision precision;
  double depth;
  bool trembles;
};

struct Outcome {
  std::uint32_t state = FDCG_FREE;
  int settling = 0;  // ticks until it is in contact
  std::uint64_t ticks = 0, moved = 0;
};

Outcome hold(const Site& site, const Hold& how, int ticks, std::uint64_t seed) {
  const Rotation turn = random_rotation(seed + static_cast<std::uint64_t>(how.orientation));
  const PlainGraph graph(transformed(site.soup, turn, kObject_m), how.precision);
  const double depth_m = how.depth * kObject_m;
  const auto place = [&](double out, double lean) {
    const Vec3 p = {out * site.outward.x + lean * site.lean.x, out * site.outward.y + lean * site.lean.y,
                    out * site.outward.z + lean * site.lean.z};
    return point_of(rotated(turn, p));
  };
  const fdcg_params params = contact_params(site.mu_static, site.mu_static / 2);
  const Hip start = place(0.3 * kObject_m, 0), below = place(-depth_m, 0), rest = place(-depth_m, depth_m);
  Pressed pressed{&graph.view()};
  if (site.is_placed_smooth) {
    pressed.press(params, start, below);
  } else {
    pressed.step(params, start);
    pressed.step(params, below);
  }
  Outcome outcome;
  do {
    pressed.step(params, rest);
    ++outcome.settling;
  } while (pressed.result.state == FDCG_FREE && outcome.settling < kMostSettlingTicks);
  pressed.step(params, rest);
  double god_object[3];
  std::copy_n(pressed.contact.god_object, 3, god_object);
  outcome.state = pressed.result.state;
  Random random(seed + 17);
  for (int tick = 0; tick < ticks; ++tick) {
    Hip hip = rest;
    if (how.trembles) {
      const double radius_m = site.tremor * depth_m / std::sqrt(3.0);
      for (double& x : hip)
        x += random.uniform(-radius_m, radius_m);
    }
    pressed.step(params, hip);
    ++outcome.ticks;
    outcome.moved += !pressed.is_at(god_object) || pressed.result.state == FDCG_FREE;
  }
  return outcome;
}

const char* name_of_state(std::uint32_t state) {
  constexpr const char* kNames[] = {"free", "face", "edge", "vertex"};
  return kNames[state];
}

}  // namespace

void measure_creep(const LawOptions& options, Bars& bars) {
  const std::vector<Site> sites = all_sites();
  const int ticks = options.is_quick ? kQuickTicks : kAllTicks, orientations = options.is_quick ? 1 : 3;
  std::vector<Hold> holds;
  for (std::size_t site = 0; site < sites.size(); ++site) {
    for (int orientation = 0; orientation < orientations; ++orientation) {
      for (const bake::Precision precision : kBothPrecisions) {
        for (const double depth : kDepths) {
          for (const bool trembles : {false, true})
            holds.push_back({site, orientation, precision, depth, trembles});
        }
      }
    }
  }
  std::vector<Outcome> outcomes(holds.size());
  for_each_index(holds.size(), options.threads,
                 [&](std::size_t i) { outcomes[i] = hold(sites[holds[i].site], holds[i], ticks, options.seed * 1000); });
  Table table(
      options.output, "creep",
      {"site", "orientation", "precision", "depth_of_size", "hip", "state", "mu_static", "settling_ticks", "ticks", "moved"});
  std::uint64_t moved = 0, all = 0;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const Hold& h = holds[i];
    const Outcome& o = outcomes[i];
    table.row(sites[h.site].name, h.orientation, name_of(h.precision), h.depth, h.trembles ? "trembles" : "still",
              name_of_state(o.state), sites[h.site].mu_static, o.settling, o.ticks, o.moved);
    moved += o.moved, all += o.ticks;
  }
  bars.at_most(
      "creep: ticks under static friction in which the god-object is not where it was, to the last bit",
      static_cast<double>(moved), 0, "ticks",
      std::to_string(all) + " ticks, " + std::to_string(ticks) + " at each of " + std::to_string(holds.size()) + " holds");
}

}  // namespace fdcg::test
