// SPDX-License-Identifier: Apache-2.0
// Any bytes as a device's reports, by a profile that they choose too: what is good is finite and reads the same once more, the
// judge's numbers stay finite, and no effort makes an output report say anything but a finite one.
//
// 8 bytes: which random profile. Then, again and again: a byte of length, two of the time since, the report. A length from 128
// on means a report of the right length whose id, constants and checksum are put right, so that its fields are read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

#include "profile/crc.hpp"
#include "profile/report_codec.hpp"
#include "profile_in_order.hpp"
#include "random_profile.hpp"

namespace {

using namespace fdcg::dev;

void require(bool is_kept, const char* promise) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

class Bytes {
 public:
  Bytes(const unsigned char* data, std::size_t size) : data_(data), left_(size) {}
  std::size_t left() const { return left_; }
  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof value, left_);
    std::memcpy(&value, take_bytes(count), count);
    return value;
  }
  const unsigned char* take_bytes(std::size_t count) {
    const unsigned char* first = data_;
    data_ += count;
    left_ -= count;
    return first;
  }

 private:
  const unsigned char* data_;
  std::size_t left_;
};

// Id, constants and checksum as they must be; the other fields as they are.
void put_right(const ReportLayout& layout, std::uint8_t* data) {
  const auto store = [data](int offset, int bytes, bool is_big_endian, std::uint32_t raw) {
    for (int i = 0; i < bytes; ++i)
      data[offset + i] = static_cast<std::uint8_t>(raw >> 8 * (is_big_endian ? bytes - 1 - i : i));
  };
  if (layout.id != 0) data[0] = layout.id;
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    if (field.role == Role::kConstant) store(field.offset, bytes_of(field.type), field.is_big_endian, field.constant);
  }
  const Crc& crc = layout.crc;
  store(crc.offset, bytes_of(crc.kind), crc.is_big_endian, crc_of(crc.kind, data + crc.first, crc.bytes));
}

void check_good(const Profile& profile, const Sample& sample) {
  for (const double value : sample.axis)
    require(std::isfinite(value), "a good sample is finite");
  std::uint8_t data[kMaxReportBytes];
  encode_input(profile, sample, data);
  Sample again;
  require(decode_input(profile, data, profile.input.bytes, &again) == Verdict::kGood, "a good sample is good again");
  require(again.sequence == sample.sequence && again.echo == sample.echo && again.buttons == sample.buttons, "counters stay");
  require(again.has_fault == sample.has_fault, "a fault stays");
}

// The bytes also as efforts, whatever numbers they are.
void check_output(const Profile& profile, const unsigned char* data, std::size_t size) {
  Command command;
  if (size > 0) std::memcpy(command.effort, data, std::min(size, sizeof command.effort));
  command.is_enabled = size % 2 == 0;
  std::uint8_t report[kMaxReportBytes];
  encode_output(profile, command, report);
  Command taken;
  require(decode_output(profile, report, profile.output.bytes, &taken), "an output report is in order, and finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  Bytes bytes(data, size);
  std::mt19937_64 random(bytes.take<std::uint64_t>());
  const Profile profile = random_profile(random);
  require(trouble_of(profile) == nullptr, "a random profile is in order");
  ReportJudge judge;
  double host_s = 0;
  while (bytes.left() > 0) {
    const std::size_t length = bytes.take<std::uint8_t>();
    host_s += bytes.take<std::uint16_t>() * 1e-5;
    const bool is_right = length >= 128;
    const std::size_t count = std::min<std::size_t>(is_right ? profile.input.bytes : length, bytes.left());
    const unsigned char* first = bytes.take_bytes(count);
    std::vector<std::uint8_t> report(first, first + count);  // on the heap: a read beyond it shows
    if (is_right) {
      report.resize(profile.input.bytes);
      put_right(profile.input, report.data());
    }
    Sample sample;
    check_output(profile, report.data(), report.size());
    if (decode_input(profile, report.data(), static_cast<int>(report.size()), &sample) != Verdict::kGood) continue;
    check_good(profile, sample);
    judge_report(profile, sample, host_s, &judge);
    require(std::isfinite(judge.least_offset_s) && std::isfinite(judge.last_time_s), "the judge's clock is finite");
    require(judge.outsiders <= kRestartReports, "a restart is taken in time");
  }
  return 0;
}
