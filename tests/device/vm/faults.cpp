// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "scenarios.hpp"
#include "strikes.hpp"

namespace fdcg::vm {
namespace {

// The bar: no force 2 ms after the host could first know.
constexpr Nanoseconds kZeroLimit = 2 * kMillisecond;
// No force that answers a report older than the gate's silence.
constexpr Nanoseconds kOldestAnswer = 10 * kMillisecond;

constexpr StrikeKind kStrikes[] = {
    {"short", strike_short},
    {"long", strike_long},
    {"garbled", strike_garbled, "crc"},
    {"repeated", strike_repeated, "repeated"},
    {"out-of-order", strike_out_of_order, "out-of-order"},
    {"stale", strike_stale, "stale"},
    {"nan", strike_nan, "not-finite", true},
    {"stalled", strike_stalled},
    {"unplugged", strike_unplugged},
    {"no-output", strike_no_output},
    {"asleep", strike_asleep},
    {"killed", strike_killed},
    {"disk-full", strike_disk_full, nullptr, false, true},
};

double ms(Nanoseconds time) {
  return static_cast<double>(time) / kMillisecond;
}

struct Tally {
  Nanoseconds slowest_zero = 0;      // from when the host could know
  Nanoseconds slowest_watchdog = 0;  // from the last output taken
  int zeros = 0, disarmed = 0;
};

// Empty, or what is wrong with when the force went.
std::string judge_zero(const Rig& rig, const Expectation& expected, Tally& tally) {
  const Record& record = rig.device.record;
  if (record.first_zero == 0) return "the force stays";
  ++tally.zeros;
  if (expected.is_by_watchdog) {
    const Nanoseconds waited = record.first_zero - record.output_before_zero;
    tally.slowest_watchdog = std::max(tally.slowest_watchdog, waited);
    const bool is_late = rig.options.is_timed && waited > kWatchdog + 2 * rig.period();
    return is_late ? words("the force is zero only %.3f ms after the last output", ms(waited)) : "";
  }
  const Nanoseconds delay = std::max<Nanoseconds>(0, record.first_zero - expected.known);
  tally.slowest_zero = std::max(tally.slowest_zero, delay);
  const bool is_late = rig.options.is_timed && delay > kZeroLimit;
  return is_late ? words("the force is zero only %.3f ms after the host could know", ms(delay)) : "";
}

// Empty, or what is wrong.
std::string judge(const Rig& rig, const Expectation& expected, Tally& tally) {
  const Record& record = rig.device.record;
  if (!expected.broken.empty()) return expected.broken;
  if (!rig.host.is_running()) return words("the host has ended by itself with %d", rig.host.ending());
  if (record.misled > 0) return "a force answered a report that must not be used";
  if (rig.options.is_timed && record.oldest_answer > kOldestAnswer)
    return words("a force answered a report %.3f ms old", ms(record.oldest_answer));
  if (expected.known > 0) {
    const std::string late = judge_zero(rig, expected, tally);
    if (!late.empty()) return late;
  }
  const bool has_force = record.force_n > 0;
  if (expected.disarms && (has_force || record.force_since > record.first_zero))
    return "there is force before it was armed again";
  if (!expected.disarms && !expected.may_disarm && !has_force) return "the force has not come back";
  tally.disarmed += expected.disarms;
  return {};
}

void run_strike(RigOptions options, const StrikeKind& kind, int times, Verdicts& verdicts) {
  options.has_float_axes = kind.has_float_axes;
  options.has_log = options.is_log_small = kind.is_log_small;
  for (const char* letter = kind.name; *letter != 0; ++letter)  // other moments for each kind
    options.seed = options.seed * 31 + static_cast<unsigned char>(*letter);
  Rig rig(options);
  rig.device.plug(true);
  rig.start_host();
  Tally tally;
  std::string wrong;
  int done = 0;
  for (; done < times && wrong.empty(); ++done) {
    if (!rig.feel()) {
      wrong = done == 0 ? "the host gives no force" : "the host does not carry on: no force after it was armed again";
      break;
    }
    rig.run_for(rig.random_between(5 * kMillisecond, 60 * kMillisecond));
    wrong = judge(rig, kind.strike(rig), tally);
  }
  if (wrong.empty() && kind.rejected_as && rig.refresh_status() &&
      count_of(rig.host.status_line(), std::string("rejected/") + kind.rejected_as) == 0)
    wrong = std::string("the host has rejected no report as ") + kind.rejected_as;
  const char* const way = options.is_usb ? "usb" : "uhid";
  const std::string name = words("%s %s", way, kind.name);
  if (!wrong.empty()) {
    verdicts.check(false, words("%s, number %d: ", name.c_str(), done) + wrong);
    rig.say_host_words(verdicts);
    return;
  }
  std::string numbers;
  if (options.is_timed) {
    if (tally.slowest_zero > 0) numbers += words("; zero within %.3f ms of when the host could know", ms(tally.slowest_zero));
    if (tally.slowest_watchdog > 0) numbers += words("; zero within %.3f ms of the last output", ms(tally.slowest_watchdog));
    if (rig.longest_reopening > 0) numbers += words("; answers within %.1f ms of the plug", ms(rig.longest_reopening));
    numbers += words("; oldest answer %.3f ms", ms(rig.device.record.oldest_answer));
  }
  verdicts.check(true,
                 words("%s: %d times, %d to zero, %d disarmed", name.c_str(), done, tally.zeros, tally.disarmed) + numbers);
  rig.end_host();
}

bool is_named(const std::string& list, const std::string& name) {
  return list.empty() || (',' + list + ',').find(',' + name + ',') != std::string::npos;
}

}  // namespace

void run_faults(const RigOptions& options, int times, const std::string& only, Verdicts& verdicts) {
  for (const StrikeKind& kind : kStrikes)
    if (is_named(only, kind.name)) run_strike(options, kind, times, verdicts);
}

}  // namespace fdcg::vm
