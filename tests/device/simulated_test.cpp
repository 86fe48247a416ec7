// SPDX-License-Identifier: Apache-2.0
// The simulated device: its mechanics against closed forms, its protocol through the host's own codec, each of its faults, and
// two threads on it at once.
#include "simulated_rig.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "fdcg_firmware.h"
#include "simulated_body.hpp"
#include "threads.hpp"

namespace {

using namespace fdcg::test;
using Kind = SimulatedFaultKind;
using Host = SmallHost;

Verdicts bad(const Verdicts& verdicts) {
  Verdicts found;
  for (const Verdict verdict : verdicts)
    if (verdict != Verdict::kGood) found.push_back(verdict);
  return found;
}

}  // namespace

TEST_CASE("simulated: a mass on the hand's spring swings as the closed form says") {
  SimulationConfig config = still();
  config.start_m[0] = 0.01;
  config.watchdog_s = 60;
  SimulatedBody body(config);
  // a push of 1 N from rest: x = x0 + F/k (1 - e^(-d t) (cos w t + d/w sin w t))
  std::uint8_t report[FDCG_FW_INPUT_BYTES];
  body.make_report(report);
  Profile profile = simulated_profile(config);
  for (const bool is_enabled : {false, true}) {
    Command command;
    command.effort[0] = 1;
    command.sequence = is_enabled ? 2 : 1;
    command.echo = 1;
    command.is_enabled = is_enabled;
    encode_output(profile, command, report);
    body.take(report, profile.output.bytes);
  }
  const double k = config.hand_stiffness_n_per_m, m = config.mass_kg;
  const double d = (config.damping_n_s_per_m + config.hand_damping_n_s_per_m) / (2 * m), w = std::sqrt(k / m - d * d);
  for (int ms = 1; ms <= 500; ++ms) {
    body.advance(static_cast<std::uint64_t>(ms) * 1000000);
    const double t = ms * 1e-3;
    const double x = 0.01 + 1 / k * (1 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)));
    CHECK(std::fabs(body.position_m()[0] - x) < 2e-5);  // of 5 mm
    CHECK(body.position_m()[1] == 0);
  }
}

TEST_CASE("simulated: stable whatever the spring and the mass") {
  SimulationConfig config;
  config.mass_kg = 0.001;
  config.damping_n_s_per_m = 0;
  config.hand_stiffness_n_per_m = 1e5;
  config.hand_damping_n_s_per_m = 1000;
  SECTION("damped") {}
  SECTION("not damped") {
    config.hand_damping_n_s_per_m = 0;
  }
  SimulatedBody body(config);
  for (std::uint64_t ms = 1; ms <= 3000; ++ms) {
    body.advance(ms * 1000000);
    REQUIRE(std::fabs(body.position_m()[2]) < 0.03);
  }
}

TEST_CASE("simulated: the hand goes where its target goes") {
  SimulationConfig config;
  config.is_real_time = false;
  config.hand_stiffness_n_per_m = 5000;
  config.hand_damping_n_s_per_m = 20;
  Host host(config);
  double least = 1, most = -1;
  for (int i = 1; i <= 2000; ++i) {
    REQUIRE(host.read() == Verdict::kGood);
    CHECK(host.sample.sequence == static_cast<std::uint32_t>(i));
    least = std::min(least, host.sample.axis[2]);
    most = std::max(most, host.sample.axis[2]);
    CHECK(std::fabs(std::remainder(host.sample.axis[2], config.quantum_m)) < 1e-12);
  }
  CHECK(most == Approx(0.02).epsilon(0.01));
  CHECK(least == Approx(-0.02).epsilon(0.01));
}

TEST_CASE("simulated: the device feels what is written, and says which report it took") {
  Host host(still());
  CHECK(bad(host.run(1000)).empty());
  CHECK(host.sample.echo == host.sequence - 1);
  CHECK(host.sample.axis[0] == Approx(0.5 / 200).epsilon(0.01));
  CHECK(host.sample.axis[2] == Approx(-0.25 / 200).epsilon(0.01));
  host.transport->close();
  CHECK(host.record->most_force_n == Approx(std::hypot(0.5, 0.25)));
  CHECK(host.record->verdicts[FDCG_FW_TAKEN] == 1000);
  CHECK(host.record->reports == 1000);
}

TEST_CASE("simulated: the same reads and writes give the same device") {
  for (const bool has_float_axes : {false, true}) {
    SimulationConfig config;
    config.is_real_time = false;
    config.has_float_axes = has_float_axes;
    config.faults = {fault(Kind::kGarbled, 0.1, 0, 50)};
    Host first(config), second(config);
    std::uint8_t a[kMaxReportBytes], b[kMaxReportBytes];
    for (int i = 0; i < 500; ++i) {
      const ReadResult left = first.transport->read(a, sizeof a, 10), right = second.transport->read(b, sizeof b, 10);
      REQUIRE(left.bytes == right.bytes);
      REQUIRE(std::memcmp(a, b, static_cast<std::size_t>(left.bytes)) == 0);
      first.write(i > 0);
      second.write(i > 0);
    }
  }
}

TEST_CASE("simulated: the device's watchdog ends the force of a host that falls silent") {
  Host host(still());
  host.run(100);
  const std::uint64_t last_ns = 100000000;
  for (int i = 0; i < 50; ++i)
    host.read();
  host.transport->close();
  CHECK(host.record->watchdog_trips == 1);
  CHECK(host.record->most_force_between(last_ns, last_ns) > 0.5f);
  const std::uint64_t zero = host.record->zero_at(last_ns);
  CHECK(zero >= last_ns + 20000000);
  CHECK(zero <= last_ns + 20100000);
  CHECK(host.record->most_force_between(zero, host.record->end_ns) == 0);
}

TEST_CASE("simulated: damaged reports are what the host's judge calls them") {
  SimulationConfig config = still();
  Kind kind = Kind::kShort;
  Verdict verdict = Verdict::kLength;
  SECTION("short") {}
  SECTION("long") {
    kind = Kind::kLong;
  }
  SECTION("unknown id") {
    kind = Kind::kUnknownId, verdict = Verdict::kId;
  }
  SECTION("garbled") {
    kind = Kind::kGarbled, verdict = Verdict::kCrc;
  }
  SECTION("repeated") {
    kind = Kind::kRepeated, verdict = Verdict::kRepeated;
  }
  SECTION("not finite") {
    kind = Kind::kNotFinite, verdict = Verdict::kNotFinite;
    config.has_float_axes = true;
  }
  config.faults = {fault(kind, 0.1004, 0, 5)};
  Host host(config);
  const Verdicts verdicts = host.run(200);
  REQUIRE(verdicts.size() == 200);
  for (int i = 0; i < 200; ++i) {
    INFO("report " << i + 1);
    if (i < 100 || i >= 105) CHECK(verdicts[i] == Verdict::kGood);
    // a flip in the id is found as such
    else if (kind == Kind::kGarbled)
      CHECK((verdicts[i] == verdict || verdicts[i] == Verdict::kId));
    else
      CHECK(verdicts[i] == verdict);
  }
  CHECK(host.record->noticed_ns[0] == 101000000);
}

TEST_CASE("simulated: reports that change places, and those that come late") {
  SimulationConfig config = still();
  SECTION("out of order") {
    config.faults = {fault(Kind::kOutOfOrder, 0.1004)};
    Host host(config);
    const Verdicts verdicts = host.run(200);
    CHECK(bad(verdicts) == Verdicts{Verdict::kOutOfOrder});
    CHECK(verdicts[101] == Verdict::kOutOfOrder);
    CHECK(host.judge.lost == 1);
  }
  SECTION("stale") {
    config.faults = {fault(Kind::kStale, 0.1004, 0.01)};
    Host host(config);
    std::vector<std::uint64_t> arrivals;
    host.run(100);
    std::uint8_t data[kMaxReportBytes];
    CHECK(host.transport->read(data, sizeof data, 20).status == ReadStatus::kTimeout);  // 120 ms
    CHECK(host.transport->read(data, sizeof data, 20).status == ReadStatus::kReport);   // the report of 101 ms, at 121 ms
    CHECK(host.record->noticed_ns[0] == 121000000);
    int at_once = 0;
    for (int i = 0; i < 10; ++i)
      host.transport->read(data, sizeof data, 20);
    while (host.transport->read(data, sizeof data, 0).status == ReadStatus::kReport)
      ++at_once;
    CHECK(at_once == 19);  // those of 112 to 130 ms were behind
  }
}

TEST_CASE("simulated: a stalled device is silent, and still takes forces") {
  SimulationConfig config = still();
  config.faults = {fault(Kind::kStall, 0.1, 0.05)};
  Host host(config);
  host.run(99);
  std::uint8_t data[kMaxReportBytes];
  CHECK(host.transport->read(data, sizeof data, 30).status == ReadStatus::kTimeout);
  CHECK(host.record->noticed_ns[0] == 100000000);
  CHECK(host.write(false));
  CHECK(host.read() == Verdict::kGood);
  CHECK(host.sample.sequence == 100);
  CHECK(host.sample.echo == host.sequence);
}

TEST_CASE("simulated: unplugged, plugged in again, restarted") {
  SimulationConfig config = still();
  SECTION("unplugged for a while") {
    config.faults = {fault(Kind::kUnplug, 0.1, 0.2), fault(Kind::kUnplug, 0.5)};
    Host host(config);
    CHECK(host.run(1000).size() == 99);
    CHECK(host.record->noticed_ns[0] == 100000000);
    CHECK_FALSE(host.write());
    ReadStatus status;
    host.read(&status);
    CHECK(status == ReadStatus::kLost);
    host.transport->close();
    CHECK(host.record->zero_at(99500000) == 100000000);
    int tries = 0;
    while (host.transport->open() != "")
      ++tries;
    CHECK(tries == 19);
    host.judge = ReportJudge();
    host.sequence = 0;
    CHECK(bad(host.run(100)).empty());
    CHECK(host.sample.sequence == 100);  // from 1 again
    CHECK(host.run(1000).size() == 99);
    CHECK(host.record->noticed_ns[1] == 500000000);
    host.transport->close();
    CHECK(host.transport->open() == "the simulated device is unplugged, for ever: its script says so");
  }
  SECTION("restarted") {
    config.faults = {fault(Kind::kRestart, 0.1)};
    Host host(config);
    host.run(99);
    CHECK(host.read() == Verdict::kOutOfOrder);
    CHECK(host.sample.sequence == 1);
    CHECK(host.record->noticed_ns[0] == 100000000);
    CHECK(host.sample.echo == 0);
    host.write();  // enabled: held
    host.read();
    CHECK(host.record->zero_at(101000000) == 101000000);
    CHECK(host.record->verdicts[FDCG_FW_HELD] == 1);
  }
  SECTION("a fault of its own") {
    config.faults = {fault(Kind::kDeviceFault, 0.1, 0.01)};
    Host host(config);
    for (int i = 1; i <= 130; ++i) {
      REQUIRE(host.read() == Verdict::kGood);
      CHECK(host.sample.has_fault == (i >= 100 && i < 110));
      host.write(i > 1 && i != 120);
      if (i == 115) CHECK(host.record->zero_at(114000000) == 114000000);
    }
    CHECK(host.record->most_force_between(100000000, 120900000) == 0);
    CHECK(host.record->most_force_between(125000000, 130000000) > 0.5f);
  }
}

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

TEST_CASE("simulated: in real time the device keeps its own, and a write that is not taken blocks") {
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
