// SPDX-License-Identifier: Apache-2.0
#include "host_files.hpp"

#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "rig.hpp"

namespace fdcg::vm {
namespace {

using nlohmann::json;

constexpr char kReferenceProfile[] = "/etc/fdcg-reference.json";  // the built-in one's own file
constexpr char kCube[] = "/etc/cube.fdcg";                        // from 0 to 1 m on each axis
constexpr char kScene[] = "/tmp/scene.json", kTwice[] = "/tmp/twice.json", kLog[] = "/tmp/session.fdcglog",
               kSmallLog[] = "/full/session.fdcglog";

json read_json(const char* file) {
  std::ifstream in(file);
  json read = json::parse(in, nullptr, false);
  if (read.is_discarded()) throw std::runtime_error(std::string(file) + " is no JSON");
  return read;
}

void write_json(const char* file, const json& content) {
  std::ofstream out(file);
  out << content.dump(2) << std::flush;
  if (!out) throw std::runtime_error(std::string(file) + " cannot be written");
}

// The device's positions as floats in metres, in the same places.
void make_axes_floats(json& profile) {
  for (json& field : profile.at("input").at("fields")) {
    if (field.at("role") != "axis") continue;
    field["type"] = "f32";
    field["scale"] = 1;
  }
}

}  // namespace

void write_host_files(const RigOptions& options) {
  json profile = read_json(kReferenceProfile);
  profile["name"] = "virtual device";
  profile["rate_hz"] = options.rate_hz;
  if (options.has_float_axes) make_axes_floats(profile);
  // the cube's upper face is the device's z = 0
  const json cube = {
      {"name", "cube"},           {"file", kGraph},   {"pose", {{"scale", 0.2}, {"translation_m", {-0.1, -0.1, -0.2}}}},
      {"stiffness_n_per_m", 500}, {"mu_static", 0.5}, {"mu_dynamic", 0.4}};
  if (!options.has_watchdog) profile.at("limits").erase("device_watchdog_s");
  std::filesystem::copy_file(kCube, kGraph, std::filesystem::copy_options::overwrite_existing);
  json scene = {{"fdcg_scene", 1},
                {"objects", {cube}},
                {"devices", {{{"name", "virtual"}, {"source", "hid"}, {"profile", profile}, {"force_limit_n", 3}}}},
                {"loop", {{"servo_priority", 80}, {"writer_priority", 70}, {"backend", options.backend}}}};
  write_json(kScene, scene);
  scene.at("devices").push_back(scene.at("devices").at(0));
  scene.at("devices").at(1)["name"] = "the same";
  write_json(kTwice, scene);
  if (!options.is_log_small) return;
  const std::string size = "size=" + std::to_string(kSmallDiskKb) + "k";
  if (mount("small", kSmallDisk, "tmpfs", 0, size.c_str()))
    throw std::runtime_error(std::string("no small disk: ") + std::strerror(errno));
}

std::vector<std::string> command_with_node_twice() {
  return {"/bin/fdcg-servo", "run", kTwice, "--status", "json", "--status-every", std::to_string(kStatusPeriodS), "--no-log"};
}

std::vector<std::string> host_command(const RigOptions& options) {
  std::vector<std::string> command = {
      "/bin/fdcg-servo", "run", kScene, "--status", "json", "--status-every", std::to_string(kStatusPeriodS)};
  if (!options.has_log) {
    command.push_back("--no-log");
    return command;
  }
  command.insert(command.end(), {"--log", options.is_log_small ? kSmallLog : kLog});
  return command;
}

}  // namespace fdcg::vm
