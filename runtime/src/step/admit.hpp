// SPDX-License-Identifier: Apache-2.0
// Which contact may be stepped on what, and by which parameters. A step compares one mark; all else is looked at where that
// differs: where a contact begins, and where it is refused.
#pragma once

#include "base/struct_bytes.hpp"
#include "fdcg/fdcg.h"
#include "step/contact_internals.hpp"

namespace fdcg {

// What a contact is on (ContactInternals::on). Odd, so that none is 0; a deformable mesh has another than its graph. Kinds of
// surfaces have small ones.
inline uint64_t mark_of(const fdcg_header& header) {
  return header.header_checksum | 1;
}
inline uint64_t deformable_mark_of(const fdcg_header& header) {
  return ~header.header_checksum | 1;
}
inline uint64_t surface_mark_of(uint32_t kind, uint32_t is_hollow) {
  return 4 * uint64_t{kind} + 2 * (is_hollow != 0 ? 1u : 0u) + 1;
}

// What the caller's size of params may be.
inline bool is_params_size(uint32_t struct_bytes) {
  return struct_bytes >= kSmallestStruct && struct_bytes <= sizeof(fdcg_params) && struct_bytes % 8 == 0;
}

// Marks a contact that begins, and returns the params with the fields that an older caller's lack, in *room. Or writes a
// refusal and returns null; then neither contact nor graph are touched.
[[gnu::cold]] const fdcg_params* admit(uint64_t mark, const fdcg_params& params, fdcg_params* room, fdcg_contact* contact,
                                       fdcg_result* result);
// The same, at the cost of two comparisons for a contact that goes on and whole params; of a call in a library built for size.
inline const fdcg_params* admitted(uint64_t mark, const fdcg_params& params, fdcg_params* room, fdcg_contact* contact,
                                   fdcg_result* result) {
#ifndef __OPTIMIZE_SIZE__
  if (internals_of(*contact).on == mark && params.struct_bytes == sizeof(fdcg_params)) [[likely]]
    return &params;
#endif
  return admit(mark, params, room, contact, result);
}
[[gnu::noinline, gnu::cold]] void refuse_step(uint32_t flag, fdcg_result* result);

}  // namespace fdcg
