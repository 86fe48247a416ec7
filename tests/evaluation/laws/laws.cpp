// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_laws: does the step obey the laws of friction, energy and approximation? See tests/evaluation/README.md.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "laws.hpp"
#include "program_options.hpp"

namespace {

using namespace fdcg::test;

struct Part {
  const char* name;
  void (*measure)(const LawOptions&, Bars&);
};
constexpr Part kParts[] = {{"ramps", measure_ramps},     {"slides", measure_slides}, {"stick-slip", measure_stick_slip},
                           {"creep", measure_creep},     {"energy", measure_energy}, {"tessellation", measure_tessellation},
                           {"shading", measure_shading}, {"relief", measure_relief}, {"scans", measure_scans}};

}  // namespace

int main(int argc, char** argv) {
  LawOptions options;
  bool stops_at_first = false;
  std::vector<std::string> names, only;
  for (const Part& part : kParts)
    names.push_back(part.name);
  ProgramOptions program(
      "Measures the step against physical laws: Coulomb's on ramps, in grooves and in motion, stick-slip, creep,\n"
      "energy over closed loops, and smooth shapes by formula against their tessellations.\n"
      "Example: fdcg_bench_laws --quick --output laws");
  program.flag("--quick", options.is_quick, "A few seconds: fewer orientations, ticks and loops");
  program.option("--output", options.output, "Folder for the tables");
  program.option("--seed", options.seed, "Of everything drawn at random");
  program.option("--threads", options.threads, "The results do not depend on it", 1, 256);
  program.flag("--first", stops_at_first, "End at the first bar that fails, with exit code 1");
  program.choice("--only", only, "Parts to run; default: all", names);
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    Bars bars(options.output, "fdcg_bench_laws", stops_at_first);
    for (const Part& part : kParts) {
      if (only.empty() || std::ranges::count(only, part.name) > 0) part.measure(options, bars);
    }
    return bars.failures() > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_laws: %s\n", error.what());
    return 2;
  }
}
