// SPDX-License-Identifier: Apache-2.0
// Devices of others (fdcg/transport.h) as a Transport: their samples become the reports of a profile of our own, and its output
// reports their forces. So judge, gate, log and replay know of no difference.
#pragma once

#include <memory>
#include <string>

#include "fdcg/transport.h"
#include "profile/profile.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

// How such a device's samples are written down: lengths in nanometres, times in microseconds.
Profile plugin_profile(double rate_hz, const DeviceLimits& limits);

class PluginTransport : public Transport {
 public:
  // The table that a program hands over, before the first opening.
  virtual void set(const fdcg_transport& transport) = 0;
  // The file may be loaded: it is code.
  virtual void allow() = 0;
};

// file: empty where a program hands the table over. settings: JSON. The file is loaded at the first opening.
std::unique_ptr<PluginTransport> make_plugin_transport(const Profile& profile, const std::string& file,
                                                       const std::string& settings);

}  // namespace fdcg::dev
