// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// params.cpp: FDCG_E_ARGUMENT, with the reason, unless 0 <= mu_dynamic <= mu_static and the stiffness is above 0.
fdcg_status check_finger_material(const fdcg_material& material, fdcg_error* error);

}  // namespace fdcg
