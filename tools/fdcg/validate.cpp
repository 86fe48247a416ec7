// SPDX-License-Identifier: Apache-2.0
// fdcg validate: every check on every file, each defect located.
#include <algorithm>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "command.hpp"
#include "fdcg/bake.hpp"
#include "mesh_options.hpp"

namespace fdcg::tools {
namespace {

struct ValidateArguments {
  std::vector<std::string> meshes;
  std::string format = "text";
  std::string output = "-";
  bake::ValidateOptions options;
  bool quiet = false;
};

// A file that gave no mesh stands in the report too, under the rule that says why.
bake::Report report_of_failure(const std::string& file, const bake::Failure& failure) {
  bake::Report report;
  report.file = file;
  bake::Issue issue;
  issue.rule = failure.rule.empty() ? "unreadable" : failure.rule;
  issue.total = 1;
  issue.message = failure.message;
  report.issues.push_back(std::move(issue));
  report.checks = {"unreadable", "empty-mesh"};
  return report;
}

std::optional<bake::Severity> severity_of(const std::string& name) {
  if (name == "never") return std::nullopt;
  if (name == "note") return bake::Severity::note;
  return name == "warning" ? bake::Severity::warning : bake::Severity::error;
}

int run_validate(ValidateArguments& arguments) {
  for (const std::string& mesh : arguments.meshes) {
    if (is_same_file(mesh, arguments.output))
      return fail(kUsage, "-o " + arguments.output + " would overwrite the mesh itself");
  }
  AtomicFile out(arguments.output);
  if (!out.ok()) return fail(kFile, out.error());
  int code = kClean;
  std::vector<bake::Report> reports;
  for (const std::string& mesh : arguments.meshes) {
    ProgressBar bar(!arguments.quiet);
    bake::ImportOptions import_options;
    import_options.progress =
        arguments.options.progress = [&bar](std::string_view stage, double done) { bar.update(stage, done); };
    const auto soup = bake::import_mesh(mesh, import_options);
    if (soup) {
      reports.push_back(bake::validate(*soup, arguments.options));
      bar.wipe();
      if (!reports.back().passes()) code = std::max<int>(code, kFindings);
      continue;
    }
    bar.wipe();
    code = std::max(code, fail(soup.error().exit_code, soup.error().message));
    reports.push_back(report_of_failure(mesh, soup.error()));
  }
  if (arguments.format == "json") {
    out.write(bake::report_json(reports));
  } else {
    const bool colour = arguments.output == "-" && wants_colour(Stream::standard_output);
    for (const bake::Report& report : reports) {
      if (arguments.quiet && report.passes()) continue;
      out.write(bake::report_text(report, colour));
    }
  }
  return out.commit() ? code : std::max<int>(code, fail(kFile, out.error()));
}

}  // namespace

Command add_validate(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("validate", "Every check on a mesh, every defect located");
  command->footer(R"(
Examples:
  fdcg validate part.stl
  fdcg validate --format json -o report.json meshes/*.ply
  fdcg validate --fail-on warning --allow boundary-edge scan.obj)");
  const auto arguments = std::make_shared<ValidateArguments>();
  command->add_option("mesh", arguments->meshes, "Mesh files: OFF, OBJ, PLY, STL")->required()->type_name("MESH");
  const auto check_format = [arguments](const std::string& value) {
    if (value == "sarif" || value == "junit") {
      throw CLI::ValidationError("--format", value + " is not written by this version; choose text or json");
    }
    require_choice("--format", value, {"text", "json"});
    arguments->format = value;
  };
  command->add_option_function<std::string>("--format", check_format, "text (default) or json")->type_name("text|json");
  command->add_option("-o,--output", arguments->output, "Write the report to FILE; - is standard output (default)")
      ->type_name("FILE");
  add_weld_option(*command, arguments->options.weld);
  add_precision_option(*command, arguments->options.precision,
                       "Judge the mesh as a graph of this precision stores it; default: f64");
  command->add_flag("--orient", arguments->options.orient, "Judge the mesh as 'compile --orient' leaves it");
  const auto check_fail_on = [arguments](const std::string& value) {
    require_choice("--fail-on", value, {"error", "warning", "note", "never"});
    arguments->options.fail_on = severity_of(value);
  };
  command->add_option_function<std::string>("--fail-on", check_fail_on, "Findings from this severity on give exit code 1")
      ->type_name("error|warning|note|never");
  add_allow_option(*command, arguments->options.allow, Allowable::also_warnings_and_notes);
  command->add_flag("-q,--quiet", arguments->quiet, "Text: only files that fail; no progress bar");
  return {command, [arguments] { return run_validate(*arguments); }};
}

}  // namespace fdcg::tools
