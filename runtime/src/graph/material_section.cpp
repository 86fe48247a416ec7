// SPDX-License-Identifier: Apache-2.0
// Sections MATERIALS and MATERIAL_NAMES of an opened file.
#include "graph/material_section.hpp"

#include "base/message.hpp"

namespace fdcg {
namespace {

bool is_name(const char (&name)[FDCG_MATERIAL_NAME_BYTES]) {
  uint32_t end = 0;
  while (end < FDCG_MATERIAL_NAME_BYTES && name[end] != '\0')
    ++end;
  for (uint32_t i = end; i < FDCG_MATERIAL_NAME_BYTES; ++i) {
    if (name[i] != '\0') return false;
  }
  return end > 0 && end < FDCG_MATERIAL_NAME_BYTES;
}

bool is_same(const char* a, const char* b) {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

}  // namespace

fdcg_status verify_materials(const fdcg_graph& graph, fdcg_error* error) {
  const auto refuse = [error](const char* noun, uint64_t index, const char* what) -> fdcg_status {
    return Message(error, FDCG_E_GRAPH).say(noun, index, what, "; compile the mesh again");
  };
  for (uint32_t i = 0; i < graph.material_count; ++i) {
    if (!is_name(graph.materials[i].name)) return refuse("material ", i, ": its name does not end in its record, or is empty");
  }
  if (graph.node_materials == nullptr) return FDCG_OK;
  for (uint32_t n = 0; n < graph.header->node_count; ++n) {
    const uint16_t material = graph.node_materials[n];
    if (material >= graph.material_count && material != FDCG_NO_MATERIAL) return refuse("node ", n, ": material out of range");
  }
  return FDCG_OK;
}

}  // namespace fdcg

extern "C" uint32_t fdcg_get_node_material(const fdcg_graph* graph, uint32_t node) {
  const bool has = graph->node_materials != nullptr && graph->node_materials[node] != FDCG_NO_MATERIAL;
  return has ? graph->node_materials[node] : FDCG_NONE;
}

extern "C" const char* fdcg_get_material_name(const fdcg_graph* graph, uint32_t material) {
  return material < graph->material_count ? graph->materials[material].name : nullptr;
}

extern "C" uint32_t fdcg_find_material(const fdcg_graph* graph, const char* name) {
  for (uint32_t i = 0; i < graph->material_count; ++i) {
    if (fdcg::is_same(graph->materials[i].name, name)) return i;
  }
  return FDCG_NONE;
}
