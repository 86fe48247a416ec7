// SPDX-License-Identifier: Apache-2.0
// What FULL adds to SAFE: that the graph is one surface. The walk around a corner does most of it: it comes through each of
// its sides, and asks of each whether its twin, across the connection, names it, and starts at the same corner. Walks of
// different corners have no side in common; where together they are as long as there are sides, every side and every twin has
// been asked.
#include "base/config.hpp"
#include "base/message.hpp"
#include "graph/box_tree.hpp"
#include "graph/graph_view.hpp"
#include "graph/verify.hpp"

namespace fdcg {
namespace {

// Its passes are functions of their own: inlined into one, they would take longer for want of registers. They may follow any
// index: SAFE has found all of them in range. Nodes come before corners, in order: so the walks find most of theirs in the
// cache.
template <class Real>
class FullChunk {
 public:
  FullChunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error)
      : graph_(graph), header_(*graph.header), raw_(graph), chunk_(chunk), part_(part), error_(error) {
    are_triangles_ = header_.node_bytes != 0 && header_.side_count == header_.node_count * uint64_t{kSides};
  }

  fdcg_status run() {
    fdcg_status status = raw_.hierarchy != nullptr ? hierarchy() : FDCG_OK;
    if (status == FDCG_OK && !(are_triangles_ && are_sound_triangles())) status = nodes();
    return status == FDCG_OK ? corners() : status;
  }

 private:
  using Node = NodeRef<RigidGeometry<Real>>;
  static constexpr uint32_t kSides = 3;  // of a triangle

  template <class Look>
  fdcg_status for_mine(uint64_t things, const char* noun, Look look) {
    return for_all(chunk_.first_of(things), chunk_.end_of(things), noun, error_, look);
  }

  // A leaf's box, in tree units; without a hierarchy all of space. No rounding: a float of at most 24 bits and eight bits of
  // cells.
  struct LeafBox {
    double low[3], high[3];
  };
  LeafBox box_of(uint32_t leaf) const {
    LeafBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = -DBL_MAX, box.high[axis] = DBL_MAX;
      if (raw_.hierarchy == nullptr) continue;
      const fdcg_box8& boxes = raw_.hierarchy[first_leaf_record_ + leaf / FDCG_TREE_WAYS];
      box.low[axis] = low_of(boxes, axis, leaf % FDCG_TREE_WAYS);
      box.high[axis] = high_of(boxes, axis, leaf % FDCG_TREE_WAYS);
    }
    return box;
  }

  // Of each node: the leaf's box holds its corners. Of each connection, in the node that it runs along: two corners, the second
  // node after the first.
  [[gnu::noinline]] fdcg_status nodes() {
    uint32_t leaf = FDCG_NONE;
    LeafBox box = {};
    return for_mine(header_.node_count, "node", [&](uint32_t n, auto* faults) {
      if (n / FDCG_LEAF_NODES != leaf) box = box_of(leaf = n / FDCG_LEAF_NODES);
      const Node node = graph_.node(n);
      bool is_inside = true;
      for (uint32_t k = 0; k < node.side_count(); ++k) {
        const Vec3<double> p = widen(graph_.corner_point(node.corner(k))) * per_unit_;
        is_inside &= (box.low[0] <= p.x) & (p.x <= box.high[0]) & (box.low[1] <= p.y) & (p.y <= box.high[1]) &
                     (box.low[2] <= p.z) & (p.z <= box.high[2]);
        faults->note(node.corner(k) == node.corner(node.next(k)), "both corners of a side are one");
        const uint32_t across = node.across(k);
        faults->note((node.which(k) == 0) & (across <= n), "the second node of a connection does not come after its first");
        faults->note(across == FDCG_NONE && graph_.connections()[node.connection(k)].side[1] != 0, "side of a missing node");
      }
      faults->note(!is_inside, "sticks out of its box");
    });
  }

  // The same of triangles of one size, a leaf at a time. False: something is wrong, and nodes() is to say what.
  [[gnu::noinline]] bool are_sound_triangles() const {
    const uint64_t end = chunk_.end_of(header_.node_count);
    const size_t bytes = graph_.block_bytes();
    const uint64_t ahead =
        (end - chunk_.first_of(header_.node_count)) * bytes;  // to the next chunk, which memory sends meanwhile
    bool is_wrong = false;
    for (uint64_t n = chunk_.first_of(header_.node_count); n < end;) {
      const auto leaf = static_cast<uint32_t>(n / FDCG_LEAF_NODES);
      const uint64_t leaf_end = (uint64_t{leaf} + 1) * FDCG_LEAF_NODES, last = leaf_end < end ? leaf_end : end;
      Vec3<Real> low = graph_.corner_point(sides_of(n, bytes)[0].corner), high = low;
      for (; n < last; ++n) {
        const fdcg_side* const sides = sides_of(n, bytes);
        __builtin_prefetch(reinterpret_cast<const unsigned char*>(sides) + ahead, 0, 2);
        for (uint32_t k = 0; k < kSides; ++k) {
          const Vec3<Real> p = graph_.corner_point(sides[k].corner);
          low = {p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
          high = {p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
          is_wrong |= (sides[k].corner == sides[k + 1 < kSides ? k + 1 : 0].corner) |
                      (((sides[k].link & 1) == 0) & (sides[k].across <= n));
          if (sides[k].across == FDCG_NONE) is_wrong |= graph_.connections()[sides[k].link >> 1].side[1] != 0;
        }
      }
      const LeafBox box = box_of(leaf);
      const Vec3<double> l = widen(low) * per_unit_, h = widen(high) * per_unit_;
      is_wrong |= !((box.low[0] <= l.x) & (h.x <= box.high[0]) & (box.low[1] <= l.y) & (h.y <= box.high[1]) &
                    (box.low[2] <= l.z) & (h.z <= box.high[2]));
    }
    return !is_wrong;
  }
  const fdcg_side* sides_of(uint64_t n, size_t block_bytes) const {
    return reinterpret_cast<const typename Records<Real>::Node*>(graph_.nodes() + n * block_bytes)->sides;
  }

  // Around an ordinary corner, as the step will go.
  struct FanWalk {
    uint32_t corner, first_node, first_side;
    uint32_t node, side, faces;
    bool is_open, is_done, is_wrong;
  };
  static constexpr uint32_t kWalks = 8;  // at once, so that their cache misses overlap

  [[gnu::noinline]] fdcg_status corners() {
    const uint64_t end = chunk_.end_of(header_.corner_count);
    uint64_t v = chunk_.first_of(header_.corner_count);
    while (v < end) {
      FanWalk walks[kWalks];
      uint32_t count = 0;
      for (; v < end && count < kWalks; ++v) {
        const auto corner = graph_.corner(static_cast<uint32_t>(v));
        const char* what = nullptr;
        if (corner.is_busy()) {
          what = busy_fan(static_cast<uint32_t>(v));
        } else {
          what = start_walk(static_cast<uint32_t>(v), &walks[count++]);
        }
        if (what != nullptr) return refuse_record(error_, "corner", v, what);
      }
      if (are_triangles_) {
        walk_all<true>(walks, count);
      } else {
        walk_all<false>(walks, count);
      }
      for (uint32_t i = 0; i < count; ++i) {
        const auto corner = graph_.corner(walks[i].corner);
        const bool is_right = walks[i].is_done && !walks[i].is_wrong && walks[i].is_open == corner.is_open() &&
                              walks[i].faces + (walks[i].is_open ? 1u : 0u) == corner.walked_count();
        if (!is_right)
          return refuse_record(error_, "corner", walks[i].corner, "fan does not lead around it in as many steps as it says");
        part_->faces += walks[i].faces;
      }
    }
    return FDCG_OK;
  }

  const char* start_walk(uint32_t v, FanWalk* walk) const {
    const auto corner = graph_.corner(v);
    const uint32_t n = corner.first_node(), k = corner.first_side();
    if (graph_.node(n).corner(k) != v) return "fan does not start here";
    if (corner.is_open() != (graph_.node(n).across(k) == FDCG_NONE)) return "fan is open at the wrong place";
    *walk = {v, n, k, n, k, 1, false, false, false};
    return nullptr;
  }

  template <bool kAreTriangles>
  const fdcg_side* sides_of(uint32_t n) const {
    if constexpr (kAreTriangles) return sides_of(n, graph_.block_bytes());
    return &graph_.node(n).side(0);
  }
  // The side that comes in to where side k starts.
  template <bool kAreTriangles>
  uint32_t before(uint32_t n, uint32_t k) const {
    if constexpr (kAreTriangles) return 0x010002u >> (8 * k) & 0xFF;  // 2, 0, 1: a branch could not be predicted
    return graph_.node(n).previous(k);
  }

  // From side to side: back to the start, or to the border.
  template <bool kAreTriangles>
  [[gnu::noinline]] void walk_all(FanWalk* walks, uint32_t count) const {
    uint32_t walking = count;
    for (uint32_t step = 0; walking > 0 && step < FDCG_BUSY_FAN; ++step) {
      for (uint32_t i = 0; i < count; ++i) {
        FanWalk& walk = walks[i];
        if (walk.is_done) continue;
        const fdcg_side& incoming = sides_of<kAreTriangles>(walk.node)[before<kAreTriangles>(walk.node, walk.side)];
        const uint32_t from = walk.node;
        walk.node = incoming.across;
        walk.is_open = walk.node == FDCG_NONE;
        if (!walk.is_open) {
          const fdcg_side* const sides = sides_of<kAreTriangles>(walk.node);
          __builtin_prefetch(sides);
          walk.side = graph_.connections()[incoming.link >> 1].side[1 - (incoming.link & 1)];
          const fdcg_side& twin = sides[walk.side];
          walk.is_wrong |= (twin.link != (incoming.link ^ 1u)) | (twin.across != from) | (twin.corner != walk.corner);
        }
        walk.is_done = walk.is_open || walk.is_wrong || (walk.node == walk.first_node && walk.side == walk.first_side);
        walking -= walk.is_done ? 1u : 0u;
        walk.faces += walk.is_done ? 0u : 1u;
      }
    }
  }

  // Each entry starts at this corner; the node to its left comes in along the next entry, and the two are twins there.
  [[gnu::noinline]] const char* busy_fan(uint32_t v) {
    const bool is_open = graph_.corner(v).is_open();
    const fdcg_busy_corner& busy = graph_.corner(v).busy();
    part_->faces += busy.fan_count - (is_open ? 1u : 0u);
    for (uint32_t i = 0; i < busy.fan_count; ++i) {
      const bool is_last = i + 1 == busy.fan_count;
      const uint32_t entry = graph_.fans()[busy.first_fan + i], c = entry >> 1, end = entry & 1;
      const uint32_t next = graph_.fans()[busy.first_fan + (is_last ? 0 : i + 1)];
      const auto connection = graph_.connection(c);
      if (connection.corner(end) != v) return "fan does not start here";
      const uint32_t n = connection.node(end), across = connection.node(1 - end);
      if ((n == FDCG_NONE) != (is_open && is_last)) return "fan is open at the wrong place";
      if (i == 0 && is_open != (across == FDCG_NONE)) return "fan is open at the wrong place";
      if (n == FDCG_NONE) continue;
      const Node node = graph_.node(n);
      const uint32_t k = connection.side(end);
      if (node.side(k).link != entry || node.across(k) != across || node.corner(k) != v) return "its nodes disagree";
      const bool is_round_again = i > 0 && entry == graph_.fans()[busy.first_fan];
      if (is_round_again || node.connection(node.previous(k)) != next >> 1) return "fan is not in cyclic order";
    }
    return nullptr;
  }

  // One coordinate of a box, in tree units; no rounding: a float of at most 24 bits and eight bits of cells.
  static double low_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return double{boxes.origin[axis]} + double{tree_cell(boxes.exponent[axis])} * boxes.low[axis][j];
  }
  static double high_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return double{boxes.origin[axis]} + double{tree_cell(boxes.exponent[axis])} * boxes.high[axis][j];
  }

  // Every box holds those of the record below.
  [[gnu::noinline]] fdcg_status hierarchy() {
    const BoxTree tree(header_.node_count);
    return for_mine(tree.records, "box record", [&](uint32_t i, auto* faults) {
      int level = tree.levels - 1;
      while (level > 0 && i >= tree.first[level - 1])
        --level;
      if (level + 1 == tree.levels) return;
      const uint32_t at = i - tree.first[level];
      const fdcg_box8& above = raw_.hierarchy[tree.first[level + 1] + at / FDCG_TREE_WAYS];
      faults->note(!holds_boxes(above, at % FDCG_TREE_WAYS, raw_.hierarchy[i], tree.lanes(level, at)),
                   "sticks out of the box above");
    });
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

  const RigidView<Real> graph_;
  const fdcg_header& header_;
  const fdcg_graph& raw_;
  const Chunk chunk_;
  fdcg_verification* part_;
  fdcg_error* error_;
  const uint32_t first_leaf_record_ = BoxTree(header_.node_count).first[0];
  const double per_unit_ = 1 / tree_unit(header_.extent);
  bool are_triangles_;
};

}  // namespace

fdcg_status verify_full_chunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error) {
  return with_real_of(*graph.header, [&](auto real) { return FullChunk<decltype(real)>(graph, chunk, part, error).run(); });
}

fdcg_status verify_full_sums(const fdcg_graph& graph, const fdcg_verification& sum, fdcg_error* error) {
  if (sum.faces == graph.header->side_count) return FDCG_OK;
  return refuse_record(error, "header.side_count", graph.header->side_count, "not the sum of the corners' fans");
}

}  // namespace fdcg
