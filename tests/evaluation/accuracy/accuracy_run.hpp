// SPDX-License-Identifier: Apache-2.0
// One run of fdcg_bench_accuracy: a body, how it is compiled, friction, a way, and the reference that judges it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fdcg/bake.hpp"
#include "hip_walk.hpp"

namespace fdcg::test {

enum class Judge {
  long_double,  // replay in 64 bits of mantissa
  mpfr_256,     // replay in 256
  certificate   // exact rationals, from the principle alone; without friction
};
const char* name_of(Judge judge);

struct AccuracySetting {
  std::string body, way;
  const bake::PolygonSoup* soup = nullptr;  // metres; not yet moved
  const std::vector<Hip>* hips = nullptr;   // the way, for the body where it lies; null: HipWalk
  bake::Precision precision = bake::Precision::f64;
  bool is_stored = true, is_merged = true;
  double mu_static = 0, mu_dynamic = 0;
  double offset_sizes = 0;  // how far the body is moved from the world's origin, in its own size
  std::uint64_t steps = 0, seed = 1;
  Judge judge = Judge::long_double;
};

struct AccuracyOutcome {
  std::uint64_t steps = 0, contact_steps = 0, ties = 0, carried = 0, wrong_features = 0;
  std::uint64_t ties_explained = 0, ties_unexplained = 0;
  std::vector<float> one_step_ulps, accumulated_ulps;  // the latter not of a certificate
  std::vector<float>
      at_rim_ulps;  // of a certificate, and not in the first: over 8, on a side of the face, as FACE-5 allows there
  std::vector<std::pair<float, float>> error_and_conditioning;
  double worst_conditioning = 1;
  double deviation_ulps = 0;  // header.max_deviation
  std::string first_wrong, first_unexplained, worst;
};

// Throws std::runtime_error where the compiler refuses the body.
AccuracyOutcome run(const AccuracySetting& setting);

// Nearest rank; 0 of none. Sorts.
double percentile(std::vector<float>& values, double part);

}  // namespace fdcg::test
