// SPDX-License-Identifier: Apache-2.0
// Look-up of a section in the table of an opened file.
#pragma once

#include "fdcg/format.h"

namespace fdcg {

inline const fdcg_section* section_table(const fdcg_header& header) {
  return reinterpret_cast<const fdcg_section*>(&header + 1);
}

// Null where the file has no such section.
inline const fdcg_section* find_section(const fdcg_header& header, uint32_t id) {
  const fdcg_section* const sections = section_table(header);
  for (uint32_t i = 0; i < header.section_count; ++i) {
    if (sections[i].id == id) return &sections[i];
  }
  return nullptr;
}

// Of a table's entry, its padding included.
inline uint64_t section_bytes(const fdcg_header& header, uint32_t entry) {
  const fdcg_section* const sections = section_table(header);
  const bool is_last = entry + 1 == header.section_count;
  return (is_last ? header.file_bytes : sections[entry + 1].offset) - sections[entry].offset;
}

}  // namespace fdcg
