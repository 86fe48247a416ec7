// SPDX-License-Identifier: Apache-2.0
#include "dump.hpp"

#include <charconv>
#include <string>

#include "typed_graph.hpp"

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

template <class Records>
void dump_nodes(const TypedGraph<Records>& graph, DumpText& text) {
  for (std::uint32_t n = 0; n < graph.header.node_count; ++n) {
    const auto& node = graph.nodes[n];
    text << "node " << n << ": normal " << node.plane.normal << " offset " << node.plane.offset << ", "
         << std::uint32_t{node.side_count} << " sides" << ((node.flags & FDCG_NODE_INEXACT) != 0 ? ", inexact" : "");
    text.end_line();
    for (std::uint32_t side = node.first_side; side < node.first_side + node.side_count; ++side) {
      text << "  side " << side << ": connection " << graph.connection_of(side) << " from corner " << graph.start_corner(side);
      if (graph.voronoi_planes != nullptr) {
        const auto& plane = graph.voronoi_planes[side];
        text << ", Voronoi plane " << plane.normal << " " << plane.offset;
      }
      text.end_line();
    }
  }
}

template <class Records>
void dump_connections(const TypedGraph<Records>& graph, DumpText& text) {
  for (std::uint32_t c = 0; c < graph.header.connection_count; ++c) {
    const auto& connection = graph.connections[c];
    text << "connection " << c << ": " << kTypes[connection.type] << " (" << kFlatness[connection.flatness] << "), corners "
         << connection.corner[0] << " " << connection.corner[1] << ", nodes " << connection.node[0] << " ";
    if (connection.node[1] == FDCG_NONE) {
      text << "none";
    } else {
      text << connection.node[1];
    }
    text << ", edge " << connection.edge << ", end planes " << connection.end_offset[0] << " " << connection.end_offset[1];
    text.end_line();
  }
}

template <class Records>
void dump_corners(const TypedGraph<Records>& graph, DumpText& text) {
  for (std::uint32_t v = 0; v < graph.header.corner_count; ++v) {
    const auto& corner = graph.corners[v];
    text << "corner " << v << ": " << corner.point << ", normal " << corner.normal
         << ((corner.flags & FDCG_CORNER_OPEN) != 0 ? ", open" : "") << ", fan";
    if (const std::uint32_t tree = corner.flags >> FDCG_CORNER_TREE_SHIFT; tree != 0)
      text << " with its tree at box " << tree - 1 << ":";
    for (std::uint32_t i = corner.first_fan; i < corner.first_fan + corner.fan_count; ++i)
      text << " " << (graph.fans[i] >> 1);
    text.end_line();
  }
}

}  // namespace

void dump_records(const fdcg_graph& graph, AtomicFile& out) {
  DumpText text(out);
  text << "origin " << graph.header->origin << ", metres per unit " << graph.header->metres_per_unit;
  text.end_line();
  visit_typed(graph, [&text](const auto& typed) {
    dump_nodes(typed, text);
    dump_connections(typed, text);
    dump_corners(typed, text);
  });
}

}  // namespace fdcg::tools
