// SPDX-License-Identifier: Apache-2.0
#include "verify.hpp"

#include "box_tree.hpp"
#include "config.hpp"
#include "graph_view.hpp"
#include "implicit_tree.hpp"
#include "message.hpp"
#include "sections.hpp"

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

// An edge and its face's normal give a Voronoi plane where they are far enough from parallel: the compiler joins no face to
// an edge that leaves its plane by more than 45 degrees.
template <class Real>
bool is_across(Vec3<Real> along, Vec3<Real> normal) {
  constexpr Real kLeastSquaredSine = Real(1) / 64;
  const Vec3<Real> out = cross(along, normal);
  const Real squared = dot(along, along);
  return squared >= TinyEdge<Real>::kSquare && dot(out, out) >= kLeastSquaredSine * squared;
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
    fdcg_status status = blocks();
    if (status == FDCG_OK) status = nodes();
    if (status == FDCG_OK && graph_.edges != nullptr) status = edges();
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

  // The blocks follow one another and fill their section; so that from here on any node below the count can be read.
  fdcg_status blocks() {
    const fdcg_section& section = *find_section(header_, FDCG_SECTION_NODES);
    const uint64_t bytes = section.record_bytes * section.record_count;
    uint64_t at = 0, sides = 0;
    for (uint32_t n = 0; n < header_.node_count; ++n) {
      if (raw_.node_offsets != nullptr && raw_.node_offsets[n] * uint64_t{sizeof(Real)} != at)
        return refuse("node", n, "its block does not start where the one before it ends");
      if (bytes - at < sizeof(typename Records<Real>::Node)) return refuse("node", n, "its block is out of range");
      const uint32_t count = graph_.node(n).side_count();
      if (count < 3 || count > FDCG_MAX_SIDES) return refuse("node", n, "has too few sides or too many");
      const uint32_t size = node_bytes<Real>(count, graph_.has_planes);
      if (size > bytes - at || (header_.node_bytes != 0 && size != header_.node_bytes))
        return refuse("node", n, "its block is out of range");
      at += size;
      sides += count;
    }
    if (at != bytes) return refuse("header.node_count", header_.node_count, "not the number of blocks");
    return sides == header_.side_count ? FDCG_OK : refuse("header.side_count", header_.side_count, "not the sum of the nodes'");
  }

  // Each side and its twin name each other and the same two corners. It is enough to ask the connections' first sides: where
  // these are as many as connections and the others as many as there are twins, no side and no connection is left over.
  fdcg_status nodes() {
    uint32_t types[4] = {};
    uint64_t first_sides = 0;
    for (uint32_t n = 0; n < header_.node_count; ++n) {
      const NodeRef<Real> node = graph_.node(n);
      const uint32_t count = node.side_count();
      if ((node.flags() & ~FDCG_NODE_INEXACT) != 0) return refuse("node", n, "unknown flags");
      if (!is_unit(node.normal())) return refuse("node", n, "normal is not of unit length");
      if (!(absolute(node.plane().offset) <= 4 * header_.extent)) return refuse("node", n, "plane lies outside the object");
      for (uint32_t k = 0; k < count; ++k) {
        if (node.connection(k) >= header_.connection_count) return refuse("node", n, "connection out of range");
        if (node.corner(k) >= header_.corner_count) return refuse("node", n, "corner out of range");
        if (node.across(k) >= header_.node_count && node.across(k) != FDCG_NONE)
          return refuse("node", n, "neighbour out of range");
        if (node.which(k) == 0) {
          if (const char* what = first_side(n, node, k)) return refuse("connection", node.connection(k), what);
          ++types[graph_.connections[node.connection(k)].type];
          ++first_sides;
        }
      }
      if (const char* what = voronoi_planes(node)) return refuse("node", n, what);
    }
    const uint64_t twins = first_sides - types[FDCG_BOUNDARY];
    if (first_sides != header_.connection_count || first_sides + twins != header_.side_count)
      return refuse("header.connection_count", header_.connection_count, "not the number of pairs of sides");
    for (uint32_t type = 0; type < 4; ++type) {
      if (types[type] != header_.connection_type_count[type]) return refuse("header.connection_type_count", type, "wrong");
    }
    return FDCG_OK;
  }

  // What is wrong with side k, along which its connection runs, and with its twin; null: nothing.
  const char* first_side(uint32_t n, NodeRef<Real> node, uint32_t k) const {
    const fdcg_connection& connection = graph_.connections[node.connection(k)];
    if (connection.node != n || connection.side[0] != k) return "its node does not own it";
    if (connection.type > FDCG_BOUNDARY || connection.flatness > FDCG_FLAT_ANGLE) return "unknown type or flatness";
    const uint32_t start = node.corner(k), end = node.corner(node.next(k));
    if (start == end) return "both its corners are one";
    const bool is_open = node.across(k) == FDCG_NONE;
    if (is_open != (connection.type == FDCG_BOUNDARY)) return "type does not fit its nodes";
    if (is_open) return connection.side[1] == 0 ? nullptr : "side of a missing node";
    const NodeRef<Real> other = graph_.node(node.across(k));
    const uint32_t j = connection.side[1];
    if (j >= other.side_count() || other.side(j).link != (node.side(k).link | 1u) || other.across(j) != n)
      return "its second node does not own it";
    return other.corner(j) == end && other.corner(other.next(j)) == start ? nullptr : "its nodes disagree about its corners";
  }

  // Stored, or as the step will derive them. Corners must be in range, and those of damaged files may be anything.
  const char* voronoi_planes(NodeRef<Real> node) const {
    constexpr const char* kWrong = "Voronoi plane out of range";
    const Vec3<Real> normal = node.normal();
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (graph_.has_planes) {
        const Plane<Real> plane = node.voronoi_plane(k);
        if (!is_unit(plane.normal) || !(absolute(plane.offset) <= 4 * header_.extent)) return kWrong;
      } else if (graph_.edges != nullptr) {
        if (!is_across(vec(graph_.edges[node.connection(k)].direction), normal)) return kWrong;
      } else {
        Vec3<Real> along = graph_.corner_point(node.corner(node.next(k))) - graph_.corner_point(node.corner(k));
        if (dot(along, along) < TinyEdge<Real>::kSquare) along = along * TinyEdge<Real>::kScale;
        if (!is_across(along, normal)) return kWrong;
      }
    }
    return nullptr;
  }

  fdcg_status edges() {
    for (uint32_t c = 0; c < header_.connection_count; ++c) {
      const auto& edge = graph_.edges[c];
      if (!is_unit(vec(edge.direction))) return refuse("edge", c, "direction is not of unit length");
      if (!(edge.length > 0 && edge.length <= 4 * header_.extent))
        return refuse("edge", c, "is longer than the object, or not at all");
    }
    return FDCG_OK;
  }

  fdcg_status corners() {
    uint64_t sides = 0;
    busy_seen_ = 0, fan_seen_ = 0, boxes_seen_ = 0;
    for (uint32_t v = 0; v < header_.corner_count; ++v) {
      const auto& corner = graph_.corners[v];
      for (int k = 0; k < 3; ++k) {
        const double x = corner.point[k];
        if (!(absolute(x) <= header_.extent) || x < header_.bounds_min[k] || x > header_.bounds_max[k])
          return refuse("corner", v, "outside the bounds");
      }
      const bool is_busy = graph_.corner(v).is_busy();
      uint32_t faces = 0;
      if (const char* what = is_busy ? busy_fan(v, &faces) : walked_fan(v, &faces)) return refuse("corner", v, what);
      sides += faces;
    }
    if (sides != header_.side_count) return refuse("header.side_count", header_.side_count, "not the sum of the corners' fans");
    if (busy_seen_ != header_.busy_count)
      return refuse("header.busy_count", header_.busy_count, "not the number of busy corners");
    if (fan_seen_ != header_.fan_count) return refuse("header.fan_count", header_.fan_count, "not the sum of the corners'");
    return trees();
  }

  // From side to side around the corner, as the step will: back to the start, or from border to border.
  const char* walked_fan(uint32_t v, uint32_t* faces) const {
    const CornerRef<Real> corner = graph_.corner(v);
    const uint32_t count = corner.walked_count(), first_node = corner.first_node(), first_side = corner.first_side();
    if (count < 2 || count > FDCG_BUSY_FAN || count > header_.largest_fan) return "fan out of range";
    if (first_node >= header_.node_count || first_side >= graph_.node(first_node).side_count() ||
        graph_.node(first_node).corner(first_side) != v)
      return "fan does not start here";
    if (corner.is_open() != (graph_.node(first_node).across(first_side) == FDCG_NONE)) return "fan is open at the wrong place";
    uint32_t n = first_node, k = first_side;
    for (*faces = 1;; ++*faces) {
      const NodeRef<Real> node = graph_.node(n);
      const uint32_t incoming = node.previous(k);
      n = node.across(incoming);
      if (n == FDCG_NONE) break;
      k = graph_.connections[node.connection(incoming)].side[1 - node.which(incoming)];
      if (n == first_node && k == first_side) break;
      if (*faces == count) return "fan is longer than it says";
    }
    if ((n == FDCG_NONE) != corner.is_open()) return "fan is open at the wrong place";
    return *faces + (corner.is_open() ? 1u : 0u) == count ? nullptr : "fan is shorter than it says";
  }

  // Each entry starts at this corner; the node to its left comes in along the next entry.
  const char* busy_fan(uint32_t v, uint32_t* faces) {
    const auto& record = graph_.corners[v];
    const bool is_open = (record.fan & FDCG_CORNER_OPEN) != 0;
    if (record.first != busy_seen_ || busy_seen_ >= header_.busy_count || record.side != 0)
      return "no busy corner of this number";
    const fdcg_busy_corner& busy = graph_.busy_corners[busy_seen_++];
    if (busy.corner != v || busy.first_fan != fan_seen_ || busy.fan_count <= FDCG_BUSY_FAN ||
        busy.fan_count > header_.fan_count - fan_seen_ || busy.fan_count > header_.largest_fan)
      return "fan out of range";
    fan_seen_ += busy.fan_count;
    const uint64_t boxes = ImplicitTree(busy.fan_count, FDCG_LEAF_FAN).boxes;
    if (busy.first_box != boxes_seen_ || boxes > header_.fan_box_count - boxes_seen_)
      return "busy, but it has no tree in range";
    boxes_seen_ += boxes;
    *faces = busy.fan_count - (is_open ? 1u : 0u);
    for (uint32_t i = 0; i < busy.fan_count; ++i) {
      const bool is_last = i + 1 == busy.fan_count;
      const uint32_t entry = graph_.fans[busy.first_fan + i], c = entry >> 1, end = entry & 1;
      const uint32_t next = graph_.fans[busy.first_fan + (is_last ? 0 : i + 1)];
      if (c >= header_.connection_count || graph_.connection(c).corner(end) != v) return "fan does not start here";
      const uint32_t n = graph_.connection(c).node(end);
      if ((n == FDCG_NONE) != (is_open && is_last)) return "fan is open at the wrong place";
      if (i == 0 && is_open != (graph_.connection(c).node(1 - end) == FDCG_NONE)) return "fan is open at the wrong place";
      if (n == FDCG_NONE) continue;
      const NodeRef<Real> node = graph_.node(n);
      if (node.connection(node.previous(graph_.connection(c).side(end))) != next >> 1) return "fan is not in cyclic order";
    }
    return nullptr;
  }

  fdcg_status trees() {
    if (boxes_seen_ != header_.fan_box_count)
      return refuse("header.fan_box_count", header_.fan_box_count, "not the sum of the corners'");
    for (uint32_t i = 0; i < header_.fan_box_count; ++i) {
      const auto& box = graph_.fan_boxes[i];
      bool is_in_range = norm1(vec(box.centre)) <= 4;
      for (const auto& axis : box.axis)
        is_in_range = is_in_range && norm1(vec(axis)) <= 8;
      if (!is_in_range) return refuse("fan box", i, "out of range");
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
  uint64_t busy_seen_ = 0, fan_seen_ = 0, boxes_seen_ = 0;  // by the corners so far
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
