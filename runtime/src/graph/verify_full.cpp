// SPDX-License-Identifier: Apache-2.0
// What FULL adds to SAFE: that the graph is one surface. The walk around a corner does most of it: it comes through each of
// its sides, and asks of each whether its twin, across the connection, names it, and starts at the same corner. Walks of
// different corners have no side in common; where together they are as long as there are sides, every side and every twin has
// been asked.
#include "base/config.hpp"
#include "base/message.hpp"
#include "graph/box_tree.hpp"
#include "graph/graph_view.hpp"
#include "graph/point_bounds.hpp"
#include "graph/triangle_fan.hpp"
#include "graph/verify.hpp"

namespace fdcg {
namespace {

// Its passes are functions of their own: inlined into one, they would take longer for want of registers. They may follow any
// index: SAFE has found all of them in range; but those of a surface of triangles only its own chunk's, and ask others where
// they lead. Nodes come before corners, in order: so the walks find most of theirs in the cache.
template <class Real>
class FullChunk {
 public:
  FullChunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error)
      : graph_(graph), header_(*graph.header), raw_(graph), chunk_(chunk), part_(part), error_(error) {
    are_triangles_ = header_.node_bytes != 0 && header_.side_count == header_.node_count * uint64_t{kSides};
  }

  fdcg_status run() {
    fdcg_status status = hierarchy();
    if (status == FDCG_OK && !(are_triangles_ && are_sound_triangles())) status = nodes();
    if (status == FDCG_OK && !(kWalksByTwo && are_triangles_ && are_sound_fans())) status = corners();
    return status == FDCG_OK ? busy_corners() : status;
  }

  // All of it but busy corners, where only this chunk is known to be SAFE. False: something is wrong, or cannot be told.
  bool is_sound_alone() {
    return kWalksByTwo && are_triangles_ && hierarchy() == FDCG_OK && are_sound_triangles() && are_sound_fans();
  }

  [[gnu::noinline]] fdcg_status busy_corners() {
    const uint64_t end = chunk_.end_of(header_.busy_count);
    for (uint64_t i = chunk_.first_of(header_.busy_count); i < end; ++i) {
      const uint32_t v = raw_.busy_corners[i].corner;
      if (const char* const what = busy_fan(v); what != nullptr) return refuse_record(error_, "corner", v, what);
    }
    return FDCG_OK;
  }

 private:
  using Node = NodeRef<RigidGeometry<Real>>;
  static constexpr uint32_t kSides = 3;                  // of a triangle
  static constexpr bool kWalksByTwo = FDCG_HAS_VECTORS;  // small processors wait little, and have little room

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
    for (uint64_t n = chunk_.first_of(header_.node_count); n < end;) {
      const auto leaf = static_cast<uint32_t>(n / FDCG_LEAF_NODES);
      const uint64_t leaf_end = (uint64_t{leaf} + 1) * FDCG_LEAF_NODES, last = leaf_end < end ? leaf_end : end;
      PointBounds<Real> bounds(point_of(sides_of(n)[0].corner));
      for (; n < last; ++n) {
        const fdcg_side* const sides = sides_of(n);
        const unsigned char* const next = reinterpret_cast<const unsigned char*>(sides) + ahead;
        __builtin_prefetch(next, 0, 2);
        __builtin_prefetch(next + kSides * sizeof(fdcg_side), 0, 2);
        const uint32_t least_across[2] = {static_cast<uint32_t>(n) + 1, 0};  // by which of its connection's sides it is
#pragma GCC unroll 3
        for (uint32_t k = 0; k < kSides; ++k) {
          const fdcg_side& side = sides[k];
          bounds.add(point_of(side.corner));
          if (side.corner == sides[k + 1 < kSides ? k + 1 : 0].corner || side.across < least_across[side.link & 1])
            return false;
          if (side.across == FDCG_NONE && graph_.connections()[side.link >> 1].side[1] != 0) return false;
        }
      }
      if (raw_.hierarchy != nullptr && !holds(leaf, bounds)) return false;
    }
    return true;
  }
  [[nodiscard]] const Real* point_of(uint32_t corner) const {
    return graph_.corners()[corner].point;
  }
  [[nodiscard]] bool holds(uint32_t leaf, const PointBounds<Real>& bounds) const {
    const fdcg_box8& boxes = raw_.hierarchy[first_leaf_record_ + leaf / FDCG_TREE_WAYS];
    bool is_inside = true;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      is_inside &= low_of(boxes, axis, leaf % FDCG_TREE_WAYS) <= double{bounds.low(axis)} * per_unit_;
      is_inside &= double{bounds.high(axis)} * per_unit_ <= high_of(boxes, axis, leaf % FDCG_TREE_WAYS);
    }
    return is_inside;
  }
  // Of triangles of one size.
  [[nodiscard]] const fdcg_side* sides_of(uint64_t n) const {
    return reinterpret_cast<const typename Records<Real>::Node*>(graph_.nodes() + n * graph_.block_bytes())->sides;
  }

  // Around an ordinary corner, as the step will go.
  struct FanWalk {
    uint32_t corner, node, faces;
    bool is_open, is_wrong;
    const fdcg_side* first;     // starts at the corner, in the first node
    const fdcg_side* incoming;  // ends there, in the node; null: the walk is over
  };
  static constexpr uint32_t kWalks = 8;  // at once, so that their cache misses overlap

  [[gnu::noinline]] fdcg_status corners() {
    const uint64_t end = chunk_.end_of(header_.corner_count);
    for (uint64_t v = chunk_.first_of(header_.corner_count); v < end;) {
      FanWalk walks[kWalks];
      uint32_t count = 0;
      for (; v < end && count < kWalks; ++v) {
        const auto corner = static_cast<uint32_t>(v);
        if (graph_.corner(corner).is_busy()) continue;
        const char* const what = start_walk(corner, &walks[count++]);
        if (what != nullptr) return refuse_record(error_, "corner", v, what);
      }
      walk_all(walks, count);
      for (uint32_t i = 0; i < count; ++i) {
        const FanWalk& walk = walks[i];
        const auto corner = graph_.corner(walk.corner);
        const bool is_right = walk.incoming == nullptr && !walk.is_wrong && walk.is_open == corner.is_open() &&
                              walk.faces + (walk.is_open ? 1u : 0u) == corner.walked_count();
        if (!is_right)
          return refuse_record(error_, "corner", walk.corner, "fan does not lead around it in as many steps as it says");
        part_->faces += walk.faces;
      }
    }
    return FDCG_OK;
  }

  const char* start_walk(uint32_t v, FanWalk* walk) const {
    const auto corner = graph_.corner(v);
    const uint32_t n = corner.first_node(), k = corner.first_side();
    const Node node = graph_.node(n);
    if (node.corner(k) != v) return "fan does not start here";
    if (corner.is_open() != (node.across(k) == FDCG_NONE)) return "fan is open at the wrong place";
    *walk = {v, n, 0, false, false, &node.side(k), &node.side(node.previous(k))};
    return nullptr;
  }

  // From side to side: back to the start, or to the border.
  void walk_all(FanWalk* walks, uint32_t count) const {
    uint32_t walking = count;
    for (uint32_t step = 1; walking > 0 && step <= FDCG_BUSY_FAN; ++step) {
      for (uint32_t i = 0; i < count; ++i) {
        FanWalk& walk = walks[i];
        if (walk.incoming == nullptr) continue;
        const fdcg_side incoming = *walk.incoming;
        walk.is_open = incoming.across == FDCG_NONE;
        if (!walk.is_open) {
          const uint32_t link = incoming.link ^ 1;
          const Node node = graph_.node(incoming.across);
          const uint32_t k = graph_.connections()[link >> 1].side[link & 1];
          const fdcg_side& twin = node.side(k);
          walk.is_wrong = twin.link != link || twin.across != walk.node || twin.corner != walk.corner;
          if (!walk.is_wrong && &twin != walk.first) {
            walk.node = incoming.across;
            walk.incoming = &node.side(node.previous(k));
            continue;
          }
        }
        walk.incoming = nullptr;
        walk.faces = step;
        --walking;
      }
    }
  }

  // The same of triangles of one size. False: something is wrong, and corners() is to say what.
  [[gnu::noinline]] bool are_sound_fans() {
    const uint64_t end = chunk_.end_of(header_.corner_count);
    const TriangleSides triangles{graph_.nodes() + offsetof(typename Records<Real>::Node, sides), graph_.block_bytes(),
                                  header_.node_count};
    TriangleFan fans[kFans];
    uint64_t faces = 0;
    uint32_t count = 0;
    for (uint64_t i = chunk_.first_of(header_.corner_count); i < end; ++i) {
      const auto v = static_cast<uint32_t>(i);
      if (__builtin_expect(graph_.corner(v).is_busy(), false)) continue;
      if (!start_fan(v, triangles, &fans[count])) return false;
      faces += fans[count].between + 1;
      if (++count < kFans) continue;
      if (!are_sound_together(fans, triangles)) return false;
      count = 0;
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (!is_sound_fan(fans[i], 0, triangles)) return false;
    }
    part_->faces += faces;
    return true;
  }

  bool start_fan(uint32_t v, TriangleSides triangles, TriangleFan* fan) const {
    const auto corner = graph_.corner(v);
    const uint32_t k = corner.first_side(), n = corner.first_node();
    const fdcg_side* const first = triangles.of(n) + k;
    *fan = {first, first + (k == 0 ? 2 : -1), v, n, corner.walked_count() - (corner.is_open() ? 2u : 1u), corner.is_open()};
    return first->corner == v && corner.is_open() == (first->across == FDCG_NONE);
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
  static double coordinate(const fdcg_box8& boxes, int axis, uint32_t cells) {
    return double{boxes.origin[axis]} + double{tree_cell(boxes.exponent[axis])} * cells;
  }
  static double low_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return coordinate(boxes, axis, boxes.low[axis][j]);
  }
  static double high_of(const fdcg_box8& boxes, int axis, uint32_t j) {
    return coordinate(boxes, axis, boxes.high[axis][j]);
  }

  // Every box holds those of the record below.
  [[gnu::noinline]] fdcg_status hierarchy() {
    if (raw_.hierarchy == nullptr) return FDCG_OK;
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
      uint32_t least = UINT8_MAX, most = 0;  // of those below: a cell's length is not negative
      for (uint32_t i = 0; lanes >> i != 0; ++i) {
        const uint32_t low = below.low[axis][i], high = below.high[axis][i];
        least = low < least ? low : least;
        most = high > most ? high : most;
      }
      if (!(low_of(above, axis, j) <= coordinate(below, axis, least))) return false;
      if (!(coordinate(below, axis, most) <= high_of(above, axis, j))) return false;
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

bool is_full_alone(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part) {
  return with_real_of(*graph.header,
                      [&](auto real) { return FullChunk<decltype(real)>(graph, chunk, part, nullptr).is_sound_alone(); });
}

fdcg_status verify_busy_corners(const fdcg_graph& graph, fdcg_verification* all, fdcg_error* error) {
  return with_real_of(*graph.header, [&](auto real) {
    return FullChunk<decltype(real)>(graph, {0, 1}, all, error).busy_corners();
  });
}

fdcg_status verify_full_sums(const fdcg_graph& graph, const fdcg_verification& sum, fdcg_error* error) {
  if (sum.faces == graph.header->side_count) return FDCG_OK;
  return refuse_record(error, "header.side_count", graph.header->side_count, "not the sum of the corners' fans");
}

}  // namespace fdcg
