// SPDX-License-Identifier: Apache-2.0
#include "mesh_options.hpp"

#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

bool may_be_allowed(const bake::Rule& rule, Allowable allowable) {
  if (rule.severity == bake::Severity::error) return rule.can_be_allowed;
  return rule.can_be_allowed || allowable == Allowable::also_warnings_and_notes;
}

std::vector<std::string> allowable_rules(Allowable allowable) {
  std::vector<std::string> names;
  for (const bake::Rule& rule : bake::rules()) {
    if (may_be_allowed(rule, allowable)) names.emplace_back(rule.name);
  }
  return names;
}

}  // namespace

bake::Weld parse_weld_value(const std::string& text) {
  if (text == "exact" || text == "none") return {text == "exact" ? bake::Weld::Kind::exact : bake::Weld::Kind::none, 0};
  return {bake::Weld::Kind::distance,
          positive_number("--weld", text, "none of exact, none, or a distance above 0 in the file's units")};
}

void add_mesh_argument(CLI::App& command, std::string& mesh) {
  required_argument(command, "mesh", "MESH", mesh,
                    "Mesh file: OFF, OBJ, PLY, STL, glTF, GLB, Draco, COLLADA, 3MF, VTK or X3D. - is standard input.");
}

void add_unit_options(CLI::App& command, double& metres_per_unit, std::string& unit_text) {
  const OptionGroup input(command, "Input");
  CLI::Option* const units = input.choice<double>("--units", "UNIT", {{"m", 1}, {"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}},
                                                  metres_per_unit, "Unit of the mesh's coordinates.", "the file's own, else m");
  units->each([&unit_text](const std::string& text) { unit_text = text; });
  const auto parse_scale = [&metres_per_unit, &unit_text](const std::string& text) {
    metres_per_unit = positive_number("--scale", text, "no number above 0 (metres for one unit of the file)");
    unit_text = "1 unit = " + short_number(metres_per_unit) + " m";
  };
  input.parsed("--scale", "METRES", parse_scale, "Metres for one unit of the mesh, instead of --units.")->excludes(units);
}

void add_precision_option(const OptionGroup& group, bake::Precision& precision, const std::string& help) {
  using enum bake::Precision;
  group.choice<bake::Precision>("--precision", "REAL", {{"f64", f64}, {"f32", f32}}, precision, help);
}

void add_input_format_option(CLI::App& command, std::optional<bake::Format>& format) {
  using enum bake::Format;
  OptionGroup(command, "Input")
      .choice<bake::Format>("--input-format", "FORMAT",
                            {{"off", off},
                             {"obj", obj},
                             {"ply", ply},
                             {"stl", stl},
                             {"gltf", gltf},
                             {"glb", gltf},
                             {"drc", drc},
                             {"dae", dae},
                             {"3mf", threemf},
                             {"vtk", vtk},
                             {"vtp", vtk},
                             {"x3d", x3d}},
                            format, "Input format; required for standard input whose content does not tell.",
                            "detected by content, then by extension");
}

void add_allow_option(const OptionGroup& group, std::set<std::string>& allow, Allowable allowable) {
  const auto insert = [&allow, allowable](const std::string& name) {
    const bake::Rule* const rule = bake::find_rule(name);
    if (rule != nullptr && may_be_allowed(*rule, allowable)) {
      allow.insert(name);
      return;
    }
    const std::vector<std::string> choices = allowable_rules(allowable);
    const std::string why =
        rule == nullptr ? "' is no rule" + did_you_mean(name, choices) + "; " : "' cannot be allowed: no graph can stand it; ";
    throw CLI::ValidationError("--allow", "'" + name + why + "these can: " + listed(choices));
  };
  group.repeated("--allow", "RULE", insert,
                 offering("Findings of this rule do not fail the mesh. May be repeated.", allowable_rules(allowable)));
}

}  // namespace fdcg::tools
