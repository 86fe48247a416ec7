// SPDX-License-Identifier: Apache-2.0
// Creates the transports of a scene's devices. A transport does not access its device until it is opened.
#pragma once

#include <memory>

#include "scene/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_hid_transport(const DeviceConfig& config, const LoopConfig& loop);

// The transport for config.source.
std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop);

}  // namespace fdcg::dev
