// SPDX-License-Identifier: Apache-2.0
// Worker processes by fork(): a task costs one message each way, and what a worker does to itself stays in it.
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "../common/atomic_file.hpp"
#include "../common/heap.hpp"
#include "../common/terminal.hpp"
#include "batch_process.hpp"

namespace fdcg::tools {
namespace {

constexpr std::size_t kAhead = 4;  // small tasks that a worker has, so that it need not wait for the next
constexpr int kTick_ms = 100;

bool write_all(int descriptor, const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::send(descriptor, at, bytes, MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int descriptor, void* data, std::size_t bytes) {
  char* at = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t got = ::read(descriptor, at, bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

double cpu_seconds_of(int pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The first number of a file; 0: none.
std::uint64_t number_in(const char* path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? number : 0;
}

int find_build_id(dl_phdr_info* info, std::size_t, void* result) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& header = info->dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    const auto* at = reinterpret_cast<const unsigned char*>(info->dlpi_addr + header.p_vaddr);
    const unsigned char* const end = at + header.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) < end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
      const unsigned char* const name = at + sizeof note;
      const unsigned char* const content = name + padded(note.n_namesz);
      if (note.n_type == NT_GNU_BUILD_ID && content + note.n_descsz <= end) {
        static_cast<std::string*>(result)->assign(reinterpret_cast<const char*>(content), note.n_descsz);
        return 1;
      }
      at = content + padded(note.n_descsz);
    }
  }
  return 1;  // the program itself comes first
}

}  // namespace

std::string unique_name() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return std::string(host) + "-" + std::to_string(getpid());
}

std::string build_identity() {
  std::string bytes, text;
  dl_iterate_phdr(find_build_id, &bytes);
  for (const char c : bytes)
    for (const int digit : {static_cast<unsigned char>(c) >> 4, static_cast<unsigned char>(c) & 15})
      text += "0123456789abcdef"[digit];
  return text;
}

std::uint64_t free_memory() {
  std::uint64_t least = 0;
  const auto consider = [&least](std::uint64_t bytes) {
    if (bytes != 0 && (least == 0 || bytes < least)) least = bytes;
  };
  std::ifstream file("/proc/meminfo");
  for (std::string name, unit; file >> name;) {
    std::uint64_t kib = 0;
    file >> kib;
    std::getline(file, unit);
    if (name == "MemAvailable:") consider(kib << 10);
  }
  consider(number_in("/sys/fs/cgroup/memory.max"));
  if (const char* const megabytes = std::getenv("SLURM_MEM_PER_NODE")) consider(std::strtoull(megabytes, nullptr, 10) << 20);
  return least;
}

void allow_many_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

FolderLock::FolderLock(const std::string& file) : file_(file) {
  constexpr int kTries = 100;
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    trouble_ = "cannot write '" + file + "': " + std::strerror(errno);
    return;
  }
  for (int i = 0; flock(descriptor_, LOCK_EX | LOCK_NB) != 0; ++i) {  // the workers of a run that was killed are ending
    if (errno != EWOULDBLOCK && errno != EINTR) return;               // a file system without locks: nothing can be known
    if (i == kTries) {
      trouble_ = "another run holds '" + file + "'; let it end, or give this one another folder";
      return;
    }
    poll(nullptr, 0, kTick_ms);
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool FolderLock::is_removed() const {
  struct stat held {
  }, there{};
  return fstat(descriptor_, &held) == 0 && (stat(file_.c_str(), &there) != 0 || held.st_ino != there.st_ino);
}

BatchWorkers::BatchWorkers(const WorkerLimits& limits, Work work) : limits_(limits), work_(std::move(work)) {
  workers_.resize(limits.workers);
  for (Worker& worker : workers_)
    start(worker);
}

BatchWorkers::~BatchWorkers() {
  for (const Worker& worker : workers_) {
    if (!worker.tasks.empty()) kill(worker.pid, SIGTERM);
    close(worker.channel);  // an idle one ends by this
  }
  for (const Worker& worker : workers_)
    waitpid(worker.pid, nullptr, 0);
}

void BatchWorkers::start(Worker& worker) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::runtime_error(std::string("no channel to a worker: ") + std::strerror(errno));
  const int parent = getpid();
  const int pid = fork();
  if (pid < 0) throw std::runtime_error(std::string("no worker process: ") + std::strerror(errno));
  if (pid == 0) {
    forget_unfinished_files();
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(0);
    close(ends[0]);
    for (const Worker& other : workers_)
      if (other.channel >= 0) close(other.channel);
    serve(ends[1]);
  }
  close(ends[1]);
  worker = {};
  worker.pid = pid;
  worker.channel = ends[0];
}

// In the worker.
void BatchWorkers::serve(int channel) const {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose shadow memory counts too
  if (limits_.memory_bytes != 0) {
    const rlimit limit{limits_.memory_bytes, limits_.memory_bytes};
    setrlimit(RLIMIT_DATA, &limit);
  }
#endif
  constexpr int kKept = 16 << 20;  // less than what a task is taken to need anyway
  keep_heap_top(kKept);
  for (std::uint64_t task = 0; read_all(channel, &task, sizeof task);) {
    const std::string answer = work_(task);
    const std::uint64_t bytes = answer.size();
    if (!write_all(channel, &bytes, sizeof bytes) || !write_all(channel, answer.data(), answer.size())) break;
  }
  _exit(0);
}

const BatchWorkers::Worker* BatchWorkers::least_busy(bool is_small) const {
  const Worker* best = nullptr;
  for (const Worker& worker : workers_) {
    const bool is_ready = worker.tasks.empty() || (is_small && worker.tasks.size() < kAhead && worker.tasks.front().is_small);
    if (is_ready && (best == nullptr || worker.tasks.size() < best->tasks.size())) best = &worker;
  }
  return best;
}

bool BatchWorkers::can_take(bool is_small) const {
  return least_busy(is_small) != nullptr;
}

bool BatchWorkers::is_idle() const {
  return std::all_of(workers_.begin(), workers_.end(), [](const Worker& worker) { return worker.tasks.empty(); });
}

void BatchWorkers::give(std::size_t task, bool is_small) {
  Worker& worker = workers_[static_cast<std::size_t>(least_busy(is_small) - workers_.data())];
  if (worker.tasks.empty()) worker.cpu_at_start = cpu_seconds_of(worker.pid);
  worker.tasks.push_back({task, is_small});
  const std::uint64_t number = task;
  static_cast<void>(write_all(worker.channel, &number, sizeof number));  // one that has ended is met by wait()
}

std::vector<WorkerAnswer> BatchWorkers::wait() {
  std::vector<WorkerAnswer> answers;
  std::vector<pollfd> channels;
  for (const Worker& worker : workers_)
    channels.push_back({worker.channel, POLLIN, 0});
  if (poll(channels.data(), channels.size(), kTick_ms) > 0) {
    for (std::size_t i = 0; i < workers_.size(); ++i)
      if (channels[i].revents != 0) take_answers(workers_[i], answers);
  }
  if (answers.empty() && limits_.cpu_seconds > 0) stop_overdue(answers);
  return answers;
}

void BatchWorkers::take_answers(Worker& worker, std::vector<WorkerAnswer>& answers) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  chunk_.resize(kChunk);
  ssize_t got = 0;
  do
    got = ::read(worker.channel, chunk_.data(), kChunk);
  while (got < 0 && errno == EINTR);
  worker.received.append(chunk_, 0, static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got <= 0) {
    int status = 0;
    waitpid(worker.pid, &status, 0);
    const bool is_killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    return replace(worker, answers,
                   is_killed ? "its worker was killed, as the system does where memory runs out; give the batch fewer --jobs "
                               "or less --memory, or cut the mesh into parts"
                   : WIFSIGNALED(status) ? std::string("the program crashed on it (") + strsignal(WTERMSIG(status)) +
                                               "); please report this fault"
                                         : "the program ended on it; please report this fault",
                   !is_killed);
  }
  std::size_t at = 0;
  for (std::uint64_t bytes = 0; worker.received.size() - at >= sizeof bytes; at += sizeof bytes + bytes) {
    std::memcpy(&bytes, worker.received.data() + at, sizeof bytes);
    if (worker.received.size() - at - sizeof bytes < bytes || worker.tasks.empty()) break;
    answers.push_back({worker.tasks.front().task, worker.received.substr(at + sizeof bytes, bytes), {}, false});
    worker.tasks.pop_front();
    worker.cpu_at_start = cpu_seconds_of(worker.pid);
  }
  worker.received.erase(0, at);
}

// The worker has ended: its first task is lost, the others go to the next one.
void BatchWorkers::replace(Worker& worker, std::vector<WorkerAnswer>& answers, const std::string& trouble, bool is_our_fault) {
  std::deque<Given> tasks = std::move(worker.tasks);
  close(std::exchange(worker.channel, -1));
  if (!tasks.empty()) {
    answers.push_back({tasks.front().task, {}, trouble, is_our_fault});
    tasks.pop_front();
  }
  start(worker);
  for (const Given& given : tasks) {
    worker.tasks.push_back(given);
    const std::uint64_t number = given.task;
    static_cast<void>(write_all(worker.channel, &number, sizeof number));
  }
}

void BatchWorkers::stop_overdue(std::vector<WorkerAnswer>& answers) {
  for (Worker& worker : workers_) {
    if (worker.tasks.empty() || cpu_seconds_of(worker.pid) - worker.cpu_at_start < limits_.cpu_seconds) continue;
    kill(worker.pid, SIGKILL);
    waitpid(worker.pid, nullptr, 0);
    replace(worker, answers,
            "took more than " + short_number(limits_.cpu_seconds) +
                " s of processor time (--time-limit); simplify it, or allow it more",
            false);
  }
}

}  // namespace fdcg::tools
