// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_scaling: how bake, memory, opening and the step grow with faces, contacts and objects; f32 beside f64.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "scaling.hpp"

using namespace fdcg::test;

int main(int argc, char** argv) {
  ScalingRun run;
  run.output = "build/evaluation/scaling";
  std::string part = "all";
  CLI::App app("How bake time, memory, opening and the step grow with faces, contacts and objects; f32 beside f64.");
  app.footer("Example: fdcg_bench_scaling --quick --part contacts --output scaling");
  app.add_flag("--quick", run.is_quick,
               "up to 10^5 faces, 10^4 contacts and 10^3 objects; else 10^7, 10^5 and 10^4, in some 12 GB");
  bool no_time_bars = false;
  app.add_flag("--no-time-bars", no_time_bars, "do not fail on times: for a machine that does other work");
  app.add_option("--output", run.output, "folder for the tables")->capture_default_str();
  app.add_option("--seed", run.seed, "of the contacts' places and the jumps")->capture_default_str();
  app.add_option("--part", part, "what to measure")
      ->check(CLI::IsMember({"all", "faces", "contacts", "objects"}))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  run.judges_times = !no_time_bars;
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
