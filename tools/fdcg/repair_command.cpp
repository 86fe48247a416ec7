// SPDX-License-Identifier: Apache-2.0
// fdcg repair: a mesh in, a mesh out, and an account of everything that was changed or left.
#include <algorithm>
#include <cstdio>
#include <limits>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "fdcg/bake.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"
#include "mesh_options.hpp"

namespace fdcg::tools {
namespace {

constexpr const char* kSteps =
    "--weld, --drop-degenerate, --drop-duplicates, --split-non-manifold-vertices, --orient, --reverse-inside-out, --simplify, "
    "or "
    "--all for the first six";

struct RepairArguments {
  std::string mesh;
  std::string output;
  std::string format;
  std::optional<bake::Format> input_format;
  std::string report;
  std::optional<bake::Weld> weld;
  bake::RepairOptions options;
  bool all = false;
  bool ascii = false;
  bool dry_run = false;
  bool strict = false;
  bool quiet = false;
};

struct FormatName {
  const char* name;
  bake::Format format;
};
constexpr FormatName kFormatNames[] = {
    {"off", bake::Format::off}, {"obj", bake::Format::obj}, {"ply", bake::Format::ply}, {"stl", bake::Format::stl}};

std::optional<bake::Format> format_named(const std::string& name) {
  for (const FormatName& known : kFormatNames) {
    if (name == known.name) return known.format;
  }
  return std::nullopt;
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending.empty() ? ending : ending.substr(1);
}

// What can be known to be wrong before any work is done.
int check(RepairArguments& arguments) {
  bake::RepairOptions& options = arguments.options;
  if (arguments.all) {
    options.weld = bake::Weld{};
    options.drop_degenerate_faces = options.drop_duplicate_faces = options.split_non_manifold_vertices = true;
    options.orient = options.reverse_inside_out = true;
  }
  if (arguments.weld) options.weld = arguments.weld;
  const bool asks_for_any = options.weld || options.drop_degenerate_faces || options.drop_duplicate_faces ||
                            options.split_non_manifold_vertices || options.orient || options.reverse_inside_out ||
                            options.simplify_error;
  if (!asks_for_any) return fail(kUsage, std::string("no repair was chosen; give ") + kSteps);
  if (arguments.dry_run) return kClean;
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a file; --dry-run writes none");
  if (arguments.format.empty()) {
    arguments.format = ending_of(arguments.output);
    if (!format_named(arguments.format)) {
      return fail(kUsage, "'" + arguments.output + "' does not end in .off, .obj, .ply or .stl; name the format with --format");
    }
  }
  const auto is_same = [](const std::string& a, const std::string& b) { return !a.empty() && (a == b || is_same_file(a, b)); };
  if (is_same(arguments.output, arguments.report)) return fail(kUsage, "-o and --report must be different files");
  for (const std::string* path : {&arguments.output, &arguments.report}) {
    if (is_same_file(arguments.mesh, *path)) return fail(kUsage, "'" + *path + "' would overwrite the mesh itself");
  }
  return kClean;
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
  return text;
}

// The bytes of the mesh; empty where none is to be written. A code above kFindings: why it cannot be.
int export_repaired(const RepairArguments& arguments, const bake::Repaired& repaired, std::string& bytes) {
  if (arguments.dry_run) return kClean;
  if (repaired.soup.face_count() == 0)
    return fail(kFindings, arguments.mesh + ": no face is left after the repairs; nothing was written");
  if (arguments.strict && !repaired.after.passes())
    return fail(kFindings, arguments.mesh + ": errors are left after the repairs; with --strict nothing was written");
  const bake::ExportOptions options{*format_named(arguments.format), arguments.ascii};
  if (options.format == bake::Format::stl && repaired.read_with == bake::Weld::Kind::none) {
    return fail(kUsage,
                arguments.output +
                    ": the result has vertices at equal coordinates that are apart on purpose, and STL cannot keep them "
                    "apart; write OFF, OBJ or PLY, or leave out --split-non-manifold-vertices and --weld none");
  }
  auto exported = bake::export_mesh(repaired.soup, options);
  if (!exported) return fail(exported.error().exit_code, exported.error().message);
  bytes = std::move(*exported);
  return kClean;
}

// Unless it was asked to and had to leave the mesh as it is.
bool did_simplify(const bake::Repaired& repaired) {
  return std::none_of(repaired.actions.begin(), repaired.actions.end(),
                      [](const bake::RepairAction& action) { return action.name == "simplify" && action.left != 0; });
}

int run_repair(RepairArguments& arguments) {
  if (const int code = check(arguments); code != kClean) return code;
  std::optional<AtomicFile> out, report;
  if (!arguments.dry_run) out.emplace(arguments.output);
  if (out && !out->ok()) return fail(kFile, out->error());
  if (!arguments.report.empty()) report.emplace(arguments.report);
  if (report && !report->ok()) return fail(kFile, report->error());

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
  if (report) {
    report->write(bake::repair_json(*repaired, is_written ? arguments.output : ""));
    if (!report->commit()) return fail(kFile, report->error());
  }
  if (is_written) {
    out->write(bytes);
    if (!out->commit()) return fail(kFile, out->error());
  }
  if (!arguments.quiet) {
    const bool is_stdout_taken = arguments.output == "-" || arguments.report == "-";
    std::FILE* const stream = is_stdout_taken ? stderr : stdout;
    std::fputs(account(*repaired, *soup).c_str(), stream);
    const bool colour = wants_colour(is_stdout_taken ? Stream::standard_error : Stream::standard_output);
    std::fputs(bake::report_text(repaired->after, colour).c_str(), stream);
    if (repaired->read_with == bake::Weld::Kind::none)
      std::fputs("read it with --weld none: vertices at equal coordinates are apart on purpose\n", stream);
  }
  return repaired->after.passes() && did_simplify(*repaired) ? kClean : kFindings;
}

void add_step_options(CLI::App& command, const std::shared_ptr<RepairArguments>& arguments) {
  bake::RepairOptions& options = arguments->options;
  const auto add_flag = [&command](const char* name, bool& value, const char* help) {
    command.add_flag(name, value, help)->group("Repairs");
  };
  add_flag("--all", arguments->all,
           "All repairs that do not move the surface: --weld exact and the flags below, without --simplify.");
  const auto parse_weld = [arguments](const std::string& text) { arguments->weld = parse_weld_value(text); };
  command
      .add_option_function<std::string>("--weld", parse_weld,
                                        offering("Join vertices: exact at equal coordinates, none not at all, a number within "
                                                 "that distance in the file's units.",
                                                 {"exact", "none"}))
      ->type_name("DISTANCE")
      ->group("Repairs");
  add_flag("--drop-degenerate", options.drop_degenerate_faces, "Drop faces without area, and join the faces on either side.");
  add_flag("--drop-duplicates", options.drop_duplicate_faces, "Drop faces that have the vertices of an earlier one.");
  add_flag("--split-non-manifold-vertices", options.split_non_manifold_vertices,
           "Give each fan of faces around a vertex a vertex of its own. Implies --weld exact; the result must be read with "
           "--weld none.");
  add_flag("--orient", options.orient,
           "Make the winding of each patch consistent, and that of closed patches of mixed winding outward.");
  add_flag("--reverse-inside-out", options.reverse_inside_out,
           "Reverse closed patches that enclose negative volume, by nesting depth.");
  const auto parse_error = [arguments](const std::string& text) {
    const auto error = parse_number_between(text, 0, std::numeric_limits<double>::infinity());
    if (!error) throw CLI::ValidationError("--simplify", "'" + text + "' is no distance above 0 in the file's units");
    arguments->options.simplify_error = *error;
  };
  command
      .add_option_function<std::string>("--simplify", parse_error,
                                        "Reduce the number of triangles and keep the topology. No point of either surface is "
                                        "farther than ERROR, in the file's units, from the other.")
      ->type_name("ERROR")
      ->group("Repairs");
}

}  // namespace

Command add_repair(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("repair", "Repair a mesh safely; every repair is counted and listed.");
  command->footer(R"(Examples:
  fdcg repair scan.ply -o clean.ply --all
  fdcg repair part.stl -o part.obj --weld exact --drop-degenerate --orient
  fdcg repair --all --dry-run --report account.json part.stl

Defects that cannot be repaired safely are left and reported.

)" + exit_codes("the result has no errors",
                "errors are left, or --simplify could not be done; the mesh is written unless --strict"));
  const auto arguments = std::make_shared<RepairArguments>();
  command->add_option("mesh", arguments->mesh, "Mesh file: OFF, OBJ, PLY, STL, glTF, GLB or Draco. - is standard input.")
      ->required()
      ->type_name("MESH");
  command->add_option("-o,--output", arguments->output, "File to write the repaired mesh to. - is standard output.")
      ->type_name("FILE")
      ->group("Output");
  const auto choose = [](const char* option, std::string& target) {
    return [option, &target](const std::string& value) {
      require_choice(option, value, {"off", "obj", "ply", "stl"});
      target = value;
    };
  };
  command
      ->add_option_function<std::string>("--format", choose("--format", arguments->format),
                                         one_of("Format of the repaired mesh.", {"off", "obj", "ply", "stl"}))
      ->type_name("FORMAT")
      ->default_str("by the file's extension")
      ->group("Output");
  add_input_format_option(*command, arguments->input_format);
  command->add_flag("--ascii", arguments->ascii, "Write PLY and STL as text.")->group("Output");
  add_step_options(*command, arguments);
  command->add_option("--report", arguments->report, "Write what was done and left as JSON to FILE.")
      ->type_name("FILE")
      ->group("Output");
  command->add_flag("--dry-run", arguments->dry_run, "Write no mesh.")->group("Output");
  command->add_flag("--strict", arguments->strict, "Write the mesh only if no error is left.")->group("Output");
  command->add_flag("-q,--quiet", arguments->quiet, "Print errors only, and no progress bar.")->group("Output");
  return {command, [arguments] { return run_repair(*arguments); }};
}

}  // namespace fdcg::tools
