// SPDX-License-Identifier: Apache-2.0
#include "topology/weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <future>
#include <limits>

#include "base/parallel.hpp"

namespace fdcg::bake {
namespace {

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// The range of the finite values on one axis.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double x) {
    // Comparisons with NaN are false; infinities are kept out by the finite bounds.
    constexpr double kLargest = std::numeric_limits<double>::max();
    if (x < low && x >= -kLargest) low = x;
    if (x > high && x <= kLargest) high = x;
  }
  [[nodiscard]] double origin() const {
    if (!(low <= high)) return 0;
    const double centre = low / 2 + high / 2;
    const double half = high / 2 - low / 2;
    return centre != 0 && std::abs(centre) >= 3 * half ? centre : 0;
  }
};

Vec3 choose_origin(const std::vector<Vec3>& points) {
  Range x, y, z;
  for (const Vec3& p : points) {
    x.add(p.x);
    y.add(p.y);
    z.add(p.z);
  }
  return {x.origin(), y.origin(), z.origin()};
}

double as_stored(double x, Precision precision) {
  // Adding zero turns -0 into 0, so that equal coordinates have equal bits.
  if (precision == Precision::f64) return x + 0.0;
  // Out of a float's range the conversion is undefined in C++: such a coordinate becomes an infinity, which validate reports.
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (x > kLargest * (1 + 0x1p-25)) return std::numeric_limits<double>::infinity();
  if (x < -kLargest * (1 + 0x1p-25)) return -std::numeric_limits<double>::infinity();
  return static_cast<double>(static_cast<float>(x)) + 0.0;
}

// The soup's points in the local frame as they will be stored, computed where they are used: a copy of all of them would cost
// more than the arithmetic.
struct LocalPoints {
  const std::vector<Vec3>& source;
  Vec3 origin;
  Precision precision;

  [[nodiscard]] std::size_t size() const { return source.size(); }
  Vec3 operator[](std::size_t i) const {
    const Vec3& p = source[i];
    return {as_stored(p.x - origin.x, precision), as_stored(p.y - origin.y, precision), as_stored(p.z - origin.z, precision)};
  }
};

// Threads that share the exact weld; each passes over all the points, so that more would save little.
constexpr std::size_t kMostParts = 4;

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  a = (a ^ b) * 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio: odd, bits well spread
  return a ^ (a >> 29);
}

std::uint64_t hash_of(const Vec3& p) {
  const std::uint64_t h = mix(mix(std::bit_cast<std::uint64_t>(p.x), std::rotl(std::bit_cast<std::uint64_t>(p.y), 21)),
                              std::rotl(std::bit_cast<std::uint64_t>(p.z), 42));
  return mix(h, 0);
}

// Open addressing over the numbers of points, which are the keys themselves.
class PointTable {
 public:
  PointTable(const LocalPoints& points, std::size_t expected) : points_(points) { allocate(expected); }

  void prefetch(std::uint64_t hash) const { __builtin_prefetch(&slots_[slot_of(hash)]); }
  [[nodiscard]] std::uint32_t peek(std::uint64_t hash) const { return slots_[slot_of(hash)]; }

  // The point entered that is equal to `p`, or `number`, which is then entered.
  std::uint32_t find_or_enter(const Vec3& p, std::uint64_t hash, std::uint32_t number) {
    for (std::size_t slot = slot_of(hash);; slot = (slot + 1) & mask_) {
      const std::uint32_t there = slots_[slot];
      if (there == kNone) {
        slots_[slot] = number;
        if (++used_ > mask_ / 2) grow();
        return number;
      }
      if (points_[there] == p) return there;
    }
  }

 private:
  [[nodiscard]] std::size_t slot_of(std::uint64_t hash) const { return hash >> shift_; }
  void allocate(std::size_t expected) {
    const std::size_t capacity = std::bit_ceil(std::max<std::size_t>(64, 2 * expected + 2));
    slots_.assign(capacity, kNone);
    mask_ = capacity - 1;
    shift_ = 64 - std::countr_zero(capacity);
  }
  void grow() {
    std::vector<std::uint32_t> old;
    old.swap(slots_);
    allocate(old.size() - 1);
    for (const std::uint32_t number : old) {
      if (number == kNone) continue;
      std::size_t slot = slot_of(hash_of(points_[number]));
      while (slots_[slot] != kNone)
        slot = (slot + 1) & mask_;
      slots_[slot] = number;
    }
  }

  const LocalPoints& points_;
  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0, used_ = 0;
  int shift_ = 0;
};

// The result of the weld: vertices of the mesh in order of appearance, and the vertex of each source point.
struct Welder {
  Mesh& mesh;
  std::vector<std::uint32_t> vertex_of;

  [[nodiscard]] std::uint32_t fresh() const { return static_cast<std::uint32_t>(mesh.points.size()); }
  void put(std::uint32_t source, const Vec3& p, std::uint32_t vertex) {
    vertex_of[source] = vertex;
    if (vertex == mesh.points.size()) {
      mesh.points.push_back(p);
      mesh.source_point.push_back(source);
    } else {
      ++mesh.joined_vertices;
    }
  }
};

// Of the points whose hash falls to `part`: the first one equal to each. `first_equal` has room for all.
void find_first_equal(const LocalPoints& local, std::size_t expected, std::size_t part, std::size_t parts,
                      std::vector<std::uint32_t>& first_equal) {
  // Points are looked up in blocks, so that the misses to memory of a block overlap: first the slots, then the keys.
  constexpr std::size_t kBlock = 32;
  PointTable table(local, expected / parts);
  struct Entry {
    Vec3 point;
    std::uint64_t hash;
    std::uint32_t number;
  };
  std::array<Entry, kBlock> block{};
  for (std::size_t next = 0; next < local.size();) {
    std::size_t count = 0;
    for (; next < local.size() && count < kBlock; ++next) {
      Entry& entry = block[count];
      entry = {local[next], 0, static_cast<std::uint32_t>(next)};
      entry.hash = hash_of(entry.point);
      if (entry.hash % kMostParts % parts != part) continue;
      table.prefetch(entry.hash);
      ++count;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t there = table.peek(block[i].hash);
      if (there != kNone) __builtin_prefetch(&local.source[there]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Entry& entry = block[i];
      first_equal[entry.number] =
          is_finite(entry.point) ? table.find_or_enter(entry.point, entry.hash, entry.number) : entry.number;
    }
  }
}

void weld_exact(const LocalPoints& local, std::size_t expected, unsigned jobs, Welder& out) {
  constexpr std::size_t kWorthThreads = 50'000;  // points, some milliseconds; a thread costs a tenth of one
  const std::size_t parts = local.size() < kWorthThreads ? 1 : std::min<std::size_t>(jobs, kMostParts);
  parallel_for(jobs, parts, 1,
               [&](std::size_t part, std::size_t) { find_first_equal(local, expected, part, parts, out.vertex_of); });
  for (std::uint32_t source = 0; source < local.size(); ++source) {
    const std::uint32_t first = out.vertex_of[source];
    out.put(source, local[source], first == source ? out.fresh() : out.vertex_of[first]);
  }
}

// A grid of the vertices kept so far, with cells slightly wider than the weld distance: all vertices within that distance of a
// point are in the 27 cells around it.
class Grid {
 public:
  Grid(double distance, std::size_t expected)
      // Slightly wider, so that rounding of x / cell never puts two points within the distance two cells apart.
      : distance_(distance), cell_(distance * (1 + 0x1p-20)), heads_(std::bit_ceil(expected + 1), kNone) {}

  // The lowest-numbered kept vertex within the distance of `p`, or kNone.
  [[nodiscard]] std::uint32_t find(const Vec3& p, const std::vector<Vec3>& points) const {
    const Vec3 home = cell_of(p);
    std::uint32_t best = kNone;
    for (int i = 0; i < 27; ++i) {
      const Vec3 cell{home.x + (i % 3 - 1), home.y + (i / 3 % 3 - 1), home.z + (i / 9 - 1)};
      for (std::uint32_t v = heads_[bucket(cell)]; v != kNone; v = next_[v]) {
        const Vec3& q = points[v];
        if (v < best && std::hypot(p.x - q.x, p.y - q.y, p.z - q.z) <= distance_) best = v;
      }
    }
    return best;
  }
  void enter(const Vec3& p, std::uint32_t vertex) {
    std::uint32_t& head = heads_[bucket(cell_of(p))];
    next_.resize(vertex + std::size_t{1}, kNone);
    next_[vertex] = head;
    head = vertex;
  }

 private:
  [[nodiscard]] Vec3 cell_of(const Vec3& p) const {
    return {std::floor(p.x / cell_), std::floor(p.y / cell_), std::floor(p.z / cell_)};
  }
  [[nodiscard]] std::size_t bucket(const Vec3& cell) const {
    return hash_of({cell.x + 0.0, cell.y + 0.0, cell.z + 0.0}) >> 20 & (heads_.size() - 1);
  }

  double distance_, cell_;
  std::vector<std::uint32_t> heads_, next_;
};

void weld_distance(const LocalPoints& local, double distance, Welder& out) {
  Grid grid(distance, local.size());
  for (std::uint32_t source = 0; source < local.size(); ++source) {
    const Vec3 p = local[source];
    std::uint32_t vertex = is_finite(p) ? grid.find(p, out.mesh.points) : kNone;
    if (vertex == kNone) {
      vertex = out.fresh();
      if (is_finite(p)) grid.enter(p, vertex);
    }
    out.put(source, p, vertex);
  }
}

void weld_none(const LocalPoints& local, Welder& out) {
  for (std::uint32_t source = 0; source < local.size(); ++source)
    out.put(source, local[source], source);
}

}  // namespace

Mesh weld_points(const PolygonSoup& soup, const Weld& weld, Precision precision, unsigned jobs) {
  Mesh mesh;
  mesh.origin = choose_origin(soup.points);
  const LocalPoints local{soup.points, mesh.origin, precision};

  // The system zeroes new memory page by page: done concurrently with the weld.
  constexpr std::size_t kWorthThreads = 1'000'000;  // corners
  const auto side = jobs < 2 || soup.corners.size() < kWorthThreads ? std::launch::deferred : std::launch::async;
  std::future<void> faces = std::async(side, [&] {
    mesh.face_first = soup.face_first;
    mesh.corners.resize(soup.corners.size());
  });

  // An STL file repeats each vertex about six times; elsewhere few are repeated.
  const std::size_t expected = soup.format == Format::stl ? local.size() / 5 : local.size();
  Welder out{mesh, std::vector<std::uint32_t>(local.size())};
  mesh.points.reserve(expected);
  mesh.source_point.reserve(expected);
  if (weld.kind == Weld::Kind::none) {
    weld_none(local, out);
  } else if (weld.kind == Weld::Kind::distance && weld.distance > 0) {
    weld_distance(local, weld.distance, out);
  } else {
    weld_exact(local, expected, jobs, out);
  }

  faces.get();
  constexpr std::size_t kCornersAtOnce = 65'536;
  parallel_for(jobs, soup.corners.size(), kCornersAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) {
      const std::uint32_t corner = soup.corners[h];
      mesh.corners[h] = VertexId{corner < out.vertex_of.size() ? out.vertex_of[corner] : kNone};
    }
  });
  return mesh;
}

}  // namespace fdcg::bake
