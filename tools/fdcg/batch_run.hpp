// SPDX-License-Identifier: Apache-2.0
// One shard of a batch, done by worker processes; its results stand in the order of the manifest.
#pragma once

#include <cstdint>

#include "batch_folder.hpp"
#include "batch_plan.hpp"
#include "batch_shard.hpp"

namespace fdcg::tools {

struct BatchRun {
  Shard shard;
  std::string cache;               // a folder
  unsigned jobs = 0;               // worker processes; 0: one a core
  std::uint64_t memory_bytes = 0;  // of all workers; 0: what is free
  double cpu_seconds = 0;          // for one mesh; 0: no limit
  bool is_quiet = false;
};

struct BatchCounts {
  std::uint64_t meshes = 0, cached = 0;
  int exit_code = 0;  // the highest
};

// Writes the outputs and the shard's results. Fails (3) where an output or the results cannot be written: what is done stays,
// and another run goes on with it.
bake::Result<BatchCounts> run_batch(const BatchPlan& plan, const BatchFolder& folder, const BatchRun& run);

}  // namespace fdcg::tools
