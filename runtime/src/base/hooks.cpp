// SPDX-License-Identifier: Apache-2.0
#include "base/hooks.hpp"

namespace {

// The library's only state: set before threads start, read afterwards.
fdcg_assert_handler g_assert_handler = nullptr;
void* g_assert_context = nullptr;
fdcg_log_handler g_log_handler = nullptr;
void* g_log_context = nullptr;

}  // namespace

void fdcg::log(fdcg_log_level level, const char* text) {
  if (g_log_handler != nullptr) g_log_handler(g_log_context, level, text);
}

void fdcg::assert_failed(const char* condition, const char* file, uint32_t line) {
  if (g_assert_handler == nullptr) __builtin_trap();
  g_assert_handler(g_assert_context, condition, file, line);
}

extern "C" void fdcg_set_assert_handler(fdcg_assert_handler handler, void* context) {
  g_assert_handler = handler;
  g_assert_context = context;
}

extern "C" void fdcg_set_log_handler(fdcg_log_handler handler, void* context) {
  g_log_handler = handler;
  g_log_context = context;
}
