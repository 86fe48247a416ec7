// SPDX-License-Identifier: Apache-2.0
#include "inside_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contact_rig.hpp"
#include "exact_sign.hpp"
#include "random.hpp"
#include "vector.hpp"

namespace fdcg::test {
namespace {

constexpr double kSlack = 1e-9;  // of a cell: more than the rounding of where its sides lie
constexpr int kTries = 8;        // points tried in a cell before it is given up

// Bounds first, then planes, then edges: most triangles of a cell go by the bounds.
// ends_on: the way touches it, and there it ends, whatever way it is.
enum class Meeting { apart, proper, touching, ends_on };

Meeting meeting(const Triangle& t, const Hip& from, const Hip& to) {
  const auto& [a, b, c] = t;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({a[i], b[i], c[i]});
    if (std::max(from[i], to[i]) < low || std::min(from[i], to[i]) > high) return Meeting::apart;
  }
  const int at_start = exact_sign(a, b, c, from), at_end = exact_sign(a, b, c, to);
  if (at_start * at_end > 0) return Meeting::apart;
  const int e0 = exact_sign(from, to, a, b), e1 = exact_sign(from, to, b, c);
  if (e0 * e1 < 0) return Meeting::apart;
  const int e2 = exact_sign(from, to, c, a);
  if (std::max({e0, e1, e2}) > 0 && std::min({e0, e1, e2}) < 0) return Meeting::apart;
  if (at_start * at_end < 0 && e0 * e1 * e2 != 0) return Meeting::proper;
  return at_end == 0 && at_start != 0 ? Meeting::ends_on : Meeting::touching;
}

// The edge, or the corner twice, that a way across the triangle's plane meets; none of a way within it.
using Touched = std::array<Hip, 2>;
std::optional<Touched> rim_touched(const Triangle& t, const Hip& from, const Hip& to) {
  if (exact_sign(t[0], t[1], t[2], from) * exact_sign(t[0], t[1], t[2], to) >= 0) return std::nullopt;
  std::optional<Touched> rim;
  for (std::size_t k = 0; k < 3; ++k) {
    const Hip &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    if (exact_sign(from, to, a, b) != 0) continue;
    if (exact_sign(from, to, b, c) == 0) return Touched{b, b};
    if (exact_sign(from, to, c, a) == 0) return Touched{a, a};
    rim = a < b ? Touched{a, b} : Touched{b, a};
  }
  return rim;
}

using Wide = long double;  // the plane of a sliver turns by a rounding over its width
Vector<Wide> wide(const Hip& a) {
  return {a[0], a[1], a[2]};
}

Wide distance_to_triangle(const Vector<Wide>& x, const Vector<Wide> (&corners)[3]) {
  constexpr Wide kWider = 1e-6L;  // of a triangle
  const Vector<Wide> u = corners[1] - corners[0], v = corners[2] - corners[0], w = x - corners[0];
  const Vector<Wide> n = cross(u, v);
  const Wide nn = dot(n, n), p = dot(cross(w, v), n), q = dot(cross(u, w), n);
  const bool is_above = p >= -kWider * nn && q >= -kWider * nn && p + q <= (1 + kWider) * nn;
  Wide nearest = is_above ? std::abs(dot(n, w)) / length(n) : std::numeric_limits<Wide>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<Wide>& a = corners[k];
    const Vector<Wide> e = corners[(k + 1) % 3] - a;
    const Wide along = std::clamp<Wide>(dot(x - a, e) / dot(e, e), 0, 1);
    nearest = std::min(nearest, length(x - (a + e * along)));
  }
  return nearest;
}

// Of two segments, neither of which is a point. By the cross product: of nearly parallel ones the difference of products loses
// all its digits.
Wide distance_between(const Vector<Wide>& a, const Vector<Wide>& b, const Vector<Wide>& c, const Vector<Wide>& d) {
  const Vector<Wide> u = b - a, v = d - c, w = c - a, across = cross(u, v);
  const Wide uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = dot(across, across);
  Wide s = det > 0 ? std::clamp<Wide>(dot(cross(w, v), across) / det, 0, 1) : 0;
  const Wide t = std::clamp<Wide>((s * uv - dot(v, w)) / vv, 0, 1);
  s = std::clamp<Wide>((t * uv + dot(u, w)) / uu, 0, 1);
  return length((a + u * s) - (c + v * t));
}

bool is_near(const Triangle& t, const Hip& from, const Hip& to, double near) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({t[0][i], t[1][i], t[2][i]});
    if (std::max(from[i], to[i]) < low - near || std::min(from[i], to[i]) > high + near) return false;
  }
  const Vector<Wide> corners[3] = {wide(t[0]), wide(t[1]), wide(t[2])}, a = wide(from), b = wide(to);
  if (distance_to_triangle(a, corners) <= near || distance_to_triangle(b, corners) <= near) return true;
  if (from == to) return false;
  if (meeting(t, from, to) != Meeting::apart) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (distance_between(a, b, corners[k], corners[(k + 1) % 3]) <= near) return true;
  }
  return false;
}

// Cells along each axis: the surface meets about the square of it.
int resolution(std::size_t triangles) {
  return std::clamp(static_cast<int>(4 * std::sqrt(std::sqrt(static_cast<double>(triangles) + 16) * 2)), 12, 48);
}

}  // namespace

InsideGrid::InsideGrid(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  Hip high;
  low_.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Triangle& t : triangles_) {
    for (const Hip& p : t) {
      for (std::size_t i = 0; i < 3; ++i) {
        low_[i] = std::min(low_[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
  }
  const int n = resolution(triangles_.size());
  for (std::size_t i = 0; i < 3; ++i)
    size_ = std::max(size_, high[i] - low_[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    cell_[i] = std::max(high[i] - low_[i], 1e-7 * size_) / (n - 2);  // one empty layer all around
    low_[i] -= cell_[i] * 1.03;                                      // no plane of the mesh's own between cells
    per_cell_[i] = 1 / cell_[i];
    count_[i] = n + 1;
  }
  place_triangles();
  find_sides();
}

int InsideGrid::clamped(std::size_t axis, double x) const {
  const double place = std::floor((x - low_[axis]) * per_cell_[axis]);
  return place < 0 ? 0 : place >= count_[axis] ? count_[axis] - 1 : static_cast<int>(place);
}

std::optional<InsideGrid::Place> InsideGrid::place_of(const Hip& point) const {
  Place place;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = (point[i] - low_[i]) * per_cell_[i];
    if (!(x >= 0 && x < count_[i])) return std::nullopt;
    place[i] = static_cast<int>(x);
  }
  return place;
}

// The cells of a run along x that a triangle's plane passes, slack and rounding counted in.
void InsideGrid::meet_row(const Triangle& t, const Hip& normal, std::uint32_t f, Place from, int to,
                          std::vector<std::pair<std::uint32_t, std::uint32_t>>& met) const {
  double at = 0, reach = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    at += normal[i] * (low_[i] + (from[i] + 0.5) * cell_[i] - t[0][i]);
    reach += std::abs(normal[i]) * (cell_[i] * (0.5 + kSlack) + 1e-12 * size_);
  }
  const double step = normal[0] * cell_[0];
  const auto first = static_cast<std::uint32_t>(index(from));
  for (int i = 0; i <= to - from[0]; ++i) {
    if (std::abs(at + i * step) <= reach) met.emplace_back(first + static_cast<std::uint32_t>(i), f);
  }
}

void InsideGrid::place_triangles() {
  const std::size_t cells =
      static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(count_[2]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> met;  // cell, triangle
  for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
    const Triangle& t = triangles_[f];
    Place from, to;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({t[0][i], t[1][i], t[2][i]});
      from[i] = clamped(i, low - kSlack * cell_[i]);
      to[i] = clamped(i, high + kSlack * cell_[i]);
    }
    const Hip u = difference(t[1], t[0]), v = difference(t[2], t[0]);
    const Hip n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    Place p = from;
    for (p[2] = from[2]; p[2] <= to[2]; ++p[2]) {
      for (p[1] = from[1]; p[1] <= to[1]; ++p[1])
        meet_row(t, n, f, p, to[0], met);
    }
  }
  first_.assign(cells + 1, 0);
  for (const auto& [cell, f] : met)
    ++first_[cell + 1];
  for (std::size_t c = 0; c < cells; ++c)
    first_[c + 1] += first_[c];
  member_.resize(met.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [cell, f] : met)
    member_[next[cell]++] = f;
}

std::size_t InsideGrid::crowd_at(const Hip& point) const {
  const std::optional<Place> place = place_of(point);
  return place ? first_[index(*place) + 1] - first_[index(*place)] : 0;
}

// Of a way within two neighbouring cells: each triangle counts once. One that the way touches ends the count.
InsideGrid::Parity InsideGrid::parity_between(std::size_t a, std::size_t b, const Hip& from, const Hip& to) const {
  Parity parity;
  const auto is_over_after = [&](std::uint32_t f) {
    const Meeting m = meeting(triangles_[f], from, to);
    parity.is_odd ^= m == Meeting::proper;
    parity.ends_on_surface = m == Meeting::ends_on;
    parity.touches = m == Meeting::touching || m == Meeting::ends_on;
    return parity.touches;
  };
  for (std::uint32_t i = first_[a]; i < first_[a + 1]; ++i) {
    if (is_over_after(member_[i])) return parity;
  }
  if (a == b) return parity;
  for (std::uint32_t i = first_[b]; i < first_[b + 1]; ++i) {  // both lists ascend
    const std::uint32_t f = member_[i];
    if (std::binary_search(member_.begin() + first_[a], member_.begin() + first_[a + 1], f)) continue;
    if (is_over_after(f)) return parity;
  }
  return parity;
}

// From the cell in the grid's corner, which is empty and outside, from neighbour to neighbour.
void InsideGrid::find_sides() {
  const std::size_t cells = first_.size() - 1;
  known_point_.resize(cells);
  known_.assign(cells, Where::surface);
  Random random(7);
  const auto some_point = [&](const Place& p) {
    Hip x;
    for (std::size_t i = 0; i < 3; ++i)
      x[i] = low_[i] + (p[i] + random.uniform(0.2, 0.8)) * cell_[i];
    return x;
  };
  std::vector<Place> reached = {{0, 0, 0}};
  known_point_[0] = some_point({0, 0, 0});
  known_[0] = Where::outside;
  for (std::size_t done = 0; done < reached.size(); ++done) {
    const Place here = reached[done];
    const std::size_t a = index(here);
    for (int way = 0; way < 6; ++way) {
      Place there = here;
      const auto axis = static_cast<std::size_t>(way / 2);
      there[axis] += way % 2 == 0 ? 1 : -1;
      if (there[axis] < 0 || there[axis] >= count_[axis]) continue;
      const std::size_t b = index(there);
      if (known_[b] != Where::surface) continue;
      const int tries = has_triangles(a) || has_triangles(b) ? kTries : 1;
      for (int i = 0; i < tries; ++i) {
        known_point_[b] = some_point(there);
        const Parity parity = parity_between(a, b, known_point_[a], known_point_[b]);
        if (parity.touches) continue;
        known_[b] = (known_[a] == Where::inside) != parity.is_odd ? Where::inside : Where::outside;
        reached.push_back(there);
        break;
      }
    }
  }
}

InsideGrid::Where InsideGrid::where(const Hip& point) const {
  const std::optional<Place> place = place_of(point);
  if (!place) return Where::outside;
  const std::size_t here = index(*place);
  if (!has_triangles(here)) return known_[here];
  for (int way = -1; way < 6; ++way) {  // from its own cell's point, then from the neighbours'
    Place there = *place;
    const auto axis = static_cast<std::size_t>(way < 0 ? 0 : way / 2);
    if (way >= 0) there[axis] += way % 2 == 0 ? 1 : -1;
    if (there[axis] < 0 || there[axis] >= count_[axis]) continue;
    const std::size_t cell = index(there);
    if (known_[cell] == Where::surface) continue;
    const Parity parity = parity_between(here, cell, known_point_[cell], point);
    if (!parity.touches) return (known_[cell] == Where::inside) != parity.is_odd ? Where::inside : Where::outside;
    if (parity.ends_on_surface) break;  // so would every way
  }
  return Where::surface;
}

void InsideGrid::cross_cell(std::size_t cell, const Hip& from, const Hip& to, Crossing& result) const {
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1] && !result.is_through; ++i) {
    const Meeting m = meeting(triangles_[member_[i]], from, to);
    result.is_through |= m == Meeting::proper;
    result.touches |= m == Meeting::touching || m == Meeting::ends_on;
  }
}

// Slab by slab of cells along the way's longest axis: in each, the cells between where the way comes in and goes out.
template <class Visit>
bool InsideGrid::any_cell_along(const Hip& from, const Hip& to, double near, const Visit& visit) const {
  std::size_t axis = 0;
  Hip slack;  // a way from far away is known only to the rounding of its ends
  for (std::size_t i = 0; i < 3; ++i) {
    slack[i] = near + kSlack * cell_[i] + 0x1p-48 * (std::abs(from[i]) + std::abs(to[i]));
    const double low = std::min(from[i], to[i]) - near, high = std::max(from[i], to[i]) + near;
    if (high < low_[i] || low > low_[i] + count_[i] * cell_[i]) return false;
    if (std::abs(to[i] - from[i]) * per_cell_[i] > std::abs(to[axis] - from[axis]) * per_cell_[axis]) axis = i;
  }
  const std::size_t second = (axis + 1) % 3, third = (axis + 2) % 3;
  const double length = to[axis] - from[axis];
  const int first_slab = clamped(axis, std::min(from[axis], to[axis]) - slack[axis]);
  const int last_slab = clamped(axis, std::max(from[axis], to[axis]) + slack[axis]);
  Place p;
  for (p[axis] = first_slab; p[axis] <= last_slab; ++p[axis]) {
    double begin = 0, end = 1;
    if (first_slab < last_slab && length != 0) {
      const double t0 = (low_[axis] + p[axis] * cell_[axis] - slack[axis] - from[axis]) / length;
      const double t1 = (low_[axis] + (p[axis] + 1) * cell_[axis] + slack[axis] - from[axis]) / length;
      begin = std::clamp(std::min(t0, t1), 0.0, 1.0);
      end = std::clamp(std::max(t0, t1), 0.0, 1.0);
    }
    std::array<int, 3> low{}, high{};
    for (const std::size_t i : {second, third}) {
      const double a = from[i] + (to[i] - from[i]) * begin, b = from[i] + (to[i] - from[i]) * end;
      low[i] = clamped(i, std::min(a, b) - slack[i]);
      high[i] = clamped(i, std::max(a, b) + slack[i]);
    }
    for (p[second] = low[second]; p[second] <= high[second]; ++p[second]) {
      for (p[third] = low[third]; p[third] <= high[third]; ++p[third]) {
        const std::size_t cell = index(p);
        if (has_triangles(cell) && visit(cell)) return true;
      }
    }
  }
  return false;
}

InsideGrid::Crossing InsideGrid::crossing(const Hip& from, const Hip& to) const {
  Crossing result;
  any_cell_along(from, to, 0, [&](std::size_t cell) {
    cross_cell(cell, from, to, result);
    return result.is_through;
  });
  return result;
}

bool InsideGrid::grazes(const Hip& from, const Hip& to) const {
  if (where(from) != Where::outside || where(to) != Where::outside) return false;
  std::optional<Touched> met;
  const bool meets_more = any_cell_along(from, to, 0, [&](std::size_t cell) {
    return std::any_of(member_.begin() + first_[cell], member_.begin() + first_[cell + 1], [&](std::uint32_t f) {
      const Meeting m = meeting(triangles_[f], from, to);
      if (m == Meeting::apart) return false;
      const std::optional<Touched> here = m == Meeting::touching ? rim_touched(triangles_[f], from, to) : std::nullopt;
      if (!here || (met && *met != *here)) return true;
      met = here;
      return false;
    });
  });
  return met.has_value() && !meets_more;
}

bool InsideGrid::comes_near(const Hip& from, const Hip& to, double near) const {
  return any_cell_along(from, to, near, [&](std::size_t cell) {
    return std::any_of(member_.begin() + first_[cell], member_.begin() + first_[cell + 1],
                       [&](std::uint32_t f) { return is_near(triangles_[f], from, to, near); });
  });
}

double InsideGrid::distance_to_surface(const Hip& point) const {
  Wide nearest = std::numeric_limits<Wide>::infinity();
  for (const Triangle& t : triangles_)
    nearest = std::min(nearest, distance_to_triangle(wide(point), {wide(t[0]), wide(t[1]), wide(t[2])}));
  return static_cast<double>(nearest);
}

}  // namespace fdcg::test
