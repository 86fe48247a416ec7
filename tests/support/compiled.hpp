// SPDX-License-Identifier: Apache-2.0
// Compile, and insist on a file that breaks no rule.
#pragma once

#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "graph_walker.hpp"

namespace fdcg::test {

inline bake::Compiled compile_whole(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {}) {
  auto compiled = bake::compile(soup, options);
  INFO(soup.name);
  REQUIRE(compiled.has_value());
  INFO(bake::report_text(compiled->report, false));
  REQUIRE(!compiled->bytes.empty());
  return std::move(*compiled);
}

// Walked by format.h alone, and opened by the runtime with its full verification.
inline WalkedGraph compile_sound(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {}) {
  const bake::Compiled compiled = compile_whole(soup, options);
  WalkedGraph walked = read_graph(compiled.bytes);
  INFO(soup.name);
  CHECK(defects_of(walked) == std::vector<std::string>{});
  fdcg_graph graph;
  fdcg_error error;
  const fdcg_status status = fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error);
  INFO(error.message);
  CHECK(status == FDCG_OK);
  fdcg_close(&graph);
  return walked;
}

inline std::uint32_t connections_of(const WalkedGraph& graph, fdcg_connection_type type) {
  return graph.header.connection_type_count[type];
}

}  // namespace fdcg::test
