// SPDX-License-Identifier: Apache-2.0
// The regression guard's figures of one build, one line each on standard output: figure, unit, value. guard.py runs this
// program, linked with either library, in turns. It asks for what the public headers had from the start and nothing newer,
// since the base may be old.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "bench_graph.hpp"
#include "step_times.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::PolygonSoup;
using fdcg::bake::Precision;

namespace {

constexpr int kTicks = 4000, kReplays = 5, kBakes = 3, kLoads = 20;
constexpr double kDepth_m = 1e-3, kHandWay_m = 1e-4;  // a tick: 0.1 m/s at 1 kHz
constexpr int kBakedParts = 59;                       // 69,620 faces

struct BodyCase {
  const char* name;
  Body body;
  int parts;
  double cross_rate;  // faces a tick of the crossing way: on a cube more is a jump from side to side
};
constexpr BodyCase kBodies[] = {{"cube 12", Body::cube, 0, 0.1},
                                {"sphere 980", Body::sphere, 7, 1},
                                {"sphere 69620", Body::sphere, kBakedParts, 1},
                                {"rough 69620", Body::rough, kBakedParts, 1}};

// What was asked for on the command line; all where nothing was.
struct Asked {
  std::vector<std::string> figures;

  // A figure's name, from the names of a group that is made at once: whether any of them is asked for.
  [[nodiscard]] bool any_of(const std::string& prefix) const {
    return figures.empty() || std::any_of(figures.begin(), figures.end(),
                                          [&](const std::string& f) { return f.compare(0, prefix.size(), prefix) == 0; });
  }
  void say(const std::string& figure, const char* unit, double value) const {
    if (!figures.empty() && std::find(figures.begin(), figures.end(), figure) == figures.end()) return;
    std::printf("%s,%s,%.9g\n", figure.c_str(), unit, value);
    std::fflush(stdout);
  }
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double least_processor_seconds(int runs, const std::function<void()>& work) {
  double least = 1e30;
  for (int run = 0; run < runs; ++run) {
    const double begin = processor_seconds();
    work();
    least = std::min(least, processor_seconds() - begin);
  }
  return least;
}

void steps(const Asked& asked, const Stopwatch& watch) {
  for (const BodyCase& body : kBodies) {
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      const std::string prefix = std::string("step ") + body.name + (precision == Precision::f64 ? " f64" : " f32");
      if (!asked.any_of(prefix)) continue;
      CompileOptions options;
      options.precision = precision;
      options.merge = body.body != Body::cube;
      const BenchGraph graph(make_body(body.body, body.parts), options);
      const Surface surface(body.body, body.parts);
      const Path ways[] = {slide(surface, kHandWay_m, kDepth_m, kTicks),
                           slide(surface, body.cross_rate * surface.face_way_m(), kDepth_m, kTicks)};
      for (int w = 0; w < 2; ++w) {
        const StepTimes times = time_steps({{&graph.view(), &ways[w]}}, watch, kReplays)[0];
        const std::string name = prefix + (w == 0 ? " hand" : " cross");
        asked.say(name + " p50", "ns", times.own.at(0.5));
        asked.say(name + " mean", "ns", times.own_mean_ns);
      }
    }
  }
}

void bakes(const Asked& asked) {
  const PolygonSoup soup = make_body(Body::sphere, kBakedParts);
  if (asked.any_of("validate")) {
    bool passes = true;
    const double seconds = least_processor_seconds(kBakes, [&] { passes = fdcg::bake::validate(soup, {}).passes() && passes; });
    if (passes) asked.say("validate 69620", "s", seconds);
  }
  for (const bool is_f32 : {false, true}) {
    const std::string precision = is_f32 ? " f32" : " f64";
    if (!asked.any_of("bake 69620" + precision) && !asked.any_of("load 69620" + precision) &&
        !asked.any_of("file 69620" + precision))
      continue;
    CompileOptions options;
    options.precision = is_f32 ? Precision::f32 : Precision::f64;
    std::vector<std::byte> bytes;
    const double seconds = least_processor_seconds(kBakes, [&] {
      auto compiled = fdcg::bake::compile(soup, options);
      bytes = compiled ? std::move(compiled->bytes) : std::vector<std::byte>();
    });
    if (bytes.empty()) continue;
    asked.say("bake 69620" + precision, "s", seconds);
    asked.say("file 69620" + precision, "bytes", static_cast<double>(bytes.size()));
    bool opens = true;
    const double load = least_processor_seconds(kLoads, [&] {
      fdcg_graph view;
      fdcg_error error;
      opens = fdcg_open_memory(bytes.data(), bytes.size(), FDCG_VERIFY_FULL, &view, &error) == FDCG_OK && opens;
      fdcg_close(&view);
    });
    if (opens) asked.say("load 69620" + precision, "s", load);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Asked asked;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--figure") != 0 || i + 1 == argc) {
      std::fprintf(stderr, "usage: %s [--figure NAME]...\nOne line for each figure, or for those named: figure,unit,value.\n",
                   argv[0]);
      return std::strcmp(argv[i], "--help") == 0 ? 0 : 2;
    }
    asked.figures.emplace_back(argv[++i]);
  }
  if (asked.any_of("step ")) steps(asked, Stopwatch());
  if (asked.any_of("validate") || asked.any_of("bake") || asked.any_of("file") || asked.any_of("load")) bakes(asked);
  return 0;
}
