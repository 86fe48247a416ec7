// SPDX-License-Identifier: Apache-2.0
// Run time against error along the plan's ways: what is measured, judged, written and ranked. See timing.hpp for how times are
// taken, metrics.hpp for what is judged, contender.hpp for who takes part.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "metrics.hpp"
#include "pareto.hpp"
#include "plan.hpp"
#include "table.hpp"
#include "timing.hpp"
#include "truth.hpp"
#include "way_file.hpp"

namespace fdcg::test {

struct EvaluationOptions {
  bool is_quick = false, judges_times = true;
  std::string output = "build/evaluation";
  std::uint64_t seed = 1;
  std::uint32_t seeds = 0;                // of ways that count: seed, seed + 1, ...; 0: the plan's
  std::vector<std::string> bodies, ways;  // empty: the plan's
  std::uint32_t ticks = 0;                // 0: the plan's
  std::vector<std::string> rivals;        // make_rival()'s
  std::vector<std::string> contenders;    // only these; empty: all
  std::string export_folder;              // empty: nothing is exported
  std::vector<std::string> way_files;     // in place of the plan
  std::string mesh;                       // of way files that name none
  PlainColumns columns;                   // of these
};

// contenders.csv, pareto.csv, pareto_verdict.csv, raw/ and the bars, in the options' folder. Throws std::runtime_error.
class Evaluation {
 public:
  explicit Evaluation(const EvaluationOptions& options);
  void run(const BodyPlan& plan);
  void run(const WayFile& file);
  // A mesh that others bring, scaled to kBody_m, equal vertices made one. Passed over, and said, where it is no mesh, does not
  // compile, has faces that are not convex, a contender refuses it, or too few seeds give a hand's way on it; then false.
  bool run_mesh(const std::string& path);
  // Exit code: 1 where a bar fails.
  int finish();

 private:
  struct Scene {  // a body, ready
    const Body& body;
    const Ground& ground;
    const TrueBody& truth;
    const Contenders& contenders;
  };
  // Entrants of one way: those that are judged, then controls, which are the same graph made twice, in other memory.
  struct Entrants {
    std::vector<Contender*> all;
    std::size_t judged = 0;
    Contenders controls;
  };
  // What one way has measured, as sums over ticks, so that the ways of several seeds make one figure.
  struct Measured {
    double ticks = 0, cold_ticks = 0;            // of all its ways
    std::vector<double> ns, cold_ns, square_m2;  // of each entrant; square_m2: of those judged
    void add(const Measured& other);
  };
  // What must never happen to this runtime, over every row.
  struct OwnFaults {
    std::uint64_t push_throughs = 0, astray = 0;
    double creep_m = 0, energy_excess_j = 0, tied_share = 0;
    std::string push_through_at, astray_at, creep_at, energy_at, tied_at;
    void add(const std::string& where, const Metrics& m, double creep, const LoopEnergy& energy);
  };

  void run(const Body& body, bake::PolygonSoup soup, const std::vector<WayPlan>& ways);
  [[nodiscard]] bool is_wanted(const WayPlan& way) const;
  [[nodiscard]] Contenders entrants_of(const Ground& ground, const Body& body) const;
  [[nodiscard]] Entrants enter(const Scene& scene, const WayPlan& plan) const;
  void run_way(const Scene& scene, const WayPlan& plan);
  Measured run_along(const Scene& scene, const WayPlan& plan, const Entrants& entrants, WayFile along,
                     const std::vector<TrueBody::Tick>& truth);
  // Its row; returns error_of() tick by tick.
  std::vector<float> run_contender(const Scene& scene, const WayPlan& plan, const WayFile& along,
                                   const std::vector<TrueBody::Tick>& truth, Contender& contender, const Timing& timing);
  void rank_body(const Scene& scene, const Entrants& entrants, const Measured& measured, std::uint32_t seeds);

  EvaluationOptions options_;
  Stopwatch watch_;
  Bars bars_;
  Table table_, pareto_, verdict_;
  OwnFaults faults_;
  double truth_off_m_ = 0;  // from what way files say
  double unjudged_share_ = 0;
  std::string unjudged_at_;
};

}  // namespace fdcg::test
