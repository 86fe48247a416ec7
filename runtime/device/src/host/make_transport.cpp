// SPDX-License-Identifier: Apache-2.0
#include "host/make_transport.hpp"

#include "recording/recorded_transport.hpp"
#include "transport/plugin_transport.hpp"
#include "transport/transports.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_hid_transport(const DeviceConfig& config, const LoopConfig& loop) {
  return make_hid_transport(config.profile, {config.serial, config.path, loop.backend, loop.servo_priority});
}

std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop) {
  if (config.source == DeviceSource::kHid) return make_hid_transport(config, loop);
  if (config.source == DeviceSource::kSimulated) return make_simulated_transport(config.simulation);
  if (config.source == DeviceSource::kSerial) return make_serial_transport(config.profile, config.serial_access);
  if (config.source == DeviceSource::kPlugin)
    return make_plugin_transport(config.profile, config.plugin, config.plugin_settings);
  return make_recorded_transport(config);
}

}  // namespace fdcg::dev
