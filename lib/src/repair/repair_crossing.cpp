// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "exact/outline.hpp"
#include "repair/least_area.hpp"
#include "repair/repair.hpp"
#include "topology/face_geometry.hpp"

namespace fdcg::bake {
namespace {

using Loop = std::vector<std::uint32_t>;  // points of the soup
using Edge = std::array<std::uint32_t, 2>;

Edge edge_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

// Parts a flat outline at its crossings.
class CrossingParter {
 public:
  // `axis`: along which the outline's plane is seen. New corners are added to the workpiece.
  CrossingParter(Workpiece& piece, int axis) : piece_(piece), axis_(axis) {}

  // Outlines without a crossing of two edges inside both. Too many crossings: none.
  std::vector<Loop> part(const Loop& outline) {
    std::vector<Loop> open{outline}, done;
    constexpr int kMostCrossings = 10'000;
    for (int steps = 0; !open.empty(); ++steps) {
      if (steps > kMostCrossings) return {};
      Loop loop = std::move(open.back());
      open.pop_back();
      if (loop.size() < 3) continue;
      const std::optional<Edge> at = first_crossing(loop);
      if (!at) {
        done.push_back(std::move(loop));
        continue;
      }
      const auto [i, j] = *at;  // i < j: edges from corner i and from corner j
      const std::uint32_t x = add_crossing(loop[i], loop[i + 1], loop[j], loop[(j + 1) % loop.size()]);
      Loop inner{x}, outer{x};
      inner.insert(inner.end(), loop.begin() + i + 1, loop.begin() + j + 1);
      outer.insert(outer.end(), loop.begin() + j + 1, loop.end());
      outer.insert(outer.end(), loop.begin(), loop.begin() + i + 1);
      open.push_back(std::move(inner));
      open.push_back(std::move(outer));
    }
    return done;
  }

  // New corners on edges of the outline as it was given, in order from the edge's first point.
  [[nodiscard]] const std::map<Edge, Loop>& on_edges() const { return on_edges_; }

 private:
  [[nodiscard]] const Vec3& at(std::uint32_t point) const { return piece_.soup.points[point]; }
  [[nodiscard]] int orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return exact::orient2d(at(a), at(b), at(c), axis_);
  }
  [[nodiscard]] std::optional<Edge> first_crossing(const Loop& loop) const {
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t j = i + 2; j < count; ++j) {
        const std::uint32_t a = loop[i], b = loop[i + 1], c = loop[j], d = loop[(j + 1) % count];
        if (a == d) continue;
        if (orient(a, b, c) * orient(a, b, d) < 0 && orient(c, d, a) * orient(c, d, b) < 0) return Edge{i, j};
      }
    }
    return std::nullopt;
  }

  std::uint32_t add_crossing(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const Vec3 p = at(a), q = at(b), r = at(c), s = at(d);
    const double before = component(cross(q - p, r - p), axis_), after = component(cross(q - p, s - p), axis_);
    const double share = before / (before - after);
    Vec3 x = r + share * (s - r);
    if (piece_.has_floats) x = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
    piece_.soup.points.push_back(x);
    piece_.source_point.push_back(piece_.source_point[a]);
    const auto point = static_cast<std::uint32_t>(piece_.soup.points.size() - 1);
    insert(a, b, point);
    insert(c, d, point);
    return point;
  }

  // The edge a-b may itself be a part of an edge of the outline.
  void insert(std::uint32_t a, std::uint32_t b, std::uint32_t point) {
    Edge whole = edge_of(a, b);
    for (const auto& [edge, inner] : on_edges_) {
      Loop chain{edge[0]};
      chain.insert(chain.end(), inner.begin(), inner.end());
      chain.push_back(edge[1]);
      for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        if (edge_of(chain[k], chain[k + 1]) == edge_of(a, b)) whole = edge;
      }
    }
    Loop& inner = on_edges_[whole];
    const Vec3 start = at(whole[0]);
    inner.push_back(point);
    std::sort(inner.begin(), inner.end(),
              [&](std::uint32_t s, std::uint32_t t) { return squared_length(at(s) - start) < squared_length(at(t) - start); });
  }

  Workpiece& piece_;
  int axis_;
  std::map<Edge, Loop> on_edges_;
};

class CrossingMender {
 public:
  CrossingMender(Workpiece& piece, Tally& tally)
      : piece_(piece), tally_(tally), view_(piece), geometry_(view_.mesh, view_.states) {}

  // Returns the number of polygons mended; some may wait for the next round, since their neighbour was changed.
  std::uint64_t run() {
    find_crossing();
    if (crossing_.empty()) return 0;
    find_edges();
    std::uint64_t done = 0;
    for (const std::uint32_t f : crossing_)
      done += mend(f);
    FaceEdits edits(edits_.begin(), edits_.end());
    replace_faces(piece_, edits);
    return done;
  }

 private:
  [[nodiscard]] std::uint32_t size(std::uint32_t f) const { return view_.mesh.face_first[f + 1] - view_.mesh.face_first[f]; }
  [[nodiscard]] Loop loop_of(std::uint32_t f) const {
    const auto corners = piece_.soup.corners.begin();
    return {corners + piece_.soup.face_first[f], corners + piece_.soup.face_first[f + 1]};
  }
  [[nodiscard]] std::vector<Vec3> positions(const Loop& loop) const {
    std::vector<Vec3> points;
    for (const std::uint32_t point : loop)
      points.push_back(piece_.soup.points[point]);
    return points;
  }

  void find_crossing() {
    for (std::uint32_t f = 0; f < view_.mesh.face_count(); ++f) {
      if (size(f) < 4 || !geometry_.is_finite(FaceId{f})) continue;
      const bool repeats = view_.states[f] == FaceState::repeated_corner;
      if (!repeats && geometry_.is_degenerate(FaceId{f})) continue;
      if (repeats || !simple_view(positions(loop_of(f)))) crossing_.push_back(f);
    }
  }
  void find_edges() {
    for (std::uint32_t f = 0; f < view_.mesh.face_count(); ++f) {
      const Loop loop = loop_of(f);
      for (std::size_t i = 0; i < loop.size(); ++i)
        faces_at_[edge_of(loop[i], loop[(i + 1) % loop.size()])].push_back(f);
    }
  }

  bool mend(std::uint32_t f) {
    if (edits_.count(f) != 0) return false;  // a neighbour gave it a corner
    const Loop loop = loop_of(f);
    std::vector<Loop> triangles = on_own_corners(loop);
    const bool is_flat = view_.states[f] == FaceState::sound && geometry_.is_flat(FaceId{f});
    if (is_flat && (triangles.empty() || has_both_sides(triangles))) {
      if (std::optional<std::vector<Loop>> parted = at_crossings(f, loop)) triangles = std::move(*parted);
    }
    if (triangles.empty()) return false;
    edits_[f] = std::move(triangles);
    tally_.done.push_back(piece_.source_face[f]);
    return true;
  }

  [[nodiscard]] std::vector<Loop> on_own_corners(const Loop& loop) const {
    std::vector<Loop> triangles;
    const auto is_edge = [&](std::uint32_t i, std::uint32_t j) { return faces_at_.count(edge_of(loop[i], loop[j])) != 0; };
    for (const auto& t : least_area_triangles(positions(loop), is_edge))
      triangles.push_back({loop[t[0]], loop[t[1]], loop[t[2]]});
    return triangles;
  }

  [[nodiscard]] int axis_of(const Loop& triangle) const {
    const std::vector<Vec3> p = positions(triangle);
    int axis = 0;
    while (axis < 2 && exact::orient2d(p[0], p[1], p[2], axis) == 0)
      ++axis;
    return axis;
  }
  // Of triangles in one plane.
  [[nodiscard]] bool has_both_sides(const std::vector<Loop>& triangles) const {
    const int axis = axis_of(triangles[0]);
    std::set<int> sides;
    for (const Loop& triangle : triangles) {
      const std::vector<Vec3> p = positions(triangle);
      sides.insert(exact::orient2d(p[0], p[1], p[2], axis));
    }
    return sides.size() > 1;
  }

  // None where it has no crossing, or where a neighbour that needs a corner was changed already.
  std::optional<std::vector<Loop>> at_crossings(std::uint32_t f, const Loop& loop) {
    const auto corner = [&](std::size_t i) { return positions(loop)[i]; };
    std::size_t third = 2;
    while (third < loop.size() && exact::collinear(corner(0), corner(1), corner(third)))
      ++third;
    if (third == loop.size()) return std::nullopt;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      for (const std::uint32_t g : faces_at_[edge_of(loop[i], loop[(i + 1) % loop.size()])]) {
        if (g != f && edits_.count(g) != 0) return std::nullopt;
      }
    }
    CrossingParter parter(piece_, axis_of({loop[0], loop[1], loop[third]}));
    const std::vector<Loop> parts = parter.part(loop);
    if (parter.on_edges().empty()) return std::nullopt;
    std::vector<Loop> triangles;
    for (const Loop& part : parts) {
      const std::vector<Loop> own = part.size() == 3 ? std::vector<Loop>{part} : on_own_corners(part);
      triangles.insert(triangles.end(), own.begin(), own.end());
    }
    for (const auto& [edge, inner] : parter.on_edges()) {
      for (const std::uint32_t g : faces_at_[edge]) {
        if (g != f) give_corners(g, edge, inner);
      }
    }
    return triangles;
  }

  void give_corners(std::uint32_t g, const Edge& edge, const Loop& inner) {
    auto& loops = edits_[g];
    Loop loop = loops.empty() ? loop_of(g) : loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      if (edge_of(a, b) != edge) continue;
      Loop added = inner;
      if (a != edge[0]) std::reverse(added.begin(), added.end());
      loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(i) + 1, added.begin(), added.end());
      break;
    }
    loops = {loop};
  }

  Workpiece& piece_;
  Tally& tally_;
  const View view_;
  FaceGeometry geometry_;
  std::vector<std::uint32_t> crossing_;
  std::map<Edge, std::vector<std::uint32_t>> faces_at_;
  std::map<std::uint32_t, std::vector<Loop>> edits_;
};

}  // namespace

RepairAction triangulate_crossing_step(Workpiece& piece) {
  Tally tally;
  constexpr int kMostRounds = 16;
  for (int round = 0; round < kMostRounds; ++round) {
    if (CrossingMender(piece, tally).run() == 0) break;
  }
  std::sort(tally.done.begin(), tally.done.end());
  tally.done.erase(std::unique(tally.done.begin(), tally.done.end()), tally.done.end());
  return action_of(
      piece, "triangulate-crossing", Kind::faces,
      counted(tally.done.size(), "polygon that crosses itself was", "polygons that cross themselves were") + " triangulated",
      tally);
}

}  // namespace fdcg::bake
