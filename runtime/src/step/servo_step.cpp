// SPDX-License-Identifier: Apache-2.0
// The step on a graph as it is.
#include "step/servo_step.hpp"

#include "base/mutation.hpp"
#include "step/admit.hpp"

namespace fdcg {
namespace {

// Of this file alone, and so is all that the step is made of: the compiler then knows every call of each function.
template <class Real>
struct StepGeometry : RigidGeometry<Real> {
  using RigidGeometry<Real>::RigidGeometry;
};

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                          const double hip_object_m[3], fdcg_result* result) {
  if (FDCG_MUTANT("slow")) {
    volatile int idle = 400;
    while (idle > 0)
      idle = idle - 1;
  }
  if (graph->header == nullptr) return fdcg::refuse_step(FDCG_RESULT_NOT_OPEN, result);
  fdcg_params room;
  params = fdcg::admitted(fdcg::mark_of(*graph->header), *params, &room, contact, result);
  if (params == nullptr) return;
  fdcg::with_real_of(*graph->header, [&](auto real) {
    fdcg::step<fdcg::StepGeometry<decltype(real)>>(*graph, *params, contact, hip_object_m, result);
  });
}
