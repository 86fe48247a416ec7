// SPDX-License-Identifier: Apache-2.0
#include "mesh_options.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

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
  const auto distance = parse_number_between(text, 0, std::numeric_limits<double>::infinity());
  if (!distance) {
    throw CLI::ValidationError("--weld", "'" + text + "' is none of exact, none, or a distance above 0 in the file's units");
  }
  return {bake::Weld::Kind::distance, *distance};
}

namespace {

void add_weld_option_to(CLI::App& command, const std::function<void(const bake::Weld&)>& set) {
  command
      .add_option_function<std::string>(
          "--weld", [set](const std::string& text) { set(parse_weld_value(text)); },
          offering("Join vertices: exact at equal coordinates, none not at all, a number within that distance in the "
                   "file's units.",
                   {"exact", "none"}))
      ->type_name("DISTANCE")
      ->default_str("exact")
      ->group("Mesh checks");
}

}  // namespace

void add_weld_option(CLI::App& command, bake::Weld& weld) {
  add_weld_option_to(command, [&weld](const bake::Weld& value) { weld = value; });
}
void add_weld_option(CLI::App& command, std::optional<bake::Weld>& weld) {
  add_weld_option_to(command, [&weld](const bake::Weld& value) { weld = value; });
}

const std::vector<std::string>& mesh_endings() {
  static const std::vector<std::string> kEndings{".off", ".obj", ".ply", ".stl", ".gltf", ".glb", ".drc", ".dae", ".3mf"};
  return kEndings;
}

void add_unit_options(CLI::App& command, double& metres_per_unit, std::string& unit_text) {
  struct UnitName {
    const char* name;
    double metres;
  };
  const auto parse_units = [&metres_per_unit, &unit_text](const std::string& text) {
    constexpr UnitName kUnits[] = {{"m", 1}, {"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}};
    require_choice("--units", text, {"m", "mm", "cm", "in"});
    for (const UnitName& unit : kUnits) {
      if (text != unit.name) continue;
      metres_per_unit = unit.metres;
      unit_text = text;
    }
  };
  const auto parse_scale = [&metres_per_unit, &unit_text](const std::string& text) {
    const auto scale = parse_number_between(text, 0, std::numeric_limits<double>::infinity());
    if (!scale) throw CLI::ValidationError("--scale", "'" + text + "' is no number above 0 (metres for one unit of the file)");
    metres_per_unit = *scale;
    unit_text = "1 unit = " + short_number(*scale) + " m";
  };
  CLI::Option* const units = command.add_option_function<std::string>(
      "--units", parse_units, one_of("Unit of the mesh's coordinates.", {"m", "mm", "cm", "in"}));
  units->type_name("UNIT")->default_str("m")->group("Input");
  command.add_option_function<std::string>("--scale", parse_scale, "Metres for one unit of the mesh, instead of --units.")
      ->type_name("METRES")
      ->excludes(units)
      ->group("Input");
}

void add_precision_option(CLI::App& command, bake::Precision& precision, const std::string& help, const std::string& group) {
  const auto parse = [&precision](const std::string& text) {
    require_choice("--precision", text, {"f64", "f32"});
    precision = text == "f32" ? bake::Precision::f32 : bake::Precision::f64;
  };
  command.add_option_function<std::string>("--precision", parse, one_of(help, {"f64", "f32"}))
      ->type_name("REAL")
      ->default_str("f64")
      ->group(group);
}

void add_input_format_option(CLI::App& command, std::optional<bake::Format>& format) {
  const std::vector<std::string> names{"off", "obj", "ply", "stl", "gltf", "glb", "drc", "dae", "3mf"};
  const auto parse = [&format, names](const std::string& text) {
    require_choice("--input-format", text, names);
    using enum bake::Format;
    constexpr std::array kFormats{off, obj, ply, stl, gltf, gltf, drc, dae, threemf};
    format = kFormats[static_cast<std::size_t>(std::find(names.begin(), names.end(), text) - names.begin())];
  };
  command
      .add_option_function<std::string>("--input-format", parse,
                                        one_of("Input format; required for standard input whose content does not tell.", names))
      ->type_name("FORMAT")
      ->default_str("detected by content, then by extension")
      ->group("Input");
}

void add_allow_option(CLI::App& command, std::set<std::string>& allow, Allowable allowable) {
  const auto insert = [&allow, allowable](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const bake::Rule* const rule = bake::find_rule(name);
      if (rule != nullptr && may_be_allowed(*rule, allowable)) {
        allow.insert(name);
        continue;
      }
      const std::vector<std::string> choices = allowable_rules(allowable);
      const std::string why = rule == nullptr ? "' is no rule" + did_you_mean(name, choices) + "; "
                                              : "' cannot be allowed: no graph can stand it; ";
      throw CLI::ValidationError("--allow", "'" + name + why + "these can: " + joined(choices));
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--allow", insert,
          offering("Findings of this rule do not fail the mesh. May be repeated.", allowable_rules(allowable)))
      ->type_name("RULE")
      ->group("Mesh checks")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace fdcg::tools
