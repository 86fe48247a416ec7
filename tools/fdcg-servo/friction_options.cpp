// SPDX-License-Identifier: Apache-2.0
#include "friction_options.hpp"

#include <algorithm>

namespace fdcg::servo {
namespace {

constexpr double kLargestTerm = 1e9;  // fdcg_check_params
constexpr const char* kMaterialForm = "not NAME=MU_S,MU_D,K: a material, two coefficients of friction and N/m";

// "rubber=0.9,0.7,600"
std::pair<std::string, fdcg_material> parse_material(const std::string& text) {
  const std::size_t at = text.rfind('=');
  if (at == 0 || at == std::string::npos) throw CLI::ValidationError("--material", "'" + text + "' is " + kMaterialForm);
  std::vector<double> numbers;
  for (std::size_t from = at + 1; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const auto number = tools::parse_number_between(text.substr(from, comma - from), -1, kLargestTerm);
    if (!number || *number < 0) throw CLI::ValidationError("--material", "'" + text + "' is " + kMaterialForm);
    numbers.push_back(*number);
    from = comma + 1;
  }
  if (numbers.size() != 3) throw CLI::ValidationError("--material", "'" + text + "' is " + kMaterialForm);
  return {text.substr(0, at), {numbers[0], numbers[1], numbers[2]}};
}

}  // namespace

void FrictionOptions::declare(const tools::OptionGroup& group, fdcg_params& params) {
  const auto term = [&](const char* name, const char* value, double& target, std::uint32_t flag, const char* unit,
                        const std::string& help) {
    const std::string option = name;
    group.parsed(
        name, value,
        [option, &target, &params, flag, unit](const std::string& text) {
          target = tools::number_between(option, text, -1, kLargestTerm, std::string("not a number from 0 to 1e9") + unit);
          params.friction_flags |= flag;
        },
        help);
  };
  term("--stribeck", "V", params.stribeck_m_per_s, FDCG_FRICTION_STRIBECK, " m/s",
       "Friction falls from --mu-s to --mu-d as slip speeds up: half of it at V m/s.");
  term("--viscous", "C", params.viscous_s_per_m, FDCG_FRICTION_VISCOUS, " s/m",
       "Friction grows with slip speed: its coefficient by C for each m/s.");
  term("--presliding", "K", params.presliding_n_per_m, FDCG_FRICTION_PRESLIDING, " N/m",
       "A contact that sticks yields like a spring of K N/m.");
  term("--lag", "S", params.friction_lag_s, FDCG_FRICTION_LAG, " s", "Friction follows slip speed with a delay of S seconds.");
  group.flag("--shading", has_shading_,
             "Force shading: the graph's normals are felt in place of its facets (fdcg compile --normals).");
  group.repeated(
      "--material", "NAME=MU_S,MU_D,K", [this](const std::string& text) { named_.push_back(parse_material(text)); },
      "Faces of this material have other friction and stiffness. May be given again.");
}

std::string FrictionOptions::apply(const fdcg_graph& graph, fdcg_params& params) {
  if (has_shading_) {
    if (graph.normals == nullptr)
      return "it has no normals at the corners of its faces; compile it with --normals faces (--shading)";
    params.friction_flags |= FDCG_FRICTION_SHADING;
  }
  if (named_.empty()) return {};
  table_.assign(graph.material_count, {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m});
  for (const auto& [name, material] : named_) {
    const std::uint32_t number = fdcg_find_material(&graph, name.c_str());
    if (number >= table_.size())
      return "it has no material '" + name + "'; 'fdcg inspect' lists those that it has (--material)";
    table_[number] = material;
  }
  params.materials = table_.data();
  params.material_count = static_cast<std::uint32_t>(table_.size());
  params.friction_flags |= FDCG_FRICTION_MATERIALS;
  return {};
}

}  // namespace fdcg::servo
