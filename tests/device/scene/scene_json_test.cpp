// SPDX-License-Identifier: Apache-2.0
// Scenes: reading, refusals with their messages, and writing with reading back. Over 400 lines: a
// case for each kind of thing that a scene may hold.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "catch.hpp"
#include "profile/profile_json.hpp"
#include "scene/scene_build.hpp"
#include "scene/scene_json.hpp"

using namespace fdcg::dev;
using nlohmann::json;

namespace {

// Every key that there is, none at its default.
constexpr const char* kFull = R"({
  "fdcg_scene": 1, "$schema": "servo-scene.schema.json", "notes": "all of it",
  "objects": [
    {"name": "cube", "file": "cube.fdcg", "notes": "x",
     "pose": {"rotation_xyzw": [0, 0, 0.6, 0.8], "translation_m": [0.1, -0.2, 0.3], "scale": 2.5},
     "stiffness_n_per_m": 800.5, "damping_n_s_per_m": 1.25, "mu_static": 0.7, "mu_dynamic": 0.1, "edge_friction": "paper", "shading": true,
     "motion": {"kind": "spin", "axis": [0, 3, 4], "rate_hz": 0.1}},
    {"name": "ball", "file": "/somewhere/ball.fdcg", "motion": {"kind": "swing", "axis": [1, 0, 0], "rate_hz": 2, "amplitude_m": 0.05}},
    {"name": "tool", "file": "cube.fdcg", "motion": {"kind": "driven"}},
    {"name": "floor", "file": "sub/floor.fdcg", "motion": {"kind": "fixed"}}],
  "devices": [
    {"name": "left", "source": "simulated", "notes": "x", "force_limit_n": 2,
     "mapping": {"scale": 3, "rotation_xyzw": [0.5, 0.5, 0.5, 0.5], "offset_m": [1, 2, 3]},
     "contacts": [{"offset_m": [0, 0, 0]}, {"offset_m": [0.01, 0, -0.02]}],
     "simulation": {"rate_hz": 2000, "mass_kg": 0.2, "damping_n_s_per_m": 0.6, "hand_stiffness_n_per_m": 150,
                    "hand_damping_n_s_per_m": 3, "quantum_m": 2e-5, "start_m": [0, 0, 0.01], "amplitude_m": [0.01, 0.02, 0.03],
                    "frequency_hz": [0.1, 0.2, 0.3], "real_time": false, "seed": 7, "force_n": 5, "watchdog_s": 0.03,
                    "float_axes": true,
                    "faults": [{"kind": "not-finite", "at_s": 1.5, "for_s": 0.1, "delay_s": 0.03, "reports": 4}]}},
    {"name": "right", "profile": "fdcg-reference", "serial": "A1", "path": "/dev/hidraw3"}],
  "loop": {"servo_priority": 50, "writer_priority": 40, "cpu": 1, "lock_memory": false, "backend": "libusb"},
  "log": {"file": "logs/a.fdcglog", "limit_mb": 12.5},
  "limits": {"force_n": 3}
})";

// The keys of a grasp, none at its default.
constexpr const char* kGrasp = R"({
  "fdcg_scene": 1, "gravity_m_per_s2": [1, 2, -3],
  "ground": {"normal": [0, 0.6, 0.8], "offset_m": -0.1, "stiffness_n_per_m": 4000, "mu_static": 0.9, "mu_dynamic": 0.8},
  "objects": [
    {"name": "cube", "file": "cube.fdcg", "motion": {"kind": "body", "density_kg_per_m3": 700, "points": 9,
     "linear_damping_per_s": 0.1, "angular_damping_per_s": 0.2, "notes": "x"}},
    {"name": "cone", "surface": {"kind": "cone", "radius_m": 0.1, "top_radius_m": 0.05, "length_m": 0.3},
     "motion": {"kind": "body", "mass_kg": 2}},
    {"name": "egg", "surface": {"kind": "ellipsoid", "half_m": [0.1, 0.2, 0.3], "hollow": true}},
    {"name": "ring", "surface": {"kind": "torus", "radius_m": 0.1, "tube_radius_m": 0.02}},
    {"name": "sheet", "file": "sheet.fdcg", "motion": {"kind": "soft", "radius_m": 0.01, "stiffness_n_per_m": 6, "tension_n_per_m": 7,
     "damping_n_s_per_m": 8, "depth_m": 0.01}}],
  "devices": [
    {"name": "left", "source": "simulated",
     "contacts": [{"offset_m": [0.03, 0, 0], "closed_m": [0.01, 0.001, 0], "pad_radius_m": 0.004}, {"offset_m": [-0.03, 0, 0]}],
     "grip": {"button": 3, "seconds": 0.25}, "dead_man": {"button": 31}, "turn": {"button": 31, "seconds": 2, "rotation_xyzw": [0, 0, -0.6, -0.8]},
     "simulation": {"script": [{"at_s": 0.5, "place_m": [0.1, 0, 0.2]}, {"at_s": 1, "place_m": [0, 0, 0.3], "buttons": [0, 7]}]}}]
})";

std::string refusal(const json& scene) {
  HostConfig config;
  return parse_scene(scene.dump(), "dir/s.json", &config);
}

// A scene of one object and one simulated device, with one thing changed.
json small() {
  return json::parse(R"({"fdcg_scene": 1, "objects": [{"name": "cube", "file": "cube.fdcg"}],
                        "devices": [{"name": "hand", "source": "simulated"}]})");
}

}  // namespace

TEST_CASE("every key of a scene is read") {
  HostConfig config;
  REQUIRE(parse_scene(kFull, "dir/s.json", &config) == "");
  CHECK(config.scene_file == "dir/s.json");
  REQUIRE(config.objects.size() == 4);
  const ObjectConfig& cube = config.objects[0];
  CHECK(cube.name == "cube");
  CHECK(cube.file == "dir/cube.fdcg");
  CHECK(config.objects[1].file == "/somewhere/ball.fdcg");
  CHECK(cube.pose.rotation_xyzw[2] == 0.6);
  CHECK(cube.pose.translation_m[1] == -0.2);
  CHECK(cube.pose.scale == 2.5);
  CHECK(cube.params.stiffness_n_per_m == 800.5);
  CHECK(cube.params.damping_n_s_per_m == 1.25);
  CHECK(cube.params.mu_static == 0.7);
  CHECK(cube.params.mu_dynamic == 0.1);
  CHECK(cube.params.edge_friction == FDCG_EDGE_PAPER);
  CHECK(cube.params.friction_flags == FDCG_FRICTION_SHADING);
  CHECK(config.objects[1].params.friction_flags == 0);
  CHECK(cube.motion.kind == MotionKind::kSpin);
  CHECK(cube.motion.axis[1] == 0.6);
  CHECK(cube.motion.axis[2] == 0.8);
  CHECK(cube.motion.rate_hz == 0.1);
  CHECK(config.objects[1].motion.kind == MotionKind::kSwing);
  CHECK(config.objects[1].motion.amplitude_m == 0.05);
  CHECK(config.objects[2].motion.kind == MotionKind::kDriven);
  CHECK(config.objects[3].motion.kind == MotionKind::kFixed);
  REQUIRE(config.devices.size() == 2);
  const DeviceConfig& left = config.devices[0];
  CHECK(left.source == DeviceSource::kSimulated);
  CHECK(left.most_force_n == 2);
  CHECK(left.mapping.scale == 3);
  const double cyclic[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0};  // x -> y -> z -> x
  CHECK(std::equal(cyclic, cyclic + 9, left.mapping.rotation));
  CHECK(left.mapping.offset_m[2] == 3);
  CHECK(left.contact_count == 2);
  CHECK(left.contacts_m[1][2] == -0.02);
  const SimulationConfig& s = left.simulation;
  CHECK(s.rate_hz == 2000);
  CHECK(left.profile.rate_hz == 2000);
  CHECK(s.mass_kg == 0.2);
  CHECK(s.damping_n_s_per_m == 0.6);
  CHECK(s.hand_stiffness_n_per_m == 150);
  CHECK(s.hand_damping_n_s_per_m == 3);
  CHECK(s.quantum_m == 2e-5);
  CHECK(s.start_m[2] == 0.01);
  CHECK(s.amplitude_m[1] == 0.02);
  CHECK(s.frequency_hz[2] == 0.3);
  CHECK(!s.is_real_time);
  CHECK(s.seed == 7);
  CHECK(s.force_n == 5);
  CHECK(s.watchdog_s == 0.03);
  CHECK(s.has_float_axes);
  REQUIRE(s.faults.size() == 1);
  CHECK(s.faults[0].kind == SimulatedFaultKind::kNotFinite);
  CHECK(s.faults[0].at_s == 1.5);
  CHECK(s.faults[0].for_s == 0.1);
  CHECK(s.faults[0].delay_s == 0.03);
  CHECK(s.faults[0].reports == 4);
  const DeviceConfig& right = config.devices[1];
  CHECK(right.source == DeviceSource::kHid);
  CHECK(right.most_force_n == 3);
  CHECK(right.serial == "A1");
  CHECK(right.path == "/dev/hidraw3");
  CHECK(right.profile.axis_count == 3);
  CHECK(config.loop.servo_priority == 50);
  CHECK(config.loop.writer_priority == 40);
  CHECK(config.loop.cpu == 1);
  CHECK(!config.loop.lock_memory);
  CHECK(config.loop.backend == HidBackend::kLibusb);
  CHECK(config.log_file == "dir/logs/a.fdcglog");
  CHECK(config.log_megabytes == 12.5);
}

TEST_CASE("scene: optional fields have their defaults") {
  HostConfig config;
  REQUIRE(parse_scene(small().dump(), "s.json", &config) == "");
  const fdcg_params params = fdcg_make_params();
  CHECK(std::memcmp(&config.objects[0].params, &params, sizeof params) == 0);
  const fdcg_pose pose = fdcg_make_identity_pose();
  CHECK(std::memcmp(&config.objects[0].pose, &pose, sizeof pose) == 0);
  CHECK(config.objects[0].file == "cube.fdcg");
  CHECK(config.devices[0].contact_count == 1);
  CHECK(config.devices[0].most_force_n == 0);
  CHECK(config.loop.servo_priority == LoopConfig().servo_priority);
  CHECK(config.log_file.empty());
}

TEST_CASE("a scene that is written reads back bit for bit, whatever its numbers") {
  HostConfig config;
  REQUIRE(parse_scene(kFull, "dir/s.json", &config) == "");
  std::mt19937_64 random(21);
  std::normal_distribution<double> some;
  for (int round = 0; round < 200; ++round) {
    for (ObjectConfig& object : config.objects) {
      double square = 0;
      for (double& x : object.pose.rotation_xyzw) {
        x = some(random);
        square += x * x;
      }
      for (double& x : object.pose.rotation_xyzw)
        x /= std::sqrt(square);
      for (double& x : object.pose.translation_m)
        x = some(random);
      object.params.mu_static = 1 + std::fabs(some(random));
      object.params.damping_n_s_per_m = std::fabs(some(random));
    }
    for (DeviceConfig& device : config.devices)
      for (double& x : device.mapping.offset_m)
        x = some(random) * 1e-3;
    const std::string text = write_scene(config);
    REQUIRE(text.find('\n') == std::string::npos);
    HostConfig back;
    REQUIRE(parse_scene(text, "elsewhere/log", &back) == "");
    // Files are as `config` names them, seen from the reader's folder.
    for (std::size_t i = 0; i < back.objects.size(); ++i) {
      const ObjectConfig &a = config.objects[i], &b = back.objects[i];
      REQUIRE(std::memcmp(&a.pose, &b.pose, sizeof a.pose) == 0);
      REQUIRE(std::memcmp(&a.params, &b.params, sizeof a.params) == 0);
      REQUIRE(std::memcmp(a.motion.axis, b.motion.axis, sizeof a.motion.axis) == 0);
      back.objects[i].file = a.file;
    }
    for (std::size_t i = 0; i < back.devices.size(); ++i) {
      const DeviceConfig &a = config.devices[i], &b = back.devices[i];
      REQUIRE(std::memcmp(&a.mapping, &b.mapping, sizeof a.mapping) == 0);
      REQUIRE(std::memcmp(a.contacts_m, b.contacts_m, sizeof a.contacts_m) == 0);
      REQUIRE(a.most_force_n == b.most_force_n);
      REQUIRE(a.profile.limits.force_n == b.profile.limits.force_n);
      REQUIRE(a.profile.input.field_count == b.profile.input.field_count);
    }
    back.log_file = config.log_file;
    REQUIRE(write_scene(back) == text);
  }
}

TEST_CASE("bodies, surfaces, soft sheets, grips and scripts are read, and written the same") {
  HostConfig config;
  REQUIRE(parse_scene(kGrasp, "dir/s.json", &config) == "");
  CHECK(config.gravity_m_per_s2[2] == -3);
  CHECK(config.ground.is_there);
  CHECK(config.ground.normal[1] == 0.6);
  CHECK(config.ground.offset_m == -0.1);
  CHECK(config.ground.params.stiffness_n_per_m == 4000);
  CHECK(config.ground.params.mu_static == 0.9);
  const BodyConfig& body = config.objects[0].motion.body;
  CHECK(config.objects[0].motion.kind == MotionKind::kBody);
  CHECK(!is_moved(config.objects[0].motion));
  CHECK(body.density_kg_per_m3 == 700);
  CHECK(body.points == 9);
  CHECK(body.linear_damping_per_s == 0.1);
  CHECK(body.angular_damping_per_s == 0.2);
  CHECK(config.objects[1].is_surface);
  CHECK(config.objects[1].file.empty());
  CHECK(config.objects[1].surface.kind == FDCG_SURFACE_CONE);
  CHECK(config.objects[1].surface.top_radius_m == 0.05);
  CHECK(config.objects[1].motion.body.mass_kg == 2);
  CHECK(config.objects[2].surface.half_m[1] == 0.2);
  CHECK(config.objects[2].surface.is_hollow == 1);
  CHECK(config.objects[3].surface.tube_radius_m == 0.02);
  CHECK(config.objects[4].motion.soft.tension_n_per_m == 7);
  CHECK(config.objects[4].motion.soft.depth_m == 0.01);
  CHECK(config.objects[4].motion.soft.radius_m == 0.01);
  const DeviceConfig& left = config.devices[0];
  CHECK(left.grip.close.mask == 8);
  CHECK(left.grip.close.seconds == 0.25);
  CHECK(left.grip.turn.mask == 0x80000000u);
  CHECK(left.grip.turn_xyzw[2] == 0.6);  // the shorter way round
  CHECK(left.grip.turn_xyzw[3] == 0.8);
  CHECK(left.grip.closed_m[0][1] == 0.001);
  CHECK(left.grip.closed_m[1][0] == -0.03);
  CHECK(left.pads_m[0] == 0.004);
  CHECK(left.pads_m[1] == 0);
  REQUIRE(left.simulation.script.size() == 2);
  CHECK(left.simulation.script[0].place_m[2] == 0.2);
  CHECK(left.simulation.script[1].buttons == 0x81);
  CHECK(left.profile.limits.workspace_max_m[0] == Approx(0.2));
  CHECK(left.profile.limits.velocity_m_per_s == Approx(2 + 1.5 * 0.2 + 1.5 * 0.2));
  const std::string text = write_scene(config);
  HostConfig back;
  REQUIRE(parse_scene(text, "log", &back) == "");
  CHECK(write_scene(back) == text);
}

TEST_CASE("scene: errors of a grasp are reported") {
  struct Wrong {
    const char *pointer, *value;
    std::vector<const char*> words;
  };
  const std::vector<Wrong> cases = {
      {"/objects/0/surface", R"({"kind": "sphere", "radius_m": 1})", {"objects[0].file stands beside surface"}},
      {"/objects/1/surface/radius_m", "1e-30", {"objects[1].surface.radius_m is 1e-30, allowed 0 and 1e-9 to 1e9"}},
      {"/objects/1/surface/half_m", "[1, 1, 1]", {"objects[1].surface.half_m[0] is 1, allowed 0; a surface of this kind"}},
      {"/objects/1/surface",
       R"({"kind": "torus", "radius_m": 0.1})",
       {"objects[1].surface.tube_radius_m is missing, so it is 0, allowed 1e-9 to"}},
      {"/objects/1/surface",
       R"({"kind": "plane", "hollow": true})",
       {"objects[1].surface.hollow is 1, allowed 0: turn the plane"}},
      {"/objects/2/surface/half_m",
       "[0.1, 0.2, 1e-6]",
       {"objects[2].surface.half_m[2] is 1e-6, allowed 2e-5 to 1e9 (at least"}},
      {"/objects/1/motion", R"({"kind": "soft"})", {"objects[1].motion is soft", "give a file"}},
      {"/objects/0/motion/mass_kg", "1", {"objects[0].motion.mass_kg stands beside density_kg_per_m3"}},
      {"/objects/0/motion/points", "0", {"points is 0", "1 to 256"}},
      {"/objects/0/motion/axis", "[1, 0, 0]", {"'axis'", "of a body"}},
      {"/ground/normal", "[0, 0, 2]", {"ground.normal has length 2"}},
      {"/devices/0/turn/rotation_xyzw", "[0, 0, 0, 0]", {"turn.rotation_xyzw has length 0"}},
      {"/devices/0/grip/button", "32", {"grip.button is 32", "0 to 31"}},
      {"/devices/0/contacts/0/pad_radius_m", "-0.001", {"contacts[0].pad_radius_m is -0.001", "0 to 1"}},
      {"/devices/0/contacts/0/pad_radius_m", "1e-10", {"pad_radius_m is 1e-10", "0 (a point) or a number from 1e-09 to 1 m"}},
      {"/devices/0/grip", "", {"contacts[0].closed_m has no \"grip\""}},
      {"/devices/0/simulation/start_m", "[0, 0, 0]", {"simulation.start_m stands beside script"}},
      {"/devices/0/simulation/script/1/at_s", "0.5", {"script[1].at_s is 0.5", "times ascend"}},
      {"/devices/0/simulation/script/1/buttons", "[1.5]", {"script[1].buttons has 1.5"}},
  };
  for (const Wrong& wrong : cases) {
    json scene = json::parse(kGrasp);
    if (*wrong.value == 0) {
      scene["devices"][0].erase("grip");
    } else {
      scene[json::json_pointer(wrong.pointer)] = json::parse(wrong.value);
    }
    const std::string message = refusal(scene);
    CAPTURE(wrong.pointer, message);
    CHECK(message.rfind("dir/s.json: ", 0) == 0);
    for (const char* const word : wrong.words)
      CHECK(message.find(word) != std::string::npos);
  }
}

TEST_CASE("scene: an error is one line with file, field, value and limit") {
  struct Wrong {
    const char* pointer;  // where
    const char* value;    // JSON; empty: taken away
    std::vector<const char*> words;
  };
  const std::vector<Wrong> cases = {
      {"/fdcg_scene", "", {"fdcg_scene is missing"}},
      {"/fdcg_scene", "2", {"fdcg_scene is 2", "1"}},
      {"/object", "[]", {"'object'", "did you mean 'objects'?"}},
      {"/objects", "", {"objects is missing"}},
      {"/objects", "{}", {"objects is an object", "a list of 0 to 1000"}},
      {"/objects/0/name", "", {"objects[0].name is missing"}},
      {"/objects/0/name", "\"\"", {"objects[0].name"}},
      {"/objects/0/file", "3", {"objects[0].file is 3"}},
      {"/objects/0/stifness_n_per_m", "3", {"objects[0] has 'stifness_n_per_m'", "did you mean 'stiffness_n_per_m'?"}},
      {"/objects/0/stiffness_n_per_m", "-1", {"objects[0].stiffness_n_per_m is -1", "from 0 to 1000000 N/m"}},
      {"/objects/0/mu_static", "0.1", {"objects[0].mu_static is 0.1, below mu_dynamic, 0.4 (the default)"}},
      {"/objects/0/mu_dynamic", "0.9", {"objects[0].mu_static is 0.6 (the default), below mu_dynamic, 0.9"}},
      {"/objects/0/edge_friction", "\"glue\"", {"objects[0].edge_friction is \"glue\"", "wedge", "paper"}},
      {"/objects/0/shading", "1", {"objects[0].shading is 1"}},
      {"/objects/0",
       R"({"name": "ball", "shading": true, "surface": {"kind": "sphere", "radius_m": 0.1}})",
       {"objects[0].shading is for meshes"}},
      {"/objects/0",
       R"({"name": "sheet", "file": "s.fdcg", "shading": true, "motion": {"kind": "soft"}})",
       {"objects[0].shading is true of a soft object"}},
      {"/objects/0/pose", R"({"rotation_xyzw": [0, 0, 0, 2]})", {"objects[0].pose.rotation_xyzw has length 2", "[0, 0, 0, 1]"}},
      {"/objects/0/pose", R"({"translation_m": [0, 0]})", {"objects[0].pose.translation_m is a list of 2", "3"}},
      {"/objects/0/pose", R"({"scale": 0})", {"objects[0].pose.scale is 0", "1e-09"}},
      {"/objects/0/motion", R"({"kind": "spin"})", {"objects[0].motion.axis is missing"}},
      {"/objects/0/motion", R"({"kind": "spin", "axis": [0, 0, 0], "rate_hz": 1})", {"axis has length 0"}},
      {"/objects/0/motion", R"({"kind": "spin", "axis": [1, 0, 0], "rate_hz": 1000})", {"rate_hz is 1000", "100 Hz"}},
      {"/objects/0/motion", R"({"kind": "fixed", "rate_hz": 1})", {"'rate_hz'", "neither spin nor swing"}},
      {"/objects/1", R"({"name": "cube", "file": "x"})", {"objects[1].name is 'cube', which another one has too"}},
      {"/devices", "[]", {"devices is a list of 0", "1 to 16"}},
      {"/devices/1", R"({"name": "hand", "source": "simulated"})", {"devices[1].name is 'hand', which another one has too"}},
      {"/devices/0/source", "\"usb\"", {"devices[0].source is \"usb\"", "hid, simulated, recorded"}},
      {"/devices/0/source", "\"hid\"", {"devices[0].profile is missing"}},
      {"/devices/0/profile", "\"fdcg-reference\"", {"devices[0] has 'profile'", "of a simulated device"}},
      {"/devices/0/contacts", "[]", {"devices[0].contacts is a list of 0", "1 to 8"}},
      {"/devices/0/force_limit_n", "0", {"devices[0].force_limit_n is 0", "above 0 and up to 1000 N"}},
      {"/devices/0/mapping",
       R"({"rotation_matrix": [1, 0, 0, 0, 1, 0, 0, 0, -1]})",
       {"rotation_matrix is off a rotation by 2"}},
      {"/devices/0/mapping",
       R"({"rotation_matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1], "rotation_xyzw": [0, 0, 0, 1]})",
       {"rotation_matrix stands beside rotation_xyzw"}},
      {"/devices/0/simulation", R"({"rate_hz": 0})", {"devices[0].simulation.rate_hz is 0", "1 to 20000 Hz"}},
      {"/devices/0/simulation", R"({"faults": [{"kind": "not-finite", "at_s": 1}]})", {"faults[0].kind", "float_axes"}},
      {"/devices/0/simulation", R"({"faults": [{"kind": "fire", "at_s": 1}]})", {"faults[0].kind is \"fire\"", "unplug"}},
      {"/devices/0",
       R"({"name": "hand", "profile": "fdcg-referense"})",
       {"devices[0].profile is 'fdcg-referense'", "did you mean 'fdcg-reference'?"}},
      {"/devices/0", R"({"name": "hand", "profile": "missing.json"})", {"devices[0].profile is refused", "dir/missing.json"}},
      {"/devices/0", R"({"name": "hand", "profile": {"fdcg_profile": 1}})", {"devices[0].profile is refused", "is missing"}},
      {"/devices/0", R"({"name": "hand", "source": "recorded"})", {"devices[0].recording is missing"}},
      {"/devices/0",
       R"({"name": "hand", "source": "recorded", "recording": "no.fdcglog"})",
       {"devices[0].recording is refused", "dir/no.fdcglog", "No such file"}},
      {"/loop", R"({"servo_priority": 100})", {"loop.servo_priority is 100", "0 to 99"}},
      {"/loop", R"({"servo_priority": 2.5})", {"loop.servo_priority is 2.5"}},
      {"/loop", R"({"backend": "usb"})", {"loop.backend is \"usb\"", "any, hidraw, libusb"}},
      {"/log", "{}", {"log.file is missing"}},
      {"/log", R"({"file": "a", "limit_mb": -1})", {"log.limit_mb is -1", "MB"}},
      {"/limits", R"({"force_n": 0})", {"limits.force_n is 0", "above 0"}},
  };
  for (const Wrong& wrong : cases) {
    json scene = small();
    const json::json_pointer place(wrong.pointer);
    if (std::strlen(wrong.value) == 0) {
      scene = scene.patch({{{"op", "remove"}, {"path", wrong.pointer}}});
    } else {
      scene[place] = json::parse(wrong.value);
    }
    const std::string problem = refusal(scene);
    INFO(wrong.pointer << " " << wrong.value << ": " << problem);
    CHECK(problem.find("dir/s.json: ") == 0);
    CHECK(problem.find('\n') == std::string::npos);
    for (const char* const word : wrong.words)
      CHECK(problem.find(word) != std::string::npos);
  }
  CHECK(refusal(small()).empty());
}

TEST_CASE("no more objects may move than a tick has poses for") {
  json scene = small();
  for (int i = 0; i < kMaxDriven + 1; ++i)
    scene["objects"][static_cast<std::size_t>(i)] = {
        {"name", "o" + std::to_string(i)}, {"file", "cube.fdcg"}, {"motion", {{"kind", "driven"}}}};
  CHECK(refusal(scene).find("objects[16].motion is one more than the 16") != std::string::npos);
  scene["objects"].erase(16);
  CHECK(refusal(scene).empty());
}

TEST_CASE("a device without limits is accepted, and a warning says that it gives no force") {
  json profile = json::parse(std::string(find_builtin_profile("fdcg-reference")->text));
  profile.erase("limits");
  json scene = small();
  scene["devices"][0] = {{"name", "hand"}, {"profile", profile}};
  HostConfig config;
  std::vector<std::string> warnings;
  REQUIRE(parse_scene(scene.dump(), "s.json", &config, &warnings).empty());
  REQUIRE(!warnings.empty());
  CHECK(warnings[0].find("device 'hand': ") == 0);
  CHECK(std::any_of(warnings.begin(), warnings.end(),
                    [](const std::string& warning) { return warning.find("limits") != std::string::npos; }));
}

TEST_CASE("scene: a device rate in the range of silence gives one warning with the minimum rate") {
  json profile = json::parse(std::string(find_builtin_profile("fdcg-reference")->text));
  for (const double rate_hz : {1.0, 10.0, 100.0, 100.5, 1000.0}) {
    profile["rate_hz"] = rate_hz;
    const json simulation = {{"rate_hz", rate_hz}};
    const json devices = {{{"name", "hand"}, {"source", "simulated"}, {"simulation", simulation}},
                          {{"name", "hand"}, {"profile", profile}},
                          {{"name", "hand"}, {"source", "recorded"}, {"recording", "a"}, {"simulation", simulation}},
                          {{"name", "hand"}, {"source", "recorded"}, {"recording", "a"}, {"profile", profile}}};
    for (const json& device : devices) {
      json scene = small();
      scene["devices"][0] = device;
      HostConfig config;
      std::vector<std::string> warnings;
      INFO(device.dump());
      REQUIRE(parse_scene(scene.dump(), "s.json", &config, &warnings) == "");
      REQUIRE(warnings.size() == (rate_hz <= 100 ? 1 : 0));
      if (warnings.empty()) continue;
      CHECK(warnings[0].rfind("device 'hand': ", 0) == 0);
      CHECK(warnings[0].find("rate_hz is " + std::to_string(static_cast<int>(rate_hz)) + ", ") != std::string::npos);
      CHECK(warnings[0].find("disarms after 10 ms") != std::string::npos);
      CHECK(warnings[0].find("above 100 Hz") != std::string::npos);
    }
  }
}

TEST_CASE("scene: any change is accepted, or refused in one line that names the file") {
  std::mt19937_64 random(22);
  const json full = json::parse(kFull);
  const std::vector<json> values = {nullptr,
                                    true,
                                    0,
                                    -1,
                                    1e300,
                                    0.5,
                                    99999999999,
                                    "",
                                    "x",
                                    "0x10",
                                    json::array(),
                                    json::object(),
                                    json::array({1, 2, 3}),
                                    json::array({json::array()}),
                                    "a\nb",
                                    "\u0000"};
  const json flat = full.flatten();
  std::vector<std::string> places;
  for (const auto& item : flat.items())
    places.push_back(item.key());
  int accepted = 0, refused = 0;
  for (int round = 0; round < 10000; ++round) {
    json scene = full;
    for (int change = 0; change < 1 + static_cast<int>(random() % 3); ++change) {
      json::json_pointer place(places[random() % places.size()]);
      for (std::uint64_t up = random() % 4; up > 0 && !place.parent_pointer().empty(); --up)
        place = place.parent_pointer();
      const std::uint64_t what = random() % 4;
      if (!scene.contains(place)) continue;
      json& parent = scene.at(place.parent_pointer());
      if (what == 0 && parent.is_object()) {
        parent.erase(place.back());
      } else if (what == 1 && parent.is_object()) {
        parent[place.back() + "x"] = values[random() % values.size()];
      } else {
        scene[place] = values[random() % values.size()];
      }
    }
    HostConfig config;
    const std::string problem = parse_scene(scene.dump(), "s.json", &config, nullptr, {false});
    if (problem.empty()) {
      ++accepted;
      HostConfig back;
      REQUIRE(parse_scene(write_scene(config), "s.json", &back, nullptr, {false}) == "");
    } else {
      ++refused;
      INFO(problem);
      REQUIRE(problem.find("s.json: ") == 0);
      REQUIRE(problem.find('\n') == std::string::npos);
      REQUIRE(problem.size() < 2000);
    }
  }
  CHECK(accepted > 250);
  CHECK(refused > 2500);
}

TEST_CASE("a motion begins at the pose and stays on its path") {
  HostConfig config;
  REQUIRE(parse_scene(kFull, "s.json", &config) == "");
  for (const ObjectConfig& object : config.objects) {
    const fdcg_pose start = pose_at(object, 0);
    for (int i = 0; i < 4; ++i)
      CHECK(start.rotation_xyzw[i] == Approx(object.pose.rotation_xyzw[i]).margin(1e-15));
    for (int i = 0; i < 3; ++i)
      CHECK(start.translation_m[i] == object.pose.translation_m[i]);
  }
  const ObjectConfig &spin = config.objects[0], &swing = config.objects[1], &driven = config.objects[2];
  const fdcg_pose turned = pose_at(spin, 10);  // one turn
  const double sign = turned.rotation_xyzw[3] * spin.pose.rotation_xyzw[3] < 0 ? -1 : 1;
  for (int i = 0; i < 4; ++i)
    CHECK(sign * turned.rotation_xyzw[i] == Approx(spin.pose.rotation_xyzw[i]).margin(1e-12));
  const fdcg_pose quarter = pose_at(spin, 2.5);  // about (0, 0.6, 0.8), after a turn about z
  const double half = std::sqrt(0.5);
  CHECK(quarter.rotation_xyzw[3] == Approx(half * 0.8 - half * (0.8 * 0.6)).margin(1e-12));
  CHECK(pose_at(swing, 0.125).translation_m[0] == Approx(swing.pose.translation_m[0] + 0.05));
  CHECK(pose_at(swing, 100000.125).translation_m[0] == Approx(swing.pose.translation_m[0] + 0.05));
  CHECK(pose_at(driven, 5).translation_m[0] == driven.pose.translation_m[0]);
}
