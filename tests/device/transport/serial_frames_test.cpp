// SPDX-License-Identifier: Apache-2.0
// Frames of a serial line: round trips, what is cut, lost and damaged, and lines that never end.
#include "transport/serial_frames.hpp"

#include <random>
#include <vector>

#include "catch.hpp"
#include "fdcg_cobs.h"

using namespace fdcg::dev;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes frame_of(const Bytes& report, bool is_text = false) {
  Bytes frame(kMaxFrameBytes);
  frame.resize(static_cast<std::size_t>(make_frame(is_text, report.data(), static_cast<int>(report.size()), frame.data())));
  return frame;
}

// All that a reader makes of a stream which comes in pieces of up to `most` bytes. Too long: a report of no bytes.
std::vector<Bytes> read_all(const Bytes& stream, std::size_t most, std::mt19937_64& random, bool is_text = false) {
  FrameReader reader(is_text);
  std::vector<Bytes> reports;
  std::uint8_t report[kMaxReportBytes + 1];
  int bytes = 0;
  for (std::size_t at = 0; at < stream.size();) {
    REQUIRE(reader.room_bytes() > 0);
    const std::size_t piece =
        std::min({1 + random() % most, stream.size() - at, static_cast<std::size_t>(reader.room_bytes())});
    std::copy_n(stream.data() + at, piece, reader.room());
    reader.added(static_cast<int>(piece));
    at += piece;
    while (reader.next(report, sizeof report, &bytes))
      reports.emplace_back(report, report + (bytes > kMaxReportBytes ? 0 : bytes));
  }
  return reports;
}

}  // namespace

TEST_CASE("cobs: the frames of the published examples") {
  const auto stuffed = [](const Bytes& bytes) {
    Bytes frame(FDCG_COBS_FRAME_BYTES(bytes.size()));
    frame.resize(fdcg_cobs_encode(bytes.data(), bytes.size(), frame.data()));
    return frame;
  };
  CHECK(stuffed({0}) == Bytes{1, 1, 0});
  CHECK(stuffed({0, 0}) == Bytes{1, 1, 1, 0});
  CHECK(stuffed({0, 0x11, 0}) == Bytes{1, 2, 0x11, 1, 0});
  CHECK(stuffed({0x11, 0x22, 0, 0x33}) == Bytes{3, 0x11, 0x22, 2, 0x33, 0});
  CHECK(stuffed({0x11, 0, 0, 0}) == Bytes{2, 0x11, 1, 1, 1, 0});
  Bytes full(254, 0x55);
  CHECK(stuffed(full).size() == 256);
  full.push_back(0x66);
  CHECK(stuffed(full).size() == 258);
}

TEST_CASE("cobs: every length comes back, and no frame holds a zero") {
  std::mt19937_64 random(1);
  for (std::size_t length = 0; length < 700; ++length) {
    Bytes bytes(length);
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 0 : random());
    Bytes frame(FDCG_COBS_FRAME_BYTES(length));
    const std::size_t count = fdcg_cobs_encode(bytes.data(), length, frame.data());
    REQUIRE(count <= frame.size());
    REQUIRE(std::find(frame.begin(), frame.begin() + static_cast<long>(count), 0) ==
            frame.begin() + static_cast<long>(count) - 1);
    Bytes back(length);
    REQUIRE(fdcg_cobs_decode(frame.data(), count - 1, back.data(), length) == length);
    REQUIRE(back == bytes);
    if (length > 0) REQUIRE(fdcg_cobs_decode(frame.data(), count - 1, back.data(), length - 1) == 0);
    REQUIRE(fdcg_cobs_decode(frame.data(), count - 1, frame.data(), frame.size()) == length);  // in place
  }
}

TEST_CASE("serial frames: reports come back however the stream is cut") {
  std::mt19937_64 random(2);
  for (const bool is_text : {false, true}) {
    Bytes stream;
    std::vector<Bytes> sent;
    for (int i = 0; i < 2000; ++i) {
      Bytes report(1 + random() % (kMaxReportBytes - 1));
      for (std::uint8_t& byte : report)
        byte = static_cast<std::uint8_t>(is_text ? ' ' + random() % 90 : random() % 4 == 0 ? 0 : random());
      Bytes line = report;
      if (is_text) line.push_back('\n');
      const Bytes frame = frame_of(line, is_text);
      stream.insert(stream.end(), frame.begin(), frame.end());
      sent.push_back(report);
    }
    for (const std::size_t most : {1, 7, 64, 1000})
      REQUIRE(read_all(stream, most, random, is_text) == sent);
  }
}

TEST_CASE("serial frames: after a loss or noise the next whole frame is found") {
  std::mt19937_64 random(3);
  const Bytes good = {1, 2, 0, 3};
  for (int i = 0; i < 5000; ++i) {
    Bytes stream = frame_of(Bytes(1 + random() % 100, 0x42));
    const std::size_t cut = random() % stream.size();
    stream.erase(stream.begin() + static_cast<long>(cut), stream.end() - static_cast<long>(random() % (stream.size() - cut)));
    for (auto noise = random() % 40; noise > 0; --noise)
      stream.push_back(static_cast<std::uint8_t>(random()));
    const Bytes frame = frame_of(good);
    stream.insert(stream.end(), frame.begin(), frame.end());
    const std::vector<Bytes> reports = read_all(stream, 50, random);
    REQUIRE(!reports.empty());
    REQUIRE(reports.back() == good);
  }
}

TEST_CASE("serial frames: a line that does not end is one report that is too long") {
  std::mt19937_64 random(4);
  for (const bool is_text : {false, true}) {
    Bytes stream(5000, 'x');
    stream.push_back(frame_end(is_text));
    const Bytes frame = frame_of({'g', 'o', 'o', 'd', '!'}, is_text);
    stream.insert(stream.end(), frame.begin(), frame.end());
    if (is_text) stream.push_back('\n');
    const std::vector<Bytes> reports = read_all(stream, 100, random, is_text);
    REQUIRE(reports.size() == 2);
    CHECK(reports[0].empty());
    CHECK(reports[1] == Bytes{'g', 'o', 'o', 'd', '!'});
  }
}
