// SPDX-License-Identifier: Apache-2.0
// Run time against error: this runtime in its variants, and other ways to find a god-object, along the same ways in the same
// harness. Errors are against brute force in long double. See timing.hpp for how times are taken, metrics.hpp for what is
// judged, contender.hpp for who takes part.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metrics.hpp"
#include "pareto.hpp"
#include "plan.hpp"
#include "point.hpp"
#include "program_options.hpp"
#include "rival.hpp"
#include "table.hpp"
#include "timing.hpp"
#include "truth.hpp"
#include "way_file.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

// Rivals of this folder, whose libraries were found when it was built.
const std::vector<std::string> kShippedRivals = {
#ifdef FDCG_RIVAL_FCL
    FDCG_RIVAL_FCL
#endif
};

struct Options {
  bool is_quick = false, judges_times = true;
  std::string output = "build/evaluation";
  std::uint64_t seed = 1;
  std::vector<std::string> bodies, ways;  // empty: the plan's
  std::uint32_t ticks = 0;                // 0: the plan's
  std::vector<std::string> rivals;        // make_rival()'s
  std::vector<std::string> contenders;    // only these; empty: all
  std::string export_folder;              // empty: nothing is exported
  std::vector<std::string> way_files;     // in place of the plan
  std::string mesh;                       // of way files that name none
};

const std::vector<std::string> kColumns = {"body",
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
                                           "batch_ns",
                                           "p50_ns",
                                           "p99_ns",
                                           "p999_ns",
                                           "max_ns",
                                           "free_p50_ns",
                                           "contact_p50_ns",
                                           "transitions",
                                           "carried_ticks",
                                           "bytes_per_face",
                                           "bake_s",
                                           "tied_share",
                                           "god_object_rms_untied_m",
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
                                           "reference"};

// Every edge has two faces.
bool is_closed(const fdcg::bake::PolygonSoup& soup) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], last = soup.face_first[f + 1];
    for (std::uint32_t k = first; k < last; ++k)
      ++uses[std::minmax(soup.corners[k], soup.corners[k + 1 < last ? k + 1 : first])];
  }
  return std::all_of(uses.begin(), uses.end(), [](const auto& use) { return use.second == 2; });
}

const char* name_of(BodyGroup group) {
  constexpr const char* kNames[] = {"sphere", "star", "torus", "awkward"};
  return kNames[static_cast<std::size_t>(group)];
}

// What the same graph made twice, in other memory, differs by in time: that much tells nothing. Never finer than half a per
// cent, never blinder than three, whatever the machine does.
double resolution_of(const std::vector<Contender*>& entrants, const std::vector<Timing>& timings) {
  constexpr double kFinest = 0.005, kCoarsest = 0.03;
  double seen = kFinest;
  for (std::size_t a = 0; a < entrants.size(); ++a) {
    for (std::size_t b = a + 1; b < entrants.size(); ++b) {
      if (entrants[a]->info().name != entrants[b]->info().name) continue;
      seen = std::max(seen, std::abs(timings[b].mean_ns() / timings[a].mean_ns() - 1));
    }
  }
  return std::min(seen, kCoarsest);
}

// What must never happen to this runtime, over every row.
struct OwnFaults {
  std::uint64_t push_throughs = 0;
  double creep_m = 0, energy_excess_j = 0;
  std::string push_through_at, creep_at, energy_at;

  void add(const std::string& where, const Metrics& m, double creep, const LoopEnergy& energy) {
    push_throughs += m.push_throughs;
    if (m.push_throughs > 0) push_through_at = where;
    if (creep > creep_m) creep_m = creep, creep_at = where;
    const double excess = energy.work_j - energy.bound_j;
    if (excess > energy_excess_j) energy_excess_j = excess, energy_at = where;
  }
};

class Evaluation {
 public:
  explicit Evaluation(const Options& options)
      : options_(options),
        bars_(options.output, "fdcg_bench_contenders"),
        table_(options.output, "contenders", kColumns),
        pareto_(options.output, "pareto",
                {"body", "group", "faces", "contender", "family", "mean_ns", "god_object_rms_m", "bytes_per_face", "bake_s",
                 "on_frontier", "beaten_by", "resolution"}),
        verdict_(options.output, "pareto_verdict",
                 {"body", "faces", "f64_on_frontier", "f32_on_frontier", "f32_over_f64_time", "resolution",
                  "where_others_are_better"}) {}

  void run(const BodyPlan& plan);
  void run(const WayFile& file);
  int finish();

 private:
  struct Scene {  // a body, ready
    const Body& body;
    const Ground& ground;
    const TrueBody& truth;
    const Contenders& contenders;
  };
  [[nodiscard]] bool is_wanted(const WayPlan& way) const;
  [[nodiscard]] Contenders entrants_of(const Ground& ground, const Body& body) const;
  void run_way(const Scene& scene, const WayPlan& plan);
  void run_along(const Scene& scene, const WayPlan& plan, WayFile along);
  // Its row; returns the god-object's error.
  double run_contender(const Scene& scene, const WayPlan& plan, const WayFile& along, const std::vector<TrueBody::Tick>& truth,
                       Contender& contender, const Timing& timing);
  void rank_body(const Body& body, std::vector<Standing> standings, double resolution);

  Options options_;
  Stopwatch watch_;
  Bars bars_;
  Table table_, pareto_, verdict_;
  OwnFaults faults_;
  double truth_off_m_ = 0;  // from what way files say
};

bool Evaluation::is_wanted(const WayPlan& way) const {
  return options_.ways.empty() ||
         std::find(options_.ways.begin(), options_.ways.end(), name_of(way.kind)) != options_.ways.end();
}

Contenders Evaluation::entrants_of(const Ground& ground, const Body& body) const {
  Contenders list = contenders_for(ground, body, options_.is_quick);
  for (const std::vector<std::string>* rivals : {&kShippedRivals, &options_.rivals}) {
    for (const std::string& rival : *rivals)
      list.push_back(make_rival(rival, ground.soup()));
  }
  if (options_.contenders.empty()) return list;
  std::erase_if(list, [&](const auto& contender) {
    return std::find(options_.contenders.begin(), options_.contenders.end(), contender->info().name) ==
           options_.contenders.end();
  });
  if (list.size() < options_.contenders.size()) {
    throw std::runtime_error("on " + body.name +
                             " not every contender of --contender takes part; contenders.csv of a run has the names");
  }
  return list;
}

void Evaluation::run(const BodyPlan& plan) {
  const Body body = body_named(plan.body);
  const Ground ground(body.make());
  const TrueBody truth(ground);
  const Contenders contenders = entrants_of(ground, body);
  for (const WayPlan& way : plan.ways) {
    if (is_wanted(way)) run_way({body, ground, truth, contenders}, way);
  }
}

void Evaluation::run(const WayFile& file) {
  const std::string& path = file.mesh.empty() ? options_.mesh : file.mesh;
  if (path.empty()) throw std::runtime_error("a way of plain columns needs --mesh");
  auto soup = fdcg::bake::import_mesh(path);
  if (!soup) throw std::runtime_error(soup.error().message);
  Body body;
  body.name = file.body.empty() ? std::filesystem::path(path).stem().string() : file.body;
  body.faces = static_cast<std::uint32_t>(soup->face_count());
  body.is_closed = is_closed(*soup);
  const Ground ground(std::move(*soup));
  const TrueBody truth(ground);
  const Contenders contenders = entrants_of(ground, body);
  WayPlan plan;
  plan.rate_hz = file.rate_hz;
  plan.mu_static = file.mu_static;
  plan.mu_dynamic = file.mu_dynamic;
  run_along({body, ground, truth, contenders}, plan, file);
}

void Evaluation::run_way(const Scene& scene, const WayPlan& plan) {
  WayOptions options;
  options.kind = plan.kind;
  options.rate_hz = plan.rate_hz;
  options.ticks = options_.ticks > 0 ? options_.ticks : std::min(options_.is_quick ? 4000u : 10'000u, plan.most_ticks);
  options.seed = options_.seed;
  options.hold_ticks = 20;  // of teleports: time to arrive
  WayFile along;
  along.way = name_of(plan.kind);
  along.seed = options_.seed;
  along.hips = make_way(scene.ground, options);
  run_along(scene, plan, std::move(along));
}

void Evaluation::run_along(const Scene& scene, const WayPlan& plan, WayFile along) {
  along.body = scene.body.name;
  along.rate_hz = plan.rate_hz;
  along.mu_static = plan.mu_static;
  along.mu_dynamic = plan.mu_dynamic;
  const std::vector<TrueBody::Tick> truth = scene.truth.follow(along.hips, {plan.mu_static, plan.mu_dynamic, true});
  along.reference = scene.truth.reference(along.hips, truth);
  using namespace plain;
  for (std::size_t i = 0; i < along.true_god_objects.size(); ++i)
    truth_off_m_ = std::max(truth_off_m_, length(along.true_god_objects[i] - truth[i].feel.god_object));
  if (!options_.export_folder.empty()) write_way(options_.export_folder, along, truth, scene.ground.soup());
  std::vector<Contender*> entrants;
  for (const auto& contender : scene.contenders) {
    contender->set_friction(plan.mu_static, plan.mu_dynamic);
    if (plan.mu_static == 0 || contender->info().has_friction) entrants.push_back(contender.get());
  }
  const std::size_t judged = entrants.size();
  Contenders controls;
  if (plan.counts) {
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      controls.push_back(make_fdcg(scene.ground.soup(), {precision, true, true}));
      entrants.push_back(controls.back().get());
    }
  }
  // more rounds where a bar is set: f64 and f32 are a hundredth apart
  const double budget_s = !options_.judges_times ? 0.05 : (options_.is_quick ? 0.3 : 0.4) * (plan.counts ? 4 : 1);
  const std::vector<Timing> timings = time_all(entrants, along.hips, watch_, budget_s);
  std::printf("%s, %s at %g Hz, mu %g/%g\n", scene.body.name.c_str(), along.way.c_str(), plan.rate_hz, plan.mu_static,
              plan.mu_dynamic);
  std::vector<Standing> standings;
  for (std::size_t e = 0; e < judged; ++e) {
    const double error_rms_m = run_contender(scene, plan, along, truth, *entrants[e], timings[e]);
    const ContenderInfo& info = entrants[e]->info();
    standings.push_back({info.name, info.family, timings[e].mean_ns(), error_rms_m,
                         static_cast<double>(info.bytes) / scene.body.faces, info.bake_s, false, ""});
  }
  if (plan.counts) rank_body(scene.body, std::move(standings), resolution_of(entrants, timings));
  std::fflush(stdout);
}

double Evaluation::run_contender(const Scene& scene, const WayPlan& plan, const WayFile& along,
                                 const std::vector<TrueBody::Tick>& truth, Contender& contender, const Timing& timing) {
  const ContenderInfo& info = contender.info();
  const Way& way = along.hips;
  const std::vector<Feel> felt = feel_along(contender, way);
  for (std::size_t i = 0; i < way.size(); ++i)
    check_answer(info, way[i], felt[i]);
  if (!options_.export_folder.empty()) write_answers(options_.export_folder, along, info.name, felt);
  const Metrics m = judge(way, plan.rate_hz, felt, truth, scene.truth);
  const LoopEnergy energy = energy_of_loop(contender, way);
  const double creep = creep_m(contender, way, truth);
  std::vector<float> in_free, in_contact;
  for (std::size_t i = 0; i < way.size(); ++i)
    (truth[i].feel.in_contact ? in_contact : in_free).push_back(timing.tick_ns[i]);
  const Percentiles ticks(timing.tick_ns), free(std::move(in_free)), contact(std::move(in_contact));
  const double bytes_per_face = static_cast<double>(info.bytes) / scene.body.faces;
  table_.row(scene.body.name, name_of(scene.body.group), scene.body.faces, along.way, plan.rate_hz, plan.mu_static,
             plan.mu_dynamic, info.name, info.family, info.precision, info.planes, info.merged, m.ticks, m.contact_ticks,
             timing.rounds, timing.mean_ns(), timing.batch_ns, ticks.at(0.5), ticks.at(0.99), ticks.at(0.999), ticks.at(1),
             free.at(0.5), contact.at(0.5), m.transitions, m.carried_ticks, bytes_per_face, info.bake_s, m.tied_share,
             m.untied_rms_m, m.god_object_rms_m, m.god_object_p50_m, m.god_object_p99_m, m.god_object_max_m, m.force_rms_n,
             m.force_max_n, m.force_share_p99, m.noticeable_share, m.direction_p99_deg, m.direction_max_deg, m.jump_n_per_ms,
             m.true_jump_n_per_ms, m.wrong_feature_share, m.push_throughs, m.push_through_share, m.phantom_share, creep,
             energy.work_j, energy.bound_j, along.reference);
  std::printf("  %-26s %6.0f ns (p99 %6.0f)  error rms %8.2g m, max %8.2g m  off the feature %5.1f %%  pushed through %llu\n",
              info.name.c_str(), timing.mean_ns(), ticks.at(0.99), m.god_object_rms_m, m.god_object_max_m,
              100 * m.wrong_feature_share, static_cast<unsigned long long>(m.push_throughs));
  if (info.family == "fdcg") {
    faults_.add(info.name + " on " + scene.body.name + ", " + along.way, m, creep, energy);
  }
  return m.god_object_rms_m;
}

void Evaluation::rank_body(const Body& body, std::vector<Standing> standings, double resolution) {
  constexpr double kFloor_m = kBody_m * 0x1p-53;  // a unit in the last place of the body: less is no error
  rank(standings, resolution, kFloor_m);
  int on_frontier[2] = {0, 0};
  double best_ns[2] = {1e300, 1e300};
  std::string beaten[2];
  for (const Standing& s : standings) {
    pareto_.row(body.name, name_of(body.group), body.faces, s.name, s.family, s.time_ns, s.error_m, s.bytes_per_face, s.bake_s,
                s.is_on_frontier ? "yes" : "no", s.beaten_by, resolution);
    if (s.family != "fdcg") continue;
    const std::size_t which = s.name.find("f32") != std::string::npos;
    on_frontier[which] += s.is_on_frontier;
    best_ns[which] = std::min(best_ns[which], s.time_ns);
    if (!s.is_on_frontier) beaten[which] += ", " + s.name + " by " + s.beaten_by;
  }
  const double ratio = best_ns[1] / best_ns[0];
  const std::string others = where_others_win(standings, "fdcg");
  verdict_.row(body.name, body.faces, on_frontier[0], on_frontier[1], ratio, resolution, others);
  std::printf("  where others are better: %s\n", others.empty() ? "nowhere" : others.c_str());
  if (!options_.judges_times) return;
  for (const std::size_t which : {0, 1}) {
    char note[160];
    std::snprintf(note, sizeof note, "f32 takes %.3f of f64's time, told apart from %.1f %%", ratio, 100 * resolution);
    bars_.at_least((which == 0 ? "f64 variants on the frontier, " : "f32 variants on the frontier, ") + body.name,
                   on_frontier[which], 1, "variants",
                   on_frontier[which] > 0 ? note : std::string(note).append("; beaten: ").append(beaten[which], 2));
  }
}

int Evaluation::finish() {
  bars_.at_most("own push-throughs", static_cast<double>(faults_.push_throughs), 0, "times", faults_.push_through_at);
  bars_.at_most("own creep at rest", faults_.creep_m, 0, "m", faults_.creep_at);
  bars_.at_most("own work beyond the zero-order hold's", faults_.energy_excess_j, 0, "J", faults_.energy_at);
  if (!options_.way_files.empty()) bars_.at_most("truth beside the way files'", truth_off_m_, kBody_m * 0x1p-53, "m");
  return bars_.failures() == 0 ? 0 : 1;
}

std::vector<BodyPlan> plan_with(const Options& options) {
  if (!options.way_files.empty()) return {};
  const std::vector<BodyPlan> plan = plan_of(options.is_quick);
  if (options.bodies.empty()) return plan;
  std::vector<BodyPlan> chosen;
  for (const std::string& name : options.bodies) {
    const auto planned = std::find_if(plan.begin(), plan.end(), [&](const BodyPlan& p) { return p.body == name; });
    chosen.push_back(planned != plan.end() ? *planned : BodyPlan{name, ways_of_other(body_named(name))});
  }
  return chosen;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  ProgramOptions program(
      "Run time against error: this runtime and other ways to find a god-object, along the same ways.\n"
      "Example: fdcg_bench_contenders --body star_10k --way hand --output bench");
  program.flag("--quick", options.is_quick, "small bodies, few ways: some 10 s in place of 3 minutes");
  program.flag("!--no-time-bars", options.judges_times, "measure times briefly and do not judge them: for busy machines");
  program.option("--output", options.output, "folder for contenders.csv, pareto.csv, pareto_verdict.csv and the bars");
  program.option("--seed", options.seed, "of the ways");
  program.option("--body", options.bodies, "only these; any of bodies.hpp, up to 10 million faces (some 12 GB)");
  program.option("--way", options.ways, "only these of the plan's ways");
  program.option("--ticks", options.ticks, "of each way; default 10,000, quick 4,000", 100, 1e6);
  program.option("--rival", options.rivals, "shared object or pipe:COMMAND that takes part too (docs/rivals.md)");
  program.option("--contender", options.contenders, "only these, by their names in contenders.csv");
  program.option("--export", options.export_folder, "folder for meshes, ways with their truth, and every contender's answers");
  program.option("--way-file", options.way_files, "ways in place of the plan's, in the format of --export or plain columns");
  program.option("--mesh", options.mesh, "of way files that are plain columns");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    for (const std::string& name : options.bodies)
      (void)body_named(name);
    for (const std::string& name : options.ways)
      (void)way_named(name);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  try {
    Evaluation evaluation(options);
    for (const std::string& path : options.way_files)
      evaluation.run(read_way(path));
    for (const BodyPlan& body : plan_with(options))
      evaluation.run(body);
    return evaluation.finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
}
