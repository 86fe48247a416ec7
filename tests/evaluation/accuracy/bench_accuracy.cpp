// SPDX-License-Identifier: Apache-2.0
// How far the god-object is from the exact one: the runtime beside rational arithmetic and beside its rules in wider numbers,
// over bodies, ways, friction, precisions and ways of storing a graph. Errors in ulps of the extent, f32 in its own.
// Over 400 lines: plan, search, tables and bars of one program, read from top to bottom.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "accuracy_run.hpp"
#include "adversary.hpp"
#include "bodies.hpp"
#include "ground.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "program_options.hpp"
#include "table.hpp"
#include "ways.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

constexpr double kMu[4][2] = {{0, 0}, {0.3, 0.2}, {1, 1}, {2, 1}};
constexpr double kOffsets_sizes[] = {1e3, 1e6};
constexpr double kP999Bar_ulps = 8, kMaxBar_ulps = 64;  // the project's own
constexpr double kMostAtRim = 0.01;                     // of a body's and way's contact ticks: exempt from the bar of 8 ulps
constexpr unsigned kWaysOfAKind = 16;                   // one for each combination of friction, planes and merging
constexpr std::uint32_t kMostFaces = 1500;              // of bodies from bodies.hpp: the replay tests every face of a sweep

constexpr const char* kRestless = "restless";  // the way of hip_walk.hpp

struct Options {
  bool is_quick = false, explains = false, stops_at_first = false;
  std::string output = "accuracy";
  std::uint64_t seed = 1;
  unsigned threads = 2;
  std::string body, way;  // only these; empty: all
};

// Everything that is to be run. Holds the soups and ways that the settings point to.
struct Plan {
  std::vector<std::unique_ptr<PolygonSoup>> soups;
  std::vector<std::unique_ptr<std::vector<Hip>>> ways;
  std::vector<AccuracySetting> settings;
};

std::vector<PolygonSoup> walked_bodies() {
  const Rotation tilt = random_rotation(20);
  const double right_angle = 1.5707963267948966;
  std::vector<PolygonSoup> soups = {cube(),
                                    transformed(triangulated(cube()), tilt),
                                    l_prism(),
                                    corner_pit(),
                                    transformed(triangulated(corner_pit()), tilt),
                                    v_groove(right_angle),
                                    v_groove(0.17),
                                    wedge(0.1),
                                    cone(12),
                                    cone(500),
                                    cone_pit(12),
                                    saddle_block(),
                                    prism(500),
                                    ico_sphere(2),
                                    uv_sphere(20, 10),
                                    star_sphere(2, 0.3, 1),
                                    spiky_sphere(2, 1, 1),
                                    torus(20, 10),
                                    thin_plate(1e-6),
                                    triangulated(thin_plate(1e-6, 3)),
                                    bumpy_patch(6, 0.2, 1),
                                    needle_strip(100, 0.1, 1),
                                    plane_grid(8, 8),
                                    rounded_to_float(transformed(triangulated(grid_box(3, 3, 3, {1, 1, 1})), tilt))};
  std::map<std::string, int> times;
  for (PolygonSoup& soup : soups) {
    const int n = ++times[soup.name];
    if (n > 1) soup.name += "-" + std::to_string(n);
  }
  return soups;
}

// Ticks of one run, by judge.
struct Ticks {
  std::uint64_t long_double, mpfr_256, certificate;
  unsigned every;  // of 32 combinations one in so many is run, others on the next body
};

// Both precisions, planes stored and derived, merged and not, four pairs of friction. The widest replay takes turns with planes
// and merging: it is a hundred times as slow.
void add_all(Plan& plan, const AccuracySetting& base, const Ticks& ticks, unsigned turn) {
  for (unsigned i = 0; i < 32; ++i) {
    if ((i * 5 + turn) / 4 % ticks.every != 0) continue;
    AccuracySetting s = base;
    s.precision = (i & 1) == 0 ? Precision::f64 : Precision::f32;
    s.mu_static = kMu[i >> 1 & 3][0];
    s.mu_dynamic = kMu[i >> 1 & 3][1];
    s.is_stored = (i >> 3 & 1) == 0;
    s.is_merged = (i >> 4 & 1) == 0;
    s.seed += i;
    const auto add = [&](Judge judge, std::uint64_t steps) {
      s.judge = judge;
      s.steps = steps;
      if (steps > 0) plan.settings.push_back(s);
    };
    add(Judge::long_double, ticks.long_double);
    if (i >> 3 == (i + turn) % 4) add(Judge::mpfr_256, ticks.mpfr_256);
    if (s.mu_static == 0) add(Judge::certificate, ticks.certificate);
  }
}

void add_offsets(Plan& plan, const AccuracySetting& base, const Ticks& ticks) {
  for (const double offset : kOffsets_sizes) {
    for (unsigned i = 0; i < 4; ++i) {
      AccuracySetting s = base;
      s.offset_sizes = offset;
      s.precision = (i & 1) == 0 ? Precision::f64 : Precision::f32;
      s.mu_static = kMu[i >> 1][0];
      s.mu_dynamic = kMu[i >> 1][1];
      s.steps = ticks.long_double;
      plan.settings.push_back(s);
      if (s.mu_static > 0) continue;
      s.judge = Judge::certificate;
      plan.settings.push_back(s);
    }
  }
}

bool is_wanted(const std::string& only, const std::string& name) {
  return only.empty() || only == name;
}

Plan make_plan(const Options& options) {
  const Ticks on_walks = options.is_quick ? Ticks{240, 24, 240, 4} : Ticks{1500, 120, 1500, 1};
  const Ticks on_ways = options.is_quick ? Ticks{200, 12, 200, 8} : Ticks{600, 40, 600, 1};
  Plan plan;
  unsigned turn = 0;
  AccuracySetting base;
  for (PolygonSoup& soup : walked_bodies()) {
    if (!is_wanted(options.body, soup.name) || !is_wanted(options.way, kRestless)) continue;
    plan.soups.push_back(std::make_unique<PolygonSoup>(std::move(soup)));
    base.soup = plan.soups.back().get();
    base.body = base.soup->name;
    base.way = kRestless;
    base.seed = options.seed * 1000 + turn * 50;
    add_all(plan, base, on_walks, turn++);
    add_offsets(plan, base, on_walks);
  }
  for (const Body& body : bodies(kMostFaces)) {
    if (!is_wanted(options.body, body.name)) continue;
    plan.soups.push_back(std::make_unique<PolygonSoup>(body.make()));
    base.soup = plan.soups.back().get();
    base.body = body.name;
    const Ground ground(*base.soup);
    for (const WayName& way : kWays) {
      if (!is_wanted(options.way, way.name)) continue;
      if (options.is_quick && (turn + static_cast<unsigned>(way.kind)) % 4 != 0) continue;
      WayOptions how;
      how.kind = way.kind;
      how.ticks = static_cast<std::uint32_t>(on_ways.long_double);
      const std::size_t first_way = plan.ways.size();
      for (unsigned k = 0; k < kWaysOfAKind; ++k) {
        how.seed = options.seed * 1000 + k;
        plan.ways.push_back(std::make_unique<std::vector<Hip>>(make_way(ground, how)));
      }
      const std::size_t first_setting = plan.settings.size();
      base.way = way.name;
      base.seed = 0;
      add_all(plan, base, on_ways, turn++);
      for (std::size_t i = first_setting; i < plan.settings.size(); ++i)
        plan.settings[i].hips = plan.ways[first_way + plan.settings[i].seed / 2].get();  // f64 and f32 go the same
    }
  }
  return plan;
}

// Calls work(i) for each i below `count`, on so many threads.
template <class Work>
void in_parallel(std::size_t count, unsigned threads, Work work) {
  std::vector<std::string> faults(count);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> pool;
  for (unsigned t = 0; t < threads; ++t) {
    pool.emplace_back([&] {
      for (std::size_t i; (i = next++) < count;) {
        try {
          work(i);
        } catch (const std::exception& fault) {
          faults[i] = fault.what();
        }
      }
    });
  }
  for (std::thread& thread : pool)
    thread.join();
  for (const std::string& fault : faults) {
    if (!fault.empty()) throw std::runtime_error(fault);
  }
}

const char* name_of(Precision precision) {
  return precision == Precision::f64 ? "f64" : "f32";
}

// What the bars call runs of one kind.
std::string kind_of(const std::string& precision, Judge judge, double offset_sizes) {
  return precision + " against " + name_of(judge) + (offset_sizes > 0 ? ", moved by " + cell(offset_sizes) + " sizes" : "");
}

// Where faces were merged that are flat only within the input's quantum, the file says how far corners are off the planes, and
// exactness ends there: such a run's errors are held against that. Where that is a matter of ulps, what they exceed it by is
// held to the bars of all runs.
bool has_deviation(const AccuracyOutcome& outcome) {
  return outcome.deviation_ulps > kMaxBar_ulps;
}

// With --first in their order, to the first that fails a bar by itself; the bars on shares of ticks are of all runs.
std::vector<AccuracyOutcome> run_all(const Plan& plan, const Options& options) {
  std::vector<AccuracyOutcome> outcomes(plan.settings.size());
  if (!options.stops_at_first) {
    in_parallel(outcomes.size(), options.threads, [&](std::size_t i) { outcomes[i] = run(plan.settings[i]); });
    return outcomes;
  }
  Bars bars(options.output, "bench_accuracy", true);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    outcomes[i] = run(s);
    const std::string kind = kind_of(name_of(s.precision), s.judge, s.offset_sizes), where = s.body + ", " + s.way;
    const std::uint64_t wrong = outcomes[i].wrong_features;
    if (wrong > 0) bars.at_most(kind + ", wrong features", static_cast<double>(wrong), 0, "ticks", where);
    const double largest = has_deviation(outcomes[i]) ? 0 : percentile(outcomes[i].one_step_ulps, 1);
    if (largest > kMaxBar_ulps) bars.at_most(kind + ", largest", largest, kMaxBar_ulps, "ulps", where);
  }
  return outcomes;
}

// ---- search ----------------------------------------------------------------------------------------------------------------

struct Search {
  const PolygonSoup* soup = nullptr;
  Precision precision = Precision::f64;
  AdversaryGoal goal = AdversaryGoal::error;
  AdversaryFind find;
  std::uint64_t ticks = 0, wrong = 0;
  double well_posed_ulps = 0;
  std::string first_wrong;
};

// Over the bodies of the restless walks, as they are, not merged.
std::vector<Search> search_all(const Plan& plan, const Options& options) {
  const int cases = options.is_quick ? 60 : 1500;
  std::vector<Search> searches;
  for (const auto& soup : plan.soups) {
    const auto setting = std::find_if(plan.settings.begin(), plan.settings.end(),
                                      [&](const AccuracySetting& s) { return s.soup == soup.get() && s.way == kRestless; });
    if (setting == plan.settings.end()) continue;
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      for (const auto goal : {AdversaryGoal::error, AdversaryGoal::backward_error, AdversaryGoal::transitions}) {
        searches.push_back({});
        searches.back().soup = soup.get();
        searches.back().precision = precision;
        searches.back().goal = goal;
      }
    }
  }
  in_parallel(searches.size(), options.threads, [&](std::size_t i) {
    Search& s = searches[i];
    const PlainGraph graph(*s.soup, s.precision);
    Adversary adversary(graph.view(), *s.soup, options.seed * 1000 + i);
    s.find = adversary.search(s.goal, cases);
    s.ticks = adversary.ticks;
    s.well_posed_ulps = adversary.well_posed_ulps;
    s.wrong = adversary.wrong;
    s.first_wrong = adversary.first_wrong;
  });
  return searches;
}

std::string said(const AdversaryCase& way) {
  std::string text;
  char number[40];
  for (const Hip& hip : way.hips) {
    for (const double c : hip) {
      std::snprintf(number, sizeof number, "%a ", c);
      text += number;
    }
  }
  return text;
}

void write_searches(const std::string& folder, const std::vector<Search>& searches) {
  Table table(folder, "god_object_search",
              {"body", "precision", "goal", "ticks", "error_ulps", "conditioning", "backward_ulps", "transitions", "mu_s",
               "mu_d", "wrong_features", "hips"});
  for (const Search& s : searches) {
    table.row(s.soup->name, name_of(s.precision), name_of(s.goal), s.ticks, s.find.ulps, s.find.conditioning,
              s.find.backward_ulps(), s.find.transitions, s.find.way.mu_static, s.find.way.mu_dynamic, s.wrong,
              said(s.find.way));
  }
}

// ---- tables ----------------------------------------------------------------------------------------------------------------

void write_errors(const std::string& folder, const Plan& plan, std::vector<AccuracyOutcome>& outcomes) {
  Table table(folder, "god_object_error",
              {"body",
               "precision",
               "planes",
               "merged",
               "way",
               "mu_s",
               "mu_d",
               "offset_sizes",
               "steps",
               "contact_steps",
               "p50_ulps",
               "p99_ulps",
               "p999_ulps",
               "max_ulps",
               "accumulated_p999_ulps",
               "accumulated_max_ulps",
               "wrong_features",
               "ties",
               "ties_explained",
               "ties_unexplained",
               "carried",
               "at_rim",
               "worst_conditioning",
               "max_deviation_ulps",
               "reference"});
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    AccuracyOutcome& o = outcomes[i];
    table.row(s.body, name_of(s.precision), s.is_stored ? "stored" : "derived", s.is_merged ? "yes" : "no", s.way, s.mu_static,
              s.mu_dynamic, s.offset_sizes, o.steps, o.contact_steps, percentile(o.one_step_ulps, 0.5),
              percentile(o.one_step_ulps, 0.99), percentile(o.one_step_ulps, 0.999), percentile(o.one_step_ulps, 1),
              percentile(o.accumulated_ulps, 0.999), percentile(o.accumulated_ulps, 1), o.wrong_features, o.ties,
              o.ties_explained, o.ties_unexplained, o.carried, o.at_rim_ulps.size(), o.worst_conditioning, o.deviation_ulps,
              name_of(s.judge));
  }
}

// Shares of errors between two powers of two: `from_ulps` to twice that; the first row of each kind holds all that is less.
// Faces that are flat only within the input's quantum are left out, here and below: they are not held to roundings.
void write_histogram(const std::string& folder, const Plan& plan, const std::vector<AccuracyOutcome>& outcomes) {
  constexpr int kLeast = -6, kMost = 16;  // powers of two
  std::map<std::tuple<std::string, std::string>, std::vector<std::uint64_t>> counts;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    if (has_deviation(outcomes[i])) continue;
    auto& bins = counts[{name_of(s.precision), name_of(s.judge)}];
    bins.resize(kMost - kLeast + 1);
    for (const auto* errors : {&outcomes[i].one_step_ulps, &outcomes[i].at_rim_ulps}) {
      for (const float ulps : *errors)
        ++bins[static_cast<std::size_t>(ulps > 0 ? std::clamp(std::ilogb(ulps), kLeast, kMost) - kLeast : 0)];
    }
  }
  Table table(folder, "god_object_error_histogram", {"precision", "reference", "from_ulps", "ticks"});
  for (const auto& [key, bins] : counts) {
    for (std::size_t k = 0; k < bins.size(); ++k)
      table.row(std::get<0>(key), std::get<1>(key), std::ldexp(1.0, static_cast<int>(k) + kLeast), bins[k]);
  }
}

// Ticks whose error is large: beside it, how much the exact answer itself moves for inputs half an ulp off.
void write_conditioning(const std::string& folder, const Plan& plan, const std::vector<AccuracyOutcome>& outcomes) {
  constexpr std::size_t kMostRows = 4000;
  Table table(folder, "god_object_conditioning", {"body", "precision", "way", "reference", "error_ulps", "conditioning"});
  std::size_t rows = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    if (has_deviation(outcomes[i])) continue;
    for (const auto& [error, conditioning] : outcomes[i].error_and_conditioning) {
      if (rows++ < kMostRows)
        table.row(s.body, name_of(s.precision), s.way, name_of(s.judge), static_cast<double>(error),
                  static_cast<double>(conditioning));
    }
  }
}

// ---- bars ------------------------------------------------------------------------------------------------------------------

// Runs of one precision, judge and offset on one body and way, taken together.
struct Group {
  std::vector<float> one_step, accumulated;
  std::uint64_t contact_steps = 0, at_rim = 0;
};
using GroupKey = std::tuple<std::string, std::string>;  // body, way

struct Total {
  std::uint64_t steps = 0, contact_steps = 0, ties = 0, unexplained = 0, wrong = 0;
  double worst_conditioning = 1, worst_share_of_deviation = 0;
  bool has_deviation = false;
  std::vector<float> all, all_along;
  std::map<GroupKey, Group> groups;
};

void append(std::vector<float>& to, const std::vector<float>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

struct Worst {
  double ulps = 0;
  std::string where = "nothing";
};

// Of the groups that have so many ticks that there is such a percentile, and of all that are too small taken together.
Worst worst_group(std::map<GroupKey, Group>& groups, double part, std::vector<float> Group::*of) {
  Worst worst;
  std::vector<float> rest;
  const auto consider = [&](std::vector<float>& values, const std::string& where) {
    const double ulps = percentile(values, part);
    if (ulps > worst.ulps) worst = {ulps, where};
  };
  for (auto& [key, group] : groups) {
    std::vector<float>& values = group.*of;
    if (part < 1 && static_cast<double>(values.size()) * (1 - part) < 1) {
      append(rest, values);
    } else {
      consider(values, std::get<0>(key) + ", " + std::get<1>(key));
    }
  }
  consider(rest, "short walks together");
  return worst;
}

// The largest share, as worst_group() groups them.
Worst most_at_rim(const std::map<GroupKey, Group>& groups) {
  Worst worst;
  std::uint64_t rest = 0, rest_at_rim = 0;
  const auto consider = [&](std::uint64_t at_rim, std::uint64_t of, const std::string& where) {
    const double share = static_cast<double>(at_rim) / static_cast<double>(std::max<std::uint64_t>(1, of));
    if (share > worst.ulps) worst = {share, where};
  };
  for (const auto& [key, group] : groups) {
    if (group.contact_steps < 1000) {
      rest += group.contact_steps;
      rest_at_rim += group.at_rim;
    } else {
      consider(group.at_rim, group.contact_steps, std::get<0>(key) + ", " + std::get<1>(key));
    }
  }
  consider(rest_at_rim, rest, "short walks together");
  return worst;
}

void judge(Bars& bars, const std::string& name, Total& total, bool has_accumulated) {
  const Worst p999 = worst_group(total.groups, 0.999, &Group::one_step), most = worst_group(total.groups, 1, &Group::one_step);
  bars.at_most(name + ", p99.9 of the worst body and way", p999.ulps, kP999Bar_ulps, "ulps", p999.where);
  bars.at_most(name + ", largest", most.ulps, kMaxBar_ulps, "ulps", most.where);
  bars.at_most(name + ", wrong features", static_cast<double>(total.wrong), 0, "ticks");
  if (total.has_deviation)
    bars.at_most(name + ", merged within the quantum, largest", total.worst_share_of_deviation, 1, "max_deviation");
  if (!has_accumulated) {
    const Worst rim = most_at_rim(total.groups);
    bars.at_most(name + ", off at a rim within FACE-5's rounding", rim.ulps, kMostAtRim, "of the contact ticks", rim.where);
    return;
  }
  const Worst most_along = worst_group(total.groups, 1, &Group::accumulated);
  bars.at_most(name + ", along the way, largest", most_along.ulps, kMaxBar_ulps, "ulps", most_along.where);
}

void explain(const Plan& plan, std::vector<AccuracyOutcome>& outcomes, const std::vector<Search>& searches) {
  for (const Search& s : searches) {
    if (s.find.ulps > kP999Bar_ulps)
      std::printf("%s, search for %s, %s: backward %g ulps\n  %s\n", s.soup->name.c_str(), name_of(s.goal),
                  name_of(s.precision), s.find.backward_ulps(), s.find.what.c_str());
  }
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    const bool is_large = percentile(outcomes[i].one_step_ulps, 1) > kP999Bar_ulps;
    if (!is_large && outcomes[i].first_unexplained.empty()) continue;
    std::printf("%s, %s, %s, planes %s, merged %s, offset %g, %s, deviation %g ulps\n  %s\n", s.body.c_str(), s.way.c_str(),
                name_of(s.precision), s.is_stored ? "stored" : "derived", s.is_merged ? "yes" : "no", s.offset_sizes,
                name_of(s.judge), outcomes[i].deviation_ulps, is_large ? outcomes[i].worst.c_str() : "");
    if (!outcomes[i].first_unexplained.empty()) std::printf("  unexplained tie: %s\n", outcomes[i].first_unexplained.c_str());
  }
}

void add(Total& total, const AccuracySetting& s, const AccuracyOutcome& o) {
  total.steps += o.steps;
  total.contact_steps += o.contact_steps;
  total.ties += o.ties;
  total.unexplained += o.ties_unexplained;
  total.wrong += o.wrong_features;
  total.worst_conditioning = std::max(total.worst_conditioning, o.worst_conditioning);
  append(total.all, o.one_step_ulps);
  append(total.all_along, o.accumulated_ulps);
  if (has_deviation(o)) {
    total.has_deviation = true;
    for (const float ulps : o.one_step_ulps)
      total.worst_share_of_deviation = std::max(total.worst_share_of_deviation, static_cast<double>(ulps) / o.deviation_ulps);
    return;
  }
  Group& group = total.groups[{s.body, s.way}];
  for (const float ulps : o.one_step_ulps)
    group.one_step.push_back(std::max(0.0F, ulps - static_cast<float>(o.deviation_ulps)));
  append(group.accumulated, o.accumulated_ulps);
  group.contact_steps += o.contact_steps;
  group.at_rim += o.at_rim_ulps.size();
}

// A search may find what the geometry magnifies without bound; the backward error then tells whether the step still is exact
// for inputs so near to the ones it got.
void judge_searches(Bars& bars, const std::vector<Search>& searches) {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const Search *worst = nullptr, *furthest = nullptr, *posed = nullptr;
    std::uint64_t wrong = 0;
    for (const Search& s : searches) {
      if (s.precision != precision) continue;
      wrong += s.wrong;
      if (worst == nullptr || s.find.backward_ulps() > worst->find.backward_ulps()) worst = &s;
      if (furthest == nullptr || s.find.ulps > furthest->find.ulps) furthest = &s;
      if (posed == nullptr || s.well_posed_ulps > posed->well_posed_ulps) posed = &s;
      if (!s.first_wrong.empty())
        std::printf("wrong: %s %s\n  %s\n", s.soup->name.c_str(), name_of(precision), s.first_wrong.c_str());
    }
    if (worst == nullptr) continue;
    const std::string name = std::string(name_of(precision)) + ", worst found by search";
    std::printf(
        "%s, of any conditioning: %.1f ulps, where half an ulp of the input moves the exact answer by %.1f half ulps; %s\n",
        name.c_str(), furthest->find.ulps, furthest->find.conditioning, furthest->soup->name.c_str());
    bars.at_most(name + ", error of a well-posed tick", posed->well_posed_ulps, kMaxBar_ulps, "ulps", posed->soup->name);
    bars.at_most(name + ", backward error", worst->find.backward_ulps(), kMaxBar_ulps, "ulps", worst->soup->name);
    bars.at_most(name + ", wrong features", static_cast<double>(wrong), 0, "ticks");
  }
}

int say_and_judge(const std::string& folder, const Plan& plan, const std::vector<AccuracyOutcome>& outcomes,
                  const std::vector<Search>& searches) {
  std::map<std::tuple<std::string, Judge, double>, Total> totals;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const AccuracySetting& s = plan.settings[i];
    const AccuracyOutcome& o = outcomes[i];
    add(totals[{name_of(s.precision), s.judge, s.offset_sizes}], s, o);
    if (!o.first_wrong.empty())
      std::printf("wrong: %s %s %s mu %g: %s\n", s.body.c_str(), s.way.c_str(), name_of(s.precision), s.mu_static,
                  o.first_wrong.c_str());
  }
  std::printf("god-object error in ulps of the extent\n%-4s %-20s %8s %9s %9s %6s %6s %6s %8s %9s %8s %6s %6s %6s %9s\n", "",
              "reference", "offset", "ticks", "contacts", "p50", "p99", "p99.9", "max", "along99.9", "max", "ties", "unexp.",
              "wrong", "condition");
  for (auto& [key, t] : totals) {
    std::printf("%-4s %-20s %8g %9llu %9llu %6.2f %6.2f %6.2f %8.3g %9.2f %8.3g %6llu %6llu %6llu %9.3g\n",
                std::get<0>(key).c_str(), name_of(std::get<1>(key)), std::get<2>(key), static_cast<unsigned long long>(t.steps),
                static_cast<unsigned long long>(t.contact_steps), percentile(t.all, 0.5), percentile(t.all, 0.99),
                percentile(t.all, 0.999), percentile(t.all, 1), percentile(t.all_along, 0.999), percentile(t.all_along, 1),
                static_cast<unsigned long long>(t.ties), static_cast<unsigned long long>(t.unexplained),
                static_cast<unsigned long long>(t.wrong), t.worst_conditioning);
  }
  Bars bars(folder, "bench_accuracy");
  for (auto& [key, total] : totals) {
    const auto& [precision, reference, offset] = key;
    judge(bars, kind_of(precision, reference, offset), total, reference != Judge::certificate);
  }
  judge_searches(bars, searches);
  return bars.failures();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  ProgramOptions program(
      "The god-object's error against exact rational arithmetic and against the same rules in wider numbers.\n"
      "Writes god_object_error.csv, god_object_error_histogram.csv, god_object_conditioning.csv, god_object_search.csv\n"
      "and bench_accuracy.bars.csv.\n"
      "Exit code 1: a bar failed.\n\nExample: fdcg_bench_accuracy --quick --output build/accuracy");
  program.flag("--quick", options.is_quick, "a few seconds instead of a few minutes");
  program.flag("--explain", options.explains,
               "say everything about ticks above the limit of p99.9, and about ties without an explanation");
  program.flag("--first", options.stops_at_first,
               "end at the first run that fails a bar by itself, with exit code 1; --threads is not used until then");
  program.option("--output", options.output, "folder for the tables");
  program.option("--seed", options.seed, "of the ways");
  program.option("--threads", options.threads, "the results do not depend on it", 1, 64);
  program.option("--body", options.body, "only this one, by its name in the tables");
  program.option("--way", options.way, "only this one");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    const Plan plan = make_plan(options);
    std::vector<AccuracyOutcome> outcomes = run_all(plan, options);
    write_errors(options.output, plan, outcomes);
    write_histogram(options.output, plan, outcomes);
    write_conditioning(options.output, plan, outcomes);
    const std::vector<Search> searches = search_all(plan, options);
    write_searches(options.output, searches);
    if (options.explains) explain(plan, outcomes, searches);
    return say_and_judge(options.output, plan, outcomes, searches) > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_accuracy: %s\n", error.what());
    return 2;
  }
}
