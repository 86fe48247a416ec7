// SPDX-License-Identifier: Apache-2.0
// fdcg batch: a library of meshes, each by its rule, in one run or in shards of it.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "batch_folder.hpp"
#include "batch_merge.hpp"
#include "batch_plan.hpp"
#include "batch_run.hpp"
#include "batch_shard.hpp"
#include "fdcg_commands.hpp"

namespace fdcg::tools {
namespace {

constexpr double kDefaultCpuSeconds = 3600;

struct BatchArguments {
  std::vector<std::string> manifests;
  std::string output;
  std::string cache;
  std::optional<Shard> shard;
  double memory_mb = 0;
  double cpu_seconds = kDefaultCpuSeconds;
  unsigned jobs = 0;
  bool resume = false;
  bool merge = false;
  bool quiet = false;
};

int fail_with(const bake::Failure& failure) {
  return failure.message.empty() ? failure.exit_code : fail(failure.exit_code, failure.message);
}

std::string summary(const BatchTotals& totals) {
  std::string text = grouped(totals.meshes) + (totals.meshes == 1 ? " mesh: " : " meshes: ") + grouped(totals.clean) + " clean";
  if (totals.with_findings != 0) text += ", " + grouped(totals.with_findings) + " with findings";
  if (totals.failed != 0) text += ", " + grouped(totals.failed) + " failed";
  return text;
}

int merge_all(const BatchFolder& folder, const BatchArguments& arguments, std::uint64_t cached) {
  const auto totals = merge_shards(folder);
  if (!totals) return fail_with(totals.error());
  if (arguments.quiet) return totals->exit_code;
  std::printf("%s%s\n%s\n%s\n%s\n", summary(*totals).c_str(),
              cached == 0 ? "" : ("; " + grouped(cached) + " from the cache").c_str(), folder.results().c_str(),
              folder.report().c_str(), folder.sarif().c_str());
  return totals->exit_code;
}

bake::Result<Shard> chosen_shard(const BatchArguments& arguments) {
  if (arguments.shard) return *arguments.shard;
  return shard_of([](const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  });
}

int run(const BatchFolder& folder, const BatchPlan& plan, const Shard& shard, const BatchArguments& arguments) {
  BatchRun how;
  how.shard = shard;
  how.cache = arguments.cache.empty() ? folder.cache() : arguments.cache;
  how.jobs = arguments.jobs;
  how.memory_bytes = static_cast<std::uint64_t>(arguments.memory_mb * 1e6);
  how.cpu_seconds = arguments.cpu_seconds;
  how.is_quiet = arguments.quiet;
  const auto counts = run_batch(plan, folder, how);
  if (!counts) return fail_with(counts.error());
  if (shard.of == 1) {
    const int code = merge_all(folder, arguments, counts->cached);
    std::error_code ignored;
    std::filesystem::remove(folder.shard(shard), ignored);
    std::filesystem::remove(folder.shards(), ignored);  // if it is empty
    return code;
  }
  if (!arguments.quiet)
    std::printf("shard %zu/%zu: %s of %s meshes%s\n%s\n", shard.number, shard.of, grouped(counts->meshes).c_str(),
                grouped(plan.tasks.size()).c_str(),
                counts->cached == 0 ? "" : (", " + grouped(counts->cached) + " from the cache").c_str(),
                folder.shard(shard).c_str());
  return counts->exit_code;
}

int run_batch_command(const BatchArguments& arguments) {
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a folder; it is empty");
  BatchFolder folder(arguments.output);
  if (arguments.merge) return merge_all(folder, arguments, 0);
  if (arguments.manifests.empty()) return fail(kUsage, "--manifest is required: a file that names meshes");
  const auto shard = chosen_shard(arguments);
  if (!shard) return fail_with(shard.error());
  const auto plan = read_batch_plan(arguments.manifests);
  if (!plan) return fail_with(plan.error());
  if (!arguments.quiet) {
    for (const std::string& note : plan->notes)
      std::fputs(("fdcg: " + note + "\n").c_str(), stderr);
    if (!shard->source.empty())
      std::fprintf(stderr, "fdcg: shard %zu/%zu, by %s\n", shard->number, shard->of, shard->source.c_str());
  }
  if (const auto failure = folder.open(*plan, *shard, arguments.resume)) return fail_with(*failure);
  return run(folder, *plan, *shard, arguments);
}

void add_options(CLI::App& command, BatchArguments& arguments) {
  const OptionGroup input(command, "Input"), output(command, "Output"), work(command, "Work");
  input.repeated(
      "--manifest", "FILE", [&arguments](const std::string& path) { arguments.manifests.push_back(path); },
      "Meshes, folders, patterns and robots (URDF, SDF), one a line, or with rules as JSON where the name ends in .json. May "
      "be "
      "repeated; - is standard input.");
  output
      .text("-o,--output", "FOLDER", arguments.output,
            "Folder for results.jsonl, report.json, report.sarif and, in files/, what is compiled and repaired.")
      ->required();
  output.flag("-q,--quiet", arguments.quiet, "Print errors only, and no progress bar.");
  CLI::Option* const shard = work.parsed(
      "--shard", "I/N",
      [&arguments](const std::string& text) {
        const auto parsed = parse_shard(text);
        if (!parsed) throw CLI::ValidationError("--shard", parsed.error().message);
        arguments.shard = *parsed;
      },
      "Do every N-th mesh from the I-th on; --merge joins the results.",
      "the task of an array of Slurm, Grid Engine, LSF and others, else 1/1");
  CLI::Option* const resume =
      work.flag("--resume", arguments.resume, "Go on with a run that was ended, or do one again that changed.");
  work.flag("--merge", arguments.merge, "Join the results of all shards in FOLDER.")
      ->excludes(shard)
      ->excludes(resume)
      ->excludes("--manifest");
  work.text("--cache", "FOLDER", arguments.cache, "What was done before, by content; may be shared by runs and machines.",
            "FOLDER/cache of -o");
  work.number("--memory", "MB", arguments.memory_mb, {1, 1e9, " MB"}, "Memory that all meshes in work may take.",
              "what is free");
  work.number("--time-limit", "SECONDS", arguments.cpu_seconds, {0.01, 1e9, " s"}, "Processor time that one mesh may take.",
              short_number(kDefaultCpuSeconds));
  work.jobs(arguments.jobs, "The results do not depend on it.");
}

}  // namespace

Command add_batch(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("batch", "Validate, repair and compile many meshes by rules.");
  command->footer(R"(Examples:
  fdcg batch --manifest meshes.txt -o out
  fdcg batch --manifest meshes.json -o out --resume
  fdcg batch --manifest meshes.txt --manifest rules.json -o out --shard 2/4
  fdcg batch -o out --merge
  find library -name '*.stl' | fdcg batch --manifest - -o out

A rule has a pattern (match), an action (validate, repair or compile) and options of that command; the first that matches a mesh
counts, and without one it is validated. Rules stand in a JSON manifest, which schemas/batch-manifest.schema.json describes.

A mesh that cannot be read, or that crashes the program, costs its own result alone. Results, outputs and reports have the same
bytes whatever --shard, --jobs and --cache are.

)" + exit_codes("every mesh is clean", "a mesh has findings; of several codes the highest counts"));
  const auto arguments = std::make_shared<BatchArguments>();
  add_options(*command, *arguments);
  return {command, [arguments] { return run_batch_command(*arguments); }};
}

}  // namespace fdcg::tools
