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

// Less deep than this a HIP may be outside as the step has it: rounded to the file's numbers, faces merged within theirs.
double rounding_of(const fdcg_header& header, const ExactSolid& solid) {
  const double epsilon = header.real_bytes == 8 ? 0x1p-52 : 0x1p-23;
  return 4 * epsilon * solid.size() + 4 * header.max_deviation;
}

bool is_within_bounds(const ExactSolid& solid, const Hip& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (x[i] < solid.low()[i] || x[i] > solid.high()[i]) return false;
  }
  return true;
}

// How deep a point is below the surface; 0: it is not inside.
double depth_inside(const ExactSolid& solid, const Hip& x) {
  if (!is_within_bounds(solid, x) || solid.where(x) != ExactSolid::Where::inside) return 0;
  return solid.distance_to_surface(x);
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
  bool had_force = false, was_outside = false;
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
    const double depth = force == 0 ? depth_inside(solid, local_of(*graph.header, way_m[i])) : 0;
    was_outside = was_outside || depth == 0;
    const bool is_forceless = was_outside && depth > rounding_of(*graph.header, solid);
    run = is_forceless ? run + 1 : 0;
    report.forceless_ticks += is_forceless;
    report.longest_forceless = std::max(report.longest_forceless, run);
    if (is_forceless) report.deepest_forceless_m = std::max(report.deepest_forceless_m, depth * graph.header->metres_per_unit);
  }
  return report;
}

}  // namespace fdcg::test
