// SPDX-License-Identifier: Apache-2.0
// The two-sided distance, by dividing the triangles that only one surface has. Of each part the distance of its middle is a
// lower bound. A part is done where one of three things shows that none of its points is farther than the largest lower bound
// and the allowance: the middle's distance plus the part's radius; its corners' distance from one triangle, a convex function;
// SurfaceCover's proof that it lies along a sheet of the other surface.
#include "repair/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "base/vec3.hpp"
#include "repair/surface_cover.hpp"
#include "repair/triangle_tree.hpp"
#include "topology/face_geometry.hpp"
#include "topology/face_triangles.hpp"

namespace fdcg::bake {
namespace {

using Triangle = std::array<Vec3, 3>;

bool is_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}
bool is_before(const Triangle& s, const Triangle& t) {
  return std::lexicographical_compare(s.begin(), s.end(), t.begin(), t.end(), is_less);
}

double volume_of(const Triangle& t) {
  return dot(t[0], cross(t[1], t[2])) / 6;
}

double largest_of(const TriangleSet& triangles) {
  double largest = 0;
  for (const Triangle& t : triangles) {
    for (const Vec3& p : t)
      largest = std::max(largest, largest_component(p));
  }
  return largest;
}

// Each in a form of its own, sorted: turned so that the least corner is first; without sides, all corners sorted.
TriangleSet in_order(const TriangleSet& triangles, bool with_sides) {
  TriangleSet sorted = triangles;
  for (Triangle& t : sorted) {
    for (Vec3& p : t)
      p = p + Vec3{};  // -0 becomes 0
    if (with_sides) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end(), is_less), t.end());
    } else {
      std::sort(t.begin(), t.end(), is_less);
    }
  }
  std::sort(sorted.begin(), sorted.end(), is_before);
  return sorted;
}

TriangleSet only_in_first(const TriangleSet& first, const TriangleSet& second) {
  TriangleSet only;
  std::set_difference(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(only), is_before);
  return only;
}

// Corners at equal coordinates have one name.
std::vector<NamedTriangle> with_names(const TriangleSet& triangles) {
  std::vector<Vec3> points;
  for (const Triangle& t : triangles)
    points.insert(points.end(), t.begin(), t.end());
  std::sort(points.begin(), points.end(), is_less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<NamedTriangle> named;
  named.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    NamedTriangle& triangle = named.emplace_back(NamedTriangle{t, {}});
    for (std::size_t k = 0; k < 3; ++k)
      triangle.name[k] =
          static_cast<std::uint32_t>(std::lower_bound(points.begin(), points.end(), t[k], is_less) - points.begin());
  }
  return named;
}

// The largest distance of some triangles' points from a surface.
class OneSided {
 public:
  OneSided(const TriangleSet& surface, double largest)
      : named_(with_names(surface)), tree_(named_), largest_(largest), allowance_(largest * kAllowance) {}

  // An upper bound; `least` is a lower bound that is known already.
  double bound(const TriangleSet& parts, double least) {
    lower_ = least;
    const std::uint64_t few = kFewParts + kPartsEach * parts.size();
    for (const Triangle& part : parts)
      open(part);
    for (std::uint64_t looked_at = 0; !open_.empty() && open_.top().upper > reach(); ++looked_at) {
      const double upper = open_.top().upper;
      if (looked_at > kMostParts || (looked_at > few && upper <= kRounding * largest_)) return upper;
      const Triangle part = open_.top().triangle;
      open_.pop();
      if (!lies_along(part)) divide(part);
    }
    return reach();
  }
  [[nodiscard]] double lower() const { return lower_; }

 private:
  static constexpr double kAllowance = 0x1p-26;
  static constexpr std::uint64_t kMostParts = 50'000;  // about a second
  // Within the rounding of floats a few parts are enough, in proportion to what changed: beside a crack that is as wide no
  // number of parts would be.
  static constexpr std::uint64_t kFewParts = 1'000, kPartsEach = 100;
  static constexpr double kRounding = 0x1p-24;

  struct Part {
    double upper;
    Triangle triangle;
    bool operator<(const Part& other) const { return upper < other.upper; }
  };
  [[nodiscard]] double reach() const { return 1.005 * lower_ + allowance_; }

  void open(const Triangle& part) {
    const Vec3 centre = 1.0 / 3 * (part[0] + part[1] + part[2]);
    const TriangleTree::Nearest near = tree_.nearest(centre);
    lower_ = std::max(lower_, near.distance);
    double radius = 0, corners = 0;
    for (const Vec3& p : part) {
      radius = std::max(radius, length(p - centre));
      corners = std::max(corners, distance_bound(p, named_[near.triangle].point));
    }
    open_.push({std::min(near.distance + radius, corners), part});
  }
  bool lies_along(const Triangle& part) {
    const auto [a, b, c] = part;
    const Vec3 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
    const Vec3 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
    tree_.in_box(low, high, reach(), candidates_);
    constexpr std::size_t kMostCandidates = 64;  // else a smaller part is cheaper
    if (candidates_.size() > kMostCandidates) return false;
    SurfaceCover cover(reach(), largest_);
    return cover.covers(part, candidates_, used_) || lies_along_one_side(part, cover);
  }
  // Sheets that lie on one another, as of plates without a thickness, share edges of more than two triangles, which look like
  // borders: so each side by itself, without copies. Where these are whole, a part need not be divided along all of such an
  // edge.
  bool lies_along_one_side(const Triangle& part, SurfaceCover& cover) {
    const auto side_of = [](const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]); };
    const auto has_same_corners = [](const NamedTriangle& s, const NamedTriangle& t) {
      return std::is_permutation(s.name.begin(), s.name.end(), t.name.begin());
    };
    for (const double sign : {1.0, -1.0}) {
      facing_.clear();
      for (const NamedTriangle& t : candidates_) {
        const bool is_copy =
            std::any_of(facing_.begin(), facing_.end(), [&](const NamedTriangle& s) { return has_same_corners(s, t); });
        if (sign * dot(side_of(part), side_of(t.point)) > 0 && !is_copy) facing_.push_back(t);
      }
      if (facing_.size() < candidates_.size() && cover.covers(part, facing_, used_, 1)) return true;
    }
    return false;
  }
  void divide(const Triangle& part) {
    const auto& [a, b, c] = part;
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    for (const Triangle& quarter : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
      open(quarter);
  }

  std::vector<NamedTriangle> named_;
  TriangleTree tree_;
  double largest_, allowance_;
  double lower_ = 0;
  std::priority_queue<Part> open_;
  std::vector<NamedTriangle> candidates_, facing_;
  std::vector<std::uint32_t> used_;
};

double two_sided(const TriangleSet& before, const TriangleSet& after) {
  TriangleSet first = in_order(before, false), second = in_order(after, false);
  for (TriangleSet* triangles : {&first, &second})  // a copy covers no more than its original
    triangles->erase(std::unique(triangles->begin(), triangles->end()), triangles->end());
  const TriangleSet gone = only_in_first(first, second), fresh = only_in_first(second, first);
  if (gone.empty() && fresh.empty()) return 0;
  if (before.empty() || after.empty()) return std::numeric_limits<double>::infinity();
  const double largest = std::max(largest_of(before), largest_of(after));
  double bound = 0, lower = 0;
  if (!gone.empty()) {
    OneSided side(after, largest);
    bound = side.bound(gone, 0);
    lower = side.lower();
  }
  if (!fresh.empty()) bound = std::max(bound, OneSided(before, largest).bound(fresh, lower));
  return bound;
}

}  // namespace

TriangleSet triangles_of(const PolygonSoup& soup, const Mesh& mesh, const std::vector<FaceState>& states, const Vec3& middle) {
  const FaceGeometry geometry(mesh, states);
  const FaceTriangles cut(mesh, geometry, 1);
  const auto point = [&](VertexId v) {
    return soup.points[mesh.source_point[+v]] - middle;
  };  // the mesh's own origin may change
  TriangleSet triangles;
  triangles.reserve(cut.count());
  for (std::uint32_t t = 0; t < cut.count(); ++t) {
    const FaceId f = cut.face(t);
    if (!geometry.is_finite(f) || geometry.is_degenerate(f)) continue;
    const VertexId* const c = cut.corners(t);
    triangles.push_back({point(c[0]), point(c[1]), point(c[2])});
  }
  return triangles;
}

double signed_volume(const TriangleSet& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += volume_of(t);
  return sum;
}

SurfaceChange surface_change(const TriangleSet& before, const TriangleSet& after) {
  SurfaceChange change;
  const TriangleSet first = in_order(before, true), second = in_order(after, true);
  change.volume_change = signed_volume(only_in_first(second, first)) - signed_volume(only_in_first(first, second));
  change.distance = two_sided(before, after);
  return change;
}

}  // namespace fdcg::bake
