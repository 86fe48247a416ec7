// SPDX-License-Identifier: Apache-2.0
// Replay of a session: the scene is rebuilt from its log, every recorded input is processed by device_tick, every output
// compared bit for bit. Devices with separate scenes end separately: at the first difference, or before a lost tick. Those that
// share a scene end together.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/host_config.hpp"
#include "fdcg/device_status.hpp"
#include "scene/scene_build.hpp"
#include "session/session_reader.hpp"
#include "tick/device_tick.hpp"

namespace fdcg::dev {

struct ReplayedTick {
  std::size_t device = 0;
  std::uint64_t tick = 0;
  const TickInput* input = nullptr;
  const LoggedOutput* output = nullptr;  // the replay's
  const DeviceState* state = nullptr;    // after the tick
};

class SessionReplay {
 public:
  SessionReplay();
  ~SessionReplay();
  // graph_folder: where the graphs are now; empty: where they were, or beside the log. Empty: fine. Otherwise a file and what
  // is wrong with it.
  std::string open(const std::string& path, const std::string& graph_folder);
  const HostConfig& config() const;
  const fdcg_graph& graph(std::size_t object) const;
  const SessionReader& reader() const;
  // Replays the log's next tick; ticks of devices that have ended are skipped. False: the log has ended.
  bool next(ReplayedTick* tick);
  const std::vector<DeviceReplay>& devices() const;
  // Every tick was there and the same, and the log was closed in order (at its limit, too).
  bool is_same() const;
  bool has_strays() const;  // records of devices that the scene has not: they were passed by
  // The record of the last that next() gave, its bytes made anew from the replay; and the whole header, and the end.
  const std::vector<std::uint8_t>& record() const;
  std::string header_bytes() const;
  std::string end_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fdcg::dev
