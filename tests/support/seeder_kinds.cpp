// SPDX-License-Identifier: Apache-2.0
// One short function for each kind of defect, with the argument for what it predicts; together over 400 lines.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/vec3.hpp"
#include "seeder.hpp"

namespace fdcg::test {
namespace {

using bake::cross;
using bake::dot;
using bake::length;
using bake::operator+;
using bake::operator-;
using bake::operator*;

Vec3 as_float(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

}  // namespace

const std::map<std::string, bool (Seeder::*)()>& Seeder::planters() {
  static const std::map<std::string, bool (Seeder::*)()> kPlanters = {
      {"flip", &Seeder::flip_face},
      {"delete", &Seeder::delete_face},
      {"duplicate", &Seeder::duplicate_face},
      {"pinch", &Seeder::pinch_vertex},
      {"poke", &Seeder::poke_vertex},
      {"unweld", &Seeder::unweld_vertex},
      {"non-finite", &Seeder::non_finite_vertex},
      {"isolated", &Seeder::isolated_vertex},
      {"repeated-point", &Seeder::repeated_point},
      {"collapse", &Seeder::collapse_edge},
      {"repeated-corner", &Seeder::repeated_corner},
      {"collinear", &Seeder::collinear_face},
      {"bad-index", &Seeder::bad_index},
      {"split-edge", &Seeder::split_edge},
      {"fin", &Seeder::fin},
      {"moebius", &Seeder::moebius_band},
      {"fold", &Seeder::folded_pair},
      {"sliver", &Seeder::sliver},
      {"bow-tie", &Seeder::bow_tie},
      {"bulge", &Seeder::bulge},
  };
  return kPlanters;
}

std::vector<std::string> Seeder::kinds() {
  std::vector<std::string> names;
  for (const auto& [name, planter] : planters())
    names.push_back(name);
  return names;
}

bool Seeder::plant(const std::string& kind) {
  if (!(this->*planters().at(kind))()) return false;
  ++planted_[kind];
  return true;
}

bool Seeder::plant() {
  return plant(std::next(planters().begin(), random_.below(static_cast<std::uint32_t>(planters().size())))->first);
}

// All of its edges are then run along in the same direction twice.
bool Seeder::flip_face() {
  const auto f = free_face(false);
  if (!f) return false;
  const Polygon& loop = clean_loops_[*f];
  std::reverse(loops_[*f].begin(), loops_[*f].end());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vertex u = loop[i], v = loop[(i + 1) % loop.size()];
    find("winding-inconsistent", {*f, across(u, v, *f)}, {u, v});
  }
  break_shell(*f);
  return true;
}

bool Seeder::delete_face() {
  const auto f = free_face(false);
  if (!f) return false;
  is_there_[*f] = false;
  find_hole(*f);
  break_shell(*f);
  return true;
}

// Each of its edges then has three faces; the two cover one another.
bool Seeder::duplicate_face() {
  const auto f = free_face(false);
  if (!f) return false;
  Polygon loop = clean_loops_[*f];
  if (random_.chance(0.5)) std::reverse(loop.begin(), loop.end());
  const Face copy = add_face(loop, CleanMesh::kNone);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vertex u = loop[i], v = loop[(i + 1) % loop.size()];
    find("non-manifold-edge", {*f, copy, across(u, v, *f)}, {u, v});
  }
  find("duplicate-face", {*f, copy});
  find("self-intersection", {*f, copy});
  dropped_.insert(copy);
  break_shell(*f);
  return true;
}

// A pit from one side of a wall to a vertex of the other: two fans in one vertex. Kept apart, they touch: each face of the one
// with each of the other.
bool Seeder::pinch_vertex() {
  if (clean_.facing.empty()) return false;
  const auto [v, w] = clean_.facing[random_.below(static_cast<std::uint32_t>(clean_.facing.size()))];
  if (!claim({v, w})) return false;
  if (setting_.has_vertices && random_.chance(0.5)) {  // by number; v is left without faces
    for (const Face f : faces_at_[v])
      *std::find(loops_[f].begin(), loops_[f].end(), v) = w;
    find("non-manifold-vertex", {}, {w});
    return true;
  }
  make_equal(v, w);
  if (setting_.welds) {
    find("non-manifold-vertex", {}, {v});
    return true;
  }
  for (const Face f : faces_at_[v]) {
    for (const Face g : faces_at_[w])
      find("self-intersection", {f, g});
  }
  return true;
}

// Through the middle of a face of the other side, a little: all of the tip's faces cross that face and nothing else.
bool Seeder::poke_vertex() {
  constexpr double kBeyond = 0.03;  // of the way there: the tip's cross-section with the face is that fraction of its foot
  if (clean_.facing.empty()) return false;
  const auto [v, w] = clean_.facing[random_.below(static_cast<std::uint32_t>(clean_.facing.size()))];
  const Face f = faces_at_[w][random_.below(static_cast<std::uint32_t>(faces_at_[w].size()))];
  Polygon core = clean_loops_[f];
  core.push_back(v);
  if (!claim(core)) return false;
  Vec3 middle;
  for (const Vertex c : clean_loops_[f])
    middle = middle + 1.0 / static_cast<double>(clean_loops_[f].size()) * points_[c];
  points_[v] = as_float(middle + kBeyond * (middle - points_[v]));
  for (const Face g : faces_at_[v])
    find("self-intersection", {f, g});
  return true;
}

// Welded nothing changes. Kept apart each of the vertex' edges opens, one boundary for either face, and its faces touch at the
// common point.
bool Seeder::unweld_vertex() {
  if (!setting_.has_vertices) return false;
  const auto v = free_vertex(&Seeder::is_triangle_fan);
  if (!v) return false;
  std::vector<Vertex> copies;
  cut_apart(*v, copies);
  for (const Vertex copy : copies)
    make_equal(copy, *v);
  if (setting_.welds) return true;
  const std::vector<Face>& faces = faces_at_[*v];
  for (std::size_t k = 0; k < faces.size(); ++k) {
    for (const Vertex end : clean_loops_[faces[k]]) {
      if (end != *v) find("boundary-edge", {faces[k]}, {copies[k], end});
    }
    for (std::size_t j = 0; j < k; ++j)
      find("self-intersection", {faces[j], faces[k]});
  }
  break_shell(faces[0]);
  return true;
}

// A vertex that faces name keeps its place among them, whatever its coordinates. Corners without a vertex (STL) are each a NaN
// of their own, so that the faces come apart; where they end then is no finding of its own.
bool Seeder::non_finite_vertex() {
  if (!setting_.has_non_finite) return false;
  const auto v = free_vertex(&Seeder::is_triangle_fan);
  if (!v) return false;
  std::vector<Vertex> copies = {*v};
  const std::vector<Face>& faces = faces_at_[*v];
  if (!setting_.has_vertices) cut_apart(*v, copies);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
  for (const Vertex copy : copies) {
    double* const coordinates[] = {&points_[copy].x, &points_[copy].y, &points_[copy].z};
    *coordinates[random_.below(3)] = bad[random_.below(3)];
    find("non-finite-coordinate", {}, {copy});
  }
  dropped_.insert(faces.begin(), faces.end());
  break_shell(faces[0]);
  return true;
}

bool Seeder::isolated_vertex() {
  if (!setting_.has_vertices) return false;
  add_point(far_away());
  return true;
}

// Isolated, or joined to the vertex at the same point; number_file() sees to both.
bool Seeder::repeated_point() {
  if (!setting_.has_vertices) return false;
  const Vertex v = random_.below(static_cast<std::uint32_t>(faces_at_.size()));
  if (is_taken_[v]) return false;
  is_taken_[v] = true;
  make_equal(add_point({}), v);
  return true;
}

bool Seeder::keeps_shape(Vertex v, const Vec3& p, const std::vector<Face>& gone) const {
  for (const Face f : faces_at_[v]) {
    if (std::find(gone.begin(), gone.end(), f) != gone.end()) continue;
    Vec3 old_corner[3], corner[3];
    for (std::size_t i = 0; i < 3; ++i) {
      old_corner[i] = points_[clean_loops_[f][i]];
      corner[i] = clean_loops_[f][i] == v ? p : old_corner[i];
    }
    const Vec3 was = cross(old_corner[1] - old_corner[0], old_corner[2] - old_corner[0]);
    const Vec3 is = cross(corner[1] - corner[0], corner[2] - corner[0]);
    double sides = 0;
    for (std::size_t i = 0; i < 3; ++i)
      sides += dot(corner[i] - corner[(i + 1) % 3], corner[i] - corner[(i + 1) % 3]);
    constexpr double kSameWay = 0.5, kNotThin = 0.1;  // cosine of the turn; twice the area over the squared sides
    if (!(dot(was, is) > kSameWay * length(was) * length(is)) || !(length(is) > kNotThin * sides)) return false;
  }
  return true;
}

// One end of an edge is moved onto the other: its two triangles have no area. What remains closes up again, since no third
// triangle joins the two ends' neighbours. Kept apart, the faces of the one end touch those of the other.
bool Seeder::collapse_edge() {
  constexpr int kTries = 30;
  for (int i = 0; i < kTries; ++i) {
    const Vertex v = random_.below(static_cast<std::uint32_t>(faces_at_.size()));
    if (!is_triangle_fan(v)) continue;
    std::vector<Vertex> ends = ring(v);
    const Vertex u = ends[random_.below(static_cast<std::uint32_t>(ends.size()))];
    const std::vector<Face> gone = {face_with(v, u), face_with(u, v)};
    if (!is_triangle_fan(u) || !keeps_shape(v, points_[u], gone)) continue;
    std::vector<Vertex> others = ring(u), common;
    std::sort(ends.begin(), ends.end());
    std::sort(others.begin(), others.end());
    std::set_intersection(ends.begin(), ends.end(), others.begin(), others.end(), std::back_inserter(common));
    if (common.size() != 2 || !claim({u, v})) continue;
    make_equal(v, u);
    for (const Face f : gone) {
      find("degenerate-face", {f});
      dropped_.insert(f);
    }
    const auto is_gone = [&](Face f) { return f == gone[0] || f == gone[1]; };
    for (const Face f : faces_at_[v]) {
      for (const Face g : faces_at_[u]) {
        if (!setting_.welds && !is_gone(f) && !is_gone(g)) find("self-intersection", {f, g});
      }
    }
    return true;
  }
  return false;
}

// A further face that names a corner twice: it takes no part in anything else.
bool Seeder::repeated_corner() {
  const auto f = free_face(false);
  if (!f) return false;
  const Vertex a = clean_loops_[*f][0], b = clean_loops_[*f][1];
  const Face face = add_face(random_.chance(0.5) ? Polygon{a, b, b} : Polygon{a, b, a}, CleanMesh::kNone);
  find("degenerate-face", {face});
  dropped_.insert(face);
  return true;
}

// Three points on a line, apart from everything: three boundary edges, on one of which the middle corner lies.
bool Seeder::collinear_face() {
  const Vec3 at = far_away(), step{0.5, 1, -0.25};
  const Vertex a = add_point(at), b = add_point(at + step), c = add_point(at + 3 * step);
  const Face f = add_face({a, b, c}, CleanMesh::kNone);
  find("degenerate-face", {f});
  dropped_.insert(f);
  find("boundary-edge", {f}, {a, b});
  find("boundary-edge", {f}, {b, c});
  find("boundary-edge", {f}, {c, a});
  return true;
}

// The face drops out and leaves its hole.
bool Seeder::bad_index() {
  if (!setting_.has_bad_indices) return false;
  const auto f = free_face(false);
  if (!f) return false;
  loops_[*f][random_.below(static_cast<std::uint32_t>(loops_[*f].size()))] = PolygonSoup::kInvalidVertex;
  find("index-out-of-range", {*f});
  dropped_.insert(*f);
  find_hole(*f);
  break_shell(*f);
  return true;
}

// One of an edge's faces is cut in two there, the other is not: a boundary of three edges, the new vertex inside the long one.
// The halves lie along the other face's edge without sharing it.
bool Seeder::split_edge() {
  constexpr int kTries = 30;
  for (int i = 0; i < kTries; ++i) {
    const Face f = random_.below(static_cast<std::uint32_t>(clean_loops_.size()));
    const Polygon& loop = clean_loops_[f];
    const std::uint32_t k = random_.below(3);
    if (loop.size() != 3) continue;
    const Vertex u = loop[k], v = loop[(k + 1) % 3], w = loop[(k + 2) % 3];
    const Vec3 middle = 0.5 * (points_[u] + points_[v]);
    const Face g = face_with(v, u);
    if (as_float(middle) != middle || clean_loops_[g].size() != 3 || !claim({u, v, w})) continue;
    const Vertex m = add_point(middle);
    loops_[f] = {u, m, w};
    const Face half = add_face({m, v, w}, shell_of_[f]);
    find("boundary-edge", {g}, {u, v});
    find("boundary-edge", {f}, {u, m});
    find("boundary-edge", {half}, {m, v});
    find("t-junction", {g}, {m, u, v});
    find("self-intersection", {f, g});
    find("self-intersection", {half, g});
    break_shell(f);
    return true;
  }
  return false;
}

// A third face on an edge, standing out.
bool Seeder::fin() {
  const auto f = free_face(false);
  if (!f) return false;
  const Vertex u = clean_loops_[*f][0], v = clean_loops_[*f][1];
  const Face g = face_with(v, u);
  Vec3 out;
  for (const Face side : {*f, g}) {
    const Polygon& loop = clean_loops_[side];
    Vec3 area;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      area = area + cross(points_[loop[i]] - points_[loop[0]], points_[loop[i + 1]] - points_[loop[0]]);
    out = out + 1 / length(area) * area;
  }
  if (is_reversed_[shell_of_[*f]]) out = -1 * out;
  constexpr double kHeight = 0.7;  // over the edge's length
  const double height = kHeight * length(points_[u] - points_[v]);
  const Vertex tip = add_point(as_float(0.5 * (points_[u] + points_[v]) + height / length(out) * out));
  const Face third = add_face(random_.chance(0.5) ? Polygon{u, v, tip} : Polygon{v, u, tip}, CleanMesh::kNone);
  find("non-manifold-edge", {*f, g, third}, {u, v});
  find("boundary-edge", {third}, {u, tip});
  find("boundary-edge", {third}, {v, tip});
  break_shell(*f);
  return true;
}

// A band closed with half a turn: at the seam alone two faces run the same way.
bool Seeder::moebius_band() {
  constexpr std::uint32_t kQuads = 14;
  constexpr double kPi = 3.14159265358979323846, kRadius = 2, kHalfWidth = 0.3;
  const Vec3 at = far_away();
  std::vector<Vertex> v;
  for (std::uint32_t i = 0; i < kQuads; ++i) {
    const double a = 2 * kPi * i / kQuads;
    for (const double s : {-kHalfWidth, kHalfWidth}) {
      const double r = kRadius + s * std::cos(a / 2);
      v.push_back(add_point(as_float(at + Vec3{r * std::cos(a), r * std::sin(a), s * std::sin(a / 2)})));
    }
  }
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < kQuads; ++i) {
    const bool seam = i + 1 == kQuads;
    const Vertex a = v[2 * i], b = v[2 * i + 1], c = seam ? v[1] : v[2 * i + 2], d = seam ? v[0] : v[2 * i + 3];
    faces.push_back(add_face({a, c, b}, CleanMesh::kNone));
    find("boundary-edge", {faces.back()}, {a, c});
    faces.push_back(add_face({b, c, d}, CleanMesh::kNone));
    find("boundary-edge", {faces.back()}, {b, d});
  }
  find("winding-inconsistent", {faces.front(), faces.back()}, {v[0], v[1]});
  find("not-orientable", faces);  // listed by its first face
  return true;
}

bool Seeder::folded_pair() {
  const Vec3 at = far_away();
  const Vertex a = add_point(at), b = add_point(at + Vec3{1, 0, 0.5}), c = add_point(at + Vec3{0.5, 1, 0.25}),
               d = add_point(at + Vec3{0.25, 0.75, 0.125});  // all on z = x / 2
  const bool same_way = random_.chance(0.5);
  const Face f = add_face({a, b, c}, CleanMesh::kNone),
             g = add_face(same_way ? Polygon{a, b, d} : Polygon{b, a, d}, CleanMesh::kNone);
  find("folded-edge", {f, g}, {a, b});
  find("self-intersection", {f, g});
  if (same_way) find("winding-inconsistent", {f, g}, {a, b});
  find("boundary-edge", {f}, {b, c});
  find("boundary-edge", {f}, {c, a});
  find("boundary-edge", {g}, {a, d});
  find("boundary-edge", {g}, {d, b});
  return true;
}

bool Seeder::sliver() {
  const Vec3 at = far_away();
  const Vertex a = add_point(at), b = add_point(at + Vec3{1, 0, 0}), c = add_point(at + Vec3{0.5, 0x1p-12, 0});
  const Face f = add_face({a, b, c}, CleanMesh::kNone);
  find("sliver-face", {f});
  find("boundary-edge", {f}, {a, b});
  find("boundary-edge", {f}, {b, c});
  find("boundary-edge", {f}, {c, a});
  return true;
}

bool Seeder::bow_tie() {
  if (setting_.triangles_only) return false;
  const Vec3 at = far_away();
  const Vertex a = add_point(at), b = add_point(at + Vec3{1, 1, 0}), c = add_point(at + Vec3{1, 0, 0}),
               d = add_point(at + Vec3{0, 1, 0});
  const Face f = add_face({a, b, c, d}, CleanMesh::kNone);
  find("self-crossing-face", {f});
  const Vertex loop[] = {a, b, c, d};
  for (std::size_t i = 0; i < 4; ++i)
    find("boundary-edge", {f}, {loop[i], loop[(i + 1) % 4]});
  return true;
}

// A vertex among polygons alone is pulled out: none of them stays flat.
bool Seeder::bulge() {
  constexpr int kTries = 60;
  constexpr double kPull = 0.2, kOff = 0.02;  // of the shortest edge: how far it moves, how far at least off each plane
  for (int i = 0; i < kTries; ++i) {
    const Vertex v = random_.below(static_cast<std::uint32_t>(faces_at_.size()));
    Vec3 out;
    std::vector<Vec3> normals;
    bool all_polygons = true;
    for (const Face f : faces_at_[v]) {
      const Polygon& loop = clean_loops_[f];
      all_polygons = all_polygons && loop.size() > 3;
      const Vec3 area = cross(points_[loop[1]] - points_[loop[0]], points_[loop[2]] - points_[loop[0]]);
      normals.push_back(1 / length(area) * area);
      out = out + normals.back();
    }
    if (!all_polygons || !claim({v})) continue;
    double shortest = std::numeric_limits<double>::infinity();
    for (const Vertex end : ring(v))
      shortest = std::min(shortest, length(points_[end] - points_[v]));
    const double sign = is_reversed_[shell_of_[faces_at_[v][0]]] ? -1 : 1;
    const Vec3 moved = as_float(points_[v] + sign * kPull * shortest / length(out) * out);
    if (std::any_of(normals.begin(), normals.end(),
                    [&](const Vec3& n) { return std::abs(dot(n, moved - points_[v])) < kOff * shortest; }))
      continue;  // the room is spent, no harm done
    points_[v] = moved;
    for (const Face f : faces_at_[v])
      find("non-planar-face", {f});
    return true;
  }
  return false;
}

}  // namespace fdcg::test
