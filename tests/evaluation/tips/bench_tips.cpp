// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_tips: hands of 0.1, 0.3 and 1 m/s at 1 kHz on pointed bodies; how long they are inside without force, how large
// the first force is, what the worst tick costs.

#include <cstdio>
#include <string>
#include <vector>

#include "contact_rig.hpp"
#include "hand_probe.hpp"
#include "pointed_bodies.hpp"
#include "program_options.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

constexpr double kSpeeds[] = {0.1, 0.3, 1};

struct Choices {
  std::vector<int> sides = {100, 500, 2000, 10'000};
  int ways = 4;  // of each approach and speed
  std::uint64_t seed = 1;
  bool merges = false;
};

HandReport report_of(const PointedBody& body, Precision precision, const Choices& choices, Approach approach) {
  CompileOptions options;
  options.precision = precision;
  if (!choices.merges) {
    options.coplanar.kind = fdcg::bake::Coplanar::Kind::exact;
    options.merge = false;
  }
  const CompiledMesh mesh(body.soup, options);
  const ExactSolid solid(body.soup, *mesh.view().header);
  Random random(choices.seed);
  HandReport report;
  for (const double speed : kSpeeds) {
    for (int i = 0; i < choices.ways; ++i) {
      const PointedBody::Tip& tip = body.tips[random.below(static_cast<std::uint32_t>(body.tips.size()))];
      const bool has_friction = i % 2 == 0;
      fdcg_params params = contact_params(has_friction ? 0.6 : 0, has_friction ? 0.42 : 0);
      params.stiffness_n_per_m = 1000;
      report.add(probe_hand(mesh.view(), solid, params, hand_way(tip, approach, speed, random)));
    }
  }
  return report;
}

int run(const Choices& choices) {
  std::printf("%-7s %6s %-4s %-11s %8s %8s %9s %9s %9s %11s %9s\n", "body", "sides", "real", "approach", "ticks", "carried",
              "forceless", "longest", "depth mm", "first force", "worst us");
  std::uint64_t faults = 0;
  for (const PointedKind kind : kPointedKinds) {
    for (const int sides : choices.sides) {
      const PointedBody body = pointed_body(kind, sides, random_rotation(choices.seed + static_cast<std::uint64_t>(sides)));
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        for (const Approach approach : kApproaches) {
          const HandReport r = report_of(body, precision, choices, approach);
          faults += r.forceless_ticks;
          std::printf("%-7s %6d %-4s %-11s %8llu %8llu %9llu %9llu %9.4f %11.3f %9.1f\n", name_of(kind), sides,
                      precision == Precision::f64 ? "f64" : "f32", name_of(approach), static_cast<unsigned long long>(r.ticks),
                      static_cast<unsigned long long>(r.carried_ticks), static_cast<unsigned long long>(r.forceless_ticks),
                      static_cast<unsigned long long>(r.longest_forceless), r.deepest_forceless_m * 1e3, r.worst_first_force,
                      r.worst_ns * 1e-3);
          std::fflush(stdout);
        }
      }
    }
  }
  std::printf("%llu ticks inside without force\n", static_cast<unsigned long long>(faults));
  return faults == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  ProgramOptions program("Hands on pointed bodies: ticks inside without force");
  Choices choices;
  program.option("--sides", choices.sides, "of each body");
  program.option("--ways", choices.ways, "of each approach and speed");
  program.option("--seed", choices.seed, "of turns and ways");
  program.flag("--merge", choices.merges, "compile as by default: faces merged within the numbers' quantum");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  return run(choices);
}
