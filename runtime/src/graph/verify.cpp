// SPDX-License-Identifier: Apache-2.0
#include "graph/verify.hpp"

#include "base/config.hpp"
#include "base/message.hpp"
#include "graph/box_tree.hpp"
#include "graph/fan_run_section.hpp"
#include "graph/graph_view.hpp"
#include "graph/implicit_tree.hpp"
#include "graph/sections.hpp"

namespace fdcg {
namespace {

// How far a stored unit vector's squared length may lie from 1.
template <class Real>
constexpr double kStoredUnitTolerance = sizeof(Real) == 8 ? 1e-9 : 1e-4;

template <class Real>
bool is_unit(Vec3<Real> v) {
  const Vec3<double> w = widen(v);
  const double off = dot(w, w) - 1;
  return off <= kStoredUnitTolerance<Real> && off >= -kStoredUnitTolerance<Real>;  // false for NaN too
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

// Its passes are functions of their own: inlined into one, they take a third longer, since registers run out.
template <class Real>
class Verifier {
 public:
  Verifier(const fdcg_graph& graph, fdcg_error* error) : graph_(graph), header_(*graph.header), raw_(graph), error_(error) {}

  fdcg_status run() {
    fdcg_status status = raw_.hierarchy != nullptr ? hierarchy() : FDCG_OK;
    if (status == FDCG_OK) status = nodes();
    if (status == FDCG_OK && graph_.edges != nullptr) status = edges();
    if (status == FDCG_OK) status = corners();
    if (status == FDCG_OK && raw_.source_map != nullptr) status = source_map();
    return status;
  }

 private:
  using Node = NodeRef<RigidGeometry<Real>>;

  fdcg_status refuse(const char* noun, uint64_t index, const char* what) {
    return Message(error_, FDCG_E_GRAPH).say(noun, " ", index, ": ", what, "; compile the mesh again");
  }

  // Blocks follow one another and fill their section. Each side and its twin name each other and the same two corners: asked of
  // the later of the two, when the earlier node has just been read and found sound. Where first sides are as many as
  // connections, and second ones as many as connections with two nodes, no side and no connection is left over.
  [[gnu::noinline]] fdcg_status nodes() {
    const fdcg_section& section = *find_section(header_, FDCG_SECTION_NODES);
    const uint64_t bytes = section.record_bytes * section.record_count;
    uint32_t types[4] = {};
    uint64_t at = 0, first_sides = 0, sides = 0;
    const uint32_t first_leaf_record = BoxTree(header_.node_count).first[0];
    const double per_unit = 1 / tree_unit(header_.extent);
    for (uint32_t n = 0; n < header_.node_count; ++n) {
      if (const char* what = block(n, &at, bytes)) return refuse("node", n, what);
      const Node node = graph_.node(n);
      const uint32_t count = node.side_count();
      sides += count;
      if ((node.flags() & ~FDCG_NODE_INEXACT) != 0) return refuse("node", n, "unknown flags");
      if (!is_unit(node.normal())) return refuse("node", n, "normal is not of unit length");
      if (!(absolute(node.plane().offset) <= 4 * header_.extent)) return refuse("node", n, "plane lies outside the object");
      for (uint32_t k = 0; k < count; ++k) {
        const fdcg_side& side = node.side(k);
        if (side.link >> 1 >= header_.connection_count) return refuse("node", n, "connection out of range");
        if (side.corner >= header_.corner_count) return refuse("node", n, "corner out of range");
        if (side.across >= header_.node_count && side.across != FDCG_NONE) return refuse("node", n, "neighbour out of range");
        const bool is_first = (side.link & 1) == 0;
        if (const char* what = is_first ? first_side(n, node, k) : second_side(n, node, k))
          return refuse("connection", side.link >> 1, what);
        types[graph_.connections[side.link >> 1].type] += is_first ? 1u : 0u;
        first_sides += is_first ? 1u : 0u;
      }
      if (const char* what = voronoi_planes(node)) return refuse("node", n, what);
      if (raw_.hierarchy != nullptr && !is_in_its_box(n, node, first_leaf_record, per_unit))
        return refuse("node", n, "sticks out of its box");
    }
    if (at != bytes) return refuse("header.node_count", header_.node_count, "not the number of blocks");
    if (sides != header_.side_count) return refuse("header.side_count", header_.side_count, "not the sum of the nodes'");
    if (first_sides != header_.connection_count || 2 * first_sides - types[FDCG_BOUNDARY] != sides)
      return refuse("header.connection_count", header_.connection_count, "not the number of pairs of sides");
    for (uint32_t type = 0; type < 4; ++type) {
      if (types[type] != header_.connection_type_count[type]) return refuse("header.connection_type_count", type, "wrong");
    }
    return FDCG_OK;
  }

  // Node n's block starts where the one before it ended, and does not reach beyond the section; null: so it is.
  [[gnu::noinline]] const char* block(uint32_t n, uint64_t* at, uint64_t bytes) const {
    if (raw_.node_offsets != nullptr && raw_.node_offsets[n] * uint64_t{sizeof(Real)} != *at)
      return "its block does not start where the one before it ends";
    if (bytes - *at < sizeof(typename Records<Real>::Node)) return "its block is out of range";
    const uint32_t count = graph_.node(n).side_count();
    if (count < 3 || count > FDCG_MAX_SIDES) return "has too few sides or too many";
    const uint32_t size = node_bytes<Real>(count, graph_.has_planes);
    if (size > bytes - *at || (header_.node_bytes != 0 && size != header_.node_bytes)) return "its block is out of range";
    *at += size;
    return nullptr;
  }

  // What is wrong with side k, along which its connection runs; null: nothing.
  [[gnu::noinline]] const char* first_side(uint32_t n, Node node, uint32_t k) const {
    const fdcg_connection& connection = graph_.connections[node.connection(k)];
    if (connection.node != n || connection.side[0] != k) return "its node does not own it";
    if (connection.type > FDCG_BOUNDARY || connection.flatness > FDCG_FLAT_ANGLE) return "unknown type or flatness";
    if (node.corner(k) == node.corner(node.next(k))) return "both its corners are one";
    const bool is_open = node.across(k) == FDCG_NONE;
    if (is_open != (connection.type == FDCG_BOUNDARY)) return "type does not fit its nodes";
    return is_open && connection.side[1] != 0 ? "side of a missing node" : nullptr;
  }

  // What is wrong with side k, against which its connection runs, beside that connection's first side. Connections come by
  // first use, so the first side's node stands before this one.
  [[gnu::noinline]] const char* second_side(uint32_t n, Node node, uint32_t k) const {
    const fdcg_connection& connection = graph_.connections[node.connection(k)];
    if (connection.node >= n || connection.node != node.across(k) || connection.side[1] != k)
      return "its second node does not own it";
    const Node other = graph_.node(connection.node);
    const uint32_t j = connection.side[0];
    if (j >= other.side_count() || other.side(j).link != (node.side(k).link ^ 1u) || other.across(j) != n)
      return "its second node does not own it";
    const bool agree = other.corner(j) == node.corner(node.next(k)) && other.corner(other.next(j)) == node.corner(k);
    return agree ? nullptr : "its nodes disagree about its corners";
  }

  // Stored, or as the step will derive them. Corners must be in range, and those of damaged files may be anything.
  [[gnu::noinline]] const char* voronoi_planes(Node node) const {
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

  [[gnu::noinline]] fdcg_status edges() {
    for (uint32_t c = 0; c < header_.connection_count; ++c) {
      const auto& edge = graph_.edges[c];
      if (!is_unit(vec(edge.direction))) return refuse("edge", c, "direction is not of unit length");
      if (!(edge.length > 0 && edge.length <= 4 * header_.extent))
        return refuse("edge", c, "is longer than the object, or not at all");
    }
    return FDCG_OK;
  }

  [[gnu::noinline]] fdcg_status corners() {
    uint64_t sides = 0;
    for (uint32_t begin = 0; begin < header_.corner_count; begin += kWalks) {
      FanWalk walks[kWalks];
      uint32_t count = 0;
      for (uint32_t v = begin; v < header_.corner_count && v < begin + kWalks; ++v) {
        const auto& corner = graph_.corners[v];
        for (int k = 0; k < 3; ++k) {
          const double x = corner.point[k];
          if (!(absolute(x) <= header_.extent) || x < header_.bounds_min[k] || x > header_.bounds_max[k])
            return refuse("corner", v, "outside the bounds");
        }
        uint32_t faces = 0;
        const bool is_busy = graph_.corner(v).is_busy();
        if (const char* what = is_busy ? busy_fan(v, &faces) : start_walk(v, &walks[count])) return refuse("corner", v, what);
        sides += faces;
        count += is_busy ? 0u : 1u;
      }
      walk_all(walks, count);
      for (uint32_t i = 0; i < count; ++i) {
        const auto corner = graph_.corner(walks[i].corner);
        const bool is_right = walks[i].is_done && walks[i].is_open == corner.is_open() &&
                              walks[i].faces + (walks[i].is_open ? 1u : 0u) == corner.walked_count();
        if (!is_right) return refuse("corner", walks[i].corner, "fan does not lead around it in as many steps as it says");
        sides += walks[i].faces;
      }
    }
    if (sides != header_.side_count) return refuse("header.side_count", header_.side_count, "not the sum of the corners' fans");
    if (busy_seen_ != header_.busy_count)
      return refuse("header.busy_count", header_.busy_count, "not the number of busy corners");
    if (fan_seen_ != header_.fan_count) return refuse("header.fan_count", header_.fan_count, "not the sum of the corners'");
    return trees();
  }

  // Around an ordinary corner, as the step will go.
  struct FanWalk {
    uint32_t corner, first_node, first_side;
    uint32_t node, side, faces;
    bool is_open, is_done;
  };
  static constexpr uint32_t kWalks = 8;  // at once, so that their cache misses overlap

  [[gnu::noinline]] const char* start_walk(uint32_t v, FanWalk* walk) const {
    const auto corner = graph_.corner(v);
    const uint32_t count = corner.walked_count(), n = corner.first_node(), k = corner.first_side();
    if (count < 2 || count > FDCG_BUSY_FAN || count > header_.largest_fan) return "fan out of range";
    if (n >= header_.node_count || k >= graph_.node(n).side_count() || graph_.node(n).corner(k) != v)
      return "fan does not start here";
    if (corner.is_open() != (graph_.node(n).across(k) == FDCG_NONE)) return "fan is open at the wrong place";
    *walk = {v, n, k, n, k, 1, false, false};
    return nullptr;
  }

  // From side to side: back to the start, or to the border.
  [[gnu::noinline]] void walk_all(FanWalk* walks, uint32_t count) const {
    uint32_t walking = count;
    for (uint32_t step = 0; walking > 0 && step < FDCG_BUSY_FAN; ++step) {
      for (uint32_t i = 0; i < count; ++i) {
        FanWalk& walk = walks[i];
        if (walk.is_done) continue;
        const Node node = graph_.node(walk.node);
        const uint32_t incoming = node.previous(walk.side);
        walk.node = node.across(incoming);
        walk.is_open = walk.node == FDCG_NONE;
        if (!walk.is_open) walk.side = graph_.connections[node.connection(incoming)].side[1 - node.which(incoming)];
        walk.is_done = walk.is_open || (walk.node == walk.first_node && walk.side == walk.first_side);
        walking -= walk.is_done ? 1u : 0u;
        walk.faces += walk.is_done ? 0u : 1u;
      }
    }
  }

  // Each entry starts at this corner; the node to its left comes in along the next entry.
  [[gnu::noinline]] const char* busy_fan(uint32_t v, uint32_t* faces) {
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
      const Node node = graph_.node(n);
      if (node.connection(node.previous(graph_.connection(c).side(end))) != next >> 1) return "fan is not in cyclic order";
    }
    return nullptr;
  }

  [[gnu::noinline]] fdcg_status trees() {
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

  // Records in range, every box holds those of the record below. The pass over the nodes looks at the leaves.
  [[gnu::noinline]] fdcg_status hierarchy() {
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

  // Whether the leaf's box holds the node's corners.
  bool is_in_its_box(uint32_t n, Node node, uint32_t first_leaf_record, double per_unit) const {
    const uint32_t leaf = n / FDCG_LEAF_NODES, lane = leaf % FDCG_TREE_WAYS;
    const fdcg_box8& boxes = raw_.hierarchy[first_leaf_record + leaf / FDCG_TREE_WAYS];
    double low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = low_of(boxes, axis, lane);
      high[axis] = high_of(boxes, axis, lane);
    }
    bool is_inside = true;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      const Vec3<double> p = widen(graph_.corner_point(node.corner(k))) * per_unit;
      is_inside =
          is_inside && low[0] <= p.x && p.x <= high[0] && low[1] <= p.y && p.y <= high[1] && low[2] <= p.z && p.z <= high[2];
    }
    return is_inside;
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

  [[gnu::noinline]] fdcg_status source_map() {
    for (uint32_t f = 0; f < header_.source_face_count; ++f) {
      if (raw_.source_map[f] >= header_.node_count && raw_.source_map[f] != FDCG_NONE)
        return refuse("source face", f, "node out of range");
    }
    return FDCG_OK;
  }

  const RigidView<Real> graph_;
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
          .say("section ", sections[i].id, ": the checksum does not match; the file is damaged, compile the mesh again");
    }
    for (uint64_t at = begin + used; at < end; ++at) {
      if (bytes[at] != 0) return Message(error, FDCG_E_LAYOUT, at).say("section ", sections[i].id, ": padding is not zero");
    }
  }
  return FDCG_OK;
}

fdcg_status verify_graph(const fdcg_graph& graph, fdcg_error* error) {
  const fdcg_status status =
      with_real_of(*graph.header, [&](auto real) { return Verifier<decltype(real)>(graph, error).run(); });
  return status == FDCG_OK ? verify_fan_runs(graph, error) : status;
}

}  // namespace fdcg
