// SPDX-License-Identifier: Apache-2.0
// Runs blocks of ticks. A block is repeated, bit for bit, by (seed, case, precision, block) alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "judge.hpp"
#include "stress_case.hpp"

namespace fdcg::test {

inline constexpr std::uint32_t kBlockTicks = 20'000;

// What is made of every case's bodies and hands.
struct Variation {
  double stretch = 1;  // of the body, along one of its axes
  int axis = 0;
  bool is_frictionless = false;
};

struct BlockName {
  const StressCase* stress_case = nullptr;
  bake::Precision precision = bake::Precision::f64;
  std::uint64_t block = 0;
  std::uint64_t seed = 1;
  Variation variation = {};
};

struct BlockResult {
  std::uint64_t ticks = 0, contact_ticks = 0, transitions = 0, hash = 0, bounds_allowed = 0;
  Verdicts verdicts;

  void add(const BlockResult& other);
};

// A fault with all that leads up to it: the HIPs since the contact was new.
struct Finding {
  BlockName name;
  Fault fault = Fault::count;
  std::uint64_t tick = 0;  // of the block
  const Specimen* specimen = nullptr;
  fdcg_params params{};
  const std::vector<Hip>* path_m = nullptr;
};
using OnFinding = std::function<void(const Finding&)>;

// Makes specimens, and keeps the last: large ones serve many blocks.
class SpecimenShelf {
 public:
  // Null where the compiler refuses the body, stretched as it is.
  std::shared_ptr<const Specimen> get(const BlockName& name);

 private:
  std::uint64_t key_ = 0;
  bool has_made_ = false;
  std::shared_ptr<const Specimen> last_;
};

// `found` is called for each fault, several times for one tick where it has several.
BlockResult run_block(const BlockName& name, const Specimen& specimen, const OnFinding& found);

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word);

}  // namespace fdcg::test
