// SPDX-License-Identifier: Apache-2.0
#include "repair/surface_cover.hpp"

#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

using Point2 = std::array<double, 2>;
using Triangle2 = std::array<Point2, 3>;

double side(const Point2& a, const Point2& b, const Point2& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

// Whether the segment u-v and the triangle (counter-clockwise) are disjoint: a line through one of the four edges then
// separates them.
bool is_apart(const Point2& u, const Point2& v, const Triangle2& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Point2 &a = t[k], &b = t[(k + 1) % 3];
    if (side(a, b, u) <= 0 && side(a, b, v) <= 0) return true;
  }
  const double s0 = side(u, v, t[0]), s1 = side(u, v, t[1]), s2 = side(u, v, t[2]);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

// Winding number of a triangle around p: 1 or -1; 0 if p is outside. `is_sure` is cleared where p is too near an edge to
// decide.
int winding(const Triangle2& t, const Point2& p, double tolerance, bool& is_sure) {
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double s = side(t[k], t[(k + 1) % 3], p);
    if (std::abs(s) <= tolerance) {
      is_sure = false;
      return 0;
    }
    (s > 0 ? positive : negative)++;
  }
  return positive == 3 ? 1 : negative == 3 ? -1 : 0;
}

}  // namespace

double distance_bound(const Vec3& p, const std::array<Vec3, 3>& triangle) {
  // The projection onto the plane, if inside; else the nearest point of the nearest edge.
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = cross(ab, ac);
  const double nn = dot(n, n);
  if (nn > 0) {
    const double v = dot(cross(ap, ac), n), w = dot(cross(ab, ap), n);
    if (v >= 0 && w >= 0 && v + w <= nn) {
      // The error of the normal of a thin triangle, as an angle: about 2^-53 |ab| |ac| / |n|.
      const double size = std::sqrt(nn);
      const double error = 0x1p-47 * std::sqrt(squared_length(ab) * squared_length(ac) * squared_length(ap)) / size;
      return std::abs(dot(ap, n)) / size + error;
    }
  }
  const auto to_segment = [&](const Vec3& u, const Vec3& v) {
    const Vec3 d = v - u, up = p - u;
    const double dd = dot(d, d);
    const double t = dd > 0 ? std::clamp(dot(up, d) / dd, 0.0, 1.0) : 0.0;
    return squared_length(up - t * d);
  };
  return std::sqrt(std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)}));
}

SurfaceCover::SurfaceCover(double distance, double largest)
    : reach_(distance * (1 - 1e-6)), slack_(distance * 5e-7), is_usable_(distance > largest * kLeastShare) {}

bool SurfaceCover::covers(const std::array<Vec3, 3>& triangle, std::span<const NamedTriangle> candidates,
                          std::vector<std::uint32_t>& used, int parts) {
  used.clear();
  parts_left_ = parts;
  candidates_ = candidates;
  if (!is_usable_ || !is_covered(triangle, used)) return false;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return true;
}

bool SurfaceCover::is_covered(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used) {
  if (parts_left_-- <= 0) return false;
  bool is_far = false;
  if (is_near_one(triangle, used, is_far)) return true;
  if (is_far) return false;
  if (is_below_a_sheet(triangle, used)) return true;
  const auto& [a, b, c] = triangle;
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  return is_covered({a, ab, ca}, used) && is_covered({ab, b, bc}, used) && is_covered({ca, bc, c}, used) &&
         is_covered({ab, bc, ca}, used);
}

// `is_far`: a corner is near no candidate, so no proof can succeed.
bool SurfaceCover::is_near_one(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used, bool& is_far) {
  std::array<bool, 3> has_near{};
  for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) {
      // A corner already known to be near a candidate needs testing only where the other corners are near this one.
      if (!all && has_near[k]) continue;
      const bool near = is_near(triangle[k], candidates_[i].point);
      has_near[k] = has_near[k] || near;
      all = all && near;
    }
    if (!all) continue;
    used.push_back(i);
    return true;
  }
  is_far = !(has_near[0] && has_near[1] && has_near[2]);
  return false;
}

// The frame: the triangle's plane, and in it the triangle with its edges moved inwards so little that every point is within the
// slack of the shrunk triangle. False where the triangle is too thin.
bool SurfaceCover::set_frame(const std::array<Vec3, 3>& triangle) {
  const Vec3 u = triangle[1] - triangle[0], w = triangle[2] - triangle[0];
  const Vec3 n = cross(u, w);
  const double a = length(triangle[2] - triangle[1]), b = length(w), c = length(u), area = length(n);
  constexpr double kThinnest = 1e-4;  // for thinner triangles the rounded frame is not orthogonal enough
  if (!(c > 0 && area > kThinnest * b * c)) return false;
  Frame& frame = frame_;
  frame.origin = triangle[0];
  frame.normal = (1 / area) * n;
  frame.x = (1 / c) * u;
  frame.y = cross(frame.normal, frame.x);
  frame.reach = reach_ - slack_ - std::abs(dot(w, frame.normal));

  Triangle2& t = frame.triangle;
  t = {frame.flat(triangle[0]), frame.flat(triangle[1]), frame.flat(triangle[2])};
  const double perimeter = a + b + c, inradius = area / perimeter;
  frame.longest = std::max({a, b, c});
  // A corner of half angle h moves by inset / sin h. The incentre lies inradius / sin h from it, and less than the longest
  // edge: sin h > inradius / longest.
  const double inset = slack_ * inradius / frame.longest;
  if (!(inradius > 4 * inset) || !(inset > frame.longest * 0x1p-48)) return false;
  const Point2 centre{(a * t[0][0] + b * t[1][0] + c * t[2][0]) / perimeter,
                      (a * t[0][1] + b * t[1][1] + c * t[2][1]) / perimeter};
  const double scale = 1 - inset / inradius;
  for (Point2& p : t)
    p = {centre[0] + scale * (p[0] - centre[0]), centre[1] + scale * (p[1] - centre[1])};
  return true;
}

// The candidates within reach of the plane whose projection may overlap the triangle, and their edges, sorted.
void SurfaceCover::gather_sheet() {
  sheet_.clear();
  edges_.clear();
  const auto overlaps = [](const Triangle2& p, const Triangle2& q, std::size_t axis) {
    const auto [p_low, p_high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    const auto [q_low, q_high] = std::minmax({q[0][axis], q[1][axis], q[2][axis]});
    return p_low <= q_high && q_low <= p_high;
  };
  for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
    Projected projected{{}, i};
    bool is_in_reach = true;
    for (std::size_t k = 0; k < 3 && is_in_reach; ++k) {
      const Vec3& p = candidates_[i].point[k];
      is_in_reach = std::abs(dot(p - frame_.origin, frame_.normal)) <= frame_.reach;
      projected.point[k] = frame_.flat(p);
    }
    if (!is_in_reach || !overlaps(projected.point, frame_.triangle, 0) || !overlaps(projected.point, frame_.triangle, 1))
      continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = candidates_[i].name[k], to = candidates_[i].name[(k + 1) % 3];
      edges_.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(sheet_.size()), k});
    }
    sheet_.push_back(projected);
  }
  std::sort(edges_.begin(), edges_.end());
}

// Whether an edge of the sheet that does not have two triangles in it enters the triangle.
bool SurfaceCover::has_border_inside() const {
  for (std::size_t i = 0; i < edges_.size();) {
    std::size_t end = i + 1;
    while (end < edges_.size() && edges_[end][0] == edges_[i][0] && edges_[end][1] == edges_[i][1])
      ++end;
    for (std::size_t e = i; e < end && end - i != 2; ++e) {
      const Triangle2& q = sheet_[edges_[e][2]].point;
      if (!is_apart(q[edges_[e][3]], q[(edges_[e][3] + 1) % 3], frame_.triangle)) return true;
    }
    i = end;
  }
  return false;
}

bool SurfaceCover::is_below_a_sheet(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used) {
  if (!set_frame(triangle)) return false;
  gather_sheet();
  if (sheet_.empty() || has_border_inside()) return false;
  // Any inner point serves; several are tried, since some lie on an edge by chance.
  constexpr std::array<std::array<double, 3>, 3> kInside{{{0.31, 0.36, 0.33}, {0.57, 0.19, 0.24}, {0.17, 0.22, 0.61}}};
  const double tolerance = frame_.longest * frame_.longest * 0x1p-44;
  for (const auto& share : kInside) {
    const Triangle2& t = frame_.triangle;
    const Point2 p{share[0] * t[0][0] + share[1] * t[1][0] + share[2] * t[2][0],
                   share[0] * t[0][1] + share[1] * t[1][1] + share[2] * t[2][1]};
    bool is_sure = true;
    int sum = 0;
    for (const Projected& projected : sheet_)
      sum += winding(projected.point, p, tolerance, is_sure);
    if (!is_sure) continue;
    if (sum == 0) return false;
    for (const Projected& projected : sheet_)
      used.push_back(projected.candidate);
    return true;
  }
  return false;
}

}  // namespace fdcg::bake
