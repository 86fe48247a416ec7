// SPDX-License-Identifier: Apache-2.0
// The parts of a host around one device, each of which a test drives by itself.
#pragma once

#include <functional>

#include "catch.hpp"
#include "host/servo_loop.hpp"
#include "host/writer.hpp"
#include "hosted.hpp"
#include "scene/scene_build.hpp"
#include "spent_time.hpp"
#include "tick/link.hpp"

namespace fdcg::dev::test {

inline constexpr std::uint64_t kMsNs = 1'000'000;

// What the reader spends in there is kept apart.
class TimedReads final : public Transport {
 public:
  explicit TimedReads(Transport& real) : real_(real) {}
  std::string open() override { return real_.open(); }
  void close() override { real_.close(); }
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override {
    const std::int64_t before_ns = spent_ns();
    const ReadResult result = real_.read(data, capacity, timeout_ms);
    read_ns += spent_ns() - before_ns + clock_cost_ns;
    return result;
  }
  bool write(const std::uint8_t* data, int bytes) override { return real_.write(data, bytes); }
  bool write_feature(const std::uint8_t* data, int bytes) override { return real_.write_feature(data, bytes); }

  std::int64_t read_ns = 0, clock_cost_ns = 0;

 private:
  Transport& real_;
};

// A device, opened, and the parts of a host around it.
struct Rig {
  FakeDevice device;
  FakeTransport transport{device};
  TimedReads reads{transport};
  Profile profile = fake_profile();
  Link link;
  Writer writer{profile, transport, link};
  HostConfig config;
  SceneGraphs graphs;
  DeviceScene scene;
  Event lost;
  ServoLoop servo;

  explicit Rig(const std::string& file = "", LogRing* log = nullptr) : config(fake_config(file)) {
    REQUIRE(graphs.open(config).empty());
    REQUIRE(build_device_scene(config, {}, graphs, &scene).empty());
    ServoParts parts;
    parts.transport = &reads;
    parts.link = &link;
    parts.writer = &writer;
    parts.lost = &lost;
    parts.log = log;
    parts.start_ns = monotonic_ns();
    REQUIRE(servo.begin(scene.setups[0], parts, nullptr));
  }
  void send(const GatedForce& force, std::uint32_t echo) {
    writer.put(force, echo, monotonic_ns());
    writer.wake();
  }
  void open() {
    REQUIRE(transport.open().empty());
    link.open();
  }
};

struct Running {
  Thread thread;
  explicit Running(std::function<void()> body) { REQUIRE(thread.start("test", std::move(body)).empty()); }
  bool ends_within_ms(int ms) { return thread.join_within(static_cast<std::uint64_t>(ms) * kMsNs); }
};

}  // namespace fdcg::dev::test
