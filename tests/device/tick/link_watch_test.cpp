// SPDX-License-Identifier: Apache-2.0
// The watch of the link: what a device echoes of what it was sent, and how many of its reports arrive.
#include "tick/link_watch.hpp"

#include <deque>
#include <random>

#include "catch.hpp"
#include "plain_profile.hpp"
#include "tick/device_tick.hpp"
#include "tick/gate.hpp"

using namespace fdcg::dev;
using fdcg::test::plain_profile;

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr std::uint32_t kApplied = 2;

Profile echoing_profile(NumberType type = NumberType::kU32) {
  Profile profile = plain_profile();
  profile.input.fields[profile.input.field_count - 1].enabled = kApplied;
  Field echo;
  echo.role = Role::kEcho;
  echo.type = type;
  echo.offset = 22;
  profile.input.fields[profile.input.field_count++] = echo;
  profile.input.bytes = 26;
  Field sequence = echo;
  sequence.role = Role::kSequence;
  sequence.offset = 13;
  profile.output.fields[profile.output.field_count++] = sequence;
  profile.output.bytes = 17;
  return profile;
}

// A host and a device, a tick each millisecond: the device takes an output `lag` ticks after it was sent.
struct Rig {
  LinkWatch watch;
  Profile profile;
  std::uint32_t mask;
  std::uint64_t now_ns = 5000 * kMs;
  std::uint32_t sent = 0, taken = 0;
  int lag = 1;
  bool is_enabled = false, is_applied = true, takes = true;
  std::deque<SentReport> under_way;

  explicit Rig(NumberType type = NumberType::kU32)
      : profile(echoing_profile(type)), mask(0xFFFFFFFFU >> (32 - 8 * bytes_of(type))) {
    watch.begin(profile, true);
    watch.open(now_ns);
  }
  void send() {
    under_way.push_back({now_ns, ++sent, is_enabled});
    watch.note_sent(under_way.back());
  }
  void report() {
    bool applies = false;
    while (takes && !under_way.empty() && under_way.front().ns + static_cast<std::uint64_t>(lag) * kMs <= now_ns) {
      taken = under_way.front().sequence;
      under_way.pop_front();
    }
    applies = is_enabled && is_applied;
    Sample sample;
    sample.echo = taken & mask;
    sample.is_enabled = applies;
    watch.note_report(sample, now_ns);
  }
  void tick(bool has_report = true) {
    send();
    now_ns += kMs;
    if (has_report) report();
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i)
      tick();
  }
  Fault fault() const { return watch.fault(now_ns, true); }
};

}  // namespace

TEST_CASE("link: a device that takes what it is sent has no fault, and its round trip is measured") {
  for (const NumberType type : {NumberType::kU8, NumberType::kU16, NumberType::kU32}) {
    Rig rig(type);
    CHECK(rig.watch.lags());  // nothing has come back yet
    for (int i = 0; i < 70'000; ++i) {
      rig.is_enabled = i > 100;
      rig.tick();
      REQUIRE(rig.fault() == Fault::kNone);
    }
    CHECK_FALSE(rig.watch.lags());
    CHECK(rig.watch.round_trip_s() == Approx(0.001));
  }
}

TEST_CASE("link: a constant lag is seen before there is force") {
  for (const int lag : {1, 2, 3, 4, 5, 8, 15, 30}) {
    Rig rig;
    rig.lag = lag;
    rig.run(200);
    CHECK(rig.watch.lags() == (lag > 4));
    CHECK(rig.watch.round_trip_s() == Approx(0.001 * lag));
    CHECK((rig.fault() == Fault::kNotTaken) == (lag > 10));
  }
}

TEST_CASE("link: a lag that begins while there is force is a fault within sixteen outputs") {
  for (const int lag : {5, 8, 15, 30}) {
    Rig rig;
    rig.run(200);
    REQUIRE(rig.fault() == Fault::kNone);
    rig.lag = lag;
    int ticks = 0;
    for (; rig.fault() == Fault::kNone && ticks < 100; ++ticks)
      rig.tick();
    CHECK(rig.fault() == (lag > 10 ? Fault::kNotTaken : Fault::kLag));
    CHECK(ticks <= (lag > 10 ? 11 : 16 + lag));
    CHECK(rig.watch.fault(rig.now_ns, false) == Fault::kNone);
    rig.lag = 1;
    rig.run(20);
    CHECK(rig.fault() == Fault::kNone);
  }
}

TEST_CASE("link: jitter of the reports is not taken for lag") {
  std::mt19937_64 random(4);
  Rig rig;
  for (int i = 0; i < 20'000; ++i) {
    rig.lag = 1 + static_cast<int>(random() % 8);  // up to 8 ms
    rig.tick(random() % 8 != 0);
    REQUIRE(rig.fault() == Fault::kNone);
    if (i > 100) REQUIRE_FALSE(rig.watch.lags());
  }
}

TEST_CASE("link: an output that is not taken within 10 ms is a fault where force is asked for") {
  Rig rig;
  rig.run(500);
  rig.takes = false;
  const std::uint64_t stopped_ns = rig.now_ns;
  while (rig.fault() == Fault::kNone)
    rig.tick();
  CHECK(rig.fault() == Fault::kNotTaken);
  CHECK(rig.now_ns - stopped_ns <= 11 * kMs);
  CHECK(rig.now_ns - stopped_ns >= 9 * kMs);
  CHECK(rig.watch.fault(rig.now_ns, false) == Fault::kNone);
  rig.takes = true;
  rig.tick();
  CHECK(rig.fault() == Fault::kNone);
}

TEST_CASE("link: a device that takes forces and does not apply them is a fault after 10 ms") {
  Rig rig;
  rig.run(500);
  rig.is_enabled = true;
  rig.run(100);
  CHECK(rig.fault() == Fault::kNone);
  rig.is_applied = false;
  rig.run(9);
  CHECK(rig.fault() == Fault::kNone);
  rig.run(3);
  CHECK(rig.fault() == Fault::kNotTaken);
}

TEST_CASE("link: what another host sends is told from what this one sends") {
  Rig rig;
  rig.taken = 40'000;  // what the last host left there is nobody's fault
  rig.takes = false;
  rig.run(5);
  CHECK(rig.fault() == Fault::kNone);
  rig.takes = true;
  rig.run(100);
  CHECK(rig.fault() == Fault::kNone);
  Sample foreign;
  SECTION("ahead of all that was sent") {
    foreign.echo = rig.sent + 1000;
  }
  SECTION("behind what it has taken") {
    foreign.echo = rig.sent - 50;
  }
  SECTION("far behind") {
    foreign.echo = rig.sent - 0x70000000U;
  }
  SECTION("as after a restart") {
    foreign.echo = 0;
  }
  rig.now_ns += kMs;
  rig.watch.note_report(foreign, rig.now_ns);
  CHECK(rig.fault() == Fault::kOtherHost);
  CHECK(rig.watch.fault(rig.now_ns, false) == Fault::kOtherHost);
  rig.run(400);
  CHECK(rig.fault() == Fault::kOtherHost);
  rig.run(200);
  CHECK(rig.fault() == Fault::kNone);
}

TEST_CASE("link: half of the reports lost for a tenth of a second is a fault, a quarter is none") {
  for (const int of_four : {1, 2, 3, 4}) {
    Rig rig;
    rig.run(1000);
    const std::uint64_t began_ns = rig.now_ns;
    for (int i = 0; i < 300 && rig.fault() == Fault::kNone; ++i)
      rig.tick(i % 4 % 2 == 0 ? of_four > 1 || i % 4 == 0 : of_four > 2 && (of_four == 4 || i % 4 == 1));
    CHECK((rig.fault() == Fault::kReportsLost) == (of_four < 3));
    if (of_four < 3) CHECK(rig.now_ns - began_ns <= 105 * kMs);
  }
  std::mt19937_64 random(7);
  Rig rig;
  rig.run(1000);
  int ticks = 0;
  for (; rig.fault() == Fault::kNone && ticks < 1000; ++ticks)
    rig.tick(random() % 2 == 0);
  CHECK(ticks < 300);
}

TEST_CASE("link: a profile without an echo is judged by its reports alone") {
  LinkWatch watch;
  watch.begin(plain_profile(), true);
  std::uint64_t now_ns = 1000 * kMs;
  watch.open(now_ns);
  for (int i = 0; i < 1000; ++i) {
    watch.note_sent({now_ns, static_cast<std::uint32_t>(i), true});
    now_ns += kMs;
    watch.note_report(Sample(), now_ns);
    REQUIRE(watch.fault(now_ns, true) == Fault::kNone);
  }
  CHECK_FALSE(watch.lags());
  CHECK(watch.round_trip_s() == 0);
  CHECK(watch.fault(now_ns + 100 * kMs, true) == Fault::kReportsLost);
}

namespace {

// A gate that is armed and has force.
struct ArmedGate {
  Gate gate;
  GateInput input;

  ArmedGate() {
    const Profile profile = plain_profile();
    gate.begin(profile.limits, profile.axis_count, profile.rate_hz, 0);
    input.now_ns = 1000 * kMs;
    input.tip.jacobian[0][0] = input.tip.jacobian[1][1] = input.tip.jacobian[2][2] = 1;
    input.has_sample = true;
    step();
    input.arm = true;
    step();
    input.arm = false;
    input.wanted_force_n[2] = 1;
    for (int i = 0; i < 700; ++i)
      step();
    REQUIRE(gate.phase() == Phase::kArmed);
  }
  GatedForce step() {
    input.now_ns += kMs;
    return gate.step(input);
  }
};

}  // namespace

TEST_CASE("gate: each fault of the link takes the force away in its tick, and refuses arming") {
  for (const Fault fault : {Fault::kNotTaken, Fault::kOtherHost, Fault::kRestarted, Fault::kReportsLost}) {
    ArmedGate armed;
    REQUIRE(armed.step().force_n()[2] == Approx(1));
    armed.input.link_fault = fault;
    const GatedForce force = armed.step();
    CHECK(force.force_n()[2] == 0);
    CHECK_FALSE(force.is_enabled());
    CHECK(armed.gate.fault() == fault);
    armed.input.wanted_force_n[2] = 0;
    armed.input.arm = true;
    armed.step();
    CHECK(armed.gate.arming_refused());
    CHECK(armed.gate.phase() == Phase::kDisarmed);
    armed.input.link_fault = Fault::kNone;
    armed.step();
    CHECK(armed.gate.phase() == Phase::kRamping);
  }
}

TEST_CASE("gate: a computer that was suspended disarms, however short the tick") {
  ArmedGate armed;
  armed.input.slept_ns = 9 * kMs;
  CHECK(armed.step().is_enabled());
  armed.input.slept_ns += 10 * kMs;
  CHECK_FALSE(armed.step().is_enabled());
  CHECK(armed.gate.fault() == Fault::kSlept);
  armed.input.wanted_force_n[2] = 0;
  armed.input.arm = true;
  CHECK(armed.step().is_enabled());
}

TEST_CASE("gate: a lag refuses arming, says so, and does not disarm") {
  ArmedGate armed;
  armed.input.lags = true;
  CHECK(armed.step().is_enabled());
  armed.input.disarm = true;
  armed.step();
  armed.input.disarm = false;
  armed.input.wanted_force_n[2] = 0;
  armed.input.arm = true;
  CHECK_FALSE(armed.step().is_enabled());
  CHECK(armed.gate.arming_refused());
  CHECK(armed.gate.fault() == Fault::kLag);
}

TEST_CASE("device tick: a device that starts anew disarms at every rate") {
  for (const double rate_hz : {1000.0, 2000.0, 4000.0, 8000.0}) {
    DeviceSetup setup;
    setup.profile = plain_profile();
    setup.profile.rate_hz = rate_hz;
    std::vector<std::uint64_t> memory;
    const fdcg_scene_config config = fdcg_make_scene_config();
    memory.resize(fdcg_scene_bytes(&config) / 8 + 1);
    REQUIRE(fdcg_scene_create(memory.data(), memory.size() * 8, &config, &setup.scene, nullptr) == FDCG_OK);
    DeviceState device;
    REQUIRE(begin_device(setup, &device, nullptr));
    TickInput input{};
    TickOutput output;
    const auto period_ns = static_cast<std::uint64_t>(1e9 / rate_hz);
    input.now_ns = 1000 * kMs;
    std::uint32_t sequence = 0;
    std::uint64_t device_ns = 0;
    const auto tick = [&] {
      input.now_ns += period_ns;
      device_ns += period_ns;
      Sample sample;
      sample.sequence = ++sequence;
      sample.time_s = static_cast<double>(device_ns) * 1e-9;
      encode_input(setup.profile, sample, input.reports[0].data);
      input.reports[0].bytes = 22;
      input.reports[0].host_ns = input.now_ns;
      input.report_count = 1;
      input.read = ReadStatus::kReport;
      device_tick(device, input, &output);
    };
    for (int i = 0; i < 20; ++i)
      tick();
    input.arm = true;
    tick();
    input.arm = false;
    for (int i = 0; i < rate_hz; ++i)
      tick();
    REQUIRE(output.phase == Phase::kArmed);
    sequence = 0;
    device_ns = 0;
    int ticks = 0;
    for (; output.phase != Phase::kDisarmed && ticks < 100; ++ticks)
      tick();
    CHECK(output.phase == Phase::kDisarmed);
    CHECK((output.fault == Fault::kRestarted || output.fault == Fault::kSilence));
    CHECK(ticks <= kRestartReports + 2);
    for (int i = 0; i < rate_hz; ++i)
      tick();
    CHECK(output.phase == Phase::kDisarmed);
  }
}
