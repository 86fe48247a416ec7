// SPDX-License-Identifier: Apache-2.0
// What a device's reports say of the link between the two: whether it takes what the host sends, how long that is under way,
// whether somebody else sends to it, and how many of its reports arrive. A pure function of reports and times, as the gate is.
// No heap, no lock; the work of a report is bounded.
//
// A device that does not echo output sequences is not watched for the first three of these.
#pragma once

#include <cstdint>

#include "fdcg/device_status.hpp"
#include "profile/profile.hpp"
#include "profile/report_codec.hpp"

namespace fdcg::dev {

inline constexpr double kTakenS = 0.010;            // an output that is not echoed within this, while there is force: a fault
inline constexpr double kOtherHostS = 0.5;          // for so long a foreign echo is held against the device
inline constexpr double kCountedS = 0.1;            // the time in which reports are counted ...
inline constexpr double kLeastShare = 0.6;          // ... and the share of the profile's rate that must arrive in it
inline constexpr double kMostRoundTripS = 0.004;    // from a write to its echo, in the quickest of the last 16 ...
inline constexpr double kMostRoundTripPeriods = 4;  // ... or so many periods, where those are longer

// An output report that the device has been handed.
struct SentReport {
  std::uint64_t ns = 0;  // when the write began, host's clock; 0: none yet
  std::uint32_t sequence = 0;
  bool is_enabled = false;
};

class LinkWatch {
 public:
  // has_echo: the profile's echo, if it has one, is of what this host sends.
  void begin(const Profile& profile, bool has_echo);
  // The device has been opened (again), or has started anew.
  void open(std::uint64_t now_ns);
  // The newest that was sent; one that is known already is no news.
  void note_sent(const SentReport& sent);
  // A good report, in order. host_ns: when it was read.
  void note_report(const Sample& sample, std::uint64_t host_ns);
  // After the reports of a tick. wants_force: armed, or asked to arm.
  Fault fault(std::uint64_t now_ns, bool wants_force) const;
  // Too slow for force to be given: what arming waits for, and of kTrips in a row a fault.
  bool lags() const;
  // From the write to the echo of the newest output that has come back; 0: not known.
  double round_trip_s() const { return round_trip_s_; }

 private:
  static constexpr int kSent = 64, kTrips = 16, kSlots = 10;

  bool is_ahead(std::uint32_t from, std::uint32_t to) const;
  const SentReport* find_sent(std::uint32_t sequence) const;
  void take_echo(const Sample& sample, std::uint64_t host_ns);
  void count(std::uint64_t now_ns);
  bool is_untaken() const;
  bool is_sparse(std::uint64_t now_ns) const;

  std::uint32_t mask_ = 0;  // of an echo's bits; 0: the device has none
  bool tells_enabled_ = false;
  double period_s_ = 0;
  double least_count_ = 0;  // of reports in kCountedS; 0: too few to judge

  SentReport sent_[kSent];  // a ring
  std::uint32_t sent_count_ = 0;
  std::uint64_t report_ns_ = 0;  // of the newest report
  bool is_heard_ = false;        // one of ours has come back since the device was opened
  std::uint32_t echo_ = 0;
  double round_trip_s_ = 0;
  double trips_s_[kTrips] = {};
  std::uint32_t trip_count_ = 0;
  std::uint64_t unapplied_ns_ = 0;  // since when the device says that it does not apply what it took; 0: it does
  std::uint64_t foreign_ns_ = 0;    // of the last foreign echo; 0: none

  std::uint64_t opened_ns_ = 0, slot_ = 0;  // the slot that is being counted, of kCountedS / kSlots each
  std::uint32_t counts_[kSlots] = {};
};

}  // namespace fdcg::dev
