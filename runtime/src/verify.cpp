// SPDX-License-Identifier: Apache-2.0
#include "verify.hpp"

#include "box_tree.hpp"
#include "config.hpp"
#include "graph_view.hpp"
#include "implicit_tree.hpp"
#include "message.hpp"

namespace fdcg {
namespace {

// How far a stored unit vector's squared length may lie from 1.
template <class Real>
constexpr double kUnitTolerance = sizeof(Real) == 8 ? 1e-9 : 1e-4;

template <class Real>
bool is_unit(Vec3<Real> v) {
  const Vec3<double> w = widen(v);
  const double off = dot(w, w) - 1;
  return off <= kUnitTolerance<Real> && off >= -kUnitTolerance<Real>;  // false for NaN too
}

// Of a box record. The sweep's rounding is bounded for boxes this near to the object; cells no smaller keep the box of a lane
// that is not used inside out.
constexpr float kFarthestBox = 8;
constexpr uint8_t kLeastCellExponent = 127 - 24, kLargestCellExponent = 127;

template <class Real>
class Verifier {
 public:
  Verifier(const fdcg_graph& graph, fdcg_error* error) : graph_(graph), header_(*graph.header), raw_(graph), error_(error) {}

  fdcg_status run() {
    fdcg_status status = connections();
    if (status == FDCG_OK) status = nodes();
    if (status == FDCG_OK) status = corners();
    if (status == FDCG_OK && raw_.hierarchy != nullptr) status = hierarchy();
    if (status == FDCG_OK && raw_.source_map != nullptr) status = source_map();
    return status;
  }

 private:
  fdcg_status refuse(const char* noun, uint64_t index, const char* what) {
    return Message(error_, FDCG_E_GRAPH)
        .text(noun)
        .text(" ")
        .number(index)
        .text(": ")
        .text(what)
        .text("; compile the mesh again");
  }

  fdcg_status connections() {
    uint32_t types[4] = {};
    for (uint32_t c = 0; c < header_.connection_count; ++c) {
      const auto& connection = graph_.connections[c];
      if (connection.type > FDCG_BOUNDARY || connection.flatness > FDCG_FLAT_ANGLE || connection.reserved != 0) {
        return refuse("connection", c, "unknown type, flatness or reserved bits");
      }
      ++types[connection.type];
      if (!is_unit(vec(connection.edge))) return refuse("connection", c, "edge vector is not of unit length");
      if (!(absolute(connection.end_offset[0]) <= 4 * header_.extent) ||
          !(absolute(connection.end_offset[1]) <= 4 * header_.extent)) {
        return refuse("connection", c, "end plane lies outside the object");
      }
      if (connection.corner[0] >= header_.corner_count || connection.corner[1] >= header_.corner_count ||
          connection.corner[0] == connection.corner[1]) {
        return refuse("connection", c, "corner out of range");
      }
      const bool is_open = connection.node[1] == FDCG_NONE;
      if (is_open != (connection.type == FDCG_BOUNDARY)) return refuse("connection", c, "type does not fit its nodes");
      for (int k = 0; k < (is_open ? 1 : 2); ++k) {
        if (connection.node[k] >= header_.node_count) return refuse("connection", c, "node out of range");
        const auto& node = graph_.nodes[connection.node[k]];
        const uint64_t side = uint64_t{node.first_side} + connection.side[k];
        if (connection.side[k] >= node.side_count || side >= header_.side_count ||
            graph_.sides[side] != (c << 1 | static_cast<uint32_t>(k))) {
          return refuse("connection", c, "its node does not own it");
        }
      }
      if (is_open && connection.side[1] != 0) return refuse("connection", c, "side of a missing node");
    }
    for (int k = 0; k < 4; ++k) {
      if (types[k] != header_.connection_type_count[k])
        return refuse("header.connection_type_count", static_cast<uint64_t>(k), "wrong");
    }
    return FDCG_OK;
  }

  fdcg_status nodes() {
    uint64_t first_side = 0;
    for (uint32_t n = 0; n < header_.node_count; ++n) {
      const auto& node = graph_.nodes[n];
      if (node.first_side != first_side || node.side_count < 3 || node.side_count > header_.side_count - first_side) {
        return refuse("node", n, "sides out of range");
      }
      first_side += node.side_count;
      if ((node.flags & ~FDCG_NODE_INEXACT) != 0) return refuse("node", n, "unknown flags");
      if (!is_unit(vec(node.plane.normal))) return refuse("node", n, "normal is not of unit length");
      if (!(absolute(node.plane.offset) <= 4 * header_.extent)) return refuse("node", n, "plane lies outside the object");
      if (const fdcg_status status = loop(n, node); status != FDCG_OK) return status;
    }
    return first_side == header_.side_count ? FDCG_OK
                                            : refuse("header.side_count", header_.side_count, "not the sum of the nodes'");
  }

  // Each side belongs to this node at this place and ends where the next one starts.
  fdcg_status loop(uint32_t n, const typename Records<Real>::Node& node) {
    for (uint32_t k = 0; k < node.side_count; ++k) {
      const uint32_t side = node.first_side + k, which = graph_.sides[side] & 1, c = graph_.sides[side] >> 1;
      if (c >= header_.connection_count) return refuse("side", side, "connection out of range");
      const auto& connection = graph_.connections[c];
      if (connection.node[which] != n || connection.side[which] != k)
        return refuse("side", side, "its connection does not lead back");
      const uint32_t next = node.first_side + (k + 1 < node.side_count ? k + 1 : 0);
      if (graph_.sides[next] >> 1 >= header_.connection_count) return refuse("side", next, "connection out of range");
      if (connection.corner[1 - which] != graph_.connections[graph_.sides[next] >> 1].corner[graph_.sides[next] & 1])
        return refuse("node", n, "its sides do not form a loop");
      const Plane<Real> plane = graph_.node(n).voronoi_plane(k);  // stored, or as the step will derive it
      if (!is_unit(plane.normal) || !(absolute(plane.offset) <= 4 * header_.extent))
        return refuse("side", side, "Voronoi plane out of range");
    }
    return FDCG_OK;
  }

  fdcg_status corners() {
    uint64_t first_fan = 0, fan_boxes = 0;
    for (uint32_t v = 0; v < header_.corner_count; ++v) {
      const auto& corner = graph_.corners[v];
      const bool is_open = (corner.flags & FDCG_CORNER_OPEN) != 0;
      if (corner.first_fan != first_fan || corner.fan_count < 2 || corner.fan_count > header_.fan_count - first_fan ||
          corner.fan_count > header_.largest_fan) {
        return refuse("corner", v, "fan out of range");
      }
      first_fan += corner.fan_count;
      const uint32_t tree = corner.flags >> FDCG_CORNER_TREE_SHIFT;
      if (tree == 0 && corner.fan_count > FDCG_BUSY_FAN) return refuse("corner", v, "busy, but it has no tree");
      if (tree != 0) {
        const uint64_t boxes = ImplicitTree(corner.fan_count, FDCG_LEAF_FAN).boxes;
        if (tree - 1 != fan_boxes || boxes > header_.fan_box_count - fan_boxes) {
          return refuse("corner", v, "its tree is out of range");
        }
        fan_boxes += boxes;
      }
      for (int k = 0; k < 3; ++k) {
        const double x = corner.point[k];
        if (!(absolute(x) <= header_.extent) || x < header_.bounds_min[k] || x > header_.bounds_max[k]) {
          return refuse("corner", v, "outside the bounds");
        }
        if (!(absolute(corner.normal[k]) <= 2)) return refuse("corner", v, "normal out of range");
      }
      if (const fdcg_status status = fan(v, corner, is_open); status != FDCG_OK) return status;
    }
    if (first_fan != header_.fan_count) return refuse("header.fan_count", header_.fan_count, "not the sum of the corners'");
    return trees(fan_boxes);
  }

  fdcg_status trees(uint64_t counted) {
    if (counted != header_.fan_box_count)
      return refuse("header.fan_box_count", header_.fan_box_count, "not the sum of the corners'");
    if (counted != 0 && raw_.fan_boxes == nullptr)
      return refuse("header.fan_box_count", counted, "but there is no such section");
    for (uint32_t i = 0; i < header_.fan_box_count; ++i) {
      const auto& box = graph_.fan_boxes[i];
      bool is_in_range = norm1(vec(box.centre)) <= 4;
      for (const auto& axis : box.axis)
        is_in_range = is_in_range && norm1(vec(axis)) <= 8;
      if (!is_in_range) return refuse("fan box", i, "out of range");
    }
    return FDCG_OK;
  }

  // Each entry starts at this corner; the node to its left comes in along the next entry.
  fdcg_status fan(uint32_t v, const typename Records<Real>::Corner& corner, bool is_open) {
    for (uint32_t i = 0; i < corner.fan_count; ++i) {
      const uint32_t entry = graph_.fans[corner.first_fan + i], c = entry >> 1, end = entry & 1;
      if (c >= header_.connection_count || graph_.connections[c].corner[end] != v)
        return refuse("corner", v, "fan does not start here");
      const uint32_t n = graph_.connections[c].node[end];
      const bool is_last = i + 1 == corner.fan_count;
      if ((n == FDCG_NONE) != (is_open && is_last)) return refuse("corner", v, "fan is open at the wrong place");
      if (n == FDCG_NONE) continue;
      const auto& node = graph_.nodes[n];
      const uint32_t outgoing = graph_.connections[c].side[end];
      const uint32_t incoming = node.first_side + (outgoing == 0 ? node.side_count : outgoing) - 1;
      const uint32_t next = graph_.fans[corner.first_fan + (is_last ? 0 : i + 1)];
      if (graph_.sides[incoming] >> 1 != next >> 1) return refuse("corner", v, "fan is not in cyclic order");
    }
    return FDCG_OK;
  }

  // One coordinate of a box, in tree units; no rounding: a float of at most 24 bits and eight bits of cells.
  static double low_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return double{boxes.origin[axis]} + double{tree_cell(boxes.exponent[axis])} * boxes.low[axis][j];
  }
  static double high_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return double{boxes.origin[axis]} + double{tree_cell(boxes.exponent[axis])} * boxes.high[axis][j];
  }

  // Records in range, leaf boxes hold their nodes' corners, every box those of the record below.
  fdcg_status hierarchy() {
    const BoxTree tree(header_.node_count);
    for (uint32_t i = 0; i < tree.records; ++i) {
      const fdcg_box8& boxes = raw_.hierarchy[i];
      bool is_in_range = boxes.reserved == 0;
      for (int axis = 0; axis < 3; ++axis) {
        is_in_range = is_in_range && absolute(boxes.origin[axis]) <= kFarthestBox &&
                      boxes.exponent[axis] >= kLeastCellExponent && boxes.exponent[axis] <= kLargestCellExponent;
      }
      if (!is_in_range) return refuse("box record", i, "origin, exponent or reserved byte out of range");
    }
    const double per_unit = 1 / tree_unit(header_.extent);
    for (uint32_t n = 0; n < header_.node_count; ++n) {
      const uint32_t leaf = n / FDCG_LEAF_NODES;
      const fdcg_box8& boxes = raw_.hierarchy[tree.first[0] + leaf / FDCG_TREE_WAYS];
      if (!holds_node(boxes, leaf % FDCG_TREE_WAYS, n, per_unit)) return refuse("node", n, "sticks out of its box");
    }
    for (int level = 1; level < tree.levels; ++level) {
      for (uint32_t i = 0; i < tree.size[level - 1]; ++i) {
        const fdcg_box8& above = raw_.hierarchy[tree.first[level] + i / FDCG_TREE_WAYS];
        const fdcg_box8& below = raw_.hierarchy[tree.first[level - 1] + i];
        if (!holds_boxes(above, i % FDCG_TREE_WAYS, below, tree.lanes(level - 1, i)))
          return refuse("box record", tree.first[level - 1] + i, "sticks out of the box above");
      }
    }
    return FDCG_OK;
  }

  bool holds_node(const fdcg_box8& boxes, uint32_t j, uint32_t n, double per_unit) const {
    const NodeRef<Real> node = graph_.node(n);
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      const Vec3<double> point = widen(graph_.corner_point(node.corner(k))) * per_unit;
      const double at[3] = {point.x, point.y, point.z};
      for (int axis = 0; axis < 3; ++axis) {
        if (!(low_of(boxes, axis, j) <= at[axis] && at[axis] <= high_of(boxes, axis, j))) return false;
      }
    }
    return true;
  }

  static bool holds_boxes(const fdcg_box8& above, uint32_t j, const fdcg_box8& below, uint32_t lanes) {
    for (int axis = 0; axis < 3; ++axis) {
      const double low = low_of(above, axis, j), high = high_of(above, axis, j);
      for (uint32_t i = 0; lanes >> i != 0; ++i) {
        if (!(low <= low_of(below, axis, i) && high_of(below, axis, i) <= high)) return false;
      }
    }
    return true;
  }

  fdcg_status source_map() {
    for (uint32_t f = 0; f < header_.source_face_count; ++f) {
      if (raw_.source_map[f] >= header_.node_count && raw_.source_map[f] != FDCG_NONE)
        return refuse("source face", f, "node out of range");
    }
    return FDCG_OK;
  }

  const GraphView<Real> graph_;
  const fdcg_header& header_;
  const fdcg_graph& raw_;
  fdcg_error* error_;
};

}  // namespace

fdcg_status verify_checksums(const void* data, const fdcg_header& header, fdcg_error* error) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  const auto* sections = reinterpret_cast<const fdcg_section*>(bytes + sizeof(fdcg_header));
  for (uint32_t i = 0; i < header.section_count; ++i) {
    const uint64_t begin = sections[i].offset, used = sections[i].record_bytes * sections[i].record_count;
    const uint64_t end = i + 1 < header.section_count ? sections[i + 1].offset : header.file_bytes;
    if (fdcg_checksum(bytes + begin, end - begin) != sections[i].checksum) {
      return Message(error, FDCG_E_CHECKSUM, begin)
          .text("section ")
          .number(sections[i].id)
          .text(": the checksum does not match; the file is damaged, compile the mesh again");
    }
    for (uint64_t at = begin + used; at < end; ++at) {
      if (bytes[at] != 0)
        return Message(error, FDCG_E_LAYOUT, at).text("section ").number(sections[i].id).text(": padding is not zero");
    }
  }
  return FDCG_OK;
}

fdcg_status verify_graph(const fdcg_graph& graph, fdcg_error* error) {
  return with_real_of(*graph.header, [&](auto real) { return Verifier<decltype(real)>(graph, error).run(); });
}

}  // namespace fdcg
