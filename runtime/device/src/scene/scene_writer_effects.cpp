// SPDX-License-Identifier: Apache-2.0
// scene_json_effects.cpp's other direction: every number written out, textures in place.
#include "scene/scene_writer_effects.hpp"

namespace fdcg::dev {
namespace {

Json texture_json(const TextureConfig& texture) {
  Json json = {{"fdcg_texture", 1}, {"rate_hz", texture.rate_hz}, {"models", Json::array()}};
  for (std::size_t i = 0; i < texture.models.size(); ++i) {
    json["models"].push_back({{"speed_m_per_s", texture.speed_m_per_s[i / texture.force_n.size()]},
                              {"force_n", texture.force_n[i % texture.force_n.size()]},
                              {"coefficients", texture.models[i].coefficients},
                              {"variance", texture.models[i].variance}});
  }
  return json;
}

void add_own(const EffectConfig& config, Json* json) {
  const fdcg_effect& effect = config.effect;
  switch (effect.kind) {
    case FDCG_EFFECT_MAGNET:
      (*json)["distance_m"] = effect.distance_m;
      break;
    case FDCG_EFFECT_VISCOSITY:
      (*json)["viscosity_n_s_per_m"] = effect.viscosity_n_s_per_m;
      break;
    case FDCG_EFFECT_STICK_SLIP:
      (*json)["stiffness_n_per_m"] = effect.stiffness_n_per_m;
      break;
    case FDCG_EFFECT_VIBRATION:
      (*json)["frequency_hz"] = effect.frequency_hz;
      break;
    case FDCG_EFFECT_NOISE:
      (*json)["low_hz"] = effect.low_hz;
      (*json)["high_hz"] = effect.frequency_hz;
      (*json)["seed"] = effect.seed;
      break;
    case FDCG_EFFECT_TAP:
      (*json)["impact_n_s_per_m"] = effect.impact_n_s_per_m;
      (*json)["frequency_hz"] = effect.frequency_hz;
      (*json)["decay_s"] = effect.decay_s;
      break;
    case FDCG_EFFECT_PULSE:
      (*json)["duration_s"] = effect.duration_s;
      (*json)["period_s"] = effect.period_s;
      break;
    default:
      (*json)["mass_kg"] = effect.mass_kg;
      (*json)["seed"] = effect.seed;
      (*json)["texture"] = texture_json(*config.texture);
  }
}

Json effect_json(const EffectConfig& config) {
  constexpr const char* kKindNames[] = {"",      "magnet", "viscosity", "stick-slip", "vibration",
                                        "noise", "tap",    "pulse",     "texture"};
  constexpr const char* kWhen[] = {"touching", "slipping", "always"};
  constexpr const char* kAlong[] = {"normal", "motion", "axis"};
  const fdcg_effect& effect = config.effect;
  Json json = {{"kind", kKindNames[effect.kind]}, {"when", kWhen[effect.when]}, {"along", kAlong[effect.along]}};
  if (effect.along == FDCG_ALONG_AXIS) json["axis"] = list(effect.axis);
  if (!config.material.empty()) json["material"] = config.material;
  if (effect.region != FDCG_EVERYWHERE) json["region"]["center_m"] = list(effect.region_m);
  if (effect.region == FDCG_IN_BALL) json["region"]["radius_m"] = effect.region_half_m[0];
  if (effect.region == FDCG_IN_BOX) json["region"]["half_m"] = list(effect.region_half_m);
  if (effect.is_off != 0) json["off"] = true;
  json["force_n"] = effect.force_n;
  json["smoothing_s"] = effect.smoothing_s;
  json["ramp_s"] = effect.ramp_s;
  json["reserve_j"] = effect.reserve_j;
  json["power_w"] = effect.power_w;
  add_own(config, &json);
  return json;
}

}  // namespace

Json relief_json(const ReliefConfig& config) {
  constexpr const char* kReliefs[] = {"ridges", "bumps", "grain", "image"};
  Json json = {{"kind", kReliefs[static_cast<int>(config.kind)]}};
  if (config.kind == ReliefKind::kGrain) {
    json["rms_m"] = config.rms_m;
    json["shortest_m"] = config.shortest_m;
    json["longest_m"] = config.longest_m;
    json["exponent"] = config.exponent;
    json["seed"] = config.seed;
  } else if (config.kind != ReliefKind::kImage) {
    json["amplitude_m"] = config.amplitude_m;
    json["wavelength_m"] = config.wavelength_m;
  }
  if (config.kind == ReliefKind::kRidges) json["direction"] = list(config.direction);
  if (!config.material.empty()) json["material"] = config.material;
  if (config.relief.is_off != 0) json["off"] = true;
  json["reserve_j"] = config.relief.reserve_j;
  json["power_w"] = config.relief.power_w;
  return json;
}

Json effects_json(const std::vector<EffectConfig>& effects) {
  Json json = Json::array();
  for (const EffectConfig& effect : effects)
    json.push_back(effect_json(effect));
  return json;
}

}  // namespace fdcg::dev
