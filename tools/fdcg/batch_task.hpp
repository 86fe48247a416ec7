// SPDX-License-Identifier: Apache-2.0
// One mesh of a batch: from the cache, or done and put there.
#pragma once

#include <string>

#include "batch_cache.hpp"
#include "batch_plan.hpp"

namespace fdcg::tools {

struct BatchResult {
  int exit_code = 0;
  bool is_fatal = false;      // an output cannot be written: the run ends, `said` says why
  bool is_cached = false;     // it was in the cache
  std::string line;           // of the results, without its end
  std::string said;           // for people: one line without the mesh's name; empty: nothing was found
  std::string cache_trouble;  // why the cache cannot be written
};

std::string packed_result(const BatchResult& result);
BatchResult unpacked_result(const std::string& bytes);

// Of a mesh that nothing could be made of; the report has it under the failure's rule, or "not-compiled" and the like.
BatchResult failed_result(const BatchTask& task, const BatchPlan& plan, const bake::Failure& why);

struct BatchPlace {
  std::string outputs;     // the folder that BatchTask::output is in
  std::string unfinished;  // a folder on the same file system for files that are being written
  unsigned jobs = 1;       // threads
};

// Never throws. Same bytes, same options, same program: the same result.
BatchResult do_batch_task(const BatchTask& task, const BatchPlan& plan, const BatchPlace& place, BatchCache& cache);

}  // namespace fdcg::tools
