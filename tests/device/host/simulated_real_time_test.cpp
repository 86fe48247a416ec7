// SPDX-License-Identifier: Apache-2.0
// The simulated device on the machine's clock: what waits, what blocks, and two threads on it at once. Bounds hold on a busy
// machine, too.
#include <atomic>
#include <chrono>
#include <thread>

#include "base/threads.hpp"
#include "catch.hpp"
#include "fdcg_firmware.h"
#include "simulated_rig.hpp"

namespace {

using namespace fdcg::test;
using Kind = SimulatedFaultKind;
using Host = SmallHost;

}  // namespace

TEST_CASE("simulated: a host that does not read keeps the oldest reports") {
  SimulationConfig config = still();
  config.is_real_time = true;
  config.rate_hz = 8000;
  Host host(config);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  for (std::uint32_t i = 1; i <= 64; ++i) {
    REQUIRE(host.read() == Verdict::kGood);
    CHECK(host.sample.sequence == i);
  }
  host.read();
  CHECK(host.sample.sequence > 700);
  CHECK(host.record->reports_lost > 600);
}

TEST_CASE("simulated: a host that reads late gets the reports in order") {
  SimulationConfig config = still();
  config.is_real_time = true;
  config.rate_hz = 200;
  Host host(config);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  REQUIRE(host.write(false));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  REQUIRE(host.read() == Verdict::kGood);
  CHECK(host.sample.echo == 0);  // made before the write
  for (int i = 0; i < 1000 && host.sample.echo == 0; ++i)
    host.read();
  CHECK(host.sample.echo == 1);
}

TEST_CASE("simulated: a device that takes no output for 7 s fails the write after 5") {
  SimulationConfig config = still();
  config.is_real_time = true;
  config.faults = {fault(Kind::kNoOutput, 0, 7)};
  Host host(config);
  CHECK_FALSE(host.write(false));
  const std::uint64_t now = monotonic_ns() - host.record->origin_ns;
  CHECK(now >= 5000000000);
  host.transport->close();
  CHECK(host.record->verdicts[FDCG_FW_TAKEN] == 0);
}

TEST_CASE("simulated: in real time the device uses the real clock, and a write that is not taken blocks") {
  constexpr std::uint64_t kMs = 1000000;
  SimulationConfig config = still();
  config.is_real_time = true;
  config.faults = {fault(Kind::kNoOutput, 0.1, 0.4)};
  Host host(config);
  const auto now = [&] { return monotonic_ns() - host.record->origin_ns; };
  while (now() < 90 * kMs) {  // before any write can meet the fault
    host.read();
    if (now() < 80 * kMs) host.write(host.sequence > 0);
  }
  while (now() < 110 * kMs)
    host.read();
  const std::uint64_t before = now();
  CHECK(host.write());
  const std::uint64_t after = now();
  CHECK(after >= 500 * kMs);
  CHECK(host.record->noticed_ns[0] >= before);
  CHECK(host.record->noticed_ns[0] <= after);
  while (now() < 550 * kMs)
    host.read();
  host.transport->close();
  CHECK(host.record->watchdog_trips >= 1);
  CHECK(host.record->reports >= 549);
  CHECK(host.record->reports <= now() / kMs);
}

// For ThreadSanitizer above all: a reader and a writer at once, through an unplug.
TEST_CASE("simulated: one thread reads while another writes") {
  SimulationConfig config;
  config.rate_hz = 8000;
  config.faults = {fault(Kind::kGarbled, 0.05, 0, 20), fault(Kind::kNoOutput, 0.1, 0.02), fault(Kind::kUnplug, 0.3, 0.05)};
  Host host(config);
  for (int round = 0; round < 2; ++round) {
    std::atomic<bool> is_lost{false};
    std::atomic<std::uint32_t> answers{0};
    std::uint64_t read = 0, written = 0;
    std::thread reader([&] {
      const std::uint64_t begin = monotonic_ns();
      Sample sample;
      std::uint8_t data[kMaxReportBytes];
      while (round == 0 || monotonic_ns() < begin + 200000000) {
        const ReadResult result = host.transport->read(data, sizeof data, 1);
        if (result.status == ReadStatus::kLost) break;
        if (result.status == ReadStatus::kTimeout) continue;
        ++read;
        if (decode_input(host.profile, data, result.bytes, &sample) == Verdict::kGood) answers.store(sample.sequence);
      }
      is_lost.store(true);
    });
    std::thread writer([&] {
      Command command;
      std::uint8_t data[kMaxReportBytes];
      while (!is_lost.load()) {
        command.echo = answers.load();
        command.is_enabled = ++command.sequence > 1;
        command.effort[1] = 0.3;
        encode_output(host.profile, command, data);
        if (host.transport->write(data, host.profile.output.bytes)) ++written;
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    });
    reader.join();
    writer.join();
    CHECK(read > 200);
    CHECK(written > 50);
    host.transport->close();
    if (round == 0) {
      const std::uint64_t begin = monotonic_ns();
      while (host.transport->open() != "" && monotonic_ns() < begin + 10000000000)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  CHECK(host.record->verdicts[FDCG_FW_TAKEN] > 50);
  CHECK(host.record->noticed_ns[2] >= 300000000);
  CHECK(host.record->noticed_ns[2] < SimulationRecord::kNever);
  CHECK(host.record->most_force_n == Approx(0.3));
}
