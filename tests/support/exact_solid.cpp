// SPDX-License-Identifier: Apache-2.0
#include "exact_solid.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <limits>

#include "contact_rig.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// The sign of ((b - a) x (c - a)) . (d - a).
int side_of(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  const auto point = [](const Hip& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
  return CGAL::orientation(point(a), point(b), point(c), point(d));
}

}  // namespace

ExactSolid::ExactSolid(const bake::PolygonSoup& soup, const fdcg_header& header) {
  const auto stored = [&](const bake::Vec3& p) {
    Hip local = {p.x - header.origin[0], p.y - header.origin[1], p.z - header.origin[2]};
    if (header.real_bytes == sizeof(float)) {
      for (double& x : local)
        x = static_cast<double>(static_cast<float>(x));
    }
    return local;
  };
  low_.fill(std::numeric_limits<double>::infinity());
  high_.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    std::array<Hip, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = stored(soup.points[soup.corners[soup.face_first[f] + k]]);
      for (std::size_t i = 0; i < 3; ++i) {
        low_[i] = std::min(low_[i], triangle[k][i]);
        high_[i] = std::max(high_[i], triangle[k][i]);
      }
    }
    triangles_.push_back(triangle);
  }
  for (std::size_t i = 0; i < 3; ++i)
    size_ = std::max(size_, high_[i] - low_[i]);
  Random random(99);
  for (Hip& far : far_points_) {
    const bake::Vec3 d = random.direction();
    far = {low_[0] + 7 * size_ * d.x, low_[1] + 7 * size_ * d.y, low_[2] + 7 * size_ * d.z};
  }
}

ExactSolid::Crossing ExactSolid::crossing(const Hip& from, const Hip& to) const {
  Crossing result;
  for (const auto& [a, b, c] : triangles_) {
    bool is_apart = false;  // by the bounds
    for (std::size_t i = 0; i < 3; ++i) {
      is_apart |=
          std::max(from[i], to[i]) < std::min({a[i], b[i], c[i]}) || std::min(from[i], to[i]) > std::max({a[i], b[i], c[i]});
    }
    if (is_apart) continue;
    const int at_start = side_of(a, b, c, from), at_end = side_of(a, b, c, to);
    if (at_start * at_end > 0) continue;
    const int e0 = side_of(from, to, a, b), e1 = side_of(from, to, b, c), e2 = side_of(from, to, c, a);
    if (std::max({e0, e1, e2}) > 0 && std::min({e0, e1, e2}) < 0) continue;
    if (at_start * at_end < 0 && e0 * e1 * e2 != 0) {
      ++result.proper;
    } else {
      result.touches = true;
    }
  }
  return result;
}

double ExactSolid::distance_to_surface(const Hip& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : triangles_) {
    const Hip u = difference(b, a), v = difference(c, a), w = difference(point, a);
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v), det = uu * vv - uv * uv;
    const double s = (vv * wu - uv * wv) / det, t = (uu * wv - uv * wu) / det;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      const Hip foot = {a[0] + s * u[0] + t * v[0], a[1] + s * u[1] + t * v[1], a[2] + s * u[2] + t * v[2]};
      nearest = std::min(nearest, distance(foot, point));
    }
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const Hip e = difference(q, p);
      const double along = std::clamp(dot(difference(point, p), e) / dot(e, e), 0.0, 1.0);
      nearest = std::min(nearest, distance({p[0] + along * e[0], p[1] + along * e[1], p[2] + along * e[2]}, point));
    }
  }
  return nearest;
}

ExactSolid::Where ExactSolid::where(const Hip& point) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (point[i] < low_[i] || point[i] > high_[i]) return Where::outside;
  }
  for (const Hip& far : far_points_) {
    const Crossing way = crossing(far, point);
    if (!way.touches) return way.proper % 2 == 0 ? Where::outside : Where::inside;
  }
  return Where::surface;
}

}  // namespace fdcg::test
