// SPDX-License-Identifier: Apache-2.0
// Ticks for the tests of a session's log: random ones, and ones that contain their own number.
#pragma once

#include <stdlib.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <random>
#include <string>

#include "tick/tick_bytes.hpp"

namespace fdcg::dev {

using Random = std::mt19937_64;

inline double any_double(Random& random) {
  switch (random() % 4) {
    case 0:
      return 0;
    case 1:
      return -0.0;
    case 2:
      return std::bit_cast<double>(random());  // NaN and infinities among them
    default:
      return std::uniform_real_distribution<double>(-10, 10)(random);
  }
}

inline void fill(Random& random, TickInput* input) {
  *input = TickInput{};
  input->now_ns = random();
  input->read = static_cast<ReadStatus>(random() % 3);
  input->arm = random() % 2;
  input->disarm = random() % 2;
  input->begins = random() % 2;
  input->write_failed = random() % 2;
  input->write_busy_ns = random() % 2 * random();
  input->slept_ns = random() % 2 * random();
  input->sent = {random() % 2 * random(), static_cast<std::uint32_t>(random()), random() % 2 != 0};
  input->pose_count = static_cast<std::uint32_t>(random() % 3 == 0 ? random() % (kMaxDriven + 1) : 0);
  input->report_count = static_cast<std::uint32_t>(random() % 8 == 0 ? random() % (kMaxDrain + 1) : random() % 3);
  for (std::uint32_t i = 0; i < input->pose_count; ++i) {
    for (double& x : input->poses[i].rotation_xyzw)
      x = any_double(random);
    for (double& x : input->poses[i].translation_m)
      x = any_double(random);
    input->poses[i].scale = any_double(random);
  }
  for (std::uint32_t i = 0; i < input->report_count; ++i) {
    RawReport& report = input->reports[i];
    report.host_ns = random();
    report.bytes = static_cast<std::uint16_t>(random() % (kMaxReportBytes + 2));
    for (int k = 0; k < std::min<int>(report.bytes, kMaxReportBytes); ++k)
      report.data[k] = static_cast<std::uint8_t>(random());
  }
}

// The bytes of a tick that contains its own number.
inline void number_tick(std::uint64_t number, TickInput* input, TickOutput* output) {
  Random random(number);
  fill(random, input);
  input->now_ns = number;
  output->echo = static_cast<std::uint32_t>(number);
  output->has_sample = number % 3 == 0;
  output->hip_world_m[1] = static_cast<double>(number);
}

class Folder {
 public:
  Folder() {
    char name[] = "/tmp/fdcg-session-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace fdcg::dev
