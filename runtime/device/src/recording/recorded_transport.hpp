// SPDX-License-Identifier: Apache-2.0
// A device of a session's log as a transport: DeviceConfig::recording names the log.
#pragma once

#include <memory>

#include "scene/host_config.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_recorded_transport(const DeviceConfig& config);

}  // namespace fdcg::dev
