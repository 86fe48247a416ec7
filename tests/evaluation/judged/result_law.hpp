// SPDX-License-Identifier: Apache-2.0
// What the step says, held against itself and against the HIP: by its public structs alone.
#pragma once

#include <array>

#include "fdcg/fdcg.h"

namespace fdcg::test {

// Of one tick whose HIP was usable, without damping and without flags of friction.
struct ResultLaw {
  bool is_of_contact = true;  // state, feature, slip flag and place are the contact's; the contact's HIP is this one, rounded
  bool is_of_spring = true;   // F = k (GO - HIP), to the rounding of one product; 0 in free space
};
ResultLaw result_law(const fdcg_header& header, const fdcg_params& params, const fdcg_contact& contact,
                     const std::array<double, 3>& hip_object_m, const fdcg_result& result);

}  // namespace fdcg::test
