// SPDX-License-Identifier: Apache-2.0
// Step 1 of merging (merge.hpp): removes vertices inside planar regions and on straight borders between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/lazy_array.hpp"
#include "exact/polygon_cut.hpp"
#include "exact/projection.hpp"
#include "graph/classify.hpp"
#include "graph/merge.hpp"

namespace fdcg::bake {

struct NoneYet {
  std::uint32_t operator()(std::uint32_t) const { return kNone; }
};

// Edits a triangle mesh in place. Slots are half-edges, three per triangle; the corners of a removed triangle are kNone.
class VertexRemover {
 public:
  VertexRemover(Mesh& mesh, Topology& topology, std::vector<EdgeClass>& edges, const Regions& regions,
                const std::vector<Projection>& views, const MergeOptions& options);
  void run();
  // Of a removed vertex from the edge that now passes it by.
  [[nodiscard]] double largest_distance() const { return largest_distance_; }

 private:
  struct RingEdge {
    std::uint32_t across;  // the opposite slot, or +kBoundary
    EdgeClass edge;
    std::uint32_t swallowed;
    bool closes;  // the edge along the border that will close the ring
  };
  // The part of a vertex's fan that belongs to one region: the ring of neighbouring vertices, and its edges.
  struct Star {
    std::vector<std::uint32_t> out;  // the half-edges that leave the vertex, counter-clockwise
    std::vector<std::uint32_t> ring;
    std::vector<Vec3> points;
    std::vector<RingEdge> ring_edges;  // from each ring vertex to the next
    std::vector<Ear> ears;
  };
  enum class Outcome { kept, later, removed };

  static std::uint32_t next(std::uint32_t slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
  static std::uint32_t previous(std::uint32_t slot) { return slot % 3 == 0 ? slot + 2 : slot - 1; }
  [[nodiscard]] std::uint32_t tail(std::uint32_t slot) const { return +mesh_.corners[slot]; }
  [[nodiscard]] std::uint32_t head(std::uint32_t slot) const { return +mesh_.corners[next(slot)]; }
  [[nodiscard]] HalfedgeId twin(std::uint32_t slot) const { return topology_.twin[slot]; }
  [[nodiscard]] std::uint32_t region(std::uint32_t slot) const { return regions_.of_face[slot / 3]; }
  [[nodiscard]] const Vec3& point(std::uint32_t vertex) const { return mesh_.points[vertex]; }

  void remove_inner();
  void remove_border();
  Outcome try_inner(std::uint32_t vertex, std::size_t largest_fan);
  Outcome try_border(std::uint32_t vertex, std::uint32_t& left, std::uint32_t& right);
  bool read_fan(std::uint32_t vertex);  // into fan_; true: the fan is closed
  void read_ring(Star& star, bool is_closed) const;
  bool cut(Star& star, std::uint32_t vertex);
  std::uint32_t replace(Star& star);
  [[nodiscard]] bool goes_once_round(const Star& star, std::uint32_t vertex) const;
  [[nodiscard]] std::size_t count_edges(std::uint32_t from, std::uint32_t to) const;
  [[nodiscard]] bool is_near(const Vec3& from, const Vec3& to, const Vec3& x) const;
  [[nodiscard]] bool all_near(const Vec3& from, const Vec3& to, std::uint32_t list) const;
  [[nodiscard]] bool is_straight(std::uint32_t from, std::uint32_t vertex, std::uint32_t to, std::uint32_t list_in,
                                 std::uint32_t list_out, bool& is_exact) const;
  std::uint32_t join_lists(std::uint32_t a, std::uint32_t b);
  void measure(std::uint32_t from, std::uint32_t to, std::uint32_t list);

  Mesh& mesh_;
  Topology& topology_;
  std::vector<EdgeClass>& edges_;
  const Regions& regions_;
  const std::vector<Projection>& views_;
  const MergeOptions& options_;
  std::vector<std::uint32_t> slot_of_;  // of each vertex of a region: a half-edge that leaves it; else kNone
  // Removed vertices that a border edge replaces without passing through them exactly, as linked lists: the first by slot (the
  // same for both halves of an edge), the next by vertex.
  LazyArray<NoneYet> swallowed_, next_swallowed_;
  double largest_distance_ = 0;
  std::vector<std::uint32_t> fan_;
  Star left_star_, right_star_;
  PolygonCutter cutter_;
};

}  // namespace fdcg::bake
