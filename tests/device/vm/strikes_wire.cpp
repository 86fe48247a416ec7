// SPDX-License-Identifier: Apache-2.0
// Bursts of bad reports. The gate lets two missing reports pass, fades from the third on, and disarms after 10 ms; burst
// lengths stay clear of the edges between the three, so that it is certain which of them must happen.
#include <algorithm>
#include <deque>

#include "strikes.hpp"

namespace fdcg::vm {
namespace {

constexpr Nanoseconds kSilence = 10 * kMillisecond;  // the gate's
constexpr double kMissedPeriods = 3.5;  // from the last good report until the third missing one is overdue by half a period
constexpr Nanoseconds kAfterwards = 60 * kMillisecond;

// Reports in a burst: passes, fades, or disarms.
int burst_length(Rig& rig, int longest) {
  const int silence = static_cast<int>(kSilence / rig.period());
  switch (rig.random_between(0, 2)) {
    case 0:
      return static_cast<int>(rig.random_between(1, 2));
    case 1:
      return static_cast<int>(rig.random_between(5, silence * 6 / 10));  // the good report after it may take periods on its way
    default:
      return static_cast<int>(rig.random_between(silence + 3, longest));
  }
}

Expectation expect_of(Rig& rig, int missing) {
  Expectation expected;
  if (missing < 3) return expected;
  expected.known = now_ns() + static_cast<Nanoseconds>(kMissedPeriods * static_cast<double>(rig.period()));
  expected.disarms = missing * rig.period() > kSilence;
  return expected;
}

// Right after a good report, which it returns.
Bytes begin_on_report(Rig& rig) {
  Bytes last;
  rig.device.set_wire([&](const Bytes& report) {
    last = report;
    rig.device.send(report);
  });
  rig.run_until([&] { return !last.empty(); }, kSecond);
  rig.device.clear_wire();
  return last;
}

// Each of `count` reports goes through `wire` instead of the cable.
Expectation burst(Rig& rig, int count, const Device::Wire& wire, Bytes* last_good = nullptr) {
  const Bytes last = begin_on_report(rig);
  if (last_good != nullptr) *last_good = last;
  const Expectation expected = expect_of(rig, count);
  rig.device.record.watch(expected.known);
  int left = count;
  rig.device.distrust(true);
  rig.device.set_wire([&](const Bytes& report) {
    --left;
    wire(report);
  });
  rig.run_until([&] { return left == 0; }, (count + 2) * rig.period());
  rig.device.clear_wire();
  rig.device.distrust(false);
  rig.run_for(kAfterwards);
  return expected;
}

std::uint32_t get32(const Bytes& report, std::size_t at) {
  return report[at] | std::uint32_t{report[at + 1]} << 8 | std::uint32_t{report[at + 2]} << 16 |
         std::uint32_t{report[at + 3]} << 24;
}

void put32(Bytes& report, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    report[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

constexpr int kLongest = 40;
constexpr int kLongestWithOldNumbers = 15;  // more than 20 in a row are a device that has begun again: report_codec.hpp

// Arming is asked for while what is sent comes back too late. False: it was granted.
bool is_refused(Rig& rig) {
  rig.device.hand.above();
  rig.run_for(100 * kMillisecond);
  for (int i = 0; i < 3; ++i) {
    rig.host.say("arm");
    if (rig.run_until([&] { return rig.device.record.is_enabled; }, 100 * kMillisecond)) return false;
  }
  return true;
}

// From a random moment on reports, or outputs, are under way for so long. Longer than the gate's silence, or than an output may
// be without its echo, it is seen as that; else by the round trips of sixteen outputs. Then it cannot be armed until it is
// over.
Expectation strike_lag(Rig& rig, Nanoseconds lag) {
  constexpr int kTrips = 16;
  const bool is_of_outputs = lag < kSilence || rig.random_between(0, 1) == 1;
  begin_on_report(rig);
  Expectation expected;
  expected.disarms = true;
  const Nanoseconds wire = is_of_outputs ? lag : 0;  // until the host's word has come
  if (lag < kSilence)
    expected.known = now_ns() + lag + (kTrips + 1) * rig.period() + wire;
  else if (is_of_outputs)
    expected.known = now_ns() + kSilence + rig.period() + wire;
  else
    expected.known = now_ns() + static_cast<Nanoseconds>(kMissedPeriods * static_cast<double>(rig.period()));
  expected.oldest_answer = kSilence + lag + rig.period();
  rig.device.record.watch(expected.known);
  rig.device.lag(is_of_outputs ? 0 : lag, is_of_outputs ? lag : 0);
  rig.run_until(expected.known + 2 * lag + kAfterwards);
  const bool is_quiet = rig.device.record.force_n == 0;
  if (is_quiet && !is_refused(rig)) expected.broken = "it was armed while what is sent comes back too late";
  rig.device.lag(0, 0);
  rig.run_for(kAfterwards);
  return expected;
}

}  // namespace

Expectation strike_lag_5(Rig& rig) {
  return strike_lag(rig, 5 * kMillisecond);
}
Expectation strike_lag_15(Rig& rig) {
  return strike_lag(rig, 15 * kMillisecond);
}
Expectation strike_lag_30(Rig& rig) {
  return strike_lag(rig, 30 * kMillisecond);
}

Expectation strike_short(Rig& rig) {
  return burst(rig, burst_length(rig, kLongest), [&](const Bytes& report) {
    rig.device.send(Bytes(report.begin(), report.begin() + rig.random_between(1, FDCG_FW_INPUT_BYTES - 1)));
  });
}

// To usbhid a packet beyond the report's length is an error of the line: it waits before it asks again, so that silence
// follows.
Expectation strike_long(Rig& rig) {
  Expectation expected = burst(rig, burst_length(rig, kLongest), [&](const Bytes& report) {
    Bytes longer = report;
    longer.resize(static_cast<std::size_t>(rig.random_between(FDCG_FW_INPUT_BYTES + 1, 64)), 0xA5);
    rig.device.send(longer);
  });
  if (rig.options.is_usb) {
    expected.may_disarm = !expected.disarms;
    rig.run_for(kSecond / 10);
  }
  return expected;
}

Expectation strike_garbled(Rig& rig) {
  return burst(rig, burst_length(rig, kLongest), [&](const Bytes& report) {
    Bytes other = report;
    const auto bits = static_cast<std::uint64_t>(rig.random_between(1, 3));
    for (std::uint64_t i = 0; i < bits; ++i) {  // different bits: in thirds of the report
      const auto place =
          static_cast<std::size_t>(rig.random_between(0, FDCG_FW_INPUT_BYTES / 3 - 1)) + i * (FDCG_FW_INPUT_BYTES / 3);
      other[place] ^= static_cast<std::uint8_t>(1 << rig.random_between(0, 7));
    }
    rig.device.send(other);
  });
}

// Instead of new ones, or besides them: then nothing is missing.
Expectation strike_repeated(Rig& rig) {
  if (rig.random_between(0, 1) == 0) {
    Bytes last;
    const int count = burst_length(rig, kLongestWithOldNumbers);
    return burst(
        rig, count, [&](const Bytes&) { rig.device.send(last); }, &last);
  }
  const Nanoseconds end = now_ns() + rig.random_between(1, 40) * rig.period();
  rig.device.set_wire([&](const Bytes& report) {
    rig.device.send(report);
    rig.device.send(report);
  });
  rig.run_until(end);
  rig.device.clear_wire();
  rig.run_for(kAfterwards);
  return {};
}

// Old ones instead of new ones, or a few in the wrong order.
Expectation strike_out_of_order(Rig& rig) {
  std::deque<Bytes> past;
  rig.device.set_wire([&](const Bytes& report) {
    past.push_back(report);
    rig.device.send(report);
  });
  rig.run_until([&] { return past.size() >= kLongestWithOldNumbers + 5; }, kSecond);
  rig.device.clear_wire();
  if (rig.random_between(0, 1) == 0) {
    return burst(rig, burst_length(rig, kLongestWithOldNumbers), [&](const Bytes&) {
      rig.device.send(past.front());
      if (past.size() > 1) past.pop_front();
    });
  }
  // two out of every three are late by a report: the last of them is in time
  std::vector<Bytes> held;
  rig.device.set_wire([&](const Bytes& report) {
    held.push_back(report);
    if (held.size() < 3) return;
    std::for_each(held.rbegin(), held.rend(), [&](const Bytes& each) { rig.device.send(each); });
    held.clear();
  });
  rig.run_for(rig.random_between(1, 12) * 3 * rig.period());
  rig.run_until([&] { return held.empty(); }, 4 * rig.period());
  rig.device.clear_wire();
  rig.run_for(kAfterwards);
  return {};
}

// Held up on the way by a queue, from which they come late but in order; or made long ago by their own time.
Expectation strike_stale(Rig& rig) {
  if (rig.random_between(0, 2) == 0) {
    return burst(rig, burst_length(rig, kLongestWithOldNumbers), [&](const Bytes& report) {
      Bytes older = report;
      put32(older, 5, get32(older, 5) - static_cast<std::uint32_t>(rig.random_between(20'000, 200'000)));
      set_crc(older);
      rig.device.send(older);
    });
  }
  const auto delay = static_cast<std::size_t>(rig.random_between(7, 40));
  std::deque<Bytes> queue;
  return burst(rig, static_cast<int>(delay) + static_cast<int>(rig.random_between(10, 40)), [&](const Bytes& report) {
    queue.push_back(report);
    if (queue.size() <= delay) return;
    rig.device.send(queue.front());
    queue.pop_front();
  });
}

// No number, or none that is finite, in one axis or more; the CRC is right.
Expectation strike_nan(Rig& rig) {
  return burst(rig, burst_length(rig, kLongest), [&](const Bytes& report) {
    Bytes other = report;
    const auto lost_axes = rig.random_between(1, 7);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lost_axes >> axis & 1) put32(other, 9 + 4 * axis, rig.random_between(0, 1) == 0 ? 0x7FC00000 : 0xFF800000);
    set_crc(other);
    rig.device.send(other);
  });
}

Expectation strike_stalled(Rig& rig) {
  return burst(rig, burst_length(rig, 300), [](const Bytes&) {});
}

// Every second report, for as long as the host may take to notice and some more.
Expectation strike_half_lost(Rig& rig) {
  constexpr Nanoseconds kCounted = kSecond / 10;
  Expectation expected;
  expected.known = now_ns() + kCounted;
  expected.disarms = true;
  rig.device.record.watch(expected.known);
  bool is_lost = false;
  rig.device.set_wire([&](const Bytes& report) {
    is_lost = !is_lost;
    if (!is_lost) rig.device.send(report);
  });
  rig.run_for(2 * kCounted);
  rig.device.clear_wire();
  rig.run_for(kAfterwards);
  return expected;
}

}  // namespace fdcg::vm
