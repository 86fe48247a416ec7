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
#include "repair_settings.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

struct RepairArguments : RepairSettings {
  std::string mesh;
  std::string output;
  std::string report;
  bool dry_run = false;
  bool quiet = false;
};

// What can be known to be wrong before any work is done.
int check(RepairArguments& arguments) {
  if (const std::string wrong = settle(arguments); !wrong.empty()) return fail(kUsage, wrong);
  if (arguments.dry_run) return kClean;
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a file; --dry-run writes none");
  if (!arguments.format) arguments.format = written_format(arguments.output);
  if (!arguments.format)
    return fail(kUsage, "'" + arguments.output + "' does not end in .off, .obj, .ply or .stl; name the format with --format");
  suit_format(arguments);
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

  bake::Result<std::string> exported = std::string();
  if (!arguments.dry_run) exported = export_repaired(arguments, *repaired, arguments.output);
  if (!exported) fail(exported.error().exit_code, exported.error().message);
  if (!exported && exported.error().exit_code > kFindings) return exported.error().exit_code;
  const std::string bytes = exported ? std::move(*exported) : std::string();
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
  add_repair_settings(*command, *arguments);
  output.text("--report", "FILE", arguments->report, "Write what was done and left as JSON to FILE.");
  output.flag("--dry-run", arguments->dry_run, "Write no mesh.");
  output.flag("-q,--quiet", arguments->quiet, "Print errors only, and no progress bar.");
  return {command, [arguments] { return run_repair(*arguments); }};
}

}  // namespace fdcg::tools
