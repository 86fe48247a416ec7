// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_scaling: how bake, memory, opening and the step grow with faces, contacts and objects; f32 beside f64.
#include <cstdio>
#include <exception>
#include <string>

#include "program_options.hpp"
#include "scaling.hpp"

using namespace fdcg::test;

int main(int argc, char** argv) {
  ScalingRun run;
  run.output = "build/evaluation/scaling";
  std::string part = "all";
  ProgramOptions program(
      "How bake time, memory, opening and the step grow with faces, contacts and objects; f32 beside f64.\n"
      "Example: fdcg_bench_scaling --quick --part contacts --output scaling");
  program.flag("--quick", run.is_quick,
               "up to 10^5 faces, 10^4 contacts and 10^3 objects; else 10^7, 10^5 and 10^4, in some 12 GB");
  program.flag("!--no-time-bars", run.judges_times, "do not fail on times: for a machine that does other work");
  program.option("--output", run.output, "folder for the tables");
  program.option("--seed", run.seed, "of the contacts' places and the jumps");
  program.choice("--part", part, "what to measure", {"all", "faces", "contacts", "objects"});
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    Bars bars(run.output, "fdcg_bench_scaling");
    Table exponents(run.output, "scaling_exponents",
                    {"table", "body", "precision", "planes", "quantity", "from", "to", "exponent"});
    run.bars = &bars;
    run.exponents = &exponents;
    if (part == "all" || part == "faces") scale_faces(run);
    if (part == "all" || part == "contacts") scale_contacts(run);
    if (part == "all" || part == "objects") scale_objects(run);
    return bars.failures() == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
