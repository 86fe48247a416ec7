// SPDX-License-Identifier: Apache-2.0
// Any bytes as a session's log: refused in one short line that begins with the file's name, or read to an end that is told; a
// record that is a tick is written again with the same bytes. First the bytes as they are, then as parts of a log whose
// checksums are right: a byte of length (times 8) and so many bytes, the first part the scene's text, the others payloads.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "session/session_reader.hpp"
#include "tick/tick_bytes.hpp"

namespace {

using namespace fdcg::dev;

void require(bool is_kept, const char* promise, const std::string& text = {}) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s: %.300s\n", promise, text.c_str());
  std::abort();
}

class MemoryFile {
 public:
  explicit MemoryFile(const std::string& bytes) : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0 || write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void require_line(const std::string& line, const std::string& path) {
  constexpr std::size_t kLongest = 2000;
  require(line.find(path) != std::string::npos, "a message names the file", line);
  require(line.size() < kLongest && line.find_first_of("\r\n") == std::string::npos, "a message is a short line", line);
}

void check_tick(const SessionRecord& record) {
  const auto input = std::make_unique<TickInput>();
  LoggedOutput output;
  const std::size_t input_bytes = decode_tick_input(record.payload, record.payload_bytes, input.get());
  require(input_bytes <= record.payload_bytes, "an input is no longer than its record");
  if (input_bytes == 0) return;
  std::vector<std::uint8_t> again(kMostTickBytes);
  require(encode_tick_input(*input, again.data()) == input_bytes, "an input has its length again");
  require(std::memcmp(again.data(), record.payload, input_bytes) == 0, "an input has its bytes again");
  const std::size_t left = record.payload_bytes - input_bytes;
  const std::size_t output_bytes = decode_tick_output(record.payload + input_bytes, left, &output);
  require(output_bytes <= left, "an output is no longer than its record");
  // parts that are all zero are left out when it is written: no longer than it was, and the same when read
  if (output_bytes == 0) return;
  const std::size_t bytes = encode_tick_output(output, again.data());
  LoggedOutput back;
  require(bytes <= output_bytes && decode_tick_output(again.data(), bytes, &back) == bytes, "an output reads back");
  require(first_difference(output, back).empty(), "an output is the same again", first_difference(output, back));
}

// How many ticks there were.
std::size_t check_log(const std::string& bytes) {
  const MemoryFile file(bytes);
  SessionReader reader;
  if (const std::string problem = reader.open(file.path()); !problem.empty()) {
    require_line(problem, file.path());
    return 0;
  }
  std::size_t ticks = 0;
  for (SessionRecord record; reader.next(&record); ++ticks)
    check_tick(record);
  require(reader.ending() != Ending::kNotYet && reader.offset() <= bytes.size(), "a log ends, within its bytes");
  if (reader.ending() != Ending::kEnded) require_line(reader.damage(), file.path());
  return ticks;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  check_log(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> parts;
  while (size > 0) {
    const std::size_t bytes = std::min<std::size_t>(8 * std::size_t{data[0]}, size - 1);
    parts.emplace_back(reinterpret_cast<const char*>(data) + 1, bytes);
    data += 1 + bytes;
    size -= 1 + bytes;
  }
  SessionHeader header;
  header.program = "fuzz";
  header.scene = parts.empty() ? "" : parts[0];
  std::string log = encode_session_header(header);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    std::string record(kRecordFrameBytes + parts[i].size(), '\0');
    encode_record(RecordKind::kTick, static_cast<std::uint16_t>(i % 3), i,
                  reinterpret_cast<const std::uint8_t*>(parts[i].data()), parts[i].size(),
                  reinterpret_cast<std::uint8_t*>(record.data()));
    log += record;
  }
  const std::size_t ticks = check_log(log);
  require(parts.empty() || ticks == parts.size() - 1, "every record that is whole is read");
  return 0;
}
