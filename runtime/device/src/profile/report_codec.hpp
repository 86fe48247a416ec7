// SPDX-License-Identifier: Apache-2.0
// Reports to values and back, by a profile's table. Pure; no heap, no lock; cost linear in the report's bytes.
#pragma once

#include <cstdint>

#include "fdcg/device_status.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

// The content of an input report.
struct Sample {
  double axis[kMaxAxes] = {};  // m or rad
  std::uint32_t sequence = 0;  // as wide as its field
  std::uint32_t echo = 0;      // the sequence number of the last output report that the device took
  double time_s = 0;           // of the device's clock; wraps with its field
  std::uint32_t buttons = 0;
  bool has_fault = false;   // a bit of the status mask is set
  bool is_enabled = false;  // the device says that it applies the force
};

// Length, id, CRC, constants and finiteness; *sample is only good with kGood.
Verdict decode_input(const Profile& profile, const std::uint8_t* data, int bytes, Sample* sample);

// Sequence and age, against what came before. Begin with a fresh one wherever a device is opened.
struct ReportJudge {
  bool has_last = false;  // of the newest report in order, fresh or stale:
  std::uint32_t last_sequence = 0;
  double last_raw_time_s = 0;  // the device's clock as reported
  double last_time_s = 0;      // the device's clock, unwrapped
  double last_host_s = 0;
  double last_good_host_s = 0;  // of the newest good one
  bool has_offset = false;
  double least_offset_s = 0;  // host clock - device clock at the quickest report so far, creeping up as clocks drift
  double settled_host_s = 0;  // until then ages are not known, and reports count as stale
  int outsiders = 0;          // reports in a row that are out of order, but in order among themselves
  std::uint32_t outsider_sequence = 0;
  double outsider_raw_time_s = 0;
  std::uint64_t lost = 0;      // gaps in the sequence, in reports
  std::uint64_t restarts = 0;  // of the device
};
// host_s: when the report was read, on the host's clock, never falling. A field that the profile lacks is not judged: without a
// sequence, a report whose time is that of the one before is repeated; without a time, none is stale; with neither, all is
// good.
//
// Age is measured against the quickest report: clocks may differ by kMostDrift. After a silence of half the period of the
// device's clock, ages are unknown for kSettleS. A restart of the device (its clock or sequence begins again), or a leap of the
// sequence or of the clock ahead that nothing explains, shows as kOutOfOrder for kRestartReports reports, then is taken as new.
inline constexpr int kRestartReports = 20;
inline constexpr double kMaxAgeS = 0.005;
inline constexpr double kMostDrift = 200e-6;
inline constexpr double kSettleS = 0.1;
Verdict judge_report(const Profile& profile, const Sample& sample, double host_s, ReportJudge* judge);

// The content of an output report. Effort beyond a field's range is clamped.
struct Command {
  double effort[kMaxAxes] = {};
  std::uint32_t sequence = 0, echo = 0;
  bool is_enabled = false;
};
// Returns how many bytes it has written: profile.output.bytes, of text at most so many. Only ever called with efforts that have
// left the gate.
int encode_output(const Profile& profile, const Command& command, std::uint8_t* data);

// The other direction, for simulated devices and tests: an input report from a sample, an output report's content.
int encode_input(const Profile& profile, const Sample& sample, std::uint8_t* data);
bool decode_output(const Profile& profile, const std::uint8_t* data, int bytes, Command* command);

}  // namespace fdcg::dev
