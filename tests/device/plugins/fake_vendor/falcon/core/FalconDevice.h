// SPDX-License-Identifier: Apache-2.0
// The part of libnifalcon that the plugin uses, by its documented names and types, with a hand of our own behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "../../fake_hand.hpp"

namespace libnifalcon {

struct FalconFirmware {
  bool is_loaded = false;
  bool loadFirmware(bool, long, std::uint8_t*) { return is_loaded = true; }
  void setHomingMode(bool) {}
  bool isHomed() { return true; }
};
struct FalconGrip {
  unsigned int getDigitalInputs() { return 2; }
};

class FalconDevice {
 public:
  template <class Firmware>
  void setFalconFirmware() {
    firmware_ = std::make_shared<Firmware>();
  }
  template <class Kinematic>
  void setFalconKinematic() {}
  template <class Grip>
  void setFalconGrip() {
    grip_ = std::make_shared<Grip>();
  }
  bool getDeviceCount(unsigned int& count) {
    count = 1;
    return true;
  }
  bool open(unsigned int number) {
    hand_ = {};
    return is_open_ = number == 0;
  }
  void close() { is_open_ = false; }
  bool isFirmwareLoaded() { return firmware_->is_loaded; }
  bool runIOLoop() {
    hand_.push(force_.data());
    return is_open_;
  }
  void setForce(const std::array<double, 3>& force) { force_ = force; }
  std::array<double, 3> getPosition() { return {hand_.place_m[0], hand_.place_m[1], hand_.place_m[2] + 0.125}; }
  std::shared_ptr<FalconFirmware> getFalconFirmware() { return firmware_; }
  std::shared_ptr<FalconGrip> getFalconGrip() { return grip_; }

 private:
  std::shared_ptr<FalconFirmware> firmware_;
  std::shared_ptr<FalconGrip> grip_;
  fdcg::test::FakeHand hand_;
  std::array<double, 3> force_{};
  bool is_open_ = false;
};

}  // namespace libnifalcon
