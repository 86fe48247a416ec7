// SPDX-License-Identifier: Apache-2.0
// Legacy files and XML. What is compressed may take as much as the limit on what it unpacks to allows.
#include "fuzz_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::size_t kUnpacked = std::size_t{1} << 18, kEachByte = 100;
  constexpr std::size_t kMultiple = fdcg::bake::kSceneMultiple;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find("compressor") != std::string_view::npos)
    return fdcg::bake::fuzz_import(fdcg::bake::Format::vtk, data, size, kEachByte * kMultiple, kUnpacked * kMultiple);
  return fdcg::bake::fuzz_import(fdcg::bake::Format::vtk, data, size, kMultiple);
}
