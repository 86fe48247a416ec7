// SPDX-License-Identifier: Apache-2.0
#include "open_graph.hpp"

#include <cstdio>

namespace fdcg::tools {
namespace {

// FDCG_VERIFY_FULL of a graph that was opened as trusted, chunk by chunk.
bool passes_in_chunks(const fdcg_graph& graph, const bake::Progress& progress) {
  const std::uint32_t chunks = fdcg_verify_chunk_count(&graph);
  std::uint32_t done = 0;
  for (const fdcg_verify level : {FDCG_VERIFY_SAFE, FDCG_VERIFY_FULL}) {
    fdcg_verification part{};
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      if (fdcg_verify_chunk(&graph, level, chunk, &part, nullptr) != FDCG_OK) return false;
      progress("verify the file", static_cast<double>(++done) / (2.0 * chunks));
    }
    if (fdcg_verify_sum(&graph, level, &part, 1, nullptr) != FDCG_OK) return false;
  }
  return true;
}

}  // namespace

fdcg_status OpenGraph::open(const std::string& path, const bake::Progress& progress, fdcg_error& error) {
  constexpr std::size_t kChunkBytes = 1 << 20;
  for (std::size_t got = path == "-" ? 1 : 0; got != 0; bytes_ += got) {
    words_.resize((bytes_ + kChunkBytes) / sizeof(std::uint64_t) + 1);
    got = std::fread(reinterpret_cast<char*>(words_.data()) + bytes_, 1, kChunkBytes, stdin);
  }
  const fdcg_status status = open_at(path, FDCG_VERIFY_TRUSTED, error);
  if (status != FDCG_OK || passes_in_chunks(graph_, progress)) return status;
  fdcg_close(&graph_);
  return open_at(path, FDCG_VERIFY_FULL, error);  // which says what is wrong
}

fdcg_status OpenGraph::open_at(const std::string& path, fdcg_verify verify, fdcg_error& error) {
  return path == "-" ? fdcg_open_memory(words_.data(), bytes_, verify, &graph_, &error)
                     : fdcg_open_file(path.c_str(), verify, &graph_, &error);
}

}  // namespace fdcg::tools
