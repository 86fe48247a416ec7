// SPDX-License-Identifier: Apache-2.0
// A scene's devices as transports.
#pragma once

#include <memory>

#include "scene/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_hid_transport(const DeviceConfig& config, const LoopConfig& loop);

// Whichever config.source says.
std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop);

}  // namespace fdcg::dev
