// SPDX-License-Identifier: Apache-2.0
// A session's log: every TickInput and TickOutput of every device, so that it can be replayed bit for bit. The servo thread
// puts records into a ring that was made at the start and never waits; a thread of its own writes them to the file. A full ring
// or a full disk costs records, never a tick: they are counted, the status says so, and the replay ends before the gap.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "device_tick.hpp"
#include "host_config.hpp"

namespace fdcg::dev {

// One servo thread's way into the log.
class LogRing {
 public:
  explicit LogRing(std::uint32_t bytes);  // a power of two, at least kLeastBytes; allocates and touches every page
  ~LogRing();
  LogRing(const LogRing&) = delete;
  LogRing& operator=(const LogRing&) = delete;
  static constexpr std::uint32_t kLeastBytes = 1 << 15;  // more than two ticks with all that a tick can hold
  // The servo thread's. False: the ring is full, and the tick is counted as dropped. No lock, no heap.
  bool put(const TickInput& input, const TickOutput& output);
  // Whether the largest tick would find room now: for a thread that may wait.
  bool has_room() const;
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  friend class SessionLog;
  // The log's thread: the oldest tick into `payload` (kMostTickBytes); its bytes, or 0 where the ring is empty.
  std::size_t take(std::uint64_t* tick, std::uint8_t* payload);
  void copy_in(std::uint64_t at, const std::uint8_t* from, std::size_t bytes);
  void copy_out(std::uint64_t at, std::uint8_t* to, std::size_t bytes) const;

  std::uint8_t* bytes_ = nullptr;
  std::uint8_t* scratch_ = nullptr;  // the servo thread's: a tick being encoded
  std::uint32_t capacity_ = 0;
  std::uint64_t tick_ = 0;                          // the servo thread's: ticks put so far, dropped ones too
  alignas(64) std::atomic<std::uint64_t> head_{0};  // written by the servo thread
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // written by the log's thread
  std::atomic<std::uint64_t> dropped_{0};
};

// Whether a session of this scene could be logged where config.log_file says, as far as can be told without touching it. Empty:
// it could, or there is no log. Otherwise why not: the name is that of an input or a folder, or in none; the scene could not be
// read back.
std::string log_problem(const HostConfig& config);

// The file and its thread.
class SessionLog {
 public:
  SessionLog();
  ~SessionLog();  // stops
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;
  // Writes the header (the scene, the profiles, the graphs' checksums) and starts the thread. Rings: one a device, in order,
  // which must live until stop. Empty: fine. Otherwise why not.
  std::string start(const HostConfig& config, LogRing* const* rings, int ring_count);
  // After the servo threads have put their last tick. Writes what is left, closes the file. Empty, or what went wrong since the
  // start ("disk full"). A log that has come to its limit is well.
  std::string stop();
  // The file takes no more: failure() says why, and how many ticks are not in it. Its limit counts here.
  bool has_failed() const;
  std::string failure() const;  // any thread

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace fdcg::dev
