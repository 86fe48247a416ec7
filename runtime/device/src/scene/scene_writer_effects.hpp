// SPDX-License-Identifier: Apache-2.0
// What scene_writer.cpp and scene_writer_effects.cpp share; for them alone.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scene/host_config.hpp"

namespace fdcg::dev {

using Json = nlohmann::ordered_json;

template <std::size_t count>
Json list(const double (&values)[count]) {
  return Json(std::vector<double>(values, values + count));
}

Json relief_json(const ReliefConfig& relief);
Json effects_json(const std::vector<EffectConfig>& effects);

}  // namespace fdcg::dev
