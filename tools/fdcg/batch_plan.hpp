// SPDX-License-Identifier: Apache-2.0
// What a batch has to do: the meshes that its manifests name, each with the first rule that takes it. docs/batch.md has the
// manifests.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "batch_rule.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct BatchTask {
  std::string mesh;           // as the manifest or its pattern has it, without "." and ".." that can be left out
  std::string problem;        // why there is no such file; then it is not read
  bake::Vec3 scale{1, 1, 1};  // of a robot's description
  std::string robot;          // the description that names it; empty: none
  std::size_t rule = 0;
  std::string output;  // below the folder of the outputs; empty: none
};

struct BatchPlan {
  std::vector<BatchRule> rules;  // the last takes every mesh
  std::vector<BatchTask> tasks;
  std::vector<std::string> notes;  // for people, one line each
  std::string digest;              // of all that the results depend on but for the files' bytes
};

// Fails (3) on a manifest that cannot be read, (2) on one that says something wrong, or where two meshes would be written to
// one file; the message names file and place.
bake::Result<BatchPlan> read_batch_plan(const std::vector<std::string>& manifests);

}  // namespace fdcg::tools
