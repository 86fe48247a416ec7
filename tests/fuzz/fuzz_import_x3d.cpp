// SPDX-License-Identifier: Apache-2.0
#include "fuzz_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  return fdcg::bake::fuzz_import(fdcg::bake::Format::x3d, data, size, fdcg::bake::kSceneMultiple);
}
