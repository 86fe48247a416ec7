// SPDX-License-Identifier: Apache-2.0
#include "drc_writer.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <array>
#include <stdexcept>

namespace fdcg::test {
namespace {

bool is_float(const bake::PolygonSoup& soup) {
  for (const bake::Vec3& p : soup.points) {
    for (const double c : {p.x, p.y, p.z}) {
      if (c == c && static_cast<double>(static_cast<float>(c)) != c) return false;
    }
  }
  return true;
}

template <class T>
void add_positions(draco::Mesh& mesh, const bake::PolygonSoup& soup, draco::DataType type) {
  const auto count = static_cast<std::uint32_t>(soup.points.size());
  draco::GeometryAttribute shape;
  shape.Init(draco::GeometryAttribute::POSITION, nullptr, 3, type, false, 3 * sizeof(T), 0);
  const int id = mesh.AddAttribute(shape, true, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const bake::Vec3& p = soup.points[i];
    const std::array<T, 3> xyz = {static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)};
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), xyz.data());
  }
}

std::string encoded(draco::Encoder& encoder, const draco::Mesh& mesh) {
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) throw std::runtime_error("write_drc: " + status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

}  // namespace

std::string write_drc(const bake::PolygonSoup& soup, const DracoWriteOptions& options) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(soup.points.size()));
  if (is_float(soup)) {
    add_positions<float>(mesh, soup, draco::DT_FLOAT32);
  } else {
    add_positions<double>(mesh, soup, draco::DT_FLOAT64);
  }
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    if (soup.face_first[f + 1] - soup.face_first[f] != 3) throw std::invalid_argument("write_drc: not a triangle");
    draco::Mesh::Face face;
    for (std::uint32_t k = 0; k < 3; ++k)
      face[k] = draco::PointIndex(soup.corners.at(soup.face_first[f] + k));
    mesh.AddFace(face);
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(options.method == DracoMethod::sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                      : draco::MESH_EDGEBREAKER_ENCODING);
  if (options.position_bits > 0) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, options.position_bits);
  }
  return encoded(encoder, mesh);
}

std::string write_drc_with_looks(const bake::PolygonSoup& soup, const DracoWriteOptions& options) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(soup.face_count()));
  const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int places = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colours = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    std::array<std::array<float, 3>, 3> at{}, normal{};
    std::array<std::array<std::uint8_t, 4>, 3> colour{};
    const std::size_t first = soup.face_first[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const bake::Vec3 &p = soup.points.at(soup.corners[first + k]), &n = soup.corner_normals[first + k];
      at[k] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      normal[k] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
      for (std::size_t c = 0; c < 4; ++c)
        colour[k][c] = static_cast<std::uint8_t>(soup.appearance.colours[first + k][c] * 255 + 0.5f);
    }
    const auto& uv = soup.appearance.uv;
    const draco::FaceIndex face(f);
    builder.SetAttributeValuesForFace(positions, face, at[0].data(), at[1].data(), at[2].data());
    builder.SetAttributeValuesForFace(normals, face, normal[0].data(), normal[1].data(), normal[2].data());
    builder.SetAttributeValuesForFace(places, face, uv[first].data(), uv[first + 1].data(), uv[first + 2].data());
    builder.SetAttributeValuesForFace(colours, face, colour[0].data(), colour[1].data(), colour[2].data());
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(options.method == DracoMethod::sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                      : draco::MESH_EDGEBREAKER_ENCODING);
  if (options.position_bits > 0) {
    constexpr int kNormalBits = 10, kPlaceBits = 12;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, options.position_bits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, kNormalBits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, kPlaceBits);
  }
  return encoded(encoder, *builder.Finalize());
}

std::string write_drc_with_seam() {
  constexpr std::array<std::array<float, 3>, 4> kPlaces = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  constexpr std::array<std::array<std::size_t, 3>, 2> kFaces = {{{0, 1, 2}, {0, 2, 3}}};
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int colours = builder.AddAttribute(draco::GeometryAttribute::COLOR, 1, draco::DT_UINT8);
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto& [a, b, c] = kFaces[f];
    const auto colour = static_cast<std::uint8_t>(f);
    builder.SetAttributeValuesForFace(positions, draco::FaceIndex(f), kPlaces[a].data(), kPlaces[b].data(), kPlaces[c].data());
    builder.SetAttributeValuesForFace(colours, draco::FaceIndex(f), &colour, &colour, &colour);
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  return encoded(encoder, *builder.Finalize());
}

std::string write_drc_cloud() {
  constexpr std::array<float, 12> kPlaces = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  draco::PointCloudBuilder builder;
  builder.Start(4);
  const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  builder.SetAttributeValuesForAllPoints(positions, kPlaces.data(), 0);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodePointCloudToBuffer(*builder.Finalize(false), &buffer);
  if (!status.ok()) throw std::runtime_error("write_drc_cloud: " + status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

}  // namespace fdcg::test
