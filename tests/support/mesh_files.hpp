// SPDX-License-Identifier: Apache-2.0
// Mesh files written the plain way for tests, independent of the library's own writers: they carry what those refuse (indices
// out of range, NaN), and say on which line each thing stands.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

enum class FileKind { off, obj, ply_text, ply_little, ply_big, stl_text, stl_binary, gltf, glb, glb_draco, drc };

inline constexpr std::array kFileKinds = {FileKind::off,     FileKind::obj,       FileKind::ply_text,   FileKind::ply_little,
                                          FileKind::ply_big, FileKind::stl_text,  FileKind::stl_binary, FileKind::gltf,
                                          FileKind::glb,     FileKind::glb_draco, FileKind::drc};

const char* name_of(FileKind kind);
bool holds_polygons(FileKind kind);     // else triangles alone
bool holds_vertices(FileKind kind);     // else (STL) each corner is a point of its own
bool holds_bad_indices(FileKind kind);  // names of vertices that are not there

struct MeshFile {
  std::string bytes;
  std::vector<std::uint32_t> point_line, face_line;  // 1-based, as soups have them; empty in binary files
};

// Every coordinate must be a float's value (or not finite). kInvalidVertex becomes an index beyond the last vertex. STL's
// points are those of its facets. Draco is sequential and not quantised, so that numbers stay. `comments`: OFF and OBJ get
// remarks and blank lines between their lines.
MeshFile write_mesh(const bake::PolygonSoup& soup, FileKind kind, bool comments = false);

}  // namespace fdcg::test
