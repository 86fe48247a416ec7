// SPDX-License-Identifier: Apache-2.0
// Points are located by a walk; segments become sides by exchanges of the diagonals that they cross (Sloan 1993).
#include "solid/plane_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/vec3.hpp"

namespace fdcg::bake {

PlaneTriangulation::PlaneTriangulation(MeetingPoints& meeting, std::uint32_t triangle, int axis)
    : meeting_(meeting), triangle_(triangle), axis_(axis) {
  const Triangle3& t = meeting.triangle(triangle);
  const ExactPoints& points = meeting.points();
  sign_ = points.orient2d(t[0], t[1], t[2], axis) < 0 ? -1 : 1;
  origin_ = points.near(t[0]);
  const Vec3 side = points.near(t[1]) - origin_, normal = cross(side, points.near(t[2]) - origin_);
  const double long_side = length(side), area = length(normal);
  x_ = long_side > 0 ? 1 / long_side * side : Vec3{1, 0, 0};
  y_ = area > 0 ? cross(1 / area * normal, x_) : Vec3{0, 1, 0};
}

void PlaneTriangulation::start(const std::array<PointId, 3>& corners) {
  for (const PointId p : corners)
    add_vertex(p);
  faces_.push_back({{0, 1, 2}});
  face_at_ = {0, 0, 0};
}

PlaneTriangulation::Local PlaneTriangulation::insert(PointId p) {
  for (Local v = 0; v < 3; ++v) {
    if (vertices_[v] == p) return v;
  }
  const Place place = locate(p);
  if (place.kind == Place::Kind::vertex) return faces_[place.face].corner[place.i];
  const Local v = add_vertex(p);
  place.kind == Place::Kind::face ? split_face(place.face, v) : split_side(place.face, place.i, v);
  legalise(v);
  return v;
}

bool PlaneTriangulation::insert_segment(Local a, Local b, const SupportLine& line, std::int32_t along) {
  const auto number = static_cast<std::uint32_t>(lines_.size());
  lines_.push_back(line);
  while (a != b) {
    const std::optional<Step> step = step_towards(a, b, number);
    if (!step || (step->is_made && !make_side(a, step->next))) return false;
    mark(a, step->next, number, along);
    a = step->next;
  }
  return true;
}

void PlaneTriangulation::improve() {
  std::vector<Corner> open;
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (std::uint32_t i = 0; i < 3; ++i)
      open.push_back({f, i});
  }
  constexpr std::size_t kExchanges = 20;  // of each face: far more than it takes; rounding might go in circles
  for (std::size_t left = kExchanges * faces_.size(); !open.empty() && left > 0; --left) {
    const auto [f, i] = open.back();
    open.pop_back();
    const std::uint32_t g = faces_[f].across[i];
    if (faces_[f].line[i] != kNothing || g == kNothing || !is_better_flipped(f, i) || !flip(f, i)) continue;
    for (const Corner side : {Corner{f, 0}, Corner{f, 2}, Corner{g, 0}, Corner{g, 1}})
      open.push_back(side);
  }
}

int PlaneTriangulation::orient(Local a, Local b, Local c) const {
  return sign_ * meeting_.points().orient2d(vertices_[a], vertices_[b], vertices_[c], axis_);
}

// For points of one line: it runs through them in lexicographic order.
bool PlaneTriangulation::is_ahead(Local from, Local to, Local x) const {
  const ExactPoints& points = meeting_.points();
  return points.compare(vertices_[from], vertices_[x]) == points.compare(vertices_[from], vertices_[to]);
}

std::optional<PlaneTriangulation::Place> PlaneTriangulation::place_in(std::uint32_t f, PointId p, std::uint32_t& beyond) const {
  const Face& face = faces_[f];
  std::array<int, 3> signs{};
  beyond = kNothing;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t i = (k + f) % 3;  // beginning with another side in each face, so that the walk does not circle
    signs[i] = sign_ * meeting_.points().orient2d(vertices_[face.corner[i]], vertices_[face.corner[(i + 1) % 3]], p, axis_);
    if (signs[i] >= 0) continue;
    beyond = face.across[i];
    return std::nullopt;
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (signs[i] == 0 && signs[(i + 2) % 3] == 0) return Place{Place::Kind::vertex, f, i};
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (signs[i] == 0) return Place{Place::Kind::side, f, i};
  }
  return Place{Place::Kind::face, f, 0};
}

PlaneTriangulation::Place PlaneTriangulation::locate(PointId p) {
  std::uint32_t beyond = kNothing, f = last_;
  for (std::size_t steps = 0; steps < 2 * faces_.size() + 16; ++steps) {
    if (const std::optional<Place> place = place_in(f, p, beyond)) {
      last_ = f;
      return *place;
    }
    if (beyond == kNothing) break;
    f = beyond;
  }
  for (f = 0; f < faces_.size(); ++f) {
    if (const std::optional<Place> place = place_in(f, p, beyond)) return *place;
  }
  return {Place::Kind::vertex, 0, 0};  // outside of the first triangle, against the contract
}

PlaneTriangulation::Local PlaneTriangulation::add_vertex(PointId p) {
  const Vec3 way = meeting_.points().near(p) - origin_;
  vertices_.push_back(p);
  flat_.push_back({dot(way, x_), dot(way, y_)});
  face_at_.push_back(kNothing);
  return static_cast<Local>(vertices_.size() - 1);
}

// Puts g across the side, and f across that of g.
void PlaneTriangulation::link(std::uint32_t f, std::uint32_t i, std::uint32_t g) {
  faces_[f].across[i] = g;
  if (g != kNothing) faces_[g].across[side_from(g, faces_[f].corner[(i + 1) % 3])] = f;
}

std::uint32_t PlaneTriangulation::side_from(std::uint32_t f, Local v) const {
  const Face& face = faces_[f];
  return face.corner[0] == v ? 0 : face.corner[1] == v ? 1 : 2;
}

void PlaneTriangulation::split_face(std::uint32_t f, Local v) {
  const Face old = faces_[f];
  const std::array<std::uint32_t, 3> part{f, static_cast<std::uint32_t>(faces_.size()),
                                          static_cast<std::uint32_t>(faces_.size() + 1)};
  faces_.resize(faces_.size() + 2);
  for (std::uint32_t i = 0; i < 3; ++i) {
    Face& face = faces_[part[i]];
    face = {{old.corner[i], old.corner[(i + 1) % 3], v}};
    face.line[0] = old.line[i];
    face.along[0] = old.along[i];
    face.across[1] = part[(i + 1) % 3];
    face.across[2] = part[(i + 2) % 3];
    face_at_[old.corner[i]] = part[i];
  }
  for (std::uint32_t i = 0; i < 3; ++i)
    link(part[i], 0, old.across[i]);
  face_at_[v] = f;
}

void PlaneTriangulation::split_side(std::uint32_t f, std::uint32_t i, Local v) {
  const std::uint32_t g = faces_[f].across[i];
  // Turned so that the side is the first: f from p to q, g from q to p.
  const auto halve = [&](std::uint32_t face, std::uint32_t side) {
    const Face old = faces_[face];
    const auto fresh = static_cast<std::uint32_t>(faces_.size());
    const std::uint32_t j = (side + 1) % 3, k = (side + 2) % 3;
    Face first{{old.corner[side], v, old.corner[k]}}, second{{v, old.corner[j], old.corner[k]}};
    first.line = {old.line[side], kNothing, old.line[k]};
    first.along = {old.along[side], 0, old.along[k]};
    second.line = {old.line[side], old.line[j], kNothing};
    second.along = {old.along[side], old.along[j], 0};
    first.across[1] = fresh;
    second.across[2] = face;
    faces_[face] = first;
    faces_.push_back(second);
    link(face, 2, old.across[k]);
    link(fresh, 1, old.across[j]);
    face_at_[old.corner[side]] = face_at_[old.corner[k]] = face_at_[v] = face;
    face_at_[old.corner[j]] = fresh;
    return fresh;
  };
  const std::uint32_t in_g = g == kNothing ? 0 : side_from(g, faces_[f].corner[(i + 1) % 3]);
  const std::uint32_t f_late = halve(f, i);
  if (g == kNothing) {
    faces_[f].across[0] = faces_[f_late].across[0] = kNothing;
    return;
  }
  const std::uint32_t g_late = halve(g, in_g);
  link(f, 0, g_late);
  link(f_late, 0, g);
}

// The quadrilateral p, s, q, r, whose diagonal p-q becomes s-r. False where it is not strictly convex.
bool PlaneTriangulation::flip(std::uint32_t f, std::uint32_t i) {
  const std::uint32_t g = faces_[f].across[i], j = side_from(g, faces_[f].corner[(i + 1) % 3]);
  const Face first = faces_[f], second = faces_[g];
  const auto after = [](std::uint32_t k) { return (k + 1) % 3; };
  const auto before = [](std::uint32_t k) { return (k + 2) % 3; };
  const Local p = first.corner[i], q = first.corner[after(i)], r = first.corner[before(i)], s = second.corner[before(j)];
  if (orient(s, q, r) <= 0 || orient(r, p, s) <= 0) return false;
  const auto take = [this](std::uint32_t to, std::uint32_t side, const Face& from, std::uint32_t old) {
    faces_[to].line[side] = from.line[old];
    faces_[to].along[side] = from.along[old];
    link(to, side, from.across[old]);
  };
  faces_[f] = {{p, s, r}};
  faces_[g] = {{s, q, r}};
  take(f, 0, second, after(j));
  take(f, 2, first, before(i));
  take(g, 0, second, before(j));
  take(g, 1, first, after(i));
  faces_[f].across[1] = g;
  faces_[g].across[2] = f;
  face_at_[p] = face_at_[s] = face_at_[r] = f;
  face_at_[q] = g;
  return true;
}

// The corner across lies inside of the circle, by more than rounding.
bool PlaneTriangulation::is_better_flipped(std::uint32_t f, std::uint32_t i) const {
  const std::uint32_t g = faces_[f].across[i];
  const auto& d = flat_[faces_[g].corner[(side_from(g, faces_[f].corner[(i + 1) % 3]) + 2) % 3]];
  std::array<double, 3> x{}, y{}, square{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& c = flat_[faces_[f].corner[k]];
    x[k] = c[0] - d[0];
    y[k] = c[1] - d[1];
    square[k] = x[k] * x[k] + y[k] * y[k];
  }
  double sum = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    sum += square[k] * (x[l] * y[m] - x[m] * y[l]);
    size += square[k] * (std::fabs(x[l] * y[m]) + std::fabs(x[m] * y[l]));
  }
  constexpr double kRounding = 1e-12;
  return sum > kRounding * size;
}

void PlaneTriangulation::legalise(Local v) {
  std::vector<std::uint32_t> open;
  for (const Corner& corner : corners_at(v))
    open.push_back(corner.face);
  for (std::size_t left = 64 + 4 * open.size(); !open.empty() && left > 0; --left) {
    const std::uint32_t f = open.back(), i = (side_from(f, v) + 1) % 3, g = faces_[f].across[i];
    open.pop_back();
    if (faces_[f].corner[(i + 2) % 3] != v || faces_[f].line[i] != kNothing || g == kNothing) continue;
    if (!is_better_flipped(f, i) || !flip(f, i)) continue;
    open.push_back(f);
    open.push_back(g);
  }
}

const std::vector<PlaneTriangulation::Corner>& PlaneTriangulation::corners_at(Local v) {
  around_.clear();
  const std::uint32_t first = face_at_[v];
  std::uint32_t f = first;
  do {
    const std::uint32_t i = side_from(f, v);
    around_.push_back({f, i});
    f = faces_[f].across[(i + 2) % 3];
  } while (f != kNothing && f != first);
  if (f == first) return around_;
  for (f = faces_[first].across[side_from(first, v)]; f != kNothing;) {  // at the rim: the other way round too
    const std::uint32_t i = side_from(f, v);
    around_.push_back({f, i});
    f = faces_[f].across[i];
  }
  return around_;
}

// Of the two faces there, that in which the side runs from a to b; where there is none, the other one.
std::optional<PlaneTriangulation::Corner> PlaneTriangulation::side_between(Local a, Local b) {
  std::optional<Corner> other;
  for (const auto [f, i] : corners_at(a)) {
    if (faces_[f].corner[(i + 1) % 3] == b) return Corner{f, i};
    if (faces_[f].corner[(i + 2) % 3] == b) other = Corner{f, (i + 2) % 3};
  }
  return other;
}

void PlaneTriangulation::mark(Local a, Local b, std::uint32_t line, std::int32_t along) {
  const std::optional<Corner> side = side_between(a, b);
  if (!side) return;
  const auto set = [&](std::uint32_t f, std::uint32_t i) {
    if (faces_[f].line[i] == kNothing) faces_[f].line[i] = line;
    faces_[f].along[i] += faces_[f].corner[i] == a ? along : -along;
  };
  set(side->face, side->i);
  const std::uint32_t g = faces_[side->face].across[side->i];
  if (g != kNothing) set(g, side_from(g, faces_[side->face].corner[(side->i + 1) % 3]));
}

// The next vertex on the segment from a to b: b, one that lies on it, or one that is made where it crosses another segment.
// `crossed_` becomes the diagonals on the way there.
std::optional<PlaneTriangulation::Step> PlaneTriangulation::step_towards(Local a, Local b, std::uint32_t line) {
  crossed_.clear();
  std::uint32_t f = kNothing, side = 0;
  for (const auto [face, i] : corners_at(a)) {
    const Local p = faces_[face].corner[(i + 1) % 3], q = faces_[face].corner[(i + 2) % 3];
    if (p == b || q == b) return Step{b};
    const int of_p = orient(a, b, p), of_q = orient(a, b, q);
    if (of_p == 0 && is_ahead(a, b, p)) return Step{p};
    if (of_q == 0 && is_ahead(a, b, q)) return Step{q};
    if (of_p >= 0 || of_q <= 0) continue;
    f = face;
    side = (i + 1) % 3;
    break;
  }
  while (f != kNothing) {
    const Local p = faces_[f].corner[side], q = faces_[f].corner[(side + 1) % 3];
    if (const std::uint32_t other = faces_[f].line[side]; other != kNothing) {
      const Local v = add_vertex(meeting_.crossing(triangle_, lines_[line], lines_[other], axis_));
      split_side(f, side, v);
      return Step{v, true};
    }
    crossed_.push_back({p, q});
    f = faces_[f].across[side];
    if (f == kNothing) break;
    const std::uint32_t from_q = side_from(f, q);
    const Local r = faces_[f].corner[(from_q + 2) % 3];
    if (r == b) return Step{b, true};
    const int of_r = orient(a, b, r);
    if (of_r == 0) return Step{r, true};
    side = (from_q + (of_r > 0 ? 1 : 2)) % 3;
  }
  return std::nullopt;
}

// Makes two vertices neighbours, between which only diagonals lie.
bool PlaneTriangulation::make_side(Local a, Local b) {
  std::deque<std::array<Local, 2>> open(crossed_.begin(), crossed_.end());
  const std::size_t count = open.size();
  for (std::size_t left = 64 + 16 * count * count; !open.empty() && left > 0; --left) {
    const auto [p, q] = open.front();
    open.pop_front();
    const std::optional<Corner> side = side_between(p, q);
    if (!side) return false;
    const std::uint32_t f = side->face, g = faces_[f].across[side->i];
    if (g == kNothing || !flip(f, side->i)) {
      open.push_back({p, q});
      continue;
    }
    const Local s = faces_[f].corner[1], r = faces_[f].corner[2];
    if (s == a || s == b || r == a || r == b) continue;
    if (orient(a, b, s) * orient(a, b, r) < 0) open.push_back({s, r});
  }
  return open.empty() && side_between(a, b).has_value();
}

}  // namespace fdcg::bake
