// SPDX-License-Identifier: Apache-2.0
// The firmware core as a device, and output reports as a host would write them, by a second hand.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "catch.hpp"
#include "fdcg_firmware.h"

namespace fdcg::test {

inline constexpr fdcg_fw_config kConfig = {1000000, {-80, -60, -50}, {80, 60, 50}, 3.3f, 0.9f, 1000, 20, 3, FDCG_FW_CARTESIAN};
inline constexpr std::int32_t kCounts[3] = {12000, -3500, 250};
using Bytes = std::vector<std::uint8_t>;

inline Bytes output(std::uint32_t sequence, std::array<float, 3> force_n, std::uint32_t answers, std::uint8_t flags) {
  Bytes bytes(FDCG_FW_OUTPUT_BYTES);
  bytes[0] = FDCG_FW_OUTPUT_ID;
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i)
      bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
  };
  put(1, sequence);
  for (int i = 0; i < 3; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, &force_n[i], 4);
    put(5 + 4 * i, bits);
  }
  put(17, answers);
  bytes[21] = flags;
  const std::uint16_t crc = fdcg_fw_crc16(bytes.data(), bytes.size() - 2);
  bytes[22] = static_cast<std::uint8_t>(crc);
  bytes[23] = static_cast<std::uint8_t>(crc >> 8);
  return bytes;
}

struct Device {
  fdcg_fw fw;
  std::uint32_t time_us = 1000;
  std::uint32_t sequence = 0;  // of the last output report sent

  explicit Device(const fdcg_fw_config& config = kConfig) { fdcg_fw_init(&fw, &config); }
  fdcg_fw_verdict take(const Bytes& bytes) { return fdcg_fw_take_output(&fw, time_us, bytes.data(), bytes.size()); }
  fdcg_fw_verdict send(std::array<float, 3> force_n, std::uint8_t flags = FDCG_FW_ENABLE) {
    return take(output(++sequence, force_n, fw.sequence, flags));
  }
  Bytes input() {
    Bytes bytes(FDCG_FW_INPUT_BYTES);
    fdcg_fw_make_input(&fw, time_us, kCounts, 1, bytes.data());
    return bytes;
  }
  unsigned status() { return input()[26]; }
  std::array<float, 3> force() {
    std::array<float, 3> force_n;
    fdcg_fw_force(&fw, time_us, force_n.data());
    return force_n;
  }
};

inline constexpr std::array<float, 3> kZero = {0, 0, 0}, kPush = {0, 0.5f, -1.25f};

// Armed, with kPush.
inline Device pushing() {
  Device device;
  REQUIRE(device.send(kZero, 0) == FDCG_FW_TAKEN);
  REQUIRE(device.send(kPush) == FDCG_FW_TAKEN);
  REQUIRE(device.force() == kPush);
  return device;
}

}  // namespace fdcg::test
