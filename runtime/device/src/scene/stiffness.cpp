// SPDX-License-Identifier: Apache-2.0
#include "scene/stiffness.hpp"

#include <algorithm>

#include "scene/scene_effects_build.hpp"
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

void warn_of_relief(const DeviceConfig& device, const ObjectConfig& object, const fdcg_relief& relief,
                    std::vector<std::string>* warnings) {
  const double allowed_n_per_m = device.profile.limits.stiffness_n_per_m;
  if (allowed_n_per_m <= 0) return;
  const double load_n = device.most_force_n > 0 ? device.most_force_n : device.profile.limits.force_n;
  const double felt = fdcg_get_relief_stiffness(&relief, load_n) * device.mapping.scale;
  if (felt <= allowed_n_per_m) return;
  warnings->push_back("device " + in_quotes(device.name) + ": the relief of object " + in_quotes(object.name) +
                      " is felt along the surface as " + shown_number(felt) + " N/m at the device's force limit of " +
                      shown_number(load_n) + " N; the profile allows " + shown_number(allowed_n_per_m) +
                      ": it may buzz; make it lower, or its waves longer");
}

void warn_of_image_reliefs(const HostConfig& config, const SceneGraphs& graphs, std::vector<std::string>* warnings) {
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const ObjectConfig& object = config.objects[i];
    fdcg_heights heights;
    if (!object.relief || object.relief->kind != ReliefKind::kImage) continue;
    if (!heights_of(graphs.of_object(i), object.pose.scale, &heights).empty()) continue;  // the scene is refused for it
    const fdcg_relief relief = fdcg_make_height_relief(&heights);
    for (const DeviceConfig& device : config.devices)
      warn_of_relief(device, object, relief, warnings);
  }
}

}  // namespace fdcg::dev
