// SPDX-License-Identifier: Apache-2.0
// The simulated device: its mechanics against closed forms, its protocol through the host's own codec, each of its faults. In
// virtual time: simulated_real_time_test.cpp has the rest.
#include "simulated_rig.hpp"

#include <algorithm>
#include <cmath>

#include "base/threads.hpp"
#include "catch.hpp"
#include "fdcg_firmware.h"
#include "transport/simulated_body.hpp"

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
    Sample sample;
    body.make_report(report);
    REQUIRE(decode_input(profile, report, FDCG_FW_INPUT_BYTES, &sample) == Verdict::kGood);
    CHECK(std::fabs(sample.axis[0] - body.position_m()[0]) <= config.quantum_m * 0.500001);
  }
}

TEST_CASE("simulated: stable for any spring and mass") {
  SimulationConfig config;
  config.mass_kg = 0.001;
  config.damping_n_s_per_m = 0;
  config.hand_stiffness_n_per_m = 1e8;
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

TEST_CASE("simulated: the hand follows its target") {
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

TEST_CASE("simulated: the device applies the written force, and echoes its report") {
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

TEST_CASE("simulated: the host's judge classifies damaged reports") {
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

TEST_CASE("simulated: swapped and late reports") {
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
    CHECK(host.transport->open() == "the simulated device is unplugged for good by its fault script");
  }
  SECTION("what was waiting when it was unplugged is gone") {
    config.faults = {fault(Kind::kOutOfOrder, 0.0985), fault(Kind::kStale, 0.09, 0.005), fault(Kind::kUnplug, 0.1, 0.2)};
    Host host(config);
    host.run(80);
    host.transport->close();
    std::uint8_t data[kMaxReportBytes];
    REQUIRE(host.transport->open() == "");  // at 90 ms: four reports come late, four stand behind them, one is held back
    for (int i = 0; i < 30; ++i)
      host.transport->read(data, sizeof data, 1);
    host.transport->close();
    while (host.transport->open() != "") {
    }
    host.judge = ReportJudge();
    CHECK(bad(host.run(20)).empty());
    CHECK(host.sample.sequence == 20);
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

TEST_CASE("simulated: a body left for a day is advanced at once") {
  SimulatedBody body{SimulationConfig()};
  const std::uint64_t begin = monotonic_ns();
  body.advance(86400000000000);
  CHECK(body.time_ns() == 86400000000000);
  CHECK(monotonic_ns() - begin < 10000000000);  // 10 s of its life take some 30 ms, a day four minutes
  CHECK(std::fabs(body.position_m()[2]) < 0.021);
}
