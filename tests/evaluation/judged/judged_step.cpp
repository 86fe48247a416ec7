// SPDX-License-Identifier: Apache-2.0
// fdcg_step as the judges call it: that of a shared library, opened at the first step. By default libfdcg, as it ships; the
// environment's FDCG_JUDGED_LIBRARY names another, such as one with faults planted in it. So judges are compiled with public
// headers alone, and every program that links this object judges what is named, unchanged.
//
// In the same process: a pipe would take a hundred times as long as the step. A library that is opened so shares no symbol with
// the program.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "fdcg/fdcg.h"

namespace {

using Step = void (*)(const fdcg_graph*, const fdcg_params*, fdcg_contact*, const double*, fdcg_result*);

Step judged_step() {
  const char* const chosen = std::getenv("FDCG_JUDGED_LIBRARY");
  const char* const file = chosen != nullptr && *chosen != '\0' ? chosen : FDCG_LIBRARY;
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* const step = library == nullptr ? nullptr : dlsym(library, "fdcg_step");
  if (step == nullptr) {
    std::fprintf(stderr, "no step to judge: %s; FDCG_JUDGED_LIBRARY names a shared library with fdcg_step\n", dlerror());
    std::exit(2);
  }
  return reinterpret_cast<Step>(step);
}

}  // namespace

extern "C" void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                          const double hip_object_m[3], fdcg_result* result) {
  static const Step step = judged_step();
  step(graph, params, contact, hip_object_m, result);
}
