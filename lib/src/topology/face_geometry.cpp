// SPDX-License-Identifier: Apache-2.0
#include "topology/face_geometry.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "exact/exact.hpp"
#include "exact/filtered_sum.hpp"
#include "exact/outline.hpp"

namespace fdcg::bake {
namespace {

bool finite(const Vec3& p) {
  // NaN and infinities, and nothing else, turn into NaN when multiplied by zero.
  return p.x * 0 + p.y * 0 + p.z * 0 == 0;
}

}  // namespace

FaceGeometry::FaceGeometry(const Mesh& mesh, const std::vector<FaceState>& states, unsigned jobs)
    : mesh_(mesh), bits_(mesh.face_count(), 0) {
  const bool has_polygons = mesh.corners.size() != std::size_t{3} * mesh.face_count() ||
                            std::adjacent_find(mesh.face_first.begin(), mesh.face_first.end(),
                                               [](auto a, auto b) { return b != a + 3; }) != mesh.face_first.end();
  if (has_polygons) {
    frames_.resize(mesh.face_count());
    flat_.resize(mesh.face_count(), Flat::unknown);
  }
  constexpr std::size_t kFacesAtOnce = 16'384;
  parallel_for(jobs, mesh.face_count(), kFacesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      look_at(FaceId{static_cast<std::uint32_t>(f)}, states[f]);
  });
}

void FaceGeometry::look_at(FaceId f, FaceState state) {
  std::uint8_t& bits = bits_[+f];
  if (state == FaceState::repeated_corner) bits |= kDegenerate;
  if (state == FaceState::invalid_corner) {
    bits |= kNotFinite;
    return;
  }
  for (std::uint32_t h = first(f); h < first(f) + size(f); ++h) {
    if (!finite(point(h))) bits |= kNotFinite;
  }
  if (bits != 0) return;
  bits = certain_signs(f);
  if (bits != 0 && frames_.empty()) return;  // a certain sign: the triangle has an area
  std::array<std::uint32_t, 3> found{};
  if (!find_frame(f, found)) bits = kDegenerate;
  if (!frames_.empty()) frames_[+f] = found;
}

std::uint8_t FaceGeometry::certain_signs(FaceId f) const {
  const Vec3& o = point(first(f));
  FilteredSum x, y, z;
  const Vec3& p1 = point(first(f) + 1);
  Vec3 a{p1.x - o.x, p1.y - o.y, p1.z - o.z};
  for (std::uint32_t h = first(f) + 2; h < first(f) + size(f); ++h) {
    const Vec3& p = point(h);
    const Vec3 b{p.x - o.x, p.y - o.y, p.z - o.z};
    x.add(a.y, a.z, b.y, b.z);
    y.add(a.z, a.x, b.z, b.x);
    z.add(a.x, a.y, b.x, b.y);
    a = b;
  }
  const double terms = size(f) - 2;
  unsigned bits = 0;
  if (x.is_certain(terms)) bits |= x.value > 0 ? 1U : 8U;
  if (y.is_certain(terms)) bits |= y.value > 0 ? 2U : 16U;
  if (z.is_certain(terms)) bits |= z.value > 0 ? 4U : 32U;
  return static_cast<std::uint8_t>(bits);
}

bool FaceGeometry::find_frame(FaceId f, std::array<std::uint32_t, 3>& frame) const {
  const std::uint32_t end = first(f) + size(f);
  const std::uint32_t a = first(f);
  std::uint32_t b = a + 1;
  while (b < end && point(b) == point(a))
    ++b;
  std::uint32_t c = b + 1;
  while (c < end && exact::collinear(point(a), point(b), point(c)))
    ++c;
  frame = {a, b, c};
  return c < end;
}

std::array<std::uint32_t, 3> FaceGeometry::frame(FaceId f) const {
  if (!frames_.empty()) return frames_[+f];
  return {first(f), first(f) + 1, first(f) + 2};
}

bool FaceGeometry::is_flat(FaceId f) {
  if (!is_finite(f)) return false;
  if (is_degenerate(f) || size(f) == 3) return true;
  Flat& flat = flat_[+f];
  if (flat == Flat::unknown) {
    const auto [a, b, c] = frame(f);
    flat = Flat::yes;
    for (std::uint32_t h = first(f); h < first(f) + size(f) && flat == Flat::yes; ++h) {
      if (exact::orient3d(point(a), point(b), point(c), point(h)) != 0) flat = Flat::no;
    }
  }
  return flat == Flat::yes;
}

// The exact sign of the signed area, projected along `axis`.
int FaceGeometry::sign_along(FaceId f, int axis) const {
  if ((bits_[+f] & 1U << axis) != 0) return 1;
  if ((bits_[+f] & 8U << axis) != 0) return -1;
  if (size(f) == 3) return exact::orient2d(point(first(f)), point(first(f) + 1), point(first(f) + 2), axis);
  std::vector<Vec3> polygon;
  for (std::uint32_t h = first(f); h < first(f) + size(f); ++h)
    polygon.push_back(point(h));
  return area_sign(polygon, axis);
}

bool FaceGeometry::is_fold(FaceId a, HalfedgeId h, FaceId b, HalfedgeId other) {
  const unsigned bits_a = bits_[+a], bits_b = bits_[+b];
  if (((bits_a | bits_b) & (kNotFinite | kDegenerate)) != 0) return false;
  // The normals of folded faces are opposite if their loops traverse the edge in opposite directions, else equal. One axis with
  // certain signs to the contrary decides.
  const bool opposite_runs = mesh_.corners[+h] != mesh_.corners[+other];
  const unsigned turned_b = opposite_runs ? bits_b : ((bits_b & 7U) << 3 | bits_b >> 3);
  if ((bits_a & turned_b & kSigns) != 0) return false;

  const Vec3& p = point(+h);
  const Vec3& q = point(+next(mesh_, a, h));
  if (p == q) return false;
  std::array<std::uint32_t, 3> frame_a = frame(a), frame_b = frame(b);
  const auto off_line = [&](std::uint32_t slot) { return !exact::collinear(p, q, point(slot)); };
  const auto w = std::find_if(frame_a.begin(), frame_a.end(), off_line);
  const auto x = std::find_if(frame_b.begin(), frame_b.end(), off_line);
  if (w == frame_a.end() || x == frame_b.end()) return false;
  if (exact::orient3d(p, q, point(*w), point(*x)) != 0 || !is_flat(a) || !is_flat(b)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (exact::orient2d(p, q, point(*w), axis) == 0) continue;  // the common plane is seen edge-on
    return sign_along(a, axis) * sign_along(b, axis) == (opposite_runs ? -1 : 1);
  }
  return false;
}

}  // namespace fdcg::bake
