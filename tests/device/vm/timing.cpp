// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "scenarios.hpp"

namespace fdcg::vm {
namespace {

// The bar at 8 kHz: shorter than the two periods that a person could never feel.
constexpr double kRoundTripLimitUs = 150;

double quantile_us(std::vector<std::uint32_t>& sorted, double share) {
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
  const std::uint64_t late = rig.host_counter("late"), lost = rig.host_counter("lost");
  rig.run_for(10 * rig.period());  // what was missed while the status was read
  rig.missed_ticks = 0;
  rig.device.record.restart();
  rig.run_for(seconds * kSecond);
  Record record = rig.device.record;
  rig.refresh_status();
  std::sort(record.round_trips_ns.begin(), record.round_trips_ns.end());
  if (record.round_trips_ns.empty()) {
    verdicts.check(false, name + ": no report was answered");
    return rig.say_host_words(verdicts);
  }
  const std::uint64_t late_now = rig.host_counter("late") - late, lost_now = rig.host_counter("lost") - lost;
  verdicts.say(words(
      "%s, %d s: %llu reports, %llu answered; round trip p50 %.1f, p99 %.1f, p99.9 %.1f, max %.1f us; most force %.2f N",
      name.c_str(), seconds, static_cast<unsigned long long>(record.sent), static_cast<unsigned long long>(record.answered),
      quantile_us(record.round_trips_ns, 0.5), quantile_us(record.round_trips_ns, 0.99),
      quantile_us(record.round_trips_ns, 0.999), quantile_us(record.round_trips_ns, 1), record.most_force_n));
  bool is_good = verdicts.check(late_now == 0 && lost_now == 0,
                                name + words(": %d late, %d lost", static_cast<int>(late_now), static_cast<int>(lost_now)));
  is_good &= verdicts.check(record.sent - record.answered <= 1 && rig.missed_ticks == 0,
                            name + words(": %d reports without answer, %d ticks missed by the device itself",
                                         static_cast<int>(record.sent - record.answered), static_cast<int>(rig.missed_ticks)));
  is_good &= verdicts.check(quantile_us(record.round_trips_ns, 1) < kRoundTripLimitUs,
                            name + words(": every round trip under %.0f us", kRoundTripLimitUs));
  is_good &= verdicts.check(record.force_n > 0 && record.misled == 0, name + ": force to the end, none misled");
  const bool is_ended = rig.end_host();
  is_good &= verdicts.check(is_ended && rig.host.ending() == 0, name + words(": the host ends with %d", rig.host.ending()));
  is_good &= verdicts.check(rig.device.record.force_n == 0 && rig.device.record.watchdog_trips == 0,
                            name + ": zero force at the end, by the host");
  if (!is_good) rig.say_host_words(verdicts);
}

}  // namespace fdcg::vm
