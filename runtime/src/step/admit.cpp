// SPDX-License-Identifier: Apache-2.0
#include "step/admit.hpp"

namespace fdcg {
namespace {

[[gnu::noinline]] bool is_in_range(double value) {
  constexpr double kLargest = 1e30;  // above all that fdcg_check_params takes, and what a scale makes of it
  return value >= 0 && value <= kLargest;
}

}  // namespace

const fdcg_params* admit(uint64_t mark, const fdcg_params& params, fdcg_params* room, fdcg_contact* contact,
                         fdcg_result* result) {
  if (!is_params_size(params.struct_bytes)) {
    refuse_step(FDCG_RESULT_BAD_PARAMS, result);
    return nullptr;
  }
  const fdcg_params& whole = in_full(params, room, fdcg_params_init);
  if (internals_of(*contact).on == mark) return &whole;
  if (internals_of(*contact).on != 0) {
    refuse_step(FDCG_RESULT_OTHER_CONTACT, result);
    return nullptr;
  }
  if (!is_in_range(whole.mu_dynamic) || !is_in_range(whole.mu_static) || !is_in_range(whole.stiffness_n_per_m) ||
      !is_in_range(whole.damping_n_s_per_m)) {
    refuse_step(FDCG_RESULT_BAD_PARAMS, result);
    return nullptr;
  }
  internals_of(*contact).on = mark;
  return &whole;
}

void refuse_step(uint32_t flag, fdcg_result* result) {
  *result = {};
  result->feature = FDCG_NONE;
  result->flags = flag;
}

}  // namespace fdcg
