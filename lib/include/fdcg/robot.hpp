// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/robot.hpp
/// Descriptions of robots and worlds (URDF, SDF) as lists of the mesh files that they name.
///
/// **Threads.** Functions may be called from several threads at once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

/// A mesh that a robot's description names.
struct NamedMesh {
  std::filesystem::path file;  ///< where it was found; where it was not, as the description has it
  Vec3 scale{1, 1, 1};         ///< as the description has it; a negative factor mirrors
  std::string link;            ///< the first link that has it
  std::string problem;         ///< why it was not found, one line; empty: it was
};

/// Whether these bytes are a description: XML whose root is `robot` or `sdf`.
bool is_robot(std::string_view bytes);

/// The meshes that a URDF or SDF file names in visuals and collisions, each pair of file and scale once, in the file's order.
/// "package://name/..." and "model://name/..." are looked for from the description's folder upward: in a folder of that name,
/// or beside a package.xml that has it; other names are relative to the description's folder. Fails with exit code 3 where the
/// description cannot be read.
Result<std::vector<NamedMesh>> meshes_of_robot(const std::filesystem::path& path);

/// Scales a mesh about the origin, with its quanta: each coordinate is rounded once. Where an odd number of factors is
/// negative, faces are turned, so that the outside stays outside. Factors are finite and not 0.
void scale_soup(PolygonSoup& soup, const Vec3& scale);

}  // namespace fdcg::bake
