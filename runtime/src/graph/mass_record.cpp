// SPDX-License-Identifier: Apache-2.0
#include "shared/mass_record.hpp"

#include "base/message.hpp"
#include "graph/sections.hpp"

namespace fdcg {
namespace {

// Null where the file has none.
const fdcg_mass_record* mass_record(const fdcg_header& header) {
  const fdcg_section* const section = find_section(header, FDCG_SECTION_MASS);
  if (section == nullptr) return nullptr;
  return reinterpret_cast<const fdcg_mass_record*>(reinterpret_cast<const unsigned char*>(&header) + section->offset);
}

fdcg_status read_mass(const fdcg_header& header, const fdcg_mass_record& record, fdcg_mass* mass, fdcg_error* error) {
  *mass = mass_in_metres(record, header.origin, header.metres_per_unit);
  const char* fault = mass_fault(*mass);
  if (fault == nullptr && !(record.deviation >= 0 && record.deviation <= FDCG_LARGEST_EXTENT_F64))
    fault = "the deviation is out of range";
  if (fault == nullptr) return FDCG_OK;
  *mass = {};
  return Message(error, FDCG_E_GRAPH).say("mass properties: ", fault, "; compile the mesh again");
}

}  // namespace

fdcg_status verify_mass(const fdcg_header& header, fdcg_error* error) {
  const fdcg_mass_record* const record = mass_record(header);
  fdcg_mass mass;
  return record == nullptr ? FDCG_OK : read_mass(header, *record, &mass, error);
}

}  // namespace fdcg

extern "C" fdcg_status fdcg_get_mass(const fdcg_graph* graph, fdcg_mass* mass, fdcg_error* error) {
  using fdcg::Message;
  if (mass == nullptr) return Message(error, FDCG_E_ARGUMENT).text("mass: null pointer");
  *mass = {};
  if (graph == nullptr || graph->header == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("graph: null pointer, or not opened");
  const fdcg_mass_record* const record = fdcg::mass_record(*graph->header);
  if (record != nullptr) return fdcg::read_mass(*graph->header, *record, mass, error);
  return Message(error, FDCG_E_ABSENT)
      .text("the file has no mass properties: the mesh is not a closed solid, or they were left out; fdcg inspect says why");
}
