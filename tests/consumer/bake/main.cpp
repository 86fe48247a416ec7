// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto soup = fdcg::bake::import_mesh(argv[1]);
  if (!soup) return 3;
  const auto compiled = fdcg::bake::compile(*soup, {});
  if (!compiled || !compiled->report.passes()) return 4;
  fdcg::Graph graph;
  if (!graph.open_memory(compiled->file(), nullptr)) return 5;
  std::printf("nodes %u\n", graph.header().node_count);
}
