// SPDX-License-Identifier: Apache-2.0
#include "dump.hpp"

#include <charconv>
#include <string>
#include <vector>

#include "fdcg/fdcg.h"

namespace fdcg::tools {
namespace {

constexpr const char* kTypes[] = {"convex", "concave", "coplanar", "boundary"};
constexpr const char* kFlatness[] = {"exact", "quantum", "angle"};
constexpr std::size_t kFlushBytes = 1 << 20;

class DumpText {
 public:
  explicit DumpText(AtomicFile& out) : out_(out) {}
  ~DumpText() { out_.write(text_); }
  DumpText(const DumpText&) = delete;
  DumpText& operator=(const DumpText&) = delete;

  DumpText& operator<<(const char* words) {
    text_ += words;
    return *this;
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> DumpText& operator<<(Number number) {
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    return *this;
  }
  template <class Real>
  DumpText& operator<<(const Real (&v)[3]) {
    return *this << "(" << v[0] << " " << v[1] << " " << v[2] << ")";
  }
  void end_line() {
    text_ += '\n';
    if (text_.size() < kFlushBytes) return;
    out_.write(text_);
    text_.clear();
  }

 private:
  AtomicFile& out_;
  std::string text_;
};

void dump_node_number(std::uint32_t node, DumpText& text) {
  if (node == FDCG_NONE) {
    text << "none";
  } else {
    text << node;
  }
}

void dump_nodes(const fdcg_graph& graph, DumpText& text) {
  for (std::uint32_t n = 0; n < graph.header->node_count; ++n) {
    const fdcg_node_info node = fdcg_get_node(&graph, n);
    text << "node " << n << ": normal " << node.normal << " offset " << node.offset << ", " << node.side_count << " sides"
         << ((node.flags & FDCG_NODE_INEXACT) != 0 ? ", inexact" : "");
    text.end_line();
    for (std::uint32_t k = 0; k < node.side_count; ++k) {
      const fdcg_side_info side = fdcg_get_side(&graph, n, k);
      text << "  side " << k << ": connection " << side.connection << " from corner " << side.corner << " to node ";
      dump_node_number(side.across, text);
      text << ", Voronoi plane " << side.voronoi_normal << " " << side.voronoi_offset;
      text.end_line();
    }
  }
}

void dump_connections(const fdcg_graph& graph, DumpText& text) {
  for (std::uint32_t c = 0; c < graph.header->connection_count; ++c) {
    const fdcg_connection_info connection = fdcg_get_connection(&graph, c);
    text << "connection " << c << ": " << kTypes[connection.type] << " (" << kFlatness[connection.flatness] << "), corners "
         << connection.corner[0] << " " << connection.corner[1] << ", nodes " << connection.node[0] << " ";
    dump_node_number(connection.node[1], text);
    text << ", edge " << connection.direction << " length " << connection.length;
    text.end_line();
  }
}

void dump_corners(const fdcg_graph& graph, DumpText& text) {
  std::vector<std::uint32_t> fan(graph.header->largest_fan);
  for (std::uint32_t v = 0; v < graph.header->corner_count; ++v) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph, v);
    text << "corner " << v << ": " << corner.point << ", normal " << corner.normal << (corner.is_open != 0 ? ", open" : "")
         << ", fan" << (corner.fan_count > FDCG_BUSY_FAN ? " with a tree:" : "");
    const std::uint32_t count = fdcg_get_fan(&graph, v, fan.data(), static_cast<std::uint32_t>(fan.size()));
    for (std::uint32_t i = 0; i < count; ++i)
      text << " " << (fan[i] >> 1);
    text.end_line();
  }
}

}  // namespace

void dump_records(const fdcg_graph& graph, AtomicFile& out) {
  DumpText text(out);
  text << "origin " << graph.header->origin << ", metres per unit " << graph.header->metres_per_unit;
  text.end_line();
  dump_nodes(graph, text);
  dump_connections(graph, text);
  dump_corners(graph, text);
}

}  // namespace fdcg::tools
