// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_effects_build.hpp"

#include <cmath>

#include "scene/scene_bodies.hpp"

namespace fdcg::dev {
namespace {

// Its coefficients have been judged when they were read.
std::unique_ptr<BuiltTexture> built(const TextureConfig& from) {
  auto to = std::make_unique<BuiltTexture>();
  const std::size_t order = from.models[0].coefficients.size();
  to->speed = from.speed_m_per_s;
  to->force = from.force_n;
  to->reflection.resize(from.models.size() * order);
  for (std::size_t i = 0; i < from.models.size(); ++i) {
    fdcg_get_reflection(from.models[i].coefficients.data(), static_cast<std::uint32_t>(order), &to->reflection[i * order],
                        nullptr);
    to->deviation.push_back(std::sqrt(from.models[i].variance));
  }
  fdcg_texture& texture = to->texture;
  texture.rate_hz = from.rate_hz;
  texture.order = static_cast<std::uint32_t>(order);
  texture.speed_count = static_cast<std::uint32_t>(to->speed.size());
  texture.force_count = static_cast<std::uint32_t>(to->force.size());
  texture.speed_m_per_s = to->speed.data();
  texture.force_n = to->force.data();
  texture.reflection = to->reflection.data();
  texture.deviation_m_per_s2 = to->deviation.data();
  return to;
}

// At the rate of the slowest device that may be the clock: there the ticks are longest.
std::string add_effect(const EffectConfig& from, const fdcg_graph* graph, double slowest_hz, DeviceScene* scene) {
  fdcg_effect effect;
  if (std::string problem = make_effect(from, graph, slowest_hz, &scene->textures, &effect); !problem.empty()) return problem;
  scene->effects->add(effect);
  return {};
}

// The relief's heights, kept by the scene; what is wrong with them.
std::string make_relief(const ReliefConfig& from, const FeltObject& felt, DeviceScene* scene, fdcg_relief* relief) {
  if (from.kind != ReliefKind::kImage) {
    scene->waves.push_back(from.waves());
    *relief = fdcg_make_relief(&scene->waves.back());
    return {};
  }
  fdcg_heights heights;
  if (const std::string problem = heights_of(*felt.graph, felt.pose.scale, &heights); !problem.empty()) return problem;
  scene->heights.push_back(heights);
  *relief = fdcg_make_height_relief(&scene->heights.back());
  return {};
}

std::string add_relief(const ReliefConfig& from, const FeltObject& felt, DeviceScene* scene) {
  fdcg_relief relief;
  if (const std::string problem = make_relief(from, felt, scene, &relief); !problem.empty()) return problem;
  relief.is_off = from.relief.is_off;
  relief.reserve_j = from.relief.reserve_j;
  relief.power_w = from.relief.power_w;
  if (!from.material.empty()) {
    relief.material = fdcg_find_material(felt.graph, from.material.c_str());
    if (relief.material == FDCG_NONE) return "the graph has no material '" + from.material + "'";
  }
  fdcg_error error{};
  if (fdcg_check_relief(&relief, &error) != FDCG_OK) return error.message;
  scene->effects->set_relief(relief);
  return {};
}

bool has_effects(const HostConfig& config) {
  bool has = !config.effects.empty();
  for (const ObjectConfig& object : config.objects)
    has = has || !object.effects.empty() || object.relief;
  return has;
}

}  // namespace

std::string make_effect(const EffectConfig& from, const fdcg_graph* graph, double slowest_hz,
                        std::vector<std::unique_ptr<BuiltTexture>>* textures, fdcg_effect* effect) {
  *effect = from.effect;
  if (!from.material.empty()) {
    effect->material = fdcg_find_material(graph, from.material.c_str());
    if (effect->material == FDCG_NONE) return "the graph has no material '" + from.material + "'";
  }
  if (from.texture) {
    textures->push_back(built(*from.texture));
    effect->texture = &textures->back()->texture;
  }
  fdcg_error error{};
  return fdcg_check_effect(effect, 1 / slowest_hz, &error) == FDCG_OK ? std::string() : error.message;
}

std::string heights_of(const fdcg_graph& graph, double scale, fdcg_heights* heights) {
  fdcg_error error{};
  if (fdcg_get_heights(&graph, heights, &error) != FDCG_OK) return error.message;
  heights->metres_per_unit *= scale;
  heights->curvature_per_m /= scale * scale;
  return {};
}

std::string build_effects(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                          const std::vector<fdcg_object_id>& objects, int devices, DeviceScene* scene, DeviceSetup* setup) {
  scene->textures.clear();
  scene->heights.clear();
  scene->effects.reset();
  if (!has_effects(config)) return {};
  scene->effects = std::make_unique<SceneEffects>();
  for (std::size_t i = 0; i < config.effects.size(); ++i) {
    const std::string problem = add_effect(config.effects[i], nullptr, load.slowest_hz, scene);
    if (!problem.empty()) return config.scene_file + ": effects[" + std::to_string(i) + "]: " + problem;
  }
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const ObjectConfig& object = config.objects[i];
    if (object.effects.empty() && !object.relief) continue;
    FeltObject felt;
    felt.id = objects[i];
    felt.pose = object.pose;
    if (object.is_surface) {
      scene->felt_surfaces.push_back(object.surface);
      felt.surface = &scene->felt_surfaces.back();
    } else {
      felt.graph = &graphs.of_object(i);
    }
    scene->effects->add_object(felt);
    if (object.relief) {
      const std::string problem = add_relief(*object.relief, felt, scene);
      if (!problem.empty()) return place_of(config, i) + "relief: " + problem;
    }
    for (std::size_t k = 0; k < object.effects.size(); ++k) {
      const std::string problem = add_effect(object.effects[k], felt.graph, load.slowest_hz, scene);
      if (!problem.empty()) return place_of(config, i) + "effects[" + std::to_string(k) + "]: " + problem;
    }
  }
  scene->effects->begin(devices);
  setup->effects = scene->effects.get();
  return {};
}

}  // namespace fdcg::dev
