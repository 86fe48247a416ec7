// SPDX-License-Identifier: Apache-2.0
#include "session_replay.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "scene_json.hpp"
#include "tick_bytes.hpp"

namespace fdcg::dev {
namespace {

// Empty: the file is the graph that the session had. Otherwise why not; *is_there: a file of that name exists.
std::string compare_graph(const std::string& path, const SessionGraph& graph, bool* is_there) {
  std::error_code ignored;
  *is_there = std::filesystem::exists(path, ignored);
  if (!*is_there) return "'" + path + "' is not there";
  fdcg_graph view{};
  fdcg_error error{};
  if (fdcg_open_file(path.c_str(), FDCG_VERIFY_TRUSTED, &view, &error) != FDCG_OK) return error.message;
  const bool is_same = view.mapping_bytes == graph.bytes && fdcg_checksum(view.mapping, view.mapping_bytes) == graph.checksum;
  fdcg_close(&view);
  return is_same ? std::string()
                 : "'" + path + "' is not the file that the session had (" + std::to_string(graph.bytes) +
                       " bytes, and another checksum)";
}

// Where the graph is now. Empty, or why it cannot be had.
std::string find_graph(const std::string& log, const std::string& folder, const SessionGraph& graph, std::string* found) {
  const std::filesystem::path name = std::filesystem::path(graph.file).filename();
  std::vector<std::string> places;
  if (folder.empty()) {
    places = {graph.file, (std::filesystem::path(log).parent_path() / name).string()};
  } else {
    places = {(std::filesystem::path(folder) / name).string()};
  }
  std::string first_problem;
  bool has_seen_one = false;
  for (const std::string& place : places) {
    bool is_there = false;
    const std::string problem = compare_graph(place, graph, &is_there);
    *found = place;
    if (problem.empty()) return {};
    if (first_problem.empty() || (is_there && !has_seen_one)) first_problem = problem;
    has_seen_one = has_seen_one || is_there;
  }
  return first_problem + "; give the folder that has it (--graphs)";
}

}  // namespace

struct SessionReplay::Impl {
  SessionReader reader;
  HostConfig config;
  SceneGraphs graphs;
  std::vector<std::unique_ptr<DeviceScene>> scenes;
  std::vector<std::unique_ptr<DeviceState>> states;
  std::vector<std::uint64_t> next_tick;
  std::vector<DeviceReplay> devices;
  std::unique_ptr<TickInput> input = std::make_unique<TickInput>();
  TickOutput output;
  LoggedOutput replayed;
  std::vector<std::uint8_t> record, payload = std::vector<std::uint8_t>(kMostTickBytes);

  bool has_strays = false;

  std::string begin_devices();
  bool replay(const SessionRecord& record);
  void note_lost_tail();
};

std::string SessionReplay::Impl::begin_devices() {
  for (std::size_t i = 0; i < config.devices.size(); ++i) {
    scenes.push_back(std::make_unique<DeviceScene>());
    states.push_back(std::make_unique<DeviceState>());
    if (const std::string problem = build_device_scene(config, i, graphs, scenes.back().get()); !problem.empty())
      return problem;
    fdcg_error error{};
    if (!begin_device(scenes.back()->setup, states.back().get(), &error)) {
      return "device '" + config.devices[i].name + "': " + error.message;
    }
    DeviceReplay device;
    device.name = config.devices[i].name;
    devices.push_back(device);
  }
  next_tick.assign(config.devices.size(), 0);
  return {};
}

// False: nothing of the record was replayed.
bool SessionReplay::Impl::replay(const SessionRecord& from) {
  DeviceReplay& device = devices[from.device];
  if (from.tick != next_tick[from.device]) {
    device.has_gap = device.is_over = true;
    device.gap_at = next_tick[from.device];
    return false;
  }
  ++next_tick[from.device];
  LoggedOutput in_log;
  const std::size_t input_bytes = decode_tick_input(from.payload, from.payload_bytes, input.get());
  const std::size_t output_bytes =
      input_bytes == 0 ? 0 : decode_tick_output(from.payload + input_bytes, from.payload_bytes - input_bytes, &in_log);
  if (output_bytes == 0 || input_bytes + output_bytes != from.payload_bytes) {
    device.difference = "tick " + std::to_string(from.tick) + ": the record is no tick";
    device.is_over = true;
    return false;
  }
  device_tick(*states[from.device], *input, &output);
  ++device.ticks;
  replayed = logged(output);
  std::size_t bytes = encode_tick_input(*input, payload.data());
  bytes += encode_tick_output(replayed, payload.data() + bytes);
  record.resize(kRecordFrameBytes + bytes);
  encode_record(RecordKind::kTick, from.device, from.tick, payload.data(), bytes, record.data());
  const bool is_same = bytes == from.payload_bytes && std::memcmp(payload.data(), from.payload, bytes) == 0;
  if (is_same) return true;
  const std::string difference = first_difference(in_log, replayed);
  device.difference =
      "tick " + std::to_string(from.tick) + ": " + (difference.empty() ? "the same numbers, in other bytes" : difference);
  device.is_over = true;
  return true;
}

// Ticks that found the ring full after the last one that is there.
void SessionReplay::Impl::note_lost_tail() {
  const SessionEnd& end = reader.end();
  for (std::size_t i = 0; i < devices.size() && i < end.ticks.size(); ++i) {
    if (devices[i].is_over || next_tick[i] >= end.ticks[i]) continue;
    devices[i].has_gap = devices[i].is_over = true;
    devices[i].gap_at = next_tick[i];
  }
}

SessionReplay::SessionReplay() : impl_(std::make_unique<Impl>()) {}
SessionReplay::~SessionReplay() = default;

std::string SessionReplay::open(const std::string& path, const std::string& graph_folder) {
  if (std::string problem = impl_->reader.open(path); !problem.empty()) return problem;
  const SessionHeader& header = impl_->reader.header();
  if (std::string problem = parse_scene(header.scene, path + " (its scene)", &impl_->config); !problem.empty()) return problem;
  if (header.graphs.size() != impl_->config.objects.size()) {
    return path + ": the header has " + std::to_string(header.graphs.size()) + " graphs for " +
           std::to_string(impl_->config.objects.size()) + " objects: it is damaged";
  }
  for (std::size_t i = 0; i < header.graphs.size(); ++i) {
    ObjectConfig& object = impl_->config.objects[i];
    if (object.is_surface) continue;
    const std::string problem = find_graph(path, graph_folder, header.graphs[i], &object.file);
    if (!problem.empty()) return path + ": object '" + object.name + "': " + problem;
  }
  if (std::string problem = impl_->graphs.open(impl_->config); !problem.empty()) return problem;
  return impl_->begin_devices();
}

bool SessionReplay::next(ReplayedTick* tick) {
  SessionRecord record;
  while (impl_->reader.next(&record)) {
    if (record.device >= impl_->devices.size()) {
      impl_->has_strays = true;
      continue;
    }
    if (impl_->devices[record.device].is_over || !impl_->replay(record)) continue;
    *tick = {record.device, record.tick, impl_->input.get(), &impl_->replayed, impl_->states[record.device].get()};
    return true;
  }
  impl_->note_lost_tail();
  return false;
}

bool SessionReplay::is_same() const {
  const auto is_over = [](const DeviceReplay& device) { return device.is_over; };
  return impl_->reader.ending() == Ending::kEnded && !impl_->has_strays &&
         std::none_of(impl_->devices.begin(), impl_->devices.end(), is_over);
}

bool SessionReplay::has_strays() const {
  return impl_->has_strays;
}
const HostConfig& SessionReplay::config() const {
  return impl_->config;
}
const fdcg_graph& SessionReplay::graph(std::size_t object) const {
  return impl_->graphs.of_object(object);
}
const SessionReader& SessionReplay::reader() const {
  return impl_->reader;
}
const std::vector<DeviceReplay>& SessionReplay::devices() const {
  return impl_->devices;
}
const std::vector<std::uint8_t>& SessionReplay::record() const {
  return impl_->record;
}
std::string SessionReplay::header_bytes() const {
  return encode_session_header(impl_->reader.header());
}
std::string SessionReplay::end_bytes() const {
  return encode_end(impl_->reader.end());
}

}  // namespace fdcg::dev
