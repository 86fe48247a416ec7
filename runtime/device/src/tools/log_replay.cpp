// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "fdcg/device_tools.hpp"
#include "recording/session_csv.hpp"
#include "recording/session_replay.hpp"
#include "recording/viewed_session.hpp"

namespace fdcg::dev {

struct LogReplay::Impl {
  SessionReplay replay;
  ReplayedTick tick;
  std::uint64_t first_ns = 0;  // of the first tick
  std::uintmax_t bytes = 0;    // of the log; 0: not known, as of a pipe
};
LogReplay::LogReplay() : impl_(std::make_unique<Impl>()) {}
LogReplay::~LogReplay() = default;

std::string LogReplay::open(const std::string& path, const std::string& graph_folder) {
  std::error_code unknown;
  impl_->bytes = std::filesystem::file_size(path, unknown);
  if (unknown) impl_->bytes = 0;
  return impl_->replay.open(path, graph_folder);
}

double LogReplay::fraction() const {
  if (impl_->bytes == 0) return 0;
  return std::min(1.0, static_cast<double>(impl_->replay.reader().offset()) / static_cast<double>(impl_->bytes));
}

bool LogReplay::next() {
  if (!impl_->replay.next(&impl_->tick)) return false;
  if (impl_->first_ns == 0) impl_->first_ns = impl_->tick.input->now_ns;
  return true;
}

std::string LogReplay::csv_header() const {
  return session_csv_header(impl_->replay.config());
}
std::string LogReplay::csv_row() const {
  return impl_->tick.output->has_sample ? session_csv_row(impl_->tick, impl_->first_ns) : "";
}
std::string LogReplay::touches_header() const {
  return touches_csv_header();
}
std::string LogReplay::touches_rows() const {
  return impl_->tick.output->has_sample ? touches_csv_rows(impl_->replay, impl_->tick, impl_->first_ns) : "";
}
ViewedScene LogReplay::scene() const {
  return viewed_scene(impl_->replay.config());
}
ViewedTick LogReplay::view() const {
  return viewed_tick(impl_->replay, impl_->tick, impl_->first_ns);
}
std::string LogReplay::header_bytes() const {
  return impl_->replay.header_bytes();
}
std::string LogReplay::record_bytes() const {
  const std::vector<std::uint8_t>& record = impl_->replay.record();
  return {record.begin(), record.end()};
}
std::string LogReplay::end_bytes() const {
  return impl_->replay.reader().ending() == Ending::kEnded ? impl_->replay.end_bytes() : "";
}

const std::vector<DeviceReplay>& LogReplay::devices() const {
  return impl_->replay.devices();
}
bool LogReplay::is_same() const {
  return impl_->replay.is_same();
}
bool LogReplay::has_strays() const {
  return impl_->replay.has_strays();
}
bool LogReplay::ends_at_limit() const {
  const SessionReader& reader = impl_->replay.reader();
  return reader.ending() == Ending::kEnded && reader.end().reason == EndReason::kLimit;
}
std::string LogReplay::damage() const {
  const SessionReader& reader = impl_->replay.reader();
  return reader.ending() == Ending::kEnded ? "" : reader.damage();
}
std::string LogReplay::program() const {
  return impl_->replay.reader().header().program;
}
std::vector<std::pair<std::string, std::string>> LogReplay::graph_files() const {
  std::vector<std::pair<std::string, std::string>> files;
  for (const ObjectConfig& object : impl_->replay.config().objects)
    if (!object.is_surface) files.emplace_back(object.name, object.file);
  return files;
}

}  // namespace fdcg::dev
