// SPDX-License-Identifier: Apache-2.0
// The results of all shards as those of one run: results.jsonl, report.json, report.sarif.
#pragma once

#include <cstddef>

#include "batch_folder.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct BatchTotals {
  std::uint64_t meshes = 0, clean = 0, with_findings = 0, failed = 0;
  int exit_code = 0;  // the highest of all meshes
};

// Fails (3) where a shard's results are missing, incomplete or of another batch, or the files cannot be written; (2) where
// there are shards of two numbers.
bake::Result<BatchTotals> merge_shards(const BatchFolder& folder);

}  // namespace fdcg::tools
