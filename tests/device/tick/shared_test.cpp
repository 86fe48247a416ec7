// SPDX-License-Identifier: Apache-2.0
// Devices that share a scene, tick by tick: the clock device, and the fingers that take part. Whole sessions:
// shared_session_test.cpp.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "catch.hpp"
#include "scene/scene_build.hpp"
#include "shared_rig.hpp"

using namespace fdcg::dev;
using namespace fdcg::test;

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr double kGravity = 9.80665;
constexpr double kPressed_m = 0.003;  // 3 N a finger: more than it takes to hold the box

// A tick each millisecond; a device has a report in it where it was put there.
struct Rig {
  HostConfig config;
  SceneGraphs graphs;
  DeviceScene scene;
  std::vector<std::unique_ptr<DeviceState>> devices;
  std::vector<TickInput> inputs;
  std::vector<TickOutput> outputs;
  std::vector<std::uint32_t> sequences;
  std::uint64_t now_ns = 1000 * kMs;

  explicit Rig(HostConfig from) : config(std::move(from)) {
    const std::size_t count = config.devices.size();
    inputs.resize(count);
    outputs.resize(count);
    sequences.resize(count);
    REQUIRE(graphs.open(config) == "");
    REQUIRE(build_device_scene(config, device_ranges(config).at(0), graphs, &scene) == "");
    for (const DeviceSetup& setup : scene.setups) {
      devices.push_back(std::make_unique<DeviceState>());
      REQUIRE(begin_device(setup, devices.back().get(), nullptr));
    }
  }
  explicit Rig(const std::vector<double>& rates_hz) : Rig(config_of(rates_hz)) {}

  void report(std::size_t device, double x, double y, double z) {
    RawReport& raw = inputs[device].reports[inputs[device].report_count++];
    Sample sample;
    sample.axis[0] = x, sample.axis[1] = y, sample.axis[2] = z;
    sample.sequence = ++sequences[device];
    sample.time_s = static_cast<double>(now_ns) * 1e-9;
    encode_input(config.devices[device].profile, sample, raw.data);
    raw.bytes = 22;
    raw.host_ns = now_ns;
    inputs[device].read = ReadStatus::kReport;
  }
  int tick() {
    now_ns += kMs;
    std::vector<Member> members;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      inputs[i].now_ns = now_ns;
      members.push_back({devices[i].get(), &inputs[i], &outputs[i]});
    }
    const int clock = group_tick(members.data(), static_cast<int>(members.size()));
    for (TickInput& input : inputs) {
      input.report_count = 0;
      input.arm = input.disarm = input.begins = false;
      input.read = ReadStatus::kTimeout;
    }
    return clock;
  }
  fdcg_pose body() const { return fdcg_body_get_pose(&scene.bodies[0].body); }
  double height_m() const { return body().translation_m[2]; }
  double wanted_n(std::size_t device) const {
    const double* const f = outputs[device].wanted_force_n;
    return std::hypot(f[0], f[1], f[2]);
  }
  // Whether its finger is in the scene.
  bool is_in(std::size_t device) const {
    fdcg_finger_result felt{};
    return fdcg_scene_get_result(scene.setups[0].scene, devices[device]->setup.fingers[0], &felt, nullptr) == FDCG_OK;
  }
  // Both beside the box, armed at once, and on it before it has fallen by 2 mm.
  void press_both() {
    constexpr int kNear = 9, kWay = 8;
    for (int i = 1; i <= kNear + kWay; ++i) {
      const double at_m = kHalf_m + 0.0005 - (0.0005 + kPressed_m) * std::max(0, i - kNear) / kWay;
      report(0, -at_m, 0, 0);
      report(1, at_m, 0, 0);
      inputs[0].arm = inputs[1].arm = i == kNear;
      tick();
    }
    hold(700, true);
    REQUIRE(outputs[0].phase == Phase::kArmed);
    REQUIRE(outputs[1].phase == Phase::kArmed);
    REQUIRE(wanted_n(0) > 2.9);
    REQUIRE(wanted_n(1) > 2.9);
    REQUIRE(std::fabs(height_m()) < 0.004);
  }
  // Ticks in which device 0 holds still, and device 1 too where it reports.
  void hold(int ticks, bool has_second) {
    for (int i = 0; i < ticks; ++i) {
      report(0, -kHalf_m + kPressed_m, 0, 0);
      if (has_second) report(1, kHalf_m - kPressed_m, 0, 0);
      tick();
    }
  }
};

}  // namespace

TEST_CASE("a device that has not reported yet has no finger in the scene") {
  HostConfig config = config_of({1000, 1000});
  config.devices[1].contacts_m[0][2] = -0.05;  // right below the box, if it were there
  Rig rig(config);
  for (int i = 0; i < 200; ++i) {
    rig.report(0, 1, 0, 0);
    CHECK(rig.tick() == 0);
  }
  CHECK(rig.is_in(0));
  CHECK_FALSE(rig.is_in(1));
  CHECK(rig.height_m() == Approx(-0.5 * kGravity * 0.2 * 0.2).epsilon(0.01));
}

TEST_CASE("shared scene: motion caused by one device is felt by the other") {
  Rig rig({1000, 1000});
  rig.press_both();
  const double before_m = rig.body().translation_m[0];
  for (int i = 1; i <= 500; ++i) {  // both to the side; the second a little behind, so that it is pushed
    const double way_m = 0.02 * i / 500;
    rig.report(0, -kHalf_m + kPressed_m + way_m, 0, 0);
    rig.report(1, kHalf_m - kPressed_m + way_m - 0.0005, 0, 0);
    rig.tick();
  }
  CHECK(rig.body().translation_m[0] - before_m > 0.018);
  CHECK(rig.outputs[1].wanted_force_n[0] > 3.2);
  CHECK(rig.outputs[0].wanted_force_n[0] == Approx(-rig.outputs[1].wanted_force_n[0]).epsilon(0.05));
}

TEST_CASE("shared scene: when the clock device is silent the next one takes over, at the same speed") {
  const bool is_slow = GENERATE(false, true);
  Rig rig({1000, is_slow ? 250.0 : 1000.0});
  const auto second = [&](int i) {
    if (!is_slow || i % 4 == 0) rig.report(1, 1, 0.1, 0);
  };
  for (int i = 0; i < 100; ++i) {
    rig.report(0, 1, 0, 0);
    second(i);
    CHECK(rig.tick() == 0);
  }
  CHECK(rig.height_m() == Approx(-0.5 * kGravity * 0.1 * 0.1).epsilon(0.02));
  int clock = 0;
  for (int i = 100; i < 300; ++i) {
    second(i);
    clock = rig.tick();
    if (i >= 104) CHECK(clock == 1);
  }
  // what it stood still for: three periods, and up to one of the slow device's
  CHECK(rig.height_m() < -0.5 * kGravity * 0.292 * 0.292);
  CHECK(rig.height_m() > -0.5 * kGravity * 0.301 * 0.301);
  for (int i = 300; i < 304; ++i) {  // the fastest is the clock again as soon as it is back
    rig.report(0, 1, 0, 0);
    second(i);
    CHECK(rig.tick() == 0);
  }
}

TEST_CASE("shared scene: nothing moves while no device reports") {
  Rig rig({1000, 1000});
  rig.press_both();
  for (int i = 0; i < 4; ++i)
    rig.tick();
  const double height_m = rig.height_m();
  for (int i = 0; i < 500; ++i)
    rig.tick();
  CHECK(rig.height_m() == height_m);
}

TEST_CASE("shared scene: a silent device holds for 10 ms, then its finger is removed and the box falls") {
  Rig rig({1000, 1000});
  rig.press_both();
  rig.hold(8, false);
  CHECK(rig.is_in(1));
  CHECK(rig.wanted_n(0) > 2.9);
  CHECK(std::fabs(rig.height_m()) < 0.004);
  rig.hold(4, false);
  CHECK_FALSE(rig.is_in(1));
  CHECK(rig.outputs[1].phase == Phase::kDisarmed);
  CHECK(rig.outputs[1].fault == Fault::kSilence);
  CHECK(rig.outputs[0].phase == Phase::kArmed);
  rig.hold(200, false);
  CHECK(rig.outputs[0].phase == Phase::kArmed);  // the other goes on, with nothing to press on
  CHECK(rig.wanted_n(0) == 0);
  CHECK(rig.height_m() < -0.1);
  CHECK(rig.devices[0]->counters.bodies_lost == 0);
}

TEST_CASE("shared scene: after a fault a finger is absent until its device is armed again") {
  HostConfig config = config_of({1000, 1000});
  config.gravity_m_per_s2[2] = 0;
  config.objects[0].motion.body.linear_damping_per_s = 100;  // let go, it stays near
  Rig rig(config);
  rig.press_both();
  rig.inputs[1].write_failed = true;
  rig.hold(1, true);
  CHECK(rig.outputs[1].fault == Fault::kWriteFailed);
  CHECK_FALSE(rig.is_in(1));
  rig.inputs[1].write_failed = false;
  rig.hold(100, true);
  CHECK_FALSE(rig.is_in(1));
  CHECK(rig.wanted_n(1) == 0);
  // beside the box, armed; then to the box, which it meets
  for (int i = 0; i < 700; ++i) {
    rig.report(0, -0.1, 0, 0);
    rig.report(1, 0.2, 0, 0);
    rig.inputs[1].arm = i == 10;
    rig.tick();
    CHECK(rig.is_in(1) == (i > 10));
  }
  CHECK(rig.outputs[1].phase == Phase::kArmed);
  const fdcg_pose box = rig.body();
  double most_n = 0;
  for (int i = 0; i < 1900; ++i) {
    rig.report(0, -0.1, 0, 0);
    rig.report(1, 0.2 + (box.translation_m[0] - 0.2) * i / 1900, box.translation_m[1] * i / 1900,
               box.translation_m[2] * i / 1900);
    rig.tick();
    most_n = std::max(most_n, rig.wanted_n(1));
  }
  CHECK(most_n > 0.01);
}

TEST_CASE("shared scene: an unplugged device loses its finger at once, and regains it with the next report if not armed") {
  Rig rig({1000, 1000});
  rig.hold(10, true);
  CHECK(rig.is_in(1));
  rig.inputs[1].read = ReadStatus::kLost;
  rig.hold(1, false);
  CHECK_FALSE(rig.is_in(1));
  rig.inputs[1].begins = true;
  rig.hold(1, true);
  CHECK(rig.is_in(1));
}

TEST_CASE("shared scene: a device disarmed by command still holds objects") {
  Rig rig({1000, 1000});
  rig.press_both();
  rig.inputs[1].disarm = true;
  rig.hold(300, true);
  CHECK(rig.outputs[1].phase == Phase::kDisarmed);
  CHECK(rig.outputs[1].force.force_n()[0] == 0);
  CHECK(rig.is_in(1));
  CHECK(rig.wanted_n(0) > 2.9);
  CHECK(std::fabs(rig.height_m()) < 0.004);
}
