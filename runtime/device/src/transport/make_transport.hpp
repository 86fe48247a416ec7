// SPDX-License-Identifier: Apache-2.0
// Transports by their source. Each says no word and touches no device until it is opened.
#pragma once

#include <memory>

#include "base/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_hid_transport(const DeviceConfig& config, const LoopConfig& loop);
std::unique_ptr<Transport> make_simulated_transport(const DeviceConfig& config);
std::unique_ptr<Transport> make_recorded_transport(const DeviceConfig& config);

// Whichever config.source says.
std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop);

}  // namespace fdcg::dev
