// SPDX-License-Identifier: Apache-2.0
#include "graph/merge.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "base/lazy_array.hpp"
#include "base/parallel.hpp"
#include "base/raw_array.hpp"
#include "base/release.hpp"
#include "base/vec3.hpp"
#include "graph/remove_vertices.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kCopyGrain = 1u << 15;

// Initial values of the entries of a triangle's slots, and of a triangle.
struct NextInTriangle {
  std::uint32_t operator()(std::uint32_t slot) const { return slot % 3 == 2 ? slot - 2 : slot + 1; }
};
struct PreviousInTriangle {
  std::uint32_t operator()(std::uint32_t slot) const { return slot % 3 == 0 ? slot + 2 : slot - 1; }
};
struct Itself {
  std::uint32_t operator()(std::uint32_t face) const { return face; }
};
struct ThreeSides {
  std::uint32_t operator()(std::uint32_t) const { return 3; }
};

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
    if (options_.across_faces) {
      VertexRemover remover(mesh_, topology_, edges_, regions_, views_, options_);
      remover.run();
      out_.removed_distance = remover.largest_distance();
    }
    drop_diagonals();
    collect();
    locate_triangles();
    return std::move(out_);
  }

 private:
  struct Diagonal {
    double squared_length;
    std::uint32_t slot;
  };

  [[nodiscard]] const Vec3& start(std::uint32_t slot) const { return mesh_.points[+mesh_.corners[slot]]; }
  [[nodiscard]] std::uint32_t region(std::uint32_t slot) const { return regions_.of_face[slot / 3]; }
  [[nodiscard]] bool is_alive(std::uint32_t face) const { return mesh_.corners[3 * face] != VertexId{kNone}; }

  // Stores the centres of all triangles in regions, in order, before the mesh is edited.
  void find_centres() {
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (regions_.of_face[f] == kNone) continue;
      const Vec3& a = start(3 * f);
      centre_.push_back(a + (1.0 / 3) * ((start(3 * f + 1) - a) + (start(3 * f + 2) - a)));
    }
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t face) {
    while (parent_[face] != face) {
      parent_.set(face, parent_[parent_[face]]);
      face = parent_[face];
    }
    return face;
  }

  // Whether the path before -> at -> after turns neither clockwise nor back in the projection. For corners off their plane the
  // same must hold along the plane's normal, up to rounding error, since the Voronoi planes are perpendicular to that plane.
  [[nodiscard]] bool stays_convex(std::uint32_t before, std::uint32_t at, std::uint32_t after) const {
    const Vec3 &a = start(before), &b = start(at), &c = start(after);
    const Projection& view = views_[region(at)];
    const int turn = view.orient(a, b, c);
    if (turn < 0 || (turn == 0 && !view.goes_on(a, b, c))) return false;
    const Region& home = regions_.list[region(at)];
    if (home.is_exact) return true;
    constexpr double kRounding = 1e-14;
    return dot(home.plane.normal, cross(b - a, c - b)) >= -kRounding * length(b - a) * length(c - b);
  }

  void drop_diagonals() {
    const auto slots = static_cast<std::uint32_t>(mesh_.corners.size());
    next_ = LazyArray<NextInTriangle>(slots);
    previous_ = LazyArray<PreviousInTriangle>(slots);
    parent_ = LazyArray<Itself>(mesh_.face_count());
    sides_ = LazyArray<ThreeSides>(mesh_.face_count());
    std::vector<Diagonal> diagonals;
    for (std::uint32_t face = 0; face < mesh_.face_count(); ++face) {
      const std::uint32_t r = regions_.of_face[face];
      if (r == kNone || !is_alive(face)) continue;
      for (std::uint32_t slot = 3 * face; slot < 3 * face + 3; ++slot) {
        const HalfedgeId twin = topology_.twin[slot];
        if (twin == Topology::kBoundary || +twin < slot || region(+twin) != r || !may_join(face, +twin / 3)) continue;
        diagonals.push_back({squared_length(start(+twin) - start(slot)), slot});
      }
    }
    std::stable_sort(diagonals.begin(), diagonals.end(),
                     [](const Diagonal& a, const Diagonal& b) { return a.squared_length > b.squared_length; });
    for (const Diagonal& diagonal : diagonals)
      try_drop(diagonal.slot);
    split_large_polygons(diagonals);
  }

  [[nodiscard]] bool may_join(std::uint32_t a, std::uint32_t b) const {
    if (options_.across_faces) return true;
    return options_.polygon != nullptr && (*options_.polygon)[a] == (*options_.polygon)[b];
  }

  void try_drop(std::uint32_t slot) {
    const std::uint32_t twin = +topology_.twin[slot];
    const std::uint32_t a = root(slot / 3), b = root(twin / 3);
    if (a == b) return;
    if (!stays_convex(previous_[slot], slot, next_[next_[twin]])) return;
    if (!stays_convex(previous_[twin], twin, next_[next_[slot]])) return;
    link(previous_[slot], next_[twin]);
    link(previous_[twin], next_[slot]);
    parent_.set(std::max(a, b), std::min(a, b));
    sides_.set(std::min(a, b), sides_[a] + sides_[b] - 2);
    next_.set(slot, kNone);  // dropped
    next_.set(twin, kNone);
  }

  // Splits polygons with more sides than a node may have into the fewest parts of similar size. The new diagonals reuse the
  // slots of dropped ones.
  void split_large_polygons(const std::vector<Diagonal>& diagonals) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> spare;  // of each large polygon, by its root
    for (const Diagonal& diagonal : diagonals) {
      const std::uint32_t r = root(diagonal.slot / 3);
      if (next_[diagonal.slot] == kNone && sides_[r] > kMaxMergedSides) spare[r].push_back(diagonal.slot);
    }
    for (auto& [r, slots] : spare) {
      const std::uint32_t first = find_side(r, slots);
      std::vector<std::uint32_t> loop;
      std::uint32_t slot = first;
      do {
        loop.push_back(slot);
        slot = next_[slot];
      } while (slot != first);
      split(loop, slots);
    }
  }

  // A half-edge of the triangle that is not dropped, else kNone.
  [[nodiscard]] std::uint32_t side_of(std::uint32_t triangle) const {
    for (std::uint32_t slot = 3 * triangle; slot < 3 * triangle + 3; ++slot)
      if (next_[slot] != kNone) return slot;
    return kNone;
  }

  // A boundary half-edge of a merged polygon. Its inner triangles, perhaps the root too, have none left; but every triangle of
  // it is adjacent to a dropped diagonal, so looking at both sides of all dropped diagonals reaches every triangle.
  [[nodiscard]] std::uint32_t find_side(std::uint32_t root_triangle, const std::vector<std::uint32_t>& dropped) const {
    std::uint32_t side = side_of(root_triangle);
    for (std::size_t i = 0; i < dropped.size() && side == kNone; ++i)
      side = side_of(dropped[i] / 3);
    for (std::size_t i = 0; i < dropped.size() && side == kNone; ++i)
      side = side_of(+topology_.twin[dropped[i]] / 3);
    return side;
  }

  void split(const std::vector<std::uint32_t>& loop, std::vector<std::uint32_t>& spare) {
    const std::size_t count = loop.size();
    if (count <= kMaxMergedSides) return;
    constexpr std::size_t kCorners = kMaxMergedSides - 2;  // corners of a part beside the two of the cut
    const std::size_t pieces = (count - 2 + kCorners - 1) / kCorners;
    const std::size_t taken = (count - 2) * (pieces / 2) / pieces + 1;  // sides of the first part without the cut
    for (std::size_t offset = 0; offset < count; ++offset) {
      std::vector<std::uint32_t> part(loop.begin() + static_cast<std::ptrdiff_t>(offset), loop.end());
      part.insert(part.end(), loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(offset));
      std::vector<std::uint32_t> rest(part.begin() + static_cast<std::ptrdiff_t>(taken), part.end());
      part.resize(taken);
      const std::uint32_t from = part.front(), to = rest.front();
      if (!has_area(part, to) || !has_area(rest, from)) continue;
      if (!runs_along(regions_.list[region(from)].plane.normal, start(from), start(to))) continue;
      const std::uint32_t cut = spare.back(), back = +topology_.twin[cut];
      spare.pop_back();
      mesh_.corners[cut] = mesh_.corners[to];
      mesh_.corners[back] = mesh_.corners[from];
      const Region& home = regions_.list[region(cut)];
      edges_[cut] = edges_[back] = home.is_exact ? EdgeClass{FDCG_COPLANAR, Flat::exact} : EdgeClass{FDCG_CONVEX, home.tier};
      link(part.back(), cut);
      link(cut, from);
      link(rest.back(), back);
      link(back, to);
      part.push_back(cut);
      rest.push_back(back);
      split(part, spare);
      split(rest, spare);
      return;
    }
  }

  // Whether the chain of sides, closed by the cut from `end` back to its start, has positive area.
  [[nodiscard]] bool has_area(const std::vector<std::uint32_t>& chain, std::uint32_t end) const {
    const Projection& view = views_[region(end)];
    return std::any_of(chain.begin() + 1, chain.end(),
                       [&](std::uint32_t slot) { return view.orient(start(chain.front()), start(slot), start(end)) > 0; });
  }

  void link(std::uint32_t slot, std::uint32_t after) {
    next_.set(slot, after);
    previous_.set(after, slot);
  }

  // values[slots[0]], values[slots[1]], ...; frees `values`.
  template <class Value>
  std::vector<Value> moved_to(std::vector<Value>& values, std::span<const std::uint32_t> slots) const {
    std::vector<Value> result(slots.size());
    parallel_for(options_.jobs, slots.size(), kCopyGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        result[i] = values[slots[i]];
    });
    release(values);
    return result;
  }

  // The polygons as a mesh of their own, in the order of their first half-edges.
  void collect() {
    previous_ = {};  // arrays are freed as soon as they have served: this is where a compilation needs the most memory
    parent_ = {};
    sides_ = {};
    release(mesh_.face_first);
    const auto triangles = static_cast<std::uint32_t>(mesh_.corners.size() / 3);
    RawArray<std::uint32_t> slot_now(mesh_.corners.size());
    RawArray<std::uint32_t> source(mesh_.corners.size());  // slots, in their new order
    std::uint32_t taken = 0;
    for (std::uint32_t f = 0; f < triangles; ++f) {
      for (std::uint32_t slot = 3 * f; regions_.of_face[f] != kNone && slot < 3 * f + 3; ++slot)
        slot_now[slot] = kNone;
    }
    const auto take = [&](std::uint32_t slot) {
      slot_now[slot] = taken;
      source[taken++] = slot;
    };
    Mesh& mesh = out_.mesh;
    face_of_loner_.assign(triangles, kNone);
    mesh.face_first.reserve(triangles + 1);
    out_.regions.of_face.reserve(triangles);
    mesh.face_first.push_back(0);
    const auto end_face = [&](std::uint32_t region) {
      out_.regions.of_face.push_back(region);
      mesh.face_first.push_back(taken);
    };
    for (std::uint32_t f = 0; f < triangles; ++f) {
      const std::uint32_t home = regions_.of_face[f];
      if (home == kNone) {  // a triangle as it was
        face_of_loner_[f] = mesh.face_count();
        take(3 * f), take(3 * f + 1), take(3 * f + 2);
        end_face(kNone);
        continue;
      }
      for (std::uint32_t first = 3 * f; is_alive(f) && first < 3 * f + 3; ++first) {
        if (next_[first] == kNone || slot_now[first] != kNone) continue;
        for (std::uint32_t slot = first; slot_now[slot] == kNone; slot = next_[slot])
          take(slot);
        end_face(home);
      }
    }
    next_ = {};
    const std::span<const std::uint32_t> slots{source.data(), taken};
    out_.topology.twin.resize(taken);
    parallel_for(options_.jobs, taken, kCopyGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const HalfedgeId twin = topology_.twin[slots[i]];
        out_.topology.twin[i] = twin == Topology::kBoundary ? twin : HalfedgeId{slot_now[+twin]};
      }
    });
    topology_ = {};
    slot_now = {};
    mesh.corners = moved_to(mesh_.corners, slots);
    out_.edges = moved_to(edges_, slots);
    source = {};
    out_.topology.face_of.resize(taken);
    parallel_for(options_.jobs, mesh.face_count(), kCopyGrain, [&](std::size_t begin, std::size_t end) {
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f)
        std::fill(out_.topology.face_of.begin() + mesh.face_first[f], out_.topology.face_of.begin() + mesh.face_first[f + 1],
                  FaceId{f});
    });
    mesh.points = std::move(mesh_.points);
    mesh.origin = mesh_.origin;
    mesh.source_point = std::move(mesh_.source_point);
    out_.regions.list = regions_.list;
  }

  void locate_triangles();
  struct Depth {
    double distance;
    std::uint32_t slot;
  };
  [[nodiscard]] Depth depth(const Projection& view, std::uint32_t face, const Vec3& x) const;
  [[nodiscard]] std::uint32_t locate(const Projection& view, std::span<const std::uint32_t> faces, std::uint32_t start_face,
                                     const Vec3& x) const;

  Mesh mesh_;
  Topology topology_;
  std::vector<EdgeClass> edges_;
  Regions regions_;
  const MergeOptions& options_;
  std::vector<Projection> views_;
  std::vector<Vec3> centre_;        // of the regions' triangles, in order
  LazyArray<NextInTriangle> next_;  // of each slot in its polygon; kNone for a dropped diagonal
  LazyArray<PreviousInTriangle> previous_;
  LazyArray<Itself> parent_;                  // of each triangle: union-find
  LazyArray<ThreeSides> sides_;               // at the root: the polygon's
  std::vector<std::uint32_t> face_of_loner_;  // of each triangle in no region: its face of the result
  Merged out_;
};

// Signed depth of the point in the polygon: the smallest of the signed distances to its edges; and that edge.
Merger::Depth Merger::depth(const Projection& view, std::uint32_t face, const Vec3& x) const {
  const Mesh& mesh = out_.mesh;
  Depth least{std::numeric_limits<double>::infinity(), 0};
  for (std::uint32_t slot = mesh.face_first[face]; slot < mesh.face_first[face + 1]; ++slot) {
    const Vec3& a = mesh.points[+mesh.corners[slot]];
    const Vec3& b = mesh.points[+mesh.corners[slot + 1 < mesh.face_first[face + 1] ? slot + 1 : mesh.face_first[face]]];
    const double u = view.u(b) - view.u(a), v = view.v(b) - view.v(a);
    const double area = u * (view.v(x) - view.v(a)) - v * (view.u(x) - view.u(a));
    const double distance = area / std::sqrt(u * u + v * v);
    if (distance < least.distance) least = {distance, slot};
  }
  return least;
}

// Point location: walks from polygon to polygon of the region towards x. Where the walk leaves the region (at a hole) or
// exceeds its bound, searches all polygons.
std::uint32_t Merger::locate(const Projection& view, std::span<const std::uint32_t> faces, std::uint32_t start_face,
                             const Vec3& x) const {
  constexpr int kMostSteps = 256;
  std::uint32_t face = start_face;
  for (int step = 0; step < kMostSteps; ++step) {
    const Depth here = depth(view, face, x);
    if (here.distance >= 0) return face;
    const HalfedgeId twin = out_.topology.twin[here.slot];
    if (twin == Topology::kBoundary) break;
    const FaceId other = out_.topology.face(twin);
    if (out_.regions.of(other) != out_.regions.of(FaceId{face})) break;
    face = +other;
  }
  double best = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t candidate : faces) {
    const double distance = depth(view, candidate, x).distance;
    if (distance <= best) continue;
    best = distance;
    face = candidate;
    if (best >= 0) break;
  }
  return face;
}

void Merger::locate_triangles() {
  std::vector<std::uint32_t> first(regions_.list.size() + 1, 0);
  for (const std::uint32_t r : out_.regions.of_face) {
    if (r != kNone) ++first[r + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> faces(first.back());
  std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
  for (std::uint32_t f = 0; f < out_.mesh.face_count(); ++f) {
    const std::uint32_t r = out_.regions.of_face[f];
    if (r != kNone) faces[at[r]++] = f;
  }
  std::vector<std::uint32_t> last_found(regions_.list.size());
  for (std::size_t r = 0; r < last_found.size(); ++r)
    last_found[r] = faces[first[r]];
  const auto triangles = static_cast<std::uint32_t>(face_of_loner_.size());
  out_.face_of_triangle.resize(triangles);
  std::size_t of_regions = 0;  // triangles so far, as find_centres counted them
  for (std::uint32_t f = 0; f < triangles; ++f) {
    const std::uint32_t r = regions_.of_face[f];
    if (r == kNone) {
      out_.face_of_triangle[f] = face_of_loner_[f];
      continue;
    }
    const std::span<const std::uint32_t> of_region{faces.data() + first[r], first[r + 1] - first[r]};
    const Vec3& centre = centre_[of_regions++];
    if (of_region.size() > 1) last_found[r] = locate(views_[r], of_region, last_found[r], centre);
    out_.face_of_triangle[f] = last_found[r];
  }
}

}  // namespace

Merged merge_regions(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions, const MergeOptions& options) {
  return Merger(std::move(mesh), std::move(topology), std::move(edges), std::move(regions), options).run();
}

}  // namespace fdcg::bake
