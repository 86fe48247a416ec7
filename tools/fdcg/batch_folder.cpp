// SPDX-License-Identifier: Apache-2.0
#include "batch_folder.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "../common/atomic_file.hpp"
#include "../common/program.hpp"
#include "fdcg/fdcg.h"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

std::string plan_text(const BatchPlan& plan) {
  const nlohmann::ordered_json json{
      {"fdcg_batch", 1}, {"version", FDCG_VERSION_STRING}, {"plan", plan.digest}, {"meshes", plan.tasks.size()}};
  return json.dump() + "\n";
}

bake::Failure cannot_make(const std::string& folder, const std::error_code& error) {
  return {kFile, "cannot make the folder '" + folder + "': " + error.message(), {}};
}

}  // namespace

std::optional<bake::Failure> BatchFolder::open(const BatchPlan& plan, const Shard& shard, bool resumes) {
  const std::string inside = fs::path(path_ + "/").lexically_normal().string();
  for (const BatchTask& task : plan.tasks) {
    if (!task.mesh.starts_with(inside) || inside == "./") continue;
    return bake::Failure{kUsage,
                         "'" + printable(task.mesh) +
                             "' lies in the folder of the results; name it not in the manifest, or another "
                             "folder with -o",
                         {}};
  }
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) return cannot_make(path_, error);
  const std::string text = plan_text(plan);
  if (std::ifstream file{this->plan(), std::ios::binary}) {
    std::ostringstream there;
    there << file.rdbuf();
    if (there.str() != text)
      return bake::Failure{kUsage,
                           "'" + path_ +
                               "' has a batch of other meshes, rules or another version of fdcg; name another folder "
                               "with -o (--cache may stay the same)",
                           {}};
  } else {
    AtomicFile out(this->plan(), this->plan() + "." + unique_name());
    out.write(text);
    if (!out.commit()) return bake::Failure{kFile, out.error(), {}};
  }
  const bool is_begun = fs::exists(this->shard(shard), error) || fs::exists(unfinished(shard.name()), error) ||
                        (shard.of == 1 && fs::exists(results(), error));
  if (is_begun && !resumes) {
    return bake::Failure{kUsage,
                         "'" + path_ +
                             "' has results of this batch already, or a part of them; --resume goes on with them, or "
                             "name another folder",
                         {}};
  }
  return std::nullopt;
}

UnfinishedFolder::UnfinishedFolder(const BatchFolder& folder, const std::string& who) : path_(folder.unfinished(who)) {
  std::error_code error;
  do {
    fs::create_directories(path_, error);
    lock_ = std::make_unique<FolderLock>(path_ + "/lock");
    trouble_ = error ? cannot_make(path_, error).message : lock_->trouble();
  } while (trouble_.empty() && lock_->is_removed());
  if (!trouble_.empty()) return;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().filename() != "lock") fs::remove(entry->path(), ignored);
  }
}

UnfinishedFolder::~UnfinishedFolder() = default;

void UnfinishedFolder::finish() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  fs::remove(fs::path(path_).parent_path(), ignored);  // if it is empty
}

}  // namespace fdcg::tools
