// SPDX-License-Identifier: Apache-2.0
// A brute-force count of every rule by its definition: maps, sets and searches over all pairs, integer arithmetic for geometry.
// For small meshes whose coordinates are small integers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

class Recount {
 public:
  using Loop = std::vector<std::uint32_t>;
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  struct Use {
    std::size_t face;
    bool forward;  // from the smaller vertex to the larger
  };

  Recount(const bake::PolygonSoup& soup, bool weld) {
    read(soup, weld);
    count_faces();
    count_edges();
    count_t_junctions();
    count_vertices(soup);
    count_patches();
  }
  std::map<std::string, std::uint64_t> totals;  // rules with a total of zero are absent
  std::uint64_t components = 0, vertices = 0;

 private:
  using Integer = long long;
  struct Point {
    Integer x, y, z;
  };

  void add(const std::string& rule, std::uint64_t n) {
    if (n > 0) totals[rule] += n;
  }

  void read(const bake::PolygonSoup& soup, bool weld) {
    std::map<std::tuple<double, double, double>, std::uint32_t> seen;
    std::vector<std::uint32_t> vertex_of;
    for (const bake::Vec3& p : soup.points) {
      const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      auto id = static_cast<std::uint32_t>(points_.size());
      if (finite && weld) id = seen.emplace(std::tuple{p.x + 0.0, p.y + 0.0, p.z + 0.0}, id).first->second;
      vertex_of.push_back(id);
      if (id < points_.size()) {
        add("duplicate-vertex", 1);
        continue;
      }
      finite_.push_back(finite);
      if (!finite) add("non-finite-coordinate", 1);
      points_.push_back(finite ? Point{static_cast<Integer>(p.x), static_cast<Integer>(p.y), static_cast<Integer>(p.z)}
                               : Point{});
    }
    vertices = points_.size();
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      Loop loop;
      bool valid = true;
      for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h) {
        if (soup.corners[h] >= vertex_of.size()) {
          valid = false;
        } else {
          loop.push_back(vertex_of[soup.corners[h]]);
        }
      }
      loops_.push_back(loop);
      valid_.push_back(valid);
    }
    if (loops_.empty()) add("empty-mesh", 1);
  }

  [[nodiscard]] Point minus(std::uint32_t a, std::uint32_t b) const {
    return {points_[a].x - points_[b].x, points_[a].y - points_[b].y, points_[a].z - points_[b].z};
  }
  static Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  static Integer dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static bool is_zero(const Point& p) { return p.x == 0 && p.y == 0 && p.z == 0; }
  [[nodiscard]] Point area(const Loop& loop) const {
    Point sum{};
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      const Point c = cross(minus(loop[i], loop[0]), minus(loop[i + 1], loop[0]));
      sum = {sum.x + c.x, sum.y + c.y, sum.z + c.z};
    }
    return sum;
  }
  [[nodiscard]] bool is_finite(const Loop& loop) const {
    return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) { return finite_[v]; });
  }
  [[nodiscard]] bool is_collinear(const Loop& loop) const {
    for (const std::uint32_t a : loop)
      for (const std::uint32_t b : loop)
        for (const std::uint32_t c : loop)
          if (!is_zero(cross(minus(b, a), minus(c, a)))) return false;
    return true;
  }
  [[nodiscard]] bool are_coplanar(const Loop& loop) const {
    for (const std::uint32_t a : loop)
      for (const std::uint32_t b : loop)
        for (const std::uint32_t c : loop)
          for (const std::uint32_t d : loop)
            if (dot(cross(minus(b, a), minus(c, a)), minus(d, a)) != 0) return false;
    return true;
  }

  void count_faces() {
    std::map<Loop, int> copies;
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      const Loop& loop = loops_[f];
      const bool repeats = std::set<std::uint32_t>(loop.begin(), loop.end()).size() < loop.size() || loop.size() < 3;
      sound_.push_back(valid_[f] && !repeats);
      if (!valid_[f]) {
        add("index-out-of-range", 1);
        continue;
      }
      const bool degenerate = repeats || (is_finite(loop) && is_collinear(loop));
      add("degenerate-face", degenerate);
      degenerate_.resize(loops_.size());
      degenerate_[f] = degenerate;
      Loop sorted = loop;
      std::sort(sorted.begin(), sorted.end());
      if (!loop.empty()) add("duplicate-face", copies[sorted]++ > 0);
      if (degenerate || !is_finite(loop)) continue;
      add("non-planar-face", !are_coplanar(loop));
      add("self-crossing-face", loop.size() > 3 && crosses_itself(loop));
      add("sliver-face", !(loop.size() > 3 && crosses_itself(loop)) && is_sliver(loop));
    }
    degenerate_.resize(loops_.size());
  }

  // Seen along each axis but those that show less than a sixteenth of what another shows, as the fan's triangles.
  [[nodiscard]] bool crosses_itself(const Loop& loop) const {
    const Point n = area(loop);
    const std::array<Integer, 3> area{n.x, n.y, n.z};
    std::array<Integer, 3> shown{};
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      const Point c = cross(minus(loop[i], loop[0]), minus(loop[i + 1], loop[0]));
      shown = {shown[0] + std::abs(c.x), shown[1] + std::abs(c.y), shown[2] + std::abs(c.z)};
    }
    const Integer most = *std::max_element(shown.begin(), shown.end());
    for (int axis = 0; axis < 3; ++axis)
      if (area[axis] != 0 && 16 * shown[axis] >= most && !crosses_itself(loop, axis)) return false;
    return true;
  }
  // All pairs of edges.
  [[nodiscard]] bool crosses_itself(const Loop& loop, int axis) const {
    const auto flat = [&](std::uint32_t v) {
      const Point& p = points_[v];
      return axis == 0 ? Point{p.y, p.z, 0} : axis == 1 ? Point{p.z, p.x, 0} : Point{p.x, p.y, 0};
    };
    const auto turn = [](const Point& a, const Point& b, const Point& c) {
      const Integer t = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      return t > 0 ? 1 : t < 0 ? -1 : 0;
    };
    const auto is_between = [](const Point& a, const Point& b, const Point& c) {  // on a line
      return std::min(a.x, b.x) <= c.x && c.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= c.y && c.y <= std::max(a.y, b.y);
    };
    const std::size_t size = loop.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Point a = flat(loop[i]), b = flat(loop[(i + 1) % size]);
      for (std::size_t j = i + 1; j < size; ++j) {
        const Point c = flat(loop[j]), d = flat(loop[(j + 1) % size]);
        if (j == i + 1 || (i == 0 && j == size - 1)) {
          const Point &before = j == i + 1 ? a : c, &tip = j == i + 1 ? b : a, &after = j == i + 1 ? d : b;
          if (turn(before, tip, after) == 0 && (is_between(before, tip, after) || is_between(tip, after, before))) return true;
          continue;
        }
        const int abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
        if (abc * abd < 0 && cda * cdb < 0) return true;
        if ((abc == 0 && is_between(a, b, c)) || (abd == 0 && is_between(a, b, d)) || (cda == 0 && is_between(c, d, a)) ||
            (cdb == 0 && is_between(c, d, b)))
          return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool is_sliver(const Loop& loop) const {
    const Point n = area(loop);
    const double twice_area = std::sqrt(static_cast<double>(dot(n, n)));
    double longest = 0, outline = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point e = minus(loop[(i + 1) % loop.size()], loop[i]);
      const double edge = std::sqrt(static_cast<double>(dot(e, e)));
      longest = std::max(longest, edge);
      outline += edge;
    }
    return loop.size() == 3 ? twice_area / longest < 1e-3 * longest : twice_area / outline < 1e-3 * (outline / 2);
  }

  // Exactly inside: among small integers a vertex near an edge but not on it is far away.
  void count_t_junctions() {
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
      bool has_face = false, is_inside = false;
      for (std::size_t f = 0; f < loops_.size(); ++f)
        has_face = has_face || (sound_[f] && std::find(loops_[f].begin(), loops_[f].end(), v) != loops_[f].end());
      for (const auto& [edge, uses] : edges_) {
        if (uses.size() != 1 || !is_finite({v, edge.first, edge.second})) continue;
        const Loop& loop = loops_[uses[0].face];
        const Point e = minus(edge.second, edge.first), a = minus(v, edge.first), b = minus(v, edge.second);
        is_inside = is_inside || (std::find(loop.begin(), loop.end(), v) == loop.end() && is_zero(cross(e, a)) &&
                                  dot(e, a) > 0 && dot(e, b) < 0);
      }
      add("t-junction", has_face && is_inside);
    }
  }

  void count_edges() {
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      for (std::size_t i = 0; sound_[f] && i < loops_[f].size(); ++i) {
        const std::uint32_t u = loops_[f][i], v = loops_[f][(i + 1) % loops_[f].size()];
        edges_[std::minmax(u, v)].push_back({f, u < v});
      }
    }
    std::set<std::uint32_t> told;  // corners of faces with one that is not finite: what ends there is told by that
    for (std::size_t f = 0; f < loops_.size(); ++f) {
      if (valid_[f] && !is_finite(loops_[f])) told.insert(loops_[f].begin(), loops_[f].end());
    }
    for (const auto& [edge, uses] : edges_) {
      add("boundary-edge", uses.size() == 1 && told.count(edge.first) == 0 && told.count(edge.second) == 0);
      add("non-manifold-edge", uses.size() > 2);
      add("winding-inconsistent", uses.size() == 2 && uses[0].forward == uses[1].forward);
      add("folded-edge", uses.size() == 2 && is_fold(edge, uses));
    }
  }

  // Both in one plane, and the inner sides, n x e along the loop's own direction, agree.
  bool is_fold(const Edge& edge, const std::vector<Use>& uses) const {
    Loop both = loops_[uses[0].face];
    both.insert(both.end(), loops_[uses[1].face].begin(), loops_[uses[1].face].end());
    if (!is_finite(both) || degenerate_[uses[0].face] || degenerate_[uses[1].face] || !are_coplanar(both)) return false;
    Point inner[2];
    for (int k = 0; k < 2; ++k) {
      const Point e = uses[k].forward ? minus(edge.second, edge.first) : minus(edge.first, edge.second);
      inner[k] = cross(area(loops_[uses[k].face]), e);
    }
    return dot(inner[0], inner[1]) > 0;
  }

  static std::vector<std::size_t> sets(std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& joins) {
    std::vector<std::size_t> label(count);
    std::iota(label.begin(), label.end(), std::size_t{0});
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : joins) {
        const std::size_t least = std::min(label[a], label[b]);
        changed = changed || label[a] != least || label[b] != least;
        label[a] = label[b] = least;
      }
    }
    return label;
  }

  void count_vertices(const bake::PolygonSoup&) {
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
      std::vector<std::size_t> faces;
      bool used = false;
      for (std::size_t f = 0; f < loops_.size(); ++f) {
        const bool has = std::find(loops_[f].begin(), loops_[f].end(), v) != loops_[f].end();
        used = used || has;
        if (has && sound_[f]) faces.push_back(f);
      }
      add("isolated-vertex", !used);
      std::vector<std::pair<std::size_t, std::size_t>> joins;
      for (const auto& [edge, uses] : edges_) {
        if (edge.first != v && edge.second != v) continue;
        for (const Use& use : uses)
          joins.emplace_back(use.face, uses[0].face);
      }
      const auto label = sets(loops_.size(), joins);
      std::set<std::size_t> fans;
      for (const std::size_t f : faces)
        fans.insert(label[f]);
      add("non-manifold-vertex", fans.size() > 1);
    }
    std::vector<std::pair<std::size_t, std::size_t>> joins;
    for (std::size_t f = 0; f < loops_.size(); ++f)
      for (std::size_t g = 0; g < f; ++g)
        if (std::find_first_of(loops_[f].begin(), loops_[f].end(), loops_[g].begin(), loops_[g].end()) != loops_[f].end())
          joins.emplace_back(f, g);
    const auto label = sets(loops_.size(), joins);
    std::set<std::size_t> distinct;
    for (std::size_t f = 0; f < loops_.size(); ++f)
      if (!loops_[f].empty()) distinct.insert(label[f]);
    components = distinct.size();
  }

  void count_patches() {
    std::vector<std::pair<std::size_t, std::size_t>> joins;
    for (const auto& [edge, uses] : edges_)
      if (uses.size() == 2) joins.emplace_back(uses[0].face, uses[1].face);
    const auto label = sets(loops_.size(), joins);
    std::map<std::size_t, Loop> patches;
    for (std::size_t f = 0; f < loops_.size(); ++f)
      if (sound_[f]) patches[label[f]].push_back(static_cast<std::uint32_t>(f));
    for (const auto& [first, faces] : patches) {
      add("not-orientable", !is_orientable(faces));
      add("inside-out", encloses_negative(faces));  // as long as no patch lies in another
    }
  }
  // Signs by search from the first face, checked on every edge afterwards.
  [[nodiscard]] bool is_orientable(const Loop& faces) const {
    std::map<std::size_t, int> sign{{faces[0], 1}};
    for (std::size_t round = 0; round < faces.size(); ++round) {
      for (const auto& [edge, uses] : edges_) {
        if (uses.size() != 2) continue;
        for (int k = 0; k < 2; ++k) {
          const auto known = sign.find(uses[k].face);
          if (known == sign.end()) continue;
          sign.emplace(uses[1 - k].face, uses[0].forward == uses[1].forward ? -known->second : known->second);
        }
      }
    }
    for (const auto& [edge, uses] : edges_) {
      if (uses.size() != 2 || sign.count(uses[0].face) == 0) continue;
      if ((sign.at(uses[0].face) == sign.at(uses[1].face)) == (uses[0].forward == uses[1].forward)) return false;
    }
    return true;
  }
  [[nodiscard]] bool encloses_negative(const Loop& faces) const {
    const std::set<std::size_t> members(faces.begin(), faces.end());
    for (const auto& [edge, uses] : edges_) {
      const bool ours = std::any_of(uses.begin(), uses.end(), [&](const Use& u) { return members.count(u.face) != 0; });
      if (ours && (uses.size() != 2 || uses[0].forward == uses[1].forward)) return false;
    }
    Integer volume = 0;
    for (const std::uint32_t f : faces) {
      if (!is_finite(loops_[f])) return false;
      for (std::size_t i = 1; i + 1 < loops_[f].size(); ++i)
        volume += dot(points_[loops_[f][0]], cross(points_[loops_[f][i]], points_[loops_[f][i + 1]]));
    }
    return volume < 0;
  }

  std::vector<Point> points_;
  std::vector<bool> finite_, valid_, sound_, degenerate_;
  std::vector<Loop> loops_;
  std::map<Edge, std::vector<Use>> edges_;
};

}  // namespace fdcg::test
