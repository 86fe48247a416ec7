// SPDX-License-Identifier: Apache-2.0
// An FDCG file, opened and verified in full.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {

// A graph and the memory that it views.
class OpenGraph {
 public:
  OpenGraph() = default;
  ~OpenGraph() { fdcg_close(&graph_); }
  OpenGraph(const OpenGraph&) = delete;
  OpenGraph& operator=(const OpenGraph&) = delete;

  // A file, or "-". The error is that of fdcg_open_file and fdcg_open_memory with FDCG_VERIFY_FULL.
  fdcg_status open(const std::string& path, const bake::Progress& progress, fdcg_error& error);
  [[nodiscard]] const fdcg_graph& graph() const { return graph_; }

 private:
  fdcg_status open_at(const std::string& path, fdcg_verify verify, fdcg_error& error);

  fdcg_graph graph_{};
  std::vector<std::uint64_t> words_;  // of standard input
  std::size_t bytes_ = 0;
};

}  // namespace fdcg::tools
