// SPDX-License-Identifier: Apache-2.0
// Run time against error: this runtime in its variants, and other ways to find a god-object, along the same ways.
//
// Times: every contender goes along the whole way in turn, round after round, on one thread, after one round that is not
// counted. `mean_ns` is the least of the rounds' means (no clock inside); each tick is also timed alone, and of each tick its
// least over the rounds is kept, of which the percentiles are. The first contender runs twice in every round, as itself and as
// its own control: what the two differ by is what this machine can tell apart.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "contender.hpp"
#include "metrics.hpp"
#include "pareto.hpp"
#include "stopwatch.hpp"
#include "table.hpp"
#include "truth.hpp"
#include "ways.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

struct Options {
  bool is_quick = false;
  bool judges_times = true;
  std::string output = "build/evaluation";
  std::uint64_t seed = 1;
  std::vector<std::string> bodies, ways;  // empty: the plan's
  std::uint32_t ticks = 0;                // 0: the plan's
};

// ---- what runs where -------------------------------------------------------------------------------------------------------

struct WayPlan {
  WayKind kind;
  double rate_hz = 1000;
  bool has_friction = false;
};

struct BodyPlan {
  std::string body;
  bool is_ladder = false;  // its hand way counts for the frontier
  std::vector<WayPlan> ways;
};

std::vector<BodyPlan> plan_of(bool is_quick) {
  const WayPlan hand{WayKind::hand}, jumps{WayKind::teleport}, dive{WayKind::corner_dive}, tremor{WayKind::tremor};
  const WayPlan rub{WayKind::hand, 1000, true}, shake{WayKind::tremor, 1000, true};
  if (is_quick) {
    return {{"cube_12", true, {hand}},
            {"star_1k", true, {hand, rub}},
            {"sphere_10k", true, {hand}},
            {"thin_plate", false, {hand}},
            {"corner_pit_tilted", false, {tremor}}};
  }
  std::vector<BodyPlan> plan = {{"cube_12", true, {hand, rub, jumps}}};
  for (const char* size : {"80", "1k", "10k", "100k", "1M"}) {
    for (const char* shape : {"sphere_", "star_"})
      plan.push_back({std::string(shape) + size, true, {hand}});
  }
  for (const WayName& way : kWays) {  // the same motion at other rates, and other motions
    for (BodyPlan& body : plan) {
      if (body.body != "star_1k" && body.body != "star_100k") continue;
      if (way.kind == WayKind::hand) {
        for (const double rate : {4000.0, 10'000.0, 40'000.0})
          body.ways.push_back({way.kind, rate});
        body.ways.push_back(rub);
      } else {
        body.ways.push_back({way.kind});
      }
    }
  }
  plan.push_back({"torus_10k", true, {hand}});
  for (const char* name : {"corner_pit_tilted", "v_groove_tilted", "saddle", "spiky", "thin_plate"})
    plan.push_back({name, false, {hand, rub, dive, tremor, shake}});
  plan.push_back({"knife", false, {hand, dive}});
  plan.push_back({"foil", false, {hand}});
  plan.push_back({"needle_strip", false, {hand, {WayKind::edge_slide}}});
  plan.push_back({"fan_peak", false, {hand, {WayKind::fan_orbit}}});
  return plan;
}

using Contenders = std::vector<std::unique_ptr<Contender>>;

Contenders contenders_for(const Ground& ground, const Body& body, bool is_quick) {
  const fdcg::bake::PolygonSoup& soup = ground.soup();
  constexpr std::uint32_t kLarge = 200'000;  // faces: from here on fewer variants, and no grid that takes minutes to bake
  Contenders list;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const bool is_stored : {true, false}) {
      list.push_back(make_fdcg(soup, {precision, is_stored, true}));
      if (body.faces < kLarge) list.push_back(make_fdcg(soup, {precision, is_stored, false}));
    }
  }
  list.push_back(make_paper(soup));
  list.push_back(make_cgal_closest(soup));
  list.push_back(make_embree_closest(soup));
  list.push_back(make_proxy(soup));
  if (!body.is_closed) return list;  // no inside, no signed distance
  const std::vector<int> resolutions = is_quick ? std::vector<int>{32, 64} : std::vector<int>{32, 64, 128};
  for (const int resolution : resolutions)
    list.push_back(make_distance_grid(ground, resolution));
  if (body.name == "star_10k" || body.name == "star_100k") list.push_back(make_distance_grid(ground, 256));
  return list;
}

// ---- times -----------------------------------------------------------------------------------------------------------------

struct Timing {
  double mean_ns = 1e300;
  std::vector<float> tick_ns;  // the least of each tick
  int rounds = 0, wanted_rounds = 1;
};

double way_ns(Contender& contender, const Way& way, const Stopwatch& watch) {
  Feel feel;
  contender.reset();
  const std::uint64_t begin = Stopwatch::now();
  for (const auto& hip : way)
    contender.step(hip, feel);
  return watch.nanoseconds(begin, Stopwatch::now());
}

void time_ticks(Contender& contender, const Way& way, const Stopwatch& watch, std::vector<float>& least) {
  Feel feel;
  contender.reset();
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::uint64_t begin = Stopwatch::now();
    contender.step(way[i], feel);
    least[i] = std::min(least[i], static_cast<float>(watch.nanoseconds(begin, Stopwatch::now())));
  }
}

// One entry for each of `entrants`; the same one may enter twice.
std::vector<Timing> time_all(const std::vector<Contender*>& entrants, const Way& way, const Stopwatch& watch, double budget_s) {
  constexpr int kLeastRounds = 3, kMostRounds = 61;
  std::vector<Timing> timings(entrants.size());
  int rounds = 0;
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    const double once_ns = way_ns(*entrants[e], way, watch);  // not counted: warms up, tells how often it may run
    const double share = budget_s * 1e9 / static_cast<double>(entrants.size());
    timings[e].wanted_rounds = std::clamp(static_cast<int>(share / (2 * once_ns + 1)), kLeastRounds, kMostRounds);
    timings[e].tick_ns.assign(way.size(), 1e30f);
    rounds = std::max(rounds, timings[e].wanted_rounds);
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < entrants.size(); ++k) {
      const std::size_t e = (k + static_cast<std::size_t>(round)) % entrants.size();  // each comes after others in turn
      Timing& timing = timings[e];
      if (timing.rounds >= timing.wanted_rounds) continue;
      ++timing.rounds;
      timing.mean_ns = std::min(timing.mean_ns, way_ns(*entrants[e], way, watch) / static_cast<double>(way.size()));
      time_ticks(*entrants[e], way, watch, timing.tick_ns);
    }
  }
  return timings;
}

// ---- the program -----------------------------------------------------------------------------------------------------------

struct Totals {
  std::uint64_t own_push_throughs = 0;
  double own_creep_m = 0, own_energy_excess_j = 0;
  std::string worst_push_through, worst_energy;
};

class Evaluation {
 public:
  explicit Evaluation(const Options& options)
      : options_(options),
        bars_(options.output, "fdcg_bench_contenders"),
        table_(options.output, "contenders",
               {"body",
                "group",
                "faces",
                "way",
                "rate_hz",
                "mu_static",
                "mu_dynamic",
                "contender",
                "family",
                "precision",
                "planes",
                "merged",
                "ticks",
                "contact_ticks",
                "rounds",
                "mean_ns",
                "p50_ns",
                "p99_ns",
                "p999_ns",
                "max_ns",
                "transitions",
                "bytes_per_face",
                "bake_s",
                "god_object_rms_m",
                "god_object_p50_m",
                "god_object_p99_m",
                "god_object_max_m",
                "force_rms_n",
                "force_max_n",
                "force_share_p99",
                "noticeable_share",
                "direction_p99_deg",
                "direction_max_deg",
                "jump_n_per_ms",
                "true_jump_n_per_ms",
                "wrong_feature_share",
                "push_throughs",
                "push_through_share",
                "phantom_share",
                "creep_m",
                "energy_work_j",
                "energy_bound_j",
                "reference"}),
        pareto_(options.output, "pareto",
                {"body", "group", "faces", "contender", "family", "mean_ns", "god_object_rms_m", "bytes_per_face", "bake_s",
                 "on_frontier", "beaten_by", "resolution"}),
        verdict_(options.output, "pareto_verdict",
                 {"body", "faces", "f64_on_frontier", "f32_on_frontier", "f32_over_f64_time", "resolution",
                  "where_others_are_better"}) {}

  void run(const BodyPlan& plan);
  int finish();

 private:
  void run_way(const BodyPlan& plan, const Body& body, const Ground& ground, const TrueBody& true_body,
               const Contenders& contenders, const WayPlan& way);
  void rank_body(const Body& body, std::vector<Standing> standings, double resolution);

  Options options_;
  Stopwatch watch_;
  Bars bars_;
  Table table_, pareto_, verdict_;
  Totals totals_;
};

const char* name_of(BodyGroup group) {
  constexpr const char* names[] = {"sphere", "star", "torus", "awkward"};
  return names[static_cast<std::size_t>(group)];
}

void Evaluation::run(const BodyPlan& plan) {
  const Body body = body_named(plan.body);
  const Ground ground(body.make());
  const TrueBody true_body(ground);
  const Contenders contenders = contenders_for(ground, body, options_.is_quick);
  for (const WayPlan& way : plan.ways) {
    if (!options_.ways.empty() &&
        std::find(options_.ways.begin(), options_.ways.end(), name_of(way.kind)) == options_.ways.end()) {
      continue;
    }
    run_way(plan, body, ground, true_body, contenders, way);
  }
}

void Evaluation::run_way(const BodyPlan& plan, const Body& body, const Ground& ground, const TrueBody& true_body,
                         const Contenders& contenders, const WayPlan& way_plan) {
  constexpr double kMuStatic = 0.6, kMuDynamic = 0.4;
  const double mu_static = way_plan.has_friction ? kMuStatic : 0, mu_dynamic = way_plan.has_friction ? kMuDynamic : 0;
  WayOptions way_options;
  way_options.kind = way_plan.kind;
  way_options.rate_hz = way_plan.rate_hz;
  way_options.ticks = options_.ticks > 0 ? options_.ticks : options_.is_quick ? 4000 : 10'000;
  way_options.seed = options_.seed;
  const Way way = make_way(ground, way_options);
  const std::vector<TrueBody::Tick> truth = true_body.follow(way, {mu_static, mu_dynamic, true});
  std::vector<Contender*> entrants;
  for (const auto& contender : contenders) {
    contender->set_friction(mu_static, mu_dynamic);
    if (!way_plan.has_friction || contender->info().has_friction) entrants.push_back(contender.get());
  }
  entrants.push_back(entrants[0]);  // the control
  std::vector<Timing> timings = time_all(entrants, way, watch_, options_.is_quick ? 0.6 : 1.2);
  const double control = std::abs(std::log(timings.back().mean_ns / timings[0].mean_ns));
  constexpr double kFinest = 0.01, kCoarsest = 0.03;  // never blinder than three per cent, whatever the machine does
  const double resolution = std::clamp(std::exp(control) - 1, kFinest, kCoarsest);
  const double faces = body.faces;
  std::printf("%s, %s at %g Hz, mu %g/%g\n", body.name.c_str(), name_of(way_plan.kind), way_plan.rate_hz, mu_static,
              mu_dynamic);
  std::vector<Standing> standings;
  for (std::size_t e = 0; e + 1 < entrants.size(); ++e) {
    Contender& contender = *entrants[e];
    const ContenderInfo& info = contender.info();
    const Metrics m = judge(way, way_plan.rate_hz, feel_along(contender, way), truth, true_body);
    const LoopEnergy energy = energy_of_loop(contender, way);
    const double creep = creep_m(contender, way, truth);
    const Percentiles ticks(std::move(timings[e].tick_ns));
    const double bytes_per_face = static_cast<double>(info.bytes) / faces;
    table_.row(body.name, name_of(body.group), body.faces, name_of(way_plan.kind), way_plan.rate_hz, mu_static, mu_dynamic,
               info.name, info.family, info.precision, info.planes, info.merged, m.ticks, m.contact_ticks, timings[e].rounds,
               timings[e].mean_ns, ticks.at(0.5), ticks.at(0.99), ticks.at(0.999), ticks.at(1), m.transitions, bytes_per_face,
               info.bake_s, m.god_object_rms_m, m.god_object_p50_m, m.god_object_p99_m, m.god_object_max_m, m.force_rms_n,
               m.force_max_n, m.force_share_p99, m.noticeable_share, m.direction_p99_deg, m.direction_max_deg, m.jump_n_per_ms,
               m.true_jump_n_per_ms, m.wrong_feature_share, m.push_throughs, m.push_through_share, m.phantom_share, creep,
               energy.work_j, energy.bound_j, "brute force, long double");
    std::printf("  %-26s %7.0f ns (p99 %6.0f)  error rms %8.2g m, max %8.2g m  wrong feature %5.1f %%  pushed through %llu\n",
                info.name.c_str(), timings[e].mean_ns, ticks.at(0.99), m.god_object_rms_m, m.god_object_max_m,
                100 * m.wrong_feature_share, static_cast<unsigned long long>(m.push_throughs));
    standings.push_back(
        {info.name, info.family, timings[e].mean_ns, m.god_object_rms_m, bytes_per_face, info.bake_s, false, ""});
    if (info.family != "fdcg") continue;
    const std::string where = info.name + " on " + body.name + ", " + name_of(way_plan.kind);
    totals_.own_push_throughs += m.push_throughs;
    if (m.push_throughs > 0) totals_.worst_push_through = where;
    totals_.own_creep_m = std::max(totals_.own_creep_m, creep);
    if (energy.work_j - energy.bound_j > totals_.own_energy_excess_j) totals_.worst_energy = where;
    totals_.own_energy_excess_j = std::max(totals_.own_energy_excess_j, energy.work_j - energy.bound_j);
  }
  std::fflush(stdout);
  const bool counts = plan.is_ladder && way_plan.kind == WayKind::hand && way_plan.rate_hz == 1000 && !way_plan.has_friction;
  if (counts) rank_body(body, std::move(standings), resolution);
}

void Evaluation::rank_body(const Body& body, std::vector<Standing> standings, double resolution) {
  constexpr double kFloor_m = kBody_m * 0x1p-53;  // a unit in the last place of the body: less is no error
  rank(standings, resolution, kFloor_m);
  int on_frontier[2] = {0, 0};
  double best_ns[2] = {1e300, 1e300};
  std::string beaten_by[2];
  for (const Standing& s : standings) {
    pareto_.row(body.name, name_of(body.group), body.faces, s.name, s.family, s.time_ns, s.error_m, s.bytes_per_face, s.bake_s,
                s.is_on_frontier ? "yes" : "no", s.beaten_by, resolution);
    if (s.family != "fdcg") continue;
    const std::size_t which = s.name.find("f32") != std::string::npos;
    on_frontier[which] += s.is_on_frontier;
    best_ns[which] = std::min(best_ns[which], s.time_ns);
    if (!s.is_on_frontier) beaten_by[which] += " " + s.name + " is beaten by " + s.beaten_by;
  }
  const double ratio = best_ns[1] / best_ns[0];
  verdict_.row(body.name, body.faces, on_frontier[0], on_frontier[1], ratio, resolution, where_others_win(standings, "fdcg"));
  for (const std::size_t which : {0, 1}) {
    if (!options_.judges_times) break;
    char note[300];
    std::snprintf(note, sizeof note, "best f32 takes %.3f of best f64, told apart from %.1f %%;%s", ratio, 100 * resolution,
                  beaten_by[which].empty() ? " none beaten" : beaten_by[which].c_str());
    bars_.at_least(std::string(which == 0 ? "f64" : "f32") + " variants on the frontier, " + body.name, on_frontier[which], 1,
                   "variants", note);
  }
}

int Evaluation::finish() {
  bars_.at_most("own push-throughs", static_cast<double>(totals_.own_push_throughs), 0, "times", totals_.worst_push_through);
  bars_.at_most("own creep at rest", totals_.own_creep_m, 0, "m");
  bars_.at_most("own work beyond the zero-order hold's", totals_.own_energy_excess_j, 0, "J", totals_.worst_energy);
  return bars_.failures() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Run time against error: this runtime and other ways to find a god-object, along the same ways.\n"
      "Example: fdcg_bench_contenders --body star_10k --way hand --output /tmp/bench"};
  app.add_flag("--quick", options.is_quick, "small bodies, few ways: some 12 s in place of 3 minutes");
  app.add_flag("!--no-time-bars", options.judges_times,
               "tell the frontier without judging it: for machines that do other work");
  app.add_option("--output", options.output, "folder for contenders.csv, pareto.csv, pareto_verdict.csv and the bars")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of the ways")->capture_default_str();
  app.add_option("--body", options.bodies, "only these; one that the plan lacks gets the ways hand and teleport");
  app.add_option("--way", options.ways, "only these of the plan's ways");
  app.add_option("--ticks", options.ticks, "of each way; default 10,000, quick 4,000")->check(CLI::Range(100u, 1'000'000u));
  try {
    app.parse(argc, argv);
    for (const std::string& name : options.bodies)
      (void)body_named(name);
    for (const std::string& name : options.ways)
      (void)way_named(name);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  std::vector<BodyPlan> plan = plan_of(options.is_quick);
  if (!options.bodies.empty()) {
    std::vector<BodyPlan> chosen;
    for (const std::string& name : options.bodies) {
      const auto planned = std::find_if(plan.begin(), plan.end(), [&](const BodyPlan& p) { return p.body == name; });
      const bool is_ladder = body_named(name).group != BodyGroup::awkward;
      chosen.push_back(planned != plan.end() ? *planned : BodyPlan{name, is_ladder, {{WayKind::hand}, {WayKind::teleport}}});
    }
    plan = std::move(chosen);
  }
  Evaluation evaluation(options);
  for (const BodyPlan& body : plan)
    evaluation.run(body);
  return evaluation.finish();
}
