// SPDX-License-Identifier: Apache-2.0
// The Novint Falcon by libnifalcon, an open driver (libnifalcon 1.1: falcon/core/FalconDevice.h). It loads the device's
// firmware where that is not done; the handle must be pulled out and pushed in once before places mean anything, and until then
// there is no force. z is counted from the middle of its travel.
//
// settings: {"device": 0, "rate_hz": 1000}; both may be left out.
#include <falcon/core/FalconDevice.h>
#include <falcon/firmware/FalconFirmwareNovintSDK.h>
#include <falcon/grip/FalconGripFourButton.h>
#include <falcon/kinematic/FalconKinematicStamper.h>
#include <falcon/util/FalconFirmwareBinaryNvent.h>

#include "polled_device.hpp"

namespace fdcg::plugin {
namespace {

using namespace libnifalcon;

constexpr double kMiddle_m = 0.125;  // of z
constexpr int kTries = 10;           // to load the firmware

class NovintFalcon final : public PolledDevice {
 public:
  explicit NovintFalcon(const Settings& settings)
      : PolledDevice(settings.number("rate_hz", 1000, 1, 1000)),
        number_(static_cast<unsigned>(settings.number("device", 0, 0, 15))) {
    falcon_.setFalconFirmware<FalconFirmwareNovintSDK>();
    falcon_.setFalconKinematic<FalconKinematicStamper>();
    falcon_.setFalconGrip<FalconGripFourButton>();
  }

 private:
  std::string connect() override {
    unsigned count = 0;
    if (!falcon_.getDeviceCount(count) || count <= number_) return "no Falcon is there; plug it in and switch it on";
    if (!falcon_.open(number_))
      return "the Falcon cannot be opened; may this user open USB devices, and is no other program using it?";
    for (int i = 0; i < kTries && !falcon_.isFirmwareLoaded(); ++i)
      falcon_.getFalconFirmware()->loadFirmware(true, NOVINT_FALCON_NVENT_FIRMWARE_SIZE,
                                                const_cast<std::uint8_t*>(NOVINT_FALCON_NVENT_FIRMWARE));
    if (!falcon_.isFirmwareLoaded()) {
      falcon_.close();
      return "the Falcon takes no firmware; unplug it and plug it in again";
    }
    falcon_.getFalconFirmware()->setHomingMode(true);
    return {};
  }
  void disconnect() override {
    send({});
    falcon_.close();
  }
  bool exchange(const fdcg_transport_force& force, fdcg_transport_sample* sample) override {
    if (!send(force)) return false;
    const auto place = falcon_.getPosition();
    for (int i = 0; i < 3; ++i)
      sample->position_m[i] = place[static_cast<std::size_t>(i)] - (i == 2 ? kMiddle_m : 0);
    sample->buttons = falcon_.getFalconGrip()->getDigitalInputs();
    if (!falcon_.getFalconFirmware()->isHomed()) sample->flags |= FDCG_TRANSPORT_FAULT;
    return true;
  }
  bool send(const fdcg_transport_force& force) {
    auto vector = falcon_.getPosition();  // of the library's own type of three numbers
    for (std::size_t i = 0; i < 3; ++i)
      vector[i] = force.force_n[i];
    falcon_.setForce(vector);
    return falcon_.runIOLoop();
  }

  FalconDevice falcon_;
  const unsigned number_;
};

}  // namespace
}  // namespace fdcg::plugin

extern "C" int fdcg_transport_create(std::uint32_t abi, const char* settings, fdcg_transport* transport,
                                     fdcg_host_message* why) {
  return fdcg::plugin::create_device<fdcg::plugin::NovintFalcon>(abi, settings, {"device", "rate_hz"}, transport, why);
}
