// SPDX-License-Identifier: Apache-2.0
// What happens inside a step that its result does not tell. fdcg_stress runs a build of servo_step.cpp of its own, with this
// file included first; the library that ships counts nothing.
#pragma once

#include <cstdint>

namespace fdcg::test {

struct StepWatch {
  std::uint64_t met_again = 0;   // a feature was met again though the god-object had come no nearer: the step rested there
  std::uint64_t trail_full = 0;  // ... or 32 features were met so, all different
};
extern constinit thread_local StepWatch step_watch;

}  // namespace fdcg::test

#define FDCG_WATCH(event) static_cast<void>(++::fdcg::test::step_watch.event)
