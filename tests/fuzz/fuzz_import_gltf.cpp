// SPDX-License-Identifier: Apache-2.0
// The JSON form. Draco data in it would start a process for each execution: fuzz_import_drc.cpp has that.
#include "fuzz_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find("KHR_draco_mesh_compression") != std::string_view::npos) return -1;
  return fdcg::bake::fuzz_import(fdcg::bake::Format::gltf, data, size, fdcg::bake::kSceneMultiple);
}
