// SPDX-License-Identifier: Apache-2.0
#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "fdcg/fdcg.h"
#include "graph/material_section.hpp"
#include "step/friction_terms.hpp"

namespace fdcg {
namespace {

// contact-model RESP-4

constexpr double kLargestParam = 1e9;  // far beyond any device; keeps products finite
constexpr double kLeastParam = 1e-9;

struct ParamRange {
  const char* name;
  double value, low, high;
};

// Whose fields are in question: params, params.finger, params.materials[index].
struct Owner {
  const char* name;
  uint32_t index;  // FDCG_NONE: no index
};

Message& say(Message& message, const Owner& owner) {
  message.text(owner.name);
  if (owner.index != FDCG_NONE) message.say("[", owner.index, "]");
  return message;
}

fdcg_status check_ranges(const Owner& owner, const ParamRange* ranges, uint32_t count, double mu_dynamic, fdcg_error* error) {
  for (const ParamRange* range = ranges; range != ranges + count; ++range) {
    if (range->value >= range->low && range->value <= range->high) continue;
    Message message(error, FDCG_E_ARGUMENT);
    return say(message, owner)
        .say(".", range->name, " is ", range->value, ", allowed ", range->low, " to ", range->high,
             range->low == mu_dynamic && range->low > 0 ? " (at least mu_dynamic)" : "");
  }
  return FDCG_OK;
}

fdcg_status check_material(const Owner& owner, const fdcg_material& material, double least_stiffness, fdcg_error* error) {
  const ParamRange ranges[] = {{"mu_dynamic", material.mu_dynamic, 0, kLargestParam},
                               {"mu_static", material.mu_static, material.mu_dynamic, kLargestParam},
                               {"stiffness_n_per_m", material.stiffness_n_per_m, least_stiffness, kLargestParam}};
  return check_ranges(owner, ranges, 3, material.mu_dynamic, error);
}

#if FDCG_WITH_FRICTION_TERMS
// One solution at every speed, on this material.
fdcg_status check_steepness(const fdcg_params& params, const Owner& owner, const fdcg_material& material, fdcg_error* error) {
  const bool has_finger = (params.friction_flags & FDCG_FRICTION_FINGER) != 0;
  const Steepness steep = steepness_of(params, has_finger ? fdcg_combine_materials(&material, &params.finger) : material);
  if (steep.fall <= steep.limit) return FDCG_OK;
  Message message(error, FDCG_E_ARGUMENT);
  message.text("the friction curve of ");
  return say(message, owner)
      .say(" falls by ", steep.fall, " s/m, allowed ", steep.limit,
           " s/m to hold down to unique_solution_depth_m; raise stribeck_m_per_s or friction_lag_s (with its term), or lower "
           "unique_solution_depth_m");
}

fdcg_status check_terms(const fdcg_params& params, fdcg_error* error) {
  const auto has = [&](uint32_t term) { return (params.friction_flags & term) != 0; };
  const Owner owner = {"params", FDCG_NONE}, finger = {"params.finger", FDCG_NONE};
  if (params.friction_flags > FDCG_FRICTION_ALL) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("params.friction_flags is ", params.friction_flags, ", allowed are sums of fdcg_friction_flag: 0 to ",
             FDCG_FRICTION_ALL);
  }
  if (!FDCG_WITH_SHADING && has(FDCG_FRICTION_SHADING)) {
    return Message(error, FDCG_E_ARGUMENT)
        .text(
            "params.friction_flags has FDCG_FRICTION_SHADING, but this library was built without it; build it with "
            "FDCG_WITH_SHADING");
  }
  const ParamRange ranges[] = {
      {"stribeck_m_per_s", has(FDCG_FRICTION_STRIBECK) ? params.stribeck_m_per_s : 1, kLeastParam, kLargestParam},
      {"viscous_s_per_m", has(FDCG_FRICTION_VISCOUS) ? params.viscous_s_per_m : 0, 0, kLargestParam},
      {"presliding_n_per_m", has(FDCG_FRICTION_PRESLIDING) ? params.presliding_n_per_m : 1, kLeastParam, kLargestParam},
      {"friction_lag_s", has(FDCG_FRICTION_LAG) ? params.friction_lag_s : 0, 0, kLargestParam},
      {"unique_solution_depth_m", has(FDCG_FRICTION_STRIBECK) ? params.unique_solution_depth_m : 1, kLeastParam,
       kLargestParam}};
  fdcg_status status = check_ranges(owner, ranges, sizeof ranges / sizeof ranges[0], -1, error);
  if (status == FDCG_OK && has(FDCG_FRICTION_FINGER)) status = check_material(finger, params.finger, kLeastParam, error);
  if (status == FDCG_OK)
    status = check_steepness(params, owner, {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m}, error);
  if (status != FDCG_OK || !has(FDCG_FRICTION_MATERIALS)) return status;
  if (params.materials == nullptr && params.material_count > 0)
    return Message(error, FDCG_E_ARGUMENT).text("params.materials: null pointer, though material_count is not 0");
  for (uint32_t i = 0; i < params.material_count && status == FDCG_OK; ++i) {
    const Owner row = {"params.materials", i};
    status = check_material(row, params.materials[i], 0, error);
    if (status == FDCG_OK) status = check_steepness(params, row, params.materials[i], error);
  }
  return status;
}
#else
fdcg_status check_terms(const fdcg_params& params, fdcg_error* error) {
  if (params.friction_flags == 0) return FDCG_OK;
  return Message(error, FDCG_E_ARGUMENT)
      .say("params.friction_flags is ", params.friction_flags,
           ", but this library was built without them; build it with FDCG_WITH_FRICTION_TERMS");
}
#endif

}  // namespace

fdcg_status check_finger_material(const fdcg_material& material, fdcg_error* error) {
  return check_material({"material", FDCG_NONE}, material, kLeastParam, error);
}

}  // namespace fdcg

extern "C" fdcg_status fdcg_check_params(const fdcg_params* params, fdcg_error* error) {
  using namespace fdcg;
  if (params == nullptr) return Message(error, FDCG_E_ARGUMENT).text("params: null pointer");
  fdcg_params room;
  if (const fdcg_status status =
          check_struct_bytes(params->struct_bytes, sizeof(fdcg_params), "params", "; start from fdcg_make_params()", error);
      status != FDCG_OK) {
    return status;
  }
  params = &in_full(*params, &room, fdcg_params_init);
  const ParamRange ranges[] = {{"mu_dynamic", params->mu_dynamic, 0, kLargestParam},
                               {"mu_static", params->mu_static, params->mu_dynamic, kLargestParam},
                               {"stiffness_n_per_m", params->stiffness_n_per_m, 0, kLargestParam},
                               {"damping_n_s_per_m", params->damping_n_s_per_m, 0, kLargestParam},
                               {"tick_s", params->tick_s, kLeastParam, kLargestParam}};
  const fdcg_status status =
      check_ranges({"params", FDCG_NONE}, ranges, sizeof ranges / sizeof ranges[0], params->mu_dynamic, error);
  if (status != FDCG_OK) return status;
  if (params->disabled_optimizations > FDCG_STEP_OPT_ALL) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("params.disabled_optimizations is ", params->disabled_optimizations,
             ", allowed are sums of fdcg_step_optimization: 0 to ", FDCG_STEP_OPT_ALL);
  }
  if (params->edge_friction > FDCG_EDGE_PAPER) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("params.edge_friction is ", params->edge_friction, ", allowed 0 (wedge) and 1 (paper)");
  }
  for (const uint32_t reserved : params->reserved) {
    if (reserved == 0) continue;
    return Message(error, FDCG_E_ARGUMENT).say("params.reserved is ", reserved, ", allowed 0; start from fdcg_make_params()");
  }
  return check_terms(*params, error);
}
