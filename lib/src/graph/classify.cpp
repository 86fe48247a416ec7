// SPDX-License-Identifier: Apache-2.0
#include "graph/classify.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kPointGrain = 1u << 14;

// An edge v0 -> v1 of face a with a's third corner at v0 + left, b's at v0 + right.
struct Wedge {
  Vec3 along, left, right;
};

struct Determinant {
  double value, magnitude;  // magnitude: the sum of the absolute values of its six products
};

// (along x left) . right
Determinant determinant(const Wedge& w) {
  const double xy = w.along.x * w.left.y, yx = w.along.y * w.left.x;
  const double yz = w.along.y * w.left.z, zy = w.along.z * w.left.y;
  const double zx = w.along.z * w.left.x, xz = w.along.x * w.left.z;
  return {(yz - zy) * w.right.x + (zx - xz) * w.right.y + (xy - yx) * w.right.z,
          (std::fabs(yz) + std::fabs(zy)) * std::fabs(w.right.x) + (std::fabs(zx) + std::fabs(xz)) * std::fabs(w.right.y) +
              (std::fabs(xy) + std::fabs(yx)) * std::fabs(w.right.z)};
}

// Shewchuk's bound (7 + 56 u) u on the determinant's relative error, u = 2^-53, rounded up generously; below the second limit a
// product may have underflowed.
constexpr double kDeterminantError = 8e-16;
constexpr double kUnderflow = 1e-280;

int side_of(const Determinant& d, const Vec3& v0, const Vec3& v1, const Vec3& left, const Vec3& right) {
  if (std::fabs(d.value) > kDeterminantError * d.magnitude && d.magnitude > kUnderflow && std::isfinite(d.magnitude))
    return d.value > 0 ? 1 : -1;
  return exact::orient3d(v0, v1, left, right);
}

// For four exactly coplanar corners: whether the triangles lie on different sides of v0 v1.
bool lie_apart(const Vec3& v0, const Vec3& v1, const Vec3& left, const Vec3& right) {
  for (int k = 0; k < 3; ++k) {
    const int l = exact::orient2d(v0, v1, left, k);
    if (l != 0) return exact::orient2d(v1, v0, right, k) == l;
  }
  return false;
}

// Whether the smallest altitude of the tetrahedron is within the sum of the corners' quanta.
bool is_flat_within(double reach, const Wedge& w, double six_volumes) {
  const Vec3 left = w.left - w.along, right = w.right - w.along;
  const double largest_face = std::max({squared_length(cross(w.along, w.left)), squared_length(cross(w.right, w.along)),
                                        squared_length(cross(w.left, w.right)), squared_length(cross(left, right))});
  return six_volumes * six_volumes <= reach * reach * largest_face;
}

class Classifier {
 public:
  Classifier(const Mesh& mesh, const Quantum& quantum, const Coplanar& coplanar, unsigned jobs)
      : mesh_(mesh), quantum_(quantum), coplanar_(coplanar), cos_angle_(std::cos(coplanar.angle_rad)) {
    const std::size_t ranges = (mesh.points.size() + kPointGrain - 1) / kPointGrain;
    std::vector<double> largest(ranges, 0);
    parallel_for(jobs, mesh.points.size(), kPointGrain, [&](std::size_t begin, std::size_t end) {
      double q = 0;
      for (std::size_t v = begin; v < end; ++v)
        q = std::max(q, quantum.at(mesh.points[v]));
      largest[begin / kPointGrain] = q;
    });
    for (double q : largest)
      largest_quantum_ = std::max(largest_quantum_, q);
  }

  [[nodiscard]] EdgeClass operator()(std::uint32_t slot, std::uint32_t twin) const {
    const std::uint32_t a = slot - slot % 3, b = twin - twin % 3;
    const Vec3& v0 = point(slot);
    const Vec3& v1 = point(a + (slot - a + 1) % 3);
    const Vec3& left = point(a + (slot - a + 2) % 3);
    const Vec3& right = point(b + (twin - b + 2) % 3);
    const Wedge wedge{v1 - v0, left - v0, right - v0};
    const Determinant d = determinant(wedge);
    const int side = side_of(d, v0, v1, left, right);
    if (side == 0) return {FDCG_COPLANAR, lie_apart(v0, v1, left, right) ? Flat::exact : Flat::no};
    return {side < 0 ? FDCG_CONVEX : FDCG_CONCAVE, flatness(wedge, d.value, {&v0, &v1, &left, &right})};
  }

 private:
  [[nodiscard]] const Vec3& point(std::uint32_t slot) const { return mesh_.points[+mesh_.corners[slot]]; }

  [[nodiscard]] Flat flatness(const Wedge& w, double six_volumes, std::array<const Vec3*, 4> corners) const {
    if (coplanar_.kind == Coplanar::Kind::exact) return Flat::no;
    // No face of the tetrahedron is larger than its longest edge squared, and that is at most twice this sum.
    const double bound = 2 * (squared_length(w.along) + squared_length(w.left) + squared_length(w.right));
    const bool may_be_quantum = std::fabs(six_volumes) <= kQuantumReach * largest_quantum_ * bound;
    if (!may_be_quantum && coplanar_.kind != Coplanar::Kind::angle) return Flat::no;
    const Vec3 normal_a = cross(w.along, w.left), normal_b = cross(w.right, w.along);
    const double agreement = dot(normal_a, normal_b);
    if (may_be_quantum && agreement > 0) {
      double q = 0;
      for (const Vec3* corner : corners)
        q = std::max(q, quantum_.at(*corner));
      if (is_flat_within(kQuantumReach * q, w, six_volumes)) return Flat::quantum;
    }
    if (coplanar_.kind == Coplanar::Kind::angle && agreement >= cos_angle_ * length(normal_a) * length(normal_b))
      return Flat::angle;
    return Flat::no;
  }

  const Mesh& mesh_;
  const Quantum& quantum_;
  const Coplanar& coplanar_;
  double cos_angle_;
  double largest_quantum_ = 0;
};

}  // namespace

std::vector<EdgeClass> classify_edges(const Mesh& mesh, const Topology& topology, const Quantum& quantum,
                                      const Coplanar& coplanar, unsigned jobs) {
  std::vector<EdgeClass> classes(mesh.corners.size());
  const Classifier classify(mesh, quantum, coplanar, jobs);
  parallel_for(jobs, mesh.corners.size(), 3 * kPointGrain, [&](std::size_t begin, std::size_t end) {
    for (auto slot = static_cast<std::uint32_t>(begin); slot < end; ++slot) {
      const HalfedgeId twin = topology.twin[slot];
      if (twin == Topology::kBoundary) {
        classes[slot] = {FDCG_BOUNDARY, Flat::no};
      } else if (slot < +twin) {
        classes[slot] = classes[+twin] = classify(slot, +twin);
      }
    }
  });
  return classes;
}

}  // namespace fdcg::bake
