// SPDX-License-Identifier: Apache-2.0
// The firmware core: what it takes and what not, and that whatever arrives it never pushes beyond its limits.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "catch.hpp"
#include "firmware_rig.hpp"

using namespace fdcg::test;

TEST_CASE("firmware: no force at power-up until a report without enable has come") {
  Device device;
  CHECK(device.force() == kZero);
  CHECK(device.send(kPush) == FDCG_FW_HELD);
  CHECK(device.force() == kZero);
  CHECK(device.status() == 0);
  CHECK(device.fw.echo == 1);  // heard, all the same
  CHECK(device.send(kPush, 0) == FDCG_FW_TAKEN);
  CHECK(device.force() == kZero);
  CHECK(device.send(kPush) == FDCG_FW_TAKEN);
  CHECK(device.force() == kPush);
  CHECK(device.status() == FDCG_FW_ENABLED);
}

TEST_CASE("firmware: the watchdog drops the force after its time, and enabled reports do not reset it") {
  Device device = pushing();
  device.time_us += 19999;
  CHECK(device.force() == kPush);
  device.time_us += 1;
  CHECK(device.force() == kZero);
  CHECK(device.status() == FDCG_FW_WATCHDOG);
  CHECK(device.send(kPush) == FDCG_FW_HELD);
  CHECK(device.force() == kZero);
  CHECK(device.send(kZero, 0) == FDCG_FW_TAKEN);
  CHECK(device.status() == 0);
  CHECK(device.send(kPush) == FDCG_FW_TAKEN);
  CHECK(device.force() == kPush);
}

TEST_CASE("firmware: the watchdog also trips when only reports arrive, and across the clock's wrap") {
  Device device;
  device.time_us = 0xFFFFFFF0u;
  device.send(kZero, 0);
  device.send(kPush);
  device.time_us += 19999;
  CHECK(device.status() == FDCG_FW_ENABLED);
  device.time_us += 1;
  SECTION("input") {
    CHECK(device.status() == FDCG_FW_WATCHDOG);
  }
  SECTION("output") {
    CHECK(device.send(kPush) == FDCG_FW_HELD);
  }
  CHECK(device.force() == kZero);
}

TEST_CASE("firmware: rejected reports do not reset the watchdog") {
  Device device = pushing();
  for (int i = 0; i < 20; ++i) {
    device.time_us += 1000;
    Bytes bad = output(++device.sequence, kPush, device.fw.sequence, FDCG_FW_ENABLE);
    bad[7] ^= 1;
    CHECK(device.take(bad) == FDCG_FW_CRC);
  }
  CHECK(device.force() == kZero);
}

TEST_CASE("firmware: what makes an output report invalid") {
  Device device = pushing();
  const std::array<float, 3> other = {1, 1, 1};
  const std::uint32_t next = device.sequence + 1, answers = device.fw.sequence;
  Bytes bytes = output(next, other, answers, FDCG_FW_ENABLE);
  SECTION("short") {
    bytes.pop_back();
    CHECK(device.take(bytes) == FDCG_FW_LENGTH);
    CHECK(device.take({}) == FDCG_FW_LENGTH);
  }
  SECTION("long") {
    bytes.push_back(0);
    CHECK(device.take(bytes) == FDCG_FW_LENGTH);
  }
  SECTION("unknown id") {
    bytes[0] = 9;
    CHECK(device.take(bytes) == FDCG_FW_ID);
  }
  SECTION("every single bit") {
    for (std::size_t bit = 8; bit < 8 * bytes.size(); ++bit) {
      Bytes flipped = bytes;
      flipped[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      CHECK(device.take(flipped) == FDCG_FW_CRC);
    }
  }
  SECTION("unknown flags") {
    CHECK(device.take(output(next, other, answers, 0x03)) == FDCG_FW_FLAGS);
  }
  SECTION("not finite") {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -HUGE_VALF})
      for (int axis = 0; axis < 3; ++axis)
        for (const std::uint8_t flags : {0, 1}) {
          std::array<float, 3> force_n = other;
          force_n[axis] = bad;
          CHECK(device.take(output(next, force_n, answers, flags)) == FDCG_FW_NOT_FINITE);
        }
  }
  SECTION("repeated, or from before") {
    CHECK(device.take(output(device.sequence, other, answers, FDCG_FW_ENABLE)) == FDCG_FW_OLD);
    CHECK(device.take(output(device.sequence - 1, other, answers, FDCG_FW_ENABLE)) == FDCG_FW_OLD);
  }
  SECTION("answers a report of more than the watchdog's time ago, or one to come") {
    for (int i = 0; i < 30; ++i)
      device.input();
    CHECK(device.take(output(next, other, device.fw.sequence - 21, FDCG_FW_ENABLE)) == FDCG_FW_STALE);
    CHECK(device.take(output(next, other, device.fw.sequence + 1, FDCG_FW_ENABLE)) == FDCG_FW_STALE);
    CHECK(device.force() == kPush);
    CHECK(device.take(output(next, kPush, device.fw.sequence - 20, FDCG_FW_ENABLE)) == FDCG_FW_TAKEN);
  }
  SECTION("a watchdog that is no whole number of reports counts the one begun") {
    fdcg_fw_config config = kConfig;
    config.rate_hz = 333;  // 6.66 in 20 ms
    Device slow(config);
    for (int i = 0; i < 10; ++i)
      slow.input();
    CHECK(slow.take(output(1, kZero, 0, 0)) == FDCG_FW_TAKEN);
    CHECK(slow.take(output(2, other, 10 - 8, FDCG_FW_ENABLE)) == FDCG_FW_STALE);
    CHECK(slow.take(output(2, other, 10 - 7, FDCG_FW_ENABLE)) == FDCG_FW_TAKEN);
  }
  CHECK(device.force() == kPush);  // the last good one is still in force
  CHECK(device.take(output(next + 1, other, device.fw.sequence, FDCG_FW_ENABLE)) == FDCG_FW_TAKEN);
}

TEST_CASE("firmware: the first report without enable of a restarted host is accepted") {
  Device device = pushing();
  device.take(output(1000000, kPush, 0, FDCG_FW_ENABLE));
  CHECK(device.take(output(1, kPush, 0, FDCG_FW_ENABLE)) == FDCG_FW_OLD);
  CHECK(device.take(output(1, kZero, 0, 0)) == FDCG_FW_TAKEN);
  CHECK(device.force() == kZero);
  CHECK(device.take(output(2, kPush, 0, FDCG_FW_ENABLE)) == FDCG_FW_TAKEN);
  CHECK(device.force() == kPush);
}

TEST_CASE("firmware: sequence numbers wrap") {
  Device device;
  CHECK(device.take(output(0xFFFFFFFFu, kZero, 0, 0)) == FDCG_FW_TAKEN);
  CHECK(device.take(output(0, kPush, 0, FDCG_FW_ENABLE)) == FDCG_FW_TAKEN);
  CHECK(device.take(output(0xFFFFFFFFu, kPush, 0, FDCG_FW_ENABLE)) == FDCG_FW_OLD);
}

TEST_CASE("firmware: faults, a stop and a bad configuration give no force, also afterwards") {
  Device device = pushing();
  SECTION("each fault") {
    for (const unsigned fault : {FDCG_FW_NOT_CALIBRATED, FDCG_FW_TOO_HOT, FDCG_FW_POWER_OFF, FDCG_FW_FAULT}) {
      device.send(kZero, 0);
      device.send(kPush);
      fdcg_fw_set_faults(&device.fw, static_cast<std::uint8_t>(fault));
      CHECK(device.force() == kZero);
      CHECK(device.status() == fault);
      CHECK(device.send(kZero, 0) == FDCG_FW_TAKEN);
      CHECK(device.send(kPush) == FDCG_FW_HELD);
      CHECK(device.force() == kZero);
      fdcg_fw_set_faults(&device.fw, 0);
      CHECK(device.status() == 0);
    }
  }
  SECTION("a fault that passes unseen") {
    fdcg_fw_set_faults(&device.fw, FDCG_FW_TOO_HOT);
    fdcg_fw_set_faults(&device.fw, 0);
    CHECK(device.send(kPush) == FDCG_FW_HELD);
  }
  SECTION("bits that are no faults") {
    fdcg_fw_set_faults(&device.fw, 0xFF);
    CHECK(device.status() == FDCG_FW_FAULTS);
    fdcg_fw_set_faults(&device.fw, 0);
  }
  SECTION("stop") {
    SECTION("after the watchdog") {
      device.time_us += 20000;
      CHECK(device.status() == FDCG_FW_WATCHDOG);
    }
    fdcg_fw_stop(&device.fw);
    CHECK(device.status() == 0);
    CHECK(device.send(kPush) == FDCG_FW_HELD);
  }
  SECTION("configuration") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<fdcg_fw_config> bad(12, kConfig);
    bad[0].peak_force_n = nan;
    bad[1].peak_force_n = 0;
    bad[2].peak_force_n = HUGE_VALF;
    bad[3].continuous_force_n = nan;
    bad[4].continuous_force_n = 4;
    bad[5].counts_per_unit = 0;
    bad[6].rate_hz = 0;
    bad[7].watchdog_ms = 0;
    bad[8].dof = 0;
    bad[9].dof = 4;
    bad[10].axes = 2;
    bad[11].peak_force_n = 1.1e6f;  // would not fit the feature report
    for (const fdcg_fw_config& config : bad) {
      CHECK_FALSE(fdcg_fw_init(&device.fw, &config));
      device.send(kZero, 0);
      CHECK(device.send(kPush) == FDCG_FW_HELD);
      fdcg_fw_set_faults(&device.fw, 0);
      CHECK(device.status() == FDCG_FW_FAULT);
      CHECK(device.force() == kZero);
    }
  }
  CHECK(device.force() == kZero);
}

TEST_CASE("firmware: a force beyond the peak is scaled down; missing axes get none") {
  Device device = pushing();
  for (const std::array<float, 3>& force_n :
       {std::array<float, 3>{3.3f, 0, 0}, {-4, 0, 0}, {3, 3, 3}, {1e30f, -1e38f, 3e38f}, {1e-40f, 3.4e38f, 0}, {2, 2, 1.7f}}) {
    CHECK(device.send(force_n) == FDCG_FW_TAKEN);
    const std::array<float, 3> got = device.force();
    const double norm = std::hypot(double(got[0]), double(got[1]), double(got[2]));
    const double asked = std::hypot(double(force_n[0]), double(force_n[1]), double(force_n[2]));
    CHECK(norm <= 3.3f);
    CHECK(norm == Approx(3.3).epsilon(3e-6));
    for (int i = 0; i < 3; ++i)
      CHECK(got[i] == Approx(force_n[i] / asked * norm).margin(1e-6));
  }
  CHECK((device.status() & FDCG_FW_CLIPPED) != 0);
  CHECK(device.send({1.9f, 1.9f, 1.9f}) == FDCG_FW_TAKEN);  // 3.29 N: as it came
  CHECK(device.force() == std::array<float, 3>{1.9f, 1.9f, 1.9f});
  CHECK((device.status() & FDCG_FW_CLIPPED) == 0);

  fdcg_fw_config one_axis = kConfig;
  one_axis.dof = 1;
  device = Device(one_axis);
  device.send(kZero, 0);
  CHECK(device.send({1, 2, 1e38f}) == FDCG_FW_TAKEN);
  CHECK(device.force() == std::array<float, 3>{1, 0, 0});
  const Bytes input = device.input();
  CHECK(input[13] == 0);
  CHECK(input[17] == 0);
}

// Random bytes seldom have the right CRC, so most are made from good reports with some part of them changed.
TEST_CASE("firmware: with any input the force is finite, within the peak, and zero after the watchdog's time") {
  constexpr unsigned kSeed = 48;
  std::mt19937 random(kSeed);
  INFO("seed " << kSeed);
  Device device;
  std::uint32_t last_taken_us = 0;
  bool is_enabled = false;
  long taken = 0, refused = 0, nonzero = 0;
  for (int step = 0; step < 2000000; ++step) {
    const unsigned what = random() % 16;
    if (what == 0) device.input();
    if (what == 1) device.time_us += random() % 30000;
    if (what == 2 && random() % 50 == 0)
      fdcg_fw_set_faults(&device.fw, static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 0));
    if (what == 3 && random() % 100 == 0) fdcg_fw_stop(&device.fw);
    std::array<float, 3> force_n;
    for (float& f : force_n) {
      const std::uint32_t bits = random();
      std::memcpy(&f, &bits, 4);
      if (random() % 2) f = static_cast<float>(random() % 8000) * 0.001f - 4;
    }
    const bool is_any = random() % 16 == 0;
    Bytes bytes = output(is_any ? random() : device.fw.echo + 1, force_n, is_any ? random() : device.fw.sequence - random() % 3,
                         random() % 4 == 0 ? static_cast<std::uint8_t>(random() % 3) : FDCG_FW_ENABLE);
    if (random() % 32 == 0) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 32 == 0) bytes.resize(random() % 40);
    const fdcg_fw_verdict verdict = device.take(bytes);
    if (verdict <= FDCG_FW_HELD) {
      last_taken_us = device.time_us;
      is_enabled = bytes[21] == FDCG_FW_ENABLE;
      ++taken;
    } else {
      ++refused;
    }
    device.time_us += random() % 500;
    const std::array<float, 3> got = device.force();
    double squares = 0;
    for (const float f : got)
      squares += double(f) * f;
    if (!(squares <= double(3.3f) * 3.3f)) FAIL("step " << step << ": norm " << std::sqrt(squares));
    if (squares > 0) {
      ++nonzero;
      if (device.time_us - last_taken_us >= 20000) FAIL("step " << step << ": force after the watchdog's time");
      if (!is_enabled) FAIL("step " << step << ": force though not enabled");
      if (device.fw.status & (FDCG_FW_FAULTS | FDCG_FW_WATCHDOG)) FAIL("step " << step << ": force in a fault");
    }
  }
  CHECK(taken > 200000);  // the walk goes everywhere
  CHECK(refused > 200000);
  CHECK(nonzero > 200000);
}
