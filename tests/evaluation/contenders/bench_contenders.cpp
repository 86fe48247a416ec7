// SPDX-License-Identifier: Apache-2.0
// Run time against error: this runtime in its variants, and other ways to find a god-object, along the same ways in the same
// harness. Errors are against brute force in long double.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "evaluation.hpp"
#include "program_options.hpp"

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

}  // namespace

int main(int argc, char** argv) {
  EvaluationOptions options;
  ProgramOptions program(
      "Run time against error: this runtime and other ways to find a god-object, along the same ways.\n"
      "Example: fdcg_bench_contenders --body star_10k --way hand --output bench");
  program.flag("--quick", options.is_quick, "small bodies, few ways: some 20 s in place of 10 minutes");
  program.flag("!--no-time-bars", options.judges_times, "measure times briefly and do not judge them: for busy machines");
  program.option("--output", options.output, "folder for contenders.csv, pareto.csv, pareto_verdict.csv and the bars");
  program.option("--seed", options.seed, "of the ways");
  program.option("--seeds", options.seeds, "ways a body, each of another seed, that the frontier is over; default 5, quick 2",
                 1, 1000);
  program.option("--body", options.bodies, "only these; any of bodies.hpp, up to 10 million faces (some 12 GB)");
  program.option("--way", options.ways, "only these of the plan's ways");
  program.option("--ticks", options.ticks,
                 "of each way; default 4,000 where the frontier is over several seeds, else 10,000; quick 4,000", 100, 1e6);
  program.option("--rival", options.rivals, "shared object or pipe:COMMAND that takes part too (docs/rivals.md)");
  program.option("--contender", options.contenders, "only these, by their names in contenders.csv");
  program.option("--export", options.export_folder, "folder for meshes, ways with their truth, and every contender's answers");
  program.option("--way-file", options.way_files, "ways in place of the plan's, in the format of --export or plain columns");
  program.option("--mesh", options.mesh, "of way files that are plain columns");
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
  try {
    Evaluation evaluation(options);
    for (const std::string& path : options.way_files)
      evaluation.run(read_way(path));
    for (const BodyPlan& body : plan_with(options))
      evaluation.run(body);
    return evaluation.finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
}
