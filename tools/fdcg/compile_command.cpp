// SPDX-License-Identifier: Apache-2.0
// fdcg compile: a mesh in, an FDCG file out, or a report and nothing written.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

#include "../common/atomic_file.hpp"
#include "../common/heap.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "compile_settings.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"
#include "mesh_options.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

struct CompileArguments : CompileSettings {
  std::string mesh;
  std::string output;
  std::string depfile;
  std::string report;
  bool quiet = false;
  bool verbose = false;
};

// Spaces, # and $ as Make and Ninja want them in a file name.
std::string escaped_for_make(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (c == ' ' || c == '#' || c == '\\') text += '\\';
    if (c == '$') text += '$';
    text += c;
  }
  return text;
}

fdcg_header header_of(const bake::Compiled& compiled) {
  fdcg_header header;
  std::memcpy(&header, compiled.file().data(), sizeof header);
  return header;
}

// Of the file as it stands in memory: what it weighs, or why it does not say.
std::string mass_summary(const bake::Compiled& compiled) {
  fdcg_graph graph{};
  fdcg_mass mass{};
  const bool has_mass =
      fdcg_open_memory(compiled.file().data(), compiled.file().size(), FDCG_VERIFY_TRUSTED, &graph, nullptr) == FDCG_OK &&
      fdcg_get_mass(&graph, &mass, nullptr) == FDCG_OK;
  if (!has_mass) return compiled.no_mass.empty() ? "" : "no mass properties: " + compiled.no_mass + "\n";
  const std::string volume = "volume " + short_number(mass.volume_m3) + " m^3";
  if (mass.mass_kg == 0) return volume + "; its mass is not known (--density, --mass)\n";
  return volume + ", " + short_number(mass.density_kg_per_m3) + " kg/m^3, so it weighs " + short_number(mass.mass_kg) + " kg\n";
}

// A mass that the mesh file states is not taken unasked: with one, a mesh that encloses no solid is refused.
std::string stated_mass(const CompileArguments& arguments, const bake::PolygonSoup& soup) {
  if (arguments.options.mass_kg != 0 || arguments.options.density_kg_per_m3 != 0) return {};
  const auto has_mass = [](const bake::PhysicsBody& body) { return body.mass_kg > 0; };
  const std::vector<bake::PhysicsBody>& bodies = soup.physics.bodies;
  const auto first = std::find_if(bodies.begin(), bodies.end(), has_mass);
  if (first == bodies.end()) return {};
  const std::string mass = shown_number(first->mass_kg);
  return "the file states " + mass + " kg for '" + first->node + "'" +
         (std::count_if(bodies.begin(), bodies.end(), has_mass) == 1 ? "; --mass " + mass + " takes it\n" : " and others\n");
}

// What the repair did, and how far it moved the surface.
std::string repair_summary(const bake::RepairAccount& account, double metres_per_unit) {
  std::string text;
  for (const bake::RepairAction& action : account.actions) {
    if (action.total != 0) text += "  " + action.name + ": " + action.message + "\n";
    if (action.left != 0) text += "  " + action.name + ": " + action.left_message + "\n";
  }
  if (text.empty()) return "repair: nothing blocked\n";
  const double cube = metres_per_unit * metres_per_unit * metres_per_unit;
  return "repair: the surface moved by at most " + short_number(account.distance * metres_per_unit) +
         " m, its volume changed by " + short_number((account.volume_after - account.volume_before) * cube) + " m^3\n" + text;
}

// What came out, for a person: sizes, types, and everything that was changed on the way.
std::string summary(const CompileArguments& arguments, const bake::PolygonSoup& soup, const bake::Compiled& compiled) {
  const fdcg_header header = header_of(compiled);
  const double scale = header.metres_per_unit;
  std::string size;
  for (int axis = 0; axis < 3; ++axis) {
    size += (axis == 0 ? "" : " x ") + short_number((header.bounds_max[axis] - header.bounds_min[axis]) * scale);
  }
  const std::uint32_t* const types = header.connection_type_count;
  std::string text =
      soup.name + ": " + counted(header.source_vertex_count, "point") + ", " + counted(header.source_face_count, "face") + "\n";
  text += "units: " + arguments.unit_text + ", so the object measures " + size + " m\n";
  const auto changed = [&text](std::uint64_t count, const std::string& what) {
    if (count != 0) text += counted(count, "face") + " " + what + "\n";
  };
  changed(compiled.flipped_faces, "turned round by --orient");
  if (compiled.repair) text += repair_summary(*compiled.repair, header.metres_per_unit);
  changed(compiled.split_faces, "split: not convex or not planar");
  changed(compiled.merged_faces, "merged with coplanar neighbours");
  changed(compiled.shaded_faces, "with normals at their corners, for force shading");
  if (compiled.unusable_normals != 0)
    text +=
        counted(compiled.unusable_normals, "corner") + " flat: their normals lean from their faces by more than 60 degrees\n";
  text += header.max_deviation == 0
              ? std::string("every corner lies on the planes of its faces\n")
              : "corners lie up to " + short_number(header.max_deviation * scale) + " m off the planes of their faces\n";
  text += mass_summary(compiled) + stated_mass(arguments, soup);
  text += arguments.output + ": " + counted(header.node_count, "node") + ", " + counted(header.connection_count, "connection") +
          " (" + grouped(types[FDCG_CONVEX]) + " convex, " + grouped(types[FDCG_CONCAVE]) + " concave, " +
          grouped(types[FDCG_COPLANAR]) + " coplanar, " + grouped(types[FDCG_BOUNDARY]) + " boundary), " +
          counted(header.corner_count, "corner") + ", " + counted(header.file_bytes, "byte") + "\n";
  return text;
}

// Of the bounding box, in the file's unit.
double largest_side(const fdcg_header& header) {
  double size = 0;
  for (int axis = 0; axis < 3; ++axis)
    size = std::max(size, header.bounds_max[axis] - header.bounds_min[axis]);
  return size;
}

// A large --coplanar ANGLE flattens what is not flat. Empty where that is no more than a hand may overlook: a step of a
// thousandth of the object, 0.1 mm on one of 0.1 m, is 0.1 N at 1 N/mm, which is felt.
std::string deviation_warning(const bake::Compiled& compiled) {
  constexpr double kLargestShare = 1e-3;
  const fdcg_header header = header_of(compiled);
  const double size = largest_side(header);
  if (!(header.max_deviation > kLargestShare * size)) return {};
  return "planes lie up to " + short_number(header.max_deviation * header.metres_per_unit) +
         " m off the corners of their faces, " + short_number(100 * header.max_deviation / size) +
         " % of the object's size (warned of above " + short_number(100 * kLargestShare) +
         " %); --coplanar with a smaller angle keeps the shape";
}

// A size that nobody feels is most often a wrong unit. Empty where it is plausible, or where the unit was given and the object
// is large on purpose.
std::string size_warning(const CompileArguments& arguments, const bake::Compiled& compiled) {
  constexpr double kLargest_m = 10, kSmallest_m = 1e-3;
  const fdcg_header header = header_of(compiled);
  const double size_m = largest_side(header) * header.metres_per_unit;
  const std::string measures = "the object measures " + short_number(size_m) + " m; ";
  if (size_m > kLargest_m && arguments.has_default_unit())
    return measures + "if the file is in millimetres, compile with --units mm (--units m: it is in metres, and no warning)";
  if (size_m < kSmallest_m) {
    return measures + (arguments.has_default_unit() ? "if the file is not in metres, give its unit with --scale METRES"
                                                    : "if the file is in metres, leave out --units and --scale");
  }
  return {};
}

std::string_view as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Everything is written before anything gets its name, so that a failure leaves nothing.
int write_outputs(const CompileArguments& arguments, const std::string& mesh_report,
                  const std::vector<std::string>& other_files, const std::vector<std::byte>& buffer, AtomicFile& out) {
  out.write(as_text(buffer));  // empty where the file was made in place
  AtomicFile depfile(arguments.depfile), report(arguments.report);
  std::string rule = escaped_for_make(arguments.output) + ": " + escaped_for_make(arguments.mesh);
  for (const std::string& file : other_files)
    rule += " " + escaped_for_make(file);
  depfile.write(rule + "\n");
  if (report.is_wanted()) report.write(mesh_report);
  return commit_all({&report, &depfile, &out});
}

// The mesh is refused: its report on standard error, and in --report.
int refuse(const CompileArguments& arguments, const bake::Compiled& compiled) {
  const std::string text = bake::report_text(compiled.report, wants_colour(Stream::standard_error));
  std::fputs(text.c_str(), stderr);
  if (arguments.repair.empty()) std::fputs("--repair repairs the mesh first, and says what that does to it\n", stderr);
  AtomicFile file(arguments.report);
  if (file.is_wanted()) file.write(bake::compile_report_json(compiled));
  return commit_all({&file}, kFindings);
}

int check_paths(const CompileArguments& arguments) {
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a file; it is empty");
  const auto is_same = [](const std::string& a, const std::string& b) { return !a.empty() && (a == b || is_same_file(a, b)); };
  if (is_same(arguments.output, arguments.report) || is_same(arguments.output, arguments.depfile) ||
      is_same(arguments.report, arguments.depfile))
    return fail(kUsage, "-o, --report and --depfile must be different files");
  for (const std::string* path : {&arguments.output, &arguments.depfile, &arguments.report}) {
    if (is_same_file(arguments.mesh, *path)) return fail(kUsage, "'" + *path + "' would overwrite the mesh itself");
  }
  for (const std::string* path : {&arguments.mesh, &arguments.output}) {
    if (arguments.depfile.empty() || path->find_first_of("\r\n") == std::string::npos) continue;
    std::string shown = *path;
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c == '\r' || c == '\n'; }, '?');
    return fail(kUsage, "--depfile: neither Make nor Ninja can name '" + shown + "', which has a line break; rename the file");
  }
  if (arguments.mesh == "-" && !arguments.depfile.empty()) return fail(kUsage, "--depfile needs a mesh file, not -");
  if (arguments.output == "-" && !arguments.depfile.empty()) return fail(kUsage, "--depfile needs a file name after -o, not -");
  return kClean;
}

// The output file itself where it can be mapped; else a buffer, to be written at the end.
std::span<std::byte> memory_for(AtomicFile& out, std::size_t bytes, std::vector<std::byte>& buffer) {
  give_back_free_memory();
  const std::span<std::byte> mapped = out.map(bytes);
  if (!mapped.empty() || !out.ok()) return mapped;
  buffer.resize(bytes);
  return buffer;
}

int compile_mesh(CompileArguments& arguments) {
  if (const int code = check_paths(arguments); code != kClean) return code;
  if (const std::string wrong = settle(arguments); !wrong.empty()) return fail(kUsage, wrong);
  AtomicFile out(arguments.output);
  if (!out.ok()) return fail(kFile, out.error());
  keep_large_arrays();
  ProgressBar bar(!arguments.quiet);
  bake::ImportOptions import_options{arguments.input_format, {}};
  import_options.progress =
      arguments.options.progress = [&bar](std::string_view stage, double done) { bar.update(stage, done); };
  import_options.normals = arguments.options.normals == bake::Normals::file || arguments.options.visual;
  import_options.appearance = arguments.options.visual || arguments.options.heights;
  import_options.heights = arguments.heights;
  import_options.haptic_materials = arguments.haptic_materials;
  auto soup = import_input(arguments.mesh, import_options);
  bar.wipe();
  if (!soup) return fail(soup.error().exit_code, soup.error().message);
  for (const std::string& file : soup->other_files) {
    if (is_same_file(file, arguments.output))
      return fail(kUsage, "'" + arguments.output + "' would overwrite a part of the mesh");
  }
  take_unit(*soup, arguments);
  out.expect(bake::likely_file_bytes(*soup, arguments.options));
  std::vector<std::byte> buffer;
  arguments.options.allocate = [&](std::size_t bytes) { return memory_for(out, bytes, buffer); };
  const auto compiled = bake::compile(std::move(*soup), arguments.options);
  bar.wipe();
  if (!out.ok()) return fail(kFile, out.error());
  if (!compiled) return fail(compiled.error().exit_code, compiled.error().message);
  if (compiled->file().empty()) return refuse(arguments, *compiled);
  if (const std::string reason = refused_by_runtime(*compiled); !reason.empty()) return fail(kUsage, reason);
  const bool is_streamed = is_stream(arguments.output) || is_stream(arguments.report);
  const std::string what_was_written = summary(arguments, *soup, *compiled);  // reads the file, which commit() unmaps
  const std::string warnings[] = {deviation_warning(*compiled), size_warning(arguments, *compiled)};
  if (const int code = write_outputs(arguments, bake::compile_report_json(*compiled), soup->other_files, buffer, out);
      code != kClean)
    return code;
  if (arguments.quiet) return kClean;
  std::FILE* const stream = is_streamed ? stderr : stdout;
  if (arguments.verbose || !compiled->report.passes(bake::Severity::warning)) {
    const bool colour = wants_colour(is_streamed ? Stream::standard_error : Stream::standard_output);
    std::fputs(bake::report_text(compiled->report, colour).c_str(), stream);
  }
  std::fputs(what_was_written.c_str(), stream);
  for (const std::string& warning : warnings)
    if (!warning.empty()) warn(arguments.mesh + ": " + warning);
  if (arguments.haptic_materials && soup->physics.haptic_materials.empty())
    warn(arguments.mesh + ": --haptic-materials: the file states no MPEG_haptic_material");
  for (const std::string& unread : soup->unread_files)
    warn(arguments.mesh + ": " + unread);
  return kClean;
}

int run_compile(CompileArguments& arguments) {
  try {
    return compile_mesh(arguments);
  } catch (const std::bad_alloc&) {
    return fail(kFile, arguments.mesh +
                           ": not enough memory to compile it; cut the mesh into parts, simplify it, or use a "
                           "machine (or a limit) with more");
  }
}

}  // namespace

Command add_compile(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("compile", "Compile a mesh into an FDCG file.");
  command->footer(R"(Examples:
  fdcg compile bunny.off -o bunny.fdcg
  fdcg compile part.stl -o part.fdcg --units mm --coplanar 0.5 --precision f32
  fdcg compile scan.ply -o scan.fdcg --orient --depfile scan.d --report scan.json
  fdcg compile cube.obj -o - | fdcg inspect -
  fdcg compile hammer.stl -o hammer.fdcg --units mm --density 7850

A mesh with errors is refused with the report that 'fdcg validate' prints, and nothing is written. The same mesh and options
give the same bytes.

)" + exit_codes("the file is written", "the mesh has errors; no file is written"));
  const auto arguments = std::make_shared<CompileArguments>();
  add_mesh_argument(*command, arguments->mesh);
  add_compile_input(*command, *arguments);
  const OptionGroup output(*command, "Output");
  output.text("-o,--output", "FILE", arguments->output, "File to write. - is standard output.")->required();
  output.text("--report", "FILE", arguments->report, "Write the JSON report to FILE.");
  output.text("--depfile", "FILE", arguments->depfile, "Write the dependencies for Make and Ninja to FILE.");
  CLI::Option* const quiet = output.flag("-q,--quiet", arguments->quiet, "Print errors only.");
  output.flag("-v,--verbose", arguments->verbose, "Print the whole report.")->excludes(quiet);
  add_compile_settings(*command, *arguments);
  OptionGroup(*command, "General").jobs(arguments->options.jobs, "The output does not depend on it.");
  return {command, [arguments] { return run_compile(*arguments); }};
}

}  // namespace fdcg::tools
