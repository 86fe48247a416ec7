// SPDX-License-Identifier: Apache-2.0
// Effects of a scene (fdcg/effect.h) and recorded textures.
#include <algorithm>
#include <cmath>

#include "scene/scene_parser.hpp"
#include "scene/stiffness.hpp"

namespace fdcg::dev {
namespace {

constexpr json::Keys kEffectKeys = {"kind", "notes",   "when",        "along",  "axis",      "material", "region",
                                    "off",  "force_n", "smoothing_s", "ramp_s", "reserve_j", "power_w"};
// By fdcg_effect_kind, from 1.
constexpr json::Keys kEffectKinds = {"magnet", "viscosity", "stick-slip", "vibration", "noise", "tap", "pulse", "texture"};
const std::vector<std::string> kKeysOfKind[] = {{"distance_m"},
                                                {"viscosity_n_s_per_m"},
                                                {"stiffness_n_per_m"},
                                                {"frequency_hz"},
                                                {"low_hz", "high_hz", "seed"},
                                                {"impact_n_s_per_m", "frequency_hz", "decay_s"},
                                                {"duration_s", "period_s"},
                                                {"texture", "mass_kg", "seed"}};
constexpr json::NumberRange kHertz = above_0(1e5, "Hz"), kLongTimes = from_0(3600, "s"), kForces = above_0(kMostForce, "N"),
                            kEnergies = above_0(1e6, "J");
constexpr int kMostPoints = 64;  // of each axis of a texture

fdcg_effect make_kind(const json::Value& from, int kind) {
  switch (kind) {
    case FDCG_EFFECT_MAGNET:
      return fdcg_make_magnet(from["force_n"].number(kForces), from["distance_m"].number(above_0(1e3, "m")));
    case FDCG_EFFECT_VISCOSITY:
      return fdcg_make_viscosity(from["viscosity_n_s_per_m"].number(from_0(1e6, "N s/m")));
    case FDCG_EFFECT_STICK_SLIP:
      return fdcg_make_stick_slip(from["stiffness_n_per_m"].number(above_0(1e6, "N/m")), from["force_n"].number(kForces));
    case FDCG_EFFECT_VIBRATION:
      return fdcg_make_vibration(from["force_n"].number(kForces), from["frequency_hz"].number(kHertz));
    case FDCG_EFFECT_NOISE:
      return fdcg_make_noise(from["force_n"].number(kForces), from["low_hz"].number_or(0, from_0(1e5, "Hz")),
                             from["high_hz"].number(kHertz));
    case FDCG_EFFECT_TAP:
      return fdcg_make_tap(from["impact_n_s_per_m"].number(from_0(1e6, "N s/m")), from["frequency_hz"].number(kHertz),
                           from["decay_s"].number(above_0(3600, "s")));
    case FDCG_EFFECT_PULSE:
      return fdcg_make_pulse(from["force_n"].number(kForces), from["duration_s"].number(above_0(3600, "s")),
                             from["period_s"].number_or(0, kLongTimes));
    default:
      return fdcg_make_texture(nullptr, from["mass_kg"].number_or(0.05, from_0(1e3, "kg")));
  }
}

void read_region(const json::Value& from, fdcg_effect* effect) {
  from.allow_only({"center_m", "radius_m", "half_m"});
  from["center_m"].numbers(effect->region_m, 3, kLengths);
  if (!from["radius_m"] && !from["half_m"]) from.fail("has neither radius_m nor half_m; give one of them");
  if (from["radius_m"] && from["half_m"]) from["half_m"].fail("stands beside radius_m; give one of them");
  if (from["half_m"]) {
    effect->region = FDCG_IN_BOX;
    from["half_m"].numbers(effect->region_half_m, 3, above_0(1e6, "m"));
  } else {
    effect->region = FDCG_IN_BALL;
    effect->region_half_m[0] = from["radius_m"].number(above_0(1e6, "m"));
  }
}

// The models of a texture in the order of its grid.
void sort_models(const json::Value& from, const std::vector<json::Value>& models, TextureConfig* texture) {
  const auto index_of = [](std::vector<double>* axis, double value) {
    return static_cast<std::size_t>(std::lower_bound(axis->begin(), axis->end(), value) - axis->begin());
  };
  const auto add_to = [](std::vector<double>* axis, double value) {
    const auto at = std::lower_bound(axis->begin(), axis->end(), value);
    if (at == axis->end() || *at != value) axis->insert(at, value);
  };
  for (const json::Value& model : models) {
    add_to(&texture->speed_m_per_s, model["speed_m_per_s"].number(above_0(1e3, "m/s")));
    add_to(&texture->force_n, model["force_n"].number(above_0(kMostForce, "N")));
  }
  texture->models.resize(texture->speed_m_per_s.size() * texture->force_n.size());
  for (const json::Value& model : models) {
    const std::size_t row = index_of(&texture->speed_m_per_s, model["speed_m_per_s"].number()),
                      column = index_of(&texture->force_n, model["force_n"].number());
    TextureConfig::Model& to = texture->models[row * texture->force_n.size() + column];
    if (!to.coefficients.empty()) model["speed_m_per_s"].fail("and force_n are those of another model too");
    to.coefficients = model["coefficients"].numbers(1, FDCG_TEXTURE_MAX_ORDER, {-1e6, 1e6});
    to.variance = model["variance"].number(from_0(1e9, "m^2/s^4"));
    if (to.coefficients.size() != models[0]["coefficients"].size())
      model["coefficients"].fail("has another length than those of the first model");
    double reflection[FDCG_TEXTURE_MAX_ORDER];
    fdcg_error error{};
    if (fdcg_get_reflection(to.coefficients.data(), static_cast<std::uint32_t>(to.coefficients.size()), reflection, &error) !=
        FDCG_OK) {
      model["coefficients"].fail("is refused: " + std::string(error.message));
    }
  }
  for (std::size_t i = 0; i < texture->models.size(); ++i) {
    if (!texture->models[i].coefficients.empty()) continue;
    from["models"].fail("has none at " + shown_number(texture->speed_m_per_s[i / texture->force_n.size()]) + " m/s and " +
                        shown_number(texture->force_n[i % texture->force_n.size()]) +
                        " N; the models stand on a grid: every speed with every force");
  }
}

TextureConfig texture_of(const json::Value& from) {
  from.allow_only({"fdcg_texture", "$schema", "notes", "rate_hz", "models"});
  (void)from["fdcg_texture"].integer(1, 1);
  TextureConfig texture;
  texture.rate_hz = from["rate_hz"].number({1, 20000, true, "Hz"});
  const std::vector<json::Value> models =
      from["models"].objects(1, kMostPoints * kMostPoints, {"speed_m_per_s", "force_n", "coefficients", "variance"});
  sort_models(from, models, &texture);
  return texture;
}

}  // namespace

TextureConfig SceneParser::read_texture(const json::Value& from) {
  if (from.is_object()) return texture_of(from);
  const std::string name = from.text(kLongestPath);
  if (!options_.reads_files) from.fail("names a file, and none is read here");
  std::string text;
  const std::string path = beside(file_name_, name);
  if (const std::string error = json::read_text_file(path, json::Limits{}.bytes, &text); !error.empty())
    from.fail("is refused: " + error);
  try {
    const json::Document document(text);
    const json::Value root = document.root();
    return texture_of(root);
  } catch (const json::Refusal& refusal) {
    from.fail("is refused: " + path + ": " + refusal.message);
  }
}

std::vector<EffectConfig> SceneParser::read_effects(const json::Value& from, const ObjectConfig* object) {
  std::vector<EffectConfig> effects;
  for (const json::Value& effect : from.objects(0, kMaxEffects)) {
    if (effect_count_++ == kMaxEffects)
      effect.fail("is one more than the " + std::to_string(kMaxEffects) + " that a scene may have");
    effects.push_back(read_effect(effect, object));
  }
  return effects;
}

// object: null for the world's.
EffectConfig SceneParser::read_effect(const json::Value& from, const ObjectConfig* object) {
  EffectConfig config;
  const int kind = from["kind"].choice(kEffectKinds) + 1;
  std::vector<std::string> keys(kEffectKeys.begin(), kEffectKeys.end());
  keys.insert(keys.end(), kKeysOfKind[kind - 1].begin(), kKeysOfKind[kind - 1].end());
  from.allow_only(keys, " of such an effect");
  fdcg_effect& effect = config.effect;
  effect = make_kind(from, kind);
  const bool is_known_surface = object != nullptr && (!object->is_surface || has_known_distance(object->surface));
  if (kind == FDCG_EFFECT_MAGNET && !is_known_surface)
    from["kind"].fail("is \"magnet\", which is for meshes, planes and spheres");
  const bool is_ambient = object == nullptr && effect.when == FDCG_WHEN_TOUCHING;
  const int default_when = is_ambient ? FDCG_WHEN_ALWAYS : static_cast<int>(effect.when);
  effect.when = static_cast<std::uint32_t>(from["when"].choice_or(default_when, {"touching", "slipping", "always"}));
  effect.along = static_cast<std::uint32_t>(from["along"].choice_or(0, {"normal", "motion", "axis"}));
  if (from["axis"]) {
    read_unit(from["axis"], effect.axis, 3);
    if (effect.along != FDCG_ALONG_AXIS) from["axis"].fail("is given, and along is not \"axis\"");
  }
  if (from["material"]) {
    config.material = from["material"].text(kLongestName);
    if (object == nullptr || object->is_surface) from["material"].fail("is for the materials of a mesh");
  }
  if (from["region"]) read_region(from["region"], &effect);
  effect.is_off = from["off"].boolean_or(false) ? 1 : 0;
  effect.force_n = from["force_n"].number_or(effect.force_n, kForces);
  effect.smoothing_s = from["smoothing_s"].number_or(effect.smoothing_s, kLongTimes);
  effect.ramp_s = from["ramp_s"].number_or(effect.ramp_s, kLongTimes);
  effect.reserve_j = from["reserve_j"].number_or(effect.reserve_j, kEnergies);
  effect.power_w = from["power_w"].number_or(effect.power_w, from_0(1e6, "W"));
  effect.seed = static_cast<std::uint32_t>(from["seed"].integer_or(0, 0, 4294967295));
  if (kind == FDCG_EFFECT_TEXTURE) config.texture = read_texture(from["texture"]);
  if (kind == FDCG_EFFECT_NOISE && effect.low_hz > effect.frequency_hz) from["low_hz"].fail("is above high_hz");
  if (kind == FDCG_EFFECT_PULSE && effect.period_s != 0 && effect.period_s < effect.duration_s)
    from["period_s"].fail("is below duration_s");
  if (object != nullptr && object->motion.kind == MotionKind::kSoft)
    from["kind"].fail("is an effect of a soft object, which has none");
  return config;
}

ReliefConfig SceneParser::read_relief(const json::Value& from, const ObjectConfig& object) {
  ReliefConfig config;
  constexpr json::NumberRange kHeights = above_0(0.1, "m"), kWaves = {1e-6, 10, true, "m"};
  config.kind = static_cast<ReliefKind>(from["kind"].choice({"ridges", "bumps", "grain", "image"}));
  std::vector<std::string> keys = {"kind", "notes", "material", "off", "reserve_j", "power_w"};
  const bool is_grain = config.kind == ReliefKind::kGrain, is_ridges = config.kind == ReliefKind::kRidges,
             is_image = config.kind == ReliefKind::kImage;
  for (const char* key : {"amplitude_m", "wavelength_m"})
    if (!is_grain && !is_image) keys.emplace_back(key);
  for (const char* key : {"rms_m", "shortest_m", "longest_m", "exponent", "seed"})
    if (is_grain) keys.emplace_back(key);
  if (is_ridges) keys.emplace_back("direction");
  from.allow_only(keys, " of such a relief");
  if (is_grain) {
    config.rms_m = from["rms_m"].number(kHeights);
    config.shortest_m = from["shortest_m"].number(kWaves);
    config.longest_m = from["longest_m"].number(kWaves);
    if (config.longest_m < config.shortest_m) from["longest_m"].fail("is below shortest_m");
    config.exponent = from["exponent"].number_or(1, from_0(3, ""));
    config.seed = static_cast<std::uint32_t>(from["seed"].integer_or(0, 0, 4294967295));
  } else if (!is_image) {
    config.amplitude_m = from["amplitude_m"].number(kHeights);
    config.wavelength_m = from["wavelength_m"].number(kWaves);
    if (from["direction"]) read_unit(from["direction"], config.direction, 3);
  }
  if (from["material"]) {
    config.material = from["material"].text(kLongestName);
    if (object.is_surface) from["material"].fail("is for the materials of a mesh");
  }
  if (is_image && object.is_surface) from["kind"].fail("is of a mesh's file, and this object has none");
  fdcg_relief_init(&config.relief, sizeof config.relief);
  config.relief.is_off = from["off"].boolean_or(false) ? 1 : 0;
  config.relief.reserve_j = from["reserve_j"].number_or(config.relief.reserve_j, kEnergies);
  config.relief.power_w = from["power_w"].number_or(config.relief.power_w, from_0(1e6, "W"));
  if (object.motion.kind == MotionKind::kSoft) from["kind"].fail("is a relief of a soft object, which has none");
  return config;
}

// As a spring of that stiffness would be.
void SceneParser::judge_effects(const json::Value& scene, const DeviceConfig& device) const {
  const double allowed_n_per_m = device.profile.limits.stiffness_n_per_m;
  const auto judge = [&](const EffectConfig& effect, const std::string& whose) {
    const double felt = fdcg_get_effect_stiffness(&effect.effect, 1 / device.profile.rate_hz) * device.mapping.scale;
    if (allowed_n_per_m <= 0 || felt <= allowed_n_per_m) return;
    scene["devices"].fail(": device " + in_quotes(device.name) + ": an effect of " + whose + " shakes as a spring of " +
                          shown_number(felt) + " N/m would; the profile allows " + shown_number(allowed_n_per_m) +
                          ": weaken it");
  };
  for (const EffectConfig& effect : config_.effects)
    judge(effect, "the scene");
  for (const ObjectConfig& object : config_.objects)
    for (const EffectConfig& effect : object.effects)
      judge(effect, "object " + in_quotes(object.name));
  for (const ObjectConfig& object : config_.objects) {
    if (!object.relief || warnings_ == nullptr) continue;
    if (object.relief->kind == ReliefKind::kImage) continue;  // its file is not open yet: warn_of_image_reliefs()
    const fdcg_waves waves = object.relief->waves();
    warn_of_relief(device, object, fdcg_make_relief(&waves), warnings_);
  }
}

}  // namespace fdcg::dev
