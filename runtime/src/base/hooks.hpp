// SPDX-License-Identifier: Apache-2.0
// Who is told of what goes wrong: fdcg_set_assert_handler, fdcg_set_log_handler.
#pragma once

#include "base/config.hpp"

namespace fdcg {

// Tells the log handler, if there is one. Never called in the step.
[[gnu::cold]] void log(fdcg_log_level level, const char* text);

// Tells the assert handler, or traps.
[[gnu::cold]] void assert_failed(const char* condition, const char* file, uint32_t line);

}  // namespace fdcg

#if FDCG_WITH_ASSERTS
#define FDCG_ASSERT(condition) ((condition) ? static_cast<void>(0) : ::fdcg::assert_failed(#condition, __FILE__, __LINE__))
#else
#define FDCG_ASSERT(condition) static_cast<void>(0)
#endif

// What a stress test counts in a build of its own (tests/evaluation/stress/step_watch.hpp): nothing in the library.
#ifndef FDCG_WATCH
#define FDCG_WATCH(event) static_cast<void>(0)
#endif
