// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check_rules.hpp"

namespace fdcg::bake::checks {
namespace {

// Every corner lies within the tolerance of the plane of the area vector through the corners' mean. The tolerance is what moves
// of every coordinate by the input's quantum (and the storage's) can do, times four: the corner and the plane are off by one
// each, and programs that turn an object round more than once.
bool is_planar_within_quantum(const Subject& subject, FaceId f) {
  const Mesh& mesh = subject.mesh;
  const std::uint32_t first = mesh.face_first[+f], end = mesh.face_first[+f + 1];
  const auto point = [&](std::uint32_t h) -> const Vec3& { return mesh.points[+mesh.corners[h]]; };
  const Vec3 o = point(first);
  Vec3 n, sum, largest;
  for (std::uint32_t h = first; h < end; ++h) {
    const Vec3& p = point(h);
    const Vec3& q = point(h + 1 < end ? h + 1 : first);
    const Vec3 a{p.x - o.x, p.y - o.y, p.z - o.z}, b{q.x - o.x, q.y - o.y, q.z - o.z};
    n = {n.x + (a.y * b.z - a.z * b.y), n.y + (a.z * b.x - a.x * b.z), n.z + (a.x * b.y - a.y * b.x)};
    sum = {sum.x + a.x, sum.y + a.y, sum.z + a.z};
    largest = {std::max(largest.x, std::abs(p.x)), std::max(largest.y, std::abs(p.y)), std::max(largest.z, std::abs(p.z))};
  }
  const double length = std::hypot(n.x, n.y, n.z);
  if (!(length > 0)) return false;
  const double corners = end - first;
  const Vec3 mean{sum.x / corners, sum.y / corners, sum.z / corners};
  const double stored = subject.precision == Precision::f32 ? 0x1p-24 : 0;
  const auto quantum = [&](double local, double origin) {
    const double input = std::max(subject.soup.relative_quantum * (local + std::abs(origin)), subject.soup.absolute_quantum);
    return input + stored * local;
  };
  constexpr double kTolerance = 4;
  const double limit = kTolerance *
                       (std::abs(n.x) * quantum(largest.x, mesh.origin.x) + std::abs(n.y) * quantum(largest.y, mesh.origin.y) +
                        std::abs(n.z) * quantum(largest.z, mesh.origin.z)) /
                       length;
  for (std::uint32_t h = first; h < end; ++h) {
    const Vec3& p = point(h);
    const double x = p.x - o.x - mean.x, y = p.y - o.y - mean.y, z = p.z - o.z - mean.z;
    if (!(std::abs(x * n.x + y * n.y + z * n.z) / length <= limit)) return false;
  }
  return true;
}

}  // namespace

void index_out_of_range(const Subject& subject, Findings& out) {
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (subject.states[f] == FaceState::invalid_corner) out.at_face(FaceId{f});
  }
}

void empty_mesh(const Subject& subject, Findings& out) {
  if (subject.mesh.face_count() == 0) out.at_file();
}

void degenerate_face(const Subject& subject, Findings& out) {
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (subject.geometry.is_degenerate(FaceId{f})) out.at_face(FaceId{f});
  }
}

void duplicate_face(const Subject& subject, Findings& out) {
  for (const Duplicate& duplicate : subject.duplicates)
    out.at_face(duplicate.copy, duplicate.first);
}

void non_planar_face(const Subject& subject, Findings& out) {
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    const FaceId face{f};
    if (subject.mesh.face_first[f + 1] - subject.mesh.face_first[f] < 4) continue;
    if (!subject.geometry.is_finite(face) || subject.geometry.is_degenerate(face)) continue;
    if (!is_planar_within_quantum(subject, face) && !subject.geometry.is_flat(face)) out.at_face(face);
  }
}

}  // namespace fdcg::bake::checks
