// SPDX-License-Identifier: Apache-2.0
// fdcg view: meshes, graphs and replay logs as one page for a browser.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "../common/atomic_file.hpp"
#include "../common/heap.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "compile_settings.hpp"
#include "fdcg/bake.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"
#include "mesh_list.hpp"
#include "mesh_options.hpp"
#include "page/page_writer.hpp"
#include "view_input.hpp"
#include "view_mesh.hpp"

namespace fdcg::tools {
namespace {

struct ViewArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string unit_text;
  std::string graphs;
  MeshView mesh;
  bool open = false;
  bool quiet = false;
};

// A robot's meshes are named by its description.
const std::string& named_first(const std::vector<ListedMesh>& inputs) {
  return inputs.front().robot.empty() ? inputs.front().path : inputs.front().robot;
}

// Beside where the command runs: the first input's name with .html.
std::string output_of(const ViewArguments& arguments, const std::vector<ListedMesh>& inputs) {
  if (!arguments.output.empty()) return arguments.output;
  const std::string& first = named_first(inputs);
  return first == "-" ? "view.html" : std::filesystem::path(first).filename().string() + ".html";
}

std::string title_of(const std::vector<ListedMesh>& inputs) {
  std::string title = std::filesystem::path(named_first(inputs)).filename().string();
  const bool is_one_robot = !inputs.front().robot.empty() && inputs.front().robot == inputs.back().robot;
  if (inputs.size() > 1 && !is_one_robot) title += " and " + std::to_string(inputs.size() - 1) + " more";
  return title + " - fdcg";
}

// Hands the page to the system's browser. What it prints is of no use here.
int open_page(const std::string& path) {
  std::error_code ignored;
  const std::string absolute = std::filesystem::absolute(path, ignored).string();
  const pid_t child = fork();
  if (child == 0) {
    if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr) _exit(127);
    execlp("xdg-open", "xdg-open", absolute.c_str(), static_cast<char*>(nullptr));
    execlp("open", "open", absolute.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0) return kClean;
  return fail(kFile, "--open: neither xdg-open nor open could show " + path + "; open it in a browser yourself");
}

// Logs go with the graph that stands before them.
int add_inputs(const ViewArguments& arguments, std::vector<ViewInput>& inputs, page::PageWriter& page) {
  int code = kClean;
  const auto failed = [&code](int of_input, const std::string& message) { code = std::max(code, fail(of_input, message)); };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    ViewInput& input = inputs[i];
    if (!input.error.empty()) {
      failed(kFile, input.error);
    } else if (input.kind == ViewKind::mesh) {
      const std::string error = add_mesh_view(arguments.mesh, input.file, page);
      if (!error.empty()) failed(kFile, error);
    } else if (input.kind == ViewKind::session) {
      const std::string error = page.add_session(input.file.path, arguments.graphs);
      if (!error.empty()) failed(kFile, error);
    } else {
      const auto as_text = [](const ViewInput& from) {
        return std::string_view(reinterpret_cast<const char*>(from.bytes.data()), from.bytes.size());
      };
      const bool has_log = input.kind == ViewKind::graph && i + 1 < inputs.size() && inputs[i + 1].kind == ViewKind::log &&
                           inputs[i + 1].error.empty();
      if (has_log) {
        page.add_graph(input.file.path, input.bytes, inputs[i + 1].file.path, as_text(inputs[i + 1]));
        ++i;
      } else if (input.kind == ViewKind::graph) {
        page.add_graph(input.file.path, input.bytes);
      } else {
        page.add_log(input.file.path, as_text(input));
      }
    }
  }
  return code;
}

int run_view(const ViewArguments& arguments) {
  if (const std::string reason = page::viewer_missing(); !reason.empty()) {
    return fail(kFile, "this fdcg has no viewer: " + reason +
                           "; install what the group viewer of tools/packages names and build fdcg again (docs/view.md)");
  }
  const MeshList list = list_meshes(arguments.inputs);
  const std::vector<ListedMesh>& named = list.meshes;
  for (const ListedMesh& file : named) {
    if (!file.problem.empty() && (file.robot.empty() || named.size() == 1)) return fail(kFile, file.path + ": " + file.problem);
  }
  if (named.empty()) return fail(kFile, "there is no mesh in what was named");
  for (const std::string& note : list.notes) {
    if (!arguments.quiet) std::fputs(("fdcg: " + note + "\n").c_str(), stderr);
  }
  const std::string output = output_of(arguments, named);
  if (arguments.open && is_stream(output)) return fail(kUsage, "--open needs a file after -o, not " + output);
  for (const ListedMesh& file : named) {
    if (is_same_file(file.path, output) || is_same_file(file.robot, output))
      return fail(kUsage, "'" + output + "' would overwrite an input");
  }
  AtomicFile out(output);
  if (!out.ok()) return fail(kFile, out.error());
  keep_large_arrays();
  std::vector<ViewInput> inputs;
  for (const ListedMesh& file : named)
    inputs.push_back(read_view_input(file));
  page::PageWriter page([&out](std::string_view piece) { out.write(piece); }, title_of(named));
  const int code = add_inputs(arguments, inputs, page);
  if (code != kClean && named.size() == 1) return code;  // a page of nothing helps nobody
  page.finish();
  if (const int failed = commit_all({&out}); failed != kClean) return failed;
  if (!arguments.quiet && !is_stream(output)) std::printf("%s\n", output.c_str());
  return arguments.open ? std::max(code, open_page(output)) : code;
}

}  // namespace

Command add_view(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("view", "Write a page to see and feel meshes and graphs in a browser.");
  command->footer(R"(Examples:
  fdcg view bunny.off --open
  fdcg view scan.stl --units mm --repair -o scan.html
  fdcg view ball.stl --normals faces --crease 60
  fdcg view robot.urdf
  fdcg view bunny.fdcg
  fdcg view bunny.fdcg log.csv -o slide.html
  fdcg view session.fdcglog

The page is one file that needs no network: geometry, findings, the runtime and the viewer. A mesh without errors is also
compiled, so that the mouse feels it. A replay's log goes with the graph before it. The log of a session has its scene with it,
but for the graphs.

)" + exit_codes("the page is written, whatever was found", "not used"));
  const auto arguments = std::make_shared<ViewArguments>();
  MeshView& mesh = arguments->mesh;
  required_argument(
      *command, "input", "INPUT...", arguments->inputs,
      "Mesh files, FDCG files, logs of 'fdcg-servo replay' and 'fdcg-servo run', robots (URDF, SDF: the meshes that they "
      "name), patterns, or folders to search for meshes. - is a mesh on standard input.");
  const OptionGroup output(*command, "Output"), checks(*command, "Mesh checks"), touch(*command, "Touch"),
      session(*command, "Log of a session");
  output.text("-o,--output", "FILE", arguments->output, "Page to write. - is standard output.",
              "the first input's name with .html");
  output.flag("--open", arguments->open, "Open the page in the browser.");
  output.flag("-q,--quiet", arguments->quiet, "Print errors only. No progress bar.");
  add_input_format_option(*command, mesh.input_format);
  add_unit_options(*command, mesh.metres_per_unit, arguments->unit_text);
  add_weld_option(checks, mesh.weld);
  checks.flag("--repair", mesh.repair, "Show what 'fdcg repair --all' makes of a mesh with errors beside it.");
  touch.choice<bake::Precision>("--precision", "PRECISION", {{"f32", bake::Precision::f32}, {"f64", bake::Precision::f64}},
                                mesh.precision, "Precision of the graph that is touched.");
  touch.flag("!--no-touch", mesh.touch, "Leave the graph of a mesh out: a smaller page, without touch.");
  add_shading_options(touch, mesh.felt);
  add_heights_options(touch, mesh.felt, mesh.heights);
  session.text("--graphs", "FOLDER", arguments->graphs, "Folder of the graphs.", "where they were");
  OptionGroup(*command, "General").jobs(mesh.jobs, "The page does not depend on it.");
  return {command, [arguments] {
            arguments->mesh.shows_progress = !arguments->quiet;
            arguments->mesh.has_unit = !arguments->unit_text.empty();
            return run_view(*arguments);
          }};
}

}  // namespace fdcg::tools
