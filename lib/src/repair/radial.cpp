// SPDX-License-Identifier: Apache-2.0
#include "repair/radial.hpp"

#include <algorithm>
#include <cstddef>

#include "exact/exact.hpp"
#include "topology/face_triangles.hpp"

namespace fdcg::bake {
namespace {

// Order by the angle around the line from u to v, counter-clockwise seen from v, starting at `start`.
class AngularOrder {
 public:
  AngularOrder(const Vec3& u, const Vec3& v, const Vec3& start) : u_(u), v_(v), start_(start) {
    while (axis_ < 2 && exact::orient2d(u, v, start, axis_) == 0)
      ++axis_;
  }

  // -1, 0, 1
  [[nodiscard]] int compare(const Vec3& a, const Vec3& b) const {
    const int s = sector(a), t = sector(b);
    if (s != t) return s < t ? -1 : 1;
    if (s == kStart || s == kOpposite) return 0;
    return -exact::orient3d(u_, v_, a, b);
  }

 private:
  static constexpr int kStart = 0, kFirstHalf = 1, kOpposite = 2, kSecondHalf = 3;

  [[nodiscard]] int sector(const Vec3& w) const {
    const int side = exact::orient3d(u_, v_, start_, w);
    if (side != 0) return side > 0 ? kFirstHalf : kSecondHalf;
    return exact::orient2d(u_, v_, w, axis_) == exact::orient2d(u_, v_, start_, axis_) ? kStart : kOpposite;
  }

  const Vec3 &u_, &v_, &start_;
  int axis_ = 0;
};

}  // namespace

RadialPairing::RadialPairing(const Mesh& mesh, const Topology& topology, FaceGeometry& geometry)
    : mesh_(mesh), topology_(topology), geometry_(geometry) {}

void RadialPairing::cut_polygons() {
  is_cut_ = true;
  const FaceTriangles triangles(mesh_, geometry_, 1);
  if (triangles.is_plain()) return;
  apex_.assign(mesh_.corners.size(), VertexId{kNone});
  for (std::uint32_t t = 0; t < triangles.count(); ++t) {
    const FaceId f = triangles.face(t);
    const VertexId* const c = triangles.corners(t);
    const unsigned seams = triangles[t].seams;
    for (unsigned i = 0; i < 3; ++i) {
      if ((seams >> i & 1U) != 0) continue;
      const auto first = mesh_.corners.begin() + mesh_.face_first[+f], end = mesh_.corners.begin() + mesh_.face_first[+f + 1];
      const auto slot = std::find(first, end, c[i]);
      if (slot != end) apex_[static_cast<std::size_t>(slot - mesh_.corners.begin())] = c[(i + 2) % 3];
    }
  }
}

const Vec3* RadialPairing::apex_of(HalfedgeId h) {
  if (!is_cut_) cut_polygons();
  const FaceId f = topology_.face(h);
  if (geometry_.is_degenerate(f) || !geometry_.is_finite(f)) return nullptr;
  const VertexId apex = apex_.empty() ? mesh_.corners[+previous(mesh_, f, h)] : apex_[+h];
  return apex == VertexId{kNone} ? nullptr : &mesh_.points[+apex];
}

std::vector<RadialPairing::Spoke> RadialPairing::sorted_spokes(const OddEdge& edge) {
  const HalfedgeId any = edge.halfedges[0];
  const VertexId from = mesh_.corners[+any], to = mesh_.corners[+next(mesh_, topology_.face(any), any)];
  const Vec3 &u = mesh_.points[+from], &v = mesh_.points[+to];
  std::vector<Spoke> spokes;
  for (const HalfedgeId h : edge.halfedges) {
    const Vec3* const apex = apex_of(h);
    // Of a polygon far from flat the triangle at the edge may be seen edge-on.
    if (apex != nullptr && !exact::collinear(u, v, *apex)) spokes.push_back({h, apex, mesh_.corners[+h] == from});
  }
  if (spokes.empty()) return spokes;
  const AngularOrder order(u, v, *spokes[0].apex);
  std::stable_sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) {
    const int compared = order.compare(*a.apex, *b.apex);
    return compared != 0 ? compared < 0 : a.is_along && !b.is_along;  // nothing solid between faces at one angle
  });
  return spokes;
}

bool RadialPairing::can_pair(const Spoke& a, const Spoke& b) {
  const FaceId f = topology_.face(a.halfedge), g = topology_.face(b.halfedge);
  return f != g && !geometry_.is_fold(f, a.halfedge, g, b.halfedge);
}

// A face that runs along the edge has its front towards larger angles, so its inside towards smaller ones: it closes a wedge.
std::vector<RadialPairing::Pair> RadialPairing::pairs_of(const OddEdge& edge) {
  std::vector<Spoke> spokes = sorted_spokes(edge);
  std::vector<Pair> pairs;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < 2 * spokes.size(); ++i) {  // twice round: a wedge may lie across the start
    Spoke& spoke = spokes[i % spokes.size()];
    if (spoke.is_taken) continue;
    if (!spoke.is_along) {
      if (i < spokes.size()) open.push_back(i);
      continue;
    }
    for (std::size_t k = open.size(); k-- > 0;) {
      if (!can_pair(spokes[open[k]], spoke)) continue;
      pairs.emplace_back(spokes[open[k]].halfedge, spoke.halfedge);
      spoke.is_taken = spokes[open[k]].is_taken = true;
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(k));
      break;
    }
  }
  return pairs;
}

}  // namespace fdcg::bake
