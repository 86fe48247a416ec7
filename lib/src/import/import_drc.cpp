// SPDX-License-Identifier: Apache-2.0
// Draco files: one compressed triangle mesh. The decoded mesh is validated, because quantisation itself causes defects.
#include <string>

#include "base/quantised.hpp"
#include "import/draco_decode.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {

Result<PolygonSoup> read_drc(const MeshText& input) {
  const DracoInput draco{input.bytes, std::nullopt};
  const DracoMeshes decoded = decode_draco({&draco, 1}, draco_limits(input.bytes.size()));
  if (!decoded.trouble().empty()) return refuse(input.name, decoded.refusal());
  const DracoMeshes::Mesh& mesh = decoded.meshes().front();
  if (!mesh.trouble.empty()) return refuse(input.name, mesh.trouble + "; fetch the file or compress the mesh again");
  if (mesh.is_point_cloud) return refuse(input.name, "is a Draco point cloud and holds no face; compress a mesh", "empty-mesh");
  if (mesh.points.size() > kMaxPoints || mesh.corners.size() > kMaxCorners) {
    return refuse(input.name, "holds more than 4,294,967,040 vertices or face corners; cut the mesh into parts");
  }
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::drc;
  soup.points.assign(mesh.points.begin(), mesh.points.end());
  soup.corners.assign(mesh.corners.begin(), mesh.corners.end());
  for (std::uint32_t& corner : soup.corners) {
    if (corner >= soup.points.size()) corner = PolygonSoup::kInvalidVertex;
  }
  soup.face_first.reserve(soup.corners.size() / 3 + 1);
  for (std::size_t first = 0; first <= soup.corners.size(); first += 3)
    soup.face_first.push_back(static_cast<std::uint32_t>(first));
  if (mesh.is_float) soup.relative_quantum = 0x1p-24;
  if (mesh.absolute_quantum > 0) soup.absolute_quantum = at_most_a_share(mesh.absolute_quantum, soup.points);
  return soup;
}

}  // namespace fdcg::bake
