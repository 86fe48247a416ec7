// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_laws: does the step obey the laws of friction, energy and approximation? See tests/evaluation/README.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "laws.hpp"

int main(int argc, char** argv) {
  using namespace fdcg::test;
  LawOptions options;
  CLI::App app{
      "Measures the step against physical laws: Coulomb's on ramps, in grooves and in motion.\n"
      "Example: fdcg_bench_laws --quick --output /tmp/laws"};
  app.add_flag("--quick", options.is_quick, "A few seconds: fewer orientations, ticks and loops");
  app.add_option("--output", options.output, "Folder for the tables")->capture_default_str();
  app.add_option("--seed", options.seed, "Of everything drawn at random")->capture_default_str();
  app.add_option("--threads", options.threads, "The results do not depend on it")
      ->check(CLI::Range(1u, 256u))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    Bars bars(options.output, "fdcg_bench_laws");
    measure_ramps(options, bars);
    measure_slides(options, bars);
    measure_stick_slip(options, bars);
    measure_creep(options, bars);
    measure_energy(options, bars);
    measure_tessellation(options, bars);
    return bars.failures() > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_laws: %s\n", error.what());
    return 2;
  }
}
