// SPDX-License-Identifier: Apache-2.0
#include "validate/t_junctions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
Vec3 least(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3 most(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

struct Box {
  Vec3 low, high;

  void add(const Vec3& p) {
    low = least(low, p);
    high = most(high, p);
  }
};

// A boundary edge, prepared for the search of vertices near it.
struct Segment {
  Vec3 p, q;
  double reach;  // how far from it a vertex may lie
  double slack;  // bound on the rounding error of a distance computed here

  // True if no point of the box is within `reach` plus `slack` of the segment.
  [[nodiscard]] bool misses(const Box& box) const {
    const double margin = reach + slack;
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; ++k) {
      const double from = component(p, k), way = component(q, k) - from;
      const double low = component(box.low, k) - margin - from, high = component(box.high, k) + margin - from;
      if (way == 0) {
        if (low > 0 || high < 0) return true;
        continue;
      }
      const double a = low / way, b = high / way;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter > leave;
  }
  // True if every point of the box is within reach of one end: at the file's precision the same vertex.
  [[nodiscard]] bool has_at_end(const Box& box) const { return covers(p, box) || covers(q, box); }

  [[nodiscard]] bool has_inside(const Vec3& v) const {
    const Vec3 way = q - p, offset = v - p;
    const double long_way = std::hypot(way.x, way.y, way.z);
    if (!(long_way > 0)) return false;
    const Vec3 along = (1 / long_way) * way;
    const double at = dot(offset, along);
    if (!(at > 0 && at < long_way) || is_within_reach(v, p) || is_within_reach(v, q)) return false;
    const Vec3 off = offset - at * along;
    const double distance = std::hypot(off.x, off.y, off.z);
    return distance <= reach || (distance <= reach + slack && exact::collinear(p, q, v));
  }

 private:
  [[nodiscard]] bool is_within_reach(const Vec3& v, const Vec3& end) const {
    return std::hypot(v.x - end.x, v.y - end.y, v.z - end.z) <= reach;
  }
  [[nodiscard]] bool covers(const Vec3& end, const Box& box) const {
    const Vec3 far = most(end - box.low, box.high - end);
    return std::hypot(far.x, far.y, far.z) <= reach;
  }
};

// The cells of a grid over a box that segments pass through.
class Marks {
 public:
  explicit Marks(const Box& box) : box_(box), is_marked_(std::size_t{kCells} * kCells * kCells, false) {}

  void mark(const Segment& s) {
    if (is_all_marked_) return;
    int pieces = 1;
    for (int k = 0; k < 3; ++k)
      pieces = std::max(pieces, std::abs(cell(component(s.q, k), k) - cell(component(s.p, k), k)) + 1);
    const double margin = 2 * (s.reach + s.slack);
    for (int i = 0; i < pieces; ++i) {
      const Vec3 a = at(s, i, pieces), b = at(s, i + 1, pieces);
      mark(least(a, b) - Vec3{margin, margin, margin}, most(a, b) + Vec3{margin, margin, margin});
    }
  }
  [[nodiscard]] bool has(const Vec3& p) const {
    return is_all_marked_ || is_marked_[index(cell(p.x, 0), cell(p.y, 1), cell(p.z, 2))];
  }

 private:
  static constexpr int kCells = 64;  // a quarter of a million bits: they stay in the cache

  static Vec3 at(const Segment& s, int i, int pieces) {
    const double t = static_cast<double>(i) / pieces;
    return (1 - t) * s.p + t * s.q;
  }
  [[nodiscard]] int cell(double x, int k) const {
    const double extent = component(box_.high, k) - component(box_.low, k);
    const double place = extent > 0 ? (x - component(box_.low, k)) / extent * kCells : 0;
    return static_cast<int>(std::clamp(place, 0.0, kCells - 1.0));
  }
  static std::size_t index(int x, int y, int z) { return (static_cast<std::size_t>(z) * kCells + y) * kCells + x; }
  void mark(const Vec3& low, const Vec3& high) {
    // A segment of a flat part covers a column of cells, one with a reach of a tenth of the part a whole block: the grid is
    // then of no use (a small part far from the origin, in floats), and filling it for every edge would take hours.
    constexpr int kMostCells = 16 * kCells;
    const int x0 = cell(low.x, 0), x1 = cell(high.x, 0), y0 = cell(low.y, 1), y1 = cell(high.y, 1);
    const int z0 = cell(low.z, 2), z1 = cell(high.z, 2);
    is_all_marked_ = is_all_marked_ || (x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1) > kMostCells;
    if (is_all_marked_) return;
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          is_marked_[index(x, y, z)] = true;
  }

  Box box_;
  std::vector<bool> is_marked_;
  bool is_all_marked_ = false;
};

// A bounding volume hierarchy of vertices, from which found vertices are removed.
class VertexTree {
 public:
  VertexTree(const std::vector<Vec3>& points, std::vector<std::uint32_t> vertices)
      : points_(points), vertices_(std::move(vertices)) {
    if (!vertices_.empty()) build(0, static_cast<std::uint32_t>(vertices_.size()));
  }

  // Calls wants(vertex) for the vertices inside the segment, and removes those for which it returns true.
  template <class Wants>
  void take(const Segment& segment, const Wants& wants) {
    if (!vertices_.empty()) take(0, segment, wants);
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;
  struct Node {
    Box box;
    std::uint32_t first = 0, end = 0;  // of vertices_; the remaining ones come first in a leaf
    std::uint32_t right = 0;           // the second child; the first follows its parent. 0: a leaf
    std::uint32_t left_over = 0;       // remaining vertices below
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t end) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    Box box{points_[vertices_[first]], points_[vertices_[first]]};
    for (std::uint32_t i = first; i < end; ++i)
      box.add(points_[vertices_[i]]);
    nodes_.push_back({box, first, end, 0, end - first});
    if (end - first <= kLeaf) return number;
    const int axis = dominant_axis(box.high - box.low);
    const std::uint32_t middle = first + (end - first) / 2;
    const auto begin = vertices_.begin();
    std::nth_element(begin + first, begin + middle, begin + end, [&](std::uint32_t v, std::uint32_t w) {
      return component(points_[v], axis) < component(points_[w], axis);
    });
    build(first, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[number].right = right;
    return number;
  }

  template <class Wants>
  std::uint32_t take(std::uint32_t number, const Segment& segment, const Wants& wants) {
    Node& node = nodes_[number];
    if (node.left_over == 0 || segment.misses(node.box) || segment.has_at_end(node.box)) return 0;
    std::uint32_t taken = 0;
    if (node.right != 0) {
      taken = take(number + 1, segment, wants) + take(node.right, segment, wants);
    } else {
      for (std::uint32_t i = node.first; i < node.first + node.left_over - taken;) {
        const std::uint32_t v = vertices_[i];
        if (segment.has_inside(points_[v]) && wants(v)) {
          ++taken;
          std::swap(vertices_[i], vertices_[node.first + node.left_over - taken]);
        } else {
          ++i;
        }
      }
    }
    node.left_over -= taken;
    return taken;
  }

  const std::vector<Vec3>& points_;
  std::vector<std::uint32_t> vertices_;
  std::vector<Node> nodes_;
};

class Finder {
 public:
  // `points` are the mesh's, perhaps scaled.
  Finder(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states, const std::vector<Vec3>& points,
         const Quantum& quantum)
      : mesh_(mesh), topology_(topology), states_(states), points_(points), quantum_(quantum) {}

  std::vector<TJunction> run() {
    std::vector<TJunction> found;
    for (std::uint32_t h = 0; h < topology_.twin.size(); ++h) {
      if (topology_.twin[h] == Topology::kBoundary && is_finite(start(h)) && is_finite(end(h))) edges_.push_back(h);
    }
    if (edges_.empty()) return found;
    VertexTree tree(points_, vertices_near_edges());
    for (const std::uint32_t h : edges_) {
      tree.take(segment(h), [&](std::uint32_t v) {
        if (is_corner_of(v, topology_.face(HalfedgeId{h}))) return false;
        found.push_back({VertexId{v}, HalfedgeId{h}});
        return true;
      });
    }
    std::sort(found.begin(), found.end(), [](const TJunction& a, const TJunction& b) { return a.vertex < b.vertex; });
    return found;
  }

 private:
  [[nodiscard]] const Vec3& start(std::uint32_t h) const { return points_[+mesh_.corners[h]]; }
  [[nodiscard]] const Vec3& end(std::uint32_t h) const {
    return points_[+mesh_.corners[+next(mesh_, topology_.face(HalfedgeId{h}), HalfedgeId{h})]];
  }
  [[nodiscard]] Segment segment(std::uint32_t h) const {
    const Vec3 &p = start(h), &q = end(h);
    constexpr double kRounding = 0x1p-48;  // of the coordinates: a dozen operations with an error of 2^-53 each
    return {p, q, kQuantumReach * std::max(quantum_.at(p), quantum_.at(q)),
            kRounding * std::max(largest_component(p), largest_component(q))};
  }
  [[nodiscard]] bool is_corner_of(std::uint32_t v, FaceId f) const {
    const auto corners = mesh_.corners.begin();
    const auto stop = corners + mesh_.face_first[+f + 1];
    return std::find(corners + mesh_.face_first[+f], stop, VertexId{v}) != stop;
  }

  // The vertices of sound faces in cells that an edge passes through: usually few.
  [[nodiscard]] std::vector<std::uint32_t> vertices_near_edges() const {
    Box box{start(edges_[0]), start(edges_[0])};
    for (const std::uint32_t h : edges_) {
      box.add(start(h));
      box.add(end(h));
    }
    Marks marks(box);
    for (const std::uint32_t h : edges_)
      marks.mark(segment(h));
    std::vector<bool> is_used(mesh_.points.size(), false);
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (states_[f] != FaceState::sound) continue;
      for (std::uint32_t h = mesh_.face_first[f]; h < mesh_.face_first[f + 1]; ++h)
        is_used[+mesh_.corners[h]] = true;
    }
    std::vector<std::uint32_t> near;
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
      const Vec3& p = points_[v];
      if (is_used[v] && is_finite(p) && marks.has(p)) near.push_back(v);
    }
    return near;
  }

  const Mesh& mesh_;
  const Topology& topology_;
  const std::vector<FaceState>& states_;
  const std::vector<Vec3>& points_;
  const Quantum& quantum_;
  std::vector<std::uint32_t> edges_;  // the boundary half-edges between finite vertices
};

}  // namespace

std::vector<TJunction> find_t_junctions(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
                                        const Quantum& quantum) {
  if (std::find(topology.twin.begin(), topology.twin.end(), Topology::kBoundary) == topology.twin.end()) return {};
  double size = 0;
  for (const Vec3& p : mesh.points) {
    if (is_finite(p)) size = std::max(size, largest_component(p));
  }
  constexpr double kLeast = 1e-290, kMost = 1e300;  // differences, their reciprocals and their sums stay in range
  if (!(size > 0) || (size > kLeast && size < kMost)) return Finder(mesh, topology, states, mesh.points, quantum).run();
  const int exponent = -std::ilogb(size);
  const auto scaled = [&](const Vec3& p) {
    return Vec3{std::scalbn(p.x, exponent), std::scalbn(p.y, exponent), std::scalbn(p.z, exponent)};
  };
  std::vector<Vec3> points;
  for (const Vec3& p : mesh.points)
    points.push_back(scaled(p));
  const Quantum scaled_quantum{quantum.relative, std::scalbn(quantum.absolute, exponent), quantum.local_relative,
                               scaled(quantum.origin)};
  return Finder(mesh, topology, states, points, scaled_quantum).run();
}

}  // namespace fdcg::bake
