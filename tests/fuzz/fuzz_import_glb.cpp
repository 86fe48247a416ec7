// SPDX-License-Identifier: Apache-2.0
// The binary container: the first two bytes say how long the JSON is, so that the mutations need not keep the lengths right.
#include <algorithm>
#include <string>

#include "fuzz_import.hpp"

namespace {

void put_u32(std::string& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>(value >> shift & 0xFF);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::size_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find("KHR_draco_mesh_compression") != std::string_view::npos) return -1;
  if (text.starts_with("glTF") || size < 2)
    return fdcg::bake::fuzz_import(fdcg::bake::Format::gltf, data, size, fdcg::bake::kSceneMultiple);
  const std::size_t json_bytes = std::min<std::size_t>(data[0] | data[1] << 8, size - 2), binary_bytes = size - 2 - json_bytes;
  std::string glb = "glTF";
  put_u32(glb, 2);
  put_u32(glb, 28 + json_bytes + binary_bytes);
  put_u32(glb, json_bytes);
  put_u32(glb, kJson);
  glb += text.substr(2, json_bytes);
  put_u32(glb, binary_bytes);
  put_u32(glb, kBinary);
  glb += text.substr(2 + json_bytes);
  return fdcg::bake::fuzz_import(fdcg::bake::Format::gltf, reinterpret_cast<const unsigned char*>(glb.data()), glb.size(),
                                 fdcg::bake::kSceneMultiple);
}
