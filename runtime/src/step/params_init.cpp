// SPDX-License-Identifier: Apache-2.0
// Default parameters: a program that does not check what it sets links these alone.
#include "base/struct_bytes.hpp"
#include "fdcg/fdcg.h"

extern "C" void fdcg_params_init(fdcg_params* params, uint32_t struct_bytes) {
  fdcg_params defaults = {};
  defaults.edge_friction = FDCG_EDGE_WEDGE;
  defaults.mu_static = 0.6;
  defaults.mu_dynamic = 0.4;
  defaults.stiffness_n_per_m = 1000;
  defaults.damping_n_s_per_m = 0;
  defaults.tick_s = 0.001;
  defaults.stribeck_m_per_s = 0.05;
  defaults.viscous_s_per_m = 0.1;
  defaults.presliding_n_per_m = 1e5;
  defaults.friction_lag_s = 0.03;
  defaults.unique_solution_depth_m = 0.01;
  defaults.finger = {1, 1, 1e4};
  fdcg::fill_defaults(params, defaults, struct_bytes);
}
