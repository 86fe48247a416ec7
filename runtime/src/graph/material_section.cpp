// SPDX-License-Identifier: Apache-2.0
// Sections MATERIALS and MATERIAL_NAMES of an opened file.
#include "fdcg/fdcg.h"

namespace fdcg {
namespace {

bool is_same_text(const char* a, const char* b) {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

}  // namespace
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
    if (fdcg::is_same_text(graph->materials[i].name, name)) return i;
  }
  return FDCG_NONE;
}
