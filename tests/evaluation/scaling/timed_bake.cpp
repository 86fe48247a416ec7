// SPDX-License-Identifier: Apache-2.0
#include "timed_bake.hpp"

#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>

namespace fdcg::test {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

double cpu_seconds_so_far() {
  timespec now = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A line of /proc/self/status in bytes ("VmHWM": most resident so far, "VmRSS": now); NaN where there is none.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.compare(0, name.size() + 1, name + ":") == 0) return 1024 * std::strtod(line.c_str() + name.size() + 1, nullptr);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// Lets VmHWM start anew from what is resident now. False where the system does not let it.
bool forget_peak() {
  malloc_trim(0);
  std::ofstream refs("/proc/self/clear_refs");
  refs << "5" << std::flush;
  return refs.good();
}

}  // namespace

TimedBake::TimedBake(const bake::PolygonSoup& soup, const bake::CompileOptions& options, double least_s) {
  constexpr int kMostRuns = 5;
  const bool can_tell_peak = forget_peak();
  const double before = status_bytes("VmRSS");
  const auto begin = Clock::now();
  for (int run = 0; run < kMostRuns && (run == 0 || seconds_between(begin, Clock::now()) < least_s); ++run) {
    bake_once(soup, options);
    if (run == 0) peak_bytes_ = can_tell_peak ? status_bytes("VmHWM") - before : std::numeric_limits<double>::quiet_NaN();
  }
  fdcg_error error = {};
  if (fdcg_open_memory(bytes_.data(), bytes_.size(), FDCG_VERIFY_TRUSTED, &view_, &error) != FDCG_OK) {
    std::fprintf(stderr, "%s: %s\n", soup.name.c_str(), error.message);
    std::exit(2);
  }
}

void TimedBake::bake_once(const bake::PolygonSoup& soup, bake::CompileOptions options) {
  bytes_ = {};
  std::vector<std::pair<std::string, Clock::time_point>> marks;
  options.progress = [&](std::string_view stage, double) { marks.emplace_back(stage, Clock::now()); };
  const double cpu_begin = cpu_seconds_so_far();
  const auto begin = Clock::now();
  auto compiled = bake::compile(soup, options);
  const auto end = Clock::now();
  cpu_seconds_ = std::min(cpu_seconds_, cpu_seconds_so_far() - cpu_begin);
  if (!compiled || !compiled->report.passes()) {
    std::fprintf(stderr, "%s\n",
                 compiled ? bake::report_text(compiled->report, false).c_str() : compiled.error().message.c_str());
    std::exit(2);
  }
  bytes_ = std::move(compiled->bytes);
  const double seconds = seconds_between(begin, end);
  if (!(seconds < seconds_)) return;
  seconds_ = seconds;
  stages_.clear();
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const double spent = seconds_between(marks[k].second, k + 1 < marks.size() ? marks[k + 1].second : end);
    if (!stages_.empty() && stages_.back().first == marks[k].first) {
      stages_.back().second += spent;
    } else {
      stages_.emplace_back(marks[k].first, spent);
    }
  }
}

double TimedBake::open_s(fdcg_verify verify, double least_s) const {
  constexpr int kMostRuns = 1000;
  double least = std::numeric_limits<double>::infinity();
  const auto begin = Clock::now();
  for (int run = 0; run < kMostRuns && (run == 0 || seconds_between(begin, Clock::now()) < least_s); ++run) {
    fdcg_graph graph;
    fdcg_error error;
    const auto start = Clock::now();
    const fdcg_status status = fdcg_open_memory(bytes_.data(), bytes_.size(), verify, &graph, &error);
    least = std::min(least, seconds_between(start, Clock::now()));
    if (status != FDCG_OK) {
      std::fprintf(stderr, "%s\n", error.message);
      std::exit(2);
    }
    fdcg_close(&graph);
  }
  return least;
}

}  // namespace fdcg::test
