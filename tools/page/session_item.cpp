// SPDX-License-Identifier: Apache-2.0
// A session's log in a page: its scene, and what a replay says of every moment.
#include <map>

#include "fdcg/device_tools.hpp"
#include "fdcg/fdcg.h"
#include "packed_array.hpp"
#include "page_writer.hpp"
#include "session_frames.hpp"

namespace fdcg::page {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMotions[] = {"fixed", "moved", "body", "soft"};
constexpr const char* kSurfaces[] = {"plane", "sphere", "cylinder", "capsule", "box", "cone", "torus", "ellipsoid"};

template <class T>
PackedArray array_of(const std::vector<T>& values, std::size_t stride) {
  const auto bytes = std::as_bytes(std::span<const T>(values));
  const std::vector<Run> runs{{bytes.size(), static_cast<std::uint32_t>(stride)}};
  return {described(bytes.size(), runs), packed(bytes, runs)};
}

Json surface_json(const fdcg_surface& surface) {
  return {{"kind", kSurfaces[surface.kind & 7]},
          {"hollow", surface.is_hollow != 0},
          {"radius", surface.radius_m},
          {"top_radius", surface.top_radius_m},
          {"tube_radius", surface.tube_radius_m},
          {"length", surface.length_m},
          {"half", {surface.half_m[0], surface.half_m[1], surface.half_m[2]}}};
}

Json pose_json(const fdcg_pose& pose) {
  const double *t = pose.translation_m, *q = pose.rotation_xyzw;
  return {t[0], t[1], t[2], q[0], q[1], q[2], q[3]};
}

// What the replay has to say of the log, where not all of it is well.
Json remarks_json(const dev::LogReplay& replay) {
  Json remarks = Json::array();
  for (const dev::DeviceReplay& device : replay.devices()) {
    const std::string at = device.name + ", after " + std::to_string(device.ticks) + " ticks: ";
    if (!device.difference.empty()) remarks.push_back(at + "the replay differs from the log (" + device.difference + ")");
    if (device.has_gap) remarks.push_back(at + "the log lacks ticks, and what comes after cannot be replayed");
  }
  if (replay.ends_at_limit()) remarks.push_back("the log ends at its limit of bytes; the session went on");
  if (replay.has_strays()) remarks.push_back("there are ticks of devices that the scene has not");
  if (const std::string damage = replay.damage(); !damage.empty()) remarks.push_back(damage);
  return remarks;
}

Json faults_json() {
  Json names = Json::array();
  for (int fault = 0; fault < dev::kFaults; ++fault) {
    const auto code = static_cast<dev::Fault>(fault);
    names.push_back({{"name", dev::fault_name(code)}, {"text", dev::fault_text(code)}});
  }
  return names;
}

}  // namespace

bool is_session_log(const std::string& path) {
  return dev::is_session_log(path);
}

Json PageWriter::session_objects(const dev::ViewedScene& scene, Json* graphs) {
  std::map<std::string, std::size_t> known;  // by file
  Json objects = Json::array();
  for (const dev::ViewedObject& object : scene.objects) {
    Json about{{"name", object.name},
               {"motion", kMotions[static_cast<int>(object.motion)]},
               {"pose", pose_json(object.pose)},
               {"scale", object.pose.scale},
               {"mu_static", object.mu_static}};
    if (object.file.empty()) {
      about["surface"] = surface_json(object.surface);
    } else if (const auto [place, is_new] = known.try_emplace(object.file, known.size()); true) {
      about["graph"] = place->second;
      if (is_new) graphs->push_back(add_graph_file(object.file));
    }
    objects.push_back(about);
  }
  return objects;
}

// A graph that has been opened and verified already.
Json PageWriter::add_graph_file(const std::string& path) {
  fdcg_graph graph{};
  fdcg_error error{};
  if (fdcg_open_file(path.c_str(), FDCG_VERIFY_TRUSTED, &graph, &error) != FDCG_OK) return nullptr;
  Json about = add_array(graph_array({static_cast<const std::byte*>(graph.mapping), graph.mapping_bytes}));
  fdcg_close(&graph);
  return about;
}

Json PageWriter::add_world(const dev::ViewedScene& scene, const WorldFrames& frames) {
  Json world{{"ticks_per_frame", frames.ticks_per_frame()}, {"time", add_array(array_of(frames.time_s(), sizeof(double)))}};
  world["devices"] = Json::array();
  for (std::size_t i = 0; i < frames.devices().size(); ++i) {
    const DeviceFrames& device = frames.devices()[i];
    const dev::ViewedDevice& about = scene.devices[frames.first_device() + i];
    const std::size_t numbers = kDeviceNumbers + kContactNumbers * device.contacts;
    world["devices"].push_back({{"name", about.name},
                                {"pads", about.pads_m},
                                {"numbers", add_array(array_of(device.numbers, sizeof(float) * numbers))},
                                {"words", add_array(array_of(device.words, sizeof(std::uint32_t) * (1 + device.contacts)))}});
  }
  world["moving"] = frames.moving();
  world["poses"] = add_array(array_of(frames.poses(), sizeof(float) * 7 * frames.moving().size()));
  world["soft"] = Json::array();
  for (const SoftFrames& soft : frames.soft()) {
    world["soft"].push_back({{"object", soft.object},
                             {"corners", soft.corners},
                             {"time", add_array(array_of(soft.time_s, sizeof(double)))},
                             {"moved", add_array(array_of(soft.moved_m, sizeof(float) * 3 * soft.corners))}});
  }
  return world;
}

std::string PageWriter::add_session(const std::string& path, const std::string& graph_folder) {
  dev::LogReplay replay;
  if (std::string problem = replay.open(path, graph_folder); !problem.empty()) return problem;
  const dev::ViewedScene scene = replay.scene();
  std::vector<WorldFrames> worlds;
  for (std::size_t i = 0; i < scene.world_count; ++i)
    worlds.emplace_back(scene, i);
  while (replay.next()) {
    const dev::ViewedTick view = replay.view();
    worlds[scene.devices[view.device].world].add(view);
  }
  Json session{{"same", replay.is_same()}, {"program", replay.program()}, {"remarks", remarks_json(replay)}};
  session["faults"] = faults_json();
  session["gravity"] = scene.gravity_m_per_s2;
  if (scene.has_ground) session["ground"] = {{"normal", scene.ground_normal}, {"offset", scene.ground_offset_m}};
  Json graphs = Json::array();
  session["objects"] = session_objects(scene, &graphs);
  session["graphs"] = graphs;
  session["worlds"] = Json::array();
  for (const WorldFrames& world : worlds)
    session["worlds"].push_back(add_world(scene, world));
  add_item({{"name", path}, {"session", session}});
  return {};
}

}  // namespace fdcg::page
