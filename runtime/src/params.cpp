// SPDX-License-Identifier: Apache-2.0
#include "fdcg/fdcg.h"
#include "message.hpp"
#include "struct_bytes.hpp"

extern "C" void fdcg_init_params(fdcg_params* params, uint32_t struct_bytes) {
  fdcg_params defaults = {};
  defaults.edge_friction = FDCG_EDGE_WEDGE;
  defaults.mu_static = 0.6;
  defaults.mu_dynamic = 0.4;
  defaults.stiffness_n_per_m = 1000;
  defaults.damping_n_s_per_m = 0;
  defaults.tick_s = 0.001;
  fdcg::fill_defaults(params, defaults, struct_bytes);
}

extern "C" fdcg_status fdcg_check_params(const fdcg_params* params, fdcg_error* error) {
  using fdcg::Message;
  constexpr double kLargest = 1e9;  // far beyond any device; keeps products finite
  if (params == nullptr) return Message(error, FDCG_E_ARGUMENT).text("params: null pointer");
  fdcg_params room;
  if (const fdcg_status status = fdcg::check_struct_bytes(params->struct_bytes, sizeof(fdcg_params), "params",
                                                          "; start from fdcg_default_params()", error);
      status != FDCG_OK) {
    return status;
  }
  params = &fdcg::in_full(*params, &room, fdcg_init_params);
  struct Range {
    const char* name;
    double value, low, high;
  };
  const Range ranges[] = {{"mu_dynamic", params->mu_dynamic, 0, kLargest},
                          {"mu_static", params->mu_static, params->mu_dynamic, kLargest},
                          {"stiffness_n_per_m", params->stiffness_n_per_m, 0, kLargest},
                          {"damping_n_s_per_m", params->damping_n_s_per_m, 0, kLargest},
                          {"tick_s", params->tick_s, 1e-9, kLargest}};
  for (const Range& range : ranges) {
    if (range.value >= range.low && range.value <= range.high) continue;
    return Message(error, FDCG_E_ARGUMENT)
        .text("params.")
        .text(range.name)
        .text(" is ")
        .real(range.value)
        .text(", allowed ")
        .real(range.low)
        .text(" to ")
        .real(range.high)
        .text(range.low == params->mu_dynamic && range.low > 0 ? " (at least mu_dynamic)" : "");
  }
  if (params->disabled_skips > FDCG_STEP_SKIP_ALL) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("params.disabled_skips is ")
        .number(params->disabled_skips)
        .text(", allowed are sums of fdcg_step_skip: 0 to ")
        .number(FDCG_STEP_SKIP_ALL);
  }
  if (params->edge_friction > FDCG_EDGE_PAPER) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("params.edge_friction is ")
        .number(params->edge_friction)
        .text(", allowed 0 (wedge) and 1 (paper)");
  }
  return FDCG_OK;
}
