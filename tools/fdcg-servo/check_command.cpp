// SPDX-License-Identifier: Apache-2.0
// fdcg-servo check: scenes and device profiles, as far as they can be judged without a device.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json_reader.hpp"
#include "host/make_transport.hpp"
#include "profile/profile_json.hpp"
#include "recording/session_log.hpp"
#include "scene/scene_build.hpp"
#include "scene/scene_json.hpp"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

struct Judgement {
  std::string what;     // "scene: 2 objects, 1 device"
  std::string problem;  // one line that begins with the file; empty: none
  std::vector<std::string> warnings;
  bool is_unreadable = false;  // no JSON at all
};

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// What the run would refuse of devices that feel one scene before it starts.
std::string problem_of(const dev::HostConfig& config, const dev::DeviceRange& devices, const dev::SceneGraphs& graphs) {
  dev::DeviceScene scene;
  if (std::string problem = dev::build_device_scene(config, devices, graphs, &scene); !problem.empty()) return problem;
  for (std::size_t i = 0; i < devices.count; ++i) {
    const dev::DeviceConfig& device = config.devices[devices.first + i];
    const auto state = std::make_unique<dev::DeviceState>();
    fdcg_error error{};
    if (!dev::begin_device(scene.setups[i], state.get(), &error)) return "device '" + device.name + "': " + error.message;
    if (device.source != dev::DeviceSource::kRecorded) continue;
    const std::string problem = dev::make_transport(device, config.loop)->open();
    if (!problem.empty()) return "device '" + device.name + "': " + problem;
  }
  return {};
}

// Names, values and files, and that the runtime takes the whole.
Judgement judge_scene(const std::string& file, const std::string& text) {
  Judgement judgement;
  dev::HostConfig config;
  judgement.problem = dev::parse_scene(text, file, &config, &judgement.warnings);
  if (!judgement.problem.empty()) return judgement;
  judgement.what = "scene: " + counted(config.objects.size(), "object") + ", " + counted(config.devices.size(), "device") +
                   (config.is_shared ? " that share it" : "");
  dev::SceneGraphs graphs;
  judgement.problem = graphs.open(config);
  for (const dev::DeviceRange& devices : dev::device_ranges(config))
    if (judgement.problem.empty()) judgement.problem = problem_of(config, devices, graphs);
  if (judgement.problem.empty()) judgement.problem = dev::log_problem(config);
  if (!judgement.problem.empty() && judgement.problem.rfind(file, 0) != 0) judgement.problem.insert(0, file + ": ");
  return judgement;
}

Judgement judge_profile(const std::string& file, const std::string& text) {
  Judgement judgement;
  dev::Profile profile;
  judgement.problem = dev::parse_profile(text, file, &profile, &judgement.warnings);
  judgement.what = "device profile: " + std::string(profile.name);
  return judgement;
}

// By the key that says what it is. What has neither is no JSON at all (its scene says where), or is told of both.
Judgement judge(const std::string& file, const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_discarded() && !json.contains("fdcg_scene")) {
    if (json.contains("fdcg_profile")) return judge_profile(file, text);
    return {"", file + ": neither a scene nor a device profile: \"fdcg_scene\": 1 or \"fdcg_profile\": 1 must say which", {}};
  }
  Judgement judgement = judge_scene(file, text);
  judgement.is_unreadable = json.is_discarded();
  return judgement;
}

int check_files(const std::vector<std::string>& files) {
  int code = kClean;
  for (const std::string& file : files) {
    std::string text;
    if (const std::string problem = dev::read_text_file(file, dev::kMostJsonBytes, &text); !problem.empty()) {
      code = fail(kFile, problem);
      continue;
    }
    const Judgement judgement = judge(file, text);
    if (judgement.is_unreadable) {
      code = fail(kFile, judgement.problem);
      continue;
    }
    if (!judgement.problem.empty()) {
      std::printf("%s\n", judgement.problem.c_str());
      code = std::max<int>(code, kFindings);
      continue;
    }
    std::printf("%s: %s: ok\n", file.c_str(), judgement.what.c_str());
    for (const std::string& warning : judgement.warnings)
      std::printf("%s: warning: %s\n", file.c_str(), warning.c_str());
  }
  return code;
}

}  // namespace

Command add_check(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("check", "Judge scenes and device profiles without touching a device");
  command->footer(R"(
Examples:
  fdcg-servo check scene.json
  fdcg-servo check my-device.json scenes/*.json

A file's first problem is told with its field, value and limit; the graphs of a scene are opened. Warnings do not fail.

Exit codes: 0 every file is fine; 1 one is not; 2 wrong usage; 3 one cannot be read or is no JSON.)");
  const auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("files", *files, "Scenes and device profiles")->required()->type_name("FILE...");
  return {command, [files] { return check_files(*files); }};
}

}  // namespace fdcg::servo
