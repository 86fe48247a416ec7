// SPDX-License-Identifier: Apache-2.0
// The reports of one device of a session, at their recorded intervals or, without real time, as fast as they are read. Writes
// are discarded.
#include "recording/recorded_transport.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>

#include "scene/scene_json.hpp"
#include "session/session_reader.hpp"
#include "shared/text.hpp"

namespace fdcg::dev {
namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000, kMillisecond_ns = 1'000'000;
// Without real time each millisecond is a tick's work: of a silence, and of a whole recording.
constexpr std::uint64_t kLongestGap_ns = 3600 * kSecond_ns, kLongest_ns = 7 * 24 * 3600 * kSecond_ns;

std::uint64_t now_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * kSecond_ns + static_cast<std::uint64_t>(time.tv_nsec);
}

void sleep_until(std::uint64_t when_ns) {
  const timespec time{static_cast<time_t>(when_ns / kSecond_ns), static_cast<long>(when_ns % kSecond_ns)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) != 0) {
  }
}

class RecordedTransport final : public Transport {
 public:
  explicit RecordedTransport(const DeviceConfig& config)
      : path_(config.recording), name_(config.name), is_real_time_(config.is_recording_in_real_time) {}

  std::string open() override;
  void close() override { reports_.clear(); }
  bool is_over() const override { return is_over_; }
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override;
  std::uint64_t clock_ns() const override { return is_real_time_ ? 0 : clock_ns_; }
  bool write(const std::uint8_t*, int) override { return true; }
  bool write_feature(const std::uint8_t*, int) override { return true; }

 private:
  struct Report {
    std::uint64_t host_ns;
    std::size_t first;  // in bytes_
    std::uint16_t bytes;
  };
  std::string load();
  std::string check_times() const;

  std::uint64_t time_ns() const { return is_real_time_ ? now_ns() : clock_ns_; }
  void wait_until(std::uint64_t when_ns) {
    if (is_real_time_) return sleep_until(when_ns);
    clock_ns_ = std::max(clock_ns_, when_ns);
  }

  std::string path_, name_;
  const bool is_real_time_;
  std::uint64_t clock_ns_ = 0;  // the reader's, where it is not in real time
  // The whole recording is read at opening: the servo thread accesses no file.
  std::vector<Report> reports_;
  std::vector<std::uint8_t> bytes_;
  std::size_t next_ = 0;
  std::uint64_t started_ns_ = 0;
  bool has_started_ = false;
  std::atomic<bool> is_over_{false};
};

std::string RecordedTransport::load() {
  SessionReader reader;
  if (std::string problem = reader.open(path_); !problem.empty()) return problem;
  HostConfig recorded;
  if (std::string problem = parse_scene(reader.header().scene, path_ + " (its scene)", &recorded); !problem.empty())
    return problem;
  const std::size_t device = find_recorded_device(recorded, name_);
  if (device == recorded.devices.size()) return path_ + ": no device '" + name_ + "' in it";
  const auto input = std::make_unique<TickInput>();
  for (SessionRecord record; reader.next(&record);) {
    if (record.device != device || decode_tick_input(record.payload, record.payload_bytes, input.get()) == 0) continue;
    for (std::uint32_t i = 0; i < input->report_count; ++i) {
      const RawReport& report = input->reports[i];
      const auto length = std::min<std::size_t>(report.bytes, kMaxReportBytes);
      reports_.push_back({report.host_ns, bytes_.size(), report.bytes});
      bytes_.insert(bytes_.end(), report.data, report.data + length);
    }
  }
  if (reports_.empty()) return path_ + ": no report of '" + name_ + "' in it: there is nothing to play";
  return is_real_time_ ? std::string() : check_times();
}

std::string RecordedTransport::check_times() const {
  std::uint64_t last_ns = reports_[0].host_ns;
  for (std::size_t i = 1; i < reports_.size(); ++i) {
    const std::uint64_t at_ns = reports_[i].host_ns;
    const std::uint64_t gap_ns = at_ns - std::min(at_ns, last_ns), whole_ns = at_ns - std::min(at_ns, reports_[0].host_ns);
    const auto in_s = [](std::uint64_t ns) { return shown_number(static_cast<double>(ns) * 1e-9) + " s"; };
    const auto report = [&] { return path_ + ": report " + std::to_string(i) + " of '" + name_ + "' comes "; };
    if (gap_ns > kLongestGap_ns) {
      return report() + in_s(gap_ns) + " after the one before; without waiting at most " + in_s(kLongestGap_ns) +
             " are passed over: play it in real time (without --fast), or a recording without that silence";
    }
    if (whole_ns > kLongest_ns) {
      return report() + in_s(whole_ns) + " after the first; without waiting at most " + in_s(kLongest_ns) +
             " are played: record it in parts";
    }
    last_ns = std::max(last_ns, at_ns);
  }
  return {};
}

std::string RecordedTransport::open() {
  if (is_over_) return path_ + ": the recording has ended";
  reports_.clear();
  bytes_.clear();
  next_ = 0;
  has_started_ = false;
  return load();
}

ReadResult RecordedTransport::read(std::uint8_t* data, int capacity, int timeout_ms) {
  if (next_ == reports_.size()) {
    is_over_ = true;
    return {ReadStatus::kLost, 0};
  }
  if (!has_started_) started_ns_ = time_ns();
  has_started_ = true;
  const Report& report = reports_[next_];
  const std::uint64_t after_ns = report.host_ns - std::min(report.host_ns, reports_[0].host_ns);
  const std::uint64_t due_ns = started_ns_ + std::min(after_ns, ~started_ns_);  // saturates: an absurd time is never due
  const std::uint64_t until_ns = time_ns() + static_cast<std::uint64_t>(std::max(timeout_ms, 0)) * kMillisecond_ns;
  if (due_ns > until_ns) {
    if (timeout_ms > 0) wait_until(until_ns);
    return {ReadStatus::kTimeout, 0};
  }
  if (timeout_ms > 0) wait_until(due_ns);
  if (time_ns() < due_ns) return {ReadStatus::kTimeout, 0};
  ++next_;
  // what the log cut off is not there: a report that was too long is still too long
  const int length = std::min<int>(report.bytes, kMaxReportBytes);
  std::memcpy(data, bytes_.data() + report.first, static_cast<std::size_t>(std::min(length, capacity)));
  return {ReadStatus::kReport, report.bytes};
}

}  // namespace

std::unique_ptr<Transport> make_recorded_transport(const DeviceConfig& config) {
  return std::make_unique<RecordedTransport>(config);
}

}  // namespace fdcg::dev
