// SPDX-License-Identifier: Apache-2.0
#include "run_tap.hpp"

#include <cerrno>
#include <cstring>

namespace fdcg::servo {
namespace {

constexpr double kKeptS = 1;  // of ticks, while nobody takes them
constexpr double kFastestRateHz = 8000;
constexpr std::size_t kAtOnce = 64;

}  // namespace

RunTap::RunTap(const TapArguments& arguments, dev::SceneRun& host) : arguments_(arguments), host_(host) {}

RunTap::~RunTap() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(arguments_.record.c_str());  // nothing has run: it is empty
}

std::string RunTap::open() {
  for (int i = 0; i < host_.device_count(); ++i)
    names_.devices.push_back(host_.look(i).name);
  names_.objects = host_.object_names();
  names_.bodies = host_.body_names();
  newest_.resize(names_.devices.size());
  has_newest_.resize(names_.devices.size());
  some_.resize(kAtOnce);
  if (arguments_.listen >= 0) {
    if (std::string problem = server_.start(static_cast<std::uint16_t>(arguments_.listen)); !problem.empty()) return problem;
    is_listening_ = true;
  }
  if (!arguments_.record.empty()) {
    file_ = std::fopen(arguments_.record.c_str(), "wx");
    if (file_ == nullptr)
      return arguments_.record + ": " +
             (errno == EEXIST ? "is there already, and a recording overwrites nothing" : std::strerror(errno));
    is_recording_ = true;
  }
  // a recording wants every tick, a dashboard the newest
  host_.keep_snapshots(file_ != nullptr ? static_cast<std::size_t>(kKeptS * kFastestRateHz) : 4 * kAtOnce);
  return {};
}

int RunTap::port() const {
  return is_listening_ ? server_.port() : -1;
}

void RunTap::take(std::size_t device) {
  for (std::size_t count = kAtOnce; count == kAtOnce;) {
    count = host_.take_snapshots(static_cast<int>(device), some_.data(), kAtOnce);
    for (std::size_t i = 0; i < count && is_recording_ && failure_.empty(); ++i) {
      const std::string line = tick_json(names_, device, some_[i]) + "\n";
      if (std::fwrite(line.data(), 1, line.size(), file_) != line.size()) failure_ = std::strerror(errno);
    }
    if (count == 0) return;
    newest_[device] = some_[count - 1];
    has_newest_[device] = 1;
  }
}

void RunTap::look(double seconds) {
  for (std::size_t i = 0; i < names_.devices.size(); ++i)
    take(i);
  if (!is_listening_) return;
  std::vector<const fdcg_snapshot*> newest;
  for (std::size_t i = 0; i < names_.devices.size(); ++i)
    newest.push_back(has_newest_[i] != 0 ? &newest_[i] : nullptr);
  server_.publish_snapshot(snapshots_json(names_, newest, seconds, is_recording_));
}

void RunTap::say(double seconds, const std::string& text) {
  if (is_listening_) server_.publish_event(said_json(seconds, text));
}

void RunTap::take_commands(std::vector<std::string>* commands) {
  if (is_listening_) server_.take_commands(commands);
}

std::string RunTap::set_recording(bool is_on) {
  if (file_ == nullptr) return "there is no recording: start with --record FILE";
  is_recording_ = is_on;
  return is_on ? "recording into " + arguments_.record : "recording paused";
}

std::string RunTap::close() {
  std::uint64_t dropped = 0;
  for (std::size_t i = 0; i < names_.devices.size(); ++i) {
    take(i);  // the last ticks
    dropped += host_.dropped_snapshots(static_cast<int>(i));
  }
  if (file_ == nullptr) return {};
  if (std::fclose(file_) != 0 && failure_.empty()) failure_ = std::strerror(errno);
  file_ = nullptr;
  if (!failure_.empty()) return arguments_.record + ": not whole: " + failure_;
  return dropped == 0 ? ""
                      : arguments_.record + ": lacks " + std::to_string(dropped) + " ticks: this program had no time for them";
}

}  // namespace fdcg::servo
