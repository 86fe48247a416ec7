// SPDX-License-Identifier: Apache-2.0
// fdcg repair: a mesh in, a mesh out, and an account of everything that was changed or left.
#include <algorithm>
#include <cstdio>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "fdcg/bake.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"
#include "mesh_options.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

constexpr const char* kSteps =
    "--all for all but --solid and --simplify, or of these: --weld, --drop-unusable, --triangulate-crossing, "
    "--drop-degenerate, "
    "--drop-duplicates, --unfold, --cut-non-manifold, --split-non-manifold-vertices, --orient, --drop-blocking, "
    "--reverse-inside-out, --solid, --simplify";

struct RepairArguments {
  std::string mesh;
  std::string output;
  std::optional<bake::Format> format, input_format;
  std::string report;
  std::optional<bake::Weld> weld;
  bake::RepairOptions options;
  bool all = false;
  std::string solid;  // how; empty: not asked for
  std::optional<bake::Extent> hole_size, voxel;
  bool ascii = false;
  bool dry_run = false;
  bool strict = false;
  bool quiet = false;
};

const OptionGroup::Words<bake::Format> kFormatNames{
    {"off", bake::Format::off}, {"obj", bake::Format::obj}, {"ply", bake::Format::ply}, {"stl", bake::Format::stl}};

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending.empty() ? ending : ending.substr(1);
}

// What can be known to be wrong before any work is done.
int check(RepairArguments& arguments) {
  bake::RepairOptions& options = arguments.options;
  if (!arguments.solid.empty() && arguments.solid != "exact" && arguments.solid != "remesh")
    return fail(kUsage, "--solid: '" + arguments.solid + "' is no method; there are exact and remesh");
  if (arguments.solid != "exact" && arguments.hole_size) return fail(kUsage, "--hole-size is for --solid");
  if (arguments.solid != "remesh" && arguments.voxel) return fail(kUsage, "--voxel is for --solid=remesh");
  if (arguments.all || !arguments.solid.empty()) {
    const std::optional<double> simplify_error = options.simplify_error;
    options = bake::repair_options(arguments.solid.empty() ? bake::RepairLevel::full : bake::RepairLevel::solid);
    options.simplify_error = simplify_error;
  }
  if (arguments.solid == "remesh") options.solid->method = bake::SolidOptions::Method::remesh;
  if (arguments.voxel) options.solid->voxel = *arguments.voxel;
  if (arguments.hole_size) options.solid->hole_size = *arguments.hole_size;
  if (arguments.weld) options.weld = arguments.weld;
  const bool asks_for_any = options.weld || options.drop_degenerate_faces || options.drop_duplicate_faces ||
                            options.split_non_manifold_vertices || options.orient || options.reverse_inside_out ||
                            options.simplify_error || options.cut_non_manifold || options.drop_unusable_faces ||
                            options.triangulate_crossing_faces || options.unfold || options.drop_blocking_faces;
  if (!asks_for_any) return fail(kUsage, std::string("no repair was chosen; give ") + kSteps);
  if (arguments.dry_run) return kClean;
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a file; --dry-run writes none");
  const std::string ending = ending_of(arguments.output);
  for (const auto& [name, format] : kFormatNames)
    if (!arguments.format && name == ending) arguments.format = format;
  if (!arguments.format)
    return fail(kUsage, "'" + arguments.output + "' does not end in .off, .obj, .ply or .stl; name the format with --format");
  options.part_equal_points = arguments.format == bake::Format::stl;
  if (options.solid) options.solid->as_floats = arguments.format == bake::Format::stl && !arguments.ascii;
  const auto is_same = [](const std::string& a, const std::string& b) { return !a.empty() && (a == b || is_same_file(a, b)); };
  if (is_same(arguments.output, arguments.report)) return fail(kUsage, "-o and --report must be different files");
  for (const std::string* path : {&arguments.output, &arguments.report}) {
    if (is_same_file(arguments.mesh, *path)) return fail(kUsage, "'" + *path + "' would overwrite the mesh itself");
  }
  return kClean;
}

// A length in the file's units, or a percentage of the object's size.
bake::Extent extent_of(const std::string& option, const std::string& text) {
  const bool is_share = !text.empty() && text.back() == '%';
  const std::string number = is_share ? text.substr(0, text.size() - 1) : text;
  const double value = positive_number(option, number, "no length above 0 in the file's units, and no percentage of its size");
  return {is_share ? value / 100 : value, is_share};
}

void append_elements(std::string& text, const std::vector<bake::Element>& elements, std::uint64_t total) {
  constexpr std::size_t kShown = 3;
  const std::size_t shown = std::min(elements.size(), kShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const bake::Element& element = elements[i];
    text += i == 0 ? "    " : ", ";
    if (!element.faces.empty()) text += "face " + std::to_string(element.faces[0]);
    if (!element.vertices.empty()) text += "vertex " + std::to_string(element.vertices[0]);
    if (element.line) text += " (line " + std::to_string(*element.line) + ")";
  }
  if (shown > 0) text += (total > shown ? " and " + grouped(total - shown) + " more" : std::string()) + "\n";
}

// OFF, OBJ, PLY and STL hold none. Empty where the input states none either.
std::string unit_note(const bake::PolygonSoup& input) {
  if (input.metres_per_unit <= 0) return {};
  const std::string metres = shown_number(input.metres_per_unit);
  return "  unit: the input states 1 unit = " + metres +
         " m, which the written formats cannot hold; compile the result with --scale " + metres + "\n";
}

std::string account(const bake::Repaired& repaired, const bake::PolygonSoup& input) {
  std::string text =
      input.name + ": " + grouped(input.points.size()) + " vertices, " + grouped(input.face_count()) + " faces\n";
  for (const bake::RepairAction& action : repaired.actions) {
    text += "  " + action.name + ": " + action.message + "\n";
    append_elements(text, action.elements, action.total);
    if (action.left == 0) continue;
    text += "  " + action.name + ": " + action.left_message + "\n";
    append_elements(text, action.left_elements, action.left);
  }
  text += unit_note(input);
  return text;
}

// The bytes of the mesh; empty where none is to be written. A code above kFindings: why it cannot be.
int export_repaired(const RepairArguments& arguments, const bake::Repaired& repaired, std::string& bytes) {
  if (arguments.dry_run) return kClean;
  if (repaired.soup.face_count() == 0)
    return fail(kFindings, arguments.mesh + ": no face is left after the repairs; nothing was written");
  if (arguments.strict && !repaired.after.passes())
    return fail(kFindings, arguments.mesh + ": errors are left after the repairs; with --strict nothing was written");
  const bake::ExportOptions options{*arguments.format, arguments.ascii};
  if (options.format == bake::Format::stl && repaired.read_with == bake::Weld::Kind::none) {
    return fail(kUsage,
                arguments.output +
                    ": the result has vertices at equal coordinates that are apart on purpose, and STL cannot keep them "
                    "apart; write OFF, OBJ or PLY, or leave out --weld none");
  }
  auto exported = bake::export_mesh(repaired.soup, options);
  if (!exported) return fail(exported.error().exit_code, exported.error().message);
  bytes = std::move(*exported);
  return kClean;
}

// simplify and solid are done, or were not asked for.
bool did_all(const bake::Repaired& repaired) {
  return std::none_of(repaired.actions.begin(), repaired.actions.end(),
                      [](const bake::RepairAction& action) { return action.is_refused; });
}

int run_repair(RepairArguments& arguments) {
  if (const int code = check(arguments); code != kClean) return code;
  AtomicFile out(arguments.dry_run ? "" : arguments.output), report(arguments.report);
  for (const AtomicFile* const file : {&out, &report})
    if (!file->ok()) return fail(kFile, file->error());

  ProgressBar bar(!arguments.quiet);
  arguments.options.progress = [&bar](std::string_view stage, double done) { bar.update(stage, done); };
  const auto soup = import_input(arguments.mesh, {arguments.input_format, arguments.options.progress});
  bar.wipe();
  if (!soup) return fail(soup.error().exit_code, soup.error().message);
  auto repaired = bake::repair(*soup, arguments.options);
  bar.wipe();
  if (!repaired) return fail(repaired.error().exit_code, repaired.error().message);
  if (!arguments.dry_run) repaired->after.file = arguments.output;

  std::string bytes;
  const int export_code = export_repaired(arguments, *repaired, bytes);
  if (export_code > kFindings) return export_code;
  const bool is_written = !bytes.empty();
  if (report.is_wanted()) report.write(bake::repair_json(*repaired, is_written ? arguments.output : ""));
  out.write(bytes);
  const int code = is_written ? commit_all({&report, &out}) : commit_all({&report});
  if (code != kClean) return code;
  if (!arguments.quiet) {
    const bool is_stdout_taken = arguments.output == "-" || arguments.report == "-";
    std::FILE* const stream = is_stdout_taken ? stderr : stdout;
    std::fputs(account(*repaired, *soup).c_str(), stream);
    const bool colour = wants_colour(is_stdout_taken ? Stream::standard_error : Stream::standard_output);
    std::fputs(bake::report_text(repaired->after, colour).c_str(), stream);
    if (repaired->read_with == bake::Weld::Kind::none)
      std::fputs("read it with --weld none: vertices at equal coordinates are apart on purpose\n", stream);
  }
  return repaired->after.passes() && did_all(*repaired) ? kClean : kFindings;
}

void add_step_options(CLI::App& command, RepairArguments& arguments) {
  bake::RepairOptions& options = arguments.options;
  const OptionGroup repairs(command, "Repairs");
  repairs.flag("--all", arguments.all,
               "All repairs: --weld exact and the flags below, without --solid and --simplify. What each did to the surface is "
               "measured.");
  add_weld_option(repairs, arguments.weld, "");
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
      .add_flag("--solid{exact}", arguments.solid,
                "All repairs, and: close holes, resolve self-intersections into the outer surface by exact arithmetic, leave "
                "out what lies inside. The result is closed, and no two of its faces meet but at a shared corner or edge. "
                "--solid=remesh: rebuild the surface on a lattice in place of that, where the exact way says that it cannot.")
      ->group("Repairs");
  repairs.parsed(
      "--hole-size", "LENGTH", [&arguments](const std::string& text) { arguments.hole_size = extent_of("--hole-size", text); },
      "With --solid: close holes up to this size, the diagonal of their bounds, in the file's units or as 5% of the object's "
      "size. Parts with a larger hole are left out.",
      "100%");
  repairs.parsed(
      "--voxel", "LENGTH", [&arguments](const std::string& text) { arguments.voxel = extent_of("--voxel", text); },
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

Command add_repair(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("repair", "Repair a mesh safely; every repair is counted and listed.");
  command->footer(R"(Examples:
  fdcg repair scan.ply -o clean.ply --all
  fdcg repair part.stl -o part.obj --weld exact --drop-degenerate --orient
  fdcg repair --solid --hole-size 5% part.stl -o solid.stl
  fdcg repair --all --dry-run --report account.json part.stl

Defects that cannot be repaired safely are left and reported.

)" + exit_codes("the result has no errors",
                "errors are left, or --simplify or --solid could not be done; the mesh is written unless --strict"));
  const auto arguments = std::make_shared<RepairArguments>();
  add_mesh_argument(*command, arguments->mesh);
  const OptionGroup output(*command, "Output");
  output.text("-o,--output", "FILE", arguments->output, "File to write the repaired mesh to. - is standard output.");
  output.choice<bake::Format>("--format", "FORMAT", kFormatNames, arguments->format, "Format of the repaired mesh.",
                              "by the file's extension");
  add_input_format_option(*command, arguments->input_format);
  output.flag("--ascii", arguments->ascii, "Write PLY and STL as text.");
  add_step_options(*command, *arguments);
  output.text("--report", "FILE", arguments->report, "Write what was done and left as JSON to FILE.");
  output.flag("--dry-run", arguments->dry_run, "Write no mesh.");
  output.flag("--strict", arguments->strict, "Write the mesh only if no error is left.");
  output.flag("-q,--quiet", arguments->quiet, "Print errors only, and no progress bar.");
  return {command, [arguments] { return run_repair(*arguments); }};
}

}  // namespace fdcg::tools
