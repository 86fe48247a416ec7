// SPDX-License-Identifier: Apache-2.0
// Worker processes, locks and names of a batch. batch_process_posix.cpp implements them; another platform needs another file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace fdcg::tools {

// Of this process on all machines: "node3-4711".
std::string unique_name();
// Of the program's file as it was linked; empty where the linker left none.
std::string build_identity();
// Bytes that this process may take: what is free, or what its container or its job is limited to.
std::uint64_t free_memory();

// As many open files at once as the system lets a process have.
void allow_many_files();

// Held while the object lives, and by its process's children.
class FolderLock {
 public:
  // Waits for a holder to end, for some seconds.
  explicit FolderLock(const std::string& file);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // empty: it is held
  [[nodiscard]] bool is_removed() const;  // the holder before has removed the file: it guards nothing

 private:
  std::string file_;
  int descriptor_ = -1;
  std::string trouble_;
};

struct WorkerLimits {
  unsigned workers = 1;
  std::uint64_t memory_bytes = 0;  // that one worker may take; 0: no limit
  double cpu_seconds = 0;          // of processor time for one task; 0: no limit
};

struct WorkerAnswer {
  std::size_t task = 0;
  std::string bytes;    // what the work returned
  std::string trouble;  // else: why there is nothing, a phrase that follows the task's name
  bool is_our_fault = false;
};

// Processes that do one task after the other, forked from this one, which must have no other thread: what they know is what it
// knew. One that crashes or takes too long costs its task alone: another takes its place. They end with this process.
class BatchWorkers {
 public:
  using Work = std::function<std::string(std::size_t task)>;  // in a worker; must not throw

  BatchWorkers(const WorkerLimits& limits, Work work);
  ~BatchWorkers();
  BatchWorkers(const BatchWorkers&) = delete;
  BatchWorkers& operator=(const BatchWorkers&) = delete;

  [[nodiscard]] bool can_take(bool is_small) const;
  void give(std::size_t task, bool is_small);
  // The next answers, in any order; none where nothing came for a tenth of a second.
  std::vector<WorkerAnswer> wait();
  [[nodiscard]] bool is_idle() const;

 private:
  struct Given {
    std::size_t task = 0;
    bool is_small = false;
  };
  struct Worker {
    int pid = 0;
    int channel = -1;
    std::deque<Given> tasks;  // given and not answered; it is at the first
    std::string received;
    double cpu_at_start = 0;  // of the first
  };

  void start(Worker& worker);
  [[noreturn]] void serve(int channel) const;
  void take_answers(Worker& worker, std::vector<WorkerAnswer>& answers);
  void replace(Worker& worker, std::vector<WorkerAnswer>& answers, const std::string& trouble, bool is_our_fault);
  void stop_overdue(std::vector<WorkerAnswer>& answers);
  [[nodiscard]] const Worker* least_busy(bool is_small) const;

  WorkerLimits limits_;
  Work work_;
  std::vector<Worker> workers_;
  std::string chunk_;  // what one read takes
};

}  // namespace fdcg::tools
