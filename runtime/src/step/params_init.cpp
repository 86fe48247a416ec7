// SPDX-License-Identifier: Apache-2.0
// Default parameters: a program that does not check what it sets links these alone.
#include "base/struct_bytes.hpp"
#include "fdcg/fdcg.h"

namespace fdcg {
namespace {

// As a table: in code each number takes twice the bytes.
constexpr fdcg_params kDefaults = {.struct_bytes = sizeof(fdcg_params),
                                   .edge_friction = FDCG_EDGE_WEDGE,
                                   .mu_static = 0.6,
                                   .mu_dynamic = 0.4,
                                   .stiffness_n_per_m = 1000,
                                   .damping_n_s_per_m = 0,
                                   .tick_s = 0.001,
                                   .disabled_optimizations = 0,
                                   .friction_flags = 0,
                                   .stribeck_m_per_s = 0.05,
                                   .viscous_s_per_m = 0.1,
                                   .presliding_n_per_m = 1e5,
                                   .friction_lag_s = 0.03,
                                   .unique_solution_depth_m = 0.01,
                                   .finger = {1, 1, 1e4},
                                   .materials = nullptr,
                                   .material_count = 0,
                                   .reserved = {}};

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_params_init(fdcg_params* params, uint32_t struct_bytes) {
  fdcg::fill_defaults(params, fdcg::kDefaults, struct_bytes);
}
