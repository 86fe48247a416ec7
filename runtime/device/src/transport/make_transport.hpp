// SPDX-License-Identifier: Apache-2.0
// Creates transports by their source. A transport does not access its device until it is opened.
#pragma once

#include <memory>

#include "base/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_hid_transport(const DeviceConfig& config, const LoopConfig& loop);
std::unique_ptr<Transport> make_simulated_transport(const DeviceConfig& config);
std::unique_ptr<Transport> make_recorded_transport(const DeviceConfig& config);

// The transport for config.source.
std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop);

}  // namespace fdcg::dev
