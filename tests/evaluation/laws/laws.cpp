// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_laws: does the step obey the laws of friction, energy and approximation? See tests/evaluation/README.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <set>
#include <string>

#include "laws.hpp"

namespace {

using namespace fdcg::test;

struct Part {
  const char* name;
  void (*measure)(const LawOptions&, Bars&);
};
constexpr Part kParts[] = {{"ramps", measure_ramps}, {"slides", measure_slides}, {"stick-slip", measure_stick_slip},
                           {"creep", measure_creep}, {"energy", measure_energy}, {"tessellation", measure_tessellation}};

}  // namespace

int main(int argc, char** argv) {
  LawOptions options;
  std::set<std::string> names, only;
  for (const Part& part : kParts)
    names.insert(part.name);
  CLI::App app{
      "Measures the step against physical laws: Coulomb's on ramps, in grooves and in motion, stick-slip, creep,\n"
      "energy over closed loops, and smooth shapes by formula against their tessellations.\n"
      "Example: fdcg_bench_laws --quick --output laws"};
  app.add_flag("--quick", options.is_quick, "A few seconds: fewer orientations, ticks and loops");
  app.add_option("--output", options.output, "Folder for the tables")->capture_default_str();
  app.add_option("--seed", options.seed, "Of everything drawn at random")->capture_default_str();
  app.add_option("--threads", options.threads, "The results do not depend on it")
      ->check(CLI::Range(1u, 256u))
      ->capture_default_str();
  app.add_option("--only", only, "Parts to run; default: all")->check(CLI::IsMember(names));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    Bars bars(options.output, "fdcg_bench_laws");
    for (const Part& part : kParts) {
      if (only.empty() || only.contains(part.name)) part.measure(options, bars);
    }
    return bars.failures() > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_laws: %s\n", error.what());
    return 2;
  }
}
