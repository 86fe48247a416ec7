// SPDX-License-Identifier: Apache-2.0
#include "graph/fan_run_section.hpp"

#include "base/config.hpp"
#include "base/message.hpp"
#include "graph/graph_view.hpp"

namespace fdcg {
namespace {

template <class Real>
bool has_corner(NodeRef<RigidGeometry<Real>> node, uint32_t corner) {
  for (uint32_t k = 0; k < node.side_count(); ++k) {
    if (node.corner(k) == corner) return true;
  }
  return false;
}

// The first run that is not sound, or how many there are.
template <class Real>
uint32_t sound_runs(const RigidView<Real>& graph) {
  const fdcg_header& header = *graph.header();
  uint64_t end = 0;
  for (uint32_t i = 0; i < graph.fan_run_count(); ++i) {
    const fdcg_fan_run& run = graph.fan_runs()[i];
    if (run.first_node < end || run.node_count == 0 || run.node_count > header.node_count ||
        run.first_node > header.node_count - run.node_count || run.busy >= header.busy_count ||
        (run.flags & ~FDCG_RUN_INEXACT) != 0)
      return i;
    end = uint64_t{run.first_node} + run.node_count;
    const uint32_t corner = graph.busy_corners()[run.busy].corner;
    for (uint32_t n = run.first_node; n < end; ++n) {
      if (!has_corner<Real>(graph.node(n), corner)) return i;
    }
  }
  return graph.fan_run_count();
}

}  // namespace

fdcg_status verify_fan_runs(const fdcg_graph& graph, fdcg_error* error) {
  const uint32_t sound = with_real_of(*graph.header, [&](auto real) { return sound_runs(RigidView<decltype(real)>(graph)); });
  if (sound == graph.fan_run_count) return FDCG_OK;
  return Message(error, FDCG_E_GRAPH)
      .text("fan run ")
      .number(sound)
      .text(": out of range, or a node of it is not at its corner; compile the mesh again");
}

}  // namespace fdcg
