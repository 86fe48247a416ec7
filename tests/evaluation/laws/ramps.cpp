// SPDX-License-Identifier: Apache-2.0
// Coulomb's law of the ramp: a load that leans by an angle sticks where the angle's tangent is below mu_s, and slides at mu_d
// where it is above. The judge is the force that the god-object of the tick before would give, in long double.
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

constexpr int kFrictions = 24, kLeans = 24;
constexpr double kFrictionStep = 0.1, kLeanStep_deg = 2.75;            // to 2.3, and to 63 degrees
constexpr double kDynamicShare = 0.75;                                 // mu_d of mu_s
constexpr double kDepths[] = {1e-3, 1e-2, 1e-1};                       // of the extent
constexpr double kOffsets[] = {2e-12, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3};  // of the lean's tangent from mu_s, as a share of it
constexpr double kDegree = std::numbers::pi / 180;

// One cell of the grid: the lean's tangent is tan(lean), or mu_s (1 + offset) near the limit.
struct Lean {
  double mu_static, tangent, offset;
};

struct Tally {
  std::uint64_t cases = 0, sticks = 0, slides = 0, wrong = 0, undecided = 0;
  double worst_ratio_error = 0;
};

std::vector<Lean> all_leans() {
  std::vector<Lean> leans;
  for (int i = 0; i < kFrictions; ++i) {
    const double mu = kFrictionStep * i;
    for (int j = 0; j < kLeans; ++j)
      leans.push_back({mu, std::tan(kLeanStep_deg * j * kDegree), std::nan("")});
    for (const double offset : kOffsets) {
      if (mu == 0) continue;
      leans.push_back({mu, mu * (1 - offset), -offset});
      leans.push_back({mu, mu * (1 + offset), offset});
    }
  }
  return leans;
}

void try_lean(const Ramp& ramp, const RampShape& shape, const Lean& lean, double depth, double heading, double bar,
              Tally* tally) {
  const double depth_m = depth * ramp.surface().extent;
  const bool is_groove = shape.kind == RampKind::groove;
  const double load_m = is_groove ? depth_m / std::sin(shape.opening_deg / 2 * kDegree) : depth_m;
  const double aside_m = lean.tangent * load_m;
  Pressed pressed{&ramp.view()};
  const fdcg_params params = contact_params(lean.mu_static, kDynamicShare * lean.mu_static);
  pressed.press(params, ramp.place(0, 0, depth_m), ramp.place(0, 0, -depth_m));
  const std::uint32_t state = pressed.contact.state, feature = pressed.contact.feature;
  double before[3];
  std::copy_n(pressed.contact.god_object, 3, before);
  const double angle = is_groove ? 0 : heading;
  pressed.step(params, ramp.place(aside_m * std::cos(angle), aside_m * std::sin(angle), -depth_m));

  const CoulombLoad asked =
      coulomb_load(ramp.surface(), state, feature, wide(before) - wide(pressed.contact.hip), FDCG_EDGE_WEDGE);
  const CoulombLoad given =
      coulomb_load(ramp.surface(), pressed.result.state, pressed.result.feature, wide(pressed.result.force_n), FDCG_EDGE_WEDGE);
  ++tally->cases;
  if (!asked.is_borne || !given.is_borne) {
    ++tally->wrong;
    return;
  }
  const bool slides = pressed.result.slipping != 0;
  ++(slides ? tally->slides : tally->sticks);
  const Wide beyond = asked.ratio() - static_cast<Wide>(lean.mu_static);
  if (std::abs(beyond) <= static_cast<Wide>(bar)) {
    ++tally->undecided;
  } else {
    tally->wrong += slides != (beyond > 0) || (!slides && !pressed.is_at(before));
  }
  const Wide expected = slides ? static_cast<Wide>(params.mu_dynamic) : asked.ratio();
  const double error = static_cast<double>(std::abs(given.ratio() - expected));
  tally->worst_ratio_error = std::max(tally->worst_ratio_error, error);
}

}  // namespace

void measure_ramps(const LawOptions& options, Bars& bars) {
  Table table(options.output, "coulomb_ramps",
              {"precision", "mu_static", "mu_dynamic", "lean_deg", "offset_of_mu_static", "cases", "sticks", "slides", "wrong",
               "within_rounding", "worst_ratio_error"});
  const std::vector<Lean> leans = all_leans();
  const int orientations = options.is_quick ? 2 : 20;
  for (const bake::Precision precision : kBothPrecisions) {
    const double bar = ratio_bar(precision);
    std::vector<Tally> tallies(leans.size());
    for (const RampShape& shape : {RampShape{RampKind::face}, {RampKind::groove, 60}, {RampKind::groove, 120}}) {
      std::vector<Ramp> ramps;
      for (int k = 0; k < orientations; ++k)
        ramps.emplace_back(shape, precision, options.seed * 1000 + static_cast<std::uint64_t>(k));
      for_each_index(leans.size(), options.threads, [&](std::size_t i) {
        Random random(options.seed + 7919 * i);
        for (const Ramp& ramp : ramps) {
          for (const double depth : kDepths)
            try_lean(ramp, shape, leans[i], depth, random.uniform(0, 2 * std::numbers::pi), bar, &tallies[i]);
        }
      });
    }
    Tally all;
    for (std::size_t i = 0; i < leans.size(); ++i) {
      const Tally& t = tallies[i];
      table.row(name_of(precision), leans[i].mu_static, kDynamicShare * leans[i].mu_static,
                std::atan(leans[i].tangent) / kDegree, leans[i].offset, t.cases, t.sticks, t.slides, t.wrong, t.undecided,
                t.worst_ratio_error);
      all.cases += t.cases, all.wrong += t.wrong, all.slides += t.slides;
      all.worst_ratio_error = std::max(all.worst_ratio_error, t.worst_ratio_error);
    }
    const std::string of = std::string(", ") + name_of(precision);
    bars.at_most("ramp: wrong decisions between stick and slip" + of, static_cast<double>(all.wrong), 0, "cases",
                 std::to_string(all.cases) + " cases, of which " + std::to_string(all.slides) + " slid");
    bars.at_most("ramp: |Ft|/|Fn| from what Coulomb says" + of, all.worst_ratio_error, bar, "",
                 "depths from 1e-3 of the extent");
  }
}

}  // namespace fdcg::test
