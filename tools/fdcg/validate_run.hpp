// SPDX-License-Identifier: Apache-2.0
// Validates many files on a few threads; reports come in order, and few wait in memory.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "baseline.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct ValidateTask {
  std::string mesh;
  std::string problem;        // why there is no such file; then it is not read
  bake::Vec3 scale{1, 1, 1};  // at which it is checked
  std::string config;         // the file that some of `options` came from
  bake::ValidateOptions options;
  bool has_baseline = false;
  const BaselineFile* known = nullptr;  // of the baseline; null: it does not have this mesh
};

struct ValidateRun {
  std::vector<ValidateTask> tasks;
  std::optional<bake::Format> input_format;  // default: by content
  unsigned jobs = 0;                         // threads; 0: one a core
  bool wants_all_elements = false;
  bool keeps_meshes = false;
  bool shows_progress = false;
};

struct Validated {
  bake::Report report;
  int exit_code = 0;                      // of this file alone
  std::string error;                      // one line; why there was no mesh
  bake::ElementSpool spool;               // with wants_all_elements
  std::optional<bake::PolygonSoup> soup;  // with keeps_meshes, where there is one
};

// `deliver` gets each file's result in the order of the tasks, one at a time, perhaps from several threads. What it and the
// library throw is thrown again here, once all threads have ended.
void validate_all(const ValidateRun& run, const std::function<void(Validated&)>& deliver);

}  // namespace fdcg::tools
