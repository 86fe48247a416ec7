// SPDX-License-Identifier: Apache-2.0
// The safety gate: its output limits, and every fault that makes it give zero.
#include "tick/gate.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "catch.hpp"
#include "gate_limits.hpp"

using namespace fdcg::dev;
using fdcg::test::norm;
using fdcg::test::sound_limits;

namespace {

constexpr double kRateHz = 1000;
constexpr std::uint64_t kMs = 1'000'000;

// A gate with a clock and an identity Jacobian.
struct Rig {
  Gate gate;
  GateInput input;

  explicit Rig(const DeviceLimits& limits = sound_limits(), double most_force_n = 0) {
    gate.begin(limits, 3, kRateHz, most_force_n);
    input.now_ns = 5000 * kMs;
    for (int i = 0; i < 3; ++i)
      input.tip.jacobian[i][i] = 1;
  }
  // One tick later, with a report or without.
  GatedForce tick(bool has_sample = true, std::uint64_t after_ns = kMs) {
    input.now_ns += after_ns;
    input.has_sample = has_sample;
    const GatedForce force = gate.step(input);
    input.arm = input.disarm = false;
    return force;
  }
  // Armed, the ramp done, pushing with `wanted_n` along z.
  void push(double wanted_n) {
    tick();
    input.wanted_force_n[2] = 0;
    input.arm = true;
    tick();
    REQUIRE(gate.phase() == Phase::kRamping);
    input.wanted_force_n[2] = wanted_n;
    for (int i = 0; i < 600; ++i)
      tick();
    REQUIRE(gate.phase() == Phase::kArmed);
  }
};

void check_is_zero(const GatedForce& force) {
  CHECK(norm(force.force_n()) == 0);
  CHECK(norm(force.effort()) == 0);
  CHECK_FALSE(force.is_enabled());
}

// After `fault`: no force until armed again.
void check_is_latched(Rig& rig, Fault fault) {
  CHECK(rig.gate.phase() == Phase::kDisarmed);
  CHECK(rig.gate.fault() == fault);
  rig.input.device_fault = rig.input.read_failed = rig.input.write_failed = false;
  rig.input.write_busy_ns = 0;
  rig.input.is_tip_valid = true;
  rig.input.tip = Rig().input.tip;
  for (double& f : rig.input.wanted_force_n)
    f = 0;
  for (int i = 0; i < 1000; ++i)
    check_is_zero(rig.tick());
  CHECK(rig.gate.fault() == fault);
  rig.input.arm = true;
  CHECK(rig.tick().is_enabled());
  CHECK(rig.gate.fault() == Fault::kNone);
}

}  // namespace

TEST_CASE("gate: no force until armed") {
  Rig rig;
  rig.input.wanted_force_n[0] = 1;
  for (int i = 0; i < 100; ++i)
    check_is_zero(rig.tick());
  CHECK(rig.gate.fault() == Fault::kCommanded);
}

TEST_CASE("arming is refused while the hand is pressed against something, and without a report") {
  Rig rig;
  rig.input.arm = true;
  check_is_zero(rig.tick(false));
  CHECK(rig.gate.arming_refused());
  rig.tick();
  CHECK_FALSE(rig.gate.arming_refused());
  rig.input.arm = true;
  rig.input.wanted_force_n[1] = 1.001 * kArmForceShare * 3;
  check_is_zero(rig.tick());
  CHECK(rig.gate.arming_refused());
  rig.input.arm = true;
  rig.input.wanted_force_n[1] = 0.999 * kArmForceShare * 3;
  CHECK(rig.tick().is_enabled());
  CHECK_FALSE(rig.gate.arming_refused());
}

TEST_CASE("after arming the force grows from zero over the ramp's time") {
  Rig rig;
  rig.tick();
  rig.input.arm = true;
  rig.tick();
  rig.input.wanted_force_n[2] = 2;
  double before = 0;
  for (int tick = 1; tick <= 499; ++tick) {
    const double force = norm(rig.tick().force_n());
    CHECK(force >= before);
    CHECK(force == Approx(2 * (tick + 1) * 0.001 / kRampS).margin(0.005));
    before = force;
  }
  rig.tick();
  CHECK(norm(rig.tick().force_n()) == Approx(2));
  CHECK(rig.gate.phase() == Phase::kArmed);
}

TEST_CASE("gate: the ramp also holds for a requested force far beyond the limit") {
  Rig rig;
  rig.tick();
  rig.input.arm = true;
  rig.tick();
  rig.input.wanted_force_n[2] = 1000;
  for (int tick = 1; tick <= 100; ++tick)
    CHECK(norm(rig.tick().force_n()) <= 3 * (tick + 1) * 0.001 / kRampS * 1.000001);
}

TEST_CASE("gate: neither a late tick nor a force from before a fault allows a larger step") {
  DeviceLimits limits = sound_limits();
  limits.slew_n_per_s = 5;
  Rig rig(limits);
  rig.push(0);
  rig.input.wanted_force_n[2] = 2;
  CHECK(norm(rig.tick(true, 8 * kMs).force_n()) <= 5 * 0.002 * 1.000001);
  for (int i = 0; i < 1000; ++i)
    rig.tick();
  CHECK(norm(rig.tick().force_n()) == Approx(2));
  rig.input.device_fault = true;
  check_is_zero(rig.tick());
  rig.input.device_fault = false;
  rig.input.wanted_force_n[2] = 0.1;
  rig.input.arm = true;
  rig.tick();
  rig.input.wanted_force_n[2] = 2;
  for (int i = 0; i < 3; ++i)
    CHECK(norm(rig.tick().force_n()) <= 5 * 0.001 * (i + 1) + 0.001);
}

TEST_CASE("gate: an unknown limit means no force") {
  const double unknowns[] = {0, -1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const double unknown : unknowns) {
    for (int which = 0; which < 7; ++which) {
      DeviceLimits limits = sound_limits();
      if (which == 0) limits.force_n = unknown;
      if (which == 1) limits.slew_n_per_s = unknown;
      if (which == 2) limits.velocity_m_per_s = unknown;
      if (which >= 3 && which < 6) limits.effort[which - 3] = unknown;
      if (which == 6) limits.workspace_max_m[1] = std::isfinite(unknown) ? limits.workspace_min_m[1] : unknown;
      Rig rig(limits);
      rig.tick();
      rig.input.arm = true;
      check_is_zero(rig.tick());
      CHECK(rig.gate.arming_refused());
      CHECK(rig.gate.fault() == Fault::kUnknownLimit);
    }
  }
}

TEST_CASE("without a watchdog in the device, or with a slow one, the force limit is low, and a scene can only lower it") {
  for (const double watchdog_s : {0.0, 0.5}) {
    DeviceLimits limits = sound_limits();
    limits.device_watchdog_s = watchdog_s;
    Rig without(limits);
    without.push(100);
    CHECK(norm(without.tick().force_n()) == Approx(kForceWithoutWatchdogN));
  }
  Rig lowered(sound_limits(), 0.5);
  lowered.push(100);
  CHECK(norm(lowered.tick().force_n()) == Approx(0.5));
  Rig raised(sound_limits(), 50);
  raised.push(100);
  CHECK(norm(raised.tick().force_n()) == Approx(2.5));  // the axis' limit; the force's is 3
}

TEST_CASE("an effort beyond its axis' limit makes the whole force smaller and keeps its direction") {
  Rig rig;
  rig.input.tip.jacobian[0][0] = 4;
  rig.push(0);
  rig.input.wanted_force_n[0] = 1;
  rig.input.wanted_force_n[1] = 1;
  GatedForce force;
  for (int i = 0; i < 100; ++i)
    force = rig.tick();
  CHECK(force.effort()[0] == Approx(2.5));
  CHECK(force.force_n()[0] == Approx(0.625));
  CHECK(force.force_n()[1] == Approx(0.625));
}

TEST_CASE("gate: three missed ticks fade the force out; returning reports ramp it up") {
  Rig rig;
  rig.push(2);
  CHECK(norm(rig.tick(false).force_n()) == Approx(2));
  CHECK(norm(rig.tick(false).force_n()) == Approx(2));
  const double first = norm(rig.tick(false).force_n());
  CHECK(rig.gate.phase() == Phase::kFading);
  CHECK(first < 1);
  CHECK(norm(rig.tick(false).force_n()) == 0);
  CHECK(norm(rig.tick(true).force_n()) < 0.01);
  CHECK(rig.gate.phase() == Phase::kRamping);
  for (int i = 0; i < 600; ++i)
    rig.tick();
  CHECK(norm(rig.tick().force_n()) == Approx(2));
}

TEST_CASE("gate: ten milliseconds of silence disarm") {
  Rig rig;
  rig.push(2);
  for (int i = 0; i < 9; ++i)
    rig.tick(false);
  CHECK(rig.gate.phase() == Phase::kFading);
  check_is_zero(rig.tick(false));
  check_is_latched(rig, Fault::kSilence);
}

TEST_CASE("gate: every other fault disarms at once") {
  const auto after = [](Fault fault, const auto& cause) {
    Rig rig;
    rig.push(2);
    cause(rig);
    check_is_zero(rig.tick());
    check_is_latched(rig, fault);
  };
  after(Fault::kReadFailed, [](Rig& rig) { rig.input.read_failed = true; });
  after(Fault::kWriteFailed, [](Rig& rig) { rig.input.write_failed = true; });
  after(Fault::kDeviceFault, [](Rig& rig) { rig.input.device_fault = true; });
  after(Fault::kCommanded, [](Rig& rig) { rig.input.disarm = true; });
  after(Fault::kWriterStuck, [](Rig& rig) { rig.input.write_busy_ns = 5 * kMs; });
  after(Fault::kNotFinite, [](Rig& rig) { rig.input.wanted_force_n[1] = std::nan(""); });
  after(Fault::kNotFinite, [](Rig& rig) { rig.input.tip.position_m[1] = std::nan(""); });
  after(Fault::kNotFinite, [](Rig& rig) { rig.input.tip.jacobian[2][1] = std::numeric_limits<double>::infinity(); });
  after(Fault::kWorkspace, [](Rig& rig) { rig.input.tip.position_m[0] = 0.1001; });
  after(Fault::kWorkspace, [](Rig& rig) { rig.input.is_tip_valid = false; });
  after(Fault::kSpeed, [](Rig& rig) { rig.input.tip.position_m[0] = 0.00201; });
}

TEST_CASE("a write of just under five milliseconds, and a tip at just under the speed limit, disarm nothing") {
  Rig rig;
  rig.push(2);
  rig.input.write_busy_ns = 5 * kMs - 1;
  rig.input.tip.position_m[0] = 0.00199;
  CHECK(rig.tick().is_enabled());
}

TEST_CASE("a host that was away for ten milliseconds is disarmed although a report is there") {
  Rig rig;
  rig.push(2);
  check_is_zero(rig.tick(true, 10 * kMs));
  check_is_latched(rig, Fault::kHostLate);
}

TEST_CASE("gate: a clock that goes back disarms") {
  Rig rig;
  rig.push(2);
  rig.input.now_ns -= 100 * kMs;
  check_is_zero(rig.tick());
  check_is_latched(rig, Fault::kClock);
}

TEST_CASE("gate: the first fault is kept") {
  Rig rig;
  rig.push(2);
  rig.input.device_fault = true;
  rig.tick();
  rig.input.read_failed = true;
  rig.tick();
  CHECK(rig.gate.fault() == Fault::kDeviceFault);
}

TEST_CASE("every fault has a name of its own and a text") {
  for (int i = 0; i < kFaults; ++i) {
    CHECK(std::strlen(fault_text(static_cast<Fault>(i))) > 5);
    for (int k = 0; k < i; ++k)
      CHECK(std::string(fault_name(static_cast<Fault>(i))) != fault_name(static_cast<Fault>(k)));
  }
}

TEST_CASE("the documents name every fault as the program does") {
  const auto text_of = [](const char* name) {
    std::ifstream file(std::string(FDCG_SOURCE_DIR "/schemas/") + name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string log = text_of("session-log.md"), status = text_of("servo-status.schema.json");
  std::string names;  // the schema's list is of these, in this order, and of no others
  for (int i = 0; i < kFaults; ++i) {
    const std::string name = fault_name(static_cast<Fault>(i));
    INFO(name);
    CHECK(log.find((i == 0 ? "fault: 0 `" : ", " + std::to_string(i) + " `") + name + "`") != std::string::npos);
    names += (i == 0 ? "\"" : ", \"") + name + "\"";
  }
  CHECK(status.find("\"enum\": [" + names + "]") != std::string::npos);
}
