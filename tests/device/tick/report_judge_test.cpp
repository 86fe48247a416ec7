// SPDX-License-Identifier: Apache-2.0
// Which reports are new, in order and fresh: wrapping counters, lost, repeated, late and old reports, restarts, drifting
// clocks.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"
#include "profile/report_codec.hpp"

namespace {

using namespace fdcg::dev;

constexpr double kRate = 1000, kPeriod = 1 / kRate;

// A device that counts and dates its reports, and the host's judge.
struct Stream {
  Profile profile;
  ReportJudge judge;
  std::uint32_t sequence = 0;
  double drift = 0;            // of the device's clock against the host's
  double device_start_s = 12;  // of its clock at host time 0

  Stream(const NumberType* sequence_type, const NumberType* time_type, double time_scale = 1e-6) {
    profile.rate_hz = kRate;
    if (sequence_type != nullptr) add(Role::kSequence, *sequence_type, 1);
    if (time_type != nullptr) add(Role::kTime, *time_type, time_scale);
  }
  void add(Role role, NumberType type, double scale) {
    Field& field = profile.input.fields[profile.input.field_count++];
    field.role = role;
    field.type = type;
    field.scale = scale;
    field.offset = profile.input.bytes;
    profile.input.bytes = static_cast<std::uint16_t>(profile.input.bytes + bytes_of(type));
  }
  // Made at made_s of the host's clock, as the bytes carry it.
  Sample made(double made_s) {
    Sample sample;
    sample.sequence = sequence++;
    sample.time_s = device_start_s + made_s * (1 + drift);
    std::uint8_t data[8];
    encode_input(profile, sample, data);
    if (decode_input(profile, data, profile.input.bytes, &sample) != Verdict::kGood) FAIL("does not decode");
    return sample;
  }
  Verdict read(const Sample& sample, double host_s) { return judge_report(profile, sample, host_s, &judge); }
  Verdict tick(double host_s) { return read(made(host_s), host_s); }
  // Good reports for so long; the host's time after them.
  double run(double from_s, double for_s) {
    const int count = static_cast<int>(std::lround(for_s * kRate));
    for (int i = 0; i < count; ++i)
      REQUIRE(tick(from_s + i * kPeriod) == Verdict::kGood);
    return from_s + count * kPeriod;
  }
};

constexpr NumberType kU8 = NumberType::kU8, kU16 = NumberType::kU16, kU32 = NumberType::kU32;

}  // namespace

TEST_CASE("report judge: a wrapping sequence is good without loss") {
  for (const NumberType type : {kU8, kU16, kU32}) {
    Stream stream(&type, nullptr);
    stream.sequence = 0xFFFFFF00;
    stream.run(0, 70);
    CHECK(stream.judge.lost == 0);
  }
}

TEST_CASE("report judge: a wrapping device clock is good") {
  for (const NumberType type : {kU16, kU32}) {
    Stream stream(&kU32, &type);
    stream.device_start_s = type == kU32 ? 4294.0 : 0.06;  // shortly before it
    stream.run(0, 10);
  }
  Stream coarse(&kU8, &kU8, 1e-3);  // goes round four times a second
  coarse.run(0, 10);
}

TEST_CASE("gaps are counted as lost reports") {
  for (const NumberType type : {kU8, kU16, kU32}) {
    Stream stream(&type, &kU32);
    double now_s = stream.run(0, 0.1);
    for (const unsigned gap : {1U, 2U, 100U}) {
      stream.sequence += gap;
      now_s += gap * kPeriod;
      CHECK(stream.tick(now_s) == Verdict::kGood);
      now_s += kPeriod;
    }
    CHECK(stream.judge.lost == 103);
  }
}

TEST_CASE("report judge: a repeated report is detected every time") {
  Stream stream(&kU16, &kU32);
  double now_s = stream.run(0, 0.1);
  const Sample sample = stream.made(now_s);
  CHECK(stream.read(sample, now_s) == Verdict::kGood);
  for (int i = 1; i < 1000; ++i)
    CHECK(stream.read(sample, now_s + i * kPeriod) == Verdict::kRepeated);
  stream.sequence += 999;
  stream.run(now_s + 1, 0.1);
}

TEST_CASE("report judge: without a sequence, a fine clock detects repeated reports") {
  Stream stream(nullptr, &kU32);
  const double now_s = stream.run(0, 0.1);
  const Sample sample = stream.made(now_s);
  CHECK(stream.read(sample, now_s) == Verdict::kGood);
  CHECK(stream.read(sample, now_s + kPeriod) == Verdict::kRepeated);

  Stream coarse(nullptr, &kU32, 2e-3);  // two reports a step
  coarse.run(0, 1);
}

TEST_CASE("report judge: with neither sequence nor clock every report is good") {
  Stream stream(nullptr, nullptr);
  for (int i = 0; i < 10; ++i)
    CHECK(stream.read(Sample{}, 0.5) == Verdict::kGood);
}

TEST_CASE("report judge: one overtaken report is out of order, the next are good") {
  for (const NumberType type : {kU8, kU16, kU32}) {
    Stream stream(&type, &kU32);
    const double now_s = stream.run(0, 0.1);
    const Sample late = stream.made(now_s);
    CHECK(stream.tick(now_s + kPeriod) == Verdict::kGood);
    CHECK(stream.read(late, now_s + 1.1 * kPeriod) == Verdict::kOutOfOrder);
    CHECK(stream.judge.lost == 1);
    stream.run(now_s + 2 * kPeriod, 0.1);
  }
}

TEST_CASE("old reports between good ones never count as a restart") {
  Stream stream(&kU32, &kU32);
  std::vector<Sample> old;
  for (int i = 0; i < 100; ++i) {
    old.push_back(stream.made(i * kPeriod));
    CHECK(stream.read(old.back(), i * kPeriod) == Verdict::kGood);
  }
  for (int i = 0; i < 100; ++i) {
    const double now_s = 0.1 + i * kPeriod;
    CHECK(stream.tick(now_s) == Verdict::kGood);
    CHECK(stream.read(old[static_cast<std::size_t>(i)], now_s) == Verdict::kOutOfOrder);
  }
}

TEST_CASE("a restart is out of order for a while, then taken as new") {
  for (const bool has_sequence : {true, false}) {
    for (const bool has_time : {true, false}) {
      if (!has_sequence && !has_time) continue;
      INFO(has_sequence << has_time);
      Stream stream(has_sequence ? &kU32 : nullptr, has_time ? &kU32 : nullptr);
      stream.sequence = 1000000;
      stream.device_start_s = 3000;
      double now_s = stream.run(0, 5);
      stream.sequence = 0;
      stream.device_start_s = -now_s;
      for (int i = 0; i < kRestartReports; ++i, now_s += kPeriod)
        CHECK(stream.tick(now_s) == Verdict::kOutOfOrder);
      stream.run(now_s, 5);
    }
  }
}

TEST_CASE("report judge: a restart that looks like a jump ahead is detected") {
  Stream stream(&kU32, &kU32);
  stream.sequence = 0xE0000000;  // 0 is 2^29 ahead of it
  double now_s = stream.run(0, 1);
  stream.sequence = 0;
  for (int i = 0; i < kRestartReports; ++i, now_s += kPeriod)
    CHECK(stream.tick(now_s) == Verdict::kOutOfOrder);
  stream.run(now_s, 1);
  CHECK(stream.judge.lost == 0);
}

TEST_CASE("noise in a report without a checksum costs that report") {
  Stream stream(&kU32, &kU32);
  double now_s = stream.run(0, 1);
  for (int bit = 24; bit < 32; ++bit) {
    Sample sample = stream.made(now_s);
    sample.sequence ^= 1U << bit;
    CHECK(stream.read(sample, now_s) == Verdict::kOutOfOrder);
    now_s = stream.run(now_s + kPeriod, 0.1);
  }
  for (int bit = 20; bit < 32; ++bit) {  // of the time: from one second on
    Sample sample = stream.made(now_s);
    sample.time_s = std::fmod(sample.time_s + std::ldexp(1e-6, bit), std::ldexp(1e-6, 32));
    CHECK(stream.read(sample, now_s) == Verdict::kOutOfOrder);
    now_s = stream.run(now_s + kPeriod, 0.1);
  }
}

// The host sleeps for 300 ms: the kernel keeps the 64 oldest reports and drops the newer.
TEST_CASE("report judge: queued reports after a host's sleep are stale, the next one is good") {
  for (const NumberType type : {kU8, kU16, kU32}) {
    Stream stream(&type, &kU32);
    const double asleep_s = stream.run(0, 1), awake_s = asleep_s + 0.3;
    int index = 0;
    for (; index < 64; ++index)
      CHECK(stream.read(stream.made(asleep_s + index * kPeriod), awake_s) == Verdict::kStale);
    stream.sequence += 300 - 64;
    if (type != kU8) {
      stream.run(awake_s, 1);
      CHECK(stream.judge.lost == 300 - 64);
    } else {  // 237 steps are more than half of its round: they look like 19 back
      double now_s = awake_s;
      int rejected = 0;
      for (; stream.tick(now_s) != Verdict::kGood; now_s += kPeriod)
        REQUIRE(++rejected <= kRestartReports);
      stream.run(now_s + kPeriod, 1);
    }
  }
}

TEST_CASE("report judge: the clock alone gives the age to within a millisecond") {
  Stream stream(nullptr, &kU32);
  const double now_s = stream.run(0, 1);
  Stream fresh = stream, stale = stream;
  CHECK(fresh.read(fresh.made(now_s), now_s + kMaxAgeS - 0.001) == Verdict::kGood);
  CHECK(stale.read(stale.made(now_s), now_s + kMaxAgeS + 0.001) == Verdict::kStale);
}

TEST_CASE("report judge: after a silence longer than the clock's range reports are stale until it settles") {
  Stream stream(&kU32, &kU16);  // goes round in 65 ms
  const double asleep_s = stream.run(0, 1);
  // A sleep of exactly ten rounds: by the clock alone the waiting reports would be fresh.
  const double awake_s = asleep_s + 10 * 0.065536;
  for (int i = 0; i < 64; ++i)
    CHECK(stream.read(stream.made(asleep_s + i * kPeriod), awake_s) != Verdict::kGood);
  double now_s = awake_s;
  for (; now_s < awake_s + kSettleS; now_s += kPeriod)
    CHECK(stream.tick(now_s) != Verdict::kGood);
  now_s += 0.03;
  stream.sequence += 30;
  int good = 0;
  for (int i = 0; i < 1000; ++i, now_s += kPeriod)
    good += stream.tick(now_s) == Verdict::kGood ? 1 : 0;
  CHECK(good > 950);
}

TEST_CASE("clocks that drift by 200 ppm either way stay fresh for hours, and age still shows") {
  std::mt19937_64 random(1);
  std::exponential_distribution<double> delay(1 / 0.0002);  // of the bus and the scheduler; 0.2 ms in the mean
  for (const double drift : {kMostDrift, -kMostDrift, 0.0}) {
    INFO(drift);
    Stream stream(&kU32, &kU32);
    stream.drift = drift;
    double host_s = 0;
    long stale = 0;
    const long count = 4 * 3600 * 1000;
    for (long i = 0; i < count; ++i) {
      const double made_s = static_cast<double>(i) * kPeriod;
      host_s = std::max(host_s, made_s + std::min(delay(random), 0.003));
      stale += judge_report(stream.profile, stream.made(made_s), host_s, &stream.judge) != Verdict::kGood;
    }
    CHECK(stale == 0);
    CHECK(stream.judge.lost == 0);
    const double made_s = static_cast<double>(count) * kPeriod;
    CHECK(stream.read(stream.made(made_s), made_s + 0.008) == Verdict::kStale);
  }
}

TEST_CASE("report judge: a persistent queue is stale for at least twenty seconds") {
  Stream stream(&kU32, &kU32);
  const double now_s = stream.run(0, 10);
  for (int i = 0; i < 20000; ++i)
    REQUIRE(stream.read(stream.made(now_s + i * kPeriod), now_s + i * kPeriod + 0.0111) == Verdict::kStale);
}

TEST_CASE("report judge: any counters keep its state consistent") {
  std::mt19937_64 random(7);
  for (int run = 0; run < 200; ++run) {
    const NumberType types[3] = {kU8, kU16, kU32};
    Stream stream(run % 3 == 2 ? nullptr : &types[random() % 3], run % 5 == 4 ? nullptr : &types[random() % 3],
                  std::pow(10.0, -static_cast<double>(random() % 7)));
    double host_s = 0;
    for (int i = 0; i < 2000; ++i) {
      Sample sample = stream.made(host_s);
      if (random() % 4 == 0) sample.sequence = static_cast<std::uint32_t>(random());
      if (random() % 4 == 0) sample.time_s = static_cast<double>(random() % 100000) * 1e-3;
      host_s += std::ldexp(1.0, -static_cast<int>(random() % 16));
      const std::uint64_t lost = stream.judge.lost;
      stream.read(sample, host_s);
      REQUIRE(stream.judge.lost - lost <= 0xFFFFFFFF);
      REQUIRE(std::isfinite(stream.judge.least_offset_s));
      REQUIRE(std::isfinite(stream.judge.last_time_s));
      REQUIRE(stream.judge.outsiders <= kRestartReports);
    }
  }
}
