// SPDX-License-Identifier: Apache-2.0
#include "repair_settings.hpp"

#include <algorithm>
#include <filesystem>

#include "../common/options.hpp"
#include "../common/program.hpp"
#include "mesh_options.hpp"

namespace fdcg::tools {
namespace {

constexpr const char* kSteps =
    "--all for all but --solid and --simplify, or of these: --weld, --drop-unusable, --triangulate-crossing, "
    "--drop-degenerate, "
    "--drop-duplicates, --unfold, --cut-non-manifold, --split-non-manifold-vertices, --orient, --drop-blocking, "
    "--reverse-inside-out, --solid, --simplify";

const OptionGroup::Words<bake::Format> kFormatNames{
    {"off", bake::Format::off}, {"obj", bake::Format::obj}, {"ply", bake::Format::ply}, {"stl", bake::Format::stl}};

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending.empty() ? ending : ending.substr(1);
}

// A length in the file's units, or a percentage of the object's size.
bake::Extent extent_of(const std::string& option, const std::string& text) {
  const bool is_share = !text.empty() && text.back() == '%';
  const std::string number = is_share ? text.substr(0, text.size() - 1) : text;
  const double value = positive_number(option, number, "no length above 0 in the file's units, and no percentage of its size");
  return {is_share ? value / 100 : value, is_share};
}

void add_repair_steps(CLI::App& command, RepairSettings& settings) {
  bake::RepairOptions& options = settings.options;
  const OptionGroup repairs(command, "Repairs");
  repairs.flag("--all", settings.all,
               "All repairs: --weld exact and the flags below, without --solid and --simplify. What each did to the surface is "
               "measured.");
  add_weld_option(repairs, settings.weld, "");
  repairs.flag("--drop-unusable", options.drop_unusable_faces,
               "Drop faces with a corner that is not finite or not in the file.");
  repairs.flag(
      "--triangulate-crossing", options.triangulate_crossing_faces,
      "Triangulate polygons that cross themselves or come twice to a corner. Implies --weld exact, as do the next two.");
  repairs.flag("--unfold", options.unfold,
               "Unfold slivers, thinner than a thousandth of the object's size, that lie on a neighbour.");
  repairs.flag("--cut-non-manifold", options.cut_non_manifold,
               "Part edges of more than two faces into pairs of faces; cut what has no partner, folds, and one-sided patches.");
  repairs.flag("--drop-degenerate", options.drop_degenerate_faces,
               "Drop faces without area, and join the faces on either side.");
  repairs.flag("--drop-duplicates", options.drop_duplicate_faces, "Drop faces that have the vertices of an earlier one.");
  repairs.flag("--split-non-manifold-vertices", options.split_non_manifold_vertices,
               "Give each fan of faces around a vertex a vertex of its own. Implies --weld exact; the result must be read with "
               "--weld none.");
  repairs.flag("--drop-blocking", options.drop_blocking_faces,
               "Drop faces that no other step could mend and no graph can have.");
  repairs.flag("--orient", options.orient,
               "Make the winding of each patch consistent, and that of closed patches of mixed winding outward.");
  repairs.flag("--reverse-inside-out", options.reverse_inside_out,
               "Reverse closed patches that enclose negative volume, by nesting depth.");
  command
      .add_flag("--solid{exact}", settings.solid,
                "All repairs, and: close holes, resolve self-intersections into the outer surface by exact arithmetic, leave "
                "out what lies inside. The result is closed, and no two of its faces meet but at a shared corner or edge. "
                "--solid=remesh: rebuild the surface on a lattice in place of that, where the exact way says that it cannot.")
      ->group("Repairs");
  repairs.parsed(
      "--hole-size", "LENGTH", [&settings](const std::string& text) { settings.hole_size = extent_of("--hole-size", text); },
      "With --solid: close holes up to this size, the diagonal of their bounds, in the file's units or as 5% of the object's "
      "size. Parts with a larger hole are left out.",
      "100%");
  repairs.parsed(
      "--voxel", "LENGTH", [&settings](const std::string& text) { settings.voxel = extent_of("--voxel", text); },
      "With --solid=remesh: the lattice's step, in the file's units or as 1% of the object's size. What is smaller is lost.",
      "0.5%");
  const auto parse_error = [&options](const std::string& text) {
    options.simplify_error = positive_number("--simplify", text, "no distance above 0 in the file's units");
  };
  repairs.parsed("--simplify", "ERROR", parse_error,
                 "Reduce the number of triangles and keep the topology. No point of either surface is farther than ERROR, in "
                 "the file's units, from the other.");
}

}  // namespace

void add_repair_settings(CLI::App& command, RepairSettings& settings) {
  const OptionGroup output(command, "Output");
  output.choice<bake::Format>("--format", "FORMAT", kFormatNames, settings.format, "Format of the repaired mesh.",
                              "by the file's extension");
  add_input_format_option(command, settings.input_format);
  output.flag("--ascii", settings.ascii, "Write PLY and STL as text.");
  add_repair_steps(command, settings);
  output.flag("--strict", settings.strict, "Write the mesh only if no error is left.");
}

std::string settle(RepairSettings& settings) {
  bake::RepairOptions& options = settings.options;
  if (!settings.solid.empty() && settings.solid != "exact" && settings.solid != "remesh")
    return "--solid: '" + settings.solid + "' is no method; there are exact and remesh";
  if (settings.solid != "exact" && settings.hole_size) return "--hole-size is for --solid";
  if (settings.solid != "remesh" && settings.voxel) return "--voxel is for --solid=remesh";
  if (settings.all || !settings.solid.empty()) {
    const std::optional<double> simplify_error = options.simplify_error;
    options = bake::repair_options(settings.solid.empty() ? bake::RepairLevel::full : bake::RepairLevel::solid);
    options.simplify_error = simplify_error;
  }
  if (settings.solid == "remesh") options.solid->method = bake::SolidOptions::Method::remesh;
  if (settings.voxel) options.solid->voxel = *settings.voxel;
  if (settings.hole_size) options.solid->hole_size = *settings.hole_size;
  if (settings.weld) options.weld = settings.weld;
  const bool asks_for_any = options.weld || options.drop_degenerate_faces || options.drop_duplicate_faces ||
                            options.split_non_manifold_vertices || options.orient || options.reverse_inside_out ||
                            options.simplify_error || options.cut_non_manifold || options.drop_unusable_faces ||
                            options.triangulate_crossing_faces || options.unfold || options.drop_blocking_faces;
  return asks_for_any ? std::string() : std::string("no repair was chosen; give ") + kSteps;
}

std::optional<bake::Format> written_format(const std::string& path) {
  const std::string ending = ending_of(path);
  for (const auto& [name, format] : kFormatNames)
    if (name == ending) return format;
  return std::nullopt;
}

void suit_format(RepairSettings& settings) {
  bake::RepairOptions& options = settings.options;
  options.part_equal_points = settings.format == bake::Format::stl;
  if (options.solid) options.solid->as_floats = settings.format == bake::Format::stl && !settings.ascii;
}

bake::Result<std::string> export_repaired(const RepairSettings& settings, const bake::Repaired& repaired,
                                          const std::string& output) {
  const auto refused = [&repaired](ExitCode code, const std::string& name, const char* why) {
    return bake::Failure{code, (name.empty() ? repaired.before.file : name) + ": " + why, {}};
  };
  if (repaired.soup.face_count() == 0) return refused(kFindings, {}, "no face is left after the repairs; nothing was written");
  if (settings.strict && !repaired.after.passes())
    return refused(kFindings, {}, "errors are left after the repairs; with --strict nothing was written");
  const bake::ExportOptions options{*settings.format, settings.ascii};
  if (options.format == bake::Format::stl && repaired.read_with == bake::Weld::Kind::none) {
    return refused(kUsage, output,
                   "the result has vertices at equal coordinates that are apart on purpose, and STL cannot keep them apart; "
                   "write OFF, OBJ or PLY, or leave out --weld none");
  }
  return bake::export_mesh(repaired.soup, options);
}

bool did_all(const bake::Repaired& repaired) {
  return std::none_of(repaired.actions.begin(), repaired.actions.end(),
                      [](const bake::RepairAction& action) { return action.is_refused; });
}

}  // namespace fdcg::tools
