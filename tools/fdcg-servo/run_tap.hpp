// SPDX-License-Identifier: Apache-2.0
// What a run shows beside its status: ticks into a file, a line each, and snapshots to dashboards, 60 a second. It takes what
// the host keeps of each tick; the servo threads never wait for it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "../dashboard/dashboard_server.hpp"
#include "fdcg/device_tools.hpp"
#include "snapshot_text.hpp"

namespace fdcg::servo {

struct TapArguments {
  std::string record;  // a file that is not there yet; empty: none
  double listen = -1;  // port on the loopback; -1: none

  [[nodiscard]] bool is_wanted() const { return listen >= 0 || !record.empty(); }
};

class RunTap {
 public:
  RunTap(const TapArguments& arguments, dev::SceneRun& host);
  ~RunTap();
  RunTap(const RunTap&) = delete;
  RunTap& operator=(const RunTap&) = delete;

  std::string open();              // before the host is started; empty, or the file or port and why not
  [[nodiscard]] int port() const;  // -1: nobody is listened to
  void look(double seconds);       // often: what is not taken in a second is dropped
  void say(double seconds, const std::string& text);
  void take_commands(std::vector<std::string>* commands);
  std::string set_recording(bool is_on);  // what came of it
  std::string close();                    // after the host has stopped; empty, or what is not whole
  static constexpr int kLookMs = 16;

 private:
  void take(std::size_t device);

  const TapArguments arguments_;
  dev::SceneRun& host_;
  tools::DashboardServer server_;
  std::FILE* file_ = nullptr;
  bool is_listening_ = false, is_recording_ = false;
  std::string failure_;  // of the file; empty: it is well
  SnapshotNames names_;
  std::vector<fdcg_snapshot> some_, newest_;
  std::vector<char> has_newest_;
};

}  // namespace fdcg::servo
