// SPDX-License-Identifier: Apache-2.0
// A session's log: every TickInput and TickOutput of every device, so that it can be replayed bit for bit. The servo thread
// puts records into a preallocated ring buffer and never waits; a separate thread writes them to the file. If the ring or the
// disk is full, records are dropped and no tick is delayed: they are counted and reported in the status, and the replay ends
// before the gap.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/host_config.hpp"
#include "scene/scene_build.hpp"
#include "tick/device_tick.hpp"
#include "tick/tick_bytes.hpp"

namespace fdcg::dev {

// The ring buffer between one servo thread, with one device or several, and the log.
class LogRing {
 public:
  // bytes: a power of two, at least kLeastBytes for each device. Allocates and touches every page.
  explicit LogRing(std::uint32_t bytes, int device_count = 1);
  ~LogRing();
  LogRing(const LogRing&) = delete;
  LogRing& operator=(const LogRing&) = delete;
  static constexpr std::uint32_t kLeastBytes = 1 << 15;  // more than two ticks with all that a tick can hold
  static constexpr std::uint32_t kUsualBytes = 1u
                                               << 22;  // for each device: some 1.5 s of ticks at 8 kHz while the disk is busy
  // For the servo thread. False: the ring is full, and the tick is counted as dropped. No lock, no heap. device: index among
  // the ring's devices.
  bool put(const TickInput& input, const TickOutput& output, int device = 0);
  // One tick of every device of the ring, one after another in the log; or of none.
  bool put_all(const Member* members);
  // Whether the largest tick of every device would find room now: for a thread that may wait.
  bool has_room() const;
  std::uint64_t dropped(int device = 0) const { return dropped_[device].load(std::memory_order_relaxed); }
  int device_count() const { return device_count_; }

 private:
  friend class SessionLog;
  // The log's thread: the oldest tick into `payload` (kMostTickBytes); its bytes, or 0 where the ring is empty.
  std::size_t take(std::uint64_t* tick, int* device, std::uint8_t* payload);
  // The servo thread's: into the scratch memory, from `at` on. The bytes.
  std::size_t encode(const TickInput& input, const TickOutput& output, int device, std::size_t at);
  bool hand_over(std::size_t bytes);
  void copy_in(std::uint64_t at, const std::uint8_t* from, std::size_t bytes);
  void copy_out(std::uint64_t at, std::uint8_t* to, std::size_t bytes) const;

  std::uint8_t* bytes_ = nullptr;
  std::uint8_t* scratch_ = nullptr;  // the servo thread's: ticks being encoded
  LoggedOutput output_;              // and the output of one
  std::uint32_t capacity_ = 0;
  int device_count_ = 1;
  std::uint64_t ticks_[kMaxDevices] = {};           // the servo thread's: put so far, dropped ones too
  alignas(64) std::atomic<std::uint64_t> head_{0};  // written by the servo thread
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // written by the log's thread
  std::atomic<std::uint64_t> dropped_[kMaxDevices] = {};
};

// Checks without touching the file whether a session of this scene can be logged to config.log_file. Empty: it can, or there is
// no log. Otherwise the reason: the name is that of an input or a folder, its folder does not exist, or the scene could not be
// read back. A session's log that would be overwritten goes to *warnings (may be null).
std::string log_problem(const HostConfig& config, std::vector<std::string>* warnings);

// The file and its thread.
class SessionLog {
 public:
  SessionLog();
  ~SessionLog();  // stops
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;
  // Writes the header (the scene, the profiles, the graphs' checksums) and starts the thread. Rings: their devices are the
  // scene's, in order. They must live until stop. graphs: those that the devices feel; null: the files as they are now. Empty:
  // fine. Otherwise why not. Refused is a file that is there and no session's log, and a symbolic link.
  std::string start(const HostConfig& config, LogRing* const* rings, int ring_count, const SceneGraphs* graphs = nullptr);
  // After the servo threads have put their last tick. Writes what is left, closes the file. Empty, or what went wrong since the
  // start ("disk full"). A log that has come to its limit is well.
  std::string stop();
  // The file is closed for writing: failure() has the reason and the number of missing ticks. True also at the size limit.
  bool has_failed() const;
  std::string failure() const;  // any thread

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace fdcg::dev
