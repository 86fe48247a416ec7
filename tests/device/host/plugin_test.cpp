// SPDX-License-Identifier: Apache-2.0
// Devices of others: a plugin in C (mass_plugin.c) and a program's own table, with the host's judge, gate and log.
#include <dlfcn.h>

#include <filesystem>

#include "catch.hpp"
#include "fdcg/device.h"
#include "fdcg/device_tools.hpp"
#include "hosted.hpp"
#include "scene/scene_json.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

namespace {

std::string scene_with(const std::string& plugin, const std::string& settings, const std::string& log = "") {
  return R"({"fdcg_scene": 1, "loop": {"servo_priority": 0, "writer_priority": 0, "lock_memory": false},)" +
         (log.empty() ? std::string() : R"("log": {"file": ")" + log + "\"},") + R"("objects": [{"name": "cube", "file": ")" +
         cube_file() + R"(", "stiffness_n_per_m": 500,
            "pose": {"translation_m": [0, 0, -0.5]}}],
            "devices": [{"name": "mass", "source": "plugin", )" +
         (plugin.empty() ? std::string() : R"("plugin": ")" + plugin + "\", ") + R"("settings": )" + settings +
         R"(, "rate_hz": 1000,
            "limits": {"force_n": 5, "effort": [5, 5, 5], "slew_n_per_s": 2000, "velocity_m_per_s": 5, "device_watchdog_s": 0.02,
                       "workspace_m": {"min": [-0.1, -0.1, -0.1], "max": [0.1, 0.1, 0.1]}}}]})";
}

struct OpenHost {
  fdcg_host* host = nullptr;
  fdcg_host_message message{};
  fdcg_device_status last{};

  explicit OpenHost(const std::string& scene) {
    const fdcg_status opened = fdcg_host_open_text(scene.data(), scene.size(), "scene", &host, &message);
    INFO(message.text);
    REQUIRE(opened == FDCG_OK);
  }
  ~OpenHost() { fdcg_host_close(host); }
  OpenHost(const OpenHost&) = delete;
  OpenHost& operator=(const OpenHost&) = delete;

  void start() { REQUIRE(fdcg_host_start(host, &message) == FDCG_OK); }
  const fdcg_device_status& status() {
    last.struct_bytes = sizeof last;
    REQUIRE(fdcg_host_get_status(host, 0, &last) == FDCG_OK);
    return last;
  }
  std::string problem() { return status().problem.text; }
  // A busy machine may be late, which disarms: then once more.
  bool feels() {
    return within_ms(20'000, [&] {
      const fdcg_device_status& now = status();
      if (now.is_open == 1 && now.phase == FDCG_DISARMED && now.ticks > 20) fdcg_host_arm(host, 0);
      return now.phase == FDCG_ARMED && now.force_n[2] > 0.5;
    });
  }
};

}  // namespace

TEST_CASE("plugin: a device in one C file is felt, and its session replays bit for bit") {
  const std::string log =
      (std::filesystem::temp_directory_path() / ("fdcg_plugin_" + std::to_string(getpid()) + ".fdcglog")).string();
  {
    OpenHost open(scene_with(FDCG_MASS_PLUGIN, "{}", log));
    fdcg_host_allow_plugins(open.host);
    open.start();
    CHECK(open.feels());
    CHECK(open.last.state == FDCG_FACE);
    CHECK(open.status().round_trip_p50_s > 0);
    CHECK(fdcg_host_stop(open.host, &open.message) == FDCG_OK);
  }
  LogReplay replay;
  REQUIRE(replay.open(log, "") == "");
  while (replay.next()) {
  }
  CHECK(replay.is_same());
  // it can be played to another scene, and the log of that replays too
  const std::string played = log + ".played";
  std::string scene = scene_with("", "{}");
  const std::size_t device = scene.find("{\"name\": \"mass\"");
  scene = scene.substr(0, device) + R"({"name": "mass", "source": "recorded", "recording": ")" + log + "\"}]}";
  const std::string file = log + ".json";
  std::ofstream(file) << scene;
  Scene config;
  std::vector<std::string> warnings;
  REQUIRE(config.read(file, &warnings) == "");
  config.set_log_file(played);
  FastSceneRun run;
  CHECK(run.run(std::move(config)) == "");
  LogReplay again;
  REQUIRE(again.open(played, "") == "");
  while (again.next()) {
  }
  CHECK(again.is_same());
  for (const std::string& one : {log, played, file})
    std::filesystem::remove(one);
}

TEST_CASE("plugin: it is code, and not loaded unless that is allowed") {
  OpenHost open(scene_with(FDCG_MASS_PLUGIN, "{}"));
  open.start();
  REQUIRE(within_ms(2000, [&] { return !open.problem().empty(); }));
  CHECK(open.problem().find("a plugin is code; --plugins") != std::string::npos);
  CHECK(open.status().opened == 0);
}

TEST_CASE("plugin: what keeps it from opening is told") {
  const auto problem_of = [](const std::string& file, const std::string& settings) {
    OpenHost open(scene_with(file, settings));
    fdcg_host_allow_plugins(open.host);
    open.start();
    REQUIRE(within_ms(2000, [&] { return !open.problem().empty(); }));
    return open.problem();
  };
  CHECK(problem_of(FDCG_MASS_PLUGIN, R"({"is": "absent"})").find("the mass is absent; take") == 0);
  CHECK(problem_of("/no/such.so", "{}").find("cannot be loaded: /no/such.so") != std::string::npos);
  CHECK(problem_of("libm.so.6", "{}").find("cannot be loaded") != std::string::npos);  // from the scene's folder
  CHECK(problem_of("", "{}").find("fdcg_host_set_transport") != std::string::npos);
}

TEST_CASE("plugin: the gate's faults are those of every device") {
  for (const auto& [settings, faults] :
       {std::pair<const char*, std::vector<Fault>>{R"({"it": "lies"})", {Fault::kOtherHost}},
        std::pair<const char*, std::vector<Fault>>{R"({"it": "loses"})", {Fault::kReadFailed, Fault::kSilence}}}) {
    OpenHost open(scene_with(FDCG_MASS_PLUGIN, settings));
    fdcg_host_allow_plugins(open.host);
    open.start();
    const bool is_seen = within_ms(20'000, [&] {
      const fdcg_device_status& now = open.status();
      if (now.is_open == 1 && now.phase == FDCG_DISARMED && now.ticks > 20) fdcg_host_arm(open.host, 0);
      return std::any_of(faults.begin(), faults.end(),
                         [&](Fault fault) { return now.fault == static_cast<std::uint32_t>(fault); });
    });
    INFO(settings);
    CHECK(is_seen);
    CHECK(fdcg_host_stop(open.host, &open.message) == FDCG_OK);
  }
}

TEST_CASE("plugin: a program hands over a table of its own") {
  void* const file = dlopen(FDCG_MASS_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  REQUIRE(file != nullptr);
  const auto create = reinterpret_cast<fdcg_transport_create_function>(dlsym(file, FDCG_TRANSPORT_CREATE));
  fdcg_transport table{};
  table.struct_bytes = sizeof table;
  fdcg_host_message why{};
  REQUIRE(create(FDCG_TRANSPORT_ABI, "{}", &table, &why) == FDCG_TRANSPORT_OK);
  OpenHost open(scene_with("", "{}"));
  fdcg_transport broken = table;
  broken.read = nullptr;
  CHECK(fdcg_host_set_transport(open.host, 0, &broken, &why) == FDCG_E_ARGUMENT);
  CHECK(std::string(why.text).find("lacks open, close, read or write") != std::string::npos);
  CHECK(fdcg_host_set_transport(open.host, 1, &table, &why) == FDCG_E_ARGUMENT);
  CHECK(fdcg_host_set_transport(open.host, 0, nullptr, &why) == FDCG_E_ARGUMENT);
  CHECK(fdcg_host_set_transport(nullptr, 0, &table, &why) == FDCG_E_ARGUMENT);
  REQUIRE(fdcg_host_set_transport(open.host, 0, &table, &why) == FDCG_OK);
  open.start();
  CHECK(open.feels());
  CHECK(fdcg_host_set_transport(open.host, 0, &table, &why) == FDCG_E_ARGUMENT);
  CHECK(fdcg_host_stop(open.host, &open.message) == FDCG_OK);
  OpenHost named(scene_with(FDCG_MASS_PLUGIN, "{}"));
  CHECK(fdcg_host_set_transport(named.host, 0, &table, &why) == FDCG_E_ARGUMENT);
}

TEST_CASE("plugin: its scene is written and read back, and --fast refuses it") {
  HostConfig config, back;
  const std::string text = scene_with("mass.so", R"({"port": "ttyACM0", "n": [1, 2]})");
  REQUIRE(parse_scene(text, "scene", &config) == "");
  const std::string written = write_scene(config);
  REQUIRE(parse_scene(written, "scene", &back) == "");
  CHECK(write_scene(back) == written);
  CHECK(back.devices[0].plugin == "./mass.so");
  CHECK(back.devices[0].plugin_settings == R"({"n":[1,2],"port":"ttyACM0"})");
  CHECK(back.devices[0].profile.limits.force_n == 5);
}
