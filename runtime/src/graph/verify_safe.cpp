// SPDX-License-Identifier: Apache-2.0
// The level SAFE: one pass over the file, records of a chunk while its bytes are in the cache. A record is judged without a
// branch, and by lookups that mostly stay near it: a side's connection, from which all follows that the step takes from one
// record to another:
//
//  - a side that its connection runs along is the one that the connection names, and there are as many such sides as
//    connections: so each connection has a first side, and node 1 across it exactly where it is no boundary;
//  - a side that its connection runs against has the connection's first node across;
//  - what is across is a node, and the side there that the connection names is one of its sides.
#include <string.h>

#include "base/config.hpp"
#include "graph/checksum.hpp"
#include "graph/connection_words.hpp"
#include "graph/safe_records.hpp"
#include "graph/unit_check.hpp"
#include "graph/verify.hpp"
#include "graph/wide_check.hpp"

namespace fdcg {
namespace {

// An edge and its face's normal give a Voronoi plane where they are far enough from parallel: the compiler joins no face to
// an edge that leaves its plane by more than 45 degrees.
template <class Real>
[[gnu::always_inline]] inline bool is_across(Vec3<Real> along, Vec3<Real> normal) {
  constexpr Real kLeastSquaredSine = Real(1) / 64;
  const Vec3<Real> out = cross(along, normal);
  const Real squared = dot(along, along);
  return (squared >= TinyEdge<Real>::kSquare) & (dot(out, out) >= kLeastSquaredSine * squared);
}

constexpr uint32_t kLineBytes = 64;  // of most machines' caches

template <class Real>
class SafeChunk : SafeRecords<Real> {
 public:
  SafeChunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error)
      : SafeRecords<Real>(graph, chunk, part, error), largest_offset_(static_cast<Real>(4 * graph.header->extent)) {}

  fdcg_status run() {
    if (header_.connection_count == 0 || header_.corner_count == 0)
      return refuse_record(error_, "header.connection_count", header_.connection_count, "no writer leaves all of them out");
    checksums();
    fdcg_status status = are_nodes_sound() ? FDCG_OK : refuse_nodes();
    if (status == FDCG_OK) status = connections();
    if (status == FDCG_OK && records_.edges() != nullptr) status = edges();
    if (status == FDCG_OK) status = corners();
    return status == FDCG_OK ? this->other_records() : status;
  }

 private:
  using Base = SafeRecords<Real>;
  using Base::node_section_bytes_, Base::uniform_sides_;
  using Base::records_, Base::header_, Base::raw_, Base::chunk_, Base::part_, Base::error_;
  using Base::side_count_of;
  using typename Base::Node;

  [[gnu::noinline]] void checksums() {
    const fdcg_section* const sections = section_table(header_);
    const auto* const file = reinterpret_cast<const unsigned char*>(&header_);
    BlockRange ranges[FDCG_MOST_SECTIONS];
    for (uint32_t i = 0; i < header_.section_count; ++i) {
      const uint64_t bytes = section_bytes(header_, i), blocks = checksum_blocks(bytes);
      ranges[i] = {file + sections[i].offset, bytes, chunk_.first_of(blocks), chunk_.end_of(blocks), &part_->sums[i]};
    }
    add_checksums(ranges, header_.section_count);
  }

  bool are_nodes_sound() const {
#if FDCG_HAS_WIDE_CHECKS
    if (uniform_sides_ == 3 && records_.has_planes() && has_avx2() && are_triangles_sound()) return true;
#endif
    if (uniform_sides_ == 3) return records_.has_planes() ? are_sound<3, true>() : are_sound<3, false>();
    return records_.has_planes() ? are_sound<0, true>() : are_sound<0, false>();
  }

  // Without a branch that a sound file takes now and then. False: something is wrong, and refuse_nodes() says what. kSides: of
  // every node, in a block of a size that is known here; 0: any.
  template <uint32_t kSides, bool kHasPlanes>
  [[gnu::noinline]] bool are_sound() const {
    const uint64_t first_node = chunk_.first_of(header_.node_count), end = chunk_.end_of(header_.node_count);
    uint64_t at = kSides != 0 ? first_node * node_bytes<Real>(kSides, kHasPlanes) : offset_of(first_node);
    const uint64_t begin = at, stop = kSides != 0 ? end * node_bytes<Real>(kSides, kHasPlanes) : offset_of(end);
    const uint64_t ahead = stop > begin ? stop - begin : 0;  // to the next chunk; of damaged offsets anything
    uint32_t sides = 0, seconds = 0;
    const Limits limits = this->limits();
    UnitCheck<Real> check(-largest_offset_, largest_offset_);
    if (first_node == 0 && begin != 0) return false;
    for (uint64_t n = first_node; n < end; ++n) {
      if (kSides == 0 && !holds_node(at)) return false;
      const unsigned char* const block = records_.nodes() + at;
      const auto& node = *reinterpret_cast<const Node*>(block);
      const uint32_t count = kSides != 0 ? kSides : node.side_count;
      const uint32_t bytes = node_bytes<Real>(count, kHasPlanes);
      at += bytes;
      if (kSides == 0 && (!is_side_count(count) || at != offset_of(n + 1) || at > node_section_bytes_)) return false;
      for (uint32_t line = 0; line < bytes; line += kLineBytes)
        prefetch(block + ahead + line);
      if (node.side_count != count || (node.flags & ~uint32_t{FDCG_NODE_INEXACT}) != 0) return false;
      const auto* const side_records = reinterpret_cast<const fdcg_side*>(block + offsetof(Node, sides));
#pragma GCC unroll 3
      for (uint32_t k = 0; k < count; ++k) {
        if (fault_of_side<kSides != 0>(static_cast<uint32_t>(n), k, side_records[k], limits) != nullptr) return false;
        seconds += side_records[k].link & 1;
      }
      sides += count;
      const Real* const face = node.plane.normal;
      if constexpr (kHasPlanes) {
        const Real* const planes = reinterpret_cast<const Real*>(block + planes_at<Real>(count));
        check.look_at(face, planes);
        for (uint32_t k = 1; k < count; k += 2)
          check.look_at(planes + 4 * k, planes + 4 * (k + 1 < count ? k + 1 : k));
      } else {
        check.look_at(face, face);
        bool has_planes = true;
        for (uint32_t k = 0; k < count; ++k)
          has_planes &= has_derived_plane(node, side_records[k], side_records[k + 1 < count ? k + 1 : 0]);
        if (!has_planes) return false;
      }
    }
    if (!check.holds()) return false;
    part_->sides += sides;
    part_->first_sides += sides - seconds;
    return true;
  }

#if FDCG_HAS_WIDE_CHECKS
  // are_sound<3, true>() in vectors of 32 bytes. False: that one is to say what is wrong.
  [[FDCG_AVX2, gnu::noinline]] bool are_triangles_sound() const {
    constexpr uint32_t kBytes = node_bytes<Real>(3, true);
    const uint64_t first = chunk_.first_of(header_.node_count), end = chunk_.end_of(header_.node_count);
    const uint64_t ahead = (end - first) * kBytes;
    const Limits limits = this->limits();
    TriangleCheck sides(static_cast<uint32_t>(first), limits.connections, limits.connection_count, limits.corner_count,
                        limits.node_count);
    WideUnitCheck<Real> planes(-largest_offset_, largest_offset_);
    uint32_t seconds = 0;
    const unsigned char* block = records_.nodes() + first * kBytes;
    for (uint64_t n = first; n < end; ++n, block += kBytes) {
#pragma GCC unroll 3
      for (uint32_t line = 0; line < kBytes; line += kLineBytes)
        prefetch(block + ahead + line);
      const auto& node = *reinterpret_cast<const Node*>(block);
      if (node.side_count != 3 || (node.flags & ~uint32_t{FDCG_NODE_INEXACT}) != 0) return false;
      if (__builtin_expect(!sides.look_at(node.sides), false)) {
        for (uint32_t k = 0; k < 3; ++k) {
          if (fault_of_side<true>(static_cast<uint32_t>(n), k, node.sides[k], limits) != nullptr) return false;
          seconds += node.sides[k].link & 1;
        }
      }
      const Real* const own = reinterpret_cast<const Real*>(block + planes_at<Real>(3));
      planes.look_at(node.plane.normal, own, own + 4, own + 8);
    }
    if (!sides.holds() || !planes.holds()) return false;
    part_->sides += static_cast<uint32_t>(3 * (end - first));
    part_->first_sides += static_cast<uint32_t>(3 * (end - first)) - seconds - sides.seconds();
    return true;
  }
#endif

  // Where node n's block starts in its section, which ends where one more would start. Of blocks that differ: as the file says.
  [[nodiscard]] uint64_t offset_of(uint64_t n) const {
    if (uniform_sides_ != 0) return n * records_.block_bytes();
    return n == header_.node_count ? node_section_bytes_ : records_.node_offsets()[n] * uint64_t{sizeof(Real)};
  }
  [[nodiscard]] bool holds_node(uint64_t at) const {
    return at <= node_section_bytes_ && node_section_bytes_ - at >= sizeof(Node);
  }
  [[nodiscard]] bool is_side_count(uint32_t count) const {
    return uniform_sides_ != 0 ? count == uniform_sides_ : count >= 3 && count <= FDCG_MAX_SIDES;
  }

  // A plane that the step will derive. Corners of damaged files may be anything.
  bool has_derived_plane(const Node& node, const fdcg_side& side, const fdcg_side& next) const {
    const uint32_t c = side.link >> 1;
    return is_across(along_of(side, next, c < header_.connection_count ? c : 0), vec(node.plane.normal));
  }

  // Where are_sound() has found a fault: the first node that is wrong, by name.
  [[gnu::cold, gnu::noinline]] fdcg_status refuse_nodes() {
    const uint64_t first = chunk_.first_of(header_.node_count);
#if FDCG_WITH_MESSAGES
    const uint64_t end = chunk_.end_of(header_.node_count);
    for (uint64_t n = first; n < end; ++n) {
      if (const char* const what = fault_of_node(static_cast<uint32_t>(n)); what != nullptr)
        return refuse_record(error_, "node", n, what);
    }
#endif
    return refuse_record(error_, "node", first, "is wrong, or one after it");
  }

  [[nodiscard]] const char* fault_of_node(uint32_t n) const {
    const uint64_t at = offset_of(n);
    if (!holds_node(at)) return "its block is out of range";
    const unsigned char* const block = records_.nodes() + at;
    const auto& node = *reinterpret_cast<const Node*>(block);
    if (!is_side_count(node.side_count)) return "has too few sides or too many";
    const uint64_t end = at + node_bytes<Real>(node.side_count, records_.has_planes());
    if (end != offset_of(n + uint64_t{1}) || end > node_section_bytes_ || (n == 0 && at != 0))
      return "its block does not end where the next one starts";
    if ((node.flags & ~FDCG_NODE_INEXACT) != 0) return "unknown flags";
    const auto is_plane = [this](const Real* plane) {
      UnitCheck<Real> check(-largest_offset_, largest_offset_);
      check.look_at(plane, plane);
      return check.holds();
    };
    if (!is_plane(node.plane.normal)) return "its normal is not of unit length, or its plane lies outside the object";
    const Real* const planes = reinterpret_cast<const Real*>(block + planes_at<Real>(node.side_count));
    const auto* const sides = reinterpret_cast<const fdcg_side*>(block + offsetof(Node, sides));
    for (uint32_t k = 0; k < node.side_count; ++k) {
      if (const char* const what = fault_of_side<false>(n, k, sides[k], limits()); what != nullptr) return what;
      const bool has_plane = records_.has_planes()
                                 ? is_plane(planes + 4 * k)
                                 : has_derived_plane(node, sides[k], sides[k + 1 < node.side_count ? k + 1 : 0]);
      if (!has_plane) return "Voronoi plane out of range";
    }
    return nullptr;
  }

  // What sides are judged by, in one place: a compiler would read it from the header again and again.
  struct Limits {
    const fdcg_connection* connections;
    uint32_t connection_count, corner_count, node_count;
  };

  [[nodiscard]] Limits limits() const {
    return {records_.connections(), header_.connection_count, header_.corner_count, header_.node_count};
  }

  // kIsUniform: all nodes have as many sides, and connections() sees to those across.
  template <bool kIsUniform>
  [[nodiscard]] const char* fault_of_side(uint32_t n, uint32_t k, const fdcg_side& side, const Limits& limits) const {
    const uint64_t link = side.link >> 1, which = side.link & 1;
    if (link >= limits.connection_count) return "connection out of range";
    if (side.corner >= limits.corner_count) return "corner out of range";
    const uint32_t nodes = limits.node_count, across = side.across;
    const bool is_nowhere = across >= nodes && across != FDCG_NONE;
    const fdcg_connection& connection = limits.connections[link];
    // The connection's, by which of its sides this one is: not to be predicted, so without a branch.
    const uint32_t first = __builtin_expect_with_probability(which != 0, 1, 0.5) ? across : n;
    if (connection.node != first || connection.side[which] != k)
      return is_nowhere ? "neighbour out of range" : "its connection does not own it";
    const bool is_boundary = __builtin_expect(connection.type == FDCG_BOUNDARY, false);
    if (is_boundary ? across != FDCG_NONE : across >= nodes)
      return is_nowhere ? "neighbour out of range" : "a connection's type does not fit its nodes";
    if (!kIsUniform && across < nodes && connection.side[1 - which] >= side_count_of(across))
      return "its neighbour has no such side";
    return nullptr;
  }

  // The edge vector of a side, of whatever length; `c`: its connection, in range.
  Vec3<Real> along_of(const fdcg_side& side, const fdcg_side& next, uint32_t c) const {
    if (records_.edges() != nullptr) return vec(records_.edges()[c].direction);
    const auto point = [&](uint32_t v) { return vec(records_.corners()[v < header_.corner_count ? v : 0].point); };
    const Vec3<Real> along = point(next.corner) - point(side.corner);
    return dot(along, along) < TinyEdge<Real>::kSquare ? along * TinyEdge<Real>::kScale : along;
  }

  static ConnectionWords words_of(const fdcg_connection* connections, uint64_t count) {
#if FDCG_HAS_WIDE_CHECKS
    if (has_avx2()) return look_at_words_wide(connections, count);
#endif
    return look_at_words(connections, count);
  }

  [[gnu::noinline]] fdcg_status connections() {
    const uint64_t first = chunk_.first_of(header_.connection_count), end = chunk_.end_of(header_.connection_count);
    const uint64_t most_sides = uniform_sides_ == 3 ? 3 : kByte + 1;
    // Of a byte that is at most 2 or 3: higher bits; and both of the lower two.
    constexpr uint64_t kHigher = 0xFC, kBoth = 1;
    static_assert(FDCG_BOUNDARY == 3 && FDCG_FLAT_ANGLE == 2);
    const uint64_t side1 = uniform_sides_ == 3 ? 1 : 0;
    const uint64_t higher = kHigher << kTypeAt | kHigher << kFlatnessAt | side1 * (kHigher << kSide1At);
    const uint64_t both = kBoth << kFlatnessAt | side1 * (kBoth << kSide1At);
    const ConnectionWords words = words_of(records_.connections() + first, end - first);
    if (((words.any & higher) | (words.pairs & both)) != 0) {
      return for_all(first, end, "connection", error_, [&](uint32_t c, auto* faults) {
        const fdcg_connection& connection = records_.connections()[c];
        faults->note((connection.type > FDCG_BOUNDARY) | (connection.flatness > FDCG_FLAT_ANGLE), "unknown type or flatness");
        faults->note(connection.side[1] >= most_sides, "its second node has no such side");
      });
    }
    for (uint32_t type = 0; type < 4; ++type)
      part_->types[type] += words.types[type];
    return FDCG_OK;
  }

  [[gnu::noinline]] fdcg_status edges() {
    const uint64_t first = chunk_.first_of(header_.connection_count), end = chunk_.end_of(header_.connection_count);
    const auto numbers = [this](uint64_t c) { return static_cast<const Real*>(records_.edges()[c].direction); };
#if FDCG_HAS_WIDE_CHECKS
    if (has_avx2() && are_units(numbers(first), end - first, Real(0), largest_offset_)) return FDCG_OK;
#endif
    UnitCheck<Real> check(0, largest_offset_);
    for (uint64_t c = first; c + 1 < end; c += 2) {
      prefetch(numbers(c + (end - first)));
      check.look_at(numbers(c), numbers(c + 1));
    }
    if (first < end) check.look_at(numbers(end - 1), numbers(end - 1));
    if (check.holds()) return FDCG_OK;
    return for_all(first, end, "edge", error_, [&](uint32_t c, auto* faults) {
      UnitCheck<Real> one(0, largest_offset_);
      one.look_at(numbers(c), numbers(c));
      faults->note(!one.holds(), "its direction is not of unit length, or it is longer than the object, or not at all");
    });
  }

  struct Bounds {
    double low[3], high[3];
  };

  [[nodiscard]] const char* fault_of_corner(uint32_t v, const Bounds& bounds) const {
    const auto& corner = records_.corners()[v];
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      if (!(double{corner.point[k]} >= bounds.low[k]) || !(double{corner.point[k]} <= bounds.high[k]))
        return "outside the bounds";
    }
    const uint32_t count = corner.fan & ~FDCG_CORNER_OPEN;
    if (__builtin_expect(count == 0, false)) {
      ++part_->busy_corners;
      const bool is_busy = corner.first < header_.busy_count && raw_.busy_corners[corner.first].corner == v;
      return is_busy && corner.side == 0 ? nullptr : "no busy corner of this number";
    }
    if (count < 2 || count > FDCG_BUSY_FAN || count > header_.largest_fan) return "fan out of range";
    const bool is_node = corner.first < header_.node_count;
    return is_node && corner.side < side_count_of(corner.first) ? nullptr : "fan does not start here";
  }

#if FDCG_HAS_WIDE_CHECKS
  // All of the chunk's, of a graph of triangles.
  [[FDCG_AVX2, gnu::noinline]] bool are_corners_sound(uint64_t first, uint64_t end, const Bounds& bounds) const {
    const uint32_t largest_fan = header_.largest_fan < FDCG_BUSY_FAN ? header_.largest_fan : FDCG_BUSY_FAN;
    const uint32_t nodes = header_.node_count;
    const auto* const corners = records_.corners();
    WidePointCheck points(bounds.low, bounds.high);
    for (uint64_t v = first; v < end; ++v) {
      const auto& corner = corners[v];
      prefetch(&corner + (end - first));
      points.look_at(corner.point);
      const uint32_t count = corner.fan & ~FDCG_CORNER_OPEN;
      const bool is_usual = count >= 2 && count <= largest_fan && corner.first < nodes && corner.side < 3;
      if (__builtin_expect(!is_usual, false) && fault_of_corner(static_cast<uint32_t>(v), bounds) != nullptr) return false;
    }
    return points.holds();
  }
#endif

  [[gnu::noinline]] fdcg_status corners() {
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      bounds.low[k] = header_.bounds_min[k] > -header_.extent ? header_.bounds_min[k] : -header_.extent;
      bounds.high[k] = header_.bounds_max[k] < header_.extent ? header_.bounds_max[k] : header_.extent;
    }
    const uint64_t first = chunk_.first_of(header_.corner_count), end = chunk_.end_of(header_.corner_count);
#if FDCG_HAS_WIDE_CHECKS
    if (uniform_sides_ == 3 && has_avx2() && are_corners_sound(first, end, bounds)) return FDCG_OK;
#endif
    for (uint64_t v = first; v < end; ++v) {
      prefetch(records_.corners() + v + (end - first));
      if (const char* const what = fault_of_corner(static_cast<uint32_t>(v), bounds); what != nullptr)
        return refuse_record(error_, "corner", v, what);
    }
    return FDCG_OK;
  }

  Real largest_offset_;
};

}  // namespace

fdcg_status verify_safe_chunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error) {
  return with_real_of(*graph.header, [&](auto real) { return SafeChunk<decltype(real)>(graph, chunk, part, error).run(); });
}

}  // namespace fdcg
