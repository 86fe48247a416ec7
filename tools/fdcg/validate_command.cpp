// SPDX-License-Identifier: Apache-2.0
// fdcg validate: every check on every file, each defect located, in the formats that people and CI systems read.
#include <algorithm>
#include <ctime>
#include <deque>
#include <filesystem>
#include <map>
#include <set>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "baseline.hpp"
#include "fdcg/bake.hpp"
#include "fdcg_commands.hpp"
#include "mesh_list.hpp"
#include "validate_choices.hpp"
#include "validate_config.hpp"
#include "validate_run.hpp"
#include "view_mesh.hpp"

namespace fdcg::tools {
namespace {

struct Output {
  std::optional<bake::ReportFormat> format;  // none: a page, as fdcg view writes it
  std::string path;
};

struct ValidateArguments : ValidateChoices {
  std::vector<std::string> meshes;
  std::optional<Output> output_format;  // of -o: its path is not set
  std::vector<Output> files;            // FORMAT=FILE
  std::string output = "-";
  std::string full;
  std::string config;
  bool no_config = false;
  bool sarif_each = false;
  unsigned jobs = 0;
  bool quiet = false;
};

const std::vector<std::string> kReportFormatNames{"text", "json", "sarif", "junit", "html"};
const std::map<std::string, std::optional<bake::ReportFormat>> kReportFormats{{"text", bake::ReportFormat::text},
                                                                              {"json", bake::ReportFormat::json},
                                                                              {"sarif", bake::ReportFormat::sarif},
                                                                              {"junit", bake::ReportFormat::junit},
                                                                              {"html", std::nullopt}};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "2000-01-01T00:00:00"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  return text;
}

// ---- what is to be done

std::vector<Output> outputs_of(const ValidateArguments& arguments) {
  std::vector<Output> outputs{arguments.output_format.value_or(Output{bake::ReportFormat::text, {}})};
  outputs.front().path = arguments.output;
  outputs.insert(outputs.end(), arguments.files.begin(), arguments.files.end());
  return outputs;
}

bool wants_page(const ValidateArguments& arguments) {
  const std::vector<Output> outputs = outputs_of(arguments);
  return std::any_of(outputs.begin(), outputs.end(), [](const Output& output) { return !output.format; });
}

int check_paths(const ValidateArguments& arguments, const std::vector<ListedMesh>& meshes) {
  std::vector<std::string> paths;
  for (const Output& output : outputs_of(arguments))
    paths.push_back(output.path);
  if (!arguments.full.empty()) paths.push_back(arguments.full);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) return fail(kUsage, "an output needs the name of a file; it is empty");
    for (std::size_t j = 0; j < i; ++j) {
      if (paths[i] == paths[j] || is_same_file(paths[i], paths[j]))
        return fail(kUsage, "two reports would both be written to '" + paths[i] + "'; name another file for one of them");
    }
    if (paths[i] == "-") continue;
    for (const ListedMesh& mesh : meshes) {
      if (is_same_file(mesh.path, paths[i])) return fail(kUsage, "'" + paths[i] + "' would overwrite the mesh itself");
    }
  }
  return kClean;
}

// Settings of each mesh: its configuration file's, and over them the command line's.
bake::Result<std::vector<ValidateTask>> tasks_of(const ValidateArguments& arguments, const std::vector<ListedMesh>& meshes,
                                                 std::vector<std::string>& baselines) {
  ConfigFinder finder;
  std::set<std::string> told;
  std::vector<ValidateTask> tasks;
  for (const ListedMesh& mesh : meshes) {
    bake::Result<ValidateConfig> config = ValidateConfig{};
    if (!arguments.config.empty()) {
      config = read_config(arguments.config);
    } else if (!arguments.no_config) {
      config = finder.for_mesh(mesh.path);
    }
    if (!config) return config.error();
    const ValidateSettings settings = combined(config->settings, arguments.settings);
    if (const std::string word = lowered_errors(settings); !word.empty() && told.insert(word).second) warn(word);
    ValidateTask task;
    task.mesh = mesh.path;
    task.problem = mesh.problem;
    task.scale = mesh.scale;
    task.config = config->path;
    task.options = validate_options(arguments, settings);
    task.has_baseline = settings.baseline.has_value();
    tasks.push_back(std::move(task));
    baselines.push_back(settings.baseline.value_or(""));
  }
  return tasks;
}

// Reads each baseline once and gives every task its part; `loaded` keeps them.
std::optional<bake::Failure> load_baselines(const std::vector<std::string>& paths, std::vector<ValidateTask>& tasks,
                                            std::deque<bake::Result<Baseline>>& loaded) {
  std::map<std::string, std::vector<std::size_t>> users;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!paths[i].empty()) users[paths[i]].push_back(i);
  }
  for (const auto& [path, indices] : users) {
    loaded.push_back(Baseline::read(path));
    if (!loaded.back()) return loaded.back().error();
    std::vector<std::string> meshes;
    for (const std::size_t i : indices)
      meshes.push_back(tasks[i].mesh);
    const auto files = loaded.back()->files_for(meshes);
    for (std::size_t i = 0; i < indices.size(); ++i)
      tasks[indices[i]].known = files[i];
  }
  return std::nullopt;
}

// ---- what comes out

// The reports that were asked for, each to its file.
class Outputs {
 public:
  explicit Outputs(const ValidateArguments& arguments) : is_quiet_(arguments.quiet) {
    bake::ReportOptions options;
    std::error_code ignored;
    options.source_root = std::filesystem::current_path(ignored).string();
    options.result_per_element = arguments.sarif_each;
    options.timestamp = now_utc();
    for (const Output& output : outputs_of(arguments)) {
      options.colour = output.path == "-" && wants_colour(Stream::standard_output);
      AtomicFile& file = files_.emplace_back(output.path);
      const auto write = [&file](std::string_view piece) { file.write(piece); };
      if (output.format) {
        writers_.push_back({*output.format, bake::make_report_writer(*output.format, write, options)});
      } else {
        pages_.emplace_back(write, "fdcg validate");
      }
    }
    if (arguments.full.empty()) return;
    AtomicFile& file = files_.emplace_back(arguments.full);
    full_.emplace([&file](std::string_view piece) { file.write(piece); });
  }

  void add(Validated& result) {
    for (Writer& writer : writers_) {
      const bool is_wanted = !is_quiet_ || writer.format != bake::ReportFormat::text || !result.report.passes();
      if (is_wanted) writer.to->add(result.report);
    }
    for (page::PageWriter& page : pages_) {
      if (result.soup) {
        add_judged_mesh(page_view(), *result.soup, result.report, page);
      } else {
        page.add_report(result.report);
      }
    }
    if (full_ && !full_->add(result.report, result.spool)) lost_elements_ = true;
  }
  // An error's line, or nothing.
  std::string finish(int exit_code) {
    for (Writer& writer : writers_) {
      if (!is_quiet_ || writer.format != bake::ReportFormat::text) writer.to->finish(exit_code);
    }
    for (page::PageWriter& page : pages_)
      page.finish();
    if (full_) full_->finish();
    if (lost_elements_) return "--full needs room for temporary files (TMPDIR), and there is none left";
    std::string first = error();
    for (AtomicFile& file : files_) {
      if (first.empty() && !file.commit()) first = file.error();
    }
    return first;
  }
  [[nodiscard]] std::string error() const {
    for (const AtomicFile& file : files_) {
      if (!file.ok()) return file.error();
    }
    return "";
  }

 private:
  struct Writer {
    bake::ReportFormat format;
    std::unique_ptr<bake::ReportWriter> to;
  };
  // Without a graph: a page of many meshes is large as it is.
  static MeshView page_view() {
    MeshView view;
    view.touch = view.shows_progress = false;
    return view;
  }

  bool is_quiet_;
  bool lost_elements_ = false;
  std::deque<AtomicFile> files_;  // stay where they are
  std::deque<page::PageWriter> pages_;
  std::vector<Writer> writers_;
  std::optional<bake::FullReportWriter> full_;
};

int run_validate(const ValidateArguments& arguments) {
  const MeshList list = list_meshes(arguments.meshes);
  const std::vector<ListedMesh>& meshes = list.meshes;
  for (const std::string& note : list.notes) {
    if (!arguments.quiet) std::fputs(("fdcg: " + note + "\n").c_str(), stderr);
  }
  if (const int code = check_paths(arguments, meshes); code != kClean) return code;
  if (const std::string reason = page::viewer_missing(); wants_page(arguments) && !reason.empty())
    return fail(kFile, "--format html: this fdcg has no viewer: " + reason + " (docs/view.md)");
  std::vector<std::string> baselines;
  auto tasks = tasks_of(arguments, meshes, baselines);
  if (!tasks) return fail(tasks.error().exit_code, tasks.error().message);
  std::deque<bake::Result<Baseline>> loaded;
  if (const auto failure = load_baselines(baselines, *tasks, loaded)) return fail(failure->exit_code, failure->message);
  Outputs outputs(arguments);
  if (const std::string error = outputs.error(); !error.empty()) return fail(kFile, error);
  ValidateRun run;
  run.tasks = std::move(*tasks);
  run.input_format = arguments.input_format;
  run.jobs = arguments.jobs;
  run.wants_all_elements = !arguments.full.empty();
  run.keeps_meshes = wants_page(arguments);
  for (ValidateTask& task : run.tasks) {
    if (run.keeps_meshes) task.options.max_elements = kPageElements;
  }
  run.shows_progress = !arguments.quiet;
  // The text report says it too: once is enough for a person who sees both.
  const bool is_in_sight = is_terminal(Stream::standard_output) && is_terminal(Stream::standard_error) &&
                           arguments.output == "-" && outputs_of(arguments).front().format == bake::ReportFormat::text;
  int code = kClean;
  validate_all(run, [&](Validated& result) {
    if (!result.error.empty() && !is_in_sight) fail(result.exit_code, result.error);
    code = std::max(code, result.exit_code);
    outputs.add(result);
  });
  const std::string error = outputs.finish(code);
  return error.empty() ? code : std::max<int>(code, fail(kFile, error));
}

// ---- options

void add_report_options(CLI::App& command, ValidateArguments& arguments) {
  const OptionGroup output(command, "Output");
  const auto add_format = [&arguments](const std::string& value) {
    const std::size_t equals = value.find('=');
    const std::string name = value.substr(0, equals);
    require_choice("--format", name, kReportFormatNames);
    if (equals != std::string::npos) {
      arguments.files.push_back({kReportFormats.at(name), value.substr(equals + 1)});
    } else if (arguments.output_format) {
      throw CLI::ValidationError("--format", "two formats for one output; write --format " + name + "=FILE for one of them");
    } else {
      arguments.output_format = Output{kReportFormats.at(name), {}};
    }
  };
  output.repeated(
      "--format", "FORMAT", add_format,
      one_of("Format of the report; html is the page of 'fdcg view'. FORMAT=FILE writes one more report to FILE, and "
             "may be repeated.",
             kReportFormatNames),
      "text");
  output.text("-o,--output", "FILE", arguments.output, "Write the report to FILE.", "standard output");
  output.text("--full", "FILE", arguments.full, "Write all findings, without a limit, as JSON to FILE: a baseline.");
  output.flag(
      "--sarif-each", arguments.sarif_each,
      "SARIF: one result for each listed finding, so that code scanning marks every line, instead of one for each rule.");
}

void add_verdict_options(CLI::App& command, ValidateArguments& arguments) {
  const OptionGroup verdict(command, "Verdict");
  ValidateSettings& settings = arguments.settings;
  const auto set_baseline = [&settings](const std::string& path) { settings.baseline = path; };
  verdict.parsed("--baseline", "FILE", set_baseline, "Findings that are in FILE (from --full) are known; only new ones fail.");
  add_validate_verdict(command, arguments);
  const std::string name = kConfigName;
  CLI::Option* const config =
      verdict.text("--config", "FILE", arguments.config, "Read settings from FILE instead of " + name + ".");
  verdict.flag("--no-config", arguments.no_config, "Do not look for " + name + " in the mesh's folder and those above.")
      ->excludes(config);
}

}  // namespace

Command add_validate(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("validate", "Check meshes, and locate every defect.");
  command->footer(R"(Examples:
  fdcg validate part.stl
  fdcg validate 'meshes/**/*.stl' --format junit=report.xml
  fdcg validate scan.obj --format html=scan.html
  fdcg validate --fail-on warning --allow boundary-edge scan.obj
  fdcg validate meshes --full known.json; fdcg validate meshes --baseline known.json
  convert part.step | fdcg validate - --input-format stl

A pattern knows *, ?, [abc], comma-separated alternatives in curly brackets, and ** for any number of folders. Patterns and
folders match names in upper and lower case alike.

Settings may stand in a file .fdcg-validate.json in the mesh's folder or one above; the command line overrides it.

)" + exit_codes("no findings at or above --fail-on", "findings at or above --fail-on"));
  const auto arguments = std::make_shared<ValidateArguments>();
  required_argument(*command, "mesh", "MESH...", arguments->meshes,
                    "Mesh files (OFF, OBJ, PLY, STL, glTF, GLB, Draco, COLLADA, 3MF, VTK, X3D), robots (URDF, SDF) for the "
                    "meshes that they name, patterns, or folders to search. - is standard input.");
  add_report_options(*command, *arguments);
  add_verdict_options(*command, *arguments);
  add_validate_checks(*command, *arguments);
  OptionGroup(*command, "General").jobs(arguments->jobs, "The report does not depend on it.");
  OptionGroup(*command, "Output")
      .flag("-q,--quiet", arguments->quiet, "Text report: list only files that fail. No progress bar.");
  return {command, [arguments] { return run_validate(*arguments); }};
}

}  // namespace fdcg::tools
