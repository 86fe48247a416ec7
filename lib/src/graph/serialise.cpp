// SPDX-License-Identifier: Apache-2.0
// A little over 400 lines: one writer for all sections of a file, in the order of its table, with common counts and offsets.
#include "graph/serialise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "exact/planes.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/format.h"
#include "graph/face_materials.hpp"
#include "graph/fan_tree.hpp"
#include "graph/hierarchy.hpp"
#include "graph/layout.hpp"
#include "shared/derive.hpp"  // stored bits are those that the runtime derives
#include "shared/face_plane.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kRecordGrain = 1u << 12;

struct Records64 {
  using Real = double;
  using Plane = fdcg_plane_f64;
  using Node = fdcg_node_f64;
  using Edge = fdcg_connection_geometry_f64;
  using Corner = fdcg_corner_f64;
  using FanBox = fdcg_fan_box_f64;
};
struct Records32 {
  using Real = float;
  using Plane = fdcg_plane_f32;
  using Node = fdcg_node_f32;
  using Edge = fdcg_connection_geometry_f32;
  using Corner = fdcg_corner_f32;
  using FanBox = fdcg_fan_box_f32;
};

// Contribution of one range of nodes to the header.
struct NodeTally {
  std::array<std::uint32_t, 4> types{};
  double max_deviation = 0;
};

template <class Records>
class Writer {
  using Real = typename Records::Real;
  using Node = typename Records::Node;
  using StoredPlane = typename Records::Plane;

 public:
  Writer(const Graph& graph, const SerialiseInput& input)
      : graph_(graph),
        input_(input),
        blocks_(graph, offsetof(Node, sides), sizeof(Real), input.with_planes ? sizeof(StoredPlane) : 0) {}

  Result<std::span<std::byte>> run(const Allocate& allocate) {
    constexpr std::uint64_t kMostBlocks = sizeof(Real) << 32;  // offsets have 32 bits
    if (blocks_.uniform_bytes() == 0 && blocks_.bytes() > kMostBlocks)
      return Failure{
          3,
          "the nodes take " + std::to_string(blocks_.bytes()) + " bytes, the format holds 2^32 numbers: derive the planes",
          {}};
    plan();
    file_ = allocate(layout_.bytes());
    if (file_.empty()) return Failure{3, "no memory for a file of " + std::to_string(layout_.bytes()) + " bytes", {}};
    clear_padding();
    blocks_.place(layout_.records<std::uint32_t>(file_, FDCG_SECTION_NODE_OFFSETS));
    node_blocks_ = layout_.records<std::byte>(file_, FDCG_SECTION_NODES);
    edges_ = layout_.records<typename Records::Edge>(file_, FDCG_SECTION_EDGES);
    connections_ = layout_.records<fdcg_connection>(file_, FDCG_SECTION_CONNECTIONS);
    corners_ = layout_.records<typename Records::Corner>(file_, FDCG_SECTION_CORNERS);
    fans_ = layout_.records<std::uint32_t>(file_, FDCG_SECTION_FANS);
    find_bounds();
    write_nodes();
    parallel_for(input_.jobs, graph_.corner_count(), kRecordGrain, [&](std::size_t begin, std::size_t end) {
      for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c)
        write_corner(c);
    });
    write_busy_corners();
    if (input_.with_hierarchy) {
      build_hierarchy(graph_, {header_.extent, header_.max_deviation},
                      layout_.records<fdcg_box8>(file_, FDCG_SECTION_HIERARCHY), input_.jobs);
    }
    write_source_map();
    std::copy(input_.info.begin(), input_.info.end(), layout_.records<char>(file_, FDCG_SECTION_INFO).begin());
    if (input_.mass) layout_.records<fdcg_mass_record>(file_, FDCG_SECTION_MASS)[0] = *input_.mass;
    write_materials();
    write_fan_runs();
    const auto normals = layout_.records<fdcg_node_normals>(file_, FDCG_SECTION_NODE_NORMALS);
    for (std::size_t face = 0; face < input_.normals_of_face.size(); ++face)
      normals[graph_.node_of_face[face]] = input_.normals_of_face[face];
    write_visual();
    write_heights();
    write_header();
    return file_;
  }

 private:
  void plan() {
    if (blocks_.uniform_bytes() != 0) {
      layout_.add(FDCG_SECTION_NODES, blocks_.uniform_bytes(), graph_.node_count());
    } else {
      layout_.add(FDCG_SECTION_NODES, sizeof(Real), blocks_.bytes() / sizeof(Real));
      layout_.add(FDCG_SECTION_NODE_OFFSETS, sizeof(std::uint32_t), graph_.node_count());
    }
    if (input_.with_planes) layout_.add(FDCG_SECTION_EDGES, sizeof(typename Records::Edge), graph_.connection_count);
    layout_.add(FDCG_SECTION_CONNECTIONS, sizeof(fdcg_connection), graph_.connection_count);
    layout_.add(FDCG_SECTION_CORNERS, sizeof(typename Records::Corner), graph_.corner_count());
    find_busy_corners();
    if (!busy_corners_.empty()) layout_.add(FDCG_SECTION_FANS, sizeof(std::uint32_t), fan_entries_);
    if (input_.with_hierarchy) {
      const std::vector<std::uint32_t> levels = hierarchy_levels(graph_.node_count());
      layout_.add(FDCG_SECTION_HIERARCHY, sizeof(fdcg_box8), std::accumulate(levels.begin(), levels.end(), std::uint64_t{0}));
    }
    if (input_.with_source_map) layout_.add(FDCG_SECTION_SOURCE_MAP, sizeof(std::uint32_t), input_.source_face_count);
    if (!input_.info.empty()) layout_.add(FDCG_SECTION_INFO, 1, input_.info.size());
    if (!busy_corners_.empty()) {
      layout_.add(FDCG_SECTION_FAN_BOXES, sizeof(typename Records::FanBox), fan_boxes_);
      layout_.add(FDCG_SECTION_BUSY_CORNERS, sizeof(fdcg_busy_corner), busy_corners_.size());
    }
    if (input_.mass) layout_.add(FDCG_SECTION_MASS, sizeof(fdcg_mass_record), 1);
    if (!input_.materials.empty()) {
      layout_.add(FDCG_SECTION_MATERIALS, sizeof(std::uint16_t), graph_.node_count());
      layout_.add(FDCG_SECTION_MATERIAL_NAMES, sizeof(fdcg_material_record), input_.materials.size());
    }
    if (has_fan_runs()) layout_.add(FDCG_SECTION_FAN_RUNS, sizeof(fdcg_fan_run), graph_.fan_runs.size());
    if (!input_.normals_of_face.empty()) layout_.add(FDCG_SECTION_NODE_NORMALS, sizeof(fdcg_node_normals), graph_.node_count());
    if (!input_.visual.is_empty()) {
      layout_.add(section_id(FDCG_SECTION_VISUAL_VERTICES), sizeof(fdcg_visual_vertex), input_.visual.vertices.size());
      layout_.add(section_id(FDCG_SECTION_VISUAL_INDICES), sizeof(std::uint32_t), input_.visual.indices.size());
      layout_.add(section_id(FDCG_SECTION_VISUAL_NODES), sizeof(std::uint32_t), input_.visual.nodes.size());
      layout_.add(section_id(FDCG_SECTION_VISUAL_MATERIALS), sizeof(fdcg_visual_material), input_.visual.materials.size());
    }
    if (!input_.heights.is_empty()) {
      layout_.add(section_id(FDCG_SECTION_NODE_PLACES), sizeof(fdcg_node_place), graph_.node_count());
      layout_.add(section_id(FDCG_SECTION_HEIGHT_MAPS), sizeof(fdcg_height_map), input_.heights.maps.size());
      layout_.add(section_id(FDCG_SECTION_HEIGHT_TEXELS), sizeof(std::int16_t), input_.heights.texels.size());
    }
    layout_.place();
  }
  static fdcg_section_id section_id(fdcg_visual_section_id id) { return static_cast<fdcg_section_id>(id); }
  static fdcg_section_id section_id(fdcg_heights_section_id id) { return static_cast<fdcg_section_id>(id); }

  // What lies between sections. Inside them every byte is written with its record.
  void clear_padding() {
    std::memset(file_.data(), 0, layout_.table_end());
    for (const fdcg_section& section : layout_.sections()) {
      const std::uint64_t bytes = section.record_bytes * section.record_count;
      std::memset(file_.data() + section.offset + bytes, 0, padded(bytes) - bytes);
    }
  }

  void find_busy_corners() {
    for (std::uint32_t c = 0; c < graph_.corner_count(); ++c) {
      const std::uint32_t entries = graph_.first_fan[c + 1] - graph_.first_fan[c], boxes = fan_box_count(entries);
      if (boxes == 0) continue;
      busy_corners_.push_back({c, fan_entries_, entries, fan_boxes_});
      fan_entries_ += entries;
      fan_boxes_ += boxes;
    }
  }

  // What they spare a sweep are boxes.
  [[nodiscard]] bool has_fan_runs() const { return input_.with_hierarchy && !graph_.fan_runs.empty(); }

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

  static StoredPlane stored(const Plane& p) {
    return {{static_cast<Real>(p.normal.x), static_cast<Real>(p.normal.y), static_cast<Real>(p.normal.z)},
            static_cast<Real>(p.offset)};
  }

  static fdcg::Vec3<Real> rounded(const Vec3& v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
  }

  [[nodiscard]] Node& node(std::uint32_t n) const { return *reinterpret_cast<Node*>(node_blocks_.data() + blocks_.at(n)); }

  [[nodiscard]] const Vec3& start(std::uint32_t side) const { return graph_.points[graph_.corner[side]]; }

  [[nodiscard]] fdcg::Vec3<double> exact_corner(std::uint32_t side) const {
    const Vec3& p = start(side);
    return {p.x, p.y, p.z};
  }

  // The plane as it is stored. For a face in no region the offset is computed for the rounded normal.
  [[nodiscard]] Plane plane_of(std::uint32_t node) const {
    const std::uint32_t region = graph_.region_of(node), first = graph_.first_side[node];
    if (region != kNone) return graph_.regions[region].plane;
    const fdcg::Vec3<double> a = exact_corner(first), b = exact_corner(first + 1), c = exact_corner(first + 2);
    fdcg::Vec3<double> unit;
    if (!quick_normal_of(a, b, c, &unit, Real{})) unit = unit_normal_of(a, b, c);
    const fdcg::Plane<Real> plane = plane_with_normal<Real>(unit, a, b, c);
    return {{plane.normal.x, plane.normal.y, plane.normal.z}, plane.offset};
  }

  void write_nodes() {
    std::vector<NodeTally> tallies((graph_.node_count() + kRecordGrain - 1) / kRecordGrain);
    parallel_for(input_.jobs, graph_.node_count(), kRecordGrain, [&](std::size_t begin, std::size_t end) {
      NodeTally tally;
      for (auto n = static_cast<std::uint32_t>(begin); n < end; ++n)
        write_node(n, tally);
      tallies[begin / kRecordGrain] = tally;
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
    Node& record = node(n);
    record.plane = stored(plane);
    record.side_count = static_cast<std::uint16_t>(end - first);
    record.flags = is_exact ? 0 : FDCG_NODE_INEXACT;
    auto* const block = reinterpret_cast<std::byte*>(&record);
    auto* const sides = reinterpret_cast<fdcg_side*>(block + offsetof(Node, sides));
    const std::uint32_t sides_end = blocks_.sides_end(end - first), planes_at = blocks_.planes_at(end - first);
    std::memset(block + sides_end, 0, planes_at - sides_end);
    auto* const planes = reinterpret_cast<StoredPlane*>(block + planes_at);
    for (std::uint32_t side = first; side < end; ++side) {
      const std::uint32_t link = graph_.connection[side], twin = graph_.twin[side];
      sides[side - first] = {link, graph_.corner[side], twin == kNone ? FDCG_NONE : graph_.node(twin)};
      if (input_.with_planes) {
        const Edge<Real> edge = edge_of(side);
        const fdcg::Plane<Real> m = derive_voronoi_plane(edge.start, edge.direction, rounded(plane.normal), link & 1u);
        planes[side - first] = {{m.normal.x, m.normal.y, m.normal.z}, m.offset};
        if ((link & 1u) == 0) edges_[link >> 1] = {{edge.direction.x, edge.direction.y, edge.direction.z}, edge.length};
      }
      if ((link & 1u) == 0) ++tally.types[write_connection(link >> 1, side, n)];
      if (!is_exact) tally.max_deviation = std::max(tally.max_deviation, deviation(plane, start(side)));
    }
  }

  // The connection's edge, from its corner 0 to its corner 1.
  [[nodiscard]] Edge<Real> edge_of(std::uint32_t side) const {
    const fdcg::Vec3<Real> from = rounded(start(side)), to = rounded(start(graph_.next(side)));
    return (graph_.connection[side] & 1u) == 0 ? derive_edge(from, to) : derive_edge(to, from);
  }

  // An upper bound that includes the rounding error of the three products and sums.
  [[nodiscard]] double deviation(const Plane& plane, const Vec3& point) const {
    constexpr double kRounding = 1e-15;  // 4 operations on terms no larger than 3 extents and an offset: below 8 * 2^-53 each
    return std::fabs(dot(plane.normal, point) + plane.offset) + kRounding * (header_.extent + std::fabs(plane.offset));
  }

  fdcg_connection_type write_connection(std::uint32_t id, std::uint32_t side, std::uint32_t n) {
    const std::uint32_t twin = graph_.twin[side], other = twin == kNone ? FDCG_NONE : graph_.node(twin);
    const auto [type, flatness] = type_of(side, n, other);
    const auto side_there = static_cast<std::uint8_t>(twin == kNone ? 0 : twin - graph_.first_side[other]);
    connections_[id] = {n,
                        {static_cast<std::uint8_t>(side - graph_.first_side[n]), side_there},
                        static_cast<std::uint8_t>(type),
                        static_cast<std::uint8_t>(flatness)};
    return type;
  }

  // Coplanar inside a region, where the two nodes have one plane; else the sign from the stored points.
  [[nodiscard]] std::pair<fdcg_connection_type, fdcg_flatness> type_of(std::uint32_t side, std::uint32_t a,
                                                                       std::uint32_t b) const {
    const EdgeClass edge = graph_.edges[side];
    const std::uint32_t region = graph_.region_of(a);
    if (b == FDCG_NONE) return {FDCG_BOUNDARY, FDCG_FLAT_EXACT};
    if (!graph_.is_one_plane(a, b)) return {edge.sign(), FDCG_FLAT_EXACT};
    if (edge.sign() == FDCG_COPLANAR) return {FDCG_COPLANAR, FDCG_FLAT_EXACT};
    const Flat tier = edge.flat() != Flat::no ? edge.flat() : graph_.regions[region].tier;
    return {FDCG_COPLANAR, tier == Flat::angle ? FDCG_FLAT_ANGLE : FDCG_FLAT_QUANTUM};
  }

  void write_corner(std::uint32_t c) {
    typename Records::Corner& corner = corners_[c];
    corner = {};
    const Vec3& point = graph_.points[c];
    corner.point[0] = static_cast<Real>(point.x);
    corner.point[1] = static_cast<Real>(point.y);
    corner.point[2] = static_cast<Real>(point.z);
    const std::uint32_t entries = graph_.first_fan[c + 1] - graph_.first_fan[c], first = graph_.fan_start[c];
    const bool is_open = graph_.twin[first] == kNone, is_busy = entries > FDCG_BUSY_FAN;
    corner.first = graph_.node(first);
    corner.side = static_cast<std::uint8_t>(is_busy ? 0 : first - graph_.first_side[corner.first]);
    corner.fan = static_cast<std::uint8_t>((is_busy ? 0 : entries) | (is_open ? FDCG_CORNER_OPEN : 0));
    Vec3 sum;
    std::uint32_t side = first;
    Vec3 along = leaving(side);
    for (std::uint32_t faces = entries - (is_open ? 1 : 0); faces > 0; --faces) {
      const std::uint32_t incoming = graph_.previous(side);
      const Vec3 next_along = -leaving(incoming);  // the way in which the twin leaves
      const double angle = angle_of({along.x, along.y, along.z}, {next_along.x, next_along.y, next_along.z});
      sum = sum + angle * normal_of(graph_.node(side));
      side = graph_.twin[incoming];
      along = next_along;
    }
    const Vec3 normal = unit(sum);
    for (int k = 0; k < 3; ++k)
      corner.normal[k] = static_cast<std::int16_t>(std::floor(FDCG_NORMAL_SCALE * component(normal, k) + 0.5));
  }

  // The fan as the file stores it, and its directions.
  std::vector<FanDirection> write_fan(std::uint32_t c, std::span<std::uint32_t> entries) const {
    std::vector<FanDirection> fan(entries.size());
    std::uint32_t side = graph_.fan_start[c];
    for (std::size_t i = 0; i < fan.size(); ++i) {
      entries[i] = graph_.connection[side];
      fan[i] = {leaving(side), normal_of(graph_.node(side))};
      const std::uint32_t incoming = graph_.previous(side);
      side = graph_.twin[incoming];
      if (side != kNone) continue;
      entries[i + 1] = graph_.connection[incoming] ^ 1u;
      fan[i + 1] = {-leaving(incoming), {}};
      break;
    }
    return fan;
  }

  void write_busy_corners() {
    const auto boxes = layout_.records<typename Records::FanBox>(file_, FDCG_SECTION_FAN_BOXES);
    std::copy(busy_corners_.begin(), busy_corners_.end(),
              layout_.records<fdcg_busy_corner>(file_, FDCG_SECTION_BUSY_CORNERS).begin());
    parallel_for(input_.jobs, busy_corners_.size(), 1, [&](std::size_t i, std::size_t) {
      const fdcg_busy_corner& busy = busy_corners_[i];
      corners_[busy.corner].first = static_cast<std::uint32_t>(i);
      const std::vector<FanDirection> fan = write_fan(busy.corner, fans_.subspan(busy.first_fan, busy.fan_count));
      std::uint32_t at = busy.first_box;
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

  void write_fan_runs() {
    if (!has_fan_runs()) return;
    const auto runs = layout_.records<fdcg_fan_run>(file_, FDCG_SECTION_FAN_RUNS);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const FanRun& run = graph_.fan_runs[i];
      const auto busy = std::lower_bound(busy_corners_.begin(), busy_corners_.end(), run.vertex,
                                         [](const fdcg_busy_corner& b, std::uint32_t corner) { return b.corner < corner; });
      runs[i] = {run.first, run.count, static_cast<std::uint32_t>(busy - busy_corners_.begin()),
                 is_near_inexact(*busy) ? FDCG_RUN_INEXACT : 0};
    }
  }

  // Whether a node at a corner, or one across a concave side of such a node, is inexact: these may be entered beside the way.
  [[nodiscard]] bool is_near_inexact(const fdcg_busy_corner& busy) const {
    const auto is_inexact = [&](std::uint32_t n) { return (node(n).flags & FDCG_NODE_INEXACT) != 0; };
    for (const std::uint32_t entry : fans_.subspan(busy.first_fan, busy.fan_count)) {
      const fdcg_connection& connection = connections_[entry >> 1];
      if ((entry & 1u) != 0 && connection.type == FDCG_BOUNDARY) continue;
      const std::uint32_t first = graph_.first_side[connection.node] + connection.side[0];
      const std::uint32_t n = (entry & 1u) == 0 ? connection.node : graph_.node(graph_.twin[first]);
      if (is_inexact(n)) return true;
      for (std::uint32_t side = graph_.first_side[n]; side < graph_.first_side[n + 1]; ++side) {
        const bool is_concave = connections_[graph_.connection[side] >> 1].type == FDCG_CONCAVE;
        if (is_concave && is_inexact(graph_.node(graph_.twin[side]))) return true;
      }
    }
    return false;
  }

  [[nodiscard]] Vec3 normal_of(std::uint32_t n) const {
    const auto& normal = node(n).plane.normal;
    return {normal[0], normal[1], normal[2]};
  }

  // The direction in which a side leaves its corner.
  [[nodiscard]] Vec3 leaving(std::uint32_t side) const {
    const std::uint32_t link = graph_.connection[side];
    Vec3 along;
    if (input_.with_planes) {
      const Real(&e)[3] = edges_[link >> 1].direction;  // written with the nodes
      along = {e[0], e[1], e[2]};
    } else {
      const fdcg::Vec3<Real> e = edge_of(side).direction;
      along = {e.x, e.y, e.z};
    }
    return (link & 1u) == 0 ? along : -along;
  }

  void write_source_map() {
    const std::span<std::uint32_t> map = layout_.records<std::uint32_t>(file_, FDCG_SECTION_SOURCE_MAP);
    static_assert(kNone == FDCG_NONE);
    std::copy_n(input_.node_of_source.begin(), map.size(), map.begin());
  }

  void write_materials() {
    const auto of_node = layout_.records<std::uint16_t>(file_, FDCG_SECTION_MATERIALS);
    for (std::uint32_t face = 0; !of_node.empty() && face < graph_.node_of_face.size(); ++face)
      of_node[graph_.node_of_face[face]] = input_.material_of_face[face];
    std::transform(input_.materials.begin(), input_.materials.end(),
                   layout_.records<fdcg_material_record>(file_, FDCG_SECTION_MATERIAL_NAMES).begin(), material_record);
  }

  void write_visual() {
    const auto write = [this](const auto& records, fdcg_visual_section_id id) {
      using Record = typename std::decay_t<decltype(records)>::value_type;
      std::copy(records.begin(), records.end(), layout_.records<Record>(file_, section_id(id)).begin());
    };
    if (input_.visual.is_empty()) return;
    write(input_.visual.vertices, FDCG_SECTION_VISUAL_VERTICES);
    write(input_.visual.indices, FDCG_SECTION_VISUAL_INDICES);
    write(input_.visual.nodes, FDCG_SECTION_VISUAL_NODES);
    write(input_.visual.materials, FDCG_SECTION_VISUAL_MATERIALS);
  }

  void write_heights() {
    const HeightSections& heights = input_.heights;
    if (heights.is_empty()) return;
    const auto places = layout_.records<fdcg_node_place>(file_, section_id(FDCG_SECTION_NODE_PLACES));
    for (std::size_t face = 0; face < heights.place_of_face.size(); ++face)
      places[graph_.node_of_face[face]] = heights.place_of_face[face];
    std::copy(heights.maps.begin(), heights.maps.end(),
              layout_.records<fdcg_height_map>(file_, section_id(FDCG_SECTION_HEIGHT_MAPS)).begin());
    std::copy(heights.texels.begin(), heights.texels.end(),
              layout_.records<std::int16_t>(file_, section_id(FDCG_SECTION_HEIGHT_TEXELS)).begin());
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
    header_.fan_count = fan_entries_;
    header_.busy_count = static_cast<std::uint32_t>(busy_corners_.size());
    header_.node_bytes = blocks_.uniform_bytes();
    header_.flags = input_.with_planes ? FDCG_STORED_PLANES : 0;
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
  Blocks blocks_;
  std::vector<fdcg_busy_corner> busy_corners_;
  std::uint32_t fan_boxes_ = 0;
  std::uint32_t fan_entries_ = 0;  // of the busy corners
  std::span<std::byte> file_;
  std::span<std::byte> node_blocks_;  // the section's records, of whatever size, as bytes: only its start is used
  std::span<typename Records::Edge> edges_;
  std::span<fdcg_connection> connections_;
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
