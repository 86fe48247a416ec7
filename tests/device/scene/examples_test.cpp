// SPDX-License-Identifier: Apache-2.0
// The examples of testdata/scenes, from end to end and without real time: simulated device, gate, log, replay. What is held
// does not slip: each finger's god-object stays where it took hold, in the frame of what it holds.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "catch.hpp"
#include "host/fast_run.hpp"
#include "recording/session_log.hpp"
#include "recording/session_replay.hpp"
#include "scene/scene_json.hpp"
#include "session_rig.hpp"

using namespace fdcg::dev;

namespace {

const std::string kScenes = FDCG_SOURCE_DIR "/testdata/scenes/";

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

HostConfig read(const std::string& scene) {
  HostConfig config;
  std::vector<std::string> warnings;
  REQUIRE(read_scene(scene, &config, &warnings) == "");
  CHECK(warnings.empty());
  return config;
}

DeviceStatus run(HostConfig config, double seconds, const std::string& log) {
  config.log_file = log;
  FastRun fast;
  REQUIRE(fast.open(std::move(config)) == "");
  REQUIRE(fast.run(seconds, true) == "");
  return fast.status(0);
}

// A point of the world in the frame of a body of scale 1 or not: only differences of it are looked at.
void to_body(const fdcg_pose& pose, const double world_m[3], double body_m[3]) {
  const double* const q = pose.rotation_xyzw;
  const double v[3] = {world_m[0] - pose.translation_m[0], world_m[1] - pose.translation_m[1],
                       world_m[2] - pose.translation_m[2]};
  const double c[3] = {q[2] * v[1] - q[1] * v[2], q[0] * v[2] - q[2] * v[0], q[1] * v[0] - q[0] * v[1]};
  body_m[0] = v[0] + 2 * (q[3] * c[0] + q[2] * c[1] - q[1] * c[2]);
  body_m[1] = v[1] + 2 * (q[3] * c[1] + q[0] * c[2] - q[2] * c[0]);
  body_m[2] = v[2] + 2 * (q[3] * c[2] + q[1] * c[0] - q[0] * c[1]);
}

constexpr double kStill = 1e-6;  // m/s
constexpr double kSize = 0.03;   // m: of what is held, from its middle

struct Held {
  double highest_m = 0, drift_m = 0, end_m = 0, least_force_n = 1e9;
  double last_look_s = 0;  // at the drift
  int slipping = 0, looks = 0;
  fdcg_pose last;
};

// Of the scene's one body, between two times at which all contacts hold it.
Held replay(const std::string& log, double from_s, double to_s) {
  SessionReplay replay;
  REQUIRE(replay.open(log, "") == "");
  Held held;
  double first_m[kMaxDevices][kMaxContacts][3] = {};
  bool has_first[kMaxDevices][kMaxContacts] = {};
  std::uint64_t first_ns = 0;
  for (ReplayedTick tick; replay.next(&tick);) {
    if (first_ns == 0) first_ns = tick.input->now_ns;
    const double time_s = static_cast<double>(tick.input->now_ns - first_ns) * 1e-9;
    REQUIRE(tick.output->body_count == 1);
    held.last = tick.output->bodies[0];
    held.highest_m = std::max(held.highest_m, held.last.translation_m[2]);
    held.end_m = held.last.translation_m[2];
    if (time_s < from_s || time_s > to_s) continue;
    const DeviceSetup& setup = tick.state->setup;
    for (int contact = 0; contact < setup.contact_count; ++contact) {
      fdcg_finger_result finger{};
      REQUIRE(fdcg_scene_get_result(setup.scene, setup.fingers[contact], &finger, nullptr) == FDCG_OK);
      CAPTURE(time_s, contact);
      REQUIRE(finger.touch_count == 1);
      const fdcg_touch& touch = finger.touches[0];
      REQUIRE(touch.state == FDCG_FACE);
      held.slipping += touch.slipping;
      held.least_force_n = std::min(held.least_force_n, std::hypot(touch.force_n[0], touch.force_n[1], touch.force_n[2]));
      // A touch is reported in the pose before the last substep, so it is compared only while the body is at rest.
      const fdcg_body& body = tick.state->setup.bodies[0].body;
      const double *const v = body.velocity_m_per_s, *const turn = body.spin_rad_per_s;
      if (std::hypot(v[0], v[1], v[2]) > kStill || std::hypot(turn[0], turn[1], turn[2]) * kSize > kStill) continue;
      ++held.looks;
      held.last_look_s = time_s;
      double at_m[3];
      to_body(held.last, touch.god_object_m, at_m);
      double* const first = first_m[tick.device][contact];
      if (!has_first[tick.device][contact]) std::copy_n(at_m, 3, first);
      has_first[tick.device][contact] = true;
      for (int i = 0; i < 3; ++i)
        held.drift_m = std::max(held.drift_m, std::fabs(at_m[i] - first[i]));
    }
  }
  CHECK(replay.is_same());
  return held;
}

// A cube is lifted, turned by a quarter and put down, without slipping between these times.
Held check_lifted(const char* scene, double from_s, double to_s) {
  const Folder folder;
  const DeviceStatus status = run(read(kScenes + scene), 8, folder.file("a.fdcglog"));
  CHECK(status.counters.ticks == 8000);
  CHECK(status.counters.bodies_lost == 0);
  CHECK(status.last.phase == Phase::kArmed);
  const Held held = replay(folder.file("a.fdcglog"), from_s, to_s);
  CHECK(held.highest_m > 0.07);
  CHECK(std::fabs(held.end_m) < 0.0005);  // as deep in the ground as its springs carry it
  CHECK(held.slipping == 0);
  CHECK(held.least_force_n > 2.9);
  WARN("drift of the god-objects on the cube in 4.1 s: " << held.drift_m << " m, at " << held.looks << " looks");
  CHECK(held.drift_m < 1e-9);
  CHECK(held.last.rotation_xyzw[2] == Approx(std::sqrt(0.5)).margin(1e-4));
  CHECK(held.last.rotation_xyzw[3] == Approx(std::sqrt(0.5)).margin(1e-4));
  return held;
}

}  // namespace

TEST_CASE("two fingers lift a cube, turn it by a quarter and put it down, without slipping") {
  const Held held = check_lifted("lift_cube.json", 2, 6.1);
  CHECK(held.looks > 300);
  CHECK(held.last_look_s > 4.5);
}

TEST_CASE("two devices lift one cube, turn it by a quarter and put it down, without slipping") {
  CHECK(check_lifted("two_devices.json", 2.1, 6.2).looks > 100);
}

TEST_CASE("three fingers hold a ball and turn it by a third, without slipping") {
  const Folder folder;
  const DeviceStatus status = run(read(kScenes + "hold_sphere.json"), 8, folder.file("a.fdcglog"));
  CHECK(status.counters.ticks == 8000);
  CHECK(status.last.phase == Phase::kArmed);
  const Held held = replay(folder.file("a.fdcglog"), 2, 6.2);
  CHECK(held.highest_m > 0.1);
  CHECK(held.slipping == 0);
  CHECK(held.least_force_n > 1.5);
  WARN("drift of the god-objects on the ball in 4.2 s: " << held.drift_m << " m, at " << held.looks << " looks");
  CHECK(held.looks > 300);
  CHECK(held.last_look_s > 4.5);
  CHECK(held.drift_m < 1e-9);
  CHECK(held.last.rotation_xyzw[2] == Approx(std::sqrt(0.75)).margin(1e-3));
  CHECK(std::fabs(held.end_m - 0.03) < 0.002);
}

TEST_CASE("two fingers beside a cube's middle: it tips between points, pads hold and turn it") {
  for (const double pad_m : {0.0, 0.01}) {
    const Folder folder;
    HostConfig config = read(kScenes + "lift_cube.json");
    DeviceConfig& device = config.devices[0];
    for (int contact = 0; contact < 2; ++contact) {
      device.contacts_m[contact][1] = device.grip.closed_m[contact][1] = 0.006;
      device.pads_m[contact] = pad_m;
    }
    CHECK(run(std::move(config), 4.6, folder.file("a.fdcglog")).last.phase == Phase::kArmed);
    SessionReplay replay;
    REQUIRE(replay.open(folder.file("a.fdcglog"), "") == "");
    fdcg_pose last{};
    double tilt_rad = 0;
    std::uint64_t ticks = 0;
    for (ReplayedTick tick; replay.next(&tick);) {
      last = tick.output->bodies[0];
      const double* const q = last.rotation_xyzw;
      if (++ticks > 2600) tilt_rad = std::max(tilt_rad, 2 * std::hypot(q[0], q[1]));  // it hangs in the air
    }
    CAPTURE(pad_m, tilt_rad, last.translation_m[2]);
    CHECK(replay.is_same());
    CHECK(last.translation_m[2] > 0.03);
    if (pad_m == 0) {
      CHECK(tilt_rad > 0.5);
      continue;
    }
    // the weight, 6 mm beside, against two springs of 1 N/mm times the radius squared; as much again for the swing
    const double sagged_rad = 0.1 * 9.80665 * 0.006 / (2 * 1000 * pad_m * pad_m);
    CHECK(tilt_rad < 2 * sagged_rad);
    CHECK(tilt_rad > 0.5 * sagged_rad);
  }
}

TEST_CASE("with friction for half of its weight the cube stays on the ground, and the fingers slip") {
  const Folder folder;
  HostConfig config = read(kScenes + "lift_cube.json");
  // two contacts of 3 N bear 6 mu
  config.objects[0].params.mu_static = config.objects[0].params.mu_dynamic = 0.5 * 0.1 * 9.80665 / 6;
  run(std::move(config), 8, folder.file("a.fdcglog"));
  SessionReplay replay;
  REQUIRE(replay.open(folder.file("a.fdcglog"), "") == "");
  double highest_m = 0;
  for (ReplayedTick tick; replay.next(&tick);)
    highest_m = std::max(highest_m, tick.output->bodies[0].translation_m[2]);
  CHECK(replay.is_same());
  CHECK(highest_m < 0.001);
}

TEST_CASE("a soft sheet deforms under a finger, carries its god-object, and recovers") {
  const Folder folder;
  HostConfig config = read(kScenes + "press_sheet.json");
  config.objects[0].file = FDCG_SHEET;
  const DeviceStatus status = run(std::move(config), 8, folder.file("a.fdcglog"));
  CHECK(status.last.phase == Phase::kArmed);
  SessionReplay replay;
  REQUIRE(replay.open(folder.file("a.fdcglog"), "") == "");
  double deepest_m = 0, most_n = 0, held_z_m = 0, last_m = 1;
  int pressed = 0, released = 0;
  for (ReplayedTick tick; replay.next(&tick);) {
    const SoftObject& sheet = *tick.state->setup.soft[0];
    const double force_n =
        std::hypot(tick.output->wanted_force_n[0], tick.output->wanted_force_n[1], tick.output->wanted_force_n[2]);
    pressed += tick.output->state != FDCG_FREE;
    if (tick.output->state == FDCG_FREE) {
      released += pressed > 0;
      REQUIRE(force_n == 0);
    } else {
      // it rides on the sheet, which has given way: well below where the sheet was
      REQUIRE(tick.output->wanted_force_n[2] > 0);
      fdcg_finger_result finger{};
      REQUIRE(fdcg_scene_get_result(tick.state->setup.scene, tick.state->setup.fingers[0], &finger, nullptr) == FDCG_OK);
      REQUIRE(finger.touch_count == 1);
      held_z_m = std::min(held_z_m, finger.touches[0].god_object_m[2]);
    }
    deepest_m = std::max(deepest_m, sheet.deepest_m());
    most_n = std::max(most_n, force_n);
    last_m = sheet.deepest_m();
  }
  CHECK(replay.is_same());
  WARN("dent " << deepest_m << " m under " << most_n << " N; at the end " << last_m << " m");
  CHECK(pressed > 3000);
  CHECK(released > 1000);
  CHECK(deepest_m > 0.004);
  CHECK(held_z_m < -0.004);
  CHECK(most_n > 0.5);
  CHECK(last_m < 1e-4);
}

TEST_CASE("two contacts press one sheet beside a ball, and the sheet's load is the sum of their forces") {
  const Folder folder;
  HostConfig config = read(kScenes + "press_sheet.json");
  config.objects[0].file = FDCG_SHEET;
  config.objects[0].motion.soft.damping_n_s_per_m = 2;  // for two contacts
  ObjectConfig ball;
  ball.name = "ball";
  ball.is_surface = true;
  ball.surface = fdcg_make_sphere(0.01);
  ball.pose = fdcg_make_identity_pose();
  ball.pose.translation_m[0] = -0.03;
  ball.params = fdcg_make_params();
  config.objects.push_back(ball);
  DeviceConfig& device = config.devices[0];
  device.contact_count = 2;
  device.contacts_m[0][0] = 0.02;
  device.contacts_m[1][0] = -0.02;
  run(std::move(config), 4, folder.file("a.fdcglog"));
  SessionReplay replay;
  REQUIRE(replay.open(folder.file("a.fdcglog"), "") == "");
  int both_on_sheet = 0, on_ball = 0;
  for (ReplayedTick tick; replay.next(&tick);) {
    double sum_n[3] = {};
    int on_sheet = 0;
    for (int contact = 0; contact < 2; ++contact) {
      fdcg_finger_result finger{};
      REQUIRE(fdcg_scene_get_result(tick.state->setup.scene, tick.state->setup.fingers[contact], &finger, nullptr) == FDCG_OK);
      for (std::uint32_t t = 0; t < finger.touch_count; ++t) {
        on_sheet += finger.touches[t].object.index == 0;
        on_ball += finger.touches[t].object.index == 1;
        for (int i = 0; i < 3; ++i)
          sum_n[i] += finger.touches[t].force_n[i];
      }
    }
    both_on_sheet += on_sheet == 2;
    for (int i = 0; i < 3; ++i)
      REQUIRE(sum_n[i] == Approx(tick.output->wanted_force_n[i]).margin(1e-12));
  }
  CHECK(replay.is_same());
  CHECK(both_on_sheet > 500);
  CHECK(on_ball > 500);
}

TEST_CASE("a run without real time writes the same log every time") {
  const Folder folder;
  for (const char* const name : {"a.fdcglog", "b.fdcglog"}) {
    run(read(kScenes + "lift_cube.json"), 1, folder.file(name));
  }
  std::string a = bytes_of(folder.file("a.fdcglog")), b = bytes_of(folder.file("b.fdcglog"));
  const std::size_t at = b.find("b.fdcglog");
  REQUIRE(at != std::string::npos);
  REQUIRE(a.size() == b.size());
  // the header names the log itself, and has a checksum; the records follow
  SessionReader reader;
  REQUIRE(reader.open(folder.file("a.fdcglog")) == "");
  REQUIRE(reader.offset() < a.size());
  CHECK(a.substr(reader.offset()) == b.substr(reader.offset()));
}

TEST_CASE("a recording is played without real time to its end, with the same forces") {
  const Folder folder;
  run(read(kScenes + "lift_cube.json"), 3, folder.file("a.fdcglog"));
  HostConfig config = read(kScenes + "lift_cube.json");
  DeviceConfig& device = config.devices[0];
  device.source = DeviceSource::kRecorded;
  device.recording = folder.file("a.fdcglog");
  device.profile_text = R"({"fdcg_profile": 1})";  // its log could not be read back; there is none here
  FastRun fast;
  REQUIRE(fast.open(config) == "");
  REQUIRE(fast.run(0, true) == "");
  CHECK(fast.has_ended(0));
  CHECK(fast.status(0).counters.ticks == 3000);
  SessionReplay replay;
  REQUIRE(replay.open(folder.file("a.fdcglog"), "") == "");
  fdcg_pose last{};
  for (ReplayedTick tick; replay.next(&tick);)
    last = tick.output->bodies[0];
  CHECK(std::memcmp(&last, &fast.status(0).last.bodies[0], offsetof(fdcg_pose, scale)) == 0);
}

TEST_CASE("a recording with a silence of hours is not played without waiting") {
  const Folder folder;
  const HostConfig scene = read(kScenes + "lift_cube.json");
  const auto play = [&](const std::vector<std::uint64_t>& times_ns) {
    HostConfig config = scene;
    config.log_file = folder.file("a.fdcglog");
    LogRing ring(1 << 16);
    LogRing* const rings[] = {&ring};
    SessionLog log;
    REQUIRE(log.start(config, rings, 1) == "");
    for (const std::uint64_t time_ns : times_ns) {
      TickInput input;
      input.now_ns = input.reports[0].host_ns = time_ns;
      input.read = ReadStatus::kReport;
      input.report_count = 1;
      input.reports[0].bytes = 4;
      ring.put(input, TickOutput());
    }
    REQUIRE(log.stop() == "");
    config = scene;
    config.devices[0].source = DeviceSource::kRecorded;
    config.devices[0].recording = folder.file("a.fdcglog");
    FastRun fast;
    REQUIRE(fast.open(config) == "");
    const std::string problem = fast.run(0, false);
    CHECK(fast.has_failed_file() == !problem.empty());
    return problem;
  };
  constexpr std::uint64_t kSecond = 1'000'000'000, kHour = 3600 * kSecond;
  CHECK(play({kSecond, kSecond, 2 * kSecond}) == "");
  CHECK(play({kHour, kSecond, kHour + kSecond}) == "");  // times that go back are played at once
  const std::string gap = play({kSecond, kSecond + 1, 3 * kSecond + kHour});
  INFO(gap);
  CHECK(gap.find("a.fdcglog: report 2 of 'gripper' comes 3601.9") != std::string::npos);
  CHECK(gap.find("at most 3600 s") != std::string::npos);
  CHECK(gap.find("without --fast") != std::string::npos);
  CHECK(play({kSecond, 10'000'000'000'000'000'000u}).find("report 1 of 'gripper'") != std::string::npos);
  CHECK(play({kSecond, kHour, 0, ~std::uint64_t{0}}).find("report 3 of 'gripper'") != std::string::npos);
  std::vector<std::uint64_t> hours;
  for (std::uint64_t i = 0; i < 200; ++i)
    hours.push_back(i * kHour);
  CHECK(play(hours).find("are played: record it in parts") != std::string::npos);
}

TEST_CASE("devices that need real time are refused with a remedy") {
  HostConfig config = read(kScenes + "lift_cube.json");
  FastRun fast;
  REQUIRE(fast.open(config) == "");
  CHECK(fast.run(0, false).find("--for") != std::string::npos);
  config.devices[0].source = DeviceSource::kHid;
  CHECK(fast.open(config).find("without --fast") != std::string::npos);
}

TEST_CASE("a body without mass is refused") {
  std::string text = bytes_of(kScenes + "lift_cube.json");
  HostConfig config;
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string changed = text;
    changed.replace(changed.find(what), what.size(), by);
    return changed;
  };
  REQUIRE(parse_scene(replaced("\"mass_kg\": 0.1, ", ""), kScenes + "x.json", &config) == "");
  FastRun fast;
  CHECK(fast.open(config).find("mass_kg") != std::string::npos);
  REQUIRE(parse_scene(replaced("\"mass_kg\": 0.1,", "\"mass_kg\": 1e-6,"), kScenes + "x.json", &config) == "");
  CHECK(fast.open(config).find("too light") != std::string::npos);
}
