// SPDX-License-Identifier: Apache-2.0
// The part of a batch that one of several runs does.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct Shard {
  std::size_t number = 1, of = 1;  // 1 <= number <= of
  std::string source;              // the variable of the environment that it is from; empty: none

  // Neighbours in a library are alike, so they are dealt out in turn.
  [[nodiscard]] bool has(std::size_t task) const { return task % of == number - 1; }
  [[nodiscard]] std::size_t count(std::size_t tasks) const { return (tasks + of - number) / of; }
  [[nodiscard]] std::string name() const { return std::to_string(number) + "-of-" + std::to_string(of); }
};

inline constexpr std::size_t kMostShards = 10'000;

// "2/4". Fails (2) on anything else.
bake::Result<Shard> parse_shard(const std::string& text);

// That of an engine's array of tasks, which the environment has: Slurm, Grid Engine, LSF, AWS Batch, Google's Batch and Cloud
// Run, GitLab, Buildkite, CircleCI. Without one the whole batch. Fails (2) where the variables contradict one another.
using Variables = std::function<std::optional<std::string>(const char* name)>;
bake::Result<Shard> shard_of(const Variables& variables);

}  // namespace fdcg::tools
