// SPDX-License-Identifier: Apache-2.0
// Shared by all kinds of defects; the kinds are in seeder_kinds.cpp.
#include "seeder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fdcg::test {
namespace {

constexpr std::uint32_t kNone = CleanMesh::kNone;

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
  reverse_shell(random_.below(static_cast<std::uint32_t>(clean_.shells.size())));
}

void Seeder::reverse_shell(std::uint32_t s) {
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

// Undamaged shells enclose volume; a shell is at an even depth if it is inside an even number of them.
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
