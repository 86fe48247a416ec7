// SPDX-License-Identifier: Apache-2.0
// Every tick of a measured way, for readers who trust no summary: report/raw.py reads it.
#pragma once

#include <string>
#include <vector>

#include "timing.hpp"
#include "truth.hpp"

namespace fdcg::test {

struct RawWay {
  std::string body, way;
  std::uint32_t faces = 0;
  std::uint64_t seed = 0;
};
struct RawContender {
  std::string name, family;
  bool is_control = false;     // the same graph made once more: what its time differs by tells nothing
  std::vector<float> error_m;  // of the god-object, from the nearest right answer, each tick; empty for a control
};

// FOLDER/raw/BODY.WAY.SEED.raw.gz: gzip of a line of JSON, then floats of 32 bits, little-endian, without gaps: `contact` and
// `tied` of the truth (0 or 1: other answers are as right), then for each contender in order `warm_ns`, `error_m` (both of all
// ticks) and `cold_ns` (of cold_ticks). The JSON has the members of RawWay, `format`, `ticks`, `rounds`, `swept_bytes`,
// `cold_ticks` (a list) and `contenders` (name, family, control). Throws std::runtime_error where it cannot be written.
void write_raw(const std::string& folder, const RawWay& way, const std::vector<TrueBody::Tick>& truth,
               const std::vector<std::uint32_t>& cold_ticks, const std::vector<RawContender>& contenders,
               const std::vector<Timing>& timings);

}  // namespace fdcg::test
