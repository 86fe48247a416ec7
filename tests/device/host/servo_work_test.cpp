// SPDX-License-Identifier: Apache-2.0
// What the servo thread does in a tick: no heap, no lock, and how long it takes.
#include <algorithm>
#include <cstdlib>

#include "base/real_time.hpp"
#include "catch.hpp"
#include "instruction_count.hpp"
#include "loop_rig.hpp"
#include "thread_calls.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

TEST_CASE("servo loop: no heap and no lock, whatever happens to the device") {
  if (!can_count_thread_calls()) return;
  LogRing log(LogRing::kLeastBytes);  // too small for all of it, as is the ring of snapshots: a full one is part of the test
  Rig rig(cube_file(), &log);
  rig.servo.keep_snapshots(64);
  rig.open();
  Running writer([&] { rig.writer.run(); });
  ThreadCalls calls;
  std::atomic<bool> ends{false};
  std::uint64_t ticks = 0;
  Running servo([&] {
    count_calls_of_this_thread(true);
    while (!ends) {
      rig.servo.tick();
      ++ticks;
    }
    count_calls_of_this_thread(false);
    calls = thread_calls();
  });
  rig.servo.request_arm();
  sleep_ms(50);
  rig.device.is_silent = true;
  sleep_ms(30);
  rig.device.is_silent = false;
  rig.device.burst = 200;
  rig.device.excess = 3;
  sleep_ms(30);
  rig.device.excess = 0;
  rig.device.refuses_writes = true;
  rig.servo.request_arm();
  sleep_ms(30);
  rig.device.is_plugged = false;
  sleep_ms(50);
  rig.servo.request_disarm();
  ends = true;
  CHECK(servo.ends_within_ms(1000));
  CHECK(ticks > 100);
  CHECK(log.dropped(0) > 0);
  CHECK(rig.servo.snapshots().dropped() > 0);
  CHECK(calls.heap == 0);
  CHECK(calls.locks == 0);
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
}

namespace {

struct Work {
  std::vector<std::int64_t> all_ns, wake_ns;  // of each tick; the second is in the first
};

std::int64_t quantile(std::vector<std::int64_t> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size()))];
}

// All of a tick but the reading: judging, stepping, the gate, handing over, the log, the snapshot.
Work own_work(int priority) {
  constexpr int kTicks = 2000;
  LogRing log(1u << 22);
  Rig rig(cube_file(), &log);
  rig.servo.keep_snapshots(2 * kTicks);
  rig.open();
  Running writer([&] {
    const OwnPriority real_time(priority);
    rig.writer.run();
  });
  Work work;
  work.all_ns.reserve(kTicks);
  work.wake_ns.reserve(kTicks);
  Running servo([&] {
    const OwnPriority real_time(priority);
    rig.servo.request_arm();
    const std::int64_t clock_ns = rig.reads.clock_cost_ns = clock_cost_ns();
    count_calls_of_this_thread(true);
    for (int tick = 0; tick < kTicks; ++tick) {
      if (tick == 100) rig.device.tip_z_m = -0.002;
      const std::int64_t wake_ns = futex_ns_of_this_thread();
      const std::int64_t before_ns = spent_ns() - rig.reads.read_ns;
      rig.servo.tick();
      work.all_ns.push_back(spent_ns() - rig.reads.read_ns - before_ns - clock_ns);
      work.wake_ns.push_back(futex_ns_of_this_thread() - wake_ns);
    }
    count_calls_of_this_thread(false);
  });
  REQUIRE(servo.ends_within_ms(60'000));
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
  CHECK(rig.servo.snapshots().dropped() == 0);
  CHECK(log.dropped(0) == 0);
  return work;
}

}  // namespace

namespace {

// What it takes to wake a thread that sleeps, and nothing else: a yardstick of how dear the machine's system calls and cold
// caches are just now. On a virtual machine beside busy ones it may be most of a tick.
std::vector<std::int64_t> bare_wakes_ns(int priority) {
  constexpr int kWakes = 300;
  Event event;
  std::atomic<bool> ends{false};
  Running sleeper([&] {
    const OwnPriority real_time(priority);
    while (!ends)
      event.wait(kMsNs * 1000);
  });
  std::vector<std::int64_t> took_ns;
  Running waker([&] {
    const OwnPriority real_time(priority);
    const std::int64_t clock_ns = clock_cost_ns();
    for (int wake = 0; wake < kWakes; ++wake) {
      sleep_ms(1);
      const std::int64_t before_ns = spent_ns();
      event.signal();
      took_ns.push_back(spent_ns() - before_ns - clock_ns);
    }
  });
  CHECK(waker.ends_within_ms(60'000));
  ends = true;
  event.signal();
  CHECK(sleeper.ends_within_ms(10'000));
  return took_ns;
}

}  // namespace

TEST_CASE("servo loop: its own work in a tick takes less than 10 us, log and snapshot included") {
  if (!can_count_thread_calls()) return;  // sanitizers make it slower
  constexpr std::int64_t kMostNs = 10'000;
  constexpr double kBareWakeNs = 1000;  // of the idle machine, on which a tick took 2 us
  const bool is_idle =
      std::getenv("FDCG_IDLE") != nullptr;  // the machine, but for this test: no allowance, and the 99th percentile too
  const int priority = GENERATE(0, 80);
  bool is_within = false;
  for (int round = 0; round < 10 && !is_within; ++round) {  // other programs may have the caches
    const Work work = own_work(priority);
    const std::vector<std::int64_t> bare_ns = bare_wakes_ns(priority);
    const double slowness = is_idle ? 1 : std::clamp(static_cast<double>(quantile(bare_ns, 0.5)) / kBareWakeNs, 1.0, 3.0);
    const auto most_ns = static_cast<std::int64_t>(slowness * static_cast<double>(kMostNs));
    std::vector<std::int64_t> rest_ns;
    for (std::size_t i = 0; i < work.all_ns.size(); ++i)
      rest_ns.push_back(work.all_ns[i] - work.wake_ns[i]);
    is_within =
        quantile(priority == 0 ? work.all_ns : rest_ns, 0.5) < most_ns && (!is_idle || quantile(rest_ns, 0.99) < kMostNs);
    WARN("priority " << priority << ": p50 " << quantile(rest_ns, 0.5) << " p99 " << quantile(rest_ns, 0.99)
                     << " ns; waking the writer p50 " << quantile(work.wake_ns, 0.5) << " p99 " << quantile(work.wake_ns, 0.99)
                     << " ns; both p50 " << quantile(work.all_ns, 0.5) << " p99 " << quantile(work.all_ns, 0.99)
                     << " ns; a bare thread's wake p50 " << quantile(bare_ns, 0.5) << " p99 " << quantile(bare_ns, 0.99)
                     << " ns; bound " << most_ns << " ns");
  }
  CHECK(is_within);
}

namespace {

// Of a tick in contact and armed, but for the reading; the median of some. Each is single-stepped, which takes so long that the
// next tick disarms.
std::uint64_t instructions_of_a_tick(bool has_taps) {
  constexpr int kCounted = 3, kTicksToArm = 20, kTicksInside = 40;
  constexpr std::uint64_t kMost = 1'000'000;
  LogRing log(1u << 22);
  Rig rig(cube_file(), has_taps ? &log : nullptr);
  if (has_taps) rig.servo.keep_snapshots(4096);
  rig.open();
  Running writer([&] { rig.writer.run(); });
  const OwnPriority real_time(80);  // where it is granted a busy machine is no matter
  const auto ticks = [&](int count) {
    for (int i = 0; i < count; ++i)
      rig.servo.tick();
  };
  std::uint8_t report[kMaxReportBytes];
  std::vector<std::uint64_t> counts;
  for (int tries = 0; static_cast<int>(counts.size()) < kCounted && tries < 20 * kCounted; ++tries) {
    rig.device.tip_z_m = 0.01;
    ticks(kTicksToArm);
    rig.servo.request_arm();
    ticks(kTicksToArm);
    rig.device.tip_z_m = -0.002;
    ticks(kTicksInside);
    if (!(rig.device.force_n > 0)) continue;  // a busy machine was late
    rig.device.burst = 1;
    std::uint64_t count = fdcg::test::instructions_of([&] { rig.servo.tick(); }, kMost);
    rig.device.burst = 1;
    count -= fdcg::test::instructions_of([&] { rig.reads.read(report, sizeof report, 1); }, kMost);  // it finds a report
    count -= fdcg::test::instructions_of([&] { rig.reads.read(report, sizeof report, 0); }, kMost);  // and then none
    counts.push_back(count);
  }
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
  REQUIRE(counts.size() == kCounted);
  std::sort(counts.begin(), counts.end());
  return counts[kCounted / 2];
}

}  // namespace

TEST_CASE("servo loop: a tick's instructions, with log and snapshot and without") {
  if (!can_count_thread_calls() || FDCG_COUNTS_INSTRUCTIONS == 0) return;
  const std::uint64_t without = instructions_of_a_tick(false), with = instructions_of_a_tick(true);
  WARN("instructions of a tick: " << without << ", with log and snapshot " << with);
  CHECK(without > 1000);
  CHECK(with < 20'000);
  CHECK(with - without < 10'000);
}

TEST_CASE("the counters of heap and locks count") {
  if (!can_count_thread_calls()) return;
  const ThreadCalls before = thread_calls();
  count_calls_of_this_thread(true);
  std::mutex mutex;
  delete new std::string(100, 'x');
  mutex.lock();
  mutex.unlock();
  count_calls_of_this_thread(false);
  CHECK(thread_calls().heap - before.heap >= 2);
  CHECK(thread_calls().locks - before.locks == 1);
}
