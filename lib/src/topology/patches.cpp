// SPDX-License-Identifier: Apache-2.0
#include "topology/patches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "exact/volume.hpp"

namespace fdcg::bake {
namespace {

// Disjoint sets of faces. The smallest member stands for its set, so that the outcome does not depend on the order of joins.
class FaceSets {
 public:
  explicit FaceSets(std::uint32_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t f) {
    while (parent_[f] != f)
      f = parent_[f] = parent_[parent_[f]];
    return f;
  }
  void join(std::uint32_t f, std::uint32_t g) {
    f = find(f);
    g = find(g);
    if (f < g) parent_[g] = f;
    if (g < f) parent_[f] = g;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// Disjoint sets that also store whether a face must be flipped relative to its set's root.
class TurnedSets {
 public:
  explicit TurnedSets(std::uint32_t count) : parent_(count), turned_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t find(std::uint32_t f) {
    std::uint32_t root = f, turned = 0;
    for (; parent_[root] != root; root = parent_[root])
      turned ^= turned_[root];
    while (parent_[f] != root && f != root) {  // every face on the way now hangs on the root
      const std::uint32_t up = parent_[f], here = turned_[f];
      parent_[f] = root;
      turned_[f] = static_cast<std::uint8_t>(turned);
      turned ^= here;
      f = up;
    }
    return root;
  }
  // After find(f).
  [[nodiscard]] std::uint32_t is_turned(std::uint32_t f) const { return turned_[f]; }
  // False if they were joined before and that contradicts `turned`.
  bool join(std::uint32_t f, std::uint32_t g, std::uint32_t turned) {
    const std::uint32_t a = find(f), b = find(g);
    const std::uint32_t between = turned_[f] ^ turned_[g] ^ turned;
    if (a == b) return between == 0;
    const std::uint32_t root = a < b ? a : b, child = a < b ? b : a;
    parent_[child] = root;
    turned_[child] = static_cast<std::uint8_t>(between);
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> turned_;
};

FaceSets join_across_edges(const Mesh& mesh, const Topology& topology, const std::vector<OddEdge>& odd) {
  FaceSets sets(mesh.face_count());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      const HalfedgeId twin = topology.twin[h];
      if (is_halfedge(twin) && +twin < h) sets.join(f, +topology.face(twin));
    }
  }
  for (const OddEdge& edge : odd) {
    if (edge.halfedges.size() == 2) sets.join(+topology.face(edge.halfedges[0]), +topology.face(edge.halfedges[1]));
  }
  return sets;
}

void number_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
                    const FaceGeometry& geometry, FaceSets& sets, Patches& out) {
  out.of_face.assign(mesh.face_count(), kNone);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (states[f] != FaceState::sound) continue;
    const std::uint32_t root = sets.find(f);  // root <= f: it has its number already
    if (root == f) {
      out.of_face[f] = static_cast<std::uint32_t>(out.patches.size());
      out.patches.emplace_back().first_face = FaceId{f};
    }
    Patch& patch = out.patches[out.of_face[f] = out.of_face[root]];
    ++patch.faces;
    patch.is_finite = patch.is_finite && geometry.is_finite(FaceId{f});
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      const HalfedgeId twin = topology.twin[h];
      if (twin == Topology::kBoundary || twin == Topology::kNonManifold) patch.is_closed = false;
      if (twin == Topology::kSameWay) patch.is_consistent = false;
    }
  }
}

// One patch of all faces is one component; else patches and other faces that meet at a vertex are joined.
std::uint64_t count_components(const Mesh& mesh, const Patches& found, FaceSets& sets) {
  if (found.patches.size() == 1 && found.patches[0].faces == mesh.face_count()) return 1;
  std::vector<std::uint32_t> face_at(mesh.points.size(), kNone);  // one face at each vertex
  std::uint64_t components = 0;
  std::vector<std::uint32_t> rooted;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    bool has_vertex = false;
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      const VertexId v = mesh.corners[h];
      if (v == VertexId{kNone}) continue;
      has_vertex = true;
      if (face_at[+v] == kNone) face_at[+v] = f;
      sets.join(face_at[+v], f);
    }
    if (has_vertex && sets.find(f) == f) rooted.push_back(f);
  }
  for (const std::uint32_t f : rooted)
    components += sets.find(f) == f;
  return components;
}

// Finds the faces wound opposite to the first face of their patch, and the patches that cannot be made consistent.
void find_turned(const Mesh& mesh, const Topology& topology, const std::vector<OddEdge>& odd, Patches& out) {
  TurnedSets sets(mesh.face_count());
  const auto join = [&](HalfedgeId h, HalfedgeId other, std::uint32_t turned) {
    const std::uint32_t f = +topology.face(h);
    if (sets.join(f, +topology.face(other), turned)) return;
    Patch& patch = out.patches[out.of_face[f]];
    if (patch.is_orientable) patch.conflict = h;
    patch.is_orientable = false;
  };
  for (std::uint32_t h = 0; h < topology.twin.size(); ++h) {
    if (is_halfedge(topology.twin[h]) && +topology.twin[h] < h) join(HalfedgeId{h}, topology.twin[h], 0);
  }
  for (const OddEdge& edge : odd) {
    if (edge.halfedges.size() == 2) join(edge.halfedges[0], edge.halfedges[1], 1);
  }
  out.is_turned.assign(mesh.face_count(), 0);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (out.of_face[f] == kNone || !out.patches[out.of_face[f]].is_orientable) continue;
    sets.find(f);
    out.is_turned[f] = static_cast<std::uint8_t>(sets.is_turned(f));  // the root is the patch's first face
  }
}

// Calls visit(a, b, c) for the triangles of the fan from the face's first corner.
template <class Visit>
void for_each_triangle(const Mesh& mesh, std::uint32_t f, Visit visit) {
  const auto point = [&](std::uint32_t h) -> const Vec3& { return mesh.points[+mesh.corners[h]]; };
  for (std::uint32_t h = mesh.face_first[f] + 1; h + 1 < mesh.face_first[f + 1]; ++h) {
    visit(point(mesh.face_first[f]), point(h), point(h + 1));
  }
}

// Six times the volume over the origin in floating point, with the sum of the magnitudes, which bounds the rounding error.
struct Volume {
  double value = 0, magnitude = 0, terms = 0;

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double yz = b.y * c.z, zy = b.z * c.y, zx = b.z * c.x, xz = b.x * c.z, xy = b.x * c.y, yx = b.y * c.x;
    value += a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx);
    magnitude += std::abs(a.x) * (std::abs(yz) + std::abs(zy)) + std::abs(a.y) * (std::abs(zx) + std::abs(xz)) +
                 std::abs(a.z) * (std::abs(xy) + std::abs(yx));
    ++terms;
  }
  [[nodiscard]] bool is_certain() const {
    // At most 6 roundings of u = 2^-53 in a term and one an addition; 16 covers the bound's own; 1e-280: no underflow matters.
    return std::abs(value) > (terms + 16) * 0x1p-53 * magnitude && magnitude > 1e-280 &&
           magnitude < std::numeric_limits<double>::max();
  }
};

void find_volumes(const Mesh& mesh, Patches& out) {
  std::vector<Volume> volumes(out.patches.size());
  const auto is_asked = [&](std::uint32_t f) {
    if (out.of_face[f] == kNone) return false;
    const Patch& patch = out.patches[out.of_face[f]];
    return patch.is_closed && patch.is_consistent && patch.is_finite;
  };
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!is_asked(f)) continue;
    Volume& volume = volumes[out.of_face[f]];
    for_each_triangle(mesh, f, [&](const Vec3& a, const Vec3& b, const Vec3& c) { volume.add(a, b, c); });
  }
  // Faces of the patches that the filter leaves undecided, grouped by patch, so that one exact sum at a time is enough.
  std::vector<std::uint64_t> open;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!is_asked(f)) continue;
    const Volume& volume = volumes[out.of_face[f]];
    if (volume.is_certain()) {
      out.patches[out.of_face[f]].volume_sign = volume.value > 0 ? 1 : -1;
    } else {
      open.push_back(std::uint64_t{out.of_face[f]} << 32 | f);
    }
  }
  std::sort(open.begin(), open.end());
  for (std::size_t i = 0; i < open.size();) {
    const auto patch = static_cast<std::uint32_t>(open[i] >> 32);
    ExactSum sum;
    for (; i < open.size() && open[i] >> 32 == patch; ++i) {
      for_each_triangle(mesh, static_cast<std::uint32_t>(open[i]),
                        [&](const Vec3& a, const Vec3& b, const Vec3& c) { sum.add_determinant(a, b, c); });
    }
    out.patches[patch].volume_sign = sum.sign();
  }
}

}  // namespace

Patches find_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
                     const std::vector<OddEdge>& odd, const FaceGeometry& geometry) {
  Patches out;
  FaceSets sets = join_across_edges(mesh, topology, odd);
  number_patches(mesh, topology, states, geometry, sets, out);
  out.components = count_components(mesh, out, sets);
  for (const OddEdge& edge : odd) {
    if (topology.twin[+edge.halfedges[0]] != Topology::kSameWay) continue;
    find_turned(mesh, topology, odd, out);
    break;
  }
  find_volumes(mesh, out);
  return out;
}

std::vector<std::uint32_t> inside_out_patches(const Mesh& mesh, const Patches& patches) {
  std::vector<std::uint32_t> negative;
  std::size_t enclosing = 0;
  for (std::uint32_t p = 0; p < patches.patches.size(); ++p) {
    if (!patches.patches[p].encloses()) continue;
    ++enclosing;
    if (patches.patches[p].volume_sign < 0) negative.push_back(p);
  }
  if (negative.empty() || enclosing == 1) return negative;  // no other enclosing patch: depth 0
  const std::vector<std::uint32_t> depths = nesting_depths(mesh, patches, negative);
  std::vector<std::uint32_t> inside_out;
  for (std::size_t i = 0; i < negative.size(); ++i) {
    if (depths[i] % 2 == 0) inside_out.push_back(negative[i]);
  }
  return inside_out;
}

}  // namespace fdcg::bake
