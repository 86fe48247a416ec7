// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "bench_graph.hpp"
#include "heap_count.hpp"
#include "scaling.hpp"
#include "slope.hpp"
#include "step_times.hpp"
#include "timed_bake.hpp"

namespace fdcg::test {
namespace {

constexpr double kDepth_m = 1e-3;
constexpr double kHandWay_m = 1e-4;  // a tick: 0.1 m/s at 1 kHz
constexpr double kHover_m = 2e-3;    // at most, above the surface; less where two edges are
// Own p50 on a body over that on the small one, at as many faces a tick and, near the surface, as many edges above it.
constexpr double kFlat = 1.3;
constexpr double kSteepestBake = 1.3;  // exponent of the bake's time; n log n is 1.07 over these sizes
constexpr double kNoise = 1.03;        // of a ratio of two medians of least times: see the control beside it
constexpr double kClockStep_ns = 0.8;  // of the time-stamp counter, which moves by two at 2.7 GHz: a median is off by as much
// Three numbers rounded to float and back: f64 has no such work, and in free space there is little else.
constexpr double kConversions_ns = 3;
constexpr double kLinearFrom_faces = 900;  // below, what a bake takes at least is in the time
constexpr int kSmallParts = 7;             // the small body: 980 faces
constexpr int kReplays = 9;

struct Size {
  Body body;
  int parts;
  [[nodiscard]] int faces() const { return faces_of(body, parts); }
  [[nodiscard]] std::string name() const { return body == Body::cube ? "cube" : body == Body::sphere ? "sphere" : "rough"; }
};

const char* name_of(bake::Precision precision) {
  return precision == bake::Precision::f64 ? "f64" : "f32";
}
const char* name_of_planes(bool is_stored) {
  return is_stored ? "stored" : "derived";
}

// ---- ways ------------------------------------------------------------------------------------------------------------------

enum class Motion { hand, cross, near, far };
constexpr std::array<Motion, 4> kMotions = {Motion::hand, Motion::cross, Motion::near, Motion::far};

const char* name_of(Motion motion) {
  switch (motion) {
    case Motion::hand:
      return "hand";
    case Motion::cross:
      return "cross";
    case Motion::near:
      return "near";
    default:
      return "far";
  }
}

// A slide over a cube goes no faster than a tenth of a face a tick: more is a jump from side to side.
double faces_a_tick(Motion motion, Body body, const Surface& surface) {
  if (motion == Motion::cross) return body == Body::cube ? 0.1 : 1.0;
  return motion == Motion::far ? 0.0 : kHandWay_m / surface.face_way_m();
}

// How high a near way goes, in edges of the body.
double height_in_edges(const Surface& surface) {
  return std::min(2.0, kHover_m / surface.edge_m());
}

// A way at so many faces a tick; a near one so many edges above the surface.
Path path_of(Motion motion, const Surface& surface, double rate, double height_edges, int ticks) {
  const double way_m = rate * surface.face_way_m();
  switch (motion) {
    case Motion::near:
      return hover(surface, way_m, height_edges * surface.edge_m(), ticks);
    case Motion::far:
      return far_away(kHandWay_m, ticks);
    default:
      return slide(surface, way_m, kDepth_m, ticks);
  }
}

// ---- the part --------------------------------------------------------------------------------------------------------------

// The largest of a quantity, and where it was.
struct Worst {
  double value = 0;
  std::string where = "nothing measured";
  void take(double other, const std::string& there) {
    if (!(other <= value)) value = other, where = there;
  }
};

constexpr int kMostDerived_faces = 2'000'000;  // beyond, only graphs with planes stored, for the sake of time

using Pair = std::array<std::unique_ptr<TimedBake>, 2>;  // f64, f32
using Key = std::array<std::string, 3>;                  // body, precision, planes

class FacesPart {
 public:
  explicit FacesPart(const ScalingRun& run)
      : run_(run),
        ticks_(run.is_quick ? 2500 : 20'000),
        faces_(run.output, "scaling_faces",
               {"body", "precision", "planes", "faces", "bake_s", "bake_cpu_s", "bake_peak_bytes", "file_bytes",
                "open_trusted_s", "open_full_s"}),
        stages_(run.output, "scaling_stages", {"body", "precision", "planes", "faces", "stage", "seconds"}),
        steps_(run.output, "scaling_steps",
               {"body", "precision", "planes", "faces", "way", "faces_a_tick", "transitions_a_tick", "contact_share", "kind",
                "p50_ns", "p99_ns", "p99.9_ns", "max_ns", "small_p50_ns"}),
        ratios_(run.output, "scaling_f32",
                {"body", "planes", "faces", "way", "f64_own_p50_ns", "f32_own_p50_ns", "f64_own_mean_ns", "f32_own_mean_ns",
                 "f64_met_p50_ns", "f32_met_p50_ns", "control_own_p50_ns"}) {}

  void measure() {
    std::printf("%-7s %-9s %-8s | %9s %9s %8s %9s | hand: own p50, p99, as met p50 | cross own | near own | f32/f64 own\n",
                "body", "faces", "planes", "bake s", "peak MB", "B/face", "open full");
    warm_up();
    measure_steps({Body::cube, 0}, bake_pair({Body::cube, 0}, make_body(Body::cube, 0), true), nullptr, true);
    for (const Body body : {Body::sphere, Body::rough}) {
      std::array<Pair, 2> small;  // by is_stored
      for (const int parts : {2, kSmallParts, 22, 71, 224, 707}) {
        const Size size = {body, parts};
        if (run_.is_quick && size.faces() > 200'000) break;
        const bake::PolygonSoup soup = make_body(body, parts);
        for (const bool is_stored : {true, false}) {
          if (!is_stored && size.faces() > kMostDerived_faces) continue;
          Pair graphs = bake_pair(size, soup, is_stored);
          const bool is_small = parts == kSmallParts;
          if (is_small) small[is_stored] = std::move(graphs);
          measure_steps(size, is_small ? small[is_stored] : graphs, small[is_stored][0] ? &small[is_stored] : nullptr,
                        is_stored);
        }
      }
    }
    judge();
  }

 private:
  // The first work of a program is its slowest.
  void warm_up() const {
    bake::CompileOptions options;
    const TimedBake bake(make_body(Body::sphere, kSmallParts), options, 0);
    const Surface surface(Body::sphere, kSmallParts);
    const Path path = slide(surface, kHandWay_m, kDepth_m, ticks_);
    time_steps({{&bake.view(), &path}}, run_.watch, kReplays);
  }

  Pair bake_pair(const Size& size, const bake::PolygonSoup& soup, bool is_stored) {
    const double patience_s = run_.is_quick ? 0.2 : 1;
    Pair pair;
    for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
      bake::CompileOptions options;
      options.precision = precision;
      options.store_planes = is_stored;
      options.merge = size.body != Body::cube;
      auto& graph = pair[precision == bake::Precision::f32];
      graph = std::make_unique<TimedBake>(soup, options, patience_s);
      const double trusted_s = graph->open_s(FDCG_VERIFY_TRUSTED, patience_s / 10);
      const double full_s = graph->open_s(FDCG_VERIFY_FULL, patience_s / 10);
      const Key key = {size.name(), name_of(precision), name_of_planes(is_stored)};
      faces_.row(key[0], key[1], key[2], size.faces(), graph->seconds(), graph->cpu_seconds(), graph->peak_bytes(),
                 graph->file_bytes(), trusted_s, full_s);
      for (const auto& [stage, seconds] : graph->stages())
        stages_.row(key[0], key[1], key[2], size.faces(), stage, seconds);
      if (size.body == Body::cube) continue;
      auto& grown = grown_[key];
      const double faces = size.faces();
      grown["bake_s"].emplace_back(faces, graph->seconds());
      grown["bake_cpu_s"].emplace_back(faces, graph->cpu_seconds());
      grown["bake_peak_bytes"].emplace_back(faces, graph->peak_bytes());
      grown["file_bytes"].emplace_back(faces, static_cast<double>(graph->file_bytes()));
      grown["open_trusted_s"].emplace_back(faces, trusted_s);
      grown["open_full_s"].emplace_back(faces, full_s);
    }
    return pair;
  }

  void measure_steps(const Size& size, const Pair& graphs, const Pair* small, bool is_stored) {
    const Surface surface(size.body, size.parts), small_surface(size.body, kSmallParts);
    std::map<Motion, std::vector<StepTimes>> all;
    for (const Motion motion : kMotions) {
      const double rate = faces_a_tick(motion, size.body, surface);
      const double height = height_in_edges(surface);
      const Path path = path_of(motion, surface, rate, height, ticks_);
      const Path small_path = path_of(motion, small_surface, rate, height, ticks_);
      std::vector<Lane> lanes = {{&graphs[0]->view(), &path}, {&graphs[1]->view(), &path}, {&graphs[0]->view(), &path}};
      if (small != nullptr && size.parts > kSmallParts) {
        for (const auto& graph : *small)
          lanes.push_back({&graph->view(), &small_path});
      }
      const auto times = time_steps(lanes, run_.watch, kReplays);
      record(size, motion, rate, is_stored, times);
      all[motion] = times;
    }
    say(size, is_stored, graphs, all);
  }

  // `times`: f64, f32, f64 again as a control; and, where there are five, f64 and f32 on the small body.
  void record(const Size& size, Motion motion, double rate, bool is_stored, const std::vector<StepTimes>& times) {
    const std::string planes = name_of_planes(is_stored), way = name_of(motion);
    for (std::size_t k = 0; k < 2; ++k) {
      const StepTimes& t = times[k];
      const StepTimes* const small = times.size() > 3 ? &times[3 + k] : nullptr;
      const std::string precision = k == 0 ? "f64" : "f32";
      for (const bool is_own : {true, false}) {
        const Percentiles& p = is_own ? t.own : t.met;
        const double small_p50 = small == nullptr ? std::nan("") : (is_own ? small->own : small->met).at(0.5);
        steps_.row(size.name(), precision, planes, size.faces(), way, rate, t.transitions, t.contact, is_own ? "own" : "met",
                   p.at(0.5), p.at(0.99), p.at(0.999), p.at(1), small_p50);
      }
      heap_calls_ += t.heap_calls;
      if (size.body == Body::cube) continue;
      grown_[{size.name(), precision, planes}][way + "_own_p50_ns"].emplace_back(size.faces(), t.own.at(0.5));
      if (small == nullptr) continue;
      flat_[way].take(t.own.at(0.5) / small->own.at(0.5),
                      size.name() + " of " + std::to_string(size.faces()) + ", " + precision + ", " + planes);
    }
    const StepTimes &f64 = times[0], &f32 = times[1], &control = times[2];
    ratios_.row(size.name(), planes, size.faces(), way, f64.own.at(0.5), f32.own.at(0.5), f64.own_mean_ns, f32.own_mean_ns,
                f64.met.at(0.5), f32.met.at(0.5), control.own.at(0.5));
    const std::string where = size.name() + " of " + std::to_string(size.faces()) + ", " + planes;
    if (motion == Motion::near || motion == Motion::far) {
      conversions_["own p50, " + way].take(f32.own.at(0.5) - f64.own.at(0.5), where);
    } else {
      narrow_["own p50 less a step of the clock, " + way].take((f32.own.at(0.5) - kClockStep_ns) / f64.own.at(0.5), where);
      narrow_["own mean, " + way].take(f32.own_mean_ns / f64.own_mean_ns, where);
      met_.take(f32.met.at(0.5) / f64.met.at(0.5), where + ", " + way);
    }
    control_.take(std::max(control.own.at(0.5) / f64.own.at(0.5), f64.own.at(0.5) / control.own.at(0.5)), where + ", " + way);
  }

  void say(const Size& size, bool is_stored, const Pair& graphs, std::map<Motion, std::vector<StepTimes>>& all) const {
    for (std::size_t k = 0; k < 2; ++k) {
      const StepTimes &hand = all[Motion::hand][k], &cross = all[Motion::cross][k], &near = all[Motion::near][k];
      std::printf("%-7s %-9d %s %-7s | %9.4g %9.4g %8.4g | %6.0f %6.0f %6.0f | %6.0f | %6.0f | %5.2f\n", size.name().c_str(),
                  size.faces(), k == 0 ? "f64" : "f32", name_of_planes(is_stored), graphs[k]->seconds(),
                  graphs[k]->peak_bytes() / 1e6, static_cast<double>(graphs[k]->file_bytes()) / size.faces(), hand.own.at(0.5),
                  hand.own.at(0.99), hand.met.at(0.5), cross.own.at(0.5), near.own.at(0.5),
                  hand.own.at(0.5) / all[Motion::hand][0].own.at(0.5));
    }
    std::fflush(stdout);
  }

  void judge() {
    for (const auto& [key, quantities] : grown_) {
      const std::string series = key[0] + ", " + key[1] + ", " + key[2];
      std::string said;
      for (const auto& [quantity, values] : quantities) {
        const double exponent = exponent_of(values, kLinearFrom_faces);
        run_.exponents->row("scaling_faces", key[0], key[1], key[2], quantity, kLinearFrom_faces, values.back().first,
                            exponent);
        said += ", " + quantity + " " + cell(std::round(exponent * 1000) / 1000);
        if (quantity == "bake_cpu_s")
          judge_time(run_, "exponent of the bake's processor time, " + series, exponent, kSteepestBake, "",
                     "n log n is about 1.07");
      }
      std::printf("exponents of %s: %s\n", series.c_str(), said.c_str() + 2);
    }
    for (const auto& [way, worst] : flat_)
      judge_time(run_, "flat: own p50 over the body of 980 faces, " + way, worst.value, kFlat, "", worst.where);
    for (const auto& [what, worst] : narrow_)
      judge_time(run_, "f32 over f64, " + what, worst.value, kNoise, "", worst.where);
    for (const auto& [what, worst] : conversions_)
      judge_time(run_, "f32 less f64, " + what, worst.value, kConversions_ns, "ns", worst.where);
    std::printf("f64 against itself, own p50: %.3f at most (%s); f32 over f64, as met p50 in contact: %.3f at most (%s)\n",
                control_.value, control_.where.c_str(), met_.value, met_.where.c_str());
    if (can_count_heap_calls())
      run_.bars->at_most("heap calls while stepping one contact", static_cast<double>(heap_calls_), 0, "");
  }

  const ScalingRun& run_;
  int ticks_;
  Table faces_, stages_, steps_, ratios_;
  std::map<Key, std::map<std::string, Series>> grown_;  // by quantity
  std::map<std::string, Worst> flat_, narrow_, conversions_;
  Worst control_, met_;
  std::uint64_t heap_calls_ = 0;
};

}  // namespace

void scale_faces(const ScalingRun& run) {
  FacesPart(run).measure();
}

}  // namespace fdcg::test
