// SPDX-License-Identifier: Apache-2.0
#include "tick/tick_bytes.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "catch.hpp"
#include "session_rig.hpp"

using namespace fdcg::dev;

namespace {

LoggedOutput any_output(Random& random) {
  LoggedOutput output;
  const auto fill_part = [&random](double* values, int count) {
    if (random() % 2 == 0) return;
    for (int i = 0; i < count; ++i)
      values[i] = any_double(random);
  };
  fill_part(output.effort, kMaxAxes);
  fill_part(output.force_n, 3);
  fill_part(output.hip_world_m, 3);
  fill_part(output.wanted_force_n, 3);
  fill_part(output.sample.axis, kMaxAxes);
  output.is_enabled = random() % 2;
  output.arming_refused = random() % 2;
  output.has_sample = random() % 2;
  output.phase = static_cast<std::uint8_t>(random() % 4);
  output.fault = static_cast<std::uint8_t>(random() % kFaults);
  output.state = static_cast<std::uint32_t>(random() % 4);
  if (random() % 2 == 0) output.echo = static_cast<std::uint32_t>(random());
  if (random() % 2 == 0) output.sample.sequence = static_cast<std::uint32_t>(random());
  if (random() % 2 == 0) output.sample.time_s = any_double(random);
  output.sample.has_fault = random() % 2;
  if (random() % 2 == 0) output.body_count = static_cast<std::uint8_t>(random() % (kMaxBodies + 1));
  for (int body = 0; body < output.body_count; ++body) {
    for (double& x : output.bodies[body].translation_m)
      x = any_double(random);
    for (double& x : output.bodies[body].rotation_xyzw)
      x = any_double(random);
  }
  return output;
}

}  // namespace

TEST_CASE("a tick's input and output are read back from their bytes") {
  Random random(11);
  std::uint8_t first[kMostTickBytes], second[kMostTickBytes];
  std::size_t most_output = 0;
  for (int round = 0; round < 20000; ++round) {
    TickInput input, back;
    fill(random, &input);
    const std::size_t bytes = encode_tick_input(input, first);
    REQUIRE(bytes <= kMostInputBytes);
    REQUIRE(decode_tick_input(first, bytes, &back) == bytes);
    REQUIRE(encode_tick_input(back, second) == bytes);
    REQUIRE(std::memcmp(first, second, bytes) == 0);
    REQUIRE(back.arm == input.arm);
    REQUIRE(back.write_busy_ns == input.write_busy_ns);
    REQUIRE(back.report_count == input.report_count);

    const LoggedOutput output = any_output(random);
    const std::size_t output_bytes = encode_tick_output(output, first);
    most_output = std::max(most_output, output_bytes);
    LoggedOutput output_back;
    REQUIRE(decode_tick_output(first, output_bytes, &output_back) == output_bytes);
    REQUIRE(first_difference(output, output_back).empty());
  }
  CHECK(most_output <= kMostOutputBytes);
  CHECK(most_output > kMostOutputBytes / 2);
}

TEST_CASE("the largest tick fits into its buffer") {
  TickInput input;
  input.pose_count = kMaxDriven;
  input.report_count = kMaxDrain;
  for (RawReport& report : input.reports)
    report.bytes = kMaxReportBytes + 1;
  std::uint8_t bytes[kMostTickBytes];
  CHECK(encode_tick_input(input, bytes) <= kMostInputBytes);
}

TEST_CASE("invalid tick bytes are refused without reading beyond the end") {
  Random random(12);
  std::uint8_t bytes[kMostTickBytes];
  TickInput input, back;
  LoggedOutput output;
  for (int round = 0; round < 50; ++round) {
    fill(random, &input);
    const std::size_t input_bytes = encode_tick_input(input, bytes);
    for (std::size_t cut = 0; cut < std::min<std::size_t>(input_bytes, 600); ++cut) {
      const std::vector<std::uint8_t> copy(bytes, bytes + cut);
      REQUIRE(decode_tick_input(copy.data(), cut, &back) == 0);
    }
    const std::size_t output_bytes = encode_tick_output(any_output(random), bytes);
    for (std::size_t cut = 0; cut < output_bytes; ++cut) {
      const std::vector<std::uint8_t> copy(bytes, bytes + cut);
      REQUIRE(decode_tick_output(copy.data(), cut, &output) == 0);
    }
    for (std::size_t i = 0; i < output_bytes; ++i) {
      std::vector<std::uint8_t> copy(bytes, bytes + output_bytes);
      copy[i] = static_cast<std::uint8_t>(random());
      REQUIRE(decode_tick_output(copy.data(), copy.size(), &output) <= copy.size());
    }
  }
  LoggedOutput crowded;
  crowded.body_count = kMaxBodies;
  const std::size_t crowded_bytes = encode_tick_output(crowded, bytes);
  CHECK(crowded_bytes <= kMostOutputBytes);
  bytes[6] = kMaxBodies + 1;  // the first of the only part
  CHECK(decode_tick_output(bytes, kMostTickBytes, &output) == 0);
  for (const std::size_t place : {36u, 37u, 38u, 39u}) {  // read, flags, poses, reports
    input = TickInput{};
    const std::size_t count = encode_tick_input(input, bytes);
    bytes[place] = 200;
    CHECK(decode_tick_input(bytes, count, &back) == 0);
  }
}

TEST_CASE("the first field that differs is named with both values") {
  LoggedOutput a, b;
  CHECK(first_difference(a, b).empty());
  b.wanted_force_n[2] = 1.5;
  CHECK(first_difference(a, b) == "wanted_force_n[2]: 0 in the log, 1.5 in the replay");
  b = a;
  b.hip_world_m[0] = -0.0;  // equal, but not the same bits
  CHECK(first_difference(a, b) == "hip_world_m[0]: 0 in the log, -0 in the replay");
  b = a;
  a.body_count = b.body_count = 3;
  b.bodies[2].rotation_xyzw[3] = 1;
  CHECK(first_difference(a, b) == "bodies[2].qw: 0 in the log, 1 in the replay");
  b.body_count = 2;
  CHECK(first_difference(a, b) == "body_count: 3 in the log, 2 in the replay");
  b = a = LoggedOutput();
  a.phase = 2;
  CHECK(first_difference(a, b) == "phase: 2 in the log, 0 in the replay");
}
