// SPDX-License-Identifier: Apache-2.0
// A host on devices in memory, over a cube.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "catch.hpp"
#include "fake_device.hpp"
#include "fdcg/bake.hpp"
#include "host/host.hpp"
#include "meshes.hpp"

namespace fdcg::dev::test {

// A graph in the folder for temporary files, of this process: tests run side by side.
class CubeFile {
 public:
  CubeFile() : path_(std::filesystem::temp_directory_path() / ("fdcg_host_test_" + std::to_string(getpid()) + ".fdcg")) {
    const auto compiled = fdcg::bake::compile(fdcg::test::cube(), {});
    REQUIRE(compiled);
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(compiled->bytes.data()), static_cast<std::streamsize>(compiled->bytes.size()));
  }
  ~CubeFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

inline std::string cube_file() {
  static const CubeFile file;
  return file.path();
}

inline constexpr std::uint64_t kPatienceNs = 60'000'000'000;  // for a machine that is busy with other things

// A host with devices of its own.
struct Hosted {
  std::vector<std::unique_ptr<FakeDevice>> devices;
  HostConfig config = fake_config(cube_file());
  std::size_t made = 0;
  Host host{[this](const DeviceConfig&, const LoopConfig&) { return std::make_unique<FakeTransport>(*devices[made++]); }};

  explicit Hosted(int count = 1) {
    for (int i = 0; i < count; ++i)
      devices.push_back(std::make_unique<FakeDevice>());
    config.loop.servo_priority = 80;  // where it is granted a busy machine is no matter
    config.loop.writer_priority = 70;
    while (static_cast<int>(config.devices.size()) < count)
      config.devices.push_back(config.devices[0]);
  }
  // All of them in one loop.
  void share() {
    config.is_shared = true;
    for (auto& device : devices)
      device->answers_polls = true;
  }
  void start() {
    REQUIRE(host.open(config) == "");
    REQUIRE(host.start() == "");
    for (auto& device : devices) {
      FakeDevice& one = *device;
      if (one.is_plugged) REQUIRE(within_ms(5000, [&] { return one.is_open && one.echo > 2; }));
    }
  }
  FakeDevice& device(int index = 0) { return *devices[static_cast<std::size_t>(index)]; }
  Phase phase(int index = 0) { return host.status(index).last.phase; }
  Fault fault(int index = 0) { return host.status(index).last.fault; }

  // A machine that is busy may be 10 ms late, which disarms: then once more.
  void press(int index = 0) {
    const std::uint64_t until_ns = monotonic_ns() + kPatienceNs;
    while (monotonic_ns() < until_ns) {
      device(index).tip_z_m = 0.01;
      sleep_ms(120);  // no hand taps faster: forces that swing so are calmed
      host.arm(index);
      sleep_ms(60);
      within_ms(3000, [&] { return phase(index) == Phase::kArmed || phase(index) == Phase::kDisarmed; });
      if (phase(index) != Phase::kArmed) continue;
      device(index).tip_z_m = -0.002;
      if (within_ms(500, [&] { return device(index).force_n > 1.5; })) return;
    }
    FAIL("no force in a minute: " << fault_text(fault(index)));
  }
};

}  // namespace fdcg::dev::test
