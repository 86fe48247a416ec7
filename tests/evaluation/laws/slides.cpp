// SPDX-License-Identifier: Apache-2.0
// Coulomb's law in motion: while the god-object slides, tangential over normal force is mu_d, whatever the stiffness, the speed
// and the rate, and on a plane, cut by seams or not, and in a groove it lies along the slip; while it sticks, at most mu_s.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "laws.hpp"
#include "parallel.hpp"
#include "pressed.hpp"
#include "ramp.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr double kStiffnesses_n_per_m[] = {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6};
constexpr double kSpeeds_m_per_s[] = {1e-4, 1e-3, 1e-2, 1e-1, 1};
constexpr double kRates_hz[] = {1e3, 4e3, 1e4, 4e4};
constexpr double kDepths[] = {1e-3, 1e-2, 1e-1};  // of the extent
constexpr double kLeastMu = 0.1, kMostMu = 2;     // mu_s; mu_d anywhere below it
constexpr double kGrooveMuStatic = 0.7, kGrooveMuDynamic = 0.45;
constexpr double kWay_m = 0.03;  // radius of the circle on a flat ramp, half of the way to and fro in a groove
// A god-object that the circle of friction reaches again from inside stays at rest until it is this much inside: the servo
// step's hysteresis (contact-model FRIC-3).
constexpr double kStickAgain = 1 - 0x1p-20;

// On what is slid.
struct Track {
  RampShape shape;
  bake::Precision precision;
  RampGraph graph;
  std::uint32_t edge_friction;
};

// How.
struct Motion {
  double stiffness_n_per_m, speed_m_per_s, rate_hz;
};

struct Tally {
  std::uint64_t ticks = 0, moved = 0, held = 0, wrong = 0, shallow = 0;
  double worst_ratio_error = 0, worst_off_slip = 0;

  void add(const Tally& other) {
    ticks += other.ticks, moved += other.moved, held += other.held, wrong += other.wrong, shallow += other.shallow;
    worst_ratio_error = std::max(worst_ratio_error, other.worst_ratio_error);
    worst_off_slip = std::max(worst_off_slip, other.worst_off_slip);
  }
};

// Where the HIP is, way_m along its path, in the body's frame.
Hip path(const RampShape& shape, double depth_m, double way_m, double phase) {
  if (shape.kind == RampKind::groove) {
    const double turn = way_m / kWay_m + phase, folded = std::abs(std::remainder(turn, 4.0)) - 1;  // -1 .. 1
    return {kWay_m * folded, 0, -depth_m};
  }
  if (shape.kind == RampKind::convex_edges) {  // around the prism, and slowly along it
    const double radius = kObject_m * std::cos(std::numbers::pi / shape.sides) - depth_m;
    const double angle = way_m / radius + phase;
    return {radius * std::cos(angle), radius * std::sin(angle), kWay_m * std::sin(0.37 * angle)};
  }
  const double angle = way_m / kWay_m + phase;
  return {kWay_m * std::cos(angle), kWay_m * std::sin(angle), -depth_m};
}

Hip above(const RampShape& shape, const Hip& below) {
  if (shape.kind != RampKind::convex_edges) return {below[0], below[1], kWay_m};
  return {3 * below[0] / 2 + below[0], 3 * below[1] / 2 + below[1], below[2]};
}

// Whether a slip ends on a feature along which it has gone straight: all of a plane, the bottom of a groove.
bool is_straight(const RampShape& shape, std::uint32_t state) {
  if (shape.kind == RampKind::groove) return state == FDCG_EDGE;
  return shape.kind != RampKind::convex_edges && state == FDCG_FACE;
}

void judge(const Ramp& ramp, const Track& track, const fdcg_params& params, const Pressed& pressed, const double (&before)[3],
           Tally* tally) {
  const CoulombLoad load = coulomb_load(ramp.surface(), pressed.result.state, pressed.result.feature,
                                        wide(pressed.result.force_n), track.edge_friction);
  ++tally->ticks;
  if (!load.is_borne) {
    ++tally->wrong;
    return;
  }
  const Wide depth = load.normal / (params.stiffness_n_per_m * ramp.surface().extent);
  if (depth < 0.999L * kDepths[0]) {
    ++tally->shallow;
    return;
  }
  const bool has_moved = !pressed.is_at(before), slips = pressed.result.slipping != 0;
  ++(has_moved ? tally->moved : tally->held);
  const Wide mu_static = params.mu_static, mu_dynamic = params.mu_dynamic;
  Wide error = 0;
  if (!slips) {
    error = std::max<Wide>(0, load.ratio() - mu_static);
  } else if (has_moved) {
    error = std::abs(load.ratio() - mu_dynamic);
  } else {
    error = std::max<Wide>({0, load.ratio() - mu_dynamic, kStickAgain * mu_dynamic - load.ratio()});
  }
  tally->worst_ratio_error = std::max(tally->worst_ratio_error, static_cast<double>(error));
  if (!has_moved || !is_straight(track.shape, pressed.result.state)) return;
  const Wide off = off_the_slip(ramp.surface(), pressed.result.state, pressed.result.feature, wide(pressed.result.force_n),
                                wide(before) - wide(pressed.contact.hip), load.normal);
  tally->worst_off_slip = std::max(tally->worst_off_slip, static_cast<double>(off));
}

Tally run(const Ramp& ramp, const Track& track, const Motion& motion, double depth, int ticks, Random random) {
  const double depth_m = depth * ramp.surface().extent, tick_m = motion.speed_m_per_s / motion.rate_hz;
  const double phase = random.uniform(0, 2 * std::numbers::pi), mu_static = random.uniform(kLeastMu, kMostMu);
  const auto hip_at = [&](double way_m) {
    const Hip p = path(track.shape, depth_m, way_m, phase);
    return ramp.place(p[0], p[1], p[2]);
  };
  fdcg_params params = contact_params(mu_static, mu_static * random.unit(), track.edge_friction);
  params.stiffness_n_per_m = motion.stiffness_n_per_m;
  const Hip start = path(track.shape, depth_m, 0, phase), high = above(track.shape, start);
  Pressed pressed{&ramp.view()};
  pressed.press(params, ramp.place(high[0], high[1], high[2]), hip_at(0));
  // At once beyond the static cone, then on at the speed asked for.
  const double load_factor = track.shape.kind == RampKind::groove && track.edge_friction == FDCG_EDGE_WEDGE
                                 ? 1 / std::sin(track.shape.opening_deg * std::numbers::pi / 360)
                                 : 1;
  const double lead_m = std::min(1.1 * mu_static * depth_m * load_factor, kWay_m);
  Tally tally;
  for (int tick = 0; tick < ticks; ++tick) {
    double before[3];
    std::copy_n(pressed.contact.god_object, 3, before);
    pressed.step(params, hip_at(lead_m + tick * tick_m));
    judge(ramp, track, params, pressed, before, &tally);
  }
  return tally;
}

std::vector<Track> all_tracks() {
  std::vector<Track> tracks;
  for (const RampShape& shape : ramp_shapes()) {
    for (const bake::Precision precision : kBothPrecisions) {
      for (const RampGraph graph : kRampGraphs) {
        tracks.push_back({shape, precision, graph, FDCG_EDGE_WEDGE});
        if (shape.kind == RampKind::groove) tracks.push_back({shape, precision, graph, FDCG_EDGE_PAPER});
      }
    }
  }
  return tracks;
}

std::vector<Motion> all_motions() {
  std::vector<Motion> motions;
  for (const double stiffness : kStiffnesses_n_per_m) {
    for (const double speed : kSpeeds_m_per_s) {
      for (const double rate : kRates_hz)
        motions.push_back({stiffness, speed, rate});
    }
  }
  return motions;
}

// How much the two rules let a groove hold along its line, as a multiple of the force across it.
void say_grooves(const LawOptions& options) {
  Table table(options.output, "grooves",
              {"opening_deg", "precision", "along_over_across_wedge", "along_over_across_paper", "wedge_in_theory"});
  for (const bake::Precision precision : kBothPrecisions) {
    for (int opening_deg = 30; opening_deg <= 150; opening_deg += 10) {
      const RampShape shape = {RampKind::groove, static_cast<double>(opening_deg)};
      const Ramp ramp(shape, precision, options.seed);
      const double depth_m = 1e-2 * ramp.surface().extent;
      double measured[2] = {};
      for (const std::uint32_t rule : {FDCG_EDGE_WEDGE, FDCG_EDGE_PAPER}) {
        Pressed pressed{&ramp.view()};
        const fdcg_params params = contact_params(kGrooveMuStatic, kGrooveMuDynamic, rule);
        pressed.press(params, ramp.place(-kWay_m, 0, kWay_m), ramp.place(-kWay_m, 0, -depth_m));
        pressed.step(params, ramp.place(kWay_m, 0, -depth_m));
        measured[rule] = static_cast<double>(coulomb_load(ramp.surface(), pressed.result.state, pressed.result.feature,
                                                          wide(pressed.result.force_n), FDCG_EDGE_PAPER)
                                                 .ratio());
      }
      table.row(opening_deg, name_of(precision), measured[FDCG_EDGE_WEDGE], measured[FDCG_EDGE_PAPER],
                kGrooveMuDynamic / std::sin(opening_deg * std::numbers::pi / 360));
    }
  }
}

constexpr std::size_t kDepthCount = std::size(kDepths);

// Of every track, motion and depth.
struct Results {
  std::vector<Track> tracks = all_tracks();
  std::vector<Motion> motions = all_motions();
  std::vector<Tally> tallies = std::vector<Tally>(tracks.size() * motions.size() * kDepthCount);

  Tally& at(std::size_t track, std::size_t motion, std::size_t depth) {
    return tallies[(track * motions.size() + motion) * kDepthCount + depth];
  }
};

Results slide_everywhere(const LawOptions& options) {
  Results results;
  const int ticks = options.is_quick ? 20 : 300, orientations = options.is_quick ? 1 : 4;
  for_each_index(results.tracks.size(), options.threads, [&](std::size_t t) {
    const Track& track = results.tracks[t];
    for (int k = 0; k < orientations; ++k) {
      const Ramp ramp(track.shape, track.precision, options.seed * 1000 + static_cast<std::uint64_t>(k), track.graph);
      for (std::size_t m = 0; m < results.motions.size(); ++m) {
        for (std::size_t d = 0; d < kDepthCount; ++d) {
          const Random random(options.seed + 104729 * (t * results.motions.size() + m) + 31 * d +
                              static_cast<std::uint64_t>(k));
          results.at(t, m, d).add(run(ramp, track, results.motions[m], kDepths[d], ticks, random));
        }
      }
    }
  });
  return results;
}

void say_by_track(Results& results, const LawOptions& options) {
  Table table(options.output, "coulomb_slides",
              {"surface", "opening_deg", "precision", "graph", "edge_rule", "depth_of_extent", "ticks", "moved", "held",
               "shallow", "wrong", "worst_ratio_error", "worst_off_slip"});
  for (std::size_t t = 0; t < results.tracks.size(); ++t) {
    const Track& track = results.tracks[t];
    for (std::size_t d = 0; d < kDepthCount; ++d) {
      Tally all;
      for (std::size_t m = 0; m < results.motions.size(); ++m)
        all.add(results.at(t, m, d));
      table.row(track.shape.name(), track.shape.opening_deg, name_of(track.precision), name_of(track.graph),
                track.edge_friction == FDCG_EDGE_WEDGE ? "wedge" : "paper", kDepths[d], all.ticks, all.moved, all.held,
                all.shallow, all.wrong, all.worst_ratio_error, all.worst_off_slip);
    }
  }
}

void say_by_motion(Results& results, const LawOptions& options) {
  Table table(options.output, "coulomb_motions",
              {"precision", "stiffness_n_per_m", "speed_m_per_s", "rate_hz", "ticks", "moved", "worst_ratio_error"});
  for (const bake::Precision precision : kBothPrecisions) {
    for (std::size_t m = 0; m < results.motions.size(); ++m) {
      Tally all;
      for (std::size_t t = 0; t < results.tracks.size(); ++t) {
        for (std::size_t d = 0; d < kDepthCount && results.tracks[t].precision == precision; ++d)
          all.add(results.at(t, m, d));
      }
      const Motion& motion = results.motions[m];
      table.row(name_of(precision), motion.stiffness_n_per_m, motion.speed_m_per_s, motion.rate_hz, all.ticks, all.moved,
                all.worst_ratio_error);
    }
  }
}

}  // namespace

void measure_slides(const LawOptions& options, Bars& bars) {
  Results results = slide_everywhere(options);
  say_by_track(results, options);
  say_by_motion(results, options);
  say_grooves(options);
  for (const bake::Precision precision : kBothPrecisions) {
    Tally all;
    for (std::size_t t = 0; t < results.tracks.size(); ++t) {
      for (std::size_t i = 0; i < results.motions.size() * kDepthCount && results.tracks[t].precision == precision; ++i)
        all.add(results.tallies[t * results.motions.size() * kDepthCount + i]);
    }
    const std::string of = std::string(", ") + name_of(precision);
    bars.at_most("slide: |Ft|/|Fn| from mu_d" + of, all.worst_ratio_error, ratio_bar(precision), "",
                 std::to_string(all.moved) + " ticks of sliding");
    bars.at_most("slide: friction beside the slip, of |Fn|" + of, all.worst_off_slip, ratio_bar(precision), "",
                 "on planes, through all of their seams, and in grooves");
    bars.at_most("slide: ticks on features that bear no load" + of, static_cast<double>(all.wrong), 0, "ticks");
    bars.at_least("slide: share of the judged ticks that slid" + of,
                  static_cast<double>(all.moved) / static_cast<double>(all.moved + all.held), 0.5, "",
                  "else the bar above says nothing");
  }
}

}  // namespace fdcg::test
