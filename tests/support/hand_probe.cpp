// SPDX-License-Identifier: Apache-2.0
#include "hand_probe.hpp"

#include <algorithm>
#include <chrono>

#include "contact_rig.hpp"

namespace fdcg::test {
namespace {

Hip local_of(const fdcg_header& header, const Hip& hip_m) {
  Hip local;
  for (std::size_t i = 0; i < 3; ++i)
    local[i] = hip_m[i] / header.metres_per_unit - header.origin[i];
  return local;
}

bool is_within_bounds(const ExactSolid& solid, const Hip& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (x[i] < solid.low()[i] || x[i] > solid.high()[i]) return false;
  }
  return true;
}

}  // namespace

void HandReport::add(const HandReport& other) {
  ticks += other.ticks;
  contact_ticks += other.contact_ticks;
  carried_ticks += other.carried_ticks;
  forceless_ticks += other.forceless_ticks;
  longest_forceless = std::max(longest_forceless, other.longest_forceless);
  deepest_forceless_m = std::max(deepest_forceless_m, other.deepest_forceless_m);
  worst_first_force = std::max(worst_first_force, other.worst_first_force);
  worst_ns = std::max(worst_ns, other.worst_ns);
}

HandReport probe_hand(const fdcg_graph& graph, const ExactSolid& solid, const fdcg_params& params,
                      const std::vector<Hip>& way_m) {
  using Clock = std::chrono::steady_clock;
  HandReport report;
  fdcg_contact contact = {};
  fdcg_result result = {};
  std::uint64_t run = 0;
  bool had_force = false;
  for (std::size_t i = 0; i < way_m.size(); ++i) {
    const Clock::time_point begin = Clock::now();
    fdcg_step(&graph, &params, &contact, way_m[i].data(), &result);
    report.worst_ns = std::max(report.worst_ns, std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
    ++report.ticks;
    report.carried_ticks += (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;
    const double force = norm({result.force_n[0], result.force_n[1], result.force_n[2]});
    report.contact_ticks += force > 0;
    if (force > 0 && !had_force && i > 0)
      report.worst_first_force =
          std::max(report.worst_first_force, force / (params.stiffness_n_per_m * distance(way_m[i], way_m[i - 1])));
    had_force = force > 0;
    const Hip local = local_of(*graph.header, way_m[i]);
    const bool is_forceless =
        force == 0 && i > 0 && is_within_bounds(solid, local) && solid.where(local) == ExactSolid::Where::inside;
    run = is_forceless ? run + 1 : 0;
    report.forceless_ticks += is_forceless;
    report.longest_forceless = std::max(report.longest_forceless, run);
    if (is_forceless)
      report.deepest_forceless_m =
          std::max(report.deepest_forceless_m, solid.distance_to_surface(local) * graph.header->metres_per_unit);
  }
  return report;
}

}  // namespace fdcg::test
