// SPDX-License-Identifier: Apache-2.0
// The sections VISUAL_*: found and checked when a program asks for them, so that others link nothing of it.
#include "fdcg/visual.h"

#include "base/message.hpp"
#include "graph/section_records.hpp"
#include "graph/verify.hpp"

namespace fdcg {
namespace {

bool is_in(float value, float low, float high) {
  return value >= low && value <= high;  // false for NaN
}

bool is_finite(float value) {
  return is_in(value, -3.402823466e38f, 3.402823466e38f);
}

fdcg_status refuse_layout(fdcg_error* error, const char* what) {
  return Message(error, FDCG_E_GRAPH).say("the mesh for the eye: ", what, "; compile the mesh again");
}

fdcg_status find(const fdcg_header& header, fdcg_visual* visual, fdcg_error* error) {
  uint32_t present = 0, nodes = 0;
  for (uint32_t id = FDCG_SECTION_VISUAL_VERTICES; id <= FDCG_SECTION_VISUAL_MATERIALS; ++id)
    present += find_section(header, id) != nullptr;
  if (present == 0)
    return Message(error, FDCG_E_ABSENT).text("the file has no mesh for the eye: compile the mesh with --visual");
  visual->vertices = records_of<fdcg_visual_vertex>(header, FDCG_SECTION_VISUAL_VERTICES, &visual->vertex_count);
  visual->indices = records_of<uint32_t>(header, FDCG_SECTION_VISUAL_INDICES, &visual->index_count);
  visual->nodes = records_of<uint32_t>(header, FDCG_SECTION_VISUAL_NODES, &nodes);
  visual->materials = records_of<fdcg_visual_material>(header, FDCG_SECTION_VISUAL_MATERIALS, &visual->material_count);
  if (visual->vertices == nullptr || visual->indices == nullptr || visual->nodes == nullptr || visual->materials == nullptr)
    return refuse_layout(error, "sections 17 to 20 go together, and one is missing or has records of a wrong size");
  if (visual->vertex_count < header.corner_count || visual->index_count != uint64_t{3} * nodes || visual->material_count == 0)
    return refuse_layout(error, "its sections have numbers of records that do not fit");
  for (int k = 0; k < 3; ++k)
    visual->origin[k] = header.origin[k];
  visual->metres_per_unit = header.metres_per_unit;
  return FDCG_OK;
}

template <class Faults>
void look_at_vertex(const fdcg_header& header, const fdcg_visual_vertex& vertex, uint32_t index, Faults* faults) {
  constexpr int64_t kSlack = FDCG_NORMAL_SCALE / 64;  // 1.5 %
  constexpr int64_t kShort = FDCG_NORMAL_SCALE - kSlack, kLong = FDCG_NORMAL_SCALE + kSlack;
  bool is_number = is_finite(vertex.uv[0]) && is_finite(vertex.uv[1]);
  int64_t square = 0;
  for (int k = 0; k < 3; ++k) {
    is_number = is_number && is_finite(vertex.position[k]);
    square += int64_t{vertex.normal[k]} * vertex.normal[k];
  }
  faults->note(!is_number, "a number is not finite");
  faults->note(square < kShort * kShort || square > kLong * kLong || vertex.normal[3] != 0, "its normal is not of unit length");
  const bool is_corner = index < header.corner_count ? vertex.corner == index : vertex.corner < header.corner_count;
  faults->note(!is_corner && (index < header.corner_count || vertex.corner != FDCG_NONE), "corner out of range");
}

template <class Faults>
void look_at_material(const fdcg_visual& visual, uint32_t index, Faults* faults) {
  const fdcg_visual_material& material = visual.materials[index];
  bool is_over = false, is_name = material.name[FDCG_MATERIAL_NAME_BYTES - 1] == '\0', is_colour = true;
  for (const char c : material.name) {
    is_over = is_over || c == '\0';
    is_name = is_name && (!is_over || c == '\0');
  }
  for (const float share : material.base_colour)
    is_colour = is_colour && is_in(share, 0, 1);
  faults->note(!is_name, "its name does not end in its record");
  faults->note(!is_colour, "its base colour is not of 0 to 1");
  faults->note((material.flags & ~(FDCG_VISUAL_UV | FDCG_VISUAL_COLOURS)) != 0 || material.reserved != 0, "unknown flags");
  const uint64_t begin =
      index == 0 ? 0 : visual.materials[index - 1].first_index + uint64_t{visual.materials[index - 1].index_count};
  const uint64_t end = material.first_index + uint64_t{material.index_count};
  const bool is_last = index + 1 == visual.material_count;
  faults->note(material.first_index != begin || material.index_count % 3 != 0 || end > visual.index_count ||
                   (is_last && end != visual.index_count),
               "its triangles do not follow those before it, or are not all there");
}

fdcg_status check(const fdcg_header& header, const fdcg_visual& visual, fdcg_error* error) {
  fdcg_status status = for_all(0, visual.vertex_count, "visual vertex", error,
                               [&](uint32_t v, auto* faults) { look_at_vertex(header, visual.vertices[v], v, faults); });
  if (status != FDCG_OK) return status;
  status = for_all(0, visual.index_count, "visual index", error, [&](uint32_t i, auto* faults) {
    faults->note(visual.indices[i] >= visual.vertex_count, "vertex out of range");
  });
  if (status != FDCG_OK) return status;
  status = for_all(0, visual.index_count / 3, "visual triangle", error, [&](uint32_t t, auto* faults) {
    faults->note(visual.nodes[t] >= header.node_count && visual.nodes[t] != FDCG_NONE, "node out of range");
  });
  if (status != FDCG_OK) return status;
  return for_all(0, visual.material_count, "visual material", error,
                 [&](uint32_t m, auto* faults) { look_at_material(visual, m, faults); });
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_get_visual(const fdcg_graph* graph, fdcg_visual* visual, fdcg_error* error) {
  using namespace fdcg;
  if (visual == nullptr) return refuse(error, "visual: null pointer");
  *visual = {};
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not opened");
  fdcg_status status = find(*graph->header, visual, error);
  if (status == FDCG_OK) status = check(*graph->header, *visual, error);
  if (status != FDCG_OK) *visual = {};
  return status;
}
