// SPDX-License-Identifier: Apache-2.0
// The folder of a batch: what stands where, and the lock of who writes it. docs/batch.md describes it.
#pragma once

#include <memory>
#include <string>

#include "batch_plan.hpp"
#include "batch_process.hpp"
#include "batch_shard.hpp"

namespace fdcg::tools {

class BatchFolder {
 public:
  explicit BatchFolder(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string outputs() const { return path_ + "/files"; }
  [[nodiscard]] std::string cache() const { return path_ + "/cache"; }
  [[nodiscard]] std::string plan() const { return path_ + "/plan.json"; }
  [[nodiscard]] std::string shards() const { return path_ + "/shards"; }
  [[nodiscard]] std::string shard(const Shard& shard) const { return shards() + "/" + shard.name() + ".jsonl"; }
  [[nodiscard]] std::string results() const { return path_ + "/results.jsonl"; }
  [[nodiscard]] std::string report() const { return path_ + "/report.json"; }
  [[nodiscard]] std::string sarif() const { return path_ + "/report.sarif"; }
  [[nodiscard]] std::string unfinished(const std::string& who) const { return path_ + "/unfinished/" + who; }

  // Makes the folder, or finds it as an earlier run of the same plan left it: an error where that was of another one (2), or
  // where this shard has been begun and `resumes` is false (2).
  std::optional<bake::Failure> open(const BatchPlan& plan, const Shard& shard, bool resumes);

 private:
  std::string path_;
};

// Takes the folder of unfinished files of a shard or of the merging for this process, and empties it. Removed at the end.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const BatchFolder& folder, const std::string& who);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // empty: it is ours
  [[nodiscard]] const std::string& path() const { return path_; }
  void finish();  // nothing is left to go on with: the folder may go

 private:
  std::string path_;
  std::unique_ptr<FolderLock> lock_;
  std::string trouble_;
};

}  // namespace fdcg::tools
