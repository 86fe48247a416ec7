// SPDX-License-Identifier: Apache-2.0
// The whole host, on devices in memory: start, forces, faults of devices, and zero force at the end.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "catch.hpp"
#include "device_c11.h"
#include "hosted.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

TEST_CASE("host: repeated start and stop close every device") {
  for (int round = 0; round < 20; ++round) {
    Hosted hosted(round % 3 + 1);
    hosted.start();
    CHECK(hosted.host.stop() == "");
    CHECK(hosted.host.stop() == "");
    for (const auto& device : hosted.devices) {
      CHECK(device->closed == device->opened);
      CHECK(device->safe_stops == 1);
      CHECK(device->force_n == 0);
      CHECK(device->misused == 0);
    }
  }
}

TEST_CASE("host: destruction without a stop leaves zero force") {
  FakeDevice device;
  {
    Host host([&](const DeviceConfig&, const LoopConfig&) { return std::make_unique<FakeTransport>(device); });
    REQUIRE(host.open(fake_config(cube_file())) == "");
    REQUIRE(host.start() == "");
    REQUIRE(within_ms(5000, [&] { return device.echo > 2; }));
  }
  CHECK(device.safe_stops == 1);
  CHECK_FALSE(device.is_open);
}

TEST_CASE("host: a press gives force, and a stop removes it") {
  Hosted hosted;
  hosted.start();
  CHECK(hosted.fault() == Fault::kCommanded);
  hosted.press();
  CHECK(hosted.device().is_enabled);
  CHECK(hosted.device().force_n == Approx(2).margin(0.1));
  CHECK(within_ms(1000, [&] { return hosted.host.status(0).last.state == FDCG_FACE; }));
  const std::uint64_t before_ns = monotonic_ns();
  CHECK(hosted.host.stop() == "");
  CHECK(monotonic_ns() - before_ns < 1'000'000'000);
  CHECK(hosted.device().force_n == 0);
  CHECK_FALSE(hosted.device().is_enabled);
  CHECK(hosted.device().safe_stops == 1);
  const DeviceStatus status = hosted.host.status(0);
  CHECK(status.writes == hosted.device().writes);
  CHECK(status.write.total == status.writes);
  CHECK(status.interval.total > 100);
  CHECK(status.work.total > status.interval.total);
}

TEST_CASE("host: a disarm removes the force, and arming ramps it up from zero") {
  Hosted hosted;
  hosted.start();
  hosted.press();
  hosted.host.disarm(kAllDevices);
  CHECK(within_ms(1000, [&] { return hosted.device().force_n == 0; }));
  CHECK(within_ms(1000, [&] { return hosted.phase() == Phase::kDisarmed; }));
  sleep_ms(50);
  CHECK(hosted.device().force_n == 0);
  hosted.host.arm(0);  // pressed against the cube: refused
  sleep_ms(50);
  CHECK(hosted.device().force_n == 0);
  hosted.press();
}

TEST_CASE("host: an unplugged device is closed and reopened when back, without force until armed") {
  Hosted hosted;
  hosted.start();
  for (int round = 1; round <= 5; ++round) {
    if (round == 1) hosted.press();
    hosted.device().is_plugged = false;
    REQUIRE(within_ms(5000, [&] { return !hosted.device().is_open; }));
    REQUIRE(within_ms(5000, [&] { return hosted.host.connection(0).problem == "not plugged in"; }));
    CHECK(within_ms(1000, [&] { return hosted.host.status(0).connection == Connection::kAbsent; }));
    if (round == 1) CHECK(hosted.fault() == Fault::kReadFailed);
    hosted.device().is_plugged = true;
    REQUIRE(within_ms(5000, [&] { return hosted.device().opened == round + 1; }));
    REQUIRE(within_ms(5000, [&] { return hosted.host.status(0).opened == static_cast<std::uint64_t>(round) + 1; }));
    CHECK(hosted.host.connection(0).problem == "");
    sleep_ms(20);
    CHECK(hosted.device().force_n == 0);
    CHECK_FALSE(hosted.device().is_enabled);
  }
  hosted.press();
  CHECK(hosted.host.stop() == "");
  CHECK(hosted.device().misused == 0);
  CHECK(hosted.device().closed == hosted.device().opened);
}

TEST_CASE("host: a device missing at the start is opened when it appears") {
  Hosted hosted(2);
  hosted.device(1).is_plugged = false;
  hosted.start();
  CHECK(within_ms(2000, [&] { return hosted.host.connection(1).problem == "not plugged in"; }));
  CHECK(hosted.host.connection(0).connection == Connection::kOpen);
  hosted.press(0);
  hosted.device(1).is_plugged = true;
  CHECK(within_ms(5000, [&] { return hosted.host.connection(1).connection == Connection::kOpen; }));
  hosted.press(1);
  CHECK(hosted.host.stop() == "");
}

TEST_CASE("host: a silent device gets zero force and is disarmed") {
  Hosted hosted;
  hosted.start();
  hosted.press();
  hosted.device().is_silent = true;
  const std::uint64_t silent_ns = monotonic_ns();
  REQUIRE(within_ms(2000, [&] { return hosted.device().force_n == 0; }));
  WARN("zero after " << static_cast<double>(monotonic_ns() - silent_ns) * 1e-6 << " ms of silence");
  CHECK(within_ms(1000, [&] { return hosted.phase() == Phase::kDisarmed; }));
}

TEST_CASE("host: a blocked write does not block the servo loop, disarms, and zero force is sent first afterwards") {
  int ends[2];
  REQUIRE(pipe2(ends, O_NONBLOCK | O_DIRECT) == 0);  // one report at a time: on a busy machine there may be an earlier zero
  Hosted hosted;
  hosted.device().emergency = ends[1];
  hosted.start();
  hosted.press();
  hosted.device().holds_writes = true;
  CHECK(within_ms(2000, [&] { return hosted.phase() == Phase::kDisarmed; }));
  std::uint8_t report[kMaxReportBytes];  // of a third thread, should the device take that
  ssize_t bytes = -1;
  CHECK(within_ms(2000, [&] { return (bytes = read(ends[0], report, sizeof report)) > 0; }));
  Command zero;
  REQUIRE(decode_output(fake_profile(), report, static_cast<int>(bytes), &zero));
  CHECK_FALSE(zero.is_enabled);
  CHECK((hosted.fault() == Fault::kWriterStuck || hosted.fault() == Fault::kHostLate));
  const std::uint64_t ticks = hosted.host.status(0).counters.ticks;
  CHECK(within_ms(2000, [&] { return hosted.host.status(0).counters.ticks > ticks + 50; }));
  hosted.device().holds_writes = false;
  CHECK(within_ms(1000, [&] { return hosted.device().force_n == 0; }));
  hosted.device().emergency = -1;
  CHECK(hosted.host.stop() == "");
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("host: stops within 6 s although a device takes no output", "[slow]") {
  auto device = std::make_unique<FakeDevice>();
  {
    Hosted hosted;
    hosted.devices[0].swap(device);
    hosted.start();
    hosted.press();
    hosted.device().holds_writes = true;
    REQUIRE(within_ms(1000, [&] { return hosted.device().inside_writes == 1; }));
    const std::uint64_t before_ns = monotonic_ns();
    const std::string problem = hosted.host.stop();
    CHECK(static_cast<double>(monotonic_ns() - before_ns) * 1e-9 < Host::kStopS);
    CHECK(problem.find("takes no output") != std::string::npos);
    CHECK(hosted.device().closed == 0);  // somebody is inside
    hosted.devices[0].swap(device);
  }
  // The detached thread still uses the data that it keeps alive, although the host is destroyed.
  device->holds_writes = false;
  CHECK(within_ms(5000, [&] { return device->inside_writes == 0; }));
  sleep_ms(50);
  CHECK(device->misused == 0);
}

TEST_CASE("host: a refused last zero force is reported") {
  Hosted hosted;
  hosted.start();
  hosted.device().refuses_writes = true;
  CHECK(hosted.host.stop().find("may not have got its zero force") != std::string::npos);
  CHECK_FALSE(hosted.device().is_open);

  Hosted gone;
  gone.start();
  gone.device().is_plugged = false;
  REQUIRE(within_ms(5000, [&] { return !gone.device().is_open; }));
  CHECK(gone.host.stop() == "");
}

TEST_CASE("host: a blocked read leaves no force, and the host still stops", "[slow]") {
  auto device = std::make_unique<FakeDevice>();
  {
    Hosted hosted;
    hosted.devices[0].swap(device);
    hosted.start();
    hosted.press();
    hosted.device().holds_reads = true;
    const std::uint64_t held_ns = monotonic_ns();
    REQUIRE(within_ms(2000, [&] { return hosted.device().force_n == 0; }));
    WARN("zero " << static_cast<double>(monotonic_ns() - held_ns) * 1e-6 << " ms after the reader hung");
    const std::uint64_t before_ns = monotonic_ns();
    const std::string problem = hosted.host.stop();
    CHECK(static_cast<double>(monotonic_ns() - before_ns) * 1e-9 < Host::kStopS);
    CHECK(problem.find("does not return") != std::string::npos);
    CHECK(hosted.device().safe_stops == 1);
    hosted.devices[0].swap(device);
  }
  device->holds_reads = false;
  CHECK(within_ms(5000, [&] { return device->inside_reads == 0; }));
  sleep_ms(50);
  CHECK(device->misused == 0);
}

// One of the host's threads did not run for some milliseconds.
bool is_of_a_busy_machine(Fault fault) {
  return fault == Fault::kHostLate || fault == Fault::kWriterStuck;
}

TEST_CASE("shared scene: a silent or unplugged device does not affect the others' forces") {
  Hosted hosted(3);
  hosted.share();
  hosted.start();
  for (int i = 0; i < 3; ++i)
    hosted.press(i);
  for (const int dead : {0, 2}) {  // 0 is the clock
    INFO(dead);
    hosted.device(dead).is_silent = true;
    CHECK(within_ms(2000, [&] { return hosted.device(dead).force_n == 0 && hosted.phase(dead) == Phase::kDisarmed; }));
    // a busy machine may have been late before
    INFO("fault " << static_cast<int>(hosted.fault(dead)));
    CHECK((hosted.fault(dead) == Fault::kSilence || is_of_a_busy_machine(hosted.fault(dead))));
    hosted.press(1);  // at once, where the machine is not too busy
    hosted.device(dead).is_silent = false;
    hosted.device(dead).is_plugged = false;
    REQUIRE(within_ms(5000, [&] { return !hosted.device(dead).is_open; }));
    hosted.press(1);
    hosted.device(dead).is_plugged = true;
    REQUIRE(within_ms(5000, [&] { return hosted.device(dead).is_open.load(); }));
    hosted.press(dead);
    if (is_of_a_busy_machine(hosted.fault(1))) hosted.press(1);
    CHECK(hosted.device(1).force_n > 1.5);
  }
  CHECK(hosted.host.stop() == "");
  for (int i = 0; i < 3; ++i) {
    CHECK(hosted.device(i).force_n == 0);
    CHECK(hosted.device(i).misused == 0);
  }
}

TEST_CASE("shared scene: a blocked read removes the force of all devices until it returns") {
  Hosted hosted(2);
  hosted.share();
  hosted.start();
  hosted.press(0);
  hosted.press(1);
  hosted.device(1).holds_reads = true;
  CHECK(within_ms(2000, [&] { return hosted.device(0).force_n == 0 && hosted.device(1).force_n == 0; }));
  hosted.device(1).holds_reads = false;
  hosted.press(0);
  hosted.press(1);
  CHECK(hosted.host.stop() == "");
  CHECK(hosted.device(0).misused + hosted.device(1).misused == 0);
}

TEST_CASE("host: spinning and driven objects have their pose for every device") {
  Hosted hosted(2);
  hosted.config.objects[0].motion.kind = MotionKind::kDriven;
  hosted.start();
  hosted.press(0);
  fdcg_pose away = fdcg_make_identity_pose();
  away.translation_m[2] = -0.05;
  CHECK(hosted.host.set_pose("cube", away) == "");
  CHECK(within_ms(1000, [&] { return hosted.device(0).force_n == 0; }));
  CHECK(hosted.host.set_pose("ball", away).find("'ball'") != std::string::npos);
  CHECK(hosted.host.stop() == "");

  Hosted fixed;
  fixed.start();
  CHECK(fixed.host.set_pose("cube", away).find("driven") != std::string::npos);
}

TEST_CASE("host: a stop request ends the wait at once, from any thread or signal") {
  Hosted hosted;
  hosted.start();
  CHECK_FALSE(hosted.host.wait_ms(10));
  const std::uint64_t before_ns = monotonic_ns();
  Thread other;
  REQUIRE(other
              .start("stopper",
                     [&] {
                       sleep_ms(20);
                       hosted.host.request_stop();
                     })
              .empty());
  CHECK(hosted.host.wait_ms(20'000));
  CHECK(monotonic_ns() - before_ns < 5'000'000'000);
  CHECK(hosted.host.is_stopping());
  CHECK(hosted.host.wait_ms(20'000));
  CHECK(other.join_within(1'000'000'000));
}

TEST_CASE("host: an invalid scene is refused with its reason") {
  Host host;
  HostConfig config = fake_config("no_such_file.fdcg");
  CHECK(host.open(config).find("no_such_file.fdcg") != std::string::npos);
  CHECK(host.start() == "no scene is open");
  FakeDevice device;
  Host other([&](const DeviceConfig&, const LoopConfig&) { return std::make_unique<FakeTransport>(device); });
  REQUIRE(other.open(fake_config("")) == "");
  REQUIRE(other.start() == "");
  CHECK(other.start() == "the host is running already");
  CHECK(other.open(fake_config("")).find("stop it first") != std::string::npos);
  CHECK(other.stop() == "");
  CHECK(other.start() == "the host has stopped; open the scene again");
  REQUIRE(other.open(fake_config("")) == "");
  CHECK(other.start() == "");
  config = fake_config("");
  config.devices.clear();
  CHECK(host.open(config).find("devices") != std::string::npos);
  config.devices.assign(kMaxDevices + 1, fake_config("").devices[0]);
  CHECK(host.open(config).find("at most 16") != std::string::npos);
}

TEST_CASE("the C API refuses invalid arguments with the reason") {
  CHECK(refuses_from_c() == 0);
}

TEST_CASE("a C program runs a host") {
  const std::string scene = R"({"fdcg_scene": 1,
    "objects": [{"name": "cube", "file": ")" +
                            cube_file() + R"(", "motion": {"kind": "driven"}}],
    "devices": [{"name": "toy", "source": "simulated", "mapping": {"offset_m": [0, 0, 5]}}],
    "loop": {"servo_priority": 80, "writer_priority": 70, "lock_memory": false}})";
  CHECK(runs_from_c(scene.c_str(), "cube") == 0);
}
