// SPDX-License-Identifier: Apache-2.0
// The graph -> the bytes of an FDCG v1 file (format.h), every floating-point number computed straight into its place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/format.h"
#include "graph/graph.hpp"
#include "graph/height_sections.hpp"
#include "graph/visual_mesh.hpp"

namespace fdcg::bake {

struct SerialiseInput {
  Vec3 origin;  // of the local frame, source units
  double metres_per_unit = 1;
  double quantum = 0;  // for the header
  std::uint32_t source_vertex_count = 0;
  std::uint32_t source_face_count = 0;
  std::vector<std::uint32_t> node_of_source;       // of each source face, or kNone
  std::optional<fdcg_mass_record> mass;            // none: no section
  std::vector<std::string> materials;              // names; empty: no sections
  std::vector<std::uint16_t> material_of_face;     // of each face the graph was made of
  std::vector<fdcg_node_normals> normals_of_face;  // likewise; empty: no section
  VisualMesh visual;                               // empty: no sections
  HeightSections heights;                          // empty: no sections
  std::string info;                                // JSON; empty: no section
  Precision precision = Precision::f64;
  bool with_planes = true;
  bool with_hierarchy = true;
  bool with_source_map = true;
  unsigned jobs = 1;
};

// Same input, same bytes, whatever `jobs`. Fails (3) where a count exceeds the format's limit or memory runs out.
[[nodiscard]] Result<std::span<std::byte>> serialise(const Graph& graph, const SerialiseInput& input, const Allocate& allocate);

}  // namespace fdcg::bake
