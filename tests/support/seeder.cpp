// SPDX-License-Identifier: Apache-2.0
// Over 400 lines: one short function for each kind of defect, with the argument for what it predicts.
#include "seeder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace fdcg::test {
namespace {

constexpr std::uint32_t kNone = CleanMesh::kNone;

Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3 operator*(const Vec3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3 as_float(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

template <class T>
void shuffle(std::vector<T>& list, Random& random) {
  for (std::size_t i = list.size(); i > 1; --i)
    std::swap(list[i - 1], list[random.below(static_cast<std::uint32_t>(i))]);
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> list) {
  std::sort(list.begin(), list.end());
  return list;
}

}  // namespace

Seeder::Seeder(const CleanMesh& clean, const Setting& setting, Random& random)
    : clean_(clean), setting_(setting), random_(random), points_(clean.soup.points) {
  for (std::uint32_t f = 0; f < clean.soup.face_count(); ++f)
    clean_loops_.push_back(face_corners(clean.soup, f));
  loops_ = clean_loops_;
  is_there_.assign(loops_.size(), true);
  faces_at_.resize(points_.size());
  for (Face f = 0; f < loops_.size(); ++f) {
    for (const Vertex v : loops_[f])
      faces_at_[v].push_back(f);
  }
  shell_of_.resize(loops_.size());
  for (std::uint32_t s = 0; s < clean.shells.size(); ++s)
    std::fill(shell_of_.begin() + clean.shells[s].first_face, shell_of_.begin() + clean.shells[s].end_face, s);
  is_broken_.resize(clean.shells.size());
  is_reversed_.resize(clean.shells.size());
  is_taken_.resize(points_.size());
  place_.resize(points_.size());
  std::iota(place_.begin(), place_.end(), 0U);
  for (const Vec3& p : points_)
    far_ = std::max(far_, std::ceil(p.x) + 8);
}

// ---- the clean mesh

Seeder::Face Seeder::face_with(Vertex from, Vertex to) const {
  for (const Face f : faces_at_[from]) {
    const Polygon& loop = clean_loops_[f];
    const auto at = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), from) - loop.begin());
    if (loop[(at + 1) % loop.size()] == to) return f;
  }
  return kNone;
}

Seeder::Face Seeder::across(Vertex u, Vertex v, Face f) const {
  const Face forward = face_with(u, v);
  return forward == f ? face_with(v, u) : forward;
}

std::vector<Seeder::Vertex> Seeder::ring(Vertex v) const {
  std::vector<Vertex> ends;
  Face f = faces_at_[v][0];
  do {
    const Polygon& loop = clean_loops_[f];
    const auto at = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), v) - loop.begin());
    ends.push_back(loop[(at + 1) % loop.size()]);
    f = face_with(v, loop[(at + loop.size() - 1) % loop.size()]);
  } while (f != faces_at_[v][0]);
  return ends;
}

bool Seeder::is_triangle_fan(Vertex v) const {
  return std::all_of(faces_at_[v].begin(), faces_at_[v].end(), [&](Face f) { return clean_loops_[f].size() == 3; });
}

// ---- room

bool Seeder::claim(const std::vector<Vertex>& core) {
  std::vector<Vertex> region;
  for (const Vertex c : core) {
    for (const Face f : faces_at_[c])
      region.insert(region.end(), clean_loops_[f].begin(), clean_loops_[f].end());
  }
  if (std::any_of(region.begin(), region.end(), [&](Vertex v) { return is_taken_[v]; })) return false;
  for (const Vertex v : region)
    is_taken_[v] = true;
  return true;
}

std::optional<Seeder::Face> Seeder::free_face(bool triangle) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const Face f = random_.below(static_cast<std::uint32_t>(clean_loops_.size()));
    if (triangle && clean_loops_[f].size() != 3) continue;
    if (claim(clean_loops_[f])) return f;
  }
  return std::nullopt;
}

std::optional<Seeder::Vertex> Seeder::free_vertex(bool (Seeder::*fits)(Vertex) const) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const Vertex v = random_.below(static_cast<std::uint32_t>(faces_at_.size()));
    if ((this->*fits)(v) && claim({v})) return v;
  }
  return std::nullopt;
}

Vec3 Seeder::far_away() {
  far_ += 8;
  return {far_, 0, 0};
}

// ---- changes

Seeder::Vertex Seeder::add_point(const Vec3& p) {
  points_.push_back(p);
  place_.push_back(static_cast<Vertex>(place_.size()));
  return place_.back();
}

Seeder::Face Seeder::add_face(const Polygon& loop, std::uint32_t shell) {
  loops_.push_back(loop);
  is_there_.push_back(true);
  shell_of_.push_back(shell);
  return static_cast<Face>(loops_.size() - 1);
}

void Seeder::find(const std::string& rule, std::vector<Face> faces, std::vector<Vertex> vertices) {
  found_.emplace(rule, Finding{std::move(faces), std::move(vertices)});
}

void Seeder::find_hole(Face f) {
  const Polygon& loop = clean_loops_[f];
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vertex u = loop[i], v = loop[(i + 1) % loop.size()];
    find("boundary-edge", {across(u, v, f)}, {u, v});
  }
}

// Every face at v but the first gets a vertex of its own there.
void Seeder::cut_apart(Vertex v, std::vector<Vertex>& copies) {
  copies = {v};
  for (std::size_t k = 1; k < faces_at_[v].size(); ++k) {
    Polygon& loop = loops_[faces_at_[v][k]];
    const Vertex copy = add_point(points_[v]);
    *std::find(loop.begin(), loop.end(), v) = copy;
    copies.push_back(copy);
  }
}

void Seeder::make_equal(Vertex v, Vertex w) {
  points_[v] = points_[w];
  if (setting_.welds) place_[v] = place_[w];
}

// ---- whole shells

void Seeder::reverse_shell() {
  const std::uint32_t s = random_.below(static_cast<std::uint32_t>(clean_.shells.size()));
  for (Face f = clean_.shells[s].first_face; f < clean_.shells[s].end_face; ++f) {
    std::reverse(clean_loops_[f].begin(), clean_loops_[f].end());
    loops_[f] = clean_loops_[f];
  }
  is_reversed_[s] = !is_reversed_[s];
  ++planted_["reverse-shell"];
}

// Edges between a face that was turned over and one that was not are inconsistent, all others are not.
bool Seeder::flip_many(double probability) {
  const CleanMesh::Shell& shell = clean_.shells[random_.below(static_cast<std::uint32_t>(clean_.shells.size()))];
  std::vector<Vertex> core;
  for (Face f = shell.first_face; f < shell.end_face; ++f)
    core.insert(core.end(), clean_loops_[f].begin(), clean_loops_[f].end());
  if (!claim(core)) return false;
  std::vector<bool> is_turned(loops_.size());
  std::uint32_t turned = 0;
  for (Face f = shell.first_face; f < shell.end_face; ++f) {
    if (!random_.chance(probability)) continue;
    is_turned[f] = true;
    ++turned;
    std::reverse(loops_[f].begin(), loops_[f].end());
  }
  for (Face f = shell.first_face; f < shell.end_face; ++f) {
    const Polygon& loop = clean_loops_[f];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vertex u = loop[i], v = loop[(i + 1) % loop.size()];
      const Face g = face_with(v, u);
      if (f < g && is_turned[f] != is_turned[g]) find("winding-inconsistent", {f, g}, {u, v});
    }
  }
  const std::uint32_t s = shell_of_[shell.first_face];
  if (turned == shell.end_face - shell.first_face) {
    is_reversed_[s] = !is_reversed_[s];
  } else if (turned > 0) {
    is_broken_[s] = true;
  }
  ++planted_["flip-many"];
  return true;
}

// An edge with one face left is a boundary. A vertex has as many fans as there are runs of faces left around it.
bool Seeder::delete_many(double probability) {
  const CleanMesh::Shell& shell = clean_.shells[random_.below(static_cast<std::uint32_t>(clean_.shells.size()))];
  std::set<Vertex> core;
  for (Face f = shell.first_face; f < shell.end_face; ++f)
    core.insert(clean_loops_[f].begin(), clean_loops_[f].end());
  if (!claim({core.begin(), core.end()})) return false;
  for (Face f = shell.first_face + 1; f < shell.end_face; ++f) {  // the first stays: no file without a face
    is_there_[f] = !random_.chance(probability);
    if (!is_there_[f]) break_shell(f);
  }
  for (Face f = shell.first_face; f < shell.end_face; ++f) {
    const Polygon& loop = clean_loops_[f];
    for (std::size_t i = 0; is_there_[f] && i < loop.size(); ++i) {
      const Vertex u = loop[i], v = loop[(i + 1) % loop.size()];
      if (!is_there_[face_with(v, u)]) find("boundary-edge", {f}, {u, v});
    }
  }
  for (const Vertex v : core) {
    int runs = 0;
    for (const Vertex end : ring(v))
      runs += is_there_[face_with(v, end)] && !is_there_[face_with(end, v)] ? 1 : 0;
    if (runs > 1) find("non-manifold-vertex", {}, {v});
  }
  ++planted_["delete-many"];
  return true;
}

// ---- single defects

const std::vector<std::string>& Seeder::kinds() {
  static const std::vector<std::string> kKinds = {
      "flip",     "delete",         "duplicate", "pinch",           "poke",      "unweld",    "non-finite",
      "isolated", "repeated-point", "collapse",  "repeated-corner", "collinear", "bad-index", "split-edge",
      "fin",      "moebius",        "fold",      "sliver",          "bow-tie",   "bulge"};
  return kKinds;
}

bool Seeder::plant(const std::string& kind) {
  static const std::map<std::string, bool (Seeder::*)()> kPlant = {
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
  if (!(this->*kPlant.at(kind))()) return false;
  ++planted_[kind];
  return true;
}

bool Seeder::plant() {
  return plant(kinds()[random_.below(static_cast<std::uint32_t>(kinds().size()))]);
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
  const Face copy = add_face(loop, kNone);
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
  constexpr double kBeyond = 0.06;  // of the way there: the tip's cross-section with the face is that fraction of its foot
  if (clean_.facing.empty()) return false;
  const auto [v, w] = clean_.facing[random_.below(static_cast<std::uint32_t>(clean_.facing.size()))];
  const Face f = faces_at_[w][random_.below(static_cast<std::uint32_t>(faces_at_[w].size()))];
  Polygon core = clean_loops_[f];
  core.push_back(v);
  if (!claim(core)) return false;
  Vec3 middle;
  for (const Vertex c : clean_loops_[f])
    middle = middle + points_[c] * (1.0 / static_cast<double>(clean_loops_[f].size()));
  points_[v] = as_float(middle + (middle - points_[v]) * kBeyond);
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
// of their own, so that the faces come apart.
bool Seeder::non_finite_vertex() {
  if (!setting_.has_non_finite) return false;
  const auto v = free_vertex(&Seeder::is_triangle_fan);
  if (!v) return false;
  std::vector<Vertex> copies = {*v};
  const std::vector<Face>& faces = faces_at_[*v];
  if (!setting_.has_vertices) {
    cut_apart(*v, copies);
    for (std::size_t k = 0; k < faces.size(); ++k) {
      for (const Vertex end : clean_loops_[faces[k]]) {
        if (end != *v) find("boundary-edge", {faces[k]}, {copies[k], end});
      }
    }
  }
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
// triangle joins the two ends' neighbours.
bool Seeder::collapse_edge() {
  constexpr int kTries = 30;
  for (int i = 0; i < kTries; ++i) {
    const Vertex v = random_.below(static_cast<std::uint32_t>(faces_at_.size()));
    if (!is_triangle_fan(v)) continue;
    std::vector<Vertex> ends = ring(v);
    const Vertex u = ends[random_.below(static_cast<std::uint32_t>(ends.size()))];
    const std::vector<Face> gone = {face_with(v, u), face_with(u, v)};
    if (!is_triangle_fan(u) || !keeps_shape(v, points_[u], gone)) continue;
    std::vector<Vertex> others = sorted(ring(u)), common;
    ends = sorted(ends);
    std::set_intersection(ends.begin(), ends.end(), others.begin(), others.end(), std::back_inserter(common));
    if (common.size() != 2 || !claim({u, v})) continue;
    make_equal(v, u);
    for (const Face f : gone) {
      find("degenerate-face", {f});
      dropped_.insert(f);
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
  const Face face = add_face(random_.chance(0.5) ? Polygon{a, b, b} : Polygon{a, b, a}, kNone);
  find("degenerate-face", {face});
  dropped_.insert(face);
  return true;
}

// Three points on a line, apart from everything: three boundary edges, on one of which the middle corner lies.
bool Seeder::collinear_face() {
  const Vec3 at = far_away(), step{0.5, 1, -0.25};
  const Vertex a = add_point(at), b = add_point(at + step), c = add_point(at + step * 3);
  const Face f = add_face({a, b, c}, kNone);
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
    const Vec3 middle = (points_[u] + points_[v]) * 0.5;
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
    out = out + area * (1 / length(area));
  }
  if (is_reversed_[shell_of_[*f]]) out = out * -1;
  constexpr double kHeight = 0.7;  // over the edge's length
  const double height = kHeight * length(points_[u] - points_[v]);
  const Vertex tip = add_point(as_float((points_[u] + points_[v]) * 0.5 + out * (height / length(out))));
  const Face third = add_face(random_.chance(0.5) ? Polygon{u, v, tip} : Polygon{v, u, tip}, kNone);
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
    faces.push_back(add_face({a, c, b}, kNone));
    find("boundary-edge", {faces.back()}, {a, c});
    faces.push_back(add_face({b, c, d}, kNone));
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
  const Face f = add_face({a, b, c}, kNone), g = add_face(same_way ? Polygon{a, b, d} : Polygon{b, a, d}, kNone);
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
  const Face f = add_face({a, b, c}, kNone);
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
  const Face f = add_face({a, b, c, d}, kNone);
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
      normals.push_back(area * (1 / length(area)));
      out = out + normals.back();
    }
    if (!all_polygons || !claim({v})) continue;
    double shortest = std::numeric_limits<double>::infinity();
    for (const Vertex end : ring(v))
      shortest = std::min(shortest, length(points_[end] - points_[v]));
    const double sign = is_reversed_[shell_of_[faces_at_[v][0]]] ? -1 : 1;
    const Vec3 moved = as_float(points_[v] + out * (sign * kPull * shortest / length(out)));
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

// ---- the finished mesh

SeededMesh Seeder::finish() {
  SeededMesh out;
  out.planted = planted_;
  number_file(out);
  const auto numbers = [](const std::vector<std::uint32_t>& list, const std::vector<std::uint32_t>& number) {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t i : list)
      result.push_back(number[i]);
    return sorted(result);
  };
  for (const auto& [rule, finding] : found_) {
    Place place{numbers(finding.faces, face_number_), numbers(finding.vertices, vertex_number_)};
    if (rule == "not-orientable") place.faces.resize(1);
    out.findings[rule].insert(std::move(place));
  }
  find_inside_out(out);
  count(out);
  return out;
}

// Also finds what depends on the numbering alone: joined and isolated vertices.
void Seeder::number_file(SeededMesh& out) {
  PolygonSoup& soup = out.soup;
  soup.name = "seeded";
  soup.relative_quantum = 0x1p-24;
  std::vector<Face> order;
  for (Face f = 0; f < loops_.size(); ++f) {
    if (is_there_[f]) order.push_back(f);
  }
  shuffle(order, random_);
  face_number_.assign(loops_.size(), kNone);
  std::vector<Vertex> point_at;  // the vertex of each of the file's points
  std::vector<std::uint32_t> number(points_.size(), kNone);
  if (setting_.has_vertices) {
    point_at.resize(points_.size());
    std::iota(point_at.begin(), point_at.end(), 0U);
    shuffle(point_at, random_);
    for (std::uint32_t n = 0; n < point_at.size(); ++n)
      number[point_at[n]] = n;
  }
  soup.face_first.push_back(0);
  std::vector<bool> is_used(points_.size());
  for (const Face f : order) {
    face_number_[f] = static_cast<std::uint32_t>(soup.face_first.size() - 1);
    Polygon& loop = loops_[f];
    std::rotate(loop.begin(), loop.begin() + random_.below(static_cast<std::uint32_t>(loop.size())), loop.end());
    for (const Vertex v : loop) {
      if (v != PolygonSoup::kInvalidVertex) is_used[place_[v]] = true;
      if (setting_.has_vertices) {
        soup.corners.push_back(v == PolygonSoup::kInvalidVertex ? v : number[v]);
      } else {
        soup.corners.push_back(static_cast<std::uint32_t>(point_at.size()));
        point_at.push_back(v);
      }
    }
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  std::vector<std::uint32_t> first_at(points_.size(), kNone);  // of each place
  for (std::uint32_t n = 0; n < point_at.size(); ++n) {
    const Vertex place = place_[point_at[n]];
    soup.points.push_back(points_[point_at[n]]);
    if (first_at[place] != kNone) {
      out.findings["duplicate-vertex"].insert({{}, {n}});
      continue;
    }
    first_at[place] = n;
    ++out.vertices;
    if (!is_used[place]) out.findings["isolated-vertex"].insert({{}, {n}});
  }
  vertex_number_.resize(points_.size());
  for (Vertex v = 0; v < points_.size(); ++v)
    vertex_number_[v] = first_at[place_[v]];
}

// Shells that came to no harm enclose volume; a shell is at an even depth if an even number of those lie around it.
void Seeder::find_inside_out(SeededMesh& out) const {
  std::vector<std::uint32_t> first_of(clean_.shells.size(), kNone);
  for (Face f = 0; f < loops_.size(); ++f) {
    const std::uint32_t s = shell_of_[f];
    if (s == kNone || !is_there_[f]) continue;
    std::set<Vertex> corners;
    for (const Vertex v : loops_[f])
      corners.insert(v == PolygonSoup::kInvalidVertex ? v : place_[v]);
    if (corners.size() == loops_[f].size()) first_of[s] = std::min(first_of[s], face_number_[f]);
  }
  for (std::uint32_t s = 0; s < clean_.shells.size(); ++s) {
    if (is_broken_[s] || clean_.shells[s].is_cavity == is_reversed_[s]) continue;
    int depth = 0;
    for (std::uint32_t around = clean_.shells[s].parent; around != kNone; around = clean_.shells[around].parent)
      depth += is_broken_[around] ? 0 : 1;
    if (depth % 2 == 0) out.findings["inside-out"].insert({{first_of[s]}, {}});
  }
}

void Seeder::count(SeededMesh& out) const {
  std::vector<Vertex> parent(points_.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](Vertex v) {
    while (parent[v] != v)
      v = parent[v] = parent[parent[v]];
    return v;
  };
  std::set<Vertex> roots;
  for (int pass = 0; pass < 2; ++pass) {
    for (Face f = 0; f < loops_.size(); ++f) {
      std::optional<Vertex> first;
      for (const Vertex v : loops_[f]) {
        if (!is_there_[f] || v == PolygonSoup::kInvalidVertex) continue;
        if (!first) first = root(place_[v]);
        if (pass == 0) parent[root(place_[v])] = *first = root(*first);
      }
      if (pass == 1 && first) roots.insert(*first);
    }
  }
  out.components = roots.size();
  out.kept_faces = out.soup.face_count() - dropped_.size();
}

}  // namespace fdcg::test
