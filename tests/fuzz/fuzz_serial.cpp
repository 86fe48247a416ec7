// SPDX-License-Identifier: Apache-2.0
// Any bytes as what comes over a serial line, in pieces: reports of bytes and of text come out that the judge may be given, and
// a whole frame at the end is found whatever stood before it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fdcg_cobs.h"
#include "profile/report_codec.hpp"
#include "transport/serial_frames.hpp"

namespace {

using namespace fdcg::dev;

void require(bool is_kept, const char* promise) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

Profile profile_of(bool is_text) {
  Profile profile;
  profile.rate_hz = 1000;
  profile.axis_count = 1;
  Field& axis = profile.input.fields[profile.input.field_count++];
  axis.role = Role::kAxis;
  axis.type = is_text ? NumberType::kU32 : NumberType::kI24;
  axis.scale = 1e-6;
  Field& sequence = profile.input.fields[profile.input.field_count++];
  sequence.role = Role::kSequence;
  sequence.type = NumberType::kU16;
  sequence.offset = is_text ? 1 : 3;
  sequence.bits = is_text ? 0 : 12;
  sequence.bit = is_text ? 0 : 3;
  profile.input.columns = is_text ? 2 : 0;
  profile.input.bytes = is_text ? kMaxReportBytes : 5;
  return profile;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size < 2) return 0;
  const bool is_text = data[0] % 2 == 0;
  const std::size_t most = 1 + data[1];
  const Profile profile = profile_of(is_text);
  FrameReader reader(is_text);
  std::uint8_t report[kMaxReportBytes + 1];
  int bytes = 0;
  std::uint32_t last_sequence = 0;
  const auto take_all = [&] {
    while (reader.next(report, sizeof report, &bytes)) {
      require(bytes > 0 && bytes <= kMaxReportBytes + 1, "a report has a length");
      Sample sample;
      if (decode_input(profile, report, bytes, &sample) != Verdict::kGood) continue;
      require(std::isfinite(sample.axis[0]), "a good report has numbers");
      require(sample.sequence <= mask_of(profile.input.fields[1]), "a counter is no wider than its field");
      last_sequence = sample.sequence;
    }
  };
  for (std::size_t at = 2; at < size;) {
    require(reader.room_bytes() > 0, "there is room");
    const std::size_t piece = std::min({most, size - at, static_cast<std::size_t>(reader.room_bytes())});
    std::memcpy(reader.room(), data + at, piece);
    reader.added(static_cast<int>(piece));
    at += piece;
    take_all();
  }
  Sample sample;
  sample.axis[0] = 0.25;
  sample.sequence = 0xABC;
  std::uint8_t frame[kMaxFrameBytes];
  const int count = make_frame(is_text, report, encode_input(profile, sample, report), frame);
  for (int at = 0; at < count; ++at) {
    *reader.room() = frame[at];
    reader.added(1);
    take_all();
  }
  require(last_sequence == 0xABC, "a whole frame is found after any noise");
  return 0;
}
