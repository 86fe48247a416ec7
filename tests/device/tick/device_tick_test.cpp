// SPDX-License-Identifier: Apache-2.0
// The pure tick: from reports to a gated force, and its counters.
#include "tick/device_tick.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"
#include "plain_profile.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::dev;
using namespace fdcg::test;

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr double kStiffness = 1000;

// A unit cube about the origin, without friction, and a device that feels it.
struct Rig {
  AlignedBytes bytes{compile_whole(cube()).bytes};
  fdcg_graph graph{};
  std::vector<std::uint64_t> memory;
  fdcg_object_id object{};
  DeviceState device;
  TickInput input{};
  TickOutput output;
  std::uint32_t sequence = 0;
  std::uint64_t now_ns = 1000 * kMs;

  explicit Rig(const Mapping& mapping = {}, const std::vector<Vec3>& contacts = {{0, 0, 0}}, bool is_driven = false) {
    REQUIRE(fdcg_open_memory(bytes.data(), bytes.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
    DeviceSetup setup;
    setup.profile = plain_profile();
    setup.mapping = mapping;
    setup.contact_count = static_cast<int>(contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      setup.contacts_m[i][0] = contacts[i].x, setup.contacts_m[i][1] = contacts[i].y, setup.contacts_m[i][2] = contacts[i].z;
    }
    const fdcg_scene_config config = fdcg_make_scene_config();
    memory.resize(fdcg_scene_bytes(&config) / 8 + 1);
    REQUIRE(fdcg_scene_create(memory.data(), memory.size() * 8, &config, &setup.scene, nullptr) == FDCG_OK);
    fdcg_params params = fdcg_make_params();
    params.mu_static = params.mu_dynamic = 0;
    params.stiffness_n_per_m = kStiffness;
    const fdcg_pose pose = fdcg_make_identity_pose();
    REQUIRE(fdcg_scene_add_object(setup.scene, &graph, &params, &pose, &object, nullptr) == FDCG_OK);
    if (is_driven) {
      setup.driven_count = 1;
      setup.driven[0] = object;
    }
    REQUIRE(begin_device(setup, &device, nullptr));
  }

  void report(double x, double y, double z, std::uint8_t status = 0) {
    RawReport& raw = input.reports[input.report_count++];
    Sample sample;
    sample.axis[0] = x, sample.axis[1] = y, sample.axis[2] = z;
    sample.sequence = ++sequence;
    sample.time_s = static_cast<double>(now_ns) * 1e-9;
    encode_input(device.setup.profile, sample, raw.data);
    raw.data[21] = status;
    raw.bytes = 22;
    raw.host_ns = now_ns;
    input.read = ReadStatus::kReport;
  }
  const TickOutput& tick(std::uint64_t after_ns = kMs) {
    now_ns += after_ns;
    input.now_ns = now_ns;
    device_tick(device, input, &output);
    input.report_count = 0;
    input.arm = input.disarm = input.begins = false;
    input.read = ReadStatus::kTimeout;
    return output;
  }
  const TickOutput& at(double x, double y, double z) {
    report(x, y, z);
    return tick();
  }
  // As many reports as arming needs.
  void begin_at(double x, double y, double z) {
    for (int i = 0; i < kSamplesToArm; ++i)
      at(x, y, z);
  }
  // Armed above the cube, the ramp done, then pressed `depth_m` into its top.
  void press(double depth_m) {
    begin_at(0.1, 0.1, 0.505);
    input.arm = true;
    for (int i = 0; i < 600; ++i)
      at(0.1, 0.1, 0.505);
    REQUIRE(output.phase == Phase::kArmed);
    at(0.1, 0.1, 0.5 - depth_m);
  }
};

}  // namespace

TEST_CASE("device tick: the force of a press into a face is that of the spring") {
  Rig rig;
  rig.press(0.002);
  CHECK(rig.output.has_sample);
  CHECK(rig.output.state == FDCG_FACE);
  CHECK(rig.output.echo == rig.sequence);
  CHECK(rig.output.force.force_n()[2] == Approx(2));
  CHECK(rig.output.force.effort()[2] == Approx(2));
  CHECK(rig.output.hip_world_m[2] == Approx(0.498));
  CHECK(rig.output.wanted_force_n[2] == Approx(2));
}

TEST_CASE("device tick: the mapping transforms the tip, and the force back") {
  Mapping mapping;
  const double turned[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0};  // device's x is the world's y, y is z, z is x
  std::copy_n(turned, 9, mapping.rotation);
  mapping.scale = 2;
  mapping.offset_m[0] = 0.1;
  Rig rig(mapping);
  const auto hand = [&](double depth) { return 0.5 * (0.5 - depth); };  // device's y for a height of 0.5 - depth
  rig.begin_at(0.05, hand(-0.01), 0);
  rig.input.arm = true;
  for (int i = 0; i < 600; ++i)
    rig.at(0.05, hand(-0.01), 0);
  rig.at(0.05, hand(0.002), 0);
  CHECK(rig.output.hip_world_m[0] == Approx(0.1));
  CHECK(rig.output.hip_world_m[1] == Approx(0.1));
  CHECK(rig.output.hip_world_m[2] == Approx(0.498));
  CHECK(rig.output.wanted_force_n[2] == Approx(2));
  CHECK(rig.output.force.force_n()[0] == Approx(0).margin(1e-9));
  CHECK(rig.output.force.force_n()[1] == Approx(2));
  CHECK(rig.output.force.force_n()[2] == Approx(0).margin(1e-9));
}

TEST_CASE("several contacts add up") {
  Rig rig({}, {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}});
  rig.press(0.002);
  CHECK(rig.output.force.force_n()[2] == Approx(4));  // the third is above the face
}

TEST_CASE("of several reports the newest good one counts") {
  Rig rig;
  rig.press(0.002);
  const TickCounters before = rig.device.counters;
  rig.report(0.1, 0.1, 0.497);
  rig.report(0.1, 0.1, 0.496);
  rig.sequence += 3;  // three are lost
  rig.report(0.1, 0.1, 0.499);
  rig.report(0.1, 0.1, 0.3);
  rig.input.reports[3].bytes = 21;  // short
  rig.tick();
  const TickCounters& counters = rig.device.counters;
  CHECK(rig.output.force.force_n()[2] == Approx(1));
  CHECK(counters.ticks == before.ticks + 1);
  CHECK(counters.superseded == before.superseded + 2);
  CHECK(counters.lost == before.lost + 3);
  CHECK(counters.rejected[static_cast<int>(Verdict::kLength)] == 1);
  CHECK(counters.late == 0);
}

TEST_CASE("device tick: rejected reports change nothing and count as missed ticks") {
  Rig rig;
  rig.press(0.002);
  for (int i = 0; i < 5; ++i) {
    rig.report(0.1, 0.1, 0.4);
    rig.input.reports[0].data[0] = 9;  // another id
    rig.tick();
    if (i < 2) CHECK(rig.output.force.force_n()[2] == Approx(2));
  }
  CHECK_FALSE(rig.output.has_sample);
  CHECK(rig.output.phase == Phase::kFading);
  CHECK(rig.output.force.force_n()[2] == 0);
  CHECK(rig.output.hip_world_m[2] == Approx(0.498));
  CHECK(rig.device.counters.rejected[static_cast<int>(Verdict::kId)] == 5);
  rig.at(0.1, 0.1, 0.498);
  CHECK(rig.device.counters.late == 1);
  CHECK(rig.output.phase == Phase::kRamping);
}

TEST_CASE("a device's own fault disarms, and a disarming is counted once, by its reason") {
  Rig rig;
  rig.press(0.002);
  rig.report(0.1, 0.1, 0.498, 1);
  CHECK(rig.tick().force.force_n()[2] == 0);
  CHECK(rig.output.fault == Fault::kDeviceFault);
  rig.input.read = ReadStatus::kLost;
  rig.tick();
  CHECK(rig.device.counters.disarmed[static_cast<int>(Fault::kDeviceFault)] == 1);
  CHECK(rig.device.counters.disarmed[static_cast<int>(Fault::kReadFailed)] == 0);
}

TEST_CASE("arming is refused until the device has sent a few good reports, each time that it is opened") {
  Rig rig;
  for (int opening = 0; opening < 2; ++opening) {
    rig.input.begins = true;
    for (int i = 1; i <= kSamplesToArm; ++i) {
      rig.input.arm = true;
      rig.at(0.1, 0.1, 0.505);
      CHECK(rig.output.arming_refused == (i < kSamplesToArm));
      CHECK(rig.output.force.is_enabled() == (i == kSamplesToArm));
    }
    rig.input.disarm = true;
    rig.at(0.1, 0.1, 0.505);
  }
}

TEST_CASE("arming is refused while a finger is pressed into something") {
  Rig rig;
  rig.begin_at(0.1, 0.1, 0.505);
  rig.at(0.1, 0.1, 0.498);
  rig.input.arm = true;
  rig.at(0.1, 0.1, 0.498);
  CHECK(rig.output.arming_refused);
  CHECK(rig.output.phase == Phase::kDisarmed);
  rig.at(0.1, 0.1, 0.505);
  rig.input.arm = true;
  rig.at(0.1, 0.1, 0.505);
  CHECK_FALSE(rig.output.arming_refused);
  CHECK(rig.output.phase == Phase::kRamping);
}

TEST_CASE("device tick: after reopening, a device starts at its position without contact on the way") {
  Rig rig;
  rig.press(0.002);
  rig.at(0.1, 0.1, 0.505);
  rig.sequence = 0;
  rig.report(0.1, 0.1, -0.6);
  rig.input.begins = true;
  rig.tick(500 * kMs);
  CHECK(rig.output.has_sample);
  CHECK(rig.output.state == FDCG_FREE);
  CHECK(rig.output.wanted_force_n[2] == 0);
  rig.at(0.1, 0.1, -0.498);
  CHECK(rig.output.wanted_force_n[2] == Approx(-2));
  CHECK(rig.device.counters.lost == 0);
}

TEST_CASE("device tick: a driven object that moves onto the hand is felt") {
  Rig rig({}, {{0, 0, 0}}, true);
  rig.at(0.1, 0.1, 0.505);
  rig.input.pose_count = 1;
  rig.input.poses[0] = fdcg_make_identity_pose();
  rig.input.poses[0].translation_m[2] = 0.007;
  rig.at(0.1, 0.1, 0.505);
  CHECK(rig.output.wanted_force_n[2] == Approx(2));
}

TEST_CASE("device tick: the same inputs give the same bits, whatever the unused part contains") {
  std::vector<double> seen[2];
  for (int run = 0; run < 2; ++run) {
    Rig rig;
    if (run == 1) {
      for (RawReport& raw : rig.input.reports)
        std::fill_n(raw.data, kMaxReportBytes, std::uint8_t{0xA5});
    }
    rig.press(0.001);
    for (int i = 0; i < 500; ++i) {
      rig.at(0.1 + 0.02 * std::sin(0.1 * i), 0.1 + 0.0001 * i, 0.499 + 0.002 * std::sin(0.37 * i));
      if (i % 50 == 0) rig.tick();
      for (int k = 0; k < 3; ++k)
        seen[run].push_back(rig.output.force.effort()[k]);
    }
  }
  REQUIRE(seen[0].size() == seen[1].size());
  CHECK(std::memcmp(seen[0].data(), seen[1].data(), seen[0].size() * sizeof(double)) == 0);
  CHECK(std::count(seen[0].begin(), seen[0].end(), 0.0) < static_cast<long>(seen[0].size()));
}

TEST_CASE("device tick: without the dead-man button there is no force, and letting it go takes it away in that tick") {
  constexpr std::uint8_t kHeld = 2;
  Rig rig;
  Profile& profile = rig.device.setup.profile;
  Field& buttons = profile.input.fields[profile.input.field_count++];
  buttons.role = Role::kButtons;
  buttons.offset = 21;  // of the status too
  rig.device.setup.dead_man_mask = kHeld;
  const auto step = [&](double z, std::uint8_t held, bool arm = false) -> const TickOutput& {
    rig.report(0, 0, z, held);
    rig.input.arm = arm;
    return rig.tick();
  };
  for (int i = 0; i < 20; ++i)
    step(0.6, 0);
  CHECK(step(0.6, 0, true).arming_refused);
  CHECK(rig.output.fault == Fault::kReleased);
  step(0.6, kHeld, true);
  CHECK(rig.output.phase == Phase::kRamping);
  for (int i = 0; i < 600; ++i)
    step(0.6 - 0.0002 * i, kHeld);
  REQUIRE(rig.output.phase == Phase::kArmed);
  for (int i = 0; i < 600 && rig.output.force.force_n()[2] < 0.5; ++i)
    step(0.499, kHeld);
  REQUIRE(rig.output.force.force_n()[2] > 0.5);
  step(0.499, 0);
  CHECK(rig.output.force.force_n()[2] == 0);
  CHECK_FALSE(rig.output.force.is_enabled());
  CHECK(rig.output.fault == Fault::kReleased);
  for (int i = 0; i < 100; ++i)
    CHECK(step(0.6, kHeld).phase == Phase::kDisarmed);  // not by itself
}
