// SPDX-License-Identifier: Apache-2.0
#include "specimen.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "exact_sign.hpp"
#include "exact_solid.hpp"
#include "meshes.hpp"

namespace fdcg::test {
namespace {

constexpr std::uint32_t kMostCertified = 2000;  // nodes: rationals are slow to make

// The normal of a needle of 1e-6 has lost twenty digits of its products: in long double it is off by more than the step's.
__extension__ using Quad = __float128;
using QuadHip = std::array<Quad, 3>;
struct Plane {
  Hip normal;
  double offset;
};

QuadHip quad_way(const Hip& from, const Hip& to) {
  return {Quad(to[0]) - from[0], Quad(to[1]) - from[1], Quad(to[2]) - from[2]};
}
QuadHip quad_cross(const QuadHip& a, const QuadHip& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Hip unit_of(const QuadHip& a) {
  const auto length = std::sqrt(static_cast<long double>(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
  return {static_cast<double>(a[0] / length), static_cast<double>(a[1] / length), static_cast<double>(a[2] / length)};
}
Hip unit_way(const Hip& from, const Hip& to) {
  return unit_of(quad_way(from, to));
}
Plane plane_through(const Hip& normal, const Hip& point) {
  long double offset = 0;
  for (std::size_t i = 0; i < 3; ++i)
    offset -= static_cast<long double>(normal[i]) * point[i];
  return {normal, static_cast<double>(offset)};
}
Plane plane_of(const std::vector<Hip>& loop) {
  QuadHip sum = {0, 0, 0};
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    const QuadHip part = quad_cross(quad_way(loop[0], loop[k]), quad_way(loop[0], loop[k + 1]));
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += part[i];
  }
  return plane_through(unit_of(sum), loop[0]);
}
// Through a side, square to its face, its normal out of the face.
Plane rim_of(const Hip& start, const Hip& end, const Hip& normal) {
  return plane_through(unit_of(quad_cross(quad_way(start, end), {normal[0], normal[1], normal[2]})), start);
}

}  // namespace

Specimen::Specimen(Body b) : body(std::move(b)), mesh(body.soup, body.options) {
  read_corners();
  read_shapes();
  read_deviation();
  find_focus();
  const ExactSolid solid(triangulated(body.soup), header());
  descent = std::make_unique<Descent>(solid.triangles());
  if (!body.is_closed) return;
  inside = std::make_unique<InsideGrid>(solid.triangles());
  if (header().max_deviation == 0 && header().node_count <= kMostCertified)
    certificate = std::make_unique<Certificate>(graph());
}

// Throws where a corner is no point of the source, rounded to the file's numbers.
void Specimen::read_corners() {
  const fdcg_graph& g = graph();
  std::set<Hip> points;
  std::map<Hip, std::uint32_t> corners_at;
  for (const bake::Vec3& p : body.soup.points) {
    Hip local = {p.x - header().origin[0], p.y - header().origin[1], p.z - header().origin[2]};
    for (double& x : local)
      x = header().real_bytes == sizeof(float) ? static_cast<double>(static_cast<float>(x)) : x;
    points.insert(local);
  }
  for (std::uint32_t c = 0; c < header().corner_count; ++c) {
    const fdcg_corner_info corner = fdcg_get_corner(&g, c);
    corners.push_back({hip_of(corner.point), hip_of(corner.normal), false, false});
    if (points.count(corners.back().point) == 0) throw std::runtime_error("a corner of the graph is no point of its source");
    if (corner.fan_count > FDCG_BUSY_FAN) busy_points.push_back(corners.back().point);
    corners_at[corners.back().point] += 1;
  }
  for (CornerShape& corner : corners)
    corner.is_shared = corners_at[corner.point] > 1;
}

void Specimen::read_shapes() {
  const fdcg_graph& g = graph();
  for (std::uint32_t n = 0; n < header().node_count; ++n) {
    const fdcg_node_info node = fdcg_get_node(&g, n);
    std::vector<Hip> loop;
    for (std::uint32_t k = 0; k < node.side_count; ++k)
      loop.push_back(corners[fdcg_get_side(&g, n, k).corner].point);
    const bool is_planar = (node.flags & FDCG_NODE_INEXACT) == 0;
    const Plane plane = is_planar ? plane_of(loop) : Plane{hip_of(node.normal), node.offset};
    nodes.push_back({plane.normal, plane.offset, static_cast<std::uint32_t>(rims.size()), node.side_count, is_planar});
    for (std::uint32_t k = 0; k < node.side_count; ++k) {
      const Plane rim = rim_of(loop[k], loop[(k + 1) % loop.size()], plane.normal);
      rims.push_back({rim.normal, rim.offset, fdcg_get_side(&g, n, k).connection});
    }
  }
  for (std::uint32_t e = 0; e < header().connection_count; ++e) {
    const fdcg_connection_info c = fdcg_get_connection(&g, e);
    const Hip &start = corners[c.corner[0]].point, &end = corners[c.corner[1]].point;
    const double length = distance(start, end);
    const bool is_rim = c.node[1] == FDCG_NONE;
    const auto type = is_rim ? static_cast<std::uint32_t>(FDCG_BOUNDARY) : type_between(c.node[0], c.node[1], c.type);
    edges.push_back({start, unit_way(start, end), length, type, {c.corner[0], c.corner[1]}, {c.node[0], c.node[1]}});
    for (const std::uint32_t corner : c.corner)
      corners[corner].is_open = corners[corner].is_open || is_rim;
  }
}

int Specimen::exact_side(std::uint32_t node, const Hip& x) const {
  const fdcg_graph& g = graph();
  const auto point = [&](std::uint32_t k) -> const Hip& { return corners[fdcg_get_side(&g, node, k).corner].point; };
  const Hip &p = point(0), &q = point(1);
  std::uint32_t widest = 2;
  double most = 0;
  for (std::uint32_t k = 2; k < nodes[node].side_count; ++k) {
    const double area = norm(cross_product(difference(q, p), difference(point(k), p)));
    if (area > most) most = area, widest = k;
  }
  return exact_sign(p, q, point(widest), x);
}

// By exact signs of one face's corners against the other's plane; `stored` where merged faces have no exact planes, and where
// two faces lie back to back.
std::uint32_t Specimen::type_between(std::uint32_t a, std::uint32_t b, std::uint32_t stored) const {
  const fdcg_graph& g = graph();
  if (!nodes[a].is_planar || !nodes[b].is_planar || dot(nodes[a].normal, nodes[b].normal) < -0.999) return stored;
  const auto point = [&](std::uint32_t n, std::uint32_t k) -> const Hip& {
    return corners[fdcg_get_side(&g, n, k).corner].point;
  };
  int above = 0;  // of the corner of b that is farthest from a's plane; the others are on the same side, or on the plane
  double farthest = -1;
  for (std::uint32_t k = 0; k < nodes[b].side_count; ++k) {
    const double off = std::abs(signed_distance(nodes[a].normal, nodes[a].offset, point(b, k)));
    const int sign = exact_side(a, point(b, k));
    if (sign != 0 && off > farthest) farthest = off, above = sign;
  }
  return above > 0 ? FDCG_CONCAVE : above < 0 ? FDCG_CONVEX : FDCG_COPLANAR;
}

// The header has that of the corners that are left, the mass properties that of all.
void Specimen::read_deviation() {
  stated_deviation = header().max_deviation;
  const auto* const file = reinterpret_cast<const unsigned char*>(&header());
  const auto* const sections = reinterpret_cast<const fdcg_section*>(file + sizeof(fdcg_header));
  for (std::uint32_t i = 0; i < header().section_count; ++i) {
    if (sections[i].id != FDCG_SECTION_MASS) continue;
    fdcg_mass_record mass;
    std::memcpy(&mass, file + sections[i].offset, sizeof mass);
    stated_deviation = std::max(stated_deviation, mass.deviation);
  }
}

void Specimen::find_focus() {
  for (const std::uint32_t v : body.focus) {
    const bake::Vec3& p = body.soup.points[v];
    const double* origin = header().origin;
    const Hip local = {p.x - origin[0], p.y - origin[1], p.z - origin[2]};
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t corner = 0;
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
      const double d = distance(corners[c].point, local);
      if (d < nearest) nearest = d, corner = c;
    }
    focus_corners.push_back(corner);
  }
}

}  // namespace fdcg::test
