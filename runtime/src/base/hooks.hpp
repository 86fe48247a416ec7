// SPDX-License-Identifier: Apache-2.0
// Assert and log callbacks: fdcg_set_assert_handler, fdcg_set_log_handler.
#pragma once

#include "base/config.hpp"

namespace fdcg {

// Calls the log handler, if one is set. Never called in the step.
[[gnu::cold]] void log(fdcg_log_level level, const char* text);

// Calls the assert handler, or traps if none is set.
[[gnu::cold]] void assert_failed(const char* condition, const char* file, uint32_t line);

}  // namespace fdcg

#if FDCG_WITH_ASSERTS
#define FDCG_ASSERT(condition) ((condition) ? static_cast<void>(0) : ::fdcg::assert_failed(#condition, __FILE__, __LINE__))
#else
#define FDCG_ASSERT(condition) static_cast<void>(0)
#endif
