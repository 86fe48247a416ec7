// SPDX-License-Identifier: Apache-2.0
// The gate's guarantees under random input, with the stage of stability before it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "catch.hpp"
#include "gate_limits.hpp"
#include "random.hpp"
#include "tick/gate.hpp"
#include "tick/stability.hpp"

using namespace fdcg::dev;
using fdcg::test::norm;
using fdcg::test::sound_limits;

namespace {

constexpr double kRateHz = 1000;
constexpr std::uint64_t kMs = 1'000'000;

// Any 64 bits as a number: NaN, infinities and denormals included; or a plausible one.
double any_number(fdcg::test::Random& random) {
  switch (random.below(8)) {
    case 0: {
      const std::uint64_t bits = random.bits();
      double number;
      std::memcpy(&number, &bits, sizeof number);
      return number;
    }
    case 1:
      return 0;
    default:
      return (random.unit() - 0.5) * 2e-2;
  }
}

struct Violation {
  int count = 0;
  std::uint64_t tick = 0;
  const char* what = "";
  void note(bool is_wrong, std::uint64_t at, const char* text) {
    if (!is_wrong) return;
    if (count++ == 0) tick = at, what = text;
  }
};

// The guarantees at the top of gate.hpp, checked independently.
struct Promise {
  DeviceLimits limits;
  double last_n[3] = {};
  Violation violation;

  void check(const GatedForce& force, double step_s, std::uint64_t tick) {
    const double* const f = force.force_n();
    violation.note(!std::isfinite(f[0]) || !std::isfinite(f[1]) || !std::isfinite(f[2]), tick, "a force that is not finite");
    violation.note(!(norm(f) <= limits.force_n), tick, "a force beyond force_n");
    for (int axis = 0; axis < kMaxAxes; ++axis) {
      violation.note(!(std::fabs(force.effort()[axis]) <= limits.effort[axis]), tick, "an effort beyond its limit");
    }
    violation.note(!force.is_enabled() && (norm(f) != 0 || norm(force.effort()) != 0), tick, "a force while not armed");
    violation.note(!is_within_slew(f, limits.slew_n_per_s * step_s), tick, "a force beyond the slew limit");
    std::copy_n(f, 3, last_n);
  }
  // Is f = s * g with |g - last| <= most and 0 <= s <= 1? For such s: |f - s * last| <= s * most: a quadratic in s.
  bool is_within_slew(const double f[3], double most) const {
    const auto excess = [&](double s) {
      double off[3];
      for (int i = 0; i < 3; ++i)
        off[i] = f[i] - s * last_n[i];
      return norm(off) - s * most;
    };
    double lo = 0, hi = 1;  // convex in s: the least is found by thirds
    for (int i = 0; i < 100 && excess(hi) > 0; ++i) {
      const double a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
      (excess(a) < excess(b) ? hi : lo) = excess(a) < excess(b) ? b : a;
    }
    return std::min({excess(0), excess(lo), excess(hi), excess(1)}) <= 1e-12 * limits.force_n;
  }
};

void run_random(std::uint64_t ticks, std::uint64_t seed, Promise& promise, std::uint64_t* with_force) {
  fdcg::test::Random random(seed);
  Gate gate;
  gate.begin(promise.limits, 3, kRateHz, 0);
  Stability stage;
  DeviceLimits heated = promise.limits;
  heated.continuous_force_n = heated.force_n / 2;
  heated.heat_s = 1;
  stage.begin({true, true, 1000}, heated, kRateHz);
  GateInput input;
  double place = 0;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    const bool is_wild = random.below(50) == 0;
    const std::uint64_t before_ns = input.now_ns;
    input.now_ns += is_wild ? random.below(20 * kMs) : 900'000 + random.below(200'000);
    if (random.below(100'000) == 0) input.now_ns = random.bits();
    input.has_sample = random.below(10) != 0;
    input.arm = random.below(20) == 0;
    input.disarm = random.below(20'000) == 0;
    input.read_failed = random.below(20'000) == 0;
    input.write_failed = random.below(20'000) == 0;
    input.device_fault = random.below(20'000) == 0;
    input.write_busy_ns = random.below(2000) == 0 ? random.below(10 * kMs) : 0;
    input.is_tip_valid = random.below(5000) != 0;
    place = std::clamp(place + (random.unit() - 0.5) * 1e-4, -0.05, 0.05);
    const bool is_calm = random.below(4) != 0;
    for (int i = 0; i < 3; ++i) {
      input.tip.position_m[i] = random.below(5000) == 0 ? any_number(random) : place;
      if (!is_calm)
        input.wanted_force_n[i] = random.below(5000) == 0 ? any_number(random) : (random.unit() - 0.5) * random.unit() * 20;
      if (input.arm) input.wanted_force_n[i] *= 1e-3;
      for (int axis = 0; axis < 3; ++axis) {
        if (random.below(20'000) == 0) input.tip.jacobian[i][axis] = any_number(random);
        if (random.below(100) == 0) input.tip.jacobian[i][axis] = (random.unit() - 0.5) * 4;
      }
    }
    GateInput steadied = input;
    const double round_trip_s = random.below(1000) == 0 ? any_number(random) : 0.002 * random.unit();
    if (input.has_sample)
      stage.step(input.tip.position_m, input.now_ns, gate.last_force_n(), round_trip_s, random.below(2) == 0,
                 steadied.wanted_force_n);
    if (stage.shakes()) steadied.link_fault = Fault::kShaking;
    const bool was_disarmed = gate.phase() == Phase::kDisarmed;
    const GatedForce force = gate.step(steadied);
    if (was_disarmed && gate.phase() != Phase::kDisarmed) stage.reset();
    if (stage.shakes() && was_disarmed) stage.reset();
    const double step_s = input.now_ns > before_ns ? static_cast<double>(input.now_ns - before_ns) * 1e-9 : 0;
    promise.check(force, step_s, tick);
    *with_force += norm(force.force_n()) > 0;
  }
}

}  // namespace

// FDCG_GATE_INPUTS: how many; the suite makes a million, 10^8 were made for each release.
TEST_CASE("gate: with any input the output is within its guarantees") {
  const char* const asked = std::getenv("FDCG_GATE_INPUTS");
  const std::uint64_t ticks = asked ? std::strtoull(asked, nullptr, 10) : 1'000'000;
  Promise promise;
  promise.limits = sound_limits();
  std::uint64_t with_force = 0;
  run_random(ticks, 42, promise, &with_force);
  INFO("first at tick " << promise.violation.tick << ": " << promise.violation.what);
  CHECK(promise.violation.count == 0);
  CHECK(with_force > ticks / 20);  // the test must not have passed by silence
}
