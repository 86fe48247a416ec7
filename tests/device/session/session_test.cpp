// SPDX-License-Identifier: Apache-2.0
// A session's log: the ring, the file, and its reader on damaged files.
#include "recording/session_log.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "catch.hpp"
#include "session/session_reader.hpp"
#include "session_rig.hpp"

using namespace fdcg::dev;

namespace {

HostConfig config_for(const std::string& log_file, double megabytes = 0, int devices = 1) {
  HostConfig config;
  config.scene_file = "scene.json";
  config.log_file = log_file;
  config.log_megabytes = megabytes;
  for (int i = 0; i < devices; ++i) {
    DeviceConfig device;
    device.name = "device " + std::to_string(i);
    device.source = DeviceSource::kSimulated;
    config.devices.push_back(device);
  }
  return config;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

// A log of `count` ticks of one device, and the results of start and stop.
struct Written {
  std::string started, stopped;
};
Written write_log(const HostConfig& config, std::uint64_t count, std::uint32_t ring_bytes = 1 << 22) {
  LogRing ring(ring_bytes);
  LogRing* const rings[] = {&ring};
  SessionLog log;
  Written written;
  written.started = log.start(config, rings, 1);
  if (!written.started.empty()) return written;
  TickInput input;
  for (std::uint64_t i = 0; i < count; ++i) {
    TickOutput output;
    number_tick(i, &input, &output);
    ring.put(input, output);
  }
  written.stopped = log.stop();
  return written;
}

// The ticks that a file gives before it ends; each is checked against number_tick.
std::vector<std::uint64_t> read_ticks(SessionReader& reader) {
  std::vector<std::uint64_t> ticks;
  std::uint8_t expected[kMostTickBytes];
  TickInput input;
  for (SessionRecord record; reader.next(&record);) {
    TickOutput output;
    number_tick(record.tick, &input, &output);
    std::size_t bytes = encode_tick_input(input, expected);
    bytes += encode_tick_output(logged(output), expected + bytes);
    REQUIRE(record.payload_bytes == bytes);
    REQUIRE(std::memcmp(record.payload, expected, bytes) == 0);
    ticks.push_back(record.tick);
  }
  return ticks;
}

}  // namespace

TEST_CASE("log: every tick is read back in order, and the log is reported complete") {
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  const Written written = write_log(config, 500);
  REQUIRE(written.started.empty());
  REQUIRE(written.stopped.empty());
  CHECK(is_session_log(config.log_file));
  SessionReader reader;
  REQUIRE(reader.open(config.log_file).empty());
  CHECK(reader.header().program == FDCG_VERSION_STRING);
  CHECK(reader.header().scene_file == "scene.json");
  const std::vector<std::uint64_t> ticks = read_ticks(reader);
  CHECK(ticks.size() == 500);
  CHECK(ticks.back() == 499);
  CHECK(reader.ending() == Ending::kEnded);
  CHECK(reader.end().ticks == std::vector<std::uint64_t>{500});
  CHECK(reader.end().dropped == std::vector<std::uint64_t>{0});
  CHECK(reader.end().reason == EndReason::kStopped);
  CHECK(reader.offset() == std::filesystem::file_size(config.log_file));
}

TEST_CASE("the header is made again from what was read, byte for byte") {
  SessionHeader header;
  header.program = "0.1.0";
  header.scene_file = "a folder/\xFFno UTF-8.json";
  header.scene = R"({"fdcg_scene":1})";
  header.graphs = {{"cube.fdcg", 1234, 0xFFFFFFFFFFFFFFFF}};
  const Folder folder;
  write_bytes(folder.file("h"), encode_session_header(header));
  SessionReader reader;
  REQUIRE(reader.open(folder.file("h")).empty());
  CHECK(reader.header().graphs[0].checksum == 0xFFFFFFFFFFFFFFFF);
  CHECK(encode_session_header(reader.header()) == encode_session_header(header));
}

TEST_CASE("log: truncated at any byte, it gives the ticks before, and the place") {
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  write_log(config, 6);
  const std::string whole = bytes_of(config.log_file);
  std::vector<std::uint64_t> boundaries;
  {
    SessionReader reader;
    REQUIRE(reader.open(config.log_file).empty());
    boundaries.push_back(reader.offset());
    for (SessionRecord record; reader.next(&record);)
      boundaries.push_back(reader.offset());
  }
  REQUIRE(boundaries.size() == 7);
  const std::string cut_file = folder.file("cut.fdcglog");
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    write_bytes(cut_file, whole.substr(0, cut));
    SessionReader reader;
    const std::string problem = reader.open(cut_file);
    INFO("cut after " << cut << " of " << whole.size());
    if (cut < boundaries[0]) {
      REQUIRE(problem.find(cut_file) == 0);
      continue;
    }
    REQUIRE(problem.empty());
    const std::size_t ticks = read_ticks(reader).size();
    const auto at = std::upper_bound(boundaries.begin(), boundaries.end(), cut) - 1;
    REQUIRE(ticks == static_cast<std::size_t>(at - boundaries.begin()));
    REQUIRE(reader.ending() == (*at == cut ? Ending::kUnclosed : Ending::kDamaged));
    REQUIRE(reader.damage().find("byte " + std::to_string(*at)) != std::string::npos);
  }
}

TEST_CASE("log: any changed byte is detected, and only the ticks before it are given") {
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  write_log(config, 4);
  const std::string whole = bytes_of(config.log_file);
  const std::string changed_file = folder.file("changed.fdcglog");
  Random random(13);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ (1 + random() % 255));
    write_bytes(changed_file, changed);
    SessionReader reader;
    INFO("byte " << i);
    if (!reader.open(changed_file).empty()) continue;
    const std::size_t ticks = read_ticks(reader).size();
    REQUIRE(reader.ending() == Ending::kDamaged);
    REQUIRE(reader.offset() <= i);
    REQUIRE(ticks <= 4);
  }
}

TEST_CASE("log: other files and trailing bytes are refused by name") {
  const Folder folder;
  SessionReader missing, empty, other, appended, newer;
  CHECK(missing.open(folder.file("missing")).find("No such file") != std::string::npos);
  write_bytes(folder.file("empty"), "");
  CHECK(empty.open(folder.file("empty")).find("not a session's log") != std::string::npos);
  write_bytes(folder.file("other"), std::string(1000, 'x'));
  CHECK(other.open(folder.file("other")).find("not a session's log") != std::string::npos);
  CHECK(SessionReader().open("/tmp").find("Is a directory") != std::string::npos);
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  write_log(config, 1);
  std::string bytes = bytes_of(config.log_file);
  write_bytes(folder.file("appended"), bytes + "x");
  REQUIRE(appended.open(folder.file("appended")).empty());
  read_ticks(appended);
  CHECK(appended.ending() == Ending::kDamaged);
  bytes[8] = 3;
  write_bytes(folder.file("newer"), bytes);
  CHECK(newer.open(folder.file("newer")).find("version 3") != std::string::npos);
}

TEST_CASE("log: a full ring drops and counts ticks, and tick numbers show which") {
  LogRing ring(LogRing::kLeastBytes);
  TickInput input;
  input.report_count = 1;
  input.reports[0].bytes = 100;
  const TickOutput output;
  std::uint64_t taken = 0;
  while (ring.put(input, output))
    ++taken;
  CHECK(taken > 100);
  CHECK(ring.dropped() == 1);
  CHECK(!ring.put(input, output));
  CHECK(ring.dropped() == 2);

  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  LogRing* const rings[] = {&ring};
  SessionLog log;
  REQUIRE(log.start(config, rings, 1).empty());
  while (!ring.put(input, output))
    std::this_thread::yield();
  const std::uint64_t dropped = ring.dropped();
  REQUIRE(log.stop().empty());
  SessionReader reader;
  REQUIRE(reader.open(config.log_file).empty());
  std::vector<std::uint64_t> ticks;
  for (SessionRecord record; reader.next(&record);)
    ticks.push_back(record.tick);
  REQUIRE(ticks.size() == taken + 1);
  CHECK(ticks[taken - 1] == taken - 1);
  CHECK(ticks[taken] == taken + dropped);
  CHECK(reader.end().dropped == std::vector<std::uint64_t>{dropped});
  CHECK(reader.end().ticks == std::vector<std::uint64_t>{taken + dropped + 1});
}

TEST_CASE("log: rings filled by several threads are written completely to one file") {
  constexpr std::uint64_t kTicks = 20000;
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"), 0, 2);
  LogRing small(LogRing::kLeastBytes), large(1 << 20);
  LogRing* const rings[] = {&small, &large};
  SessionLog log;
  REQUIRE(log.start(config, rings, 2).empty());
  const auto put_all = [](LogRing* ring) {
    TickInput input;
    for (std::uint64_t i = 0; i < kTicks; ++i) {
      TickOutput output;
      number_tick(i, &input, &output);
      ring->put(input, output);
    }
  };
  std::thread first(put_all, &small), second(put_all, &large);
  first.join();
  second.join();
  REQUIRE(log.stop().empty());
  SessionReader reader;
  REQUIRE(reader.open(config.log_file).empty());
  std::uint64_t counts[2] = {}, next[2] = {};
  TickInput input;
  std::uint8_t expected[kMostTickBytes];
  for (SessionRecord record; reader.next(&record);) {
    REQUIRE(record.device < 2);
    REQUIRE(record.tick >= next[record.device]);
    next[record.device] = record.tick + 1;
    ++counts[record.device];
    TickOutput output;
    number_tick(record.tick, &input, &output);
    std::size_t bytes = encode_tick_input(input, expected);
    bytes += encode_tick_output(logged(output), expected + bytes);
    REQUIRE(record.payload_bytes == bytes);
    REQUIRE(std::memcmp(record.payload, expected, bytes) == 0);
  }
  CHECK(reader.ending() == Ending::kEnded);
  CHECK(counts[0] + small.dropped() == kTicks);
  CHECK(counts[1] + large.dropped() == kTicks);
  CHECK(counts[0] > 0);
}

TEST_CASE("log: a full disk truncates the log after a complete tick and is reported") {
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"));
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  rlimit small = before;
  small.rlim_cur = 40000;
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);  // SIGXFSZ would end the program, were the log's thread to take it
  const Written written = write_log(config, 500);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
  CHECK(written.started.empty());
  CHECK(written.stopped.find(config.log_file + ": File too large after 0.0 MB; ") == 0);
  CHECK(std::filesystem::file_size(config.log_file) <= 40000);
  SessionReader reader;
  REQUIRE(reader.open(config.log_file).empty());
  const std::size_t ticks = read_ticks(reader).size();
  CHECK(reader.ending() == Ending::kUnclosed);
  CHECK(written.stopped.find("; " + std::to_string(500 - ticks) + " later ticks are not in it") != std::string::npos);
}

TEST_CASE("a log that cannot be written is refused before the session starts") {
  CHECK(write_log(config_for("/dev/full"), 0).started == "cannot write the log '/dev/full': No space left on device");
  CHECK(write_log(config_for("/nonexistent/a.fdcglog"), 0).started.find("No such file") != std::string::npos);
  CHECK(write_log(config_for("/tmp"), 0).started.find("is a folder") != std::string::npos);
  const Folder folder;
  write_bytes(folder.file("scene.json"), "{}");
  HostConfig config = config_for(folder.file("scene.json"));
  config.scene_file = folder.file("./scene.json");
  CHECK(write_log(config, 0).started.find("would overwrite the scene") != std::string::npos);
  config.scene_file = "scene.json";
  config.devices[0].recording = folder.file("scene.json");
  CHECK(write_log(config, 0).started.find("would overwrite the recording that 'device 0' plays") != std::string::npos);
  CHECK(bytes_of(folder.file("scene.json")) == "{}");
}

TEST_CASE("a log ends in order at its limit") {
  const Folder folder;
  const HostConfig config = config_for(folder.file("a.fdcglog"), 0.05);
  LogRing ring(1 << 22);
  LogRing* const rings[] = {&ring};
  SessionLog log;
  REQUIRE(log.start(config, rings, 1).empty());
  TickInput input;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    TickOutput output;
    number_tick(i, &input, &output);
    ring.put(input, output);
  }
  CHECK(log.stop().empty());
  CHECK(log.has_failed());
  CHECK(log.failure().find("has come to its limit (log.limit_mb)") != std::string::npos);
  const std::uint64_t bytes = std::filesystem::file_size(config.log_file);
  CHECK(bytes <= 50000);
  CHECK(bytes > 35000);  // at most one large tick short
  SessionReader reader;
  REQUIRE(reader.open(config.log_file).empty());
  const std::size_t ticks = read_ticks(reader).size();
  CHECK(reader.ending() == Ending::kEnded);
  CHECK(reader.end().reason == EndReason::kLimit);
  CHECK(reader.end().ticks == std::vector<std::uint64_t>{ticks});
  CHECK(log.failure().find("; " + std::to_string(1000 - ticks) + " later ticks") != std::string::npos);
}
