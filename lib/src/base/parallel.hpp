// SPDX-License-Identifier: Apache-2.0
// Parallel work on index ranges. Results must not depend on which thread processes which range: each range writes only its own
// results.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace fdcg::bake {

// `requested` threads, or as many as there are cores where it is 0; at most 256.
inline unsigned resolve_jobs(unsigned requested) {
  constexpr unsigned kMost = 256;
  const unsigned jobs = requested != 0 ? requested : std::thread::hardware_concurrency();
  return std::clamp(jobs, 1u, kMost);
}

// Calls work(begin, end) for ranges of at most `grain` that cover 0 .. count - 1, on `jobs` threads, and returns when all are
// done. `work` must not throw. The ranges start at multiples of `grain` whatever `jobs` is.
template <class Work>
void parallel_for(unsigned jobs, std::size_t count, std::size_t grain, const Work& work) {
  const std::size_t ranges = (count + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t r = next++; r < ranges; r = next++)
      work(r * grain, std::min(count, (r + 1) * grain));
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < std::min<std::size_t>(jobs, ranges); ++i)
    helpers.emplace_back(run);
  run();
  for (std::thread& helper : helpers)
    helper.join();
}

}  // namespace fdcg::bake
