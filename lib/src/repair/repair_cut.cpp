// SPDX-License-Identifier: Apache-2.0
// Makes every edge the edge of at most two faces that go on into each other. At an edge of more than two faces they are paired
// (radial.hpp); what is left over is cut: the surface ends there with a boundary edge. So do folds, and edges along which two
// faces run in one direction, as a one-sided strip has somewhere.
//
// Vertices hold faces together, and edges are known by their vertices. So each vertex at a cut edge becomes one for each group
// of faces that hang together there. Where both ends of the edge still are the same vertices for several pairs of faces, all
// but one pair get a corner more in the middle of the edge.
#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "base/mesh.hpp"
#include "base/vec3.hpp"
#include "repair/radial.hpp"
#include "repair/repair.hpp"
#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"
#include "topology/orient.hpp"

namespace fdcg::bake {
namespace {

using Loops = std::vector<std::vector<std::uint32_t>>;

// Turns the faces of patches that no turning makes consistent so that few edges stay along which two faces run in one
// direction: each face agrees with the one from which it was reached first. Returns the number of faces turned.
std::uint64_t turn_one_sided(Workpiece& piece) {
  const View view(piece);
  const Patches patches = find_patches(view.mesh, view.topology, view.states);
  if (std::all_of(patches.patches.begin(), patches.patches.end(), [](const Patch& p) { return p.is_orientable; })) return 0;
  std::unordered_map<std::uint32_t, HalfedgeId> same_way;
  for (const OddEdge& edge : odd_edges(view.mesh, view.topology)) {
    if (edge.halfedges.size() != 2) continue;
    same_way[+edge.halfedges[0]] = edge.halfedges[1];
    same_way[+edge.halfedges[1]] = edge.halfedges[0];
  }
  enum : std::uint8_t { kUnseen, kKept, kTurned };
  std::vector<std::uint8_t> seen(view.mesh.face_count(), kUnseen);
  std::uint64_t turned = 0;
  for (const Patch& patch : patches.patches) {
    if (patch.is_orientable) continue;
    std::deque<FaceId> queue{patch.first_face};
    seen[+patch.first_face] = kKept;
    while (!queue.empty()) {
      const FaceId f = queue.front();
      queue.pop_front();
      for (std::uint32_t h = view.mesh.face_first[+f]; h < view.mesh.face_first[+f + 1]; ++h) {
        const auto same = same_way.find(h);
        const HalfedgeId twin = same != same_way.end() ? same->second : view.topology.twin[h];
        if (!is_halfedge(twin) || seen[+view.topology.face(twin)] != kUnseen) continue;
        const bool is_turned = (seen[+f] == kTurned) != (same != same_way.end());
        seen[+view.topology.face(twin)] = is_turned ? kTurned : kKept;
        queue.push_back(view.topology.face(twin));
      }
    }
  }
  for (std::uint32_t f = 0; f < seen.size(); ++f) {
    if (seen[f] != kTurned) continue;
    const auto corners = piece.soup.corners.begin();
    std::reverse(corners + piece.soup.face_first[f] + 1, corners + piece.soup.face_first[f + 1]);
    ++turned;
  }
  return turned;
}

class EdgeCutter {
 public:
  explicit EdgeCutter(Workpiece& piece)
      : piece_(piece), view_(piece), geometry_(view_.mesh, view_.states), twin_(view_.topology.twin) {}

  // False where there is nothing to do.
  bool run(CutTally& tally) {
    pair(tally);
    if (touched_.empty()) return false;
    split_vertices(tally);
    part_edges(tally);
    return true;
  }

 private:
  [[nodiscard]] const Mesh& mesh() const { return view_.mesh; }
  [[nodiscard]] HalfedgeId after(HalfedgeId h) const { return next(mesh(), view_.topology.face(h), h); }

  void cut(HalfedgeId h, CutKind kind, CutTally& tally) {
    const VertexId u = mesh().corners[+h], v = mesh().corners[+after(h)];
    touched_.push_back(u);
    touched_.push_back(v);
    ++tally.count[kind];
    tally.edges.push_back({{piece_.source_point[+u], piece_.source_point[+v]}, piece_.source_face[+view_.topology.face(h)]});
  }

  void pair(CutTally& tally) {
    RadialPairing radial(mesh(), view_.topology, geometry_);
    for (const OddEdge& edge : odd_edges(mesh(), view_.topology)) {
      for (const HalfedgeId h : edge.halfedges)
        twin_[+h] = Topology::kBoundary;
      if (edge.halfedges.size() == 2) {
        cut(edge.halfedges[0], kOneSided, tally);
        continue;
      }
      const auto pairs = radial.pairs_of(edge);
      for (const auto& [a, b] : pairs) {
        twin_[+a] = b;
        twin_[+b] = a;
      }
      cut(edge.halfedges[0], 2 * pairs.size() == edge.halfedges.size() ? kPaired : kCrowded, tally);
    }
    for (std::uint32_t h = 0; h < twin_.size(); ++h) {
      const HalfedgeId twin = twin_[h];
      if (!is_halfedge(twin) || +twin < h || view_.topology.twin[h] != twin) continue;
      if (!geometry_.is_fold(view_.topology.face(HalfedgeId{h}), HalfedgeId{h}, view_.topology.face(twin), twin)) continue;
      twin_[h] = twin_[+twin] = Topology::kBoundary;
      cut(HalfedgeId{h}, kFold, tally);
    }
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  }

  // ---- vertices

  std::uint32_t root(std::uint32_t slot) {
    while (parent_[slot] != slot)
      slot = parent_[slot] = parent_[parent_[slot]];
    return slot;
  }
  void join(HalfedgeId a, HalfedgeId b) {
    const std::uint32_t s = root(+a), t = root(+b);
    parent_[std::max(s, t)] = std::min(s, t);
  }

  // The vertices of the view are the soup's points: it is welded.
  void split_vertices(CutTally& tally) {
    parent_.resize(twin_.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t h = 0; h < twin_.size(); ++h) {
      if (!is_halfedge(twin_[h])) continue;
      join(HalfedgeId{h}, after(twin_[h]));
      join(after(HalfedgeId{h}), twin_[h]);
    }
    std::vector<bool> is_touched(mesh().points.size(), false), is_used(mesh().points.size(), false);
    for (const VertexId v : touched_)
      is_touched[+v] = true;
    std::unordered_map<std::uint32_t, std::uint32_t> point_of_root;
    PolygonSoup& soup = piece_.soup;
    for (std::uint32_t h = 0; h < twin_.size(); ++h) {
      const VertexId v = mesh().corners[h];
      if (twin_[h] == Topology::kSkipped || !is_touched[+v]) continue;
      const auto [entry, is_new] = point_of_root.try_emplace(root(h), soup.corners[h]);
      if (is_new && is_used[+v]) {
        entry->second = add_point(soup.points[+v], piece_.source_point[+v]);
        ++tally.new_points;
      }
      is_used[+v] = true;
      soup.corners[h] = entry->second;
    }
  }
  std::uint32_t add_point(Vec3 position, std::uint32_t source) {  // by value: it may be one of the points
    piece_.soup.points.push_back(position);
    piece_.source_point.push_back(source);
    return static_cast<std::uint32_t>(piece_.soup.points.size() - 1);
  }

  // ---- edges that still have the same ends

  void part_edges(CutTally& tally) {
    std::vector<bool> is_touched(mesh().points.size(), false);
    for (const VertexId v : touched_)
      is_touched[+v] = true;
    struct Entry {
      std::uint64_t ends;
      std::uint32_t slot;
      auto operator<=>(const Entry&) const = default;
    };
    std::vector<Entry> entries;
    for (std::uint32_t h = 0; h < twin_.size(); ++h) {
      if (twin_[h] == Topology::kSkipped) continue;
      const HalfedgeId end = after(HalfedgeId{h});
      if (!is_touched[+mesh().corners[h]] || !is_touched[+mesh().corners[+end]]) continue;
      if (is_halfedge(twin_[h]) && +twin_[h] < h) continue;
      const std::uint32_t a = piece_.soup.corners[h], b = piece_.soup.corners[+end];
      entries.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), h});
    }
    std::sort(entries.begin(), entries.end());
    std::unordered_map<std::uint32_t, std::uint32_t> middle;  // of half-edges
    for (std::size_t i = 0, end = 0; i < entries.size(); i = end) {
      while (end < entries.size() && entries[end].ends == entries[i].ends)
        ++end;
      // A pair stays whole, if there is one: a corner more costs it two faces.
      std::size_t whole = i;
      while (whole + 1 < end && !is_halfedge(twin_[entries[whole].slot]))
        ++whole;
      for (std::size_t k = i; k < end; ++k) {
        if (k != whole) tally.middles += add_middle(HalfedgeId{entries[k].slot}, middle);
      }
    }
    insert(middle);
  }

  std::uint64_t add_middle(HalfedgeId h, std::unordered_map<std::uint32_t, std::uint32_t>& middle) {
    const std::uint32_t a = piece_.soup.corners[+h], b = piece_.soup.corners[+after(h)];
    Vec3 m = 0.5 * piece_.soup.points[a] + 0.5 * piece_.soup.points[b];
    if (piece_.has_floats) m = {static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)};
    const std::uint32_t point = add_point(m, piece_.source_point[a]);
    middle[+h] = point;
    if (is_halfedge(twin_[+h])) middle[+twin_[+h]] = point;
    return 1;
  }

  void insert(const std::unordered_map<std::uint32_t, std::uint32_t>& middle) {
    std::vector<std::uint32_t> faces;
    for (const auto& [slot, point] : middle)
      faces.push_back(+view_.topology.face(HalfedgeId{slot}));
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    FaceEdits edits;
    for (const std::uint32_t f : faces) {
      std::vector<Side> sides;
      for (std::uint32_t h = mesh().face_first[f]; h < mesh().face_first[f + 1]; ++h) {
        const auto entry = middle.find(h);
        sides.push_back({piece_.soup.corners[h], entry == middle.end() ? kNone : entry->second});
      }
      edits.emplace_back(f, sides.size() == 3 ? triangles_with_middles(sides) : Loops{loop_with_middles(sides)});
    }
    replace_faces(piece_, edits);
  }

  struct Side {
    std::uint32_t corner, middle;  // of the edge that starts there, or kNone
  };
  static std::vector<std::uint32_t> loop_with_middles(const std::vector<Side>& sides) {
    std::vector<std::uint32_t> loop;
    for (const Side& side : sides) {
      loop.push_back(side.corner);
      if (side.middle != kNone) loop.push_back(side.middle);
    }
    return loop;
  }
  // No triangle has both ends of an edge that has a middle.
  static Loops triangles_with_middles(std::vector<Side> sides) {
    const auto count = std::count_if(sides.begin(), sides.end(), [](const Side& side) { return side.middle != kNone; });
    const auto turn_until = [&sides](auto holds) {
      while (!holds())
        std::rotate(sides.begin(), sides.begin() + 1, sides.end());
    };
    const auto& [a, b, c] = std::tie(sides[0], sides[1], sides[2]);
    if (count == 1) {
      turn_until([&] { return a.middle != kNone; });
      return {{a.corner, a.middle, c.corner}, {a.middle, b.corner, c.corner}};
    }
    if (count == 2) {
      turn_until([&] { return c.middle == kNone; });
      return {{a.middle, b.corner, b.middle}, {a.corner, a.middle, b.middle}, {a.corner, b.middle, c.corner}};
    }
    return {{a.corner, a.middle, c.middle},
            {a.middle, b.corner, b.middle},
            {b.middle, c.corner, c.middle},
            {a.middle, b.middle, c.middle}};
  }

  Workpiece& piece_;
  const View view_;
  FaceGeometry geometry_;
  std::vector<HalfedgeId> twin_;  // as it is to be
  std::vector<VertexId> touched_;
  std::vector<std::uint32_t> parent_;  // of corners that keep one vertex
};

std::string cut_message(const CutTally& tally) {
  std::string text;
  const auto add = [&text](std::uint64_t count, const char* one, const char* many) {
    if (count != 0) text += (text.empty() ? "" : "; ") + counted(count, one, many);
  };
  add(tally.count[kPaired], "edge of more than two faces was parted into pairs of faces",
      "edges of more than two faces were parted into pairs of faces");
  add(tally.count[kCrowded], "edge of more than two faces was cut, since as many do not run along it as against it",
      "edges of more than two faces were cut, since as many do not run along them as against them");
  add(tally.count[kFold], "folded edge was cut", "folded edges were cut");
  add(tally.count[kOneSided], "edge was cut that makes its patch one-sided",
      "edges were cut that make their patches one-sided");
  if (text.empty()) return "no edge was cut";
  add(tally.new_points, "new vertex", "new vertices");
  add(tally.middles, "edge got a corner in its middle", "edges got a corner in their middle");
  return text;
}

}  // namespace

void cut_edges(Workpiece& piece, CutTally& tally) {
  tally.turned += turn_one_sided(piece);
  EdgeCutter(piece).run(tally);
}

RepairAction cut_action(const Workpiece& piece, CutTally& tally) {
  Tally none;
  RepairAction action = action_of(piece, "cut-non-manifold", Kind::faces, cut_message(tally), none);
  action.total = tally.edges.size();
  for (std::size_t i = 0; i < std::min(tally.edges.size(), kListedElements); ++i) {
    const CutTally::Edge& edge = tally.edges[i];
    Element element;
    element.faces = {edge.face};
    element.edges = {edge.ends};
    const std::vector<Vec3>& points = piece.input.points;
    element.point = 0.5 * points[edge.ends[0]] + 0.5 * points[edge.ends[1]];
    action.elements.push_back(std::move(element));
  }
  return action;
}

}  // namespace fdcg::bake
