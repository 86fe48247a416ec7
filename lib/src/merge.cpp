// SPDX-License-Identifier: Apache-2.0
#include "merge.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "remove_vertices.hpp"
#include "vec.hpp"

namespace fdcg::bake {
namespace {

class Merger {
 public:
  Merger(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions, const MergeOptions& options)
      : mesh_(std::move(mesh)),
        topology_(std::move(topology)),
        edges_(std::move(edges)),
        regions_(std::move(regions)),
        options_(options) {}

  Merged run() {
    for (const Region& region : regions_.list)
      views_.emplace_back(region.plane.normal);
    find_centres();
    if (options_.across_faces) VertexRemover(mesh_, topology_, edges_, regions_, views_, options_).run();
    drop_diagonals();
    collect();
    locate_triangles();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const Vec3& start(std::uint32_t slot) const { return mesh_.points[+mesh_.corners[slot]]; }
  [[nodiscard]] std::uint32_t region(std::uint32_t slot) const { return regions_.of_face[slot / 3]; }
  [[nodiscard]] bool is_alive(std::uint32_t face) const { return mesh_.corners[3 * face] != VertexId{kNone}; }

  // Before triangles change: where each was.
  void find_centres() {
    centre_.resize(mesh_.face_count());
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (regions_.of_face[f] == kNone) continue;
      const Vec3& a = start(3 * f);
      centre_[f] = a + (1.0 / 3) * ((start(3 * f + 1) - a) + (start(3 * f + 2) - a));
    }
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t face) {
    while (parent_[face] != face) {
      parent_[face] = parent_[parent_[face]];
      face = parent_[face];
    }
    return face;
  }

  // p -> x -> q does not turn right in the view, nor back.
  [[nodiscard]] bool stays_convex(const Projection& view, std::uint32_t before, std::uint32_t at, std::uint32_t after) const {
    const int turn = view.orient(start(before), start(at), start(after));
    return turn > 0 || (turn == 0 && view.goes_on(start(before), start(at), start(after)));
  }

  void drop_diagonals() {
    const auto slots = static_cast<std::uint32_t>(mesh_.corners.size());
    next_.resize(slots);
    previous_.resize(slots);
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      next_[slot] = slot % 3 == 2 ? slot - 2 : slot + 1;
      previous_[slot] = slot % 3 == 0 ? slot + 2 : slot - 1;
    }
    parent_.resize(mesh_.face_count());
    std::iota(parent_.begin(), parent_.end(), 0u);
    sides_.assign(mesh_.face_count(), 3);
    struct Diagonal {
      double squared_length;
      std::uint32_t slot;
    };
    std::vector<Diagonal> diagonals;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      const HalfedgeId twin = topology_.twin[slot];
      const std::uint32_t r = region(slot);
      if (r == kNone || !is_alive(slot / 3) || twin == Topology::kBoundary || +twin < slot) continue;
      if (region(+twin) != r || !may_join(slot / 3, +twin / 3)) continue;
      diagonals.push_back({squared_length(start(+twin) - start(slot)), slot});
    }
    std::stable_sort(diagonals.begin(), diagonals.end(),
                     [](const Diagonal& a, const Diagonal& b) { return a.squared_length > b.squared_length; });
    for (const Diagonal& diagonal : diagonals)
      try_drop(diagonal.slot);
  }

  [[nodiscard]] bool may_join(std::uint32_t a, std::uint32_t b) const {
    if (options_.across_faces) return true;
    return options_.polygon != nullptr && (*options_.polygon)[a] == (*options_.polygon)[b];
  }

  void try_drop(std::uint32_t slot) {
    const std::uint32_t twin = +topology_.twin[slot];
    const std::uint32_t a = root(slot / 3), b = root(twin / 3);
    if (a == b || sides_[a] + sides_[b] - 2 > kMaxMergedSides) return;
    const Projection& view = views_[region(slot)];
    if (!stays_convex(view, previous_[slot], slot, next_[next_[twin]])) return;
    if (!stays_convex(view, previous_[twin], twin, next_[next_[slot]])) return;
    link(previous_[slot], next_[twin]);
    link(previous_[twin], next_[slot]);
    parent_[std::max(a, b)] = std::min(a, b);
    sides_[std::min(a, b)] = sides_[a] + sides_[b] - 2;
    next_[slot] = next_[twin] = kNone;  // dropped
  }

  void link(std::uint32_t slot, std::uint32_t after) {
    next_[slot] = after;
    previous_[after] = slot;
  }

  // The polygons as a mesh of their own, in the order of their first triangles.
  void collect() {
    std::vector<std::uint32_t> slot_now(mesh_.corners.size(), kNone);
    Mesh& mesh = out_.mesh;
    mesh.face_first.push_back(0);
    std::vector<std::uint32_t> first_slot(mesh_.face_count(), kNone);
    for (std::uint32_t slot = 0; slot < slot_now.size(); ++slot) {
      if (!is_alive(slot / 3) || next_[slot] == kNone) continue;
      std::uint32_t& first = first_slot[root(slot / 3)];
      if (first == kNone) first = slot;
    }
    std::vector<std::uint32_t> source;  // slots, in their new order
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (first_slot[f] == kNone) continue;
      std::uint32_t slot = first_slot[f];
      do {
        slot_now[slot] = static_cast<std::uint32_t>(source.size());
        source.push_back(slot);
        slot = next_[slot];
      } while (slot != first_slot[f]);
      out_.regions.of_face.push_back(regions_.of_face[f]);
      mesh.face_first.push_back(static_cast<std::uint32_t>(source.size()));
    }
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
      out_.topology.face_of.resize(mesh.face_first[f + 1], FaceId{f});
    mesh.corners.reserve(source.size());
    out_.topology.twin.reserve(source.size());
    out_.edges.reserve(source.size());
    for (const std::uint32_t slot : source) {
      const HalfedgeId twin = topology_.twin[slot];
      mesh.corners.push_back(mesh_.corners[slot]);
      out_.topology.twin.push_back(twin == Topology::kBoundary ? twin : HalfedgeId{slot_now[+twin]});
      out_.edges.push_back(edges_[slot]);
    }
    face_of_root_.assign(mesh_.face_count(), kNone);
    for (std::uint32_t f = 0, now = 0; f < mesh_.face_count(); ++f) {
      if (first_slot[f] != kNone) face_of_root_[f] = now++;
    }
    mesh.points = std::move(mesh_.points);
    mesh.origin = mesh_.origin;
    mesh.source_point = std::move(mesh_.source_point);
    out_.regions.list = regions_.list;
  }

  void locate_triangles();
  [[nodiscard]] double depth(const Projection& view, std::uint32_t face, const Vec3& x) const;

  Mesh mesh_;
  Topology topology_;
  std::vector<EdgeClass> edges_;
  Regions regions_;
  const MergeOptions& options_;
  std::vector<Projection> views_;
  std::vector<Vec3> centre_;
  std::vector<std::uint32_t> next_, previous_;  // of each slot in its polygon; next_ is kNone for a dropped diagonal
  std::vector<std::uint32_t> parent_, sides_;   // of each triangle: union-find, and at the root the polygon's sides
  std::vector<std::uint32_t> face_of_root_;
  Merged out_;
};

// How far inside the polygon the point is: the least of the signed distances to its edges.
double Merger::depth(const Projection& view, std::uint32_t face, const Vec3& x) const {
  const Mesh& mesh = out_.mesh;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t slot = mesh.face_first[face]; slot < mesh.face_first[face + 1]; ++slot) {
    const Vec3& a = mesh.points[+mesh.corners[slot]];
    const Vec3& b = mesh.points[+mesh.corners[slot + 1 < mesh.face_first[face + 1] ? slot + 1 : mesh.face_first[face]]];
    const double u = view.u(b) - view.u(a), v = view.v(b) - view.v(a);
    const double area = u * (view.v(x) - view.v(a)) - v * (view.u(x) - view.u(a));
    least = std::min(least, area / std::sqrt(u * u + v * v));
  }
  return least;
}

void Merger::locate_triangles() {
  std::vector<std::uint32_t> first(regions_.list.size() + 1, 0), faces;
  const Mesh& mesh = out_.mesh;
  for (const std::uint32_t r : out_.regions.of_face) {
    if (r != kNone) ++first[r + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  faces.resize(first.back());
  std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t r = out_.regions.of_face[f];
    if (r != kNone) faces[at[r]++] = f;
  }
  out_.face_of_triangle.resize(mesh_.face_count());
  for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
    const std::uint32_t r = regions_.of_face[f];
    if (r == kNone) {
      out_.face_of_triangle[f] = face_of_root_[f];
      continue;
    }
    double best = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = first[r]; i < first[r + 1] && best < 0; ++i) {
      const double d = first[r + 1] - first[r] == 1 ? 0 : depth(views_[r], faces[i], centre_[f]);
      if (d <= best) continue;
      best = d;
      out_.face_of_triangle[f] = faces[i];
    }
  }
}

}  // namespace

Merged merge_regions(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions, const MergeOptions& options) {
  return Merger(std::move(mesh), std::move(topology), std::move(edges), std::move(regions), options).run();
}

}  // namespace fdcg::bake
