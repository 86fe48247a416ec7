// SPDX-License-Identifier: Apache-2.0
// Force Dimension's devices (omega, delta, sigma, lambda) and the Novint Falcon by their DHD library (Force Dimension SDK 3.17:
// dhdc.h, libdhd), which the maker provides. The library's own watchdog is set where the device has one.
//
// settings: {"device": 0, "rate_hz": 1000}; both may be left out. device: the number of one that no program has opened.
#include <dhdc.h>

#include "polled_device.hpp"

namespace fdcg::plugin {
namespace {

constexpr unsigned char kWatchdog = 20;  // units of 125 us

class ForceDimension final : public PolledDevice {
 public:
  explicit ForceDimension(const Settings& settings)
      : PolledDevice(settings.number("rate_hz", 1000, 1, 8000)),
        number_(static_cast<char>(settings.number("device", 0, 0, 15))) {}

 private:
  std::string connect() override {
    if (dhdGetDeviceCount() <= 0) return "no Force Dimension device is there; plug it in, switch it on";
    id_ = dhdOpenID(number_);
    if (id_ < 0) return "device " + std::to_string(int{number_}) + " cannot be opened: " + dhdErrorGetLastStr();
    if (dhdEnableForce(DHD_ON, static_cast<char>(id_)) < 0) {
      const std::string problem = std::string("it gives no force: ") + dhdErrorGetLastStr();
      disconnect();
      return problem;
    }
    dhdSetWatchdog(kWatchdog, static_cast<char>(id_));  // not every device has one
    return {};
  }
  void disconnect() override {
    if (id_ < 0) return;
    dhdSetForce(0, 0, 0, static_cast<char>(id_));
    dhdClose(static_cast<char>(id_));
    id_ = -1;
  }
  bool exchange(const fdcg_transport_force& force, fdcg_transport_sample* sample) override {
    const auto id = static_cast<char>(id_);
    const double* const f = force.force_n;
    double* const p = sample->position_m;
    if (dhdGetPosition(&p[0], &p[1], &p[2], id) < 0 || dhdSetForce(f[0], f[1], f[2], id) < 0) return false;
    sample->buttons = dhdGetButtonMask(id);
    return true;
  }

  const char number_;
  int id_ = -1;
};

}  // namespace
}  // namespace fdcg::plugin

extern "C" int fdcg_transport_create(std::uint32_t abi, const char* settings, fdcg_transport* transport,
                                     fdcg_host_message* why) {
  return fdcg::plugin::create_device<fdcg::plugin::ForceDimension>(abi, settings, {"device", "rate_hz"}, transport, why);
}
