// SPDX-License-Identifier: Apache-2.0
#include "serialise.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>

#include "fan_tree.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/format.h"
#include "hierarchy.hpp"
#include "parallel.hpp"
#include "planes.hpp"
#include "vec.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kGrain = 1u << 12;

struct Records64 {
  using Real = double;
  using Plane = fdcg_plane_f64;
  using Node = fdcg_node_f64;
  using Connection = fdcg_connection_f64;
  using Corner = fdcg_corner_f64;
  using FanBox = fdcg_fan_box_f64;
};
struct Records32 {
  using Real = float;
  using Plane = fdcg_plane_f32;
  using Node = fdcg_node_f32;
  using Connection = fdcg_connection_f32;
  using Corner = fdcg_corner_f32;
  using FanBox = fdcg_fan_box_f32;
};

constexpr std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + FDCG_ALIGNMENT - 1) / FDCG_ALIGNMENT * FDCG_ALIGNMENT;
}

// Where each section lies.
class Layout {
 public:
  void add(fdcg_section_id id, std::size_t record_bytes, std::uint64_t count) {
    sections_.push_back({static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(record_bytes), 0, count, 0, 0});
  }
  void place() {
    std::uint64_t at = table_end();
    for (fdcg_section& section : sections_) {
      section.offset = at;
      at += padded(section.record_bytes * section.record_count);
    }
    bytes_ = at;
  }
  [[nodiscard]] std::uint64_t table_end() const {
    return padded(sizeof(fdcg_header) + sections_.size() * sizeof(fdcg_section));
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::vector<fdcg_section>& sections() { return sections_; }

  // The records of a section inside the file; empty where the file has none.
  template <class Record>
  [[nodiscard]] std::span<Record> records(std::span<std::byte> file, fdcg_section_id id) const {
    for (const fdcg_section& section : sections_) {
      if (section.id == static_cast<std::uint32_t>(id))
        return {reinterpret_cast<Record*>(file.data() + section.offset), section.record_count};
    }
    return {};
  }

 private:
  std::vector<fdcg_section> sections_;
  std::uint64_t bytes_ = 0;
};

// What one range of nodes adds to the header.
struct NodeTally {
  std::array<std::uint32_t, 4> types{};
  double max_deviation = 0;
};

template <class Records>
class Writer {
  using Real = typename Records::Real;

 public:
  Writer(const Graph& graph, const SerialiseInput& input) : graph_(graph), input_(input) {}

  Result<std::span<std::byte>> run(const Allocate& allocate) {
    plan();
    file_ = allocate(layout_.bytes());
    if (file_.empty()) return Failure{3, "no memory for a file of " + std::to_string(layout_.bytes()) + " bytes", {}};
    nodes_ = layout_.records<typename Records::Node>(file_, FDCG_SECTION_NODES);
    sides_ = layout_.records<std::uint32_t>(file_, FDCG_SECTION_SIDES);
    voronoi_ = layout_.records<typename Records::Plane>(file_, FDCG_SECTION_VORONOI);
    connections_ = layout_.records<typename Records::Connection>(file_, FDCG_SECTION_CONNECTIONS);
    corners_ = layout_.records<typename Records::Corner>(file_, FDCG_SECTION_CORNERS);
    fans_ = layout_.records<std::uint32_t>(file_, FDCG_SECTION_FANS);
    find_bounds();
    write_nodes();
    parallel_for(input_.jobs, graph_.corner_count(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c)
        write_corner(c);
    });
    write_fan_trees();
    if (input_.with_hierarchy) {
      build_hierarchy(graph_, {header_.extent, header_.max_deviation},
                      layout_.records<fdcg_box8>(file_, FDCG_SECTION_HIERARCHY), input_.jobs);
    }
    write_source_map();
    std::copy(input_.info.begin(), input_.info.end(), layout_.records<char>(file_, FDCG_SECTION_INFO).begin());
    write_header();
    return file_;
  }

 private:
  void plan() {
    layout_.add(FDCG_SECTION_NODES, sizeof(typename Records::Node), graph_.node_count());
    layout_.add(FDCG_SECTION_SIDES, sizeof(std::uint32_t), graph_.side_count());
    if (input_.with_voronoi_planes) layout_.add(FDCG_SECTION_VORONOI, sizeof(typename Records::Plane), graph_.side_count());
    layout_.add(FDCG_SECTION_CONNECTIONS, sizeof(typename Records::Connection), graph_.connection_count);
    layout_.add(FDCG_SECTION_CORNERS, sizeof(typename Records::Corner), graph_.corner_count());
    layout_.add(FDCG_SECTION_FANS, sizeof(std::uint32_t), graph_.first_fan.back());
    if (input_.with_hierarchy) {
      const std::vector<std::uint32_t> levels = hierarchy_levels(graph_.node_count());
      layout_.add(FDCG_SECTION_HIERARCHY, sizeof(fdcg_box8), std::accumulate(levels.begin(), levels.end(), std::uint64_t{0}));
    }
    if (input_.with_source_map) layout_.add(FDCG_SECTION_SOURCE_MAP, sizeof(std::uint32_t), input_.source_face_count);
    if (!input_.info.empty()) layout_.add(FDCG_SECTION_INFO, 1, input_.info.size());
    find_busy_corners();
    if (fan_boxes_ > 0) layout_.add(FDCG_SECTION_FAN_BOXES, sizeof(typename Records::FanBox), fan_boxes_);
    layout_.place();
  }

  void find_busy_corners() {
    for (std::uint32_t c = 0; c < graph_.corner_count(); ++c) {
      const std::uint32_t boxes = fan_box_count(graph_.first_fan[c + 1] - graph_.first_fan[c]);
      if (boxes == 0) continue;
      busy_corners_.push_back({c, fan_boxes_});
      fan_boxes_ += boxes;
    }
  }

  void find_bounds() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Vec3 low{kFar, kFar, kFar}, high = -low;
    for (const Vec3& p : graph_.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    for (int k = 0; k < 3; ++k) {
      header_.bounds_min[k] = component(low, k);
      header_.bounds_max[k] = component(high, k);
    }
    header_.extent = std::max(largest_component(low), largest_component(high));
  }

  static typename Records::Plane stored(const Plane& p) {
    return {{static_cast<Real>(p.normal.x), static_cast<Real>(p.normal.y), static_cast<Real>(p.normal.z)},
            static_cast<Real>(p.offset)};
  }

  [[nodiscard]] const Vec3& start(std::uint32_t side) const { return graph_.points[graph_.corner[side]]; }

  // The plane as it is stored: for a face on its own, of the normal after rounding.
  [[nodiscard]] Plane plane_of(std::uint32_t node) const {
    const std::uint32_t region = graph_.region_of(node), first = graph_.first_side[node];
    if (region != kNone) return graph_.regions[region].plane;
    const std::array<Vec3, 3> corners{start(first), start(first + 1), start(first + 2)};
    return stored_plane(unit_normal(corners[0], corners[1], corners[2]), corners, input_.precision);
  }

  void write_nodes() {
    std::vector<NodeTally> tallies((graph_.node_count() + kGrain - 1) / kGrain);
    parallel_for(input_.jobs, graph_.node_count(), kGrain, [&](std::size_t begin, std::size_t end) {
      NodeTally tally;
      for (auto n = static_cast<std::uint32_t>(begin); n < end; ++n)
        write_node(n, tally);
      tallies[begin / kGrain] = tally;
    });
    for (const NodeTally& tally : tallies) {
      for (int type = 0; type < 4; ++type)
        header_.connection_type_count[type] += tally.types[type];
      header_.max_deviation = std::max(header_.max_deviation, tally.max_deviation);
    }
  }

  void write_node(std::uint32_t n, NodeTally& tally) {
    const std::uint32_t first = graph_.first_side[n], end = graph_.first_side[n + 1];
    const std::uint32_t region = graph_.region_of(n);
    const bool is_exact = region == kNone || graph_.regions[region].is_exact;
    const Plane plane = plane_of(n);
    nodes_[n].plane = stored(plane);
    nodes_[n].first_side = first;
    nodes_[n].side_count = static_cast<std::uint16_t>(end - first);
    nodes_[n].flags = is_exact ? 0 : FDCG_NODE_INEXACT;
    for (std::uint32_t side = first; side < end; ++side) {
      const Vec3& from = start(side);
      const Vec3& to = start(side + 1 < end ? side + 1 : first);
      const Vec3 along = edge_direction(from, to);
      const std::uint32_t entry = graph_.connection[side];
      sides_[side] = entry;
      if (!voronoi_.empty()) {
        const StoredPlane<Real> m =
            voronoi_plane(Stored3<Real>(along), Stored3<Real>(plane.normal), Stored3<Real>((entry & 1u) == 0 ? from : to));
        voronoi_[side] = {{m.normal[0], m.normal[1], m.normal[2]}, m.offset};
      }
      if ((entry & 1u) == 0) ++tally.types[write_connection(entry >> 1, side, n, along, from, to)];
      if (!is_exact) tally.max_deviation = std::max(tally.max_deviation, deviation(plane, from));
    }
  }

  // An upper bound, whatever the three products and sums lost.
  [[nodiscard]] double deviation(const Plane& plane, const Vec3& point) const {
    constexpr double kRounding = 1e-15;  // 4 operations on terms no larger than 3 extents and an offset: below 8 * 2^-53 each
    return std::fabs(dot(plane.normal, point) + plane.offset) + kRounding * (header_.extent + std::fabs(plane.offset));
  }

  fdcg_connection_type write_connection(std::uint32_t id, std::uint32_t side, std::uint32_t n, const Vec3& along,
                                        const Vec3& from, const Vec3& to) {
    typename Records::Connection& connection = connections_[id];
    connection.edge[0] = static_cast<Real>(along.x);
    connection.edge[1] = static_cast<Real>(along.y);
    connection.edge[2] = static_cast<Real>(along.z);
    connection.end_offset[0] = static_cast<Real>(dot(along, from));
    connection.end_offset[1] = static_cast<Real>(-dot(along, to));
    connection.corner[0] = graph_.corner[side];
    connection.corner[1] = graph_.corner[graph_.next(side)];
    connection.node[0] = n;
    connection.side[0] = static_cast<std::uint16_t>(side - graph_.first_side[n]);
    const std::uint32_t twin = graph_.twin[side];
    const std::uint32_t other = twin == kNone ? FDCG_NONE : graph_.node(twin);
    connection.node[1] = other;
    connection.side[1] = twin == kNone ? std::uint16_t{0} : static_cast<std::uint16_t>(twin - graph_.first_side[other]);
    const auto [type, flatness] = type_of(side, n, other);
    connection.type = static_cast<std::uint8_t>(type);
    connection.flatness = static_cast<std::uint8_t>(flatness);
    connection.reserved = 0;
    return type;
  }

  // Coplanar inside a region, for then the two share a plane; else what the stored points say.
  [[nodiscard]] std::pair<fdcg_connection_type, fdcg_flatness> type_of(std::uint32_t side, std::uint32_t a,
                                                                       std::uint32_t b) const {
    const EdgeClass edge = graph_.edges[side];
    const std::uint32_t region = graph_.region_of(a);
    if (b == FDCG_NONE) return {FDCG_BOUNDARY, FDCG_FLAT_EXACT};
    if (region == kNone || graph_.region_of(b) != region) return {edge.sign(), FDCG_FLAT_EXACT};
    if (edge.sign() == FDCG_COPLANAR) return {FDCG_COPLANAR, FDCG_FLAT_EXACT};
    const Flat tier = edge.flat() != Flat::no ? edge.flat() : graph_.regions[region].tier;
    return {FDCG_COPLANAR, tier == Flat::angle ? FDCG_FLAT_ANGLE : FDCG_FLAT_QUANTUM};
  }

  void write_corner(std::uint32_t c) {
    typename Records::Corner& corner = corners_[c];
    const Vec3& point = graph_.points[c];
    corner.point[0] = static_cast<Real>(point.x);
    corner.point[1] = static_cast<Real>(point.y);
    corner.point[2] = static_cast<Real>(point.z);
    corner.first_fan = graph_.first_fan[c];
    corner.fan_count = graph_.first_fan[c + 1] - graph_.first_fan[c];
    std::uint32_t side = graph_.fan_start[c];
    const bool is_open = graph_.twin[side] == kNone;
    corner.flags = is_open ? FDCG_CORNER_OPEN : 0;
    std::uint32_t* entry = fans_.data() + corner.first_fan;
    Vec3 sum;
    const std::uint32_t faces = corner.fan_count - (is_open ? 1 : 0);
    for (std::uint32_t i = 0; i < faces; ++i) {
      const std::uint32_t incoming = graph_.previous(side);
      *entry++ = graph_.connection[side];
      const double angle = angle_between(leaving(graph_.connection[side]), leaving(graph_.connection[incoming] ^ 1u));
      sum = sum + angle * normal_of(graph_.node(side));
      if (i + 1 == faces && is_open) *entry = graph_.connection[incoming] ^ 1u;
      side = graph_.twin[incoming];
    }
    const Vec3 normal = unit(sum);
    corner.normal[0] = static_cast<float>(normal.x);
    corner.normal[1] = static_cast<float>(normal.y);
    corner.normal[2] = static_cast<float>(normal.z);
  }

  void write_fan_trees() {
    const auto boxes = layout_.records<typename Records::FanBox>(file_, FDCG_SECTION_FAN_BOXES);
    parallel_for(input_.jobs, busy_corners_.size(), 1, [&](std::size_t i, std::size_t) {
      typename Records::Corner& corner = corners_[busy_corners_[i].corner];
      corner.flags |= (1 + busy_corners_[i].first_box) << FDCG_CORNER_TREE_SHIFT;
      std::vector<FanDirection> fan(corner.fan_count);
      for (std::uint32_t k = 0; k < corner.fan_count; ++k) {
        const std::uint32_t entry = fans_[corner.first_fan + k];
        fan[k].edge = leaving(entry);
        const std::uint32_t node = connections_[entry >> 1].node[entry & 1u];
        if (node != FDCG_NONE) fan[k].face_normal = normal_of(node);
      }
      std::uint32_t at = busy_corners_[i].first_box;
      for (const FanBox& box : build_fan_tree(fan, std::numeric_limits<Real>::epsilon())) {
        for (int k = 0; k < 3; ++k) {
          boxes[at].centre[k] = static_cast<Real>(component(box.centre, k));
          for (int axis = 0; axis < 3; ++axis)
            boxes[at].axis[axis][k] = static_cast<Real>(component(box.axis[axis], k));
        }
        ++at;
      }
    });
  }

  [[nodiscard]] Vec3 normal_of(std::uint32_t node) const {
    const auto& normal = nodes_[node].plane.normal;
    return {normal[0], normal[1], normal[2]};
  }

  // The direction in which the connection leaves the corner that the fan entry belongs to.
  [[nodiscard]] Vec3 leaving(std::uint32_t entry) const {
    const auto& edge = connections_[entry >> 1].edge;
    const Vec3 along{edge[0], edge[1], edge[2]};
    return (entry & 1u) == 0 ? along : -along;
  }

  void write_source_map() {
    const std::span<std::uint32_t> map = layout_.records<std::uint32_t>(file_, FDCG_SECTION_SOURCE_MAP);
    for (std::uint32_t i = 0; i < map.size(); ++i) {
      const std::uint32_t face = input_.face_of_source.empty() ? i : input_.face_of_source[i];
      map[i] = face == kNone ? FDCG_NONE : graph_.node_of_face[face];
    }
  }

  void write_header() {
    std::vector<fdcg_section>& sections = layout_.sections();
    parallel_for(input_.jobs, sections.size(), 1, [&](std::size_t i, std::size_t) {
      const std::uint64_t bytes = padded(sections[i].record_bytes * sections[i].record_count);
      sections[i].checksum = fdcg_checksum(file_.data() + sections[i].offset, bytes);
    });
    std::memcpy(file_.data() + sizeof header_, sections.data(), sections.size() * sizeof(fdcg_section));
    std::memcpy(header_.magic, FDCG_MAGIC, sizeof header_.magic);
    header_.format_version = FDCG_FORMAT_VERSION;
    header_.header_bytes = sizeof header_;
    header_.file_bytes = layout_.bytes();
    header_.real_bytes = sizeof(Real);
    header_.section_count = static_cast<std::uint32_t>(sections.size());
    header_.node_count = graph_.node_count();
    header_.side_count = graph_.side_count();
    header_.connection_count = graph_.connection_count;
    header_.corner_count = graph_.corner_count();
    header_.fan_count = graph_.first_fan.back();
    header_.largest_fan = graph_.largest_fan;
    for (int k = 0; k < 3; ++k)
      header_.origin[k] = component(input_.origin, k);
    header_.metres_per_unit = input_.metres_per_unit;
    header_.quantum = input_.quantum;
    header_.fan_box_count = fan_boxes_;
    header_.source_vertex_count = input_.source_vertex_count;
    header_.source_face_count = input_.source_face_count;
    header_.table_checksum = fdcg_checksum(file_.data() + sizeof header_, layout_.table_end() - sizeof header_);
    header_.header_checksum = fdcg_checksum(&header_, offsetof(fdcg_header, header_checksum));
    std::memcpy(file_.data(), &header_, sizeof header_);
  }

  const Graph& graph_;
  const SerialiseInput& input_;
  Layout layout_;
  fdcg_header header_{};
  struct BusyCorner {
    std::uint32_t corner, first_box;
  };
  std::vector<BusyCorner> busy_corners_;
  std::uint32_t fan_boxes_ = 0;
  std::span<std::byte> file_;
  std::span<typename Records::Node> nodes_;
  std::span<std::uint32_t> sides_;
  std::span<typename Records::Plane> voronoi_;
  std::span<typename Records::Connection> connections_;
  std::span<typename Records::Corner> corners_;
  std::span<std::uint32_t> fans_;
};

}  // namespace

Result<std::span<std::byte>> serialise(const Graph& graph, const SerialiseInput& input, const Allocate& allocate) {
  // Sides and fan entries carry a connection's number and one bit.
  constexpr std::uint64_t kMostConnections = 1u << 31;
  if (graph.connection_count >= kMostConnections)
    return Failure{3, "the mesh has " + std::to_string(graph.connection_count) + " edges, the format holds fewer than 2^31"};
  if (input.precision == Precision::f32) return Writer<Records32>(graph, input).run(allocate);
  return Writer<Records64>(graph, input).run(allocate);
}

}  // namespace fdcg::bake
