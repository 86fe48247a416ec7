// SPDX-License-Identifier: Apache-2.0
#include "scene/stiffness.hpp"

#include <algorithm>

#include "shared/text.hpp"

namespace fdcg::dev {

void warn_of_stiffness(const HostConfig& config, std::vector<std::string>* warnings) {
  constexpr double kNearlyBorne = 1 + 1e-9;
  for (const DeviceConfig& device : config.devices) {
    const bool is_simulated = device.source == DeviceSource::kSimulated;
    if (device.source == DeviceSource::kRecorded || !device.profile.has_output) continue;
    const double b = is_simulated ? device.simulation.damping_n_s_per_m : device.profile.limits.damping_n_s_per_m;
    for (const ObjectConfig& object : config.objects) {
      const double scale = device.mapping.scale, rate_hz = device.profile.rate_hz;
      const double felt = object.params.stiffness_n_per_m * scale, damping = object.params.damping_n_s_per_m * scale;
      const double borne = std::max(0.0, (b - damping) * 2 * rate_hz);
      if (b <= 0 || felt <= borne * kNearlyBorne) continue;
      warnings->push_back(
          "device " + in_quotes(device.name) + ": object " + in_quotes(object.name) + ": its stiffness is felt as " +
          shown_number(felt) + " N/m" + (damping > 0 ? " and its damping as " + shown_number(damping) + " N s/m" : "") +
          "; the device's own damping of " + shown_number(b) + " N s/m bears " + shown_number(borne) + " N/m at " +
          shown_number(rate_hz) + " Hz (K T / 2 + B <= b); beyond, it is the hand that keeps it from shaking");
    }
  }
}

}  // namespace fdcg::dev
