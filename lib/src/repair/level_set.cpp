// SPDX-License-Identifier: Apache-2.0
// Marching tetrahedra (Doi and Koide 1991) over those cells alone that the surface passes: they are found from the triangles,
// and from there along the surface, across holes too. Every lattice edge that changes sign has one vertex, away from its ends,
// so that no triangle is degenerate and each stays in its tetrahedron.
#include "repair/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "repair/triangle_tree.hpp"
#include "solid/winding_tree.hpp"

namespace fdcg::bake {
namespace {

// A place of the lattice, 21 bits a coordinate.
using LatticePoint = std::uint64_t;
constexpr unsigned kLatticeBits = 21;
constexpr std::uint64_t kLatticeMask = (std::uint64_t{1} << kLatticeBits) - 1;

LatticePoint lattice_point(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return x | y << kLatticeBits | z << 2 * kLatticeBits;
}
LatticePoint moved_by(LatticePoint p, int x, int y, int z) {
  return p + static_cast<std::uint64_t>(x) + (static_cast<std::uint64_t>(y) << kLatticeBits) +
         (static_cast<std::uint64_t>(z) << 2 * kLatticeBits);
}
struct LatticeHash {
  std::size_t operator()(std::uint64_t p) const {
    p *= 0x9E3779B97F4A7C15u;
    return p ^ p >> 29;
  }
};

class LevelSetMesher {
 public:
  LevelSetMesher(const TriangleSet& triangles, double voxel, unsigned jobs)
      : triangles_(triangles), voxel_(voxel), jobs_(jobs), named_(named(triangles)), near_(named_), winding_(triangles) {
    Vec3 low = triangles[0][0], high = low;
    for (const auto& t : triangles) {
      for (const Vec3& p : t) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    constexpr double kMargin = 8;  // voxels
    origin_ = low - kMargin * voxel * Vec3{1, 1, 1};
    double area = 0;
    for (const auto& [a, b, c] : triangles)
      area += 0.5 * length(cross(b - a, c - a));
    is_too_fine_ = largest_component(high - low) / voxel + 2 * kMargin >= static_cast<double>(kLatticeMask) ||
                   2 * area / (voxel * voxel) > static_cast<double>(kMostLatticePoints);
  }

  LevelSet run(const Progress& progress) {
    LevelSet result;
    std::vector<LatticePoint> front;
    if (!is_too_fine_) front = seeds();
    for (std::size_t round = 0; !front.empty() && !is_too_fine_; ++round) {
      evaluate(front);
      front = beyond(front);
      if (progress) progress("level set", 1 - 1 / (1 + static_cast<double>(round)));
    }
    if (is_too_fine_) {
      result.outcome = LevelSet::Outcome::too_fine;
      return result;
    }
    mesh(result.set);
    if (result.set.facets.empty()) result.outcome = LevelSet::Outcome::nothing_enclosed;
    return result;
  }

 private:
  static std::vector<NamedTriangle> named(const TriangleSet& triangles) {
    std::vector<NamedTriangle> list;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      list.push_back({triangles[t], {t, t, t}});
    return list;
  }
  [[nodiscard]] Vec3 place(LatticePoint p) const {
    return origin_ + voxel_ * Vec3{static_cast<double>(p & kLatticeMask), static_cast<double>(p >> kLatticeBits & kLatticeMask),
                                   static_cast<double>(p >> 2 * kLatticeBits & kLatticeMask)};
  }

  // Negative inside: the distance from the triangles, and no more than goes with how clearly the winding number tells.
  [[nodiscard]] double value(const Vec3& p) const {
    constexpr double kBand = 4;         // voxels
    constexpr double kRounding = 1e-9;  // a point on a sheet is not inside
    const double inside = winding_.at(p) - 0.5 - kRounding, clear = 2 * kBand * voxel_ * std::fabs(inside);
    return (inside > 0 ? -1 : 1) * std::min(near_.nearest(p).distance, clear);
  }

  // The lattice points around the triangles, which are divided until they are no longer than some voxels.
  std::vector<LatticePoint> seeds() {
    std::vector<LatticePoint> points;
    for (const auto& t : triangles_) {
      add_seeds(t, points);
      if (points.size() > 2 * kMostLatticePoints) keep_one_each(points);
      is_too_fine_ = points.size() > kMostLatticePoints;
      if (is_too_fine_) return {};
    }
    keep_one_each(points);
    return points;
  }
  static void keep_one_each(std::vector<LatticePoint>& points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  void add_seeds(const std::array<Vec3, 3>& t, std::vector<LatticePoint>& points) const {
    std::vector<std::array<Vec3, 3>> open{t};
    while (!open.empty()) {
      const auto [a, b, c] = open.back();
      open.pop_back();
      const Vec3 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
      const Vec3 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
      if (largest_component(high - low) > 2 * voxel_) {
        const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        open.insert(open.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        continue;
      }
      const auto cell = [&](double x, double from) { return static_cast<std::uint64_t>(std::floor((x - from) / voxel_)); };
      for (std::uint64_t z = cell(low.z, origin_.z); z <= cell(high.z, origin_.z) + 1; ++z) {
        for (std::uint64_t y = cell(low.y, origin_.y); y <= cell(high.y, origin_.y) + 1; ++y) {
          for (std::uint64_t x = cell(low.x, origin_.x); x <= cell(high.x, origin_.x) + 1; ++x)
            points.push_back(lattice_point(x, y, z));
        }
      }
    }
  }

  void evaluate(const std::vector<LatticePoint>& points) {
    if (values_.size() + points.size() > kMostLatticePoints) {
      is_too_fine_ = true;
      return;
    }
    std::vector<double> found(points.size());
    parallel_for(jobs_, points.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        found[i] = value(place(points[i]));
    });
    for (std::size_t i = 0; i < points.size(); ++i)
      values_.emplace(points[i], found[i]);
  }

  // What is still to be known around points at which the sign changes. Points whose neighbours are not known yet ask for them
  // where the surface may pass between.
  std::vector<LatticePoint> beyond(const std::vector<LatticePoint>& front) const {
    std::vector<LatticePoint> points;
    const auto ask = [&](LatticePoint p) {
      if (!values_.contains(p)) points.push_back(p);
    };
    constexpr int kWays[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const LatticePoint p : front) {
      const double here = values_.at(p);
      for (const auto& way : kWays) {
        const LatticePoint q = moved_by(p, way[0], way[1], way[2]);
        const auto there = values_.find(q);
        if (there == values_.end() || (there->second < 0) == (here < 0)) continue;
        for (int i = 0; i < 27; ++i) {
          ask(moved_by(p, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
          ask(moved_by(q, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        }
      }
    }
    keep_one_each(points);
    return points;
  }

  void mesh(FacetSet& set) {
    std::vector<LatticePoint> cells;
    for (const auto& [p, v] : values_)
      cells.push_back(p);
    std::sort(cells.begin(), cells.end());
    for (const LatticePoint p : cells)
      mesh_cell(p, set);
  }

  // The six tetrahedra of a cube go from corner 0 to corner 7, by the six orders of the axes; alike in every cube, so that they
  // fit together.
  void mesh_cell(LatticePoint p, FacetSet& set) {
    std::array<LatticePoint, 8> corner{};
    std::array<double, 8> v{};
    bool has_inside = false, has_outside = false;
    for (unsigned i = 0; i < 8; ++i) {
      corner[i] = moved_by(p, static_cast<int>(i & 1u), static_cast<int>(i >> 1 & 1u), static_cast<int>(i >> 2));
      const auto known = values_.find(corner[i]);
      if (known == values_.end()) return;
      v[i] = known->second;
      (v[i] < 0 ? has_inside : has_outside) = true;
    }
    if (!has_inside || !has_outside) return;
    constexpr unsigned kOrders[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};  // each turns the same way
    for (const auto& [second, third] : kOrders)
      mesh_tetrahedron({corner[0], corner[second], corner[third], corner[7]}, {v[0], v[second], v[third], v[7]}, set);
  }

  void mesh_tetrahedron(const std::array<LatticePoint, 4>& c, const std::array<double, 4>& v, FacetSet& set) {
    std::array<std::size_t, 4> order{};
    std::size_t inside = 0, outside = 4;
    for (std::size_t i = 0; i < 4; ++i)
      (v[i] < 0 ? order[inside++] : order[--outside]) = i;
    if (inside == 0 || inside == 4) return;
    const auto vertex = [&](std::size_t i, std::size_t j) { return vertex_on(c[i], v[i], c[j], v[j], set); };
    const auto [a, b, d, e] = order;  // even orders keep the tetrahedron's sense, and the triangles below face outside then
    const bool is_odd = ((a > b) + (a > d) + (a > e) + (b > d) + (b > e) + (d > e)) % 2 != 0;
    if (inside == 1) {
      add(set, {vertex(a, b), vertex(a, d), vertex(a, e)}, is_odd);
    } else if (inside == 3) {
      add(set, {vertex(a, e), vertex(b, e), vertex(d, e)}, is_odd);
    } else {
      const std::uint32_t p = vertex(a, d), q = vertex(a, e), r = vertex(b, e), s = vertex(b, d);
      add(set, {p, q, r}, is_odd);
      add(set, {p, r, s}, is_odd);
    }
  }

  void add(FacetSet& set, Triangle3 t, bool is_odd) const {
    if (is_odd) std::swap(t[1], t[2]);
    const Vec3 middle = 1.0 / 3 * (set.points[t[0]] + set.points[t[1]] + set.points[t[2]]);
    set.facets.push_back({t, 1, near_.nearest(middle).triangle});
  }

  std::uint32_t vertex_on(LatticePoint p, double at_p, LatticePoint q, double at_q, FacetSet& set) {
    if (q < p) {
      std::swap(p, q);
      std::swap(at_p, at_q);
    }
    const auto [found, is_new] = vertices_[p].try_emplace(q - p, static_cast<std::uint32_t>(set.points.size()));
    if (is_new) {
      constexpr double kFromEnds = 1.0 / 16;
      const double share = std::clamp(at_p / (at_p - at_q), kFromEnds, 1 - kFromEnds);
      set.points.push_back(place(p) + share * (place(q) - place(p)));
    }
    return found->second;
  }

  const TriangleSet& triangles_;
  double voxel_;
  unsigned jobs_;
  std::vector<NamedTriangle> named_;
  TriangleTree near_;
  WindingTree winding_;
  Vec3 origin_;
  bool is_too_fine_ = false;
  std::unordered_map<LatticePoint, double, LatticeHash> values_;
  std::unordered_map<LatticePoint, std::unordered_map<LatticePoint, std::uint32_t, LatticeHash>, LatticeHash> vertices_;
};

}  // namespace

LevelSet level_set_surface(const TriangleSet& triangles, double voxel, unsigned jobs, const Progress& progress) {
  if (triangles.empty()) return {LevelSet::Outcome::nothing_enclosed, {}};
  return LevelSetMesher(triangles, voxel, jobs).run(progress);
}

}  // namespace fdcg::bake
