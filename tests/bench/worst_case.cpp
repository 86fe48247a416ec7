// SPDX-License-Identifier: Apache-2.0
// The most expensive tick: searches, at random and by climbing from the worst found so far, over bodies made to be hard, hands
// that jump, graze and stand exactly on features, and friction. A case is a body and a few HIPs; its cost is its dearest tick,
// the least of several replays from a copy of the contact. What is found goes into a file that later runs begin with.
// Over 400 lines: bodies, hands, search and table of one program, read from top to bottom.
//
//   fdcg_bench_worst_case [--seconds N] [--seed S] [--cases FILE] [--write] [--no-count] [--body NAME]
//
// --seconds for each body and precision (0: only the file's cases), --write puts the worst case of each back into the file;
// --no-count: for runs under valgrind, which cannot be single-stepped.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bench_graph.hpp"
#include "instruction_count.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "stopwatch.hpp"

using namespace fdcg::test;
using fdcg::bake::PolygonSoup;
using fdcg::bake::Precision;
using fdcg::bake::Vec3;

namespace {

constexpr double kBar_ns = 5000;
constexpr int kHeldTicks = 2;     // the last HIP is held so long: carried work shows
constexpr int kQuickReplays = 4;  // in the search; a case that looks dear is measured again
constexpr int kSureReplays = 60;
constexpr int kMostWindows = 20;  // in which a case over the bar is measured: a window takes some milliseconds, in which the
constexpr std::chrono::milliseconds kBetweenWindows{50};  // whole processor may be slower than its clock says
constexpr std::size_t kMostHips = 5;
constexpr std::uint64_t kMostInstructions = 200'000;  // counted; some ten times the bar
constexpr std::size_t kPopulation = 12;

struct BodyKind {
  const char* name;
  std::function<PolygonSoup()> make;
  bool merge = true;
};

PolygonSoup tilted(const PolygonSoup& soup) {
  return transformed(soup, random_rotation(7));
}

PolygonSoup rough_ball(int parts) {
  PolygonSoup soup = geodesic_sphere(parts);
  Random random(3);
  for (Vec3& p : soup.points) {
    const double f = 1 + random.uniform(-0.2, 0.2) / parts;
    p = {p.x * f, p.y * f, p.z * f};
  }
  return soup;
}

const std::vector<BodyKind>& body_kinds() {
  static const std::vector<BodyKind> kinds = {
      {"cube", [] { return triangulated(cube()); }, false},
      {"cube-finer", [] { return subdivided(subdivided(subdivided(cube()))); }, false},  // dyadic: exactly on planes
      {"cone-10000", [] { return cone(10000); }},
      {"cone-pit-10000", [] { return cone_pit(10000); }},
      {"flat-cone-10000", [] { return fan_block(10000, 1e-3, 0, 0); }},
      {"crown-10000", [] { return fan_block(10000, 0, 0.5, -0.5); }},  // saddle: edges up and down in turns
      {"needle-fan-tilted", [] { return tilted(fan_block(4000, 3, -0.5, -0.4)); }},
      {"needle-strip", [] { return needle_strip(5000, 0.3, 2); }},
      {"needle-strip-rough", [] { return needle_strip(5000, 200, 5); }},
      {"prism-500", [] { return prism(500); }},
      {"prism-5000", [] { return tilted(prism(5000)); }},
      {"thin-plate", [] { return thin_plate(1e-6, 60); }, false},
      {"thin-plate-tilted", [] { return tilted(triangulated(thin_plate(1e-6, 40))); }, false},
      {"plate-300", [] { return thin_plate(0.1, 300); }, false},
      {"pit-tilted", [] { return tilted(triangulated(corner_pit())); }},
      {"pit-40", [] { return tilted(cone_pit(40)); }},
      {"saddle", [] { return saddle_block(); }},
      {"star", [] { return star_sphere(5, 0.4, 3); }},
      {"spiky", [] { return spiky_sphere(5, 1.5, 3); }},
      {"poles-5000", [] { return uv_sphere(5000, 50); }},
      {"ball-1M", [] { return geodesic_sphere(224); }},
      {"rough-ball-1M", [] { return rough_ball(224); }},
      {"torus-200k", [] { return torus(500, 200); }},
  };
  return kinds;
}

// ---- cases -----------------------------------------------------------------------------------------------------------------

struct Case {
  double mu_static = 0, mu_dynamic = 0;
  std::vector<Point> hips;
};

struct Cost {
  double own_ns = 0;
  std::size_t tick = 0;
  std::uint32_t transitions = 0, flags = 0, before = 0, after = 0;
};

fdcg_params params_of(const Case& c) {
  fdcg_params params = fdcg_make_params();
  params.mu_static = c.mu_static;
  params.mu_dynamic = c.mu_dynamic;
  return params;
}

const Point& hip_at(const Case& c, std::size_t tick) {
  return c.hips[std::min(tick, c.hips.size() - 1)];
}

Cost cost_of(const fdcg_graph& graph, const Case& c, const Stopwatch& watch, int replays) {
  const fdcg_params params = params_of(c);
  fdcg_contact contact = {};
  fdcg_result result;
  Cost worst;
  for (std::size_t tick = 0; tick < c.hips.size() + kHeldTicks; ++tick) {
    const fdcg_contact before = contact;
    double least = 1e18;
    for (int replay = 0; replay < replays; ++replay) {
      contact = before;
      const std::uint64_t begin = Stopwatch::now();
      fdcg_step(&graph, &params, &contact, hip_at(c, tick).data(), &result);
      least = std::min(least, watch.nanoseconds(begin, Stopwatch::now()));
      if (least < worst.own_ns) break;
    }
    if (least > worst.own_ns) worst = {least, tick, result.transitions, result.flags, before.state, result.state};
  }
  return worst;
}

// What the step answers for. A case over the bar is measured again, at other times; the least counts.
Cost sure_cost_of(const fdcg_graph& graph, const Case& c, const Stopwatch& watch) {
  Cost least = cost_of(graph, c, watch, 5 * kSureReplays);
  for (int window = 1; window < kMostWindows && least.own_ns > kBar_ns; ++window) {
    std::this_thread::sleep_for(kBetweenWindows);
    const Cost again = cost_of(graph, c, watch, 5 * kSureReplays);
    if (again.own_ns < least.own_ns) least = again;
  }
  return least;
}

std::uint64_t instructions_at(const fdcg_graph& graph, const Case& c, std::size_t worst_tick) {
  const fdcg_params params = params_of(c);
  fdcg_contact contact = {};
  fdcg_result result;
  for (std::size_t tick = 0; tick < worst_tick; ++tick)
    fdcg_step(&graph, &params, &contact, hip_at(c, tick).data(), &result);
  const Point hip = hip_at(c, worst_tick);
  return instructions_of([&] { fdcg_step(&graph, &params, &contact, hip.data(), &result); }, kMostInstructions);
}

// ---- making and changing cases ---------------------------------------------------------------------------------------------

class Proposer {
 public:
  Proposer(const PolygonSoup& soup, std::uint64_t seed) : soup_(soup), random_(seed) {
    for (const Vec3& p : soup.points)
      size_ = std::max({size_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }

  Case fresh() {
    Case c;
    set_friction(c);
    const std::size_t count = 2 + random_.below(kMostHips - 1);
    for (std::size_t i = 0; i < count; ++i)
      c.hips.push_back(hip(c));
    return c;
  }

  Case changed(Case c) {
    const std::uint32_t changes = 1 + random_.below(3);
    for (std::uint32_t i = 0; i < changes; ++i) {
      const std::size_t at = random_.below(static_cast<std::uint32_t>(c.hips.size()));
      switch (random_.below(10)) {
        case 0:
          set_friction(c);
          break;
        case 1:
          if (c.hips.size() < kMostHips) c.hips.insert(c.hips.begin() + static_cast<std::ptrdiff_t>(at), hip(c));
          break;
        case 2:
          if (c.hips.size() > 2) c.hips.erase(c.hips.begin() + static_cast<std::ptrdiff_t>(at));
          break;
        case 3:
          c.hips[at] = hip(c);
          break;
        case 4:  // one coordinate as a corner has it: onto axis-aligned planes
          c.hips[at][random_.below(3)] = corner()[random_.below(3)];
          break;
        case 5:
          for (double& x : c.hips[at])
            x = std::nextafter(x, random_.chance(0.5) ? 10 * size_ : -10 * size_);
          break;
        default:
          c.hips[at] = shaken(c.hips[at], std::pow(10, random_.uniform(-12, 0)));
      }
    }
    return c;
  }

 private:
  void set_friction(Case& c) {
    constexpr double kStatic[] = {0, 0.1, 0.6, 2};
    c.mu_static = kStatic[random_.below(4)];
    c.mu_dynamic = c.mu_static * (random_.chance(0.5) ? 1 : 0.7);
  }

  Point corner() {
    const Vec3& p = soup_.points[soup_.corners[random_.below(static_cast<std::uint32_t>(soup_.corners.size()))]];
    return {p.x, p.y, p.z};
  }

  Point shaken(Point p, double share) {
    const Vec3 d = random_.direction();
    const double length = share * size_;
    return {p[0] + d.x * length, p[1] + d.y * length, p[2] + d.z * length};
  }

  static Point between(const Point& a, const Point& b, double part) {
    return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
  }

  // A corner of the face and the next one.
  std::pair<Point, Point> edge() {
    const std::uint32_t f = random_.below(static_cast<std::uint32_t>(soup_.face_count()));
    const std::uint32_t first = soup_.face_first[f], count = soup_.face_first[f + 1] - first, k = random_.below(count);
    const auto at = [&](std::uint32_t i) {
      const Vec3& p = soup_.points[soup_.corners[first + i % count]];
      return Point{p.x, p.y, p.z};
    };
    return {at(k), at(k + 1)};
  }

  Point hip(const Case& c) {
    const auto [a, b] = edge();
    switch (random_.below(9)) {
      case 0:
        return corner();
      case 1:
        return between(a, b, random_.below(5) / 4.0);
      case 2:
        return shaken(between(a, b, random_.unit()), std::pow(10, random_.uniform(-16, -1)));
      case 3:  // near the last vertex: the apex of fans
        return shaken({soup_.points.back().x, soup_.points.back().y, soup_.points.back().z},
                      std::pow(10, random_.uniform(-16, 0)));
      case 4:  // from the last HIP through a corner, as far beyond: aims at it exactly
        if (!c.hips.empty()) return between(c.hips.back(), corner(), random_.chance(0.5) ? 2 : 1.25);
        break;
      case 5:
        if (!c.hips.empty()) return shaken(c.hips.back(), std::pow(10, random_.uniform(-12, 0)));
        break;
      case 6:  // along an edge from end to end and beyond: grazes
        if (!c.hips.empty()) return between(c.hips.back(), b, random_.uniform(0.5, 2));
        break;
      case 7: {
        Point p = shaken({}, random_.unit());
        p[random_.below(3)] = corner()[random_.below(3)];
        return p;
      }
      default:
        break;
    }
    Point p;
    for (double& x : p)
      x = 1.3 * size_ * random_.uniform(-1, 1);
    return p;
  }

  const PolygonSoup& soup_;
  Random random_;
  double size_ = 0;
};

// ---- search ----------------------------------------------------------------------------------------------------------------

struct Found {
  Case c;
  Cost cost;
};

// The worst first, at most kPopulation.
class Population {
 public:
  void add(Found found) {
    if (members_.size() == kPopulation && found.cost.own_ns <= members_.back().cost.own_ns) return;
    const auto after =
        std::find_if(members_.begin(), members_.end(), [&](const Found& m) { return m.cost.own_ns < found.cost.own_ns; });
    members_.insert(after, std::move(found));
    if (members_.size() > kPopulation) members_.pop_back();
  }
  [[nodiscard]] const std::vector<Found>& members() const { return members_; }
  [[nodiscard]] double least() const { return members_.size() < kPopulation ? 0 : members_.back().cost.own_ns; }

 private:
  std::vector<Found> members_;
};

std::uint64_t search(const fdcg_graph& graph, const PolygonSoup& soup, std::uint64_t seed, double seconds,
                     const Stopwatch& watch, Population& population) {
  Proposer proposer(soup, seed);
  Random random(seed + 1);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::uint64_t tried = 0;
  while (std::chrono::steady_clock::now() < end) {
    ++tried;
    const auto& members = population.members();
    const bool climbs = !members.empty() && random.chance(0.7);
    Case c = climbs ? proposer.changed(members[random.below(static_cast<std::uint32_t>(members.size()))].c) : proposer.fresh();
    Cost cost = cost_of(graph, c, watch, kQuickReplays);
    if (cost.own_ns <= population.least()) continue;
    cost = cost_of(graph, c, watch, kSureReplays);
    population.add({std::move(c), cost});
  }
  return tried;
}

// ---- the file --------------------------------------------------------------------------------------------------------------

// Lines of: body precision mu_static mu_dynamic, then three numbers a HIP, as hexadecimal doubles.
struct Entry {
  std::string body, precision;
  Case c;
};

std::vector<Entry> read_cases(const std::string& path) {
  std::vector<Entry> entries;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Entry entry;
    words >> entry.body >> entry.precision;
    std::vector<double> numbers;
    for (std::string word; words >> word;)
      numbers.push_back(std::strtod(word.c_str(), nullptr));
    if (numbers.size() < 8 || numbers.size() % 3 != 2) {
      std::fprintf(stderr, "%s: not a case: %s\n", path.c_str(), line.c_str());
      std::exit(2);
    }
    entry.c.mu_static = numbers[0];
    entry.c.mu_dynamic = numbers[1];
    for (std::size_t i = 2; i < numbers.size(); i += 3)
      entry.c.hips.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    entries.push_back(std::move(entry));
  }
  return entries;
}

void write_cases(const std::string& path, const std::vector<Entry>& entries) {
  std::ofstream file(path);
  file << "# The dearest ticks that fdcg_bench_worst_case has found: body precision mu_static mu_dynamic HIPs...\n";
  for (const Entry& entry : entries) {
    char text[64];
    file << entry.body << ' ' << entry.precision << ' ' << entry.c.mu_static << ' ' << entry.c.mu_dynamic;
    for (const Point& hip : entry.c.hips) {
      for (const double x : hip) {
        std::snprintf(text, sizeof text, " %a", x);
        file << text;
      }
    }
    file << '\n';
  }
}

struct Options {
  double seconds = 3;
  std::uint64_t seed = 1;
  std::string cases = FDCG_SOURCE_DIR "/tests/bench/worst_cases.txt", body;
  bool write = false, count = true;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const auto value = [&] {
      if (++i == argc) std::exit(2);
      return argv[i];
    };
    if (arg == "--seconds") {
      options.seconds = std::atof(value());
    } else if (arg == "--seed") {
      options.seed = std::strtoull(value(), nullptr, 10);
    } else if (arg == "--cases") {
      options.cases = value();
    } else if (arg == "--body") {
      options.body = value();
    } else if (arg == "--no-count") {
      options.count = false;
    } else if (arg == "--write") {
      options.write = true;
    } else {
      std::printf("usage: %s [--seconds N] [--seed S] [--cases FILE] [--write] [--no-count] [--body NAME]\n", argv[0]);
      std::exit(arg == "--help" ? 0 : 2);
    }
  }
  return options;
}

const char* state_name(std::uint32_t state) {
  constexpr const char* kNames[] = {"free", "face", "edge", "vertex"};
  return kNames[state & 3];
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const Stopwatch watch;
  const std::vector<Entry> known = read_cases(options.cases);
  std::vector<Entry> worst;
  int failures = 0;
  std::printf("seed %llu, %.0f s a body and precision; own work of the dearest tick (bar %.0f ns)\n",
              static_cast<unsigned long long>(options.seed), options.seconds, kBar_ns);
  std::printf("%-20s %-4s %10s %10s %12s %7s %5s  %s\n", "body", "", "cases", "own ns", "instructions", "trans.", "flags",
              "from -> to");
  for (const BodyKind& kind : body_kinds()) {
    if (!options.body.empty() && options.body != kind.name) continue;
    const PolygonSoup soup = kind.make();
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      const std::string precision_name = precision == Precision::f64 ? "f64" : "f32";
      fdcg::bake::CompileOptions compile;
      compile.precision = precision;
      compile.merge = kind.merge;
      compile.without = {"source-map", "info"};
      const BenchGraph graph(soup, compile);
      Population population;
      for (const Entry& entry : known) {
        if (entry.body != kind.name) continue;  // a case of the other precision may be dear here too
        population.add({entry.c, cost_of(graph.view(), entry.c, watch, kSureReplays)});
      }
      const std::uint64_t tried = search(graph.view(), soup, options.seed, options.seconds, watch, population);
      if (population.members().empty()) continue;
      Found found = population.members().front();
      found.cost = sure_cost_of(graph.view(), found.c, watch);
      failures += found.cost.own_ns > kBar_ns;
      std::printf("%-20s %-4s %10llu %10.0f %12llu %7u %5u  %s -> %s%s\n", kind.name, precision_name.c_str(),
                  static_cast<unsigned long long>(tried), found.cost.own_ns,
                  static_cast<unsigned long long>(options.count ? instructions_at(graph.view(), found.c, found.cost.tick) : 0),
                  found.cost.transitions, found.cost.flags, state_name(found.cost.before), state_name(found.cost.after),
                  found.cost.own_ns > kBar_ns ? "  FAIL" : "");
      std::fflush(stdout);
      worst.push_back({kind.name, precision_name, found.c});
    }
  }
  if (options.write) write_cases(options.cases, worst);
  return failures == 0 ? 0 : 1;
}
