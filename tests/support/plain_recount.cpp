// SPDX-License-Identifier: Apache-2.0
// A little over 400 lines: a count a rule, read side by side with the catalogue.
#include "plain_recount.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "random.hpp"

namespace fdcg::test {
namespace {

using bake::PolygonSoup;
using bake::Vec3;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Loop = std::vector<std::uint32_t>;
using Real = long double;
using Real3 = std::array<Real, 3>;

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[root(i)] = root(j); }

 private:
  std::vector<std::size_t> parent_;
};

class Counter {
 public:
  Counter(const PolygonSoup& soup, bool seams) : soup_(soup) {
    weld();
    read_faces();
    count_faces();
    count_edges();
    count_vertices();
    count_patches();
    if (seams) count_seams();
  }
  PlainRecount result;

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  struct Use {
    std::size_t face;
    bool forward;  // from the smaller vertex to the larger
  };

  void add(const std::string& rule, std::uint64_t n) {
    if (n > 0) result.totals[rule] += n;
  }

  void weld() {
    std::map<std::tuple<double, double, double>, std::uint32_t> seen;
    for (const Vec3& p : soup_.points) {
      const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      auto id = static_cast<std::uint32_t>(points_.size());
      if (finite) id = seen.emplace(std::tuple{p.x + 0.0, p.y + 0.0, p.z + 0.0}, id).first->second;
      vertex_of_.push_back(id);
      if (id < points_.size()) {
        add("duplicate-vertex", 1);
        continue;
      }
      finite_.push_back(finite);
      add("non-finite-coordinate", !finite);
      points_.push_back(finite ? Point(p.x, p.y, p.z) : Point(0, 0, 0));
    }
    result.vertices = points_.size();
  }

  void read_faces() {
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      Loop loop;
      bool valid = true;
      for (std::uint32_t h = soup_.face_first[f]; h < soup_.face_first[f + 1]; ++h) {
        if (soup_.corners[h] < vertex_of_.size()) {
          loop.push_back(vertex_of_[soup_.corners[h]]);
        } else {
          valid = false;
        }
      }
      valid_.push_back(valid);
      loops_.push_back(std::move(loop));
    }
    add("empty-mesh", loops_.empty());
  }

  [[nodiscard]] bool is_finite(const Loop& loop) const {
    return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) { return finite_[v]; });
  }
  // The first corners not on one line; false if there are none.
  bool frame(const Loop& loop, std::array<Point, 3>& out) const {
    out[0] = points_[loop[0]];
    std::size_t i = 1;
    while (i < loop.size() && points_[loop[i]] == out[0])
      ++i;
    if (i == loop.size()) return false;
    out[1] = points_[loop[i]];
    for (; i < loop.size(); ++i) {
      out[2] = points_[loop[i]];
      if (!CGAL::collinear(out[0], out[1], out[2])) return true;
    }
    return false;
  }
  [[nodiscard]] bool is_flat(const Loop& loop) const {
    std::array<Point, 3> p;
    return frame(loop, p) &&
           std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) { return CGAL::coplanar(p[0], p[1], p[2], points_[v]); });
  }
  [[nodiscard]] Exact::Vector_3 area(const Loop& loop) const {
    Exact::Vector_3 sum(0, 0, 0);
    const Exact::Point_3 o = exact(loop[0]);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      sum = sum + CGAL::cross_product(exact(loop[i]) - o, exact(loop[i + 1]) - o);
    return sum;
  }
  [[nodiscard]] Exact::Point_3 exact(std::uint32_t v) const { return {points_[v].x(), points_[v].y(), points_[v].z()}; }
  [[nodiscard]] Real3 real(std::uint32_t v) const { return {points_[v].x(), points_[v].y(), points_[v].z()}; }
  static Real3 minus(const Real3& a, const Real3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  static Real3 cross(const Real3& a, const Real3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static Real dot(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static Real length(const Real3& a) { return std::sqrt(dot(a, a)); }

  // ---- faces

  void count_faces() {
    std::map<Loop, int> copies;
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      const Loop& loop = loops_[f];
      const bool repeats = loop.size() < 3 || std::set<std::uint32_t>(loop.begin(), loop.end()).size() < loop.size();
      const bool finite = is_finite(loop);
      sound_.push_back(valid_[f] && !repeats);
      std::array<Point, 3> corners;
      degenerate_.push_back(valid_[f] && (repeats || (finite && !frame(loop, corners))));
      shaped_.push_back(valid_[f] && finite && !degenerate_[f]);
      add("index-out-of-range", !valid_[f]);
      add("degenerate-face", degenerate_[f]);
      Loop sorted = loop;
      std::sort(sorted.begin(), sorted.end());
      const bool copy = valid_[f] && !loop.empty() && copies[sorted]++ > 0;
      add("duplicate-face", copy);
      result.kept_faces += shaped_[f] && !copy ? 1 : 0;
      if (!shaped_[f]) continue;
      const bool crossing = loop.size() > 3 && crosses_itself(loop);
      add("self-crossing-face", crossing);
      add("sliver-face", !crossing && is_thin(loop));
      if (loop.size() > 3) count_flatness(loop);
    }
  }

  // Seen along each axis but those that show less than a sixteenth of what another shows, as the fan's triangles.
  [[nodiscard]] bool crosses_itself(const Loop& loop) const {
    const Exact::Vector_3 normal = area(loop);
    std::array<Exact::FT, 3> shown = {0, 0, 0};
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      const Exact::Vector_3 c = CGAL::cross_product(exact(loop[i]) - exact(loop[0]), exact(loop[i + 1]) - exact(loop[0]));
      for (int axis = 0; axis < 3; ++axis)
        shown[axis] += CGAL::abs(c[axis]);
    }
    const Exact::FT most = *std::max_element(shown.begin(), shown.end());
    for (int axis = 0; axis < 3; ++axis) {
      if (normal[axis] != 0 && 16 * shown[axis] >= most && !crosses_itself(loop, axis)) return false;
    }
    return true;
  }
  [[nodiscard]] bool crosses_itself(const Loop& loop, int axis) const {
    std::vector<Kernel::Point_2> flat;
    for (const std::uint32_t v : loop)
      flat.emplace_back(points_[v][(axis + 1) % 3], points_[v][(axis + 2) % 3]);
    const std::size_t n = flat.size();
    const auto side = [&](std::size_t i) { return Kernel::Segment_2(flat[i], flat[(i + 1) % n]); };
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n, k = (i + 2) % n;
      if (flat[i] == flat[j]) return true;
      if (CGAL::collinear(flat[i], flat[j], flat[k]) && CGAL::angle(flat[i], flat[j], flat[k]) == CGAL::ACUTE) return true;
      for (std::size_t m = i + 2; m < n; ++m) {
        if ((m + 1) % n != i && CGAL::do_intersect(side(i), side(m))) return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool is_thin(const Loop& loop) const {
    constexpr Real kThinnest = 1e-3L;
    Real longest = 0, outline = 0;
    Real3 twice_area{};
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Real3 p = minus(real(loop[i]), real(loop[0])), q = minus(real(loop[(i + 1) % loop.size()]), real(loop[0]));
      longest = std::max(longest, length(minus(q, p)));
      outline += length(minus(q, p));
      const Real3 c = cross(p, q);
      twice_area = {twice_area[0] + c[0], twice_area[1] + c[1], twice_area[2] + c[2]};
    }
    if (loop.size() == 3) return length(twice_area) / longest < kThinnest * longest;  // the height over the longest edge
    return length(twice_area) / outline < kThinnest * outline / 2;                    // the width against half the outline
  }

  [[nodiscard]] Real quantum(std::uint32_t v) const {
    const Real3 p = real(v);
    const Real largest = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    return std::sqrt(Real(3)) * std::max(soup_.relative_quantum * largest, Real(soup_.absolute_quantum));
  }

  void count_flatness(const Loop& loop) {
    Real3 normal{}, mean{};
    Real limit = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Real3 p = minus(real(loop[i]), real(loop[0])), q = minus(real(loop[(i + 1) % loop.size()]), real(loop[0]));
      const Real3 c = cross(p, q);
      for (std::size_t k = 0; k < 3; ++k) {
        normal[k] += c[k];
        mean[k] += p[k] / static_cast<Real>(loop.size());
      }
      limit = std::max(limit, quantum(loop[i]));
    }
    Real off = 0;
    for (const std::uint32_t v : loop)
      off = std::max(off, std::abs(dot(minus(minus(real(v), real(loop[0])), mean), normal)) / length(normal));
    const bool flat = is_flat(loop);
    constexpr Real kCertainlyOff = 4.1L, kCertainlyFlat = 0.5L;  // the tolerance is four quanta along the normal
    result.least_non_planar += !flat && off > kCertainlyOff * limit ? 1 : 0;
    result.most_non_planar += !flat && !(off < kCertainlyFlat * limit) ? 1 : 0;
  }

  // ---- edges and vertices

  void count_edges() {
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      for (std::size_t i = 0; sound_[f] && i < loops_[f].size(); ++i) {
        const std::uint32_t u = loops_[f][i], v = loops_[f][(i + 1) % loops_[f].size()];
        edges_[std::minmax(u, v)].push_back({f, u < v});
      }
    }
    std::set<std::uint32_t> told;  // corners of faces with one that is not finite: what ends there is told by that
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      if (valid_[f] && !is_finite(loops_[f])) told.insert(loops_[f].begin(), loops_[f].end());
    }
    for (const auto& [edge, uses] : edges_) {
      add("boundary-edge", uses.size() == 1 && told.count(edge.first) == 0 && told.count(edge.second) == 0);
      add("non-manifold-edge", uses.size() > 2);
      add("winding-inconsistent", uses.size() == 2 && uses[0].forward == uses[1].forward);
      add("folded-edge", uses.size() == 2 && is_fold(edge, uses));
    }
  }

  // Both flat and in one plane, and the inner sides, n x e along the loop's own direction, agree.
  [[nodiscard]] bool is_fold(const Edge& edge, const std::vector<Use>& uses) const {
    const Loop &a = loops_[uses[0].face], &b = loops_[uses[1].face];
    if (!shaped_[uses[0].face] || !shaped_[uses[1].face]) return false;
    std::array<Point, 3> p;
    if (!frame(a, p)) return false;
    const bool flat =
        std::all_of(b.begin(), b.end(), [&](std::uint32_t v) { return CGAL::coplanar(p[0], p[1], p[2], points_[v]); });
    if (!flat || !is_flat(a)) return false;
    const Exact::Vector_3 along = exact(edge.second) - exact(edge.first);
    const Exact::Vector_3 inner_a = CGAL::cross_product(area(a), uses[0].forward ? along : -along);
    const Exact::Vector_3 inner_b = CGAL::cross_product(area(b), uses[1].forward ? along : -along);
    return inner_a * inner_b > 0;
  }

  void count_vertices() {
    std::vector<std::vector<std::size_t>> faces(points_.size());
    std::vector<bool> is_used(points_.size(), false);
    Sets parts(points_.size());
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      for (const std::uint32_t v : loops_[f]) {
        is_used[v] = true;
        if (sound_[f]) faces[v].push_back(f);
        parts.join(v, loops_[f][0]);
      }
    }
    std::vector<std::vector<Edge>> edges_at(points_.size());
    for (const auto& [edge, uses] : edges_) {
      edges_at[edge.first].push_back(edge);
      edges_at[edge.second].push_back(edge);
    }
    std::set<std::size_t> roots;
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
      add("isolated-vertex", !is_used[v]);
      if (is_used[v]) roots.insert(parts.root(v));
      std::map<std::size_t, std::size_t> number;
      for (const std::size_t f : faces[v])
        number.emplace(f, number.size());
      Sets fans(number.size());
      for (const Edge& edge : edges_at[v]) {
        for (const Use& use : edges_.at(edge))
          fans.join(number.at(use.face), number.at(edges_.at(edge)[0].face));
      }
      std::set<std::size_t> distinct;
      for (std::size_t i = 0; i < number.size(); ++i)
        distinct.insert(fans.root(i));
      add("non-manifold-vertex", distinct.size() > 1);
    }
    result.components = roots.size();
  }

  // ---- patches

  struct Patch {
    std::vector<std::size_t> faces;
    bool is_closed = true, is_consistent = true;
  };

  void count_patches() {
    Sets sets(loops_.size());
    for (const auto& [edge, uses] : edges_)
      if (uses.size() == 2) sets.join(uses[0].face, uses[1].face);
    std::map<std::size_t, Patch> patches;
    for (std::size_t f = 0; f < loops_.size(); ++f)
      if (sound_[f]) patches[sets.root(f)].faces.push_back(f);
    for (const auto& [edge, uses] : edges_) {
      for (const Use& use : uses) {
        Patch& patch = patches.at(sets.root(use.face));
        patch.is_closed = patch.is_closed && uses.size() == 2;
        patch.is_consistent = patch.is_consistent && (uses.size() != 2 || uses[0].forward != uses[1].forward);
      }
    }
    count_orientable();
    std::vector<const Patch*> enclosing;
    std::vector<int> sign;
    for (const auto& [root, patch] : patches) {
      if (!patch.is_closed || !patch.is_consistent) continue;
      if (!std::all_of(patch.faces.begin(), patch.faces.end(), [&](std::size_t f) { return is_finite(loops_[f]); })) continue;
      const int volume = volume_sign(patch);
      if (volume == 0) continue;
      enclosing.push_back(&patch);
      sign.push_back(volume);
    }
    for (std::size_t i = 0; i < enclosing.size(); ++i) {
      if (sign[i] > 0) continue;
      int depth = 0;
      for (std::size_t j = 0; j < enclosing.size(); ++j)
        depth += j != i && is_inside(*enclosing[i], *enclosing[j]) ? 1 : 0;
      add("inside-out", depth % 2 == 0);
    }
  }

  // Each face in two copies, one for either winding, joined where windings agree: a patch is one-sided if they all hang
  // together.
  void count_orientable() {
    const std::size_t n = loops_.size();
    Sets both(2 * n), one(n);
    for (const auto& [edge, uses] : edges_) {
      if (uses.size() != 2) continue;
      const bool agrees = uses[0].forward != uses[1].forward;
      const std::size_t a = uses[0].face, b = uses[1].face;
      both.join(a, agrees ? b : b + n);
      both.join(a + n, agrees ? b + n : b);
      one.join(a, b);
    }
    std::set<std::size_t> one_sided;
    for (std::size_t f = 0; f < n; ++f)
      if (sound_[f] && both.root(f) == both.root(f + n)) one_sided.insert(one.root(f));
    add("not-orientable", one_sided.size());
  }

  // In floating point with a wide margin, exactly where that cannot tell.
  [[nodiscard]] int volume_sign(const Patch& patch) const {
    const Real3 o = real(loops_[patch.faces[0]][0]);
    Real sum = 0, magnitude = 0;
    for_triangles(patch, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const Real v = dot(minus(real(a), o), cross(minus(real(b), o), minus(real(c), o)));
      sum += v;
      magnitude += std::abs(v);
    });
    if (std::abs(sum) > 1e-9L * magnitude) return sum > 0 ? 1 : -1;
    Exact::FT total = 0;
    const Exact::Point_3 origin = exact(loops_[patch.faces[0]][0]);
    for_triangles(patch, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      total += CGAL::determinant(exact(a) - origin, exact(b) - origin, exact(c) - origin);
      total.exact();  // keeps the expression short
    });
    return CGAL::sign(total);
  }
  template <class Visit>
  void for_triangles(const Patch& patch, const Visit& visit) const {
    for (const std::size_t f : patch.faces) {
      for (std::size_t i = 1; i + 1 < loops_[f].size(); ++i)
        visit(loops_[f][0], loops_[f][i], loops_[f][i + 1]);
    }
  }

  // A ray from a vertex of the one patch that the other does not have, counted out against each of the other's triangles; drawn
  // anew where it hits an edge. Vertices on the other surface are passed over.
  [[nodiscard]] bool is_inside(const Patch& patch, const Patch& other) const {
    std::set<std::uint32_t> others;
    for_triangles(other, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { others.insert({a, b, c}); });
    Random random(1);
    for (const std::size_t f : patch.faces) {
      for (const std::uint32_t v : loops_[f]) {
        if (others.count(v) != 0) continue;
        for (int attempt = 0; attempt < 4; ++attempt) {
          const Vec3 d = random.direction();
          const int crossings = count_crossings(points_[v], Kernel::Vector_3(d.x, d.y, d.z), other);
          if (crossings >= 0) return crossings % 2 == 1;
        }
      }
    }
    return false;
  }

  // -1 if the ray meets an edge or starts on the surface.
  [[nodiscard]] int count_crossings(const Point& from, const Kernel::Vector_3& along, const Patch& other) const {
    int crossings = 0;
    bool is_clear = true;
    const Kernel::FT far = 1e7 * (1 + std::abs(from.x()) + std::abs(from.y()) + std::abs(from.z()));
    const Point to = from + far * along;
    for_triangles(other, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      const Point &a = points_[i], &b = points_[j], &c = points_[k];
      const auto side = CGAL::orientation(a, b, c, from), end = CGAL::orientation(a, b, c, to);
      if (side == end && side != CGAL::ZERO) return;
      const auto ab = CGAL::orientation(from, to, a, b), bc = CGAL::orientation(from, to, b, c),
                 ca = CGAL::orientation(from, to, c, a);
      const bool positive = ab == CGAL::POSITIVE || bc == CGAL::POSITIVE || ca == CGAL::POSITIVE;
      const bool negative = ab == CGAL::NEGATIVE || bc == CGAL::NEGATIVE || ca == CGAL::NEGATIVE;
      if (positive && negative) return;
      if (ab == CGAL::ZERO || bc == CGAL::ZERO || ca == CGAL::ZERO || side == CGAL::ZERO || end == CGAL::ZERO) {
        is_clear = false;
      } else {
        ++crossings;
      }
    });
    return is_clear ? crossings : -1;
  }

  // ---- seams

  void count_seams() {
    std::vector<bool> is_sound(points_.size(), false);
    for (std::size_t f = 0; f < loops_.size(); ++f)
      for (const std::uint32_t v : loops_[f])
        is_sound[v] = is_sound[v] || (sound_[f] && finite_[v]);
    std::set<std::uint32_t> found;
    for (const auto& [edge, uses] : edges_) {
      if (uses.size() != 1 || !finite_[edge.first] || !finite_[edge.second]) continue;
      const Loop& own = loops_[uses[0].face];
      const Real3 p = real(edge.first), way = minus(real(edge.second), p);
      const Real long_way = length(way), reach = 4 * std::max(quantum(edge.first), quantum(edge.second));
      for (std::uint32_t v = 0; v < points_.size(); ++v) {
        if (!is_sound[v]) continue;
        const Real3 d = minus(real(v), p);
        const Real at = dot(d, way) / long_way;
        if (!(at > 0 && at < long_way) || dot(d, d) > (long_way + reach) * (long_way + reach)) continue;
        const Real off = length(cross(d, way)) / long_way;
        if (off > reach || length(d) <= reach || length(minus(real(v), real(edge.second))) <= reach) continue;
        if (std::find(own.begin(), own.end(), v) == own.end()) found.insert(v);
      }
    }
    add("t-junction", found.size());
  }

  const PolygonSoup& soup_;
  std::vector<std::uint32_t> vertex_of_;
  std::vector<Point> points_;
  std::vector<bool> finite_;
  std::vector<Loop> loops_;
  std::vector<bool> valid_, sound_, degenerate_, shaped_;
  std::map<Edge, std::vector<Use>> edges_;
};

}  // namespace

PlainRecount plain_recount(const bake::PolygonSoup& soup, bool seams) {
  return Counter(soup, seams).result;
}

}  // namespace fdcg::test
