// SPDX-License-Identifier: Apache-2.0
// The three parts of fdcg_bench_scaling, and what they share.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "stopwatch.hpp"
#include "table.hpp"

namespace fdcg::test {

struct ScalingRun {
  bool is_quick = false;
  std::string output;  // folder
  std::uint64_t seed = 1;
  Stopwatch watch;
  bool judges_times = true;  // false: times are bars to be read, not to fail
  Bars* bars = nullptr;
  Table* exponents = nullptr;  // table, body, precision, planes, quantity, from, to, exponent
};

// A bar on times, or on what was fitted to times.
inline void judge_time(const ScalingRun& run, const std::string& bar, double measured, double limit, const std::string& unit,
                       const std::string& note = "") {
  if (run.judges_times) {
    run.bars->at_most(bar, measured, limit, unit, note);
  } else {
    std::printf("     %s: %s %s (at most %s, not judged); %s\n", bar.c_str(), cell(measured).c_str(), unit.c_str(),
                cell(limit).c_str(), note.c_str());
  }
}

// By the mesh's size: bake, memory, file, opening, step; and f32 against f64.
void scale_faces(const ScalingRun& run);
// By the number of contacts, on one graph and in a scene.
void scale_contacts(const ScalingRun& run);
// By the number of objects in a scene.
void scale_objects(const ScalingRun& run);

}  // namespace fdcg::test
