// SPDX-License-Identifier: Apache-2.0
#include "certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "random.hpp"
#include "ulp.hpp"

namespace fdcg::test {
namespace {

constexpr double kTie_ulps = 64;      // two minima so near one another are one to rounding
constexpr double kTieDeviations = 4;  // ... and to what merging moved: two planes, each off by the deviation, on both sides

Vector<Rational> exactly(const double* v) {
  return {Rational(v[0]), Rational(v[1]), Rational(v[2])};
}

int sign(const Rational& a) {
  return sgn(a);
}

double length_in(const Vector<Rational>& v, double unit) {
  const double x = v.x.get_d() / unit, y = v.y.get_d() / unit, z = v.z.get_d() / unit;
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

Certificate::Certificate(const fdcg_graph& graph)
    : ulp_(ulp_of_extent(*graph.header)),
      extent_(graph.header->extent),
      epsilon_(graph.header->real_bytes == sizeof(float) ? std::numeric_limits<float>::epsilon()
                                                         : std::numeric_limits<double>::epsilon()),
      tie_ulps_(kTie_ulps + kTieDeviations * graph.header->max_deviation / ulp_) {
  read(graph);
}

void Certificate::read(const fdcg_graph& graph) {
  corners_.resize(graph.header->corner_count);
  for (std::uint32_t v = 0; v < corners_.size(); ++v) {
    const fdcg_corner_info record = fdcg_get_corner(&graph, v);
    corners_[v].point = exactly(record.point);
    corners_[v].is_open = record.is_open != 0;
  }
  edges_.resize(graph.header->connection_count);
  for (std::uint32_t c = 0; c < edges_.size(); ++c) {
    const fdcg_connection_info record = fdcg_get_connection(&graph, c);
    Edge& edge = edges_[c];
    for (std::size_t k = 0; k < 2; ++k) {
      edge.corner[k] = record.corner[k];
      edge.face[k] = record.node[k];
      edge.side[k] = record.side[k];
      corners_[record.corner[k]].connections.push_back(c);
    }
    edge.type = record.type;
    edge.span = corners_[edge.corner[1]].point - corners_[edge.corner[0]].point;
    edge.span2 = dot(edge.span, edge.span);
  }
  faces_.resize(graph.header->node_count);
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    const fdcg_node_info record = fdcg_get_node(&graph, f);
    for (std::uint32_t k = 0; k < record.side_count; ++k) {
      const fdcg_side_info side = fdcg_get_side(&graph, f, k);
      faces_[f].connections.push_back(side.connection);
      faces_[f].corners.push_back(side.corner);
      corners_[side.corner].faces.push_back(f);
    }
    derive_face(faces_[f], record);
  }
  for (Edge& edge : edges_)
    derive_type(edge);
}

// Of two faces that lie back to back, and of merged faces off their corners, the stored one stands.
void Certificate::derive_type(Edge& edge) const {
  if (edge.face[1] == FDCG_NONE) return;
  const Face &a = faces_[edge.face[0]], &b = faces_[edge.face[1]];
  if (!a.is_planar || !b.is_planar) return;
  const int turn = sign(dot(cross(a.normal, b.normal), edge.span));
  if (turn == 0 && sign(dot(a.normal, b.normal)) < 0) return;
  edge.type = turn > 0 ? FDCG_CONVEX : turn < 0 ? FDCG_CONCAVE : FDCG_COPLANAR;
}

void Certificate::derive_face(Face& face, const fdcg_node_info& record) {
  const std::size_t n = face.corners.size();
  const auto at = [&](std::size_t k) -> const Point& { return corners_[face.corners[k % n]].point; };
  face.is_planar = (record.flags & FDCG_NODE_INEXACT) == 0;
  if (!face.is_planar) {
    face.normal = exactly(record.normal);
    face.normal2 = dot(face.normal, face.normal);
    face.through = face.normal * Rational(-Rational(record.offset) / face.normal2);
  } else {
    for (std::size_t k = 1; k + 1 < n; ++k)
      face.normal = face.normal + cross(at(k) - at(0), at(k + 1) - at(0));
    face.normal2 = dot(face.normal, face.normal);
    face.through = at(0);
  }
  for (std::size_t k = 0; k < n; ++k)
    face.outward.push_back(cross(at(k + 1) - at(k), face.normal));
}

// ---- local minima ----------------------------------------------------------------------------------------------------------

bool Certificate::holds(CertifiedFeature feature, const std::array<double, 3>& hip_local) const {
  return feature_holds(feature, exactly(hip_local.data()));
}

bool Certificate::feature_holds(CertifiedFeature feature, const Point& hip) const {
  switch (feature.state) {
    case FDCG_FACE:
      return face_holds(feature.index, hip);
    case FDCG_EDGE:
      return edge_holds(feature.index, hip);
    case FDCG_VERTEX:
      return corner_holds(feature.index, hip);
    default:
      return false;
  }
}

bool Certificate::face_holds(std::uint32_t f, const Point& hip) const {
  const Face& face = faces_[f];
  if (sign(dot(face.normal, hip - face.through)) > 0) return false;
  std::vector<std::uint32_t> met;  // sides that the foot is on the line of
  for (std::size_t k = 0; k < face.corners.size(); ++k) {
    const int s = sign(dot(face.outward[k], hip - corners_[face.corners[k]].point));
    if (s > 0) return false;
    if (s == 0) met.push_back(face.connections[k]);
  }
  if (met.empty()) return true;
  return std::any_of(met.begin(), met.end(), [&](std::uint32_t c) { return edge_holds(c, hip); });
}

bool Certificate::edge_holds(std::uint32_t c, const Point& hip) const {
  const Edge& edge = edges_[c];
  const Rational u = dot(hip - corners_[edge.corner[0]].point, edge.span);
  const int from_start = sign(u), from_end = sign(Rational(edge.span2 - u));
  if (from_start < 0 || from_end < 0) return false;
  if (from_start == 0) return corner_holds(edge.corner[0], hip);
  if (from_end == 0) return corner_holds(edge.corner[1], hip);
  return inside_of_edge_holds(edge, hip);
}

// Along a face the way down begins at its edge where the HIP is on the face's side of the Voronoi plane. With no such way only
// a concave edge holds: at a convex one the HIP is outside.
bool Certificate::inside_of_edge_holds(const Edge& edge, const Point& hip) const {
  if (edge.face[1] == FDCG_NONE) return false;
  const Point t = hip - corners_[edge.corner[0]].point;
  for (std::size_t k = 0; k < 2; ++k) {
    if (sign(dot(faces_[edge.face[k]].outward[edge.side[k]], t)) < 0) return false;
  }
  if (edge.type == FDCG_CONCAVE) return true;
  return edge.type == FDCG_COPLANAR && sign(dot(faces_[edge.face[0]].normal, t)) <= 0;
}

bool Certificate::corner_holds(std::uint32_t v, const Point& hip) const {
  const Corner& corner = corners_[v];
  const Point t = hip - corner.point;
  if (corner.is_open) return false;
  for (const std::uint32_t c : corner.connections) {
    const int along = sign(dot(edges_[c].span, t));
    if (edges_[c].corner[0] == v ? along > 0 : along < 0) return false;
  }
  for (const std::uint32_t f : corner.faces) {
    if (climbs_into(faces_[f], v, t)) return false;
  }
  return is_behind_corner(v, t);
}

// Whether the foot of t on the face's plane lies within the face's sector at the corner.
bool Certificate::climbs_into(const Face& face, std::uint32_t corner, const Point& t) const {
  const std::size_t n = face.corners.size();
  const auto k = static_cast<std::size_t>(std::find(face.corners.begin(), face.corners.end(), corner) - face.corners.begin());
  return sign(dot(face.outward[k], t)) < 0 && sign(dot(face.outward[(k + n - 1) % n], t)) < 0;
}

// All edges and faces of the corner point away from t. Then all directions that do not are on one side of the surface, and the
// edge that points away least tells which: nothing lies between it and t.
bool Certificate::is_behind_corner(std::uint32_t v, const Point& t) const {
  const Edge* nearest = nullptr;
  Rational least;  // squared cosine to the edge's other way, times |t|^2
  for (const std::uint32_t c : corners_[v].connections) {
    const Rational along = dot(edges_[c].span, t);
    const Rational cosine2 = along * along / edges_[c].span2;
    if (nearest != nullptr && cosine2 >= least) continue;
    nearest = &edges_[c];
    least = cosine2;
  }
  if (nearest == nullptr) return false;
  const bool is_behind_a = sign(dot(faces_[nearest->face[0]].normal, t)) <= 0;
  const bool is_behind_b = sign(dot(faces_[nearest->face[1]].normal, t)) <= 0;
  return nearest->type == FDCG_CONCAVE ? is_behind_a || is_behind_b : is_behind_a && is_behind_b;
}

Certificate::Point Certificate::foot(CertifiedFeature feature, const Point& hip) const {
  if (feature.state == FDCG_VERTEX) return corners_[feature.index].point;
  if (feature.state == FDCG_EDGE) {
    const Edge& edge = edges_[feature.index];
    const Point& start = corners_[edge.corner[0]].point;
    return start + edge.span * Rational(dot(hip - start, edge.span) / edge.span2);
  }
  const Face& face = faces_[feature.index];
  return hip - face.normal * Rational(dot(face.normal, hip - face.through) / face.normal2);
}

// All that meets the feature: what shares a corner with it.
std::vector<CertifiedFeature> Certificate::around(CertifiedFeature feature) const {
  std::vector<std::uint32_t> corners = {feature.index};
  if (feature.state == FDCG_EDGE) corners.assign(edges_[feature.index].corner.begin(), edges_[feature.index].corner.end());
  if (feature.state == FDCG_FACE) corners = faces_[feature.index].corners;
  std::vector<CertifiedFeature> result;
  for (const std::uint32_t v : corners) {
    result.push_back({FDCG_VERTEX, v});
    for (const std::uint32_t c : corners_[v].connections)
      result.push_back({FDCG_EDGE, c});
    for (const std::uint32_t f : corners_[v].faces)
      result.push_back({FDCG_FACE, f});
  }
  return result;
}

// A slide that ends so near a side's plane ends on the side: 4 eps (|x|_1 + extent). Where two faces are equally near, each
// sends the god-object back to their edge, and it rests there.
double Certificate::rim_ulps(CertifiedFeature feature, const Point& minimum, const Point& god_object) const {
  if (feature.state != FDCG_FACE) return 0;
  const Face& face = faces_[feature.index];
  const double size = std::abs(minimum.x.get_d()) + std::abs(minimum.y.get_d()) + std::abs(minimum.z.get_d());
  const double rim = 4 * epsilon_ * (size + extent_);
  for (std::size_t k = 0; k < face.corners.size(); ++k) {
    const Point& corner = corners_[face.corners[k]].point;
    const double length = length_in(face.outward[k], 1);
    const auto is_on = [&](const Point& x) { return std::abs(dot(face.outward[k], x - corner).get_d()) <= rim * length; };
    if (is_on(minimum) && is_on(god_object)) return rim / ulp_;
  }
  return 0;
}

Certificate::Answer Certificate::check(const std::array<double, 3>& hip_local, const fdcg_contact& contact) const {
  if (contact.state == FDCG_FREE) throw std::invalid_argument("a certificate is for contacts");
  const Point hip = exactly(hip_local.data()), god_object = exactly(contact.god_object);
  const CertifiedFeature own = {contact.state, contact.feature};
  const Point own_foot = foot(own, hip);
  Answer answer = {Verdict::certified, own, length_in(god_object - own_foot, ulp_)};
  if (feature_holds(own, hip)) {
    answer.rim_ulps = rim_ulps(own, own_foot, god_object);
    return answer;
  }
  answer.verdict = Verdict::refused;
  for (const CertifiedFeature other : around(own)) {
    if (!feature_holds(other, hip)) continue;
    const Point other_foot = foot(other, hip);
    const double error_ulps = length_in(god_object - other_foot, ulp_);
    if (answer.verdict != Verdict::refused && error_ulps >= answer.error_ulps) continue;
    const bool is_near = error_ulps <= tie_ulps_ || length_in(own_foot - other_foot, ulp_) <= tie_ulps_;
    answer = {is_near ? Verdict::tie : Verdict::wrong_feature, other, error_ulps};
  }
  return answer;
}

// So far from a HIP, but for the rounding of its coordinates, towards the middle of a face, and a quarter as far behind its
// plane: at a needle's tip next to no move at random comes behind the face and over it.
std::array<double, 3> Certificate::moved_over(const Face& face, const std::array<double, 3>& hip, double by) const {
  Point middle;
  for (const std::uint32_t v : face.corners)
    middle = middle + corners_[v].point;
  const Vector<Rational> way =
      middle * Rational(Rational(1) / Rational(static_cast<double>(face.corners.size()))) - exactly(hip.data());
  const double length = length_in(way, 1), normal_length = length_in(face.normal, 1);
  const double along = by / std::max(length, by), behind = by / 4 / normal_length;
  return {hip[0] + along * way.x.get_d() - behind * face.normal.x.get_d(),
          hip[1] + along * way.y.get_d() - behind * face.normal.y.get_d(),
          hip[2] + along * way.z.get_d() - behind * face.normal.z.get_d()};
}

// So that the god-object is its foot on its own feature: on a long and thin body no move at random comes near that.
std::array<double, 3> Certificate::moved_below(const fdcg_contact& contact, const std::array<double, 3>& hip) const {
  const Vector<Rational> off = exactly(contact.god_object) - foot({contact.state, contact.feature}, exactly(hip.data()));
  return {hip[0] + off.x.get_d(), hip[1] + off.y.get_d(), hip[2] + off.z.get_d()};
}

// Moves in all directions, and along one axis.
bool Certificate::holds_nearby(const std::array<double, 3>& hip_local, const fdcg_contact& contact, double most_ulps) const {
  constexpr int kTriesOfASize = 12;
  Random random(1);
  const auto holds_at = [&](const std::array<double, 3>& hip) {
    const Verdict verdict = check(hip, contact).verdict;
    return verdict == Verdict::certified || verdict == Verdict::tie;
  };
  const std::array<double, 3> below = moved_below(contact, hip_local);
  const bool is_below_near = length_in(exactly(below.data()) - exactly(hip_local.data()), ulp_) <= most_ulps;
  for (double size = 1; size <= most_ulps; size *= 2) {
    for (const std::array<double, 3>& start : {hip_local, is_below_near ? below : hip_local}) {
      if (contact.state == FDCG_FACE && holds_at(moved_over(faces_[contact.feature], start, size / 2 * ulp_))) return true;
    }
    for (int i = 0; i < kTriesOfASize; ++i) {
      std::array<double, 3> moved = hip_local;
      for (std::size_t k = 0; k < 3; ++k) {
        if (i % 2 == 0 || i / 2 % 3 == static_cast<int>(k)) moved[k] += random.uniform(-size, size) * ulp_;
      }
      if (holds_at(moved)) return true;
    }
  }
  return is_below_near && holds_at(below);
}

}  // namespace fdcg::test
