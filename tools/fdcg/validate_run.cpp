// SPDX-License-Identifier: Apache-2.0
#include "validate_run.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "../common/terminal.hpp"
#include "fdcg/robot.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"

namespace fdcg::tools {
namespace {

// The findings of a baseline that were not met yet. take() may be called for different rules at the same time.
class KnownFindings {
 public:
  explicit KnownFindings(const BaselineFile* file) {
    if (file != nullptr) left_ = file->rules;
  }
  bool take(std::string_view rule, std::uint64_t fingerprint) {
    const auto prints = left_.find(std::string(rule));
    if (prints == left_.end()) return false;
    const auto print = prints->second.find(fingerprint);
    if (print == prints->second.end() || print->second == 0) return false;
    --print->second;
    return true;
  }
  // Of the rules that ran: those of the others may be there still.
  [[nodiscard]] std::map<std::string, std::uint64_t> resolved(const std::vector<std::string>& checks) const {
    std::map<std::string, std::uint64_t> totals;
    for (const std::string& rule : checks) {
      const auto prints = left_.find(rule);
      if (prints == left_.end()) continue;
      for (const auto& [print, count] : prints->second) {
        if (count != 0) totals[rule] += count;
      }
    }
    return totals;
  }

 private:
  std::map<std::string, Fingerprints> left_;
};

// A file that gave no mesh stands in the report too, under the rule that says why.
bake::Report report_of_failure(const std::string& file, const bake::Failure& failure) {
  bake::Report report;
  report.file = file;
  bake::Issue issue;
  issue.rule = failure.rule.empty() ? "unreadable" : failure.rule;
  issue.total = 1;
  issue.message = failure.message;
  report.issues.push_back(std::move(issue));
  report.checks = {"unreadable", "empty-mesh"};
  return report;
}

void refuse(Validated& result, const ValidateTask& task, const bake::Failure& failure) {
  result.report = report_of_failure(task.mesh, failure);
  result.exit_code = failure.exit_code;
  result.error = failure.message;
}

// Throws where memory runs out.
Validated judge(const ValidateTask& task, const ValidateRun& run, unsigned jobs, const bake::Progress& progress) {
  Validated result;
  const bake::ImportOptions import_options{run.input_format, progress};
  auto soup = task.problem.empty()
                  ? import_input(task.mesh, import_options)
                  : bake::Result<bake::PolygonSoup>(bake::Failure{kFile, task.mesh + ": " + task.problem, "unreadable"});
  if (soup) {
    bake::scale_soup(*soup, task.scale);
    bake::ValidateOptions options = task.options;
    options.progress = progress;
    options.jobs = jobs;
    KnownFindings known(task.known);
    if (task.has_baseline || run.wants_all_elements) {
      options.each_element = [&](std::string_view rule, bake::Element& element) {
        if (task.has_baseline) element.is_known = known.take(rule, element.fingerprint);
        if (run.wants_all_elements) result.spool.add(rule, element);
      };
    }
    result.report = bake::validate(*soup, options);
    if (task.has_baseline) result.report.resolved = known.resolved(result.report.checks);
    result.exit_code = result.report.passes() ? kClean : kFindings;
    if (run.keeps_meshes) result.soup = std::move(*soup);
  } else {
    refuse(result, task, soup.error());
  }
  return result;
}

Validated validate_one(const ValidateTask& task, const ValidateRun& run, unsigned jobs, const bake::Progress& progress) {
  const auto started = std::chrono::steady_clock::now();
  Validated result;
  try {
    result = judge(task, run, jobs, progress);
  } catch (const std::bad_alloc&) {  // one mesh too large must not cost the report of the others
    refuse(result, task, {kFile, task.mesh + ": needs more memory than there is; cut the mesh into parts", "unreadable"});
  }
  result.report.config = task.config;
  result.report.has_baseline = task.has_baseline;
  result.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return result;
}

// Hands results over in order: a thread that comes early leaves its own and goes on, but never runs far ahead.
class InOrder {
 public:
  InOrder(std::size_t window, const std::function<void(Validated&)>& deliver) : window_(window), deliver_(deliver) {}

  // False: another thread has failed, so stop.
  bool wait_for_room(std::size_t index) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return failure_ || index < next_ + window_; });
    return !failure_;
  }
  void put(std::size_t index, Validated result) {
    const std::scoped_lock lock(mutex_);
    waiting_.emplace(index, std::move(result));
    while (!failure_ && !waiting_.empty() && waiting_.begin()->first == next_) {
      deliver_(waiting_.begin()->second);
      waiting_.erase(waiting_.begin());
      ++next_;
    }
    room_.notify_all();
  }
  void fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    room_.notify_all();
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::size_t window_;
  const std::function<void(Validated&)>& deliver_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::map<std::size_t, Validated> waiting_;
  std::size_t next_ = 0;
  std::exception_ptr failure_;
};

// One bar for all threads. A single file shows its stages, several the count.
class SharedProgress {
 public:
  SharedProgress(bool enabled, std::size_t files) : bar_(enabled), files_(files) {}
  void update(std::string_view stage, double fraction) {
    const std::scoped_lock lock(mutex_);
    if (files_ == 1) return bar_.update(stage, fraction);
    bar_.update(grouped(done_) + " of " + grouped(files_) + " files", static_cast<double>(done_) / static_cast<double>(files_));
  }
  void file_done() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    bar_.wipe();
  }

 private:
  std::mutex mutex_;
  ProgressBar bar_;
  std::size_t files_, done_ = 0;
};

}  // namespace

void validate_all(const ValidateRun& run, const std::function<void(Validated&)>& deliver) {
  constexpr std::size_t kAhead = 4;  // results that may wait for an earlier one, a thread
  const std::size_t count = run.tasks.size();
  const unsigned jobs = run.jobs != 0 ? run.jobs : std::max(1u, std::thread::hardware_concurrency());
  const auto workers = static_cast<unsigned>(std::min<std::size_t>(jobs, count));
  const unsigned jobs_each = std::max(1u, jobs / std::max(1u, workers));
  SharedProgress bar(run.shows_progress, count);
  const bake::Progress progress = [&bar](std::string_view stage, double fraction) { bar.update(stage, fraction); };
  const auto deliver_clean = std::function<void(Validated&)>([&](Validated& result) {
    bar.file_done();
    deliver(result);
  });
  InOrder order(kAhead * workers, deliver_clean);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count && order.wait_for_room(i); i = next++)
        order.put(i, validate_one(run.tasks[i], run, jobs_each, progress));
    } catch (...) {
      order.fail(std::current_exception());
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < workers; ++i)
    helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers)
    helper.join();
  order.rethrow();
}

}  // namespace fdcg::tools
