// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of devices that share one.
#pragma once

#include <string>
#include <vector>

#include "catch.hpp"
#include "plain_profile.hpp"
#include "scene/scene_json.hpp"

namespace fdcg::test {

constexpr double kHalf_m = 0.02, kMass_kg = 0.1;

// A box of 4 cm about the origin, 0.1 kg, nothing below it; devices with one contact each at their tips.
inline dev::HostConfig config_of(const std::vector<double>& rates_hz) {
  using namespace dev;
  HostConfig config;
  config.scene_file = "shared_test";
  ObjectConfig box;
  box.name = "box";
  box.is_surface = true;
  box.surface = fdcg_make_box(kHalf_m, kHalf_m, kHalf_m);
  box.pose = fdcg_make_identity_pose();
  box.params = fdcg_make_params();
  box.params.mu_static = 0.8;
  box.params.mu_dynamic = 0.6;
  box.params.damping_n_s_per_m = 2;
  box.motion.kind = MotionKind::kBody;
  box.motion.body.mass_kg = kMass_kg;
  config.objects.push_back(box);
  for (const double rate_hz : rates_hz) {
    DeviceConfig device;
    device.name = "device " + std::to_string(config.devices.size());
    device.profile = plain_profile();
    device.profile.rate_hz = rate_hz;
    device.pads_m[0] = 0.005;
    config.devices.push_back(device);
  }
  config.is_shared = true;
  return config;
}

// Two simulated devices lift a cube, turn it and put it down.
inline dev::HostConfig example() {
  dev::HostConfig config;
  REQUIRE(dev::read_scene(FDCG_SOURCE_DIR "/testdata/scenes/two_devices.json", &config) == "");
  return config;
}

}  // namespace fdcg::test
