// SPDX-License-Identifier: Apache-2.0
// Any bytes as what a firmware core is called with: an operation and its bytes, then the next. Whatever comes, the force is
// finite, no longer than the peak force, and zero where it has to be.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "fdcg_firmware.h"

namespace {

void require(bool is_kept, const char* promise) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

struct Bytes {
  const unsigned char* at;
  std::size_t left;

  unsigned next() { return left == 0 ? 0 : (--left, *at++); }
  template <class Number>
  Number number() {
    Number value{};
    unsigned char raw[sizeof value];
    for (unsigned char& byte : raw)
      byte = static_cast<unsigned char>(next());
    std::memcpy(&value, raw, sizeof value);
    return value;
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  Bytes bytes{data, size};
  fdcg_fw_config config = {1000000, {-80, -60, -50}, {80, 60, 50}, 3.3f, 0.9f, 1000, 20, 3, FDCG_FW_CARTESIAN};
  if (bytes.next() % 4 == 0) {
    config.counts_per_unit = bytes.number<std::uint32_t>();
    config.peak_force_n = bytes.number<float>();
    config.rate_hz = bytes.number<std::uint16_t>();
    config.watchdog_ms = bytes.number<std::uint16_t>();
    config.dof = bytes.number<std::uint8_t>();
    config.axes = bytes.number<std::uint8_t>();
  }
  fdcg_fw fw;
  const bool is_valid = fdcg_fw_init(&fw, &config);
  std::uint32_t now_us = bytes.number<std::uint32_t>(), sequence = 0, taken_us = 0;
  bool was_taken = false;
  while (bytes.left > 0) {
    std::uint8_t report[64];
    switch (bytes.next() % 6) {
      case 0: {  // as it comes
        std::vector<std::uint8_t> raw(bytes.next() % 40);
        for (std::uint8_t& byte : raw)
          byte = static_cast<std::uint8_t>(bytes.next());
        fdcg_fw_take_output(&fw, now_us, raw.data(), raw.size());
        was_taken = false;  // not known
        break;
      }
      case 1: {  // with its checksum
        std::uint8_t out[FDCG_FW_OUTPUT_BYTES] = {FDCG_FW_OUTPUT_ID};
        sequence += bytes.next() % 3;
        std::memcpy(out + 1, &sequence, 4);
        for (int i = 0; i < 3; ++i) {
          const auto force = bytes.number<float>();
          std::memcpy(out + 5 + 4 * i, &force, 4);
        }
        const std::uint32_t answers = fw.sequence - bytes.next() % 4;
        std::memcpy(out + 17, &answers, 4);
        out[21] = static_cast<std::uint8_t>(bytes.next() % 4);
        const std::uint16_t crc = fdcg_fw_crc16(out, sizeof out - 2);
        out[22] = static_cast<std::uint8_t>(crc), out[23] = static_cast<std::uint8_t>(crc >> 8);
        if (fdcg_fw_take_output(&fw, now_us, out, sizeof out) == FDCG_FW_TAKEN) {
          was_taken = true;
          taken_us = now_us;
        }
        break;
      }
      case 2: {
        const std::int32_t counts[3] = {bytes.number<std::int32_t>(), 0, bytes.number<std::int32_t>()};
        fdcg_fw_make_input(&fw, now_us, counts, static_cast<std::uint8_t>(bytes.next()), report);
        break;
      }
      case 3:
        now_us += bytes.number<std::uint16_t>();
        break;
      case 4:
        fdcg_fw_set_faults(&fw, static_cast<std::uint8_t>(bytes.next()));
        break;
      default:
        fdcg_fw_stop(&fw);
        was_taken = false;
        break;
    }
    float force[3];
    fdcg_fw_force(&fw, now_us, force);
    const double length = std::sqrt(double{force[0]} * force[0] + double{force[1]} * force[1] + double{force[2]} * force[2]);
    require(std::isfinite(length), "the force is finite");
    require(length <= (is_valid ? config.peak_force_n * 1.000001 : 0), "the force is no longer than the peak force");
    if (was_taken && now_us - taken_us > 1000U * config.watchdog_ms) require(length == 0, "the watchdog takes the force away");
  }
  return 0;
}
