// SPDX-License-Identifier: Apache-2.0
// Any bytes as a session's log: refused in one short line that begins with the file's name, or read to an end that is told; a
// record that is a tick is written again with the same bytes. What begins as a log is read as it is, and with every checksum
// set right; all else is the payload of a record. All of it in memory: a file for each log, and every field of every tick
// printed, took most of the time.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "session/session_reader.hpp"
#include "tick/tick_bytes.hpp"

namespace {

using namespace fdcg::dev;

void require(bool is_kept, const char* promise, const std::string& text = {}) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s: %.300s\n", promise, text.c_str());
  std::abort();
}

constexpr const char* kName = "fuzz";

void require_line(const std::string& line) {
  constexpr std::size_t kLongest = 2000;
  require(line.find(kName) != std::string::npos, "a message names the file", line);
  require(line.size() < kLongest && line.find_first_of("\r\n") == std::string::npos, "a message is a short line", line);
}

void check_tick(const SessionRecord& record) {
  static TickInput input;
  static std::uint8_t again[kMostTickBytes];
  LoggedOutput output;
  const std::size_t input_bytes = decode_tick_input(record.payload, record.payload_bytes, &input);
  require(input_bytes <= record.payload_bytes, "an input is no longer than its record");
  if (input_bytes == 0) return;
  require(encode_tick_input(input, again) == input_bytes, "an input has its length again");
  require(std::memcmp(again, record.payload, input_bytes) == 0, "an input has its bytes again");
  const std::size_t left = record.payload_bytes - input_bytes;
  const std::size_t output_bytes = decode_tick_output(record.payload + input_bytes, left, &output);
  require(output_bytes <= left, "an output is no longer than its record");
  // parts that are all zero are left out when it is written: no longer than it was, and the same when read
  if (output_bytes == 0) return;
  const std::size_t bytes = encode_tick_output(output, again);
  LoggedOutput back;
  require(bytes <= output_bytes && decode_tick_output(again, bytes, &back) == bytes, "an output reads back");
  static std::uint8_t once_more[kMostTickBytes];
  require(encode_tick_output(back, once_more) == bytes && std::memcmp(again, once_more, bytes) == 0,
          "an output is the same again");
  if (again[bytes / 2] % 32 != 0) return;  // of some, by their bytes: it prints every field twice
  const std::string difference = first_difference(output, back);
  require(difference.empty(), "an output is the same again", difference);
}

void check_log(const std::string& bytes) {
  SessionReader reader;
  std::string copy = bytes;
  std::FILE* const file = fmemopen(copy.data(), copy.size(), "rb");
  if (file == nullptr) return;  // no bytes
  if (const std::string problem = reader.open(file, kName); !problem.empty()) {
    require_line(problem);
    return;
  }
  for (SessionRecord record; reader.next(&record);)
    check_tick(record);
  require(reader.ending() != Ending::kNotYet && reader.offset() <= bytes.size(), "a log ends, within its bytes");
  if (reader.ending() != Ending::kEnded) require_line(reader.damage());
}

std::size_t length_at(const std::string& bytes, std::size_t at) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + at, sizeof length);
  return length;
}

// Sets the checksum that ends bytes [begin, end).
void seal(std::string* bytes, std::size_t begin, std::size_t end) {
  const std::uint64_t sum = fdcg_checksum(bytes->data() + begin, end - begin - sizeof(std::uint64_t));
  std::memcpy(bytes->data() + end - sizeof sum, &sum, sizeof sum);
}

// The header and each record for as long as their lengths fit.
std::string with_right_checksums(std::string bytes) {
  constexpr std::size_t kBeforeText = 16;  // magic, version, length of the text
  if (bytes.size() < kBeforeText) return bytes;
  std::size_t at = kBeforeText + length_at(bytes, 12) + 8;
  if (at > bytes.size()) return bytes;
  seal(&bytes, 0, at);
  while (at + kRecordFrameBytes <= bytes.size()) {
    const std::size_t length = length_at(bytes, at);
    if (length < kRecordFrameBytes || length > bytes.size() - at) break;
    seal(&bytes, at, at + length);
    at += length;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string as_it_is(reinterpret_cast<const char*>(data), size);
  check_log(as_it_is);
  if (size > 0 && data[0] == static_cast<unsigned char>(kSessionMagic[0])) {
    check_log(with_right_checksums(as_it_is));
    return 0;
  }
  SessionRecord record;
  record.payload = data;
  record.payload_bytes = size;
  check_tick(record);
  return 0;
}
