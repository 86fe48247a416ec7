// SPDX-License-Identifier: Apache-2.0
// The threads of one device: events, the link, the writer, the servo loop, the supervisor. The host as a whole: host_test.cpp.
#include <thread>

#include "catch.hpp"
#include "host/supervisor.hpp"
#include "loop_rig.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

namespace {

// A force that the gate has let through: only a gate can make one.
GatedForce gated_force() {
  const Profile profile = fake_profile();
  Gate gate;
  gate.begin(profile.limits, profile.axis_count, profile.rate_hz, 0);
  GateInput input;
  for (int axis = 0; axis < 3; ++axis)
    input.tip.jacobian[axis][axis] = 1;
  input.has_sample = true;
  GatedForce force;
  for (int tick = 0; tick < 2000; ++tick) {
    input.now_ns += kMsNs;
    input.arm = tick == 1;
    input.wanted_force_n[2] = tick > 2 ? 2 : 0;
    force = gate.step(input);
  }
  REQUIRE(force.is_enabled());
  REQUIRE(force.effort()[2] == Approx(2));
  return force;
}

}  // namespace

TEST_CASE("event: a signal is kept until the next wait, and a wait without one times out") {
  Event event;
  event.signal();
  event.signal();
  CHECK(event.wait(0));
  const std::uint64_t before_ns = monotonic_ns();
  CHECK_FALSE(event.wait(20 * kMsNs));
  CHECK(monotonic_ns() - before_ns >= 20 * kMsNs);
}

TEST_CASE("event: wakes its waiter every time") {
  Event ping, pong;
  std::atomic<int> missed{0};
  Running other([&] {
    for (int i = 0; i < 5000; ++i) {
      missed += !ping.wait(10'000 * kMsNs);
      pong.signal();
    }
  });
  for (int i = 0; i < 5000; ++i) {
    ping.signal();
    missed += !pong.wait(10'000 * kMsNs);
  }
  CHECK(other.ends_within_ms(10'000));
  CHECK(missed == 0);
}

TEST_CASE("a thread that does not end is reported, and can be left alone") {
  std::atomic<bool> ends{false}, has_ended{false};
  Thread thread;
  REQUIRE(thread
              .start("slow",
                     [&] {
                       while (!ends)
                         sleep_ms(1);
                       has_ended = true;
                     })
              .empty());
  CHECK_FALSE(thread.join_within(5 * kMsNs));
  thread.abandon();
  CHECK_FALSE(thread.is_started());
  CHECK(thread.join_within(0));
  ends = true;
  CHECK(within_ms(5000, [&] { return has_ended.load(); }));
}

TEST_CASE("link: no thread is inside when it is closed") {
  Link link;
  std::atomic<bool> is_usable{false}, ends{false};
  std::atomic<int> wrong{0};
  std::atomic<std::uint64_t> entered{0};
  const auto visit = [&](Link::Party party) {
    while (!ends) {
      if (!link.enter(party)) {
        std::this_thread::yield();
        continue;
      }
      wrong += !is_usable;
      ++entered;
      wrong += !is_usable;
      link.leave(party);
    }
  };
  Running reader([&] { visit(Link::kReader); });
  Running writer([&] { visit(Link::kWriter); });
  const std::uint64_t until_ns = monotonic_ns() + 1000 * kMsNs;
  std::uint64_t rounds = 0;
  for (; rounds < 20'000 && (rounds < 50 || monotonic_ns() < until_ns); ++rounds) {
    is_usable = true;
    link.open();
    const std::uint64_t before = entered;
    while (entered == before)
      std::this_thread::yield();
    link.close();
    while (!link.is_empty())
      std::this_thread::yield();
    is_usable = false;
  }
  ends = true;
  CHECK(reader.ends_within_ms(5000));
  CHECK(writer.ends_within_ms(5000));
  CHECK(wrong == 0);
  CHECK(link.opened() == rounds);
}

TEST_CASE("the writer sends each force at once, numbered, with the echo, and zero by itself 10 ms after the last") {
  Rig rig;
  rig.open();
  const GatedForce force = gated_force();
  Running writer([&] { rig.writer.run(); });
  for (std::uint32_t i = 0; i < 50; ++i) {
    rig.send(force, 1000 + i);
    REQUIRE(within_ms(5000, [&] { return rig.device.echo == 1000 + i; }));
  }
  REQUIRE(within_ms(5000, [&] { return rig.device.force_n == 0; }));
  sleep_ms(50);
  const std::uint64_t writes = rig.device.writes;
  const std::vector<Written> written = rig.device.all_written();
  std::uint32_t forces = 0;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const Command& command = written[i].command;
    if (command.is_enabled) {
      CHECK(command.effort[2] == Approx(2));
      CHECK(command.echo == 1000 + forces++);
    } else {  // by itself; more than one only where this test was held up
      CHECK(command.effort[2] == 0);
      REQUIRE(i > 0);
      CHECK(written[i - 1].command.is_enabled);
      CHECK(written[i].ns - written[i - 1].ns >= 10 * kMsNs);
    }
  }
  CHECK(forces == 50);
  CHECK_FALSE(written.back().command.is_enabled);
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
  CHECK(rig.device.safe_stops == 1);
  CHECK(rig.device.misused == 0);
  WriterStatus status;
  REQUIRE(rig.writer.take_status(&status));
  CHECK(writes == written.size());
  CHECK(status.writes == writes + 2);  // zero and the safe stop
  CHECK(status.failures == 0);
  CHECK(status.write.total == status.writes);
}

TEST_CASE("writer: after a blocked write the newest force is sent first") {
  Rig rig;
  rig.open();
  const GatedForce force = gated_force();
  Running writer([&] { rig.writer.run(); });
  rig.device.holds_writes = true;
  rig.send(force, 1);
  REQUIRE(within_ms(1000, [&] { return rig.device.inside_writes == 1; }));
  sleep_ms(8);
  CHECK(rig.writer.busy_ns(monotonic_ns()) >= 7 * kMsNs);
  for (std::uint32_t echo = 2; echo <= 500; ++echo)
    rig.send(GatedForce(), echo);
  rig.device.holds_writes = false;
  REQUIRE(within_ms(1000, [&] { return rig.device.writes >= 2; }));
  CHECK(rig.device.echo == 500);
  CHECK(rig.device.force_n == 0);
  CHECK(within_ms(1000, [&] { return rig.writer.busy_ns(monotonic_ns()) == 0; }));  // the write counts before it returns
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
}

// The servo thread was stopped before it stored the force (first), and after, before it woke the writer (then).
TEST_CASE("writer: a force 10 ms old is sent as zero") {
  Rig rig;
  rig.open();
  const GatedForce force = gated_force();
  rig.writer.put(force, 1, monotonic_ns() - 10 * kMsNs);
  Running writer([&] { rig.writer.run(); });
  REQUIRE(within_ms(1000, [&] { return rig.device.echo == 1; }));
  rig.send(force, 2);
  REQUIRE(within_ms(1000, [&] { return rig.device.echo == 2; }));
  rig.device.holds_writes = true;
  rig.send(force, 3);
  REQUIRE(within_ms(1000, [&] { return rig.device.inside_writes == 1; }));
  rig.writer.put(force, 4, monotonic_ns());
  sleep_ms(12);
  rig.device.holds_writes = false;
  REQUIRE(within_ms(1000, [&] { return rig.device.echo == 4; }));
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
  for (const Written& written : rig.device.all_written()) {
    CAPTURE(written.command.echo);
    if (written.command.echo == 1 || written.command.echo == 4) CHECK_FALSE(written.command.is_enabled);
  }
}

TEST_CASE("writer: it has kept nobody waiting before a force was stored") {
  Rig rig;
  rig.open();
  Running writer([&] { rig.writer.run(); });
  rig.send(gated_force(), 1);
  REQUIRE(within_ms(1000, [&] { return rig.device.echo == 1; }));
  REQUIRE(within_ms(1000, [&] { return rig.writer.busy_ns(monotonic_ns()) == 0; }));
  sleep_ms(8);  // as a servo thread that is stopped in the middle of a tick
  rig.device.holds_writes = true;
  rig.writer.put(gated_force(), 2, monotonic_ns());
  CHECK(rig.writer.busy_ns(monotonic_ns()) < 4 * kMsNs);
  sleep_ms(8);
  CHECK(rig.writer.busy_ns(monotonic_ns()) >= 7 * kMsNs);
  rig.device.holds_writes = false;
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
}

TEST_CASE("writer: a failed write is reported until one succeeds, and a closed link is no failure") {
  Rig rig;
  Running writer([&] { rig.writer.run(); });
  rig.send(GatedForce(), 1);
  rig.writer.flush_within(1000 * kMsNs);
  CHECK(rig.device.writes == 0);
  CHECK_FALSE(rig.writer.has_failed());
  rig.open();
  rig.device.refuses_writes = true;
  rig.send(GatedForce(), 2);
  rig.writer.flush_within(1000 * kMsNs);
  CHECK(rig.writer.has_failed());
  rig.device.refuses_writes = false;
  rig.send(GatedForce(), 3);
  rig.writer.flush_within(1000 * kMsNs);
  CHECK_FALSE(rig.writer.has_failed());
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
}

TEST_CASE("writer: a muted writer sends nothing, not even its safe stop") {
  Rig rig;
  rig.open();
  Running writer([&] { rig.writer.run(); });
  rig.send(gated_force(), 1);
  rig.writer.flush_within(1000 * kMsNs);
  const std::uint32_t next = rig.writer.mute();
  CHECK(next > rig.device.sequence);
  const std::uint64_t writes = rig.device.writes;
  rig.send(gated_force(), 2);
  rig.writer.request_stop();
  CHECK(writer.ends_within_ms(1000));
  CHECK(rig.device.writes == writes);
}

TEST_CASE("a tick drains to the newest report and counts the others") {
  Rig rig;
  rig.open();
  rig.device.burst = 10;
  rig.servo.tick();
  rig.device.burst = 100;  // more than one tick drains
  rig.servo.tick();
  rig.servo.tick();
  sleep_ms(25);
  rig.servo.tick();
  DeviceStatus status;
  REQUIRE(rig.servo.take_status(&status));
  CHECK(status.counters.superseded == 9 + 63 + 35);
  CHECK(status.counters.ticks == 4);
  CHECK(status.counters.lost == 0);
}

TEST_CASE("servo loop: a report that is too long is refused") {
  for (const int excess : {1, 100, 111, 112, 1000}) {
    Rig rig;
    rig.open();
    rig.device.excess = excess;
    rig.device.burst = 5;
    rig.servo.tick();
    sleep_ms(25);
    rig.device.excess = 0;
    rig.servo.tick();
    DeviceStatus status;
    REQUIRE(rig.servo.take_status(&status));
    CHECK(status.counters.rejected[static_cast<int>(Verdict::kLength)] == 5);
  }
}

TEST_CASE("servo loop: a loss is signalled once, after zero force, and the device is not read until reopened") {
  Rig rig;
  rig.open();
  rig.servo.tick();
  CHECK_FALSE(rig.lost.wait(0));
  rig.device.is_plugged = false;
  rig.servo.tick();
  CHECK(rig.lost.wait(0));
  CHECK(rig.servo.lost_opening() == 1);
  const std::uint64_t reads = rig.device.reads, before_ns = monotonic_ns();
  for (int i = 0; i < 20; ++i)
    rig.servo.tick();
  CHECK(rig.device.reads == reads);
  CHECK(monotonic_ns() - before_ns >= 20 * kMsNs);  // asleep, not spinning
  CHECK_FALSE(rig.lost.wait(0));
  DeviceStatus status;
  REQUIRE(rig.servo.take_status(&status));
  CHECK(status.connection == Connection::kAbsent);
  CHECK(status.last.fault == Fault::kCommanded);

  rig.link.close();
  rig.transport.close();
  rig.device.is_plugged = true;
  rig.open();
  sleep_ms(25);
  rig.servo.tick();
  REQUIRE(rig.servo.take_status(&status));
  CHECK(status.connection == Connection::kOpen);
  CHECK(status.opened == 2);
  CHECK(status.counters.lost == 0);  // the sequence begins anew
  CHECK(rig.device.misused == 0);
}
