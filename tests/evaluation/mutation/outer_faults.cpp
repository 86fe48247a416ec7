// SPDX-License-Identifier: Apache-2.0
// Faults planted around the step: in what it is given and in what it says. Those inside are FDCG_MUTANT in runtime/src. What
// each one is: faults.csv.
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/mutation.hpp"
#include "fdcg/fdcg.h"
#include "step/contact_internals.hpp"
#include "tick_count.hpp"

extern "C" void fdcg_step_inner(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                                const double hip_object_m[3], fdcg_result* result);

namespace {

struct Tick {
  const fdcg_header& header;
  const fdcg_contact& before;
  const double* hip_m;
  fdcg_params& params;
  fdcg_contact& contact;
  fdcg_result& result;
};

// One tick in 64, the same ones in every run.
bool is_now_and_then(const Tick& tick) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 3; ++i)
    bits = (bits ^ std::bit_cast<std::uint64_t>(tick.hip_m[i])) * 0x9E3779B97F4A7C15u;
  return bits >> 58 == 0;
}

bool is_usable(const Tick& tick) {
  return (tick.result.flags & FDCG_RESULT_NON_FINITE) == 0;
}

void plant_before(const Tick& tick) {
  fdcg_params& p = tick.params;
  if (FDCG_MUTANT("friction-off-once") && is_now_and_then(tick)) p.mu_static = p.mu_dynamic = 0;
  if (FDCG_MUTANT("friction-off")) p.mu_static = p.mu_dynamic = 0;
  if (FDCG_MUTANT("static-for-dynamic")) p.mu_dynamic = p.mu_static;
  if (FDCG_MUTANT("dynamic-for-static")) p.mu_static = p.mu_dynamic;
  if (FDCG_MUTANT("friction-a-percent-more")) p.mu_static *= 1.01, p.mu_dynamic *= 1.01;
  if (FDCG_MUTANT("wedge-for-paper")) p.edge_friction = FDCG_EDGE_WEDGE;
  if (FDCG_MUTANT("paper-for-wedge")) p.edge_friction = FDCG_EDGE_PAPER;
}

void plant_in_force(const Tick& tick) {
  double(&f)[3] = tick.result.force_n;
  if (FDCG_MUTANT("force-zero") && is_now_and_then(tick)) f[0] = f[1] = f[2] = 0;
  if (FDCG_MUTANT("force-axis-lost")) f[2] = 0;
  if (FDCG_MUTANT("force-axes-swapped")) std::swap(f[0], f[1]);
  for (int i = 0; i < 3; ++i) {
    if (FDCG_MUTANT("force-negated")) f[i] = -f[i];
    if (FDCG_MUTANT("force-scaled")) f[i] *= 1 + 0x1p-10;
    if (FDCG_MUTANT("unit-lost")) f[i] /= tick.header.metres_per_unit;
    if (FDCG_MUTANT("force-of-last-hip") && tick.contact.state != FDCG_FREE)
      f[i] = tick.params.stiffness_n_per_m * tick.header.metres_per_unit * (tick.contact.god_object[i] - tick.before.hip[i]);
    if (FDCG_MUTANT("force-when-free") && tick.contact.state == FDCG_FREE && is_usable(tick)) f[i] += 1e-9;
  }
}

void plant_in_place(const Tick& tick) {
  for (int i = 0; i < 3; ++i) {
    double& x = tick.result.god_object_m[i];
    if (FDCG_MUTANT("god-object-far") && is_usable(tick)) x = tick.hip_m[i] + 3 * (x - tick.hip_m[i]);
    if (FDCG_MUTANT("origin-twice")) x += tick.header.origin[i] * tick.header.metres_per_unit;
    if (FDCG_MUTANT("origin-lost")) x -= tick.header.origin[i] * tick.header.metres_per_unit;
    const bool is_stale = FDCG_MUTANT("god-object-stale") && is_now_and_then(tick) && tick.before.started != 0;
    if (is_stale && tick.before.state == tick.contact.state && tick.before.feature == tick.contact.feature) {
      tick.contact.god_object[i] = tick.before.god_object[i];
      x = (tick.before.god_object[i] + tick.header.origin[i]) * tick.header.metres_per_unit;
    }
  }
}

void plant_in_flags(const Tick& tick) {
  fdcg_result& r = tick.result;
  if (FDCG_MUTANT("slip-flag-lost")) r.slipping = tick.contact.slipping = 0;
  if (FDCG_MUTANT("slip-flag-stuck") && tick.before.slipping != 0 && r.state != FDCG_FREE)
    r.slipping = tick.contact.slipping = 1;
  if (FDCG_MUTANT("slip-flag-misreported")) r.slipping = 0;
  if (FDCG_MUTANT("feature-misreported") && r.feature != FDCG_NONE && r.feature > 0) --r.feature;
  if (FDCG_MUTANT("feature-of-last-tick") && r.state == tick.before.state && r.state != FDCG_FREE)
    r.feature = tick.before.feature;
  if (FDCG_MUTANT("state-misreported") && r.state == FDCG_VERTEX) r.state = FDCG_EDGE;
  if (FDCG_MUTANT("carried-unreported"))
    r.flags &= ~static_cast<std::uint32_t>(FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND);
  if (FDCG_MUTANT("unusable-forgets") && !is_usable(tick)) tick.contact.state = FDCG_FREE, tick.contact.feature = FDCG_NONE;
  if (FDCG_MUTANT("free-while-carried") && (r.flags & FDCG_RESULT_SWEEP_BOUND) != 0) {
    fdcg::internals_of(tick.contact).sweep.is_carried = 0;
    std::memcpy(tick.contact.god_object, tick.contact.hip, sizeof tick.contact.hip);
  }
}

}  // namespace

extern "C" FDCG_API void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                                   const double hip_object_m[3], fdcg_result* result) {
  fdcg::test::count_tick();
  fdcg_params changed = *params;
  const fdcg_contact before = *contact;
  const Tick tick = {*graph->header, before, hip_object_m, changed, *contact, *result};
  plant_before(tick);
  fdcg_step_inner(graph, &changed, contact, hip_object_m, result);
  plant_in_force(tick);
  plant_in_place(tick);
  plant_in_flags(tick);
}
