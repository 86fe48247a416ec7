// SPDX-License-Identifier: Apache-2.0
// A mesh on its way into a page: read, judged, repaired on request, compiled where it can be.
#pragma once

#include <optional>
#include <string>

#include "fdcg/bake.hpp"
#include "mesh_list.hpp"
#include "page/page_writer.hpp"

namespace fdcg::tools {

struct MeshView {
  std::optional<bake::Format> input_format;
  double metres_per_unit = 1;
  bool has_unit = false;  // it was given; else the mesh file's own counts, where it states one
  bake::Weld weld;
  bake::Precision precision = bake::Precision::f32;
  bool repair = false;
  bool touch = true;
  bake::CompileOptions felt;  // its normals and heights; the rest is set from what is here
  std::string heights;        // ImportOptions::heights
  bool shows_progress = true;
  unsigned jobs = 0;
};

inline constexpr std::size_t kPageElements = 10000;  // findings of each rule in a page; totals are exact all the same

// Why the mesh could not be read; empty: it is in the page, scaled.
std::string add_mesh_view(const MeshView& view, const ListedMesh& mesh, page::PageWriter& page);

// The same of a mesh that has been read and judged with these options.
void add_judged_mesh(const MeshView& view, const bake::PolygonSoup& soup, const bake::Report& report, page::PageWriter& page);

}  // namespace fdcg::tools
