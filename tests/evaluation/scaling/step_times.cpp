// SPDX-License-Identifier: Apache-2.0
#include "step_times.hpp"

#include <algorithm>

#include "heap_count.hpp"

namespace fdcg::test {
namespace {

// One graph's contact on its way, and what its ticks took.
class Stepper {
 public:
  explicit Stepper(const Lane& lane) : graph_(*lane.graph), path_(*lane.path) {
    met_.reserve(path_.size());
    own_.reserve(path_.size());
    fdcg_step(&graph_, &params_, &contact_, path_[0].data(), &result_);
  }

  void tick(std::size_t i, const Stopwatch& watch, int replays) {
    const Point& hip = path_[i];
    const fdcg_contact before = contact_;
    const std::uint64_t begin = Stopwatch::now();
    fdcg_step(&graph_, &params_, &contact_, hip.data(), &result_);
    float least = static_cast<float>(watch.nanoseconds(begin, Stopwatch::now()));
    met_.push_back(least);
    times_.transitions += result_.transitions;
    times_.contact += result_.state != FDCG_FREE;
    times_.bounded_ticks += result_.flags != 0;
    for (int replay = 0; replay < replays; ++replay) {
      fdcg_contact again = before;
      const std::uint64_t start = Stopwatch::now();
      fdcg_step(&graph_, &params_, &again, hip.data(), &result_);
      least = std::min(least, static_cast<float>(watch.nanoseconds(start, Stopwatch::now())));
    }
    own_.push_back(least);
    times_.own_mean_ns += least;
  }

  StepTimes finish() {
    const auto count = static_cast<double>(std::max<std::size_t>(1, met_.size()));
    times_.transitions /= count;
    times_.contact /= count;
    times_.own_mean_ns /= count;
    times_.met = Percentiles(std::move(met_));
    times_.own = Percentiles(std::move(own_));
    return times_;
  }

 private:
  const fdcg_graph& graph_;
  const Path& path_;
  const fdcg_params params_ = fdcg_make_params();
  fdcg_contact contact_ = {};
  fdcg_result result_ = {};
  StepTimes times_;
  std::vector<float> met_, own_;
};

}  // namespace

std::vector<StepTimes> time_steps(const std::vector<Lane>& lanes, const Stopwatch& watch, int replays) {
  const std::size_t ticks = lanes[0].path->size();
  std::vector<Stepper> steppers(lanes.begin(), lanes.end());
  const std::uint64_t heap_before = heap_calls();
  for (std::size_t i = 1; i < ticks; ++i) {
    for (Stepper& stepper : steppers)
      stepper.tick(i, watch, replays);
  }
  const std::uint64_t heap_after = heap_calls();
  std::vector<StepTimes> times;
  for (Stepper& stepper : steppers) {
    times.push_back(stepper.finish());
    times.back().heap_calls = heap_after - heap_before;
  }
  return times;
}

}  // namespace fdcg::test
