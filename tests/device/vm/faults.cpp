// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>

#include "scenarios.hpp"
#include "strikes.hpp"

namespace fdcg::vm {
namespace {

// The bar: no force 2 ms after the host could first know.
constexpr Nanoseconds kZeroLimit = 2 * kMillisecond;
// What the hand's trembling changes in a period, and far below a step: no force grows by more once it must go.
constexpr double kMostRiseN = 0.1;

constexpr StrikeKind kStrikes[] = {
    {"short", strike_short},
    {"long", strike_long},
    {"garbled", strike_garbled, nullptr, "crc"},
    {"repeated", strike_repeated, nullptr, "repeated"},
    {"out-of-order", strike_out_of_order, nullptr, "out-of-order"},
    {"stale", strike_stale, nullptr, "stale"},
    {"nan", strike_nan, nullptr, "not-finite", true},
    {"stalled", strike_stalled},
    {"half-lost", strike_half_lost},
    {"lag-5", strike_lag_5, "lag"},
    {"lag-15", strike_lag_15, "silence,not-taken"},
    {"lag-30", strike_lag_30, "silence,not-taken"},
    {"unplugged", strike_unplugged},
    {"no-output", strike_no_output},
    {"restarted", strike_restarted},
    {"other-host", strike_other_host},
    {"asleep", strike_asleep},
    {"clock-jump", strike_clock_jump, "slept", nullptr, false, false, true},
    {"suspended", strike_suspended, "slept,host-late,silence", nullptr, false, false, false, false},
    {"other-description", strike_other_description},
    {"killed", strike_killed},
    {"killed-unwatched", strike_killed_unwatched, nullptr, nullptr, false, false, false, false},
    {"segv", strike_crash<SIGSEGV>},
    {"abrt", strike_crash<SIGABRT>},
    {"bus", strike_crash<SIGBUS>},
    {"fpe", strike_crash<SIGFPE>},
    {"ill", strike_crash<SIGILL>},
    {"quit", strike_crash<SIGQUIT>},
    {"xcpu", strike_crash<SIGXCPU>},
    {"usr1", strike_crash<SIGUSR1>},
    {"usr2", strike_crash<SIGUSR2>},
    {"term", strike_end<SIGTERM>},
    {"int", strike_end<SIGINT>},
    {"hup", strike_end<SIGHUP>},
    {"tstp", strike_stopped, "not-armed"},
    {"servo-thread", strike_servo_thread, "host-late"},
    {"writer-thread", strike_writer_thread, "writer-stuck"},
    {"second-program", strike_second_program},
    {"node-twice", strike_node_twice},
    {"graph", strike_graph},
    {"disk-full", strike_disk_full, nullptr, nullptr, false, true},
};

double ms(Nanoseconds time) {
  return static_cast<double>(time) / kMillisecond;
}

struct Tally {
  Nanoseconds slowest_zero = 0;      // from when the host could know
  Nanoseconds slowest_watchdog = 0;  // from the last output taken
  double most_rise_n = 0;
  int felt = 0, zeros = 0, disarmed = 0;
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
  if (rig.options.is_timed && record.oldest_answer > expected.oldest_answer)
    return words("a force answered a report %.3f ms old", ms(record.oldest_answer));
  if (expected.known > 0) {
    const std::string late = judge_zero(rig, expected, tally);
    if (!late.empty()) return late;
    tally.most_rise_n = std::max(tally.most_rise_n, record.most_rise_n);
    if (expected.disarms && record.most_rise_n > kMostRiseN) return words("the force steps up by %.3f N", record.most_rise_n);
  }
  const bool has_force = record.force_n > 0;
  if (expected.disarms && (has_force || record.force_since > record.first_zero))
    return "there is force before it was armed again";
  if (rig.options.is_timed && !expected.disarms && !expected.may_disarm && !has_force) return "the force has not come back";
  tally.disarmed += expected.disarms;
  return {};
}

std::string numbers_of(const Rig& rig, const Tally& tally) {
  std::string numbers;
  if (tally.slowest_zero > 0) numbers += words("; zero within %.3f ms of when the host could know", ms(tally.slowest_zero));
  if (tally.slowest_watchdog > 0) numbers += words("; zero within %.3f ms of the last output", ms(tally.slowest_watchdog));
  if (rig.longest_reopening > 0) numbers += words("; answers within %.1f ms of the plug", ms(rig.longest_reopening));
  if (tally.most_rise_n > 0) numbers += words("; no step above %.3f N", tally.most_rise_n);
  return numbers + words("; oldest answer %.3f ms", ms(rig.device.record.oldest_answer));
}

// Of the words of `list`, how often the host says that it disarmed for one.
std::uint64_t told(const Rig& rig, const std::string& list) {
  std::uint64_t times = 0;
  for (std::size_t from = 0, to; from <= list.size(); from = to + 1) {
    to = std::min(list.find(',', from), list.size());
    times += count_of_reason(rig.host.status_line(), list.substr(from, to - from));
  }
  return times;
}

// Empty, or what the host should have said and has not.
std::string judge_words(Rig& rig, const StrikeKind& kind, const Tally& tally) {
  if (kind.told_as == nullptr && kind.rejected_as == nullptr) return {};
  if (!rig.refresh_status()) return "the host's status does not come";
  if (kind.rejected_as && count_of(rig.host.status_line(), std::string("rejected/") + kind.rejected_as) == 0)
    return std::string("the host has rejected no report as ") + kind.rejected_as;
  const std::uint64_t times = kind.told_as ? told(rig, kind.told_as) : 0;
  if (kind.told_as && times < static_cast<std::uint64_t>(tally.disarmed))
    return words("the host says only %d times that it disarmed for %s", static_cast<int>(times), kind.told_as);
  return {};
}

// Empty, or what is wrong. *done: how often it was struck.
std::string strike_often(Rig& rig, const StrikeKind& kind, int times, Tally& tally, int* done) {
  const bool is_timed = rig.options.is_timed;
  for (*done = 0; *done < times;) {
    const bool is_felt = rig.feel();
    tally.felt += is_felt;
    if (!is_felt && is_timed) return *done == 0 ? "the host gives no force" : "no force after it was armed again";
    rig.run_for(rig.random_between(5 * kMillisecond, 60 * kMillisecond));
    ++*done;
    const std::string wrong = judge(rig, kind.strike(rig), tally);
    if (!wrong.empty()) return wrong;
  }
  if (is_timed && !rig.feel()) return "no force after it was armed again";
  const std::string untold = is_timed ? judge_words(rig, kind, tally) : "";
  if (!untold.empty()) return untold;
  if (is_timed && rig.host.calmings() > 0)
    return words("the host calmed %d times a hand that does not shake", rig.host.calmings());
  if (!rig.end_host() || rig.host.ending() >= 128) return words("the host ends with %d", rig.host.ending());
  return {};
}

void run_strike(RigOptions options, const StrikeKind& kind, int times, Verdicts& verdicts) {
  options.has_float_axes = kind.has_float_axes;
  options.has_log = options.is_log_small = kind.is_log_small;
  options.has_clock_shim = kind.has_clock_shim;
  options.has_watchdog = kind.has_watchdog;
  for (const char* letter = kind.name; *letter != 0; ++letter)  // other moments for each kind
    options.seed = options.seed * 31 + static_cast<unsigned char>(*letter);
  Rig rig(options);
  rig.device.plug(true);
  rig.start_host();
  Tally tally;
  int done = 0;
  const std::string wrong = strike_often(rig, kind, times, tally, &done);
  const std::string name = words("%s %s", options.is_usb ? "usb" : "uhid", kind.name);
  if (!wrong.empty()) {
    verdicts.check(false, words("%s, number %d: ", name.c_str(), done) + wrong);
    return rig.say_host_words(verdicts);
  }
  verdicts.check(true, words("%s: %d times, %d felt, %d to zero, %d disarmed", name.c_str(), done, tally.felt, tally.zeros,
                             tally.disarmed) +
                           (options.is_timed ? numbers_of(rig, tally) : ""));
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
