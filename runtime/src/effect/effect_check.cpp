// SPDX-License-Identifier: Apache-2.0
// Which effects are taken.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "effect/effect_motion.hpp"

namespace fdcg {
namespace {

constexpr double kMostOfEffect = 1e9, kLeastOfEffect = 1e-9, kMostEffectForce = 1000, kLongestEffect = 3600,
                 kAxisTolerance = 1e-3;

struct EffectRange {
  const char* field;
  double value, low, high;
};

fdcg_status check(const EffectRange* ranges, int count, fdcg_error* error) {
  for (int i = 0; i < count; ++i) {
    if (!(ranges[i].value >= ranges[i].low && ranges[i].value <= ranges[i].high))
      return refuse(error, ranges[i].field, ranges[i].value, ranges[i].low, ranges[i].high);
  }
  return FDCG_OK;
}

fdcg_status check_common(const fdcg_effect& effect, double tick_s, fdcg_error* error) {
  const bool has_end = effect.when == FDCG_WHEN_TRIGGERED;
  const EffectRange ranges[] = {{"effect.kind", double(effect.kind), 0, FDCG_EFFECT_TEXTURE},
                                {"effect.is_off", double(effect.is_off), 0, 1},
                                {"effect.when", double(effect.when), 0, FDCG_WHEN_TRIGGERED},
                                {"effect.along", double(effect.along), 0, FDCG_ALONG_AXIS},
                                {"effect.region", double(effect.region), 0, FDCG_IN_BOX},
                                {"effect.force_n", effect.force_n, kLeastOfEffect, kMostEffectForce},
                                {"effect.duration_s", has_end ? effect.duration_s : tick_s, tick_s, kLongestEffect},
                                {"effect.smoothing_s", effect.smoothing_s, 0, kLongestEffect},
                                {"effect.ramp_s", effect.ramp_s, 0, kLongestEffect},
                                {"effect.reserve_j", effect.reserve_j, kLeastOfEffect, kMostOfEffect},
                                {"effect.power_w", effect.power_w, 0, kMostOfEffect}};
  fdcg_status status = check(ranges, sizeof ranges / sizeof ranges[0], error);
  for (int k = 0; k < 3 && status == FDCG_OK && effect.region != FDCG_EVERYWHERE; ++k) {
    const bool is_read = effect.region == FDCG_IN_BOX || k == 0;
    const EffectRange of_region[] = {
        {"effect.region_m", effect.region_m[k], -kMostOfEffect, kMostOfEffect},
        {"effect.region_half_m", is_read ? effect.region_half_m[k] : 1, kLeastOfEffect, kMostOfEffect}};
    status = check(of_region, 2, error);
  }
  if (status != FDCG_OK || effect.along != FDCG_ALONG_AXIS) return status;
  const EffectRange axis = {"effect.axis's length", norm(vec(effect.axis)), 1 - kAxisTolerance, 1 + kAxisTolerance};
  return check(&axis, 1, error);
}

fdcg_status check_texture(const fdcg_texture& texture, double tick_s, fdcg_error* error) {
  constexpr uint32_t kMostModels = 1024;
  if (texture.speed_m_per_s == nullptr || texture.force_n == nullptr || texture.reflection == nullptr ||
      texture.deviation_m_per_s2 == nullptr) {
    return refuse(error, "effect.texture: a null pointer in it");
  }
  const EffectRange ranges[] = {{"texture.rate_hz times tick_s", texture.rate_hz * tick_s, kLeastOfEffect, 16},
                                {"texture.order", double(texture.order), 1, FDCG_TEXTURE_MAX_ORDER},
                                {"texture.speed_count", double(texture.speed_count), 1, kMostModels},
                                {"texture.force_count", double(texture.force_count), 1, kMostModels}};
  fdcg_status status = check(ranges, 4, error);
  const auto ascends = [&](const char* field, const double* axis, uint32_t count) {
    for (uint32_t i = 0; i < count && status == FDCG_OK; ++i) {
      const EffectRange range = {field, axis[i], i == 0 ? kLeastOfEffect : axis[i - 1] * (1 + kLeastOfEffect), kMostOfEffect};
      status = check(&range, 1, error);
    }
  };
  if (status == FDCG_OK) ascends("texture.speed_m_per_s", texture.speed_m_per_s, texture.speed_count);
  if (status == FDCG_OK) ascends("texture.force_n", texture.force_n, texture.force_count);
  const uint64_t cells = uint64_t{texture.speed_count} * texture.force_count;
  for (uint64_t i = 0; i < cells && status == FDCG_OK; ++i) {
    const EffectRange range = {"texture.deviation_m_per_s2", texture.deviation_m_per_s2[i], 0, kMostOfEffect};
    status = check(&range, 1, error);
  }
  for (uint64_t i = 0; i < cells * texture.order && status == FDCG_OK; ++i) {
    const EffectRange range = {"texture.reflection", texture.reflection[i], -1 + kLeastOfEffect, 1 - kLeastOfEffect};
    status = check(&range, 1, error);
  }
  return status;
}

fdcg_status check_kind(const fdcg_effect& effect, double tick_s, fdcg_error* error) {
  const double nyquist_hz = 0.5 / tick_s;
  const EffectRange magnet = {"effect.distance_m", effect.distance_m, kLeastOfEffect, kMostOfEffect},
                    viscosity = {"effect.viscosity_n_s_per_m", effect.viscosity_n_s_per_m, 0, kMostOfEffect},
                    stick_slip = {"effect.stiffness_n_per_m", effect.stiffness_n_per_m, kLeastOfEffect, kMostOfEffect},
                    tone = {"effect.frequency_hz", effect.frequency_hz, kLeastOfEffect, nyquist_hz * (1 - kLeastOfEffect)};
  const EffectRange noise[] = {tone, {"effect.low_hz", effect.low_hz, 0, effect.frequency_hz}};
  const EffectRange tap[] = {tone,
                             {"effect.impact_n_s_per_m", effect.impact_n_s_per_m, 0, kMostOfEffect},
                             {"effect.decay_s", effect.decay_s, kLeastOfEffect, kLongestEffect}};
  const bool repeats = effect.period_s != 0;
  const EffectRange pulse[] = {
      {"effect.duration_s", effect.duration_s, tick_s, kLongestEffect},
      {"effect.period_s", repeats ? effect.period_s : effect.duration_s, effect.duration_s, kLongestEffect}};
  const EffectRange mass = {"effect.mass_kg", effect.mass_kg, 0, kMostOfEffect};
  switch (effect.kind) {
    case FDCG_EFFECT_MAGNET:
      return check(&magnet, 1, error);
    case FDCG_EFFECT_VISCOSITY:
      return check(&viscosity, 1, error);
    case FDCG_EFFECT_STICK_SLIP:
      return check(&stick_slip, 1, error);
    case FDCG_EFFECT_VIBRATION:
      return check(&tone, 1, error);
    case FDCG_EFFECT_NOISE:
      return check(noise, 2, error);
    case FDCG_EFFECT_TAP:
      return check(tap, 3, error);
    case FDCG_EFFECT_PULSE:
      return check(pulse, 2, error);
    case FDCG_EFFECT_TEXTURE:
      if (effect.texture == nullptr) return refuse(error, "effect.texture: null pointer");
      if (const fdcg_status status = check(&mass, 1, error); status != FDCG_OK) return status;
      return check_texture(*effect.texture, tick_s, error);
    default:
      return FDCG_OK;
  }
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_check_effect(const fdcg_effect* effect, double tick_s, fdcg_error* error) {
  using namespace fdcg;
  if (effect == nullptr) return refuse(error, "effect: null pointer");
  if (effect->struct_bytes != sizeof *effect) {
    return check_struct_bytes(0, sizeof *effect, "effect", "; start from one of its makers", error);
  }
  if (!(tick_s >= kLeastOfEffect && tick_s <= kLongestEffect))
    return refuse(error, "tick_s", tick_s, kLeastOfEffect, kLongestEffect);
  if (effect->law == nullptr) return refuse(error, "effect.law: null pointer; start from one of its makers");
  const fdcg_status status = check_common(*effect, tick_s, error);
  return status == FDCG_OK ? check_kind(*effect, tick_s, error) : status;
}

extern "C" double fdcg_get_effect_stiffness(const fdcg_effect* effect, double tick_s) {
  constexpr double kMagnet = 6.75;  // the slope of its force at the surface
  if (effect == nullptr || !(tick_s > 0)) return 0;
  if (effect->kind == FDCG_EFFECT_MAGNET) return effect->distance_m > 0 ? kMagnet * effect->force_n / effect->distance_m : 0;
  if (effect->kind == FDCG_EFFECT_VISCOSITY) return 2 * effect->viscosity_n_s_per_m / tick_s;
  return effect->kind == FDCG_EFFECT_STICK_SLIP ? effect->stiffness_n_per_m : 0;
}
