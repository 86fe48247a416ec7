// SPDX-License-Identifier: Apache-2.0
#include "compile_settings.hpp"

#include <numbers>

#include "../common/terminal.hpp"
#include "fdcg/fdcg.h"
#include "mesh_options.hpp"

namespace fdcg::tools {
namespace {

void add_graph_options(CLI::App& command, CompileSettings& settings) {
  bake::CompileOptions& options = settings.options;
  const OptionGroup graph(command, "Graph");
  add_precision_option(graph, options.precision, "Precision of the numbers in the file.");
  const auto parse_coplanar = [&options](const std::string& text) {
    if (text == "exact" || text == "quantum") {
      options.coplanar = {text == "exact" ? bake::Coplanar::Kind::exact : bake::Coplanar::Kind::quantum, 0};
      return;
    }
    const double degrees =
        number_between("--coplanar", text, 0, 90, "none of exact, quantum, or an angle between 0 and 90 degrees");
    options.coplanar = {bake::Coplanar::Kind::angle, degrees * std::numbers::pi / 180};
  };
  graph.parsed("--coplanar", "ANGLE", parse_coplanar,
               offering("Which edges count as flat: exact, those of coplanar faces; quantum, those flat within the rounding of "
                        "the input; a number, those within that angle in degrees.",
                        {"exact", "quantum"}),
               "quantum");
  CLI::Option* const merge =
      graph.flag("--merge,!--no-merge", options.merge, "Merge coplanar faces into convex polygons, or keep each face.");
  merge->default_str("--merge");
  graph
      .flag("--triangles", options.triangles,
            "Split every face into triangles and merge none: for a mesh that the program deforms (fdcg/deform.h).")
      ->excludes("--coplanar");
  command.final_callback([&options, merge] {
    if (options.triangles && merge->count() > 0 && options.merge) throw CLI::ExcludesError("--triangles", "--merge");
  });
  graph.choice<bool>(
      "--planes", "PLANES", {{"stored", true}, {"derived", false}}, options.store_planes,
      "Edge vectors, end planes and Voronoi planes: stored in the file, or derived in the step, with a smaller file.");
  add_shading_options(graph, options);
  graph.flag(
      "--visual", options.visual,
      "Also the mesh for the eye: triangles with normals, texture coordinates, colours and materials, as OBJ, PLY, glTF and "
      "Draco files have them (fdcg/visual.h).");
  add_heights_options(graph, options, settings.heights);
  graph.flag("--haptic-materials", settings.haptic_materials,
             "Experimental: of glTF files also MPEG_haptic_material. Faces have the names of their haptic materials, and 'fdcg "
             "inspect' "
             "lists what the textures of stiffness and friction hold.");
  const std::vector<std::string> sections{"hierarchy", "source-map", "info", "mass", "materials", "normals"};
  const auto leave_out = [&options, sections](const std::string& name) {
    require_choice("--without", name, sections);
    options.without.insert(name);
  };
  graph.repeated("--without", "SECTION", leave_out, one_of("Leave a section out of the file. May be repeated.", sections));
}

void add_mass_options(CLI::App& command, bake::CompileOptions& options) {
  const OptionGroup group(command, "Mass");
  const auto positive = [](const char* name, double& value, const std::string& wrong) {
    return [&value, name, wrong](const std::string& text) { value = positive_number(name, text, wrong); };
  };
  CLI::Option* const density =
      group.parsed("--density", "DENSITY",
                   positive("--density", options.density_kg_per_m3, "no number above 0 (kilograms for a cubic metre)"),
                   "Density of the body, in kg per cubic metre; its mesh must be closed.", "unknown");
  group
      .parsed("--mass", "KG", positive("--mass", options.mass_kg, "no number above 0 (kilograms)"),
              "Mass of the body in kg, instead of --density.")
      ->excludes(density);
}

}  // namespace

void add_shading_options(const OptionGroup& group, bake::CompileOptions& options) {
  group.choice<bake::Normals>(
      "--normals", "NORMALS", {{"none", bake::Normals::none}, {"faces", bake::Normals::faces}, {"file", bake::Normals::file}},
      options.normals,
      "Normals at the corners of faces, for force shading: from the faces around each vertex up to creases, or those of the "
      "mesh file (vn of OBJ, nx ny nz of PLY, NORMAL of glTF, normals of Draco).");
  group.parsed(
      "--crease", "ANGLE",
      [&options](const std::string& text) {
        options.crease_rad = number_between("--crease", text, 0, 180, "no angle of 0 to 180 degrees") * std::numbers::pi / 180;
      },
      "Of normals made from faces: faces that meet at a larger angle, in degrees, meet at a crease.", "40");
}

void add_heights_options(const OptionGroup& group, bake::CompileOptions& options, std::string& heights) {
  group.text(
      "--heights", "IMAGE", heights,
      "Images as heights that are felt (fdcg/heights.h), PNG of 8 or 16 bits: one for all faces, or, with the word file, "
      "those that the mesh file's materials name (map_bump, bump and disp of OBJ's mtllib; normalTexture of glTF, whose "
      "normals become heights).");
  group.parsed(
      "--height-range", "METRES",
      [&options](const std::string& text) {
        options.height_range_m = number_between("--height-range", text, -1, 1, "no number of -1 to 1 (metres)");
      },
      "How high white is above black.", "as the mesh file says");
}

void add_compile_input(CLI::App& command, CompileSettings& settings) {
  add_input_format_option(command, settings.input_format);
  add_unit_options(command, settings.options.metres_per_unit, settings.unit_text);
}

void add_compile_settings(CLI::App& command, CompileSettings& settings) {
  const OptionGroup checks(command, "Mesh checks");
  add_weld_option(checks, settings.options.weld);
  checks.flag("--orient", settings.options.orient,
              "Make the winding consistent and outward, and report the faces that were turned.");
  checks.flag("--self-intersections", settings.options.self_intersections,
              "Also find faces that cross or touch others, and report them as warnings.");
  command
      .add_flag(
          "--repair{full}", settings.repair,
          "Where the mesh has errors, repair it first; what was done is measured and stored in the file. --repair=safe: no "
          "point of the surface moves; --repair or --repair=full: also unfolds slivers, triangulates polygons that cross "
          "themselves, and drops what no graph can have. --repair=solid: any mesh, also one without errors, becomes the outer "
          "surface of what it encloses, with its holes closed.")
      ->group("Mesh checks");
  add_allow_option(checks, settings.options.allow, Allowable::errors_the_graph_stands);
  add_graph_options(command, settings);
  add_mass_options(command, settings.options);
}

std::string settle(CompileSettings& settings) {
  settings.options.heights = !settings.heights.empty();
  if (settings.repair.empty()) return {};
  for (const bake::RepairLevel level : {bake::RepairLevel::safe, bake::RepairLevel::full, bake::RepairLevel::solid})
    if (settings.repair == bake::level_name(level)) settings.options.repair = level;
  if (settings.options.repair) return {};
  return "--repair: '" + settings.repair + "' is no level; there are safe, full and solid";
}

void take_unit(const bake::PolygonSoup& soup, CompileSettings& settings) {
  if (!settings.has_default_unit() || soup.metres_per_unit <= 0) return;
  settings.options.metres_per_unit = soup.metres_per_unit;
  settings.unit_text = "1 unit = " + short_number(soup.metres_per_unit) + " m (the file's own)";
}

std::string refused_by_runtime(const bake::Compiled& compiled) {
  fdcg_graph graph{};
  fdcg_error error{};
  if (fdcg_open_memory(compiled.file().data(), compiled.file().size(), FDCG_VERIFY_TRUSTED, &graph, &error) == FDCG_OK)
    return {};
  return std::string("these options make a file that the runtime refuses: ") + error.message;
}

}  // namespace fdcg::tools
