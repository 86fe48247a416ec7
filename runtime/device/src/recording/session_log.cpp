// SPDX-License-Identifier: Apache-2.0
#include "recording/session_log.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

#include "base/crash_signals.hpp"
#include "scene/scene_json.hpp"
#include "session/session_reader.hpp"
#include "tick/tick_bytes.hpp"

namespace fdcg::dev {
namespace {

constexpr std::size_t kEntryBytes = 16;                  // before a tick in the ring: its length, its device, its number
constexpr std::chrono::milliseconds kDrainInterval{20};  // what a crash can lose, beside what the system holds
constexpr std::size_t kChunkBytes = 1 << 16;             // a write
constexpr double kBytesPerMegabyte = 1e6;

bool is_same_file(const struct stat& a, const std::string& path) {
  struct stat b {};
  return stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// It begins as one, or is empty.
bool is_log_or_empty(const std::string& path) {
  char begin[sizeof kSessionMagic] = {};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(begin, sizeof begin) && !file.eof()) return false;  // may not be read
  return file.gcount() == 0 || std::memcmp(begin, kSessionMagic, sizeof begin) == 0;
}

// Empty, or what the log would overwrite.
std::string overwritten(const HostConfig& config) {
  struct stat log {};
  if (lstat(config.log_file.c_str(), &log) != 0) return {};
  if (S_ISLNK(log.st_mode)) return "is a symbolic link";
  if (S_ISDIR(log.st_mode)) return "is a folder";
  if (is_same_file(log, config.scene_file)) return "would overwrite the scene";
  for (const ObjectConfig& object : config.objects)
    if (!object.is_surface && is_same_file(log, object.file)) return "would overwrite the graph of '" + object.name + "'";
  for (const DeviceConfig& device : config.devices)
    if (is_same_file(log, device.recording)) return "would overwrite the recording that '" + device.name + "' plays";
  if (S_ISREG(log.st_mode) && !is_log_or_empty(config.log_file)) return "would overwrite a file that is no session's log";
  return {};
}

std::string describe(const HostConfig& config, const SceneGraphs* graphs, SessionHeader* header) {
  header->program = FDCG_VERSION_STRING;
  header->scene_file = config.scene_file;
  header->scene = write_scene(config);
  // a log that could not be replayed is found now, not when it is needed
  HostConfig back;
  if (const std::string problem = parse_scene(header->scene, "its scene", &back, nullptr, {.shares_soft = false});
      !problem.empty())
    return problem;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const ObjectConfig& object = config.objects[i];
    if (object.is_surface) {
      header->graphs.push_back({});
      continue;
    }
    if (graphs != nullptr) {
      const fdcg_graph& graph = graphs->of_object(i);
      header->graphs.push_back({object.file, graph.mapping_bytes, fdcg_checksum(graph.mapping, graph.mapping_bytes)});
      continue;
    }
    fdcg_graph graph{};
    fdcg_error error{};
    if (fdcg_open_file(object.file.c_str(), FDCG_VERIFY_TRUSTED, &graph, &error) != FDCG_OK) return error.message;
    header->graphs.push_back({object.file, graph.mapping_bytes, fdcg_checksum(graph.mapping, graph.mapping_bytes)});
    fdcg_close(&graph);
  }
  return {};
}

std::string cannot_write(const HostConfig& config) {
  return "cannot write the log '" + config.log_file + "': ";
}

// *header is then filled in.
std::string begin_log(const HostConfig& config, const SceneGraphs* graphs, SessionHeader* header) {
  if (const std::string problem = overwritten(config); !problem.empty())
    return cannot_write(config) + "it " + problem + "; give another name (log.file, --log)";
  const std::string problem = describe(config, graphs, header);
  return problem.empty() ? problem : cannot_write(config) + problem;
}

}  // namespace

std::string log_problem(const HostConfig& config, std::vector<std::string>* warnings) {
  if (config.log_file.empty()) return {};
  const std::filesystem::path folder = std::filesystem::path(config.log_file).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    return cannot_write(config) + "its folder does not exist; make it, or give another name (log.file, --log)";
  SessionHeader header;
  if (std::string problem = begin_log(config, nullptr, &header); !problem.empty()) return problem;
  struct stat log {};
  if (warnings != nullptr && lstat(config.log_file.c_str(), &log) == 0 && S_ISREG(log.st_mode) && log.st_size > 0)
    warnings->push_back("'" + config.log_file + "' is there already: a session's log that a run overwrites");
  return {};
}

// ---- ring -----------------------------------------------------------------------------------------------------------------

static_assert(LogRing::kLeastBytes >= 2 * (kMostTickBytes + kEntryBytes));

LogRing::LogRing(std::uint32_t bytes, int device_count) : capacity_(bytes), device_count_(device_count) {
  const std::size_t most = static_cast<std::size_t>(device_count) * (kEntryBytes + kMostTickBytes);
  bytes_ = new std::uint8_t[bytes];
  scratch_ = new std::uint8_t[most];
  // every page is there before the first tick
  std::memset(bytes_, 0, bytes);
  std::memset(scratch_, 0, most);
}

LogRing::~LogRing() {
  delete[] bytes_;
  delete[] scratch_;
}

void LogRing::copy_in(std::uint64_t at, const std::uint8_t* from, std::size_t bytes) {
  const std::size_t place = at & (capacity_ - 1), first = std::min<std::size_t>(bytes, capacity_ - place);
  std::memcpy(bytes_ + place, from, first);
  std::memcpy(bytes_, from + first, bytes - first);
}

void LogRing::copy_out(std::uint64_t at, std::uint8_t* to, std::size_t bytes) const {
  const std::size_t place = at & (capacity_ - 1), first = std::min<std::size_t>(bytes, capacity_ - place);
  std::memcpy(to, bytes_ + place, first);
  std::memcpy(to + first, bytes_, bytes - first);
}

std::size_t LogRing::encode(const TickInput& input, const TickOutput& output, int device, std::size_t at) {
  std::uint8_t* const entry = scratch_ + at;
  std::size_t bytes = encode_tick_input(input, entry + kEntryBytes);
  log_output(output, &output_);
  bytes += encode_tick_output(output_, entry + kEntryBytes + bytes);
  const std::uint32_t words[2] = {static_cast<std::uint32_t>(bytes), static_cast<std::uint32_t>(device)};
  const std::uint64_t tick = ticks_[device]++;
  std::memcpy(entry, words, sizeof words);
  std::memcpy(entry + sizeof words, &tick, sizeof tick);
  return kEntryBytes + bytes;
}

// The scratch memory's first bytes into the ring, if there is room for all.
bool LogRing::hand_over(std::size_t bytes) {
  const std::uint64_t head = head_.load(std::memory_order_relaxed);
  if (capacity_ - (head - tail_.load(std::memory_order_acquire)) < bytes) return false;
  copy_in(head, scratch_, bytes);
  head_.store(head + bytes, std::memory_order_release);
  return true;
}

bool LogRing::put(const TickInput& input, const TickOutput& output, int device) {
  if (hand_over(encode(input, output, device, 0))) return true;
  dropped_[device].store(dropped_[device].load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return false;
}

bool LogRing::put_all(const Member* members) {
  std::size_t bytes = 0;
  for (int i = 0; i < device_count_; ++i)
    bytes += encode(*members[i].input, *members[i].output, i, bytes);
  if (hand_over(bytes)) return true;
  for (int i = 0; i < device_count_; ++i)
    dropped_[i].store(dropped_[i].load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return false;
}

bool LogRing::has_room() const {
  const std::uint64_t used = head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire);
  return capacity_ - used >= static_cast<std::size_t>(device_count_) * (kEntryBytes + kMostTickBytes);
}

std::size_t LogRing::take(std::uint64_t* tick, int* device, std::uint8_t* payload) {
  const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
  if (tail == head_.load(std::memory_order_acquire)) return 0;
  std::uint8_t entry[kEntryBytes];
  std::uint32_t words[2];
  copy_out(tail, entry, kEntryBytes);
  std::memcpy(words, entry, sizeof words);
  std::memcpy(tick, entry + sizeof words, sizeof *tick);
  *device = static_cast<int>(words[1]);
  copy_out(tail + kEntryBytes, payload, words[0]);
  tail_.store(tail + kEntryBytes + words[0], std::memory_order_release);
  return words[0];
}

// ---- file -----------------------------------------------------------------------------------------------------------------

struct SessionLog::Impl {
  std::string path;
  std::vector<LogRing*> rings;
  std::uint64_t limit_bytes = 0;  // 0: none
  int descriptor = -1;
  std::thread thread;
  std::mutex mutex;  // of is_stopping
  std::condition_variable wake;
  bool is_stopping = false;

  // the thread's
  std::vector<std::uint8_t> chunk, payload, record;
  std::uint64_t chunk_ticks = 0;
  std::uint64_t whole_bytes = 0;  // of the file: up to the end of a record
  SessionEnd end;                 // ticks: taken from the rings so far

  // told to any thread
  enum : int { kWell = 0, kAtLimit = -1 };  // or an errno
  std::atomic<int> trouble{kWell};
  std::atomic<std::uint64_t> bytes_written{0}, ticks_left_out{0};

  void run();
  void drain();
  void add(const std::uint8_t* bytes, std::size_t count);
  bool flush();
  void fail(int error_number);
  std::string trouble_text() const;
};

void SessionLog::Impl::fail(int error_number) {
  trouble.store(error_number, std::memory_order_release);
  // What is left ends with a whole record. Of a device there is nothing to cut off, and no harm in trying.
  if (ftruncate(descriptor, static_cast<off_t>(whole_bytes)) == 0) bytes_written.store(whole_bytes, std::memory_order_relaxed);
}

// The chunk holds whole records; after a failure it is lost.
bool SessionLog::Impl::flush() {
  std::size_t done = 0;
  while (done < chunk.size() && trouble.load(std::memory_order_relaxed) <= kWell) {
    const ssize_t wrote = write(descriptor, chunk.data() + done, chunk.size() - done);
    if (wrote > 0) {
      done += static_cast<std::size_t>(wrote);
    } else if (wrote == 0 || errno != EINTR) {
      fail(wrote == 0 ? EIO : errno);
    }
  }
  const bool is_whole = done == chunk.size();
  if (is_whole) {
    whole_bytes += done;
    bytes_written.store(whole_bytes, std::memory_order_relaxed);
  } else {
    ticks_left_out.fetch_add(chunk_ticks, std::memory_order_relaxed);
  }
  chunk_ticks = 0;
  chunk.clear();
  return is_whole;
}

void SessionLog::Impl::add(const std::uint8_t* bytes, std::size_t count) {
  chunk.insert(chunk.end(), bytes, bytes + count);
  if (chunk.size() >= kChunkBytes) flush();
}

void SessionLog::Impl::drain() {
  std::size_t first = 0;  // device of the ring
  for (LogRing* const ring : rings) {
    std::uint64_t tick = 0;
    int place = 0;
    // no more than was there at first: a fast device does not keep the others waiting
    const std::uint64_t until = ring->head_.load(std::memory_order_acquire);
    while (ring->tail_.load(std::memory_order_relaxed) < until) {
      const std::size_t bytes = ring->take(&tick, &place, payload.data());
      const std::size_t device = first + static_cast<std::size_t>(place);
      if (trouble.load(std::memory_order_relaxed) != kWell) {
        ticks_left_out.fetch_add(1, std::memory_order_relaxed);
        continue;
      }
      const std::size_t length =
          encode_record(RecordKind::kTick, static_cast<std::uint16_t>(device), tick, payload.data(), bytes, record.data());
      const std::uint64_t room_for_end = kRecordFrameBytes + 1 + 16 * end.ticks.size();
      if (limit_bytes != 0 && whole_bytes + chunk.size() + length + room_for_end > limit_bytes) {
        end.reason = EndReason::kLimit;
        const std::string last = encode_end(end);
        add(reinterpret_cast<const std::uint8_t*>(last.data()), last.size());
        if (flush()) trouble.store(kAtLimit, std::memory_order_release);
        ticks_left_out.fetch_add(1, std::memory_order_relaxed);
        continue;
      }
      ++chunk_ticks;
      add(record.data(), length);
      end.ticks[device] = tick + 1;
    }
    first += static_cast<std::size_t>(ring->device_count());
  }
  flush();
}

void SessionLog::Impl::run() {
  for (bool is_last = false; !is_last;) {
    {
      std::unique_lock lock(mutex);
      wake.wait_for(lock, kDrainInterval, [this] { return is_stopping; });
      is_last = is_stopping;
    }
    drain();
  }
  if (trouble.load(std::memory_order_relaxed) != kWell) return;
  std::size_t device = 0;
  for (const LogRing* const ring : rings) {
    for (int place = 0; place < ring->device_count(); ++place, ++device) {
      end.ticks[device] = ring->ticks_[place];  // its thread has put its last
      end.dropped[device] = ring->dropped(place);
    }
  }
  const std::string last = encode_end(end);
  add(reinterpret_cast<const std::uint8_t*>(last.data()), last.size());
  flush();
}

std::string SessionLog::Impl::trouble_text() const {
  const int what = trouble.load(std::memory_order_acquire);
  if (what == kWell) return {};
  char size[32];
  std::snprintf(size, sizeof size, "%.1f MB",
                static_cast<double>(bytes_written.load(std::memory_order_relaxed)) / kBytesPerMegabyte);
  const std::string left_out = std::to_string(ticks_left_out.load(std::memory_order_relaxed)) + " later ticks are not in it";
  if (what == kAtLimit) return path + ": the log has come to its limit (log.limit_mb) at " + size + "; " + left_out;
  return path + ": " + std::strerror(what) + " after " + size + "; " + left_out +
         ". The session goes on without a log; make room, then start anew";
}

SessionLog::SessionLog() : impl_(new Impl) {}

SessionLog::~SessionLog() {
  stop();
  delete impl_;
}

std::string SessionLog::start(const HostConfig& config, LogRing* const* rings, int ring_count, const SceneGraphs* graphs) {
  SessionHeader header;
  if (std::string problem = begin_log(config, graphs, &header); !problem.empty()) return problem;
  impl_->path = config.log_file;
  impl_->rings.assign(rings, rings + ring_count);
  std::size_t devices = 0;
  for (const LogRing* const ring : impl_->rings)
    devices += static_cast<std::size_t>(ring->device_count());
  impl_->end.ticks.assign(devices, 0);
  impl_->end.dropped.assign(devices, 0);
  impl_->limit_bytes = static_cast<std::uint64_t>(config.log_megabytes * kBytesPerMegabyte);
  impl_->payload.resize(kMostTickBytes);
  impl_->record.resize(kRecordFrameBytes + kMostTickBytes);
  impl_->chunk.reserve(2 * kChunkBytes);

  // A crash must leave a log that can be read: it is written in place as the session goes, unlike other outputs.
  impl_->descriptor = ::open(config.log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (impl_->descriptor < 0) return cannot_write(config) + std::strerror(errno);
  // The thread takes no signals but of its own crash: the process' belong to others, and SIGXFSZ becomes an error of write.
  sigset_t all{}, before{};
  sigfillset(&all);
  for (const int signal : kCrashSignals)
    sigdelset(&all, signal);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const std::string first = encode_session_header(header);
  impl_->add(reinterpret_cast<const std::uint8_t*>(first.data()), first.size());
  const bool is_written = impl_->flush();
  if (is_written) impl_->thread = std::thread([this] { impl_->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (is_written) return {};
  const int error_number = impl_->trouble.load();
  ::close(impl_->descriptor);
  impl_->descriptor = -1;
  return cannot_write(config) + std::strerror(error_number);
}

std::string SessionLog::stop() {
  if (!impl_->thread.joinable()) return {};
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_stopping = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
  if (::close(impl_->descriptor) != 0 && impl_->trouble.load() == Impl::kWell) impl_->trouble.store(errno);
  impl_->descriptor = -1;
  return impl_->trouble.load() > Impl::kWell ? failure() : std::string();
}

bool SessionLog::has_failed() const {
  return impl_->trouble.load(std::memory_order_acquire) != Impl::kWell;
}

std::string SessionLog::failure() const {
  return impl_->trouble_text();
}

}  // namespace fdcg::dev
