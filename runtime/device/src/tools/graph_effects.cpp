// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "fdcg/device_tools.hpp"
#include "scene/scene_effects_build.hpp"
#include "scene/scene_json.hpp"

namespace fdcg::dev {
namespace {

using nlohmann::json;

// A number, true or false as such, and anything else as a word.
json value_of(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_number() || value.is_boolean() ? value : json(text);
}

// Of "KIND,KEY=VALUE,...". False: it has no such form.
bool read_words(const std::string& text, json* effect) {
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string word = text.substr(from, comma - from);
    const std::size_t equals = word.find('=');
    if ((from == 0) != (equals == std::string::npos) || word.empty() || equals == 0) return false;
    if (from == 0) (*effect)["kind"] = word;
    if (from != 0) (*effect)[word.substr(0, equals)] = value_of(word.substr(equals + 1));
    from = comma + 1;
  }
  return true;
}

// What a scene is refused for, without where its effect stands.
std::string within_effect(const std::string& refusal) {
  const std::string place = "effects[0]";
  const std::size_t at = refusal.find(place);
  if (at == std::string::npos) return refusal;
  const std::string rest = refusal.substr(at + place.size());
  return rest.substr(std::min(rest.find_first_not_of(". "), rest.size()));
}

}  // namespace

struct GraphEffects::Impl {
  std::vector<EffectConfig> configs;
  std::vector<std::unique_ptr<BuiltTexture>> textures;
  std::vector<fdcg_effect> effects;
  std::vector<fdcg_effect_state> states;
  double reach_m = 0, tick_s = 0;
};

GraphEffects::GraphEffects() : impl_(std::make_unique<Impl>()) {}
GraphEffects::~GraphEffects() = default;

bool GraphEffects::is_empty() const {
  return impl_->configs.empty();
}

std::string GraphEffects::add(const std::string& text) {
  if (impl_->configs.size() == kMaxEffects) return "is one more than the " + std::to_string(kMaxEffects) + " that there may be";
  json effect = json::object();
  if (text.rfind('{', 0) == 0) {
    effect = json::parse(text, nullptr, false);
    if (effect.is_discarded()) return "is not JSON";
  } else if (!read_words(text, &effect)) {
    return "is not KIND,KEY=VALUE,...";
  }
  const json scene = {{"fdcg_scene", 1},
                      {"objects", {{{"name", "graph"}, {"file", "graph"}, {"effects", json::array({effect})}}}},
                      {"devices", {{{"name", "hand"}, {"source", "simulated"}}}}};
  HostConfig config;
  const std::string refusal =
      parse_scene(scene.dump(-1, ' ', false, json::error_handler_t::replace), "effect", &config, nullptr);
  if (!refusal.empty()) return within_effect(refusal);
  impl_->configs.push_back(config.objects[0].effects[0]);
  return {};
}

std::string GraphEffects::open(const fdcg_graph& graph, double tick_s) {
  impl_->tick_s = tick_s;
  for (const EffectConfig& config : impl_->configs) {
    fdcg_effect effect;
    if (std::string problem = make_effect(config, &graph, 1 / tick_s, &impl_->textures, &effect); !problem.empty())
      return problem;
    if (effect.kind == FDCG_EFFECT_MAGNET) impl_->reach_m = std::max(impl_->reach_m, effect.distance_m);
    impl_->effects.push_back(effect);
  }
  impl_->states.assign(impl_->effects.size(), fdcg_effect_state{});
  return {};
}

void GraphEffects::feel(const fdcg_graph& graph, const fdcg_result& felt, const double hip_m[3], double force_n[3]) {
  fdcg_effect_facts facts{};
  if (fdcg_get_effect_facts(&graph, &felt, hip_m, impl_->reach_m, impl_->tick_s, &facts, nullptr) != FDCG_OK)
    facts.tick_s = 0;  // no force
  double own_n[3] = {0, 0, 0};
  for (std::size_t i = 0; i < impl_->effects.size(); ++i)
    fdcg_effect_step(&impl_->effects[i], &facts, &impl_->states[i], own_n);
  for (int k = 0; k < 3; ++k)
    force_n[k] += own_n[k];
}

}  // namespace fdcg::dev
