// SPDX-License-Identifier: Apache-2.0
#include "batch_run.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "../common/atomic_file.hpp"
#include "../common/program.hpp"
#include "../common/terminal.hpp"
#include "batch_process.hpp"
#include "batch_task.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSmallFile = 1 << 20;
constexpr std::size_t kMostWaiting = std::size_t{64} << 20;  // bytes of results that wait for an earlier one

// What a mesh takes while it is compiled: some 20 times a compact binary file, less of a text, and what a worker has anyway.
std::uint64_t memory_for(std::uint64_t file_bytes) {
  constexpr std::uint64_t kPerByte = 24, kBase = std::uint64_t{32} << 20;
  return kBase + kPerByte * file_bytes;
}

// Gives the tasks of a shard to workers, and takes their results in order.
class ShardRun {
 public:
  ShardRun(const BatchPlan& plan, const BatchFolder& folder, const BatchRun& run, std::string unfinished)
      : plan_(plan), run_(run), unfinished_(std::move(unfinished)), bar_(!run.is_quiet) {
    for (std::size_t i = 0; i < plan.tasks.size(); ++i)
      if (run.shard.has(i)) tasks_.push_back(i);
    const std::size_t cores = run.jobs != 0 ? run.jobs : std::max(1u, std::thread::hardware_concurrency());
    limits_.workers = static_cast<unsigned>(std::clamp<std::size_t>(tasks_.size(), 1, cores));
    limits_.cpu_seconds = run.cpu_seconds;
    limits_.memory_bytes = run.memory_bytes != 0 ? run.memory_bytes : free_memory() / 10 * 9;
    place_ = {folder.outputs(), unfinished_, static_cast<unsigned>(std::max<std::size_t>(1, cores / limits_.workers))};
  }

  bake::Result<BatchCounts> run(AtomicFile& results) {
    BatchCache cache(run_.cache);
    BatchWorkers workers(
        limits_, [&](std::size_t task) { return packed_result(do_batch_task(plan_.tasks[task], plan_, place_, cache)); });
    while (delivered_ < tasks_.size()) {
      give(workers);
      for (const WorkerAnswer& answer : workers.wait())
        take(answer);
      deliver(results);
      bar_.update(grouped(delivered_) + " of " + grouped(tasks_.size()) + " meshes",
                  static_cast<double>(delivered_) / static_cast<double>(tasks_.size()));
      if (!fatal_.empty()) return bake::Failure{kFile, fatal_ + "; make room for it and go on with --resume", {}};
      if (!results.ok()) return bake::Failure{kFile, results.error(), {}};
    }
    bar_.wipe();
    return counts_;
  }

 private:
  void give(BatchWorkers& workers) {
    while (next_ < tasks_.size() && waiting_bytes_ < kMostWaiting) {
      std::error_code ignored;
      const std::uintmax_t size = fs::file_size(plan_.tasks[tasks_[next_]].mesh, ignored);
      const std::uint64_t bytes = size == static_cast<std::uintmax_t>(-1) ? 0 : size;
      const std::uint64_t need = memory_for(bytes);
      const bool is_small = bytes <= kSmallFile;
      const bool has_room = taken_memory_ == 0 || limits_.memory_bytes == 0 || taken_memory_ + need <= limits_.memory_bytes;
      if (!has_room || !workers.can_take(is_small)) return;
      workers.give(tasks_[next_++], is_small);
      memory_of_.emplace(tasks_[next_ - 1], need);
      taken_memory_ += need;
    }
  }
  void take(const WorkerAnswer& answer) {
    const auto memory = memory_of_.find(answer.task);
    taken_memory_ -= memory->second;
    memory_of_.erase(memory);
    const BatchTask& task = plan_.tasks[answer.task];
    BatchResult result = answer.trouble.empty()
                             ? unpacked_result(answer.bytes)
                             : failed_result(task, plan_, {answer.is_our_fault ? kInternal : kFile, answer.trouble, {}});
    if (!result.cache_trouble.empty() && !std::exchange(is_cache_told_, true))
      warn("the cache does not keep what is done, so that --resume would do it again: " + result.cache_trouble);
    if (result.is_fatal) fatal_ = result.said;
    waiting_bytes_ += result.line.size();
    waiting_.emplace(answer.task, std::move(result));
  }
  void deliver(AtomicFile& results) {
    while (!waiting_.empty() && waiting_.begin()->first == tasks_[delivered_]) {
      const auto& [index, result] = *waiting_.begin();
      results.write(result.line + "\n");
      tell(plan_.tasks[index], result);
      waiting_bytes_ -= result.line.size();
      ++counts_.meshes;
      counts_.cached += result.is_cached ? 1 : 0;
      counts_.exit_code = std::max(counts_.exit_code, result.exit_code);
      waiting_.erase(waiting_.begin());
      ++delivered_;
    }
  }
  void tell(const BatchTask& task, const BatchResult& result) {
    if (result.exit_code == kClean) return;
    bar_.wipe();
    const std::string line = printable(task.mesh) + ": " + result.said;
    if (result.exit_code == kFindings) {
      if (!run_.is_quiet) std::puts(line.c_str());
    } else {
      std::fputs(("fdcg: " + line + "\n").c_str(), stderr);
    }
  }

  const BatchPlan& plan_;
  const BatchRun& run_;
  std::string unfinished_;
  BatchPlace place_;
  WorkerLimits limits_;
  ProgressBar bar_;
  std::vector<std::size_t> tasks_;  // of the shard, in the order of the plan
  std::size_t next_ = 0, delivered_ = 0;
  std::map<std::size_t, BatchResult> waiting_;
  std::map<std::size_t, std::uint64_t> memory_of_;  // of tasks that were given
  std::uint64_t taken_memory_ = 0;
  std::size_t waiting_bytes_ = 0;
  bool is_cache_told_ = false;
  std::string fatal_;
  BatchCounts counts_;
};

}  // namespace

bake::Result<BatchCounts> run_batch(const BatchPlan& plan, const BatchFolder& folder, const BatchRun& run) {
  UnfinishedFolder unfinished(folder, run.shard.name());
  if (!unfinished.trouble().empty()) return bake::Failure{kFile, unfinished.trouble(), {}};
  std::error_code error;
  fs::create_directories(folder.shards(), error);
  if (error) return bake::Failure{kFile, "cannot make the folder '" + folder.shards() + "': " + error.message(), {}};
  AtomicFile results(folder.shard(run.shard), unfinished.path() + "/results");
  const nlohmann::ordered_json head{{"fdcg_batch", 1},
                                    {"plan", plan.digest},
                                    {"shard", run.shard.number},
                                    {"of", run.shard.of},
                                    {"meshes", plan.tasks.size()}};
  results.write(head.dump() + "\n");
  const auto counts = ShardRun(plan, folder, run, unfinished.path()).run(results);
  if (!counts) return counts;
  if (!results.commit()) return bake::Failure{kFile, results.error(), {}};
  unfinished.finish();
  return counts;
}

}  // namespace fdcg::tools
