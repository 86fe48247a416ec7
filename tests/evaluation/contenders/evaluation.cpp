// SPDX-License-Identifier: Apache-2.0
#include "evaluation.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "contender_row.hpp"
#include "point.hpp"
#include "raw_data.hpp"
#include "rival.hpp"

namespace fdcg::test {

using bake::Precision;

namespace {

// Closest points err as Embree's and CGAL's do, and these take longer: they are measured for the frontier alone.
bool answers_as_another(const ContenderInfo& info) {
  return info.name == "fcl_closest" || info.name == "bullet_closest";
}

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

// What the same graph made twice differs by in time: that much tells nothing. Never finer than half a per cent, never blinder
// than three, whatever the machine does.
double resolution_of(const std::vector<Contender*>& entrants, const std::vector<double>& ns) {
  constexpr double kFinest = 0.005, kCoarsest = 0.03;
  double seen = kFinest;
  for (std::size_t a = 0; a < entrants.size(); ++a) {
    for (std::size_t b = a + 1; b < entrants.size(); ++b) {
      if (entrants[a]->info().name == entrants[b]->info().name) seen = std::max(seen, std::abs(ns[b] / ns[a] - 1));
    }
  }
  return std::min(seen, kCoarsest);
}

constexpr const char* kOurs = "fdcg";  // the family
bool is_f32(const Standing& standing) {
  return standing.name.find("f32") != std::string::npos;
}

// So many ticks of true contact, evenly.
std::vector<std::uint32_t> ticks_in_contact(const std::vector<TrueBody::Tick>& truth, std::size_t wanted) {
  std::vector<std::uint32_t> contact, chosen;
  for (std::uint32_t i = 0; i < truth.size(); ++i) {
    if (truth[i].feel.in_contact) contact.push_back(i);
  }
  const std::size_t count = std::min(wanted, contact.size());
  for (std::size_t k = 0; k < count; ++k)  // of each part its middle: the first of all is a first touch, which is rare
    chosen.push_back(contact[(2 * k + 1) * contact.size() / (2 * count)]);
  return chosen;
}

// An open-loop way knows no force: where it leaves the god-object behind, round a corner say, it is not a hand's.
constexpr double kDeepest_m = 0.01;
constexpr std::uint32_t kMostTried = 20;  // seeds, for each that is wanted
double deepest_m(const Way& hips, const std::vector<TrueBody::Tick>& truth) {
  using namespace plain;
  double deepest = 0;
  for (std::size_t i = 0; i < hips.size(); ++i)
    deepest = std::max(deepest, length(truth[i].feel.god_object - hips[i]));
  return deepest;
}

template <class Values>
double sum_of(const Values& values) {
  double sum = 0;
  for (const auto value : values)
    sum += static_cast<double>(value);
  return sum;
}

}  // namespace

Evaluation::Evaluation(const EvaluationOptions& options)
    : options_(options),
      bars_(options.output, "fdcg_bench_contenders"),
      table_(options.output, "contenders", contender_columns()),
      pareto_(options.output, "pareto",
              {"body", "group", "faces", "contender", "family", "mean_ns", "cold_mean_ns", "god_object_rms_m", "bytes_per_face",
               "bake_s", "on_frontier", "beaten_by", "resolution", "seeds", "ticks"}),
      verdict_(options.output, "pareto_verdict",
               {"body", "faces", "f64_on_frontier", "f32_on_frontier", "f32_over_f64_time", "resolution",
                "where_others_are_better"}) {
  Table clock(options.output, "clock", {"cost_ns", "empty_step_ns", "swept_bytes"});
  clock.row(watch_.cost_ns(), empty_step_ns(watch_), swept_bytes());
  if (std::filesystem::exists(std::filesystem::path(options.output) / "raw"))  // of a run before
    std::filesystem::remove_all(std::filesystem::path(options.output) / "raw");
}

void Evaluation::OwnFaults::add(const std::string& where, const Metrics& m, double creep, const LoopEnergy& energy) {
  push_throughs += m.push_throughs;
  if (m.push_throughs > 0) push_through_at = where;
  astray += m.astray_ticks;
  if (m.astray_ticks > 0) astray_at = where;
  if (creep > creep_m) creep_m = creep, creep_at = where;
  const double excess = energy.work_j - energy.bound_j;
  if (excess > energy_excess_j) energy_excess_j = excess, energy_at = where;
}

void Evaluation::Measured::add(const Measured& other) {
  if (ns.empty()) {
    *this = other;
    return;
  }
  ticks += other.ticks;
  cold_ticks += other.cold_ticks;
  for (std::size_t e = 0; e < ns.size(); ++e)
    ns[e] += other.ns[e], cold_ns[e] += other.cold_ns[e];
  for (std::size_t e = 0; e < square_m2.size(); ++e)
    square_m2[e] += other.square_m2[e];
}

bool Evaluation::is_wanted(const WayPlan& way) const {
  return options_.ways.empty() ||
         std::find(options_.ways.begin(), options_.ways.end(), name_of(way.kind)) != options_.ways.end();
}

Contenders Evaluation::entrants_of(const Ground& ground, const Body& body) const {
  Contenders list = all_contenders_for(ground, body, options_.is_quick, options_.rivals);
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
  run(body, body.make(), plan.ways);
}

bool Evaluation::run_mesh(const std::string& path) {
  const auto passed_over = [&](const std::string& why) {
    std::printf("passed over: %s%s\n", why.starts_with(path) ? "" : (path + ": ").c_str(), why.c_str());
    std::fflush(stdout);
    return false;
  };
  auto soup = fdcg::bake::import_mesh(path);
  if (!soup) return passed_over(soup.error().message);
  Body body;
  for (const char c : std::filesystem::path(path).stem().string())
    body.name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  const auto compiled = fdcg::bake::compile(*soup, {});
  if (!compiled || compiled->bytes.empty()) return passed_over("does not compile: fdcg validate says why");
  if (compiled->split_faces > 0) return passed_over("has faces that are not flat and convex: cut them into triangles first");
  fdcg::bake::RepairOptions once = fdcg::bake::repair_options(fdcg::bake::RepairLevel::safe);  // equal vertices are one
  once.judges = false;
  const auto welded = fdcg::bake::repair(*soup, once);
  if (!welded) return passed_over(welded.error().message);
  fdcg::bake::PolygonSoup scaled = scaled_to_body(welded->soup);
  scaled.name = body.name;
  body.faces = static_cast<std::uint32_t>(scaled.face_count());
  body.is_closed = is_closed(scaled);
  try {
    run(body, std::move(scaled), ways_of_brought());
  } catch (const std::runtime_error& error) {  // a contender that refuses it, or no way of a hand on it
    return passed_over(error.what());
  }
  return true;
}

void Evaluation::run(const Body& body, fdcg::bake::PolygonSoup soup, const std::vector<WayPlan>& ways) {
  const Ground ground(std::move(soup));
  const TrueBody truth(ground);
  const Contenders contenders = entrants_of(ground, body);
  for (const WayPlan& way : ways) {
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
  const Scene scene{body, ground, truth, contenders};
  run_along(scene, plan, enter(scene, plan), file, truth.follow(file.hips, {plan.mu_static, plan.mu_dynamic, true}));
}

Evaluation::Entrants Evaluation::enter(const Scene& scene, const WayPlan& plan) const {
  Entrants entrants;
  for (const auto& contender : scene.contenders) {
    contender->set_friction(plan.mu_static, plan.mu_dynamic);
    if (plan.mu_static > 0 && !contender->info().has_friction) continue;
    const bool is_asked_for = plan.counts || !options_.contenders.empty() || !options_.way_files.empty();
    if (is_asked_for || !answers_as_another(contender->info())) entrants.all.push_back(contender.get());
  }
  entrants.judged = entrants.all.size();
  if (!plan.counts) return entrants;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    entrants.controls.push_back(make_fdcg(scene.ground.soup(), {precision, true, true}));
    entrants.all.push_back(entrants.controls.back().get());
  }
  return entrants;
}

void Evaluation::run_way(const Scene& scene, const WayPlan& plan) {
  const Entrants entrants = enter(scene, plan);
  const WayMeasure measure = measure_of(plan, options_.is_quick);
  const std::uint32_t seeds = plan.counts && options_.seeds > 0 ? options_.seeds : measure.ways;
  Measured measured;
  std::uint32_t found = 0;
  for (std::uint32_t k = 0; found < seeds && k < kMostTried * seeds; ++k) {
    WayOptions options;
    options.kind = plan.kind;
    options.rate_hz = plan.rate_hz;
    options.ticks = options_.ticks > 0 ? options_.ticks : measure.ticks;
    options.seed = options_.seed + k;
    options.hold_ticks = 20;  // of teleports: time to arrive
    WayFile along;
    along.way = name_of(plan.kind);
    along.seed = options.seed;
    along.hips = make_way(scene.ground, options);
    const std::vector<TrueBody::Tick> truth = scene.truth.follow(along.hips, {plan.mu_static, plan.mu_dynamic, true});
    if (plan.counts && deepest_m(along.hips, truth) > kDeepest_m) {
      std::printf("%s, %s, seed %llu: passed over, no hand presses through %g mm\n", scene.body.name.c_str(), along.way.c_str(),
                  static_cast<unsigned long long>(options.seed), kDeepest_m * 1000);
      continue;
    }
    measured.add(run_along(scene, plan, entrants, std::move(along), truth));
    ++found;
  }
  if (found < seeds) throw std::runtime_error("too few seeds give a hand's way on " + scene.body.name);
  if (plan.counts) rank_body(scene, entrants, measured, seeds);
}

Evaluation::Measured Evaluation::run_along(const Scene& scene, const WayPlan& plan, const Entrants& entrants, WayFile along,
                                           const std::vector<TrueBody::Tick>& truth) {
  using namespace plain;
  along.body = scene.body.name;
  along.rate_hz = plan.rate_hz;
  along.mu_static = plan.mu_static;
  along.mu_dynamic = plan.mu_dynamic;
  along.reference = scene.truth.reference(along.hips, truth);
  for (std::size_t i = 0; i < along.true_god_objects.size(); ++i)
    truth_off_m_ = std::max(truth_off_m_, length(along.true_god_objects[i] - truth[i].feel.god_object));
  if (!options_.export_folder.empty()) write_way(options_.export_folder, along, truth, scene.ground.soup());
  const WayMeasure measure = measure_of(plan, options_.is_quick);
  TimingPlan timing;
  timing.budget_s = options_.judges_times ? measure.budget_s : 0.05;
  timing.cold_ticks =
      ticks_in_contact(truth, options_.judges_times ? measure.cold_ticks : std::min<std::size_t>(measure.cold_ticks, 2));
  const std::vector<Timing> timings = time_all(entrants.all, along.hips, watch_, timing);
  std::printf("%s, %s at %g Hz, mu %g/%g, seed %llu\n", scene.body.name.c_str(), along.way.c_str(), plan.rate_hz,
              plan.mu_static, plan.mu_dynamic, static_cast<unsigned long long>(along.seed));
  Measured measured;
  measured.ticks = static_cast<double>(truth.size());
  measured.cold_ticks = static_cast<double>(timing.cold_ticks.size());
  std::vector<RawContender> raw;
  for (std::size_t e = 0; e < entrants.all.size(); ++e) {
    const ContenderInfo& info = entrants.all[e]->info();
    measured.ns.push_back(sum_of(timings[e].tick_ns));
    measured.cold_ns.push_back(sum_of(timings[e].cold_ns));
    raw.push_back({info.name, info.family, e >= entrants.judged, {}});
    if (raw.back().is_control) continue;
    raw.back().error_m = run_contender(scene, plan, along, truth, *entrants.all[e], timings[e]);
    double square_m2 = 0;
    for (const float error_m : raw.back().error_m)
      square_m2 += static_cast<double>(error_m) * static_cast<double>(error_m);
    measured.square_m2.push_back(square_m2);
  }
  if (plan.counts)
    write_raw(options_.output, {scene.body.name, along.way, scene.body.faces, along.seed}, truth, timing.cold_ticks, raw,
              timings);
  std::fflush(stdout);
  return measured;
}

std::vector<float> Evaluation::run_contender(const Scene& scene, const WayPlan& plan, const WayFile& along,
                                             const std::vector<TrueBody::Tick>& truth, Contender& contender,
                                             const Timing& timing) {
  using namespace plain;
  const ContenderInfo& info = contender.info();
  const bool is_double = info.precision == "f64";
  const Way& way = along.hips;
  const std::vector<Feel> felt = feel_along(contender, way);
  std::vector<float> error_m;
  for (std::size_t i = 0; i < way.size(); ++i) {
    check_answer(info, way[i], felt[i]);
    error_m.push_back(static_cast<float>(error_of(felt[i], truth[i], is_double)));
  }
  if (!options_.export_folder.empty()) write_answers(options_.export_folder, along, info.name, info.precision, felt);
  ContenderRow row{scene.body,
                   along,
                   info,
                   timing,
                   judge(way, plan.rate_hz, felt, truth, scene.truth, {plan.mu_static, plan.mu_dynamic, true}, is_double),
                   0,
                   {},
                   0};
  row.energy = energy_of_loop(contender, way);
  row.creep_m = creep_m(contender, way, truth);
  if (along.seed == options_.seed)
    row.contact_instructions = contact_instructions(contender, way, ticks_in_contact(truth, truth.size()));
  table_.write(cells_of(row, truth));
  if (row.metrics.unjudged_share > unjudged_share_) {
    unjudged_share_ = row.metrics.unjudged_share;
    unjudged_at_ = info.name + " on " + scene.body.name + ", " + along.way;
  }
  if (info.family == kOurs) {
    const std::string where = info.name + " on " + scene.body.name + ", " + along.way;
    faults_.add(where, row.metrics, row.creep_m, row.energy);
    const double tied = row.metrics.tied_share - row.metrics.equal_share;
    if (along.way != name_of(WayKind::corner_dive) && tied > faults_.tied_share)
      faults_.tied_share = tied, faults_.tied_at = where;
  }
  return error_m;
}

void Evaluation::rank_body(const Scene& scene, const Entrants& entrants, const Measured& measured, std::uint32_t seeds) {
  const Body& body = scene.body;
  const double resolution = resolution_of(entrants.all, measured.ns);
  std::vector<Standing> standings;
  for (std::size_t e = 0; e < entrants.judged; ++e) {
    const ContenderInfo& info = entrants.all[e]->info();
    Standing standing{info.name,
                      info.family,
                      measured.ns[e] / measured.ticks,
                      std::sqrt(measured.square_m2[e] / measured.ticks),
                      static_cast<double>(info.bytes) / body.faces,
                      info.bake_s,
                      false,
                      ""};
    standing.cold_ns = measured.cold_ns[e] / measured.cold_ticks;
    standings.push_back(std::move(standing));
  }
  constexpr double kFloor_m = kBody_m * 0x1p-53;  // a unit in the last place of the body: less is no error
  rank(standings, resolution, kFloor_m);
  int on_frontier[2] = {0, 0};  // of f64 and f32
  double best_ns[2] = {1e300, 1e300};
  for (const Standing& s : standings) {
    pareto_.row(body.name, name_of(body.group), body.faces, s.name, s.family, s.time_ns, s.cold_ns, s.error_m, s.bytes_per_face,
                s.bake_s, s.is_on_frontier ? "yes" : "no", s.beaten_by, resolution, seeds, measured.ticks);
    if (s.family != kOurs) continue;
    on_frontier[is_f32(s)] += s.is_on_frontier;
    best_ns[is_f32(s)] = std::min(best_ns[is_f32(s)], s.time_ns);
  }
  const bool has_both = best_ns[0] < 1e300 && best_ns[1] < 1e300;  // there may be none of one (--contender)
  const double ratio = has_both ? best_ns[1] / best_ns[0] : std::numeric_limits<double>::quiet_NaN();
  const std::string others = where_others_win(standings, kOurs);
  verdict_.row(body.name, body.faces, on_frontier[0], on_frontier[1], ratio, resolution, others);
  std::printf("  where others are better: %s\n", others.empty() ? "nowhere" : others.c_str());
  if (!options_.judges_times) return;
  for (const bool is_f32_judged : {false, true}) {
    std::vector<Standing> rivals;  // and ours of one precision: what f64 takes is no bar for f32
    for (const Standing& s : standings) {
      if (s.family != kOurs || is_f32(s) == is_f32_judged) rivals.push_back(s);
    }
    rank(rivals, resolution, kFloor_m);
    int variants = 0, unbeaten = 0;
    std::string beaten;
    for (const Standing& s : rivals) {
      if (s.family != kOurs) continue;
      ++variants;
      unbeaten += s.is_on_frontier;
      if (!s.is_on_frontier) beaten += ", " + s.name + " by " + s.beaten_by;
    }
    if (variants == 0) continue;
    char note[160];
    std::snprintf(note, sizeof note, "f32 takes %.3f of f64's time, told apart from %.1f %%", ratio, 100 * resolution);
    bars_.at_least(
        (is_f32_judged ? "f32 variants that no other method beats, " : "f64 variants that no other method beats, ") + body.name,
        unbeaten, 1, "variants", unbeaten > 0 ? note : std::string(note).append("; beaten: ").append(beaten, 2));
  }
}

int Evaluation::finish() {
  bars_.at_most("own push-throughs", static_cast<double>(faults_.push_throughs), 0, "times", faults_.push_through_at);
  bars_.at_most("own carried ticks beside the way to where they go", static_cast<double>(faults_.astray), 0, "ticks",
                faults_.astray_at);
  bars_.at_most("own creep at rest", faults_.creep_m, 0, "m", faults_.creep_at);
  bars_.at_most("own work beyond the zero-order hold's", faults_.energy_excess_j, 0, "J", faults_.energy_at);
  bars_.at_most("own contact ticks at a tie, largest share of ways that are not aimed at corners", faults_.tied_share, 0.01,
                "of a way's", faults_.tied_at);
  bars_.at_most("contact ticks that are not judged, largest share", unjudged_share_, 0.01, "of a way's", unjudged_at_);
  if (!options_.way_files.empty()) bars_.at_most("truth beside the way files'", truth_off_m_, kBody_m * 0x1p-53, "m");
  return bars_.failures() == 0 ? 0 : 1;
}

}  // namespace fdcg::test
