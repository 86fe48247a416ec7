// SPDX-License-Identifier: Apache-2.0
// Let d be any direction, v the vertex, and let its faces close up to one fan of edges e_0, e_1, ... counter-clockwise. Where
// every e_i x e_(i+1) has a positive component along d, the faces seen along d are sectors around v of less than half a turn
// each, all run the same way round, and each begins where the one before ends. So every direction around v is covered by
// equally many sectors, and if that is one, sectors have nothing in common but the sides between neighbours. Each face lies
// over its sector, one point over each, so faces too have no more in common.
//
// How many: let m be perpendicular to d. A sector covers the direction around v where e . m grows through zero, if and only if
// its first edge is below and its second above. Both signs are taken from doubles with bounds on their error.
#include "validate/simple_stars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/parallel.hpp"
#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kStarGrain = 1u << 12;
constexpr std::uint32_t kMostFaces = 16;  // of a star that is looked at
constexpr double kUnit = 0x1p-53;
// Both for edges whose components are at most 1, rounded differences of coordinates; d and m are exact as they are.
// (e x f) . d in units of d's largest component: 6 terms of at most 7 roundings; doubled and more, which covers the bound's own
// rounding.
constexpr double kVolumeError = 96 * kUnit;
// e . m in units of the sum of m's components: at most 4 roundings; doubled.
constexpr double kSideError = 8 * kUnit;
constexpr double kLargestSize = 0x1p160;  // of an edge: no product overflows
constexpr double kLeastError = 0x1p-850;  // bounds below this are not trusted: underflow could matter

std::uint32_t previous_of(std::uint32_t slot) {
  return slot % 3 == 0 ? slot + 2 : slot - 1;
}

class Star {
 public:
  Star(const Mesh& mesh, const Topology& topology) : mesh_(mesh), topology_(topology) {}

  // The star of the vertex at which `first` starts, of so many faces.
  bool is_simple(std::uint32_t first, std::uint32_t faces) {
    return faces >= 3 && faces <= kMostFaces && read_edges(first, faces) && faces_front(faces) && turns_once(faces);
  }

 private:
  // False where the fan does not close after so many faces.
  bool read_edges(std::uint32_t first, std::uint32_t faces) {
    const Vec3& centre = mesh_.points[+mesh_.corners[first]];
    std::uint32_t slot = first;
    size_ = 0;
    for (std::uint32_t i = 0; i < faces; ++i) {
      const HalfedgeId twin = topology_.twin[slot];
      if (!is_halfedge(twin)) return false;
      edges_[i] = mesh_.points[+mesh_.corners[+twin]] - centre;
      const double size = largest_component(edges_[i]);
      if (!(size <= kLargestSize)) return false;  // not a number either
      size_ = std::max(size_, size);
      const HalfedgeId next_twin = topology_.twin[previous_of(slot)];
      if (!is_halfedge(next_twin)) return false;
      slot = +next_twin;
      if (slot == first) return i + 1 == faces;
    }
    return false;
  }

  // Chooses d, and asks whether every face has a positive component along it.
  bool faces_front(std::uint32_t faces) {
    std::array<Vec3, kMostFaces> normals;
    direction_ = {};
    for (std::uint32_t i = 0; i < faces; ++i) {
      normals[i] = cross(edges_[i], edges_[i + 1 < faces ? i + 1 : 0]);
      direction_ = direction_ + normals[i];
    }
    const double error = kVolumeError * size_ * size_ * largest_component(direction_);
    for (std::uint32_t i = 0; i < faces; ++i)
      if (!(dot(normals[i], direction_) > error)) return false;
    return error > kLeastError;
  }

  bool turns_once(std::uint32_t faces) const {
    // Exactly perpendicular to d: two of its components, one negated.
    const int axis = dominant_axis(direction_);
    const Vec3& d = direction_;
    const Vec3 m = axis == 0 ? Vec3{-d.y, d.x, 0} : axis == 1 ? Vec3{0, -d.z, d.y} : Vec3{d.z, 0, -d.x};
    const double error = kSideError * (std::fabs(m.x) + std::fabs(m.y) + std::fabs(m.z)) * size_;
    if (!(error > kLeastError)) return false;
    std::array<bool, kMostFaces> is_above{};
    for (std::uint32_t i = 0; i < faces; ++i) {
      const double side = dot(edges_[i], m);
      if (!(std::fabs(side) > error)) return false;
      is_above[i] = side > 0;
    }
    std::uint32_t covering = 0;
    for (std::uint32_t i = 0; i < faces; ++i)
      covering += !is_above[i] && is_above[i + 1 < faces ? i + 1 : 0];
    return covering == 1;
  }

  const Mesh& mesh_;
  const Topology& topology_;
  std::array<Vec3, kMostFaces> edges_;
  Vec3 direction_;
  double size_ = 0;  // the largest component of an edge
};

}  // namespace

SimpleStars find_simple_stars(const Mesh& mesh, const Topology& topology, unsigned jobs) {
  struct Corners {
    std::uint32_t first = kNone, count = 0;
  };
  std::vector<Corners> corners(mesh.points.size());
  for (std::uint32_t slot = 0; slot < mesh.corners.size(); ++slot) {
    const VertexId v = mesh.corners[slot];
    if (+v == kNone) continue;
    Corners& at = corners[+v];
    at.first = slot;
    ++at.count;
  }
  SimpleStars stars;
  stars.is_simple.resize(mesh.points.size());
  for (const Corners& at : corners)
    stars.most_faces = std::max(stars.most_faces, at.count);
  parallel_for(jobs, corners.size(), kStarGrain, [&](std::size_t begin, std::size_t end) {
    Star star(mesh, topology);
    for (std::size_t v = begin; v < end; ++v)
      stars.is_simple[v] = corners[v].first != kNone && star.is_simple(corners[v].first, corners[v].count);
  });
  return stars;
}

}  // namespace fdcg::bake
