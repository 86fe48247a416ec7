// SPDX-License-Identifier: Apache-2.0
// The records of an optional section that a program asks for by itself.
#pragma once

#include "graph/sections.hpp"

namespace fdcg {

// Null where the section is missing or has records of another size.
template <class Record>
const Record* records_of(const fdcg_header& header, uint32_t id, uint32_t* count) {
  constexpr uint64_t kMostRecords = FDCG_NONE - 1;
  const fdcg_section* const section = find_section(header, id);
  if (section == nullptr || section->record_bytes != sizeof(Record) || section->record_count > kMostRecords) return nullptr;
  *count = static_cast<uint32_t>(section->record_count);
  return reinterpret_cast<const Record*>(reinterpret_cast<const unsigned char*>(&header) + section->offset);
}

}  // namespace fdcg
