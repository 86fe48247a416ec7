// SPDX-License-Identifier: Apache-2.0
// Joins sheets whose borders run along one another with a narrow gap or different vertices between them, as the faces of a CAD
// model that were divided one by one. Borders alone are changed: vertices near another border vertex are joined, and edges get
// the vertices that lie near them as corners.
#include <algorithm>
#include <map>
#include <numeric>

#include "base/vec3.hpp"
#include "repair/repair.hpp"
#include "repair/triangle_tree.hpp"

namespace fdcg::bake {
namespace {

struct BorderEdge {
  std::uint32_t from, to;  // points of the soup
  std::uint32_t face, slot;
};

class Stitcher {
 public:
  Stitcher(Workpiece& piece, double gap) : piece_(piece), gap_(gap), joined_(piece.soup.points.size()) {
    std::iota(joined_.begin(), joined_.end(), 0U);
    const View view(piece);
    for (std::uint32_t h = 0; h < view.topology.twin.size(); ++h) {
      if (view.topology.twin[h] != Topology::kBoundary) continue;
      const FaceId f = view.topology.face(HalfedgeId{h});
      edges_.push_back({piece.soup.corners[h], piece.soup.corners[+next(view.mesh, f, HalfedgeId{h})], +f, h});
    }
    for (const BorderEdge& edge : edges_) {
      vertices_.push_back(edge.from);
      vertices_.push_back(edge.to);
      neighbours_.emplace(edge.from, edge.to);
      neighbours_.emplace(edge.to, edge.from);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  void run(StitchTally& tally) {
    if (edges_.empty()) return;
    find_near();
    for (const std::uint32_t v : vertices_) {
      if (root(v) == v) continue;
      tally.done.push_back(piece_.source_point[v]);
      ++tally.joined;
    }
    replace_faces(piece_, edits(tally));
  }

 private:
  [[nodiscard]] const Vec3& at(std::uint32_t v) const { return piece_.soup.points[v]; }
  std::uint32_t root(std::uint32_t v) {
    while (joined_[v] != v)
      v = joined_[v] = joined_[joined_[v]];
    return v;
  }
  [[nodiscard]] bool are_neighbours(std::uint32_t u, std::uint32_t v) const {
    const auto [first, end] = neighbours_.equal_range(u);
    return std::any_of(first, end, [v](const auto& each) { return each.second == v; });
  }

  void find_near() {
    std::vector<NamedTriangle> lines;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      lines.push_back({{at(edges_[e].from), at(edges_[e].to), at(edges_[e].to)}, {e, e, e}});
    const TriangleTree tree(lines);
    std::vector<NamedTriangle> near;
    for (const std::uint32_t v : vertices_) {
      tree.in_box(at(v), at(v), gap_, near);
      for (const NamedTriangle& line : near)
        compare(v, line.name[0]);
    }
  }

  // The vertex and an edge in whose surroundings it lies.
  void compare(std::uint32_t v, std::uint32_t e) {
    const BorderEdge& edge = edges_[e];
    if (edge.from == v || edge.to == v) return;
    const Vec3 way = at(edge.to) - at(edge.from), to_v = at(v) - at(edge.from);
    const double whole = squared_length(way), share = whole > 0 ? dot(to_v, way) / whole : 0;
    for (const std::uint32_t end : {edge.from, edge.to}) {
      if (length(at(v) - at(end)) > gap_) continue;
      if (!are_neighbours(v, end)) join(v, end);
      return;
    }
    if (share <= 0 || share >= 1 || length(to_v - share * way) > gap_) return;
    if (are_neighbours(v, edge.from) || are_neighbours(v, edge.to)) return;  // the tip of a narrow notch
    on_edge_[e].emplace_back(share, v);
  }

  // To the one of the lower number, as long as no vertex goes farther than the gap.
  void join(std::uint32_t u, std::uint32_t v) {
    const std::uint32_t p = std::min(root(u), root(v)), q = std::max(root(u), root(v));
    if (p != q && length(at(p) - at(q)) <= gap_) joined_[q] = p;
  }

  FaceEdits edits(StitchTally& tally) {
    std::map<std::uint32_t, std::map<std::uint32_t, std::vector<std::uint32_t>>> added;  // by face and slot
    for (auto& [e, vertices] : on_edge_) {
      std::sort(vertices.begin(), vertices.end());
      for (const auto& [share, v] : vertices)
        added[edges_[e].face][edges_[e].slot].push_back(v);
      ++tally.divided;
    }
    FaceEdits edits;
    const PolygonSoup& soup = piece_.soup;
    for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
      const auto found = added.find(f);
      std::vector<std::uint32_t> loop;
      bool is_changed = found != added.end();
      const auto push = [&](std::uint32_t v) {
        is_changed = is_changed || root(v) != v;
        if (loop.empty() || loop.back() != root(v)) loop.push_back(root(v));
      };
      for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
        if (soup.corners[c] >= joined_.size()) continue;
        push(soup.corners[c]);
        if (found == added.end()) continue;
        if (const auto here = found->second.find(c); here != found->second.end()) {
          for (const std::uint32_t v : here->second)
            push(v);
        }
      }
      while (loop.size() > 1 && loop.front() == loop.back())
        loop.pop_back();
      if (!is_changed) continue;
      if (loop.size() < 3) {
        edits.push_back({f, {}});
      } else {
        edits.push_back({f, {std::move(loop)}});
      }
    }
    return edits;
  }

  Workpiece& piece_;
  double gap_;
  std::vector<std::uint32_t> joined_;  // towards the point that stands for each
  std::vector<BorderEdge> edges_;
  std::vector<std::uint32_t> vertices_;
  std::multimap<std::uint32_t, std::uint32_t> neighbours_;
  std::map<std::uint32_t, std::vector<std::pair<double, std::uint32_t>>> on_edge_;
};

}  // namespace

RepairAction stitch_step(Workpiece& piece, double gap) {
  StitchTally tally;
  Stitcher(piece, gap).run(tally);
  return action_of(piece, "stitch", Kind::vertices,
                   counted(tally.joined, "border vertex was", "border vertices were") +
                       " joined to another across a gap of up to " + in_digits(gap) + ", " +
                       counted(tally.divided, "border edge got", "border edges got") + " vertices near it as corners",
                   tally);
}

}  // namespace fdcg::bake
