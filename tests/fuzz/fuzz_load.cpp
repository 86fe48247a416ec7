// SPDX-License-Identifier: Apache-2.0
// Any bytes through open and step: first as they are, then with checksums made to fit, so that the checks behind them are
// reached. Whatever opens with full verification is walked on.
#include "sealed_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fdcg::test::AlignedBytes file(std::as_bytes(std::span(data, size)));
  for (int pass = 0; pass < 2; ++pass) {
    fdcg_graph graph;
    fdcg_error error;
    if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK) {
      fdcg::test::touch_everywhere(graph, 200);
    }
    if (size >= sizeof(fdcg_header)) {
      std::memcpy(file.header().magic, FDCG_MAGIC, 8);
      file.header().format_version = FDCG_FORMAT_VERSION;
      file.header().file_bytes = size;
    }
    fdcg::test::seal(file);
  }
  return 0;
}
