// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "scenarios.hpp"

namespace fdcg::vm {
namespace {

// The bar at 8 kHz: shorter than the two periods that a person could never feel.
constexpr double kRoundTripLimitUs = 150;

// Of its ticks the device itself may make so many late: as it reads a line of the host's, or as the kernel's own work goes on.
constexpr double kMostOwnLate = 0.01;

double quantile_us(const std::vector<std::uint32_t>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))] / 1000.0;
}

}  // namespace

void run_timing(const RigOptions& options, int seconds, Verdicts& verdicts) {
  Rig rig(options);
  rig.device.plug(true);
  rig.start_host();
  const std::string name =
      words("%s over %s, %d Hz", options.is_usb ? "usb" : "uhid", options.backend.c_str(), options.rate_hz);
  if (!rig.feel() || !rig.refresh_status()) {
    verdicts.check(false, name + ": the host gives no force");
    return rig.say_host_words(verdicts);
  }
  const std::string before = rig.host.status_line();
  rig.device.record.restart();
  rig.missed_ticks = rig.late_ticks = 0;
  rig.run_for(seconds * kSecond);
  // nothing that takes longer than a tick until the host has ended: the device would be late
  Record& record = rig.device.record;
  const std::uint64_t sent = record.sent, answered = record.answered, missed_ticks = rig.missed_ticks;
  const std::size_t trips = record.round_trips_ns.size();
  const bool has_force = record.force_n > 0 && record.misled == 0;
  rig.refresh_status();
  const std::uint64_t own_late = rig.late_ticks;
  const std::string after = rig.host.status_line();  // what is late while the host ends is late for nobody
  const bool is_ended = rig.end_host();

  const std::uint64_t late = count_of(after, "late") - count_of(before, "late");
  const std::uint64_t lost = count_of(after, "lost") - count_of(before, "lost");
  std::vector<std::uint32_t> round_trips(record.round_trips_ns.begin(),
                                         record.round_trips_ns.begin() + static_cast<long>(trips));
  std::sort(round_trips.begin(), round_trips.end());
  if (round_trips.empty()) {
    verdicts.check(false, name + ": no report was answered");
    return rig.say_host_words(verdicts);
  }
  verdicts.say(
      words("%s, %d s: %llu reports, %llu answered; round trip p50 %.1f, p99 %.1f, p99.9 %.1f, max %.1f us; most force %.2f N",
            name.c_str(), seconds, static_cast<unsigned long long>(sent), static_cast<unsigned long long>(answered),
            quantile_us(round_trips, 0.5), quantile_us(round_trips, 0.99), quantile_us(round_trips, 0.999),
            quantile_us(round_trips, 1), record.most_force_n));
  // where the device itself is late, so is its report
  bool is_good =
      verdicts.check(late <= own_late && static_cast<double>(own_late) <= kMostOwnLate * static_cast<double>(sent) && lost == 0,
                     name + words(": %d late where the device was so %d times, %d lost", static_cast<int>(late),
                                  static_cast<int>(own_late), static_cast<int>(lost)));
  const auto unanswered = static_cast<std::int64_t>(sent - answered);  // one may be under way at either end
  is_good &= verdicts.check(std::abs(unanswered) <= 1 && missed_ticks == 0,
                            name + words(": %d reports without answer, %d ticks missed by the device itself",
                                         static_cast<int>(unanswered), static_cast<int>(missed_ticks)));
  is_good &= verdicts.check(quantile_us(round_trips, 1) < kRoundTripLimitUs,
                            name + words(": every round trip under %.0f us", kRoundTripLimitUs));
  is_good &= verdicts.check(has_force, name + ": force to the end, none misled");
  is_good &= verdicts.check(is_ended && rig.host.ending() == 0, name + words(": the host ends with %d", rig.host.ending()));
  is_good &= verdicts.check(rig.device.record.force_n == 0 && rig.device.record.watchdog_trips == 0,
                            name + ": zero force at the end, by the host");
  if (!is_good) rig.say_host_words(verdicts);
}

}  // namespace fdcg::vm
