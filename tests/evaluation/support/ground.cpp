// SPDX-License-Identifier: Apache-2.0
#include "ground.hpp"

#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "point.hpp"

namespace fdcg::test {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
#if CGAL_VERSION_MAJOR >= 6  // where they have a dimension in their names
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, std::vector<Triangle>::const_iterator>;
using Traits = CGAL::AABB_traits_3<Kernel, Primitive>;
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
#endif
using AabbTree = CGAL::AABB_tree<Traits>;
using namespace plain;

std::uint64_t ends_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

}  // namespace

// Faces as fans of triangles.
struct Ground::Tree {
  std::vector<Triangle> triangles;
  struct Source {
    std::uint32_t face, corner[3];
  };
  std::vector<Source> sources;
  AabbTree aabb;
};

Ground::Ground(bake::PolygonSoup soup) : soup_(std::move(soup)), tree_(std::make_unique<Tree>()) {
  low_.fill(std::numeric_limits<double>::infinity());
  high_.fill(-std::numeric_limits<double>::infinity());
  for (std::uint32_t i = 0; i < soup_.points.size(); ++i) {
    const Point p = corner(i);
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], p[k]);
      high_[k] = std::max(high_[k], p[k]);
    }
  }
  const auto cgal = [&](std::uint32_t i) { return Kernel::Point_3(soup_.points[i].x, soup_.points[i].y, soup_.points[i].z); };
  for (std::uint32_t f = 0; f < soup_.face_count(); ++f) {
    const std::uint32_t first = soup_.face_first[f], last = soup_.face_first[f + 1];
    for (std::uint32_t k = first + 1; k + 1 < last; ++k) {
      const std::uint32_t a = soup_.corners[first], b = soup_.corners[k], c = soup_.corners[k + 1];
      tree_->triangles.emplace_back(cgal(a), cgal(b), cgal(c));
      tree_->sources.push_back({f, {a, b, c}});
    }
  }
  const std::vector<Triangle>& triangles = tree_->triangles;
  tree_->aabb.insert(triangles.begin(), triangles.end());
  tree_->aabb.build();
  tree_->aabb.accelerate_distance_queries();
  find_normals();
  find_edges();
}

Ground::~Ground() = default;

Ground::Point Ground::corner(std::uint32_t index) const {
  const bake::Vec3& p = soup_.points[index];
  return {p.x, p.y, p.z};
}

void Ground::find_normals() {
  corner_normals_.assign(soup_.points.size(), Point{});
  for (std::uint32_t f = 0; f < soup_.face_count(); ++f) {
    const std::uint32_t first = soup_.face_first[f], n = soup_.face_first[f + 1] - first;
    const auto at = [&](std::uint32_t k) { return corner(soup_.corners[first + k % n]); };
    Point sum{};
    for (std::uint32_t k = 1; k + 1 < n; ++k)
      sum = sum + cross(at(k) - at(0), at(k + 1) - at(0));
    face_normals_.push_back(unit(sum));
    for (std::uint32_t k = 0; k < n; ++k) {
      const Point out = unit(at(k + 1) - at(k)), in = unit(at(k + n - 1) - at(k));
      const double angle = std::acos(std::clamp(dot(out, in), -1.0, 1.0));
      Point& normal = corner_normals_[soup_.corners[first + k]];
      normal = normal + face_normals_.back() * angle;
    }
  }
  for (Point& normal : corner_normals_)
    normal = unit(normal);
}

void Ground::find_edges() {
  edges_.reserve(soup_.corners.size());
  for (std::uint32_t f = 0; f < soup_.face_count(); ++f) {
    const std::uint32_t first = soup_.face_first[f], last = soup_.face_first[f + 1];
    for (std::uint32_t k = first; k < last; ++k)
      edges_.push_back({ends_of(soup_.corners[k], soup_.corners[k + 1 < last ? k + 1 : first]), f});
  }
  std::sort(edges_.begin(), edges_.end(),
            [](const EdgeUse& a, const EdgeUse& b) { return a.ends != b.ends ? a.ends < b.ends : a.face < b.face; });
  first_neighbour_.assign(soup_.points.size() + 1, 0);
  const auto for_each_edge = [&](auto visit) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (i > 0 && edges_[i].ends == edges_[i - 1].ends) continue;
      visit(static_cast<std::uint32_t>(edges_[i].ends >> 32), static_cast<std::uint32_t>(edges_[i].ends));
    }
  };
  for_each_edge([&](std::uint32_t a, std::uint32_t b) { ++first_neighbour_[a + 1], ++first_neighbour_[b + 1]; });
  for (std::size_t i = 1; i < first_neighbour_.size(); ++i)
    first_neighbour_[i] += first_neighbour_[i - 1];
  neighbours_.resize(first_neighbour_.back());
  std::vector<std::uint32_t> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
  for_each_edge([&](std::uint32_t a, std::uint32_t b) { neighbours_[next[a]++] = b, neighbours_[next[b]++] = a; });
}

std::span<const std::uint32_t> Ground::neighbours(std::uint32_t corner) const {
  return {neighbours_.data() + first_neighbour_[corner], neighbours_.data() + first_neighbour_[corner + 1]};
}

// A diagonal of a face's fan is no edge: there it is the face's own.
Ground::Point Ground::edge_normal(std::uint32_t a, std::uint32_t b, std::uint32_t face) const {
  const std::uint64_t ends = ends_of(a, b);
  const auto first = std::lower_bound(edges_.begin(), edges_.end(), ends,
                                      [](const EdgeUse& use, std::uint64_t wanted) { return use.ends < wanted; });
  Point sum{};
  for (auto use = first; use != edges_.end() && use->ends == ends; ++use)
    sum = sum + face_normals_[use->face];
  return dot(sum, sum) > 0 ? unit(sum) : face_normals_[face];
}

Ground::Closest Ground::closest(const Point& point) const {
  const auto found = tree_->aabb.closest_point_and_primitive({point[0], point[1], point[2]});
  return closest_of(point, static_cast<std::uint32_t>(found.second - tree_->triangles.begin()));
}

Ground::Closest Ground::closest_of(const Point& point, std::uint32_t triangle) const {
  const Tree::Source& source = tree_->sources[triangle];
  const std::uint32_t* c = source.corner;
  const OnTriangle on = nearest_on_triangle(point, corner(c[0]), corner(c[1]), corner(c[2]));
  Closest result{on.point, face_normals_[source.face], face_normals_[source.face], source.face, length(point - on.point)};
  constexpr int kFirst[8] = {0, 0, 1, 0, 2, 0, 1, 0}, kSecond[8] = {0, 0, 0, 1, 0, 2, 2, 0};  // corners of the set bits
  if (on.on == 3 || on.on == 5 || on.on == 6) {
    result.feature_normal = edge_normal(c[kFirst[on.on]], c[kSecond[on.on]], source.face);
  } else if (on.on != 7) {
    result.feature_normal = corner_normals_[c[kFirst[on.on]]];
  }
  return result;
}

double Ground::signed_distance(const Point& point) const {
  const Closest found = closest(point);
  return dot(point - found.point, found.feature_normal) < 0 ? -found.distance : found.distance;
}

}  // namespace fdcg::test
