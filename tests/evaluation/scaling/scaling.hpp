// SPDX-License-Identifier: Apache-2.0
// The three parts of fdcg_bench_scaling, and what they share.
#pragma once

#include <cstdint>
#include <string>

#include "stopwatch.hpp"
#include "table.hpp"

namespace fdcg::test {

struct ScalingRun {
  bool is_quick = false;
  std::string output;  // folder
  std::uint64_t seed = 1;
  Stopwatch watch;
  Bars* bars = nullptr;
  Table* exponents = nullptr;  // table, body, precision, planes, quantity, from, to, exponent
};

// By the mesh's size: bake, memory, file, opening, step; and f32 against f64.
void scale_faces(const ScalingRun& run);
// By the number of contacts, on one graph and in a scene.
void scale_contacts(const ScalingRun& run);
// By the number of objects in a scene.
void scale_objects(const ScalingRun& run);

}  // namespace fdcg::test
