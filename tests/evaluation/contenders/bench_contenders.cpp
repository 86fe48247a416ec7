// SPDX-License-Identifier: Apache-2.0
// Run time against error: this runtime in its variants, and other ways to find a god-object, along the same ways in the same
// harness. Errors are against brute force in long double.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "evaluation.hpp"
#include "program_options.hpp"
#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace fdcg::test;

namespace {

std::vector<BodyPlan> plan_with(const EvaluationOptions& options) {
  if (!options.way_files.empty()) return {};
  const std::vector<BodyPlan> plan = plan_of(options.is_quick);
  if (options.bodies.empty()) return plan;
  std::vector<BodyPlan> chosen;
  for (const std::string& name : options.bodies) {
    const auto planned = std::find_if(plan.begin(), plan.end(), [&](const BodyPlan& p) { return p.body == name; });
    chosen.push_back(planned != plan.end() ? *planned : BodyPlan{name, ways_of_other(body_named(name))});
  }
  return chosen;
}

// In order of their names.
std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> files;
  if (folder.empty()) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  EvaluationOptions options;
  std::string meshes;
  ProgramOptions program(
      "Run time against error: this runtime and other ways to find a god-object, along the same ways.\n"
      "Example: fdcg_bench_contenders --body star_10k --way hand --output bench");
  program.flag("--quick", options.is_quick, "small bodies, few ways: some 20 s in place of 10 minutes");
  program.flag("!--no-time-bars", options.judges_times, "measure times briefly and do not judge them: for busy machines");
  program.option("--output", options.output, "folder for contenders.csv, pareto.csv, pareto_verdict.csv and the bars");
  program.option("--seed", options.seed, "of the ways");
  program.option("--seeds", options.seeds, "ways a body, each of another seed, that the frontier is over; default 30, quick 4",
                 1, 1000);
  program.option("--body", options.bodies, "only these; any of bodies.hpp, up to 10 million faces (some 12 GB)");
  program.option("--meshes", meshes, "folder of meshes that are bodies too, after the others, each scaled to 0.1 m");
  program.option("--way", options.ways, "only these of the plan's ways");
  program.option("--ticks", options.ticks,
                 "of each way; default 1,000 where the frontier is over several, else 10,000; quick 2,000 and 4,000", 100, 1e6);
  program.option("--rival", options.rivals, "shared object or pipe:COMMAND that takes part too (docs/rivals.md)");
  program.option("--contender", options.contenders, "only these, by their names in contenders.csv");
  program.option("--export", options.export_folder, "folder for meshes, ways with their truth, and every contender's answers");
  program.option("--way-file", options.way_files, "ways in place of the plan's, in the format of --export or plain columns");
  program.option("--mesh", options.mesh, "of way files that are plain columns; these:");
  program.option("--hip-column", options.columns.first, "of x; y and z follow; the first column is 1", 1, 1000);
  program.option("--unit-m", options.columns.unit_m, "metres a unit: 0.001 for millimetres", 1e-9, 1e9);
  program.option("--rate-hz", options.columns.rate_hz, "rows a second", 1e-3, 1e9);
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    for (const std::string& name : options.bodies)
      (void)body_named(name);
    for (const std::string& name : options.ways)
      (void)way_named(name);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
#ifdef __GLIBC__
  // Memory stays with the program: what a body gives back the next one takes, and no contender pays for pages made anew.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
  try {
    Evaluation evaluation(options);
    for (const std::string& path : options.way_files)
      evaluation.run(read_way(path, options.columns));
    for (const BodyPlan& body : plan_with(options))
      evaluation.run(body);
    std::size_t taken = 0;
    for (const std::string& path : files_of(meshes))
      taken += evaluation.run_mesh(path);
    if (!meshes.empty()) std::printf("%zu of the files of %s were measured\n", taken, meshes.c_str());
    return evaluation.finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
}
