// SPDX-License-Identifier: Apache-2.0
// Any bytes lead to a refusal or to a graph that is safe to step on. Run: fdcg_fuzz_load testdata/fuzz/load
#include "sealed_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fdcg::test::open_and_touch(std::as_bytes(std::span(data, size)), 200);
  return 0;
}
