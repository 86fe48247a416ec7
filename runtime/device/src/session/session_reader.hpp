// SPDX-License-Identifier: Apache-2.0
// Reads a session's log from its start to its end or to the first damaged byte (schemas/session-log.md).
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "tick/device_tick.hpp"
#include "tick/tick_bytes.hpp"

namespace fdcg::dev {

inline constexpr char kSessionMagic[8] = {'\x89', 'F', 'L', 'O', 'G', '\r', '\n', '\x1a'};
inline constexpr std::uint32_t kSessionVersion = 2;

// Whether a file begins like a session's log. False where it cannot be read.
bool is_session_log(const std::string& path);

struct SessionGraph {
  std::string file;  // as the host opened it
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;  // fdcg_checksum of the whole file
};

struct SessionHeader {
  std::string program;               // version of the program that wrote it
  std::string scene_file, scene;     // write_scene's text
  std::vector<SessionGraph> graphs;  // one an object, in the scene's order
};

enum class RecordKind : std::uint8_t { kTick = 1, kEnd = 2 };
enum class EndReason : std::uint8_t { kStopped = 0, kLimit = 1 };

struct SessionRecord {
  RecordKind kind = RecordKind::kTick;
  std::uint16_t device = 0;               // of kTick: its place in the scene
  std::uint64_t tick = 0;                 // of kTick: counts the device's ticks from 0; a number left out is a lost record
  const std::uint8_t* payload = nullptr;  // good until the next record is read
  std::size_t payload_bytes = 0;
};

// Of a log's last record. Ticks of each device, and those of them that found the ring full.
struct SessionEnd {
  EndReason reason = EndReason::kStopped;
  std::vector<std::uint64_t> ticks, dropped;
};

enum class Ending { kNotYet, kEnded, kUnclosed, kDamaged };

class SessionReader {
 public:
  SessionReader();
  ~SessionReader();
  SessionReader(const SessionReader&) = delete;
  SessionReader& operator=(const SessionReader&) = delete;

  // Empty: the header is whole. Otherwise the file and what is wrong with it.
  std::string open(const std::string& path);
  // The same of a file that is open, at its start; it is closed here. `name`: for messages.
  std::string open(std::FILE* file, const std::string& name);
  const SessionHeader& header() const { return header_; }
  // False at the end; ending() then says which. kEnd records are not given out: see end().
  bool next(SessionRecord* record);
  Ending ending() const { return ending_; }
  const SessionEnd& end() const { return end_; }
  const std::string& damage() const { return damage_; }  // of kDamaged and kUnclosed: one line, with the byte
  std::uint64_t offset() const { return offset_; }       // bytes read and found whole

 private:
  bool read_up_to(std::size_t bytes);  // of bytes_
  bool read_record();
  bool ends(Ending ending, const std::string& why);
  bool read_end(const SessionRecord& record);

  std::FILE* file_ = nullptr;
  std::string path_, damage_;
  SessionHeader header_;
  SessionEnd end_;
  Ending ending_ = Ending::kNotYet;
  std::uint64_t offset_ = 0;
  std::vector<std::uint8_t> bytes_;  // of the record at hand
  SessionRecord record_;
};

// A log's bytes. The writer, and the replay that writes the same log again, use these.
std::string encode_session_header(const SessionHeader& header);
inline constexpr std::size_t kRecordFrameBytes = 24;  // around a payload
// Writes a record to `to`, kRecordFrameBytes + payload_bytes; returns that.
std::size_t encode_record(RecordKind kind, std::uint16_t device, std::uint64_t tick, const std::uint8_t* payload,
                          std::size_t payload_bytes, std::uint8_t* to);
std::string encode_end(const SessionEnd& end);  // the whole record

}  // namespace fdcg::dev
