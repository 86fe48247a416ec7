// SPDX-License-Identifier: Apache-2.0
#include "gltf_writer.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>

namespace fdcg::test {
namespace {

void put_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>(value >> shift & 0xFF);
}

std::string number(std::size_t value) {
  return std::to_string(value);
}

struct Plain {
  std::string buffer, views, accessors;
};

Plain plain_geometry(const bake::PolygonSoup& soup) {
  Plain plain;
  for (const bake::Vec3& p : soup.points) {
    for (const double c : {p.x, p.y, p.z})
      put_u32(plain.buffer, std::bit_cast<std::uint32_t>(static_cast<float>(c)));
  }
  const std::size_t position_bytes = plain.buffer.size();
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    if (soup.face_first[f + 1] - soup.face_first[f] != 3) throw std::invalid_argument("write_gltf: not a triangle");
  }
  for (const std::uint32_t corner : soup.corners)
    put_u32(plain.buffer, corner);
  plain.views = R"({"buffer":0,"byteLength":)" + number(position_bytes) + R"(},{"buffer":0,"byteOffset":)" +
                number(position_bytes) + R"(,"byteLength":)" + number(plain.buffer.size() - position_bytes) + "}";
  plain.accessors = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" + number(soup.points.size()) +
                    R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + number(soup.corners.size()) + "}";
  return plain;
}

std::string document(const std::string& buffer, const std::string& views, const std::string& accessors,
                     const std::string& primitive_more, const std::string& more) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"node","mesh":0}],)"
         R"("meshes":[{"name":"mesh","primitives":[{"attributes":{"POSITION":0},"indices":1)" +
         primitive_more + R"(}]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[{)" + buffer +
         "}]" + more + "}";
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < n; ++k)
      group |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) << (16 - 8 * k);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string glb_container(std::string_view json, std::optional<std::string_view> binary) {
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  std::string chunks, text(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  put_u32(chunks, static_cast<std::uint32_t>(text.size()));
  put_u32(chunks, kJson);
  chunks += text;
  if (binary) {
    std::string data(*binary);
    data.resize((data.size() + 3) / 4 * 4, '\0');
    put_u32(chunks, static_cast<std::uint32_t>(data.size()));
    put_u32(chunks, kBinary);
    chunks += data;
  }
  std::string bytes = "glTF";
  put_u32(bytes, 2);
  put_u32(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
  return bytes + chunks;
}

std::string write_gltf(const bake::PolygonSoup& soup) {
  const Plain plain = plain_geometry(soup);
  return document(R"("byteLength":)" + number(plain.buffer.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
                      base64(plain.buffer) + '"',
                  plain.views, plain.accessors, "", "");
}

std::string write_glb(const bake::PolygonSoup& soup) {
  const Plain plain = plain_geometry(soup);
  return glb_container(document(R"("byteLength":)" + number(plain.buffer.size()), plain.views, plain.accessors, "", ""),
                       plain.buffer);
}

std::string write_glb_draco(const bake::PolygonSoup& soup, const DracoWriteOptions& options) {
  const std::string draco = write_drc(soup, options);
  const std::string views = R"({"buffer":0,"byteLength":)" + number(draco.size()) + "}";
  const std::string accessors = R"({"componentType":5126,"type":"VEC3","count":)" + number(soup.points.size()) +
                                R"(},{"componentType":5125,"type":"SCALAR","count":)" + number(soup.corners.size()) + "}";
  const std::string extension = R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
  const std::string more = R"(,"extensionsUsed":["KHR_draco_mesh_compression"],)"
                           R"("extensionsRequired":["KHR_draco_mesh_compression"])";
  return glb_container(document(R"("byteLength":)" + number(draco.size()), views, accessors, extension, more), draco);
}

}  // namespace fdcg::test
