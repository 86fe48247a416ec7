// SPDX-License-Identifier: Apache-2.0
// fdcg_step as the judges call it: that of a shared library, opened at the first step. By default libfdcg, as it ships; the
// environment's FDCG_JUDGED_LIBRARY names another, such as one with faults planted in it. So judges are compiled with public
// headers alone, and every program that links this object judges what is named, unchanged.
//
// In the same process: a pipe would take a hundred times as long as the step. A library that is opened so shares no symbol with
// the program. A step that the processor stops (a NaN made of finite numbers where a judge traps that, memory that is not
// there) is a finding, told as a bar that fails.
#include <dlfcn.h>
#include <unistd.h>

#include <csignal>
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

template <std::size_t kSize>
[[noreturn]] void end_with(const char (&finding)[kSize]) {
  [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, finding, kSize - 1);
  _exit(1);
}

// Before main(): a test framework's handlers, and a sanitizer's, come first.
[[gnu::constructor]] void tell_deaths() {
  const auto handle = [](int number, void (*handler)(int)) {
    struct sigaction before {};
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_DFL) std::signal(number, handler);
  };
  handle(SIGFPE, [](int) { end_with("FAIL step divides by zero, overflows or makes a NaN of finite numbers: signal 8\n"); });
  for (const int number : {SIGSEGV, SIGBUS})
    handle(number, [](int) { end_with("FAIL step reaches for memory that is not there: signal 11\n"); });
}

}  // namespace

extern "C" void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                          const double hip_object_m[3], fdcg_result* result) {
  static const Step step = judged_step();
  step(graph, params, contact, hip_object_m, result);
}
