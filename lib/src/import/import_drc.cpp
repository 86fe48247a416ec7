// SPDX-License-Identifier: Apache-2.0
// Draco files: one compressed triangle mesh. The decoded mesh is validated, because quantisation itself causes defects.
#include <string>

#include "base/quantised.hpp"
#include "base/srgb.hpp"
#include "import/draco_decode.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

// Of each corner; those without a vertex have what `Value{}` is.
template <class Value, class Convert>
void take_extra(const DracoMeshes::Mesh& mesh, DracoExtra which, const PolygonSoup& soup, std::vector<Value>& of_corners,
                const Convert& convert) {
  const std::span<const DracoValue> of_points = mesh.extra(which);
  if (of_points.empty()) return;
  of_corners.resize(soup.corners.size());
  for (std::size_t i = 0; i < soup.corners.size(); ++i)
    if (soup.corners[i] != PolygonSoup::kInvalidVertex) of_corners[i] = convert(of_points[soup.corners[i]]);
}

// As encoders leave them of OBJ and PLY: texture coordinates upwards, whole colours those of a screen.
void take_looks(const DracoMeshes::Mesh& mesh, PolygonSoup& soup) {
  take_extra(mesh, DracoExtra::uv, soup, soup.appearance.uv, [](const DracoValue& uv) {
    return std::array<float, 2>{uv[0], 1 - uv[1]};
  });
  take_extra(mesh, DracoExtra::colour, soup, soup.appearance.colours, [&mesh](const DracoValue& c) {
    Colour colour{};
    for (std::size_t k = 0; k < colour.size(); ++k)
      colour[k] = mesh.has_whole_colours && k < 3 ? linear_of_srgb(double{c[k]}) : share_of(double{c[k]});
    return colour;
  });
}

}  // namespace

Result<PolygonSoup> read_drc(const MeshText& input) {
  const DracoInput draco{input.bytes, std::nullopt, {}, input.wants_normals || input.wants_appearance};
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
  if (input.wants_normals) {
    take_extra(mesh, DracoExtra::normal, soup, soup.corner_normals, [](const DracoValue& n) {
      return Vec3{double{n[0]}, double{n[1]}, double{n[2]}};
    });
  }
  if (input.wants_appearance) take_looks(mesh, soup);
  if (mesh.is_float) soup.relative_quantum = 0x1p-24;
  if (mesh.absolute_quantum > 0) soup.absolute_quantum = at_most_a_share(mesh.absolute_quantum, soup.points);
  return soup;
}

}  // namespace fdcg::bake
