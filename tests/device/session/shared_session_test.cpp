// SPDX-License-Identifier: Apache-2.0
// Devices that share a scene, as whole sessions on simulated ones: the cube when one of them fails, their log, and refusals.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "base/rotation.hpp"
#include "catch.hpp"
#include "host/fast_run.hpp"
#include "host/host.hpp"
#include "recording/session_log.hpp"
#include "recording/session_replay.hpp"
#include "scene/scene_build.hpp"
#include "session_rig.hpp"
#include "shared_rig.hpp"

using namespace fdcg::dev;
using namespace fdcg::test;

namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

SimulatedFault fault_at(SimulatedFaultKind kind, double at_s, double for_s) {
  SimulatedFault fault;
  fault.kind = kind;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}

// What the log of a run tells of it.
struct Story {
  std::vector<double> height_m;   // of the body, by ms
  std::vector<double> sent_n[3];  // to each device
  std::vector<Phase> phase[3];
  double worst_slew_n = 0, most_n = 0;  // of device 0
  bool is_same = false;
};

Story run(HostConfig config, const std::string& log) {
  config.log_file = log;
  const double most_slew_n = config.devices[0].profile.limits.slew_n_per_s * 0.002;
  FastRun fast;
  REQUIRE(fast.open(std::move(config)) == "");
  REQUIRE(fast.run(7, true) == "");
  Story story;
  SessionReplay replay;
  REQUIRE(replay.open(log, "") == "");
  double last_n[3] = {};
  for (ReplayedTick tick; replay.next(&tick);) {
    const double* const f = tick.output->force_n;
    story.sent_n[tick.device].push_back(std::hypot(f[0], f[1], f[2]));
    story.phase[tick.device].push_back(static_cast<Phase>(tick.output->phase));
    if (tick.device != 0) continue;
    const fdcg_pose& pose = tick.output->bodies[0];
    const double middle[3] = {kHalf_m, kHalf_m, kHalf_m};
    double turned_m[3];
    turn(pose.rotation_xyzw, middle, turned_m);
    story.height_m.push_back(pose.translation_m[2] + turned_m[2] - kHalf_m);
    const double change_n = std::hypot(f[0] - last_n[0], f[1] - last_n[1], f[2] - last_n[2]);
    const double now_n = std::hypot(f[0], f[1], f[2]), before_n = std::hypot(last_n[0], last_n[1], last_n[2]);
    if (now_n > before_n) story.worst_slew_n = std::max(story.worst_slew_n, change_n / most_slew_n);
    story.most_n = std::max(story.most_n, now_n);
    std::copy_n(f, 3, last_n);
  }
  story.is_same = replay.is_same();
  return story;
}

}  // namespace

TEST_CASE("shared scene: one of two devices is unplugged: the cube falls, the other stays armed") {
  const Folder folder;
  HostConfig config = example();
  config.devices[1].simulation.faults.push_back(fault_at(SimulatedFaultKind::kUnplug, 3.5, 0));
  const double limit_n = config.devices[0].most_force_n;
  const Story story = run(std::move(config), folder.file("a.fdcglog"));
  CHECK(story.is_same);
  REQUIRE(story.height_m.size() >= 6990);
  CHECK(story.height_m[3490] > 0.07);
  CHECK(story.height_m[3490 + 250] < 0.01);  // 75 mm take 0.124 s; it may come down on an edge
  CHECK(story.height_m.back() < 0.0005);
  CHECK(story.phase[0].back() == Phase::kArmed);
  CHECK(story.phase[1].back() == Phase::kDisarmed);
  for (std::size_t i = 3510; i < story.sent_n[1].size(); ++i)
    REQUIRE(story.sent_n[1][i] == 0);
  CHECK(story.most_n <= limit_n);
  CHECK(story.worst_slew_n <= 1);
}

TEST_CASE("shared scene: the third of three devices fails in any way: the others hold the cube") {
  const auto kind = GENERATE(SimulatedFaultKind::kUnplug, SimulatedFaultKind::kStall, SimulatedFaultKind::kNoOutput,
                             SimulatedFaultKind::kDeviceFault, SimulatedFaultKind::kShort);
  const bool is_first = GENERATE(false, true);  // of the scene: then it is the clock
  const Folder folder;
  HostConfig config = example();
  DeviceConfig third = config.devices[1];
  third.name = "third";
  third.simulation.script = {{0, {0, 0, 0.2}, 0}, {3.3, {0, 0, 0.2}, 0}, {3.6, {0, 0, 0.115}, 0}};  // comes near, and waits
  SimulatedFault fault = fault_at(kind, 4, kind == SimulatedFaultKind::kUnplug ? 0 : 2.5);
  fault.reports = 2500;
  third.simulation.faults.push_back(fault);
  third.profile = simulated_profile(third.simulation);
  config.devices.insert(is_first ? config.devices.begin() : config.devices.end(), third);
  const Story story = run(std::move(config), folder.file("a.fdcglog"));
  CAPTURE(static_cast<int>(kind), is_first);
  CHECK(story.is_same);
  const std::size_t dead = is_first ? 0 : 2, one = is_first ? 1 : 0, other = is_first ? 2 : 1;
  REQUIRE(story.height_m.size() >= 6980);
  for (std::size_t i = 3400; i < 5000; ++i) {
    CAPTURE(i);
    REQUIRE(story.height_m[i] > 0.07);
    REQUIRE(story.phase[one][i] == Phase::kArmed);
    REQUIRE(story.phase[other][i] == Phase::kArmed);
  }
  CHECK(story.phase[dead][4050] == Phase::kDisarmed);
  CHECK(story.sent_n[dead][4050] == 0);
  CHECK(std::fabs(story.height_m.back()) < 0.0005);  // put down as if nothing had been
}

TEST_CASE("a recording of devices that share a scene is played to the same forces") {
  const Folder folder;
  HostConfig config = example();
  config.log_file = folder.file("a.fdcglog");
  {
    FastRun fast;
    REQUIRE(fast.open(config) == "");
    REQUIRE(fast.run(4, true) == "");
  }
  for (DeviceConfig& device : config.devices) {
    device.source = DeviceSource::kRecorded;
    device.recording = config.log_file;
  }
  config.log_file = folder.file("b.fdcglog");
  FastRun fast;
  REQUIRE(fast.open(config) == "");
  REQUIRE(fast.run(0, true) == "");
  CHECK(fast.has_ended(0));
  CHECK(fast.has_ended(1));
  SessionReplay first, second;
  REQUIRE(first.open(folder.file("a.fdcglog"), "") == "");
  REQUIRE(second.open(folder.file("b.fdcglog"), "") == "");
  ReplayedTick a, b;
  int compared = 0;
  while (first.next(&a) && second.next(&b)) {
    REQUIRE(a.device == b.device);
    for (int i = 0; i < 3; ++i)
      REQUIRE(a.output->wanted_force_n[i] == b.output->wanted_force_n[i]);
    ++compared;
  }
  CHECK(compared >= 7990);
}

TEST_CASE("shared scene: two devices press one sheet") {
  const bool is_shared = GENERATE(true, false);
  const Folder folder;
  HostConfig config;
  REQUIRE(read_scene(FDCG_SOURCE_DIR "/testdata/scenes/press_sheet.json", &config) == "");
  config.objects[0].file = FDCG_SHEET;
  config.objects[0].motion.soft.damping_n_s_per_m = 2;
  config.devices.push_back(config.devices[0]);
  config.devices[1].name = "second";
  for (ScriptStep& step : config.devices[1].simulation.script)
    step.place_m[0] += 0.01;
  config.is_shared = is_shared;
  config.log_file = folder.file("a.fdcglog");
  FastRun fast;
  REQUIRE(fast.open(config) == "");
  REQUIRE(fast.run(3, true) == "");
  SessionReplay replay;
  REQUIRE(replay.open(config.log_file, "") == "");
  double deepest_m[2] = {};
  for (ReplayedTick tick; replay.next(&tick);)
    deepest_m[tick.device] = std::max(deepest_m[tick.device], tick.state->setup.soft[0]->deepest_m());
  CHECK(replay.is_same());
  if (is_shared) {
    CHECK(deepest_m[0] == deepest_m[1]);
    CHECK(deepest_m[0] > 0.0105);
  } else {
    CHECK(deepest_m[0] < 0.0095);  // each alone
    CHECK(deepest_m[1] < 0.0095);
  }
}

TEST_CASE("a log that was cut off replays up to the last tick that all devices have") {
  const Folder folder;
  HostConfig config = example();
  config.log_file = folder.file("a.fdcglog");
  config.log_megabytes = GENERATE(0.0, 0.3, 0.3001, 0.3002);
  FastRun fast;
  REQUIRE(fast.open(config) == "");
  REQUIRE(fast.run(1, true) == "");
  const bool has_limit = config.log_megabytes > 0;
  if (!has_limit) {
    const std::string whole = bytes_of(config.log_file);
    std::filesystem::resize_file(config.log_file, whole.size() * 2 / 3);
  }
  SessionReplay replay;
  REQUIRE(replay.open(config.log_file, "") == "");
  std::uint64_t ticks[2] = {};
  for (ReplayedTick tick; replay.next(&tick);)
    ++ticks[tick.device];
  CHECK(ticks[0] > 100);
  CHECK(ticks[0] == ticks[1]);
  CHECK(replay.is_same() == has_limit);
  for (const DeviceReplay& device : replay.devices()) {
    CHECK(device.difference == "");
    CHECK_FALSE(device.has_gap);
  }
}

TEST_CASE("shared scene: a missing or different record ends the replay of all devices") {
  const Folder folder;
  HostConfig config = example();
  config.log_file = folder.file("a.fdcglog");
  const bool is_gap = GENERATE(false, true);
  LogRing ring(1u << 20, 2);
  LogRing* const rings[] = {&ring};
  SessionLog log;
  REQUIRE(log.start(config, rings, 1) == "");
  std::vector<TickInput> inputs(2);
  std::vector<TickOutput> outputs(2);
  const Member members[] = {{nullptr, &inputs[0], &outputs[0]}, {nullptr, &inputs[1], &outputs[1]}};
  for (int i = 0; i < 5; ++i) {
    outputs[1].hip_world_m[0] = !is_gap && i == 3 ? 1 : 0;
    inputs[0].now_ns = inputs[1].now_ns = kSecond_ns * static_cast<std::uint64_t>(i + 1);
    for (TickOutput& output : outputs) {
      output.fault = Fault::kCommanded;
      output.body_count = 1;
      output.bodies[0] = config.objects[0].pose;
    }
    if (is_gap && i == 3) ring.put(inputs[0], outputs[0], 0);  // a tick of one device alone
    ring.put_all(members);
  }
  REQUIRE(log.stop() == "");
  SessionReplay replay;
  REQUIRE(replay.open(config.log_file, "") == "");
  for (ReplayedTick tick; replay.next(&tick);) {
  }
  CHECK_FALSE(replay.is_same());
  const DeviceReplay &thumb = replay.devices()[0], &finger = replay.devices()[1];
  CHECK(thumb.ticks == (is_gap ? 3 : 4));
  CHECK(finger.ticks == thumb.ticks);
  CHECK(thumb.is_over);
  CHECK(finger.is_over);
  CHECK(thumb.has_gap == is_gap);
  if (is_gap) return;
  CHECK(finger.difference.find("tick 3: hip_world_m[0]") == 0);
  CHECK(thumb.ended_by == "finger");
}

TEST_CASE("shared scene: used where objects can move, and recorded in the log") {
  HostConfig config = example();
  CHECK(config.is_shared);
  HostConfig back;
  REQUIRE(parse_scene(write_scene(config), "log", &back) == "");
  CHECK(back.is_shared);
  const auto shared_with = [&](const char* motion, const char* key, const SceneOptions& options = {}) {
    HostConfig read;
    const std::string text =
        std::string(R"({"fdcg_scene": 1, )") + key + R"( "objects": [{"name": "a", "file": "a.fdcg", "motion": {"kind": ")" +
        motion + R"("}}], "devices": [{"name": "x", "source": "simulated"}, {"name": "y", "source": "simulated"}]})";
    const std::string problem = parse_scene(text, "s.json", &read, nullptr, options);
    return problem.empty() ? (read.is_shared ? std::string("yes") : std::string("no")) : problem;
  };
  CHECK(shared_with("body", "") == "yes");
  CHECK(shared_with("soft", "") == "yes");
  CHECK(shared_with("fixed", "") == "no");
  CHECK(shared_with("fixed", "\"shared\": true,") == "yes");
  CHECK(shared_with("soft", "\"shared\": false,") == "no");
  CHECK(shared_with("soft", "", {.shares_soft = false}) == "no");  // a log of the time before
  const std::string refused = shared_with("body", "\"shared\": false,");
  CHECK(refused.find("s.json: shared is false for 2 devices") == 0);
  CHECK(refused.find("set it to true") != std::string::npos);
}

TEST_CASE("devices that cannot share a scene are refused with the value, the limit and what to do") {
  const auto refusal = [](const HostConfig& config) {
    SceneGraphs graphs;
    DeviceScene scene;
    REQUIRE(graphs.open(config) == "");
    return build_device_scene(config, device_ranges(config).at(0), graphs, &scene);
  };
  CHECK(refusal(config_of({1000, 125})) == "");
  const std::string slow = refusal(config_of({1000, 500, 120}));
  INFO(slow);
  CHECK(slow.find("devices[2] 'device 2': it reports 120 times a second") != std::string::npos);
  CHECK(slow.find("1000") != std::string::npos);
  CHECK(slow.find("(125)") != std::string::npos);
  HostConfig light = config_of({1000, 1000, 1000});
  light.objects[0].motion.body.mass_kg = 1e-6;
  CHECK(refusal(light).find("too light for 3 contacts") != std::string::npos);
  HostConfig free_running = example();
  free_running.devices[1].simulation.is_real_time = false;
  Host host;
  const std::string message = host.open(free_running);
  INFO(message);
  CHECK(message.find("device 'finger'") == 0);
  CHECK(message.find("--fast") != std::string::npos);
}
