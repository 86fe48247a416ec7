// SPDX-License-Identifier: Apache-2.0
#include "recording/session_replay.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "scene/scene_json.hpp"
#include "tick/tick_bytes.hpp"

namespace fdcg::dev {
namespace {

constexpr SceneOptions kOfLog = {.shares_soft = false};  // a log says it, but for one of the time before

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
  // A device's tick: what the log has of it, and what became of it.
  struct Seat {
    DeviceState state;
    TickInput input;
    TickOutput output;
    LoggedOutput in_log, replayed;
    std::vector<std::uint8_t> in_log_bytes;
    std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kMostTickBytes);  // the same made anew
    std::size_t byte_count = 0;
    std::uint64_t next_tick = 0;
    std::size_t group = 0;
  };
  // A scene and the devices that feel it.
  struct Group {
    DeviceRange devices;
    DeviceScene scene;
    std::size_t taken = 0;  // of its next tick: the devices whose record is there
    bool is_over = false;
  };
  SessionReader reader;
  HostConfig config;
  SceneGraphs graphs;
  std::vector<std::unique_ptr<Group>> groups;
  std::vector<std::unique_ptr<Seat>> seats;
  std::vector<DeviceReplay> devices;
  std::vector<std::uint8_t> record;
  // Of the last tick that was replayed: the devices that next() has not given yet.
  std::size_t next_given = 0, end_given = 0;
  bool has_strays = false;

  std::string begin_devices();
  bool take(const SessionRecord& record);
  void step(Group& group);
  void end_group(Group& group);
  void give(ReplayedTick* tick);
  void compare(std::size_t index);
  void note_lost_tail();
};

std::string SessionReplay::Impl::begin_devices() {
  for (const DeviceRange& range : device_ranges(config)) {
    groups.push_back(std::make_unique<Group>());
    Group& group = *groups.back();
    group.devices = range;
    if (const std::string problem = build_device_scene(config, range, graphs, &group.scene); !problem.empty()) return problem;
    for (std::size_t i = 0; i < range.count; ++i) {
      seats.push_back(std::make_unique<Seat>());
      seats.back()->group = groups.size() - 1;
      const std::string& name = config.devices[range.first + i].name;
      fdcg_error error{};
      if (!begin_device(group.scene.setups[i], &seats.back()->state, &error)) return "device '" + name + "': " + error.message;
      devices.emplace_back();
      devices.back().name = name;
    }
  }
  return {};
}

void SessionReplay::Impl::end_group(Group& group) {
  group.is_over = true;
  for (std::size_t i = 0; i < group.devices.count; ++i)
    devices[group.devices.first + i].is_over = true;
}

// True: the group's next tick is whole. A group's records stand one after another, in the scene's order.
bool SessionReplay::Impl::take(const SessionRecord& from) {
  Seat& seat = *seats[from.device];
  Group& group = *groups[seat.group];
  DeviceReplay& device = devices[from.device];
  if (group.is_over) return false;
  if (from.tick != seat.next_tick || from.device != group.devices.first + group.taken) {
    const DeviceRange& all = group.devices;
    for (std::size_t i = all.first; i < all.first + all.count; ++i) {
      devices[i].has_gap = true;
      devices[i].gap_at = devices[i].ticks;
    }
    end_group(group);
    return false;
  }
  ++seat.next_tick;
  const std::size_t input_bytes = decode_tick_input(from.payload, from.payload_bytes, &seat.input);
  const std::size_t output_bytes =
      input_bytes == 0 ? 0 : decode_tick_output(from.payload + input_bytes, from.payload_bytes - input_bytes, &seat.in_log);
  if (output_bytes == 0 || input_bytes + output_bytes != from.payload_bytes) {
    device.difference = "tick " + std::to_string(from.tick) + ": the record is no tick";
    end_group(group);
    return false;
  }
  seat.in_log_bytes.assign(from.payload, from.payload + from.payload_bytes);
  return ++group.taken == group.devices.count;
}

void SessionReplay::Impl::step(Group& group) {
  group.taken = 0;
  next_given = group.devices.first;
  end_given = group.devices.first + group.devices.count;
  Member members[kMaxDevices];
  for (std::size_t i = 0; i < group.devices.count; ++i) {
    Seat& seat = *seats[group.devices.first + i];
    members[i] = {&seat.state, &seat.input, &seat.output};
  }
  group_tick(members, static_cast<int>(group.devices.count));
  for (std::size_t i = next_given; i < end_given; ++i)
    compare(i);
  const std::size_t other =
      static_cast<std::size_t>(std::find_if(devices.begin() + static_cast<std::ptrdiff_t>(next_given),
                                            devices.begin() + static_cast<std::ptrdiff_t>(end_given),
                                            [](const DeviceReplay& device) { return !device.difference.empty(); }) -
                               devices.begin());
  if (other == end_given) return;
  end_group(group);
  for (std::size_t i = next_given; i < end_given; ++i)
    if (devices[i].difference.empty()) devices[i].ended_by = devices[other].name;
}

void SessionReplay::Impl::compare(std::size_t index) {
  Seat& seat = *seats[index];
  DeviceReplay& device = devices[index];
  ++device.ticks;
  seat.replayed = logged(seat.output);
  seat.byte_count = encode_tick_input(seat.input, seat.bytes.data());
  seat.byte_count += encode_tick_output(seat.replayed, seat.bytes.data() + seat.byte_count);
  const std::vector<std::uint8_t>& in_log = seat.in_log_bytes;
  if (seat.byte_count == in_log.size() && std::memcmp(seat.bytes.data(), in_log.data(), in_log.size()) == 0) return;
  const std::string difference = first_difference(seat.in_log, seat.replayed);
  device.difference = "tick " + std::to_string(seat.next_tick - 1) + ": " +
                      (difference.empty() ? "the same numbers, in other bytes" : difference);
}

void SessionReplay::Impl::give(ReplayedTick* tick) {
  const std::size_t index = next_given++;
  const Seat& seat = *seats[index];
  record.resize(kRecordFrameBytes + seat.byte_count);
  const auto device = static_cast<std::uint16_t>(index);
  encode_record(RecordKind::kTick, device, seat.next_tick - 1, seat.bytes.data(), seat.byte_count, record.data());
  *tick = {index, seat.next_tick - 1, &seat.input, &seat.replayed, &seat.state};
}

// Ticks that found the ring full after the last one that is there. Where the log ends at its limit, it may do so in the middle
// of a group's tick, which is then not there.
void SessionReplay::Impl::note_lost_tail() {
  SessionEnd end = reader.end();
  end.ticks.resize(devices.size());  // a log that was not closed says nothing
  for (const auto& group : groups) {
    const auto first = end.ticks.begin() + static_cast<std::ptrdiff_t>(group->devices.first);
    const auto last = first + static_cast<std::ptrdiff_t>(group->devices.count);
    const std::uint64_t whole =
        end.reason == EndReason::kLimit ? *std::min_element(first, last) : *std::max_element(first, last);
    for (std::size_t i = group->devices.first; i < group->devices.first + group->devices.count; ++i) {
      if (devices[i].is_over || devices[i].ticks >= whole) continue;
      devices[i].has_gap = devices[i].is_over = true;
      devices[i].gap_at = devices[i].ticks;
    }
  }
}

SessionReplay::SessionReplay() : impl_(std::make_unique<Impl>()) {}
SessionReplay::~SessionReplay() = default;

std::string SessionReplay::open(const std::string& path, const std::string& graph_folder) {
  if (std::string problem = impl_->reader.open(path); !problem.empty()) return problem;
  const SessionHeader& header = impl_->reader.header();
  if (std::string problem = parse_scene(header.scene, path + " (its scene)", &impl_->config, nullptr, kOfLog);
      !problem.empty()) {
    return problem;
  }
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
  while (impl_->next_given == impl_->end_given) {
    if (!impl_->reader.next(&record)) {
      impl_->note_lost_tail();
      return false;
    }
    if (record.device >= impl_->devices.size()) {
      impl_->has_strays = true;
    } else if (impl_->take(record)) {
      impl_->step(*impl_->groups[impl_->seats[record.device]->group]);
    }
  }
  impl_->give(tick);
  return true;
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
