// SPDX-License-Identifier: Apache-2.0
#include "batch_shard.hpp"

#include <charconv>
#include <string_view>

#include "../common/program.hpp"

namespace fdcg::tools {
namespace {

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t value = 0;
  const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stopped != text.data() + text.size()) return std::nullopt;
  return value;
}

bake::Failure wrong_shard(const std::string& message) {
  return {kUsage, message, {}};
}

// How an engine says which task of an array this is: from `first` (a number, or a variable) in steps, to `last` or `count` of
// them.
struct Engine {
  const char* index;
  const char* first;  // "0", "1", or a variable
  const char* step;   // null: 1
  const char* last;   // null: there is a count
  const char* count;
};
constexpr Engine kEngines[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP", nullptr, "SLURM_ARRAY_TASK_COUNT"},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_STEPSIZE", "SGE_TASK_LAST", nullptr},
    {"LSB_JOBINDEX", "1", "LSB_JOBINDEX_STEP", "LSB_JOBINDEX_END", nullptr},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "0", nullptr, nullptr, "AWS_BATCH_JOB_ARRAY_SIZE"},
    {"BATCH_TASK_INDEX", "0", nullptr, nullptr, "BATCH_TASK_COUNT"},
    {"CLOUD_RUN_TASK_INDEX", "0", nullptr, nullptr, "CLOUD_RUN_TASK_COUNT"},
    {"CI_NODE_INDEX", "1", nullptr, nullptr, "CI_NODE_TOTAL"},
    {"BUILDKITE_PARALLEL_JOB", "0", nullptr, nullptr, "BUILDKITE_PARALLEL_JOB_COUNT"},
    {"CIRCLE_NODE_INDEX", "0", nullptr, nullptr, "CIRCLE_NODE_TOTAL"},
};

std::optional<std::size_t> number_of(const Variables& variables, const char* name) {
  if (const auto constant = whole_number(name)) return constant;
  const auto text = variables(name);
  return text ? whole_number(*text) : std::nullopt;
}

bake::Result<Shard> shard_by(const Engine& engine, std::size_t index, const Variables& variables) {
  const std::string retry = std::string(engine.index) + " is " + std::to_string(index) + ", ";
  const char* const end = engine.count != nullptr ? engine.count : engine.last;
  const auto first = number_of(variables, engine.first), last = number_of(variables, end);
  const std::size_t step = engine.step == nullptr ? 1 : number_of(variables, engine.step).value_or(1);
  if (!first || !last || step == 0)
    return wrong_shard(retry + "but " + (first ? end : engine.first) + " does not say how many there are; give --shard I/N");
  const std::size_t count = engine.count != nullptr ? *last : *last < *first ? 0 : (*last - *first) / step + 1;
  const std::size_t number = index < *first ? 0 : (index - *first) / step + 1;
  if (number < 1 || number > count || (index - *first) % step != 0 || count > kMostShards)
    return wrong_shard(retry + "which is none of " + std::to_string(count) + " from " + std::to_string(*first) +
                       " on; an array with gaps needs --shard I/N");
  return Shard{number, count, engine.index};
}

}  // namespace

bake::Result<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto number = whole_number(std::string_view(text).substr(0, slash));
  const auto of = slash == std::string::npos ? std::nullopt : whole_number(std::string_view(text).substr(slash + 1));
  if (!number || !of) return wrong_shard("'" + text + "' is no shard; write 2/4 for the second of four");
  if (*of < 1 || *of > kMostShards)
    return wrong_shard("'" + text + "': the number of shards must be from 1 to " + std::to_string(kMostShards));
  if (*number < 1 || *number > *of) return wrong_shard("'" + text + "': shards are numbered from 1 to " + std::to_string(*of));
  return Shard{*number, *of, {}};
}

bake::Result<Shard> shard_of(const Variables& variables) {
  for (const Engine& engine : kEngines) {
    const auto text = variables(engine.index);
    const auto index = text ? whole_number(*text) : std::nullopt;  // Grid Engine says "undefined" where there is no array
    if (!index || (std::string_view(engine.index) == "LSB_JOBINDEX" && *index == 0)) continue;
    return shard_by(engine, *index, variables);
  }
  return Shard{};
}

}  // namespace fdcg::tools
