// SPDX-License-Identifier: Apache-2.0
// The contact step's bars: what a step costs on bodies of 12 to 10 million faces, along ways of a hand.
//
// Each tick is timed alone, twice over:
//   tick  as the path meets it: the data of new faces are not in the cache yet. The machine's other work is in it too.
//   own   the same tick again from a copy of the contact, the least of seven replays: the step's own work, everything in cache.
// `batch` is the whole path timed at once over its ticks: a mean without the clock in it, to check the others against.
// Bars: a way at a hand's speed, 45 ns and 180 ns a face crossed; a way that crosses as many faces a tick as on the small body
// (`times`), 1.3 times that body's; no step over 5 microseconds of own work. See README.md beside this file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench_graph.hpp"
#include "heap_count.hpp"
#include "stopwatch.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

constexpr double kDepth_m = 1e-3;
constexpr double kHandWay_m = 1e-4;  // a tick: 0.1 m/s at 1 kHz
constexpr double kWorstOwn_ns = 5000;
constexpr double kFlat = 1.3;  // a large body over a small one, at as many faces a tick

struct Options {
  int ticks = 100'000;
  int replays = 7;  // 0: each tick once, and no batch: for counting what a step does
  bool large = false, csv = false, quick = false;
  std::string body, way, precision, planes;  // empty: all
};

struct Measured {
  Percentiles tick{{}}, own{{}}, held{{}};  // held: ticks that begin and end in contact, as the path meets them
  double batch_ns = 0, transitions = 0, contact = 0;
  std::uint64_t heap_calls = 0, bounded = 0;
};

fdcg_contact first_contact(const fdcg_graph& graph, const fdcg_params& params, const Point& hip) {
  fdcg_contact contact = {};
  fdcg_result result;
  fdcg_step(&graph, &params, &contact, hip.data(), &result);
  return contact;
}

Measured measure(const fdcg_graph& graph, const Path& path, const Stopwatch& watch, int replays) {
  const fdcg_params params = fdcg_make_params();
  const std::size_t ticks = path.size() - 1;
  std::vector<float> tick(ticks), own(ticks), held;
  held.reserve(ticks);
  Measured m;
  fdcg_result result;
  fdcg_contact contact = first_contact(graph, params, path[0]);
  const std::uint64_t heap_before = heap_calls();
  for (std::size_t i = 0; i < ticks; ++i) {
    const fdcg_contact before = contact;
    const double* hip = path[i + 1].data();
    const std::uint64_t begin = Stopwatch::now();
    fdcg_step(&graph, &params, &contact, hip, &result);
    tick[i] = static_cast<float>(watch.nanoseconds(begin, Stopwatch::now()));
    m.transitions += result.transitions;
    m.contact += result.state != FDCG_FREE;
    if (before.state != FDCG_FREE && result.state != FDCG_FREE) held.push_back(tick[i]);
    m.bounded += result.flags != 0;
    float least = tick[i];
    for (int replay = 0; replay < replays; ++replay) {
      fdcg_contact again = before;
      const std::uint64_t start = Stopwatch::now();
      fdcg_step(&graph, &params, &again, hip, &result);
      least = std::min(least, static_cast<float>(watch.nanoseconds(start, Stopwatch::now())));
    }
    own[i] = least;
  }
  if (replays > 0) contact = first_contact(graph, params, path[0]);
  const std::uint64_t begin = Stopwatch::now();
  for (std::size_t i = 0; replays > 0 && i < ticks; ++i)
    fdcg_step(&graph, &params, &contact, path[i + 1].data(), &result);
  const auto count = static_cast<double>(ticks);
  m.batch_ns = watch.nanoseconds(begin, Stopwatch::now()) / count;
  m.heap_calls = heap_calls() - heap_before;
  m.transitions /= count;
  m.contact /= count;
  m.tick = Percentiles(std::move(tick));
  m.own = Percentiles(std::move(own));
  m.held = Percentiles(std::move(held));
  return m;
}

// ---- bodies and ways -------------------------------------------------------------------------------------------------------

struct BodyCase {
  std::string name;
  Body body = Body::sphere;
  int parts = 0;
};

const BodyCase kSmall = {"80", Body::sphere, 2};

std::vector<BodyCase> bodies(const Options& options) {
  std::vector<BodyCase> list = {{"12", Body::cube, 0},      {"12 merged", Body::block, 0}, kSmall,
                                {"70 k", Body::sphere, 59}, {"1 M", Body::sphere, 224},    {"1 M rough", Body::rough, 224}};
  if (options.quick) list.resize(4);
  if (options.large) list.push_back({"10 M", Body::sphere, 707});
  return list;
}

constexpr double kRates[] = {0.01, 0.1, 0.5, 1, 4};  // faces a tick
constexpr double kFewFacesATick = 0.25;              // beyond, a slide on a cube is a jump from side to side

struct Way {
  std::string name;
  double faces_a_tick = 0;  // 0: none
  Path path;
};

// One after the other, since each path takes memory.
void for_each_way(const Surface& surface, bool is_box, const Options& options, const std::function<void(const Way&)>& visit) {
  const double face = surface.face_way_m(), edge = surface.edge_m();
  const auto visit_if_asked = [&](const std::string& name, double rate, auto make_path) {
    if (options.way.empty() || options.way == name) visit({name, rate, make_path()});
  };
  for (const double rate : kRates) {
    if (is_box && rate > kFewFacesATick) continue;
    char name[32];
    std::snprintf(name, sizeof name, "%g a tick", rate);
    visit_if_asked(name, rate, [&] { return slide(surface, rate * face, kDepth_m, options.ticks); });
  }
  visit_if_asked("hand", kHandWay_m / face, [&] { return slide(surface, kHandWay_m, kDepth_m, options.ticks); });
  visit_if_asked("near", 0, [&] { return hover(surface, kHandWay_m, 2 * std::min(edge, 1e-3), options.ticks); });
  visit_if_asked("far", 0, [&] { return far_away(kHandWay_m, options.ticks); });
  visit_if_asked("teleport", 0, [&] { return teleports(options.ticks / 10, 1); });
}

// ---- bars ------------------------------------------------------------------------------------------------------------------

struct Row {
  std::string precision, planes, body, way;
  int faces = 0;
  double faces_a_tick = 0;
  Measured m;
};

class Bars {
 public:
  // The small body's own medians are the measure of the others': keep them as they come.
  void remember(const Row& row) {
    if (row.body == kSmall.name || row.body == "12") small_[key(row)][row.body] = {row.m.own.at(0.5), row.m.own.at(0.99)};
  }
  // What the row must keep, as text with each verdict; counts what fails.
  std::string judge(const Row& row) {
    std::string text;
    const auto must = [&](const char* what, double value, double bar) {
      char part[64];
      const bool holds = value <= bar;
      failures_ += !holds;
      std::snprintf(part, sizeof part, " %s<=%.0f:%s", what, bar, holds ? "ok" : "FAIL");
      text += part;
    };
    if (row.m.heap_calls != 0) must("heap", static_cast<double>(row.m.heap_calls), 0);
    must("own max", row.m.own.at(1), kWorstOwn_ns);
    if (row.way == "near") must("p50", row.m.tick.at(0.5), 250);
    if (row.faces_a_tick == 0) return text;
    const bool is_cube = row.faces <= 12;
    if (is_cube) {
      must("p50", row.m.tick.at(0.5), 40);
      must("p99", row.m.tick.at(0.99), 120);
    }
    if (row.way == "hand" && !is_cube && row.faces > 1000) must("p50", row.m.tick.at(0.5), hand_bar(row));
    if (!is_cube) must("p50", row.m.tick.at(0.5), 45 + 180 * row.faces_a_tick);
    if (row.way != "hand" && row.faces > 1000) {
      const auto& small = small_[key(row)];
      const auto found = small.find(row.faces_a_tick <= kFewFacesATick ? "12" : kSmall.name);
      if (found == small.end()) return text;
      must("own p50", row.m.own.at(0.5), kFlat * found->second.p50);
      must("own p99", row.m.own.at(0.99), kFlat * found->second.p99);
      must("flat p50", row.m.tick.at(0.5), kFlat * found->second.p50);
    }
    return text;
  }
  [[nodiscard]] int failures() const { return failures_; }

 private:
  struct Small {
    double p50, p99;
  };
  static std::string key(const Row& row) { return row.precision + row.planes + row.way; }
  static double hand_bar(const Row& row) { return row.faces < 100'000 ? 60 : row.faces < 2'000'000 ? 250 : 550; }

  std::map<std::string, std::map<std::string, Small>> small_;
  int failures_ = 0;
};

void print_head(const Options& options) {
  if (options.csv) {
    std::printf(
        "precision,planes,faces,body,way,faces_a_tick,transitions,contact,tick_p50,tick_p99,tick_p99.9,tick_max,held_p99,"
        "own_p50,own_p99,own_p99.9,own_max,batch,bytes_a_face,bounded,heap_calls,bars\n");
  } else {
    std::printf("%-4s %-7s %-9s %-11s %6s %6s %5s | %6s %6s %6s %7s %6s | %6s %6s %6s %6s | %6s  bars (ns)\n", "", "planes",
                "faces", "way", "faces", "trans.", "cont.", "p50", "p99", "p99.9", "max", "held99", "own50", "own99", "99.9",
                "max", "batch");
  }
}

void print(const Row& row, double bytes, const std::string& bars, const Options& options) {
  const Measured& m = row.m;
  const Percentiles &t = m.tick, &o = m.own;
  if (options.csv) {
    std::printf("%s,%s,%d,%s,%s,%g,%g,%g,%g,%g,%g,%g,%g,%g,%g,%g,%g,%g,%.0f,%llu,%llu,%s\n", row.precision.c_str(),
                row.planes.c_str(), row.faces, row.body.c_str(), row.way.c_str(), row.faces_a_tick, m.transitions, m.contact,
                t.at(0.5), t.at(0.99), t.at(0.999), t.at(1), m.held.at(0.99), o.at(0.5), o.at(0.99), o.at(0.999), o.at(1),
                m.batch_ns, bytes, static_cast<unsigned long long>(m.bounded), static_cast<unsigned long long>(m.heap_calls),
                bars.c_str());
  } else {
    std::printf(
        "%-4s %-7s %-9s %-11s %6.2f %6.2f %4.0f%% | %6.0f %6.0f %6.0f %7.0f %6.0f | %6.0f %6.0f %6.0f %6.0f | %6.0f %s\n",
        row.precision.c_str(), row.planes.c_str(), row.body.c_str(), row.way.c_str(), row.faces_a_tick, m.transitions,
        100 * m.contact, t.at(0.5), t.at(0.99), t.at(0.999), t.at(1), m.held.at(0.99), o.at(0.5), o.at(0.99), o.at(0.999),
        o.at(1), m.batch_ns, bars.c_str());
  }
  std::fflush(stdout);
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--large") {
      options.large = true;
    } else if (arg == "--csv") {
      options.csv = true;
    } else if (arg == "--quick") {
      options.quick = true;
    } else if ((arg == "--body" || arg == "--way" || arg == "--precision" || arg == "--planes") && i + 1 < argc) {
      (arg == "--body"     ? options.body
       : arg == "--way"    ? options.way
       : arg == "--planes" ? options.planes
                           : options.precision) = argv[++i];
    } else if (arg == "--replays" && i + 1 < argc) {
      options.replays = std::max(0, std::atoi(argv[++i]));
    } else if (arg == "--ticks" && i + 1 < argc) {
      options.ticks = std::max(1000, std::atoi(argv[++i]));
    } else {
      std::printf(
          "usage: %s [--large] [--quick] [--csv] [--ticks N] [--replays N]\n"
          "          [--body NAME] [--way NAME] [--precision f64,f32] [--planes stored,derived]\n"
          "  --large   10 M faces too: some 5 GB and a minute\n"
          "  --quick   no more than 70 k faces\n"
          "  --body, --way, --precision, --planes: only these rows, named as in the table\n",
          argv[0]);
      std::exit(arg == "--help" ? 0 : 2);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const Stopwatch watch;
  if (!options.csv) std::printf("reading the clock costs %.0f ns, subtracted; all times in ns\n", watch.cost_ns());
  print_head(options);
  Bars bars;
  for (const BodyCase& body : bodies(options)) {
    if (!options.body.empty() && options.body != body.name) continue;
    const fdcg::bake::PolygonSoup soup = make_body(body.body, body.parts);
    const Surface surface(body.body, body.parts);
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      if (!options.precision.empty() && options.precision != (precision == Precision::f64 ? "f64" : "f32")) continue;
      for (const bool is_stored : {true, false}) {
        if (!options.planes.empty() && options.planes != (is_stored ? "stored" : "derived")) continue;
        fdcg::bake::CompileOptions compile;
        compile.precision = precision;
        compile.store_planes = is_stored;
        compile.merge = body.body != Body::cube;
        compile.without = {"source-map", "info"};
        const BenchGraph graph(soup, compile);
        for_each_way(surface, body.parts == 0, options, [&](const Way& way) {
          Row row = {precision == Precision::f64 ? "f64" : "f32",
                     is_stored ? "stored" : "derived",
                     body.name,
                     way.name,
                     faces_of(body.body, body.parts),
                     way.faces_a_tick,
                     measure(graph.view(), way.path, watch, options.replays)};
          bars.remember(row);
          print(row, graph.bytes_per_face(), bars.judge(row), options);
        });
      }
    }
  }
  if (!options.csv) {
    std::printf("heap calls while stepping: %s; bars that do not hold: %d\n",
                can_count_heap_calls() ? "counted in every row" : "not counted in this build", bars.failures());
  }
  return bars.failures() == 0 ? 0 : 1;
}
