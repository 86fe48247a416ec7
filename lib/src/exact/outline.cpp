// SPDX-License-Identifier: Apache-2.0
#include "exact/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "base/vec3.hpp"
#include "exact/filtered_sum.hpp"
#include "exact/volume.hpp"

namespace fdcg::bake {
namespace {

// A sweep line visits the corners in the order of u, then v, and keeps the edges that it crosses sorted from below to above.
// Two edges become neighbours on the line before it reaches the first point where they intersect, so testing new neighbours
// finds that point. An edge has the index of its start corner.
class OutlineSweep {
 public:
  OutlineSweep(const Projection& view, std::span<const Vec3> polygon)
      : view_(view), polygon_(polygon), count_(static_cast<std::uint32_t>(polygon.size())), rank_(count_), order_(count_) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) { return place(i) < place(j); });
    for (std::uint32_t i = 0; i < count_; ++i)
      rank_[order_[i]] = i;
  }

  // Precondition: consecutive edges do not overlap (no spikes).
  bool meets_itself() {
    for (std::uint32_t i = 1; i < count_; ++i) {
      if (place(order_[i - 1]) == place(order_[i])) return true;
    }
    Status status(Below{this});
    std::vector<Status::iterator> at(count_);
    for (const std::uint32_t corner : order_) {
      const std::uint32_t before = corner > 0 ? corner - 1 : count_ - 1;
      for (const std::uint32_t edge : {before, corner}) {
        if (right(edge) != corner) continue;
        const auto above = status.erase(at[edge]);
        if (above != status.begin() && above != status.end() && meet(*std::prev(above), *above)) return true;
      }
      for (const std::uint32_t edge : {before, corner}) {
        if (left(edge) != corner) continue;
        const auto [here, is_new] = status.insert(edge);
        if (!is_new) return true;  // it overlaps another edge
        at[edge] = here;
        const auto above = std::next(here);
        if (above != status.end() && meet(edge, *above)) return true;
        if (here != status.begin() && meet(edge, *std::prev(here))) return true;
      }
    }
    return false;
  }

 private:
  struct Below {
    const OutlineSweep* sweep;
    bool operator()(std::uint32_t e, std::uint32_t f) const { return sweep->is_below(e, f); }
  };
  using Status = std::set<std::uint32_t, Below>;

  [[nodiscard]] std::pair<double, double> place(std::uint32_t corner) const {
    return {view_.u(polygon_[corner]), view_.v(polygon_[corner])};
  }
  [[nodiscard]] std::uint32_t end(std::uint32_t edge) const { return edge + 1 < count_ ? edge + 1 : 0; }
  [[nodiscard]] std::uint32_t left(std::uint32_t edge) const { return rank_[edge] < rank_[end(edge)] ? edge : end(edge); }
  [[nodiscard]] std::uint32_t right(std::uint32_t edge) const { return rank_[edge] < rank_[end(edge)] ? end(edge) : edge; }
  [[nodiscard]] int orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return view_.orient(polygon_[a], polygon_[b], polygon_[c]);
  }

  // The sweep line crosses both.
  [[nodiscard]] bool is_below(std::uint32_t e, std::uint32_t f) const {
    if (rank_[left(e)] > rank_[left(f)]) return e != f && side_of(f, e) < 0;
    return e != f && side_of(e, f) > 0;
  }
  // Whether edge f, which does not start left of e, lies above (1) or below (-1) e.
  [[nodiscard]] int side_of(std::uint32_t e, std::uint32_t f) const {
    const int side = orient(left(e), right(e), left(f));
    return side != 0 ? side : orient(left(e), right(e), right(f));
  }

  [[nodiscard]] bool meet(std::uint32_t e, std::uint32_t f) const {
    if (end(e) == f || end(f) == e) return false;
    const std::uint32_t a = left(e), b = right(e), c = left(f), d = right(f);
    const int abc = orient(a, b, c), abd = orient(a, b, d);
    if (abc == 0 && abd == 0) return rank_[a] <= rank_[d] && rank_[c] <= rank_[b];
    return abc * abd <= 0 && orient(c, d, a) * orient(c, d, b) <= 0;
  }

  const Projection& view_;
  std::span<const Vec3> polygon_;
  std::uint32_t count_;
  std::vector<std::uint32_t> rank_, order_;
};

// The polygon's projection along an axis, as the triangles of the fan from its first corner.
struct Shown {
  FilteredSum area;      // twice the signed area
  double triangles = 0;  // twice the sum of the absolute areas

  void add(double a, double b, double c, double d) {
    area.add(a, b, c, d);
    triangles += std::abs(a * d - b * c);
  }
  // Whether the area exceeds the rounding error.
  [[nodiscard]] bool has_triangles(double terms) const { return FilteredSum{triangles, area.magnitude}.is_certain(terms); }
  [[nodiscard]] double size() const { return std::isfinite(area.value) ? std::abs(area.value) : 0; }
};

std::array<Shown, 3> shown_by(std::span<const Vec3> polygon) {
  std::array<Shown, 3> shown;
  Vec3 a = polygon[1] - polygon[0];
  for (const Vec3& corner : polygon.subspan(2)) {
    const Vec3 b = corner - polygon[0];
    shown[0].add(a.y, a.z, b.y, b.z);
    shown[1].add(a.z, a.x, b.z, b.x);
    shown[2].add(a.x, a.y, b.x, b.y);
    a = b;
  }
  return shown;
}

// As a share of the largest projected area over the three axes. A projection below it is nearly edge-on: what it shows may be
// rounding error only, and that may happen to be a simple polygon.
constexpr double kLeastShown = 1.0 / 16;

}  // namespace

int area_sign(std::span<const Vec3> polygon, int k) {
  const int u = (k + 1) % 3, v = (k + 2) % 3;
  ExactSum sum;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    sum.add_product(component(p, u), component(q, v), 1, false);
    sum.add_product(component(p, v), component(q, u), 1, true);
  }
  return sum.sign();
}

Turns turns_of(const Projection& view, std::span<const Vec3> polygon) {
  const std::size_t count = polygon.size();
  const auto is_upward = [&](const Vec3& from, const Vec3& to) {
    return view.v(to) != view.v(from) ? view.v(to) > view.v(from) : view.u(to) > view.u(from);
  };
  Turns turns;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % count], &c = polygon[(i + 2) % count];
    const int turn = view.orient(a, b, c);
    if (turn == 0 && ((view.u(a) == view.u(b) && view.v(a) == view.v(b)) || !view.goes_on(a, b, c))) return {};
    const bool first = is_upward(a, b), second = is_upward(b, c);
    turns.has_right = turns.has_right || turn < 0;
    if (turn > 0 && !first && second) ++turns.number;
    if (turn < 0 && first && !second) --turns.number;
  }
  return turns;
}

bool is_simple(const Projection& view, std::span<const Vec3> polygon) {
  const Turns turns = turns_of(view, polygon);
  return turns.number == 1 && (!turns.has_right || !OutlineSweep(view, polygon).meets_itself());
}

std::optional<Projection> simple_view(std::span<const Vec3> polygon) {
  const std::array<Shown, 3> shown = shown_by(polygon);
  const double terms = static_cast<double>(polygon.size()) - 2;
  double most = 0;  // stays 0 where the polygon is as thin as the rounding error: no axis is preferred
  for (const Shown& along : shown) {
    if (along.has_triangles(terms)) most = std::max(most, along.triangles);
  }
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int k, int l) { return shown[k].size() > shown[l].size(); });
  for (const int k : axes) {
    if (shown[k].triangles < kLeastShown * most) continue;
    const bool is_certain = shown[k].area.is_certain(terms);
    const int sign = is_certain ? (shown[k].area.value > 0 ? 1 : -1) : area_sign(polygon, k);
    if (sign == 0) continue;
    const Projection view(Vec3{k == 0 ? sign : 0.0, k == 1 ? sign : 0.0, k == 2 ? sign : 0.0});
    if (is_simple(view, polygon)) return view;
  }
  return std::nullopt;
}

}  // namespace fdcg::bake
