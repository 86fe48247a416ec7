// SPDX-License-Identifier: Apache-2.0
// The only source file that includes OpenMesh.
#include "repair/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "repair/surface_cover.hpp"
#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
// last: depends on names of the headers above
#include <OpenMesh/Core/Geometry/QuadricT.hh>

namespace fdcg::bake {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using VertexHandle = HalfedgeMesh::VertexHandle;
using FaceHandle = HalfedgeMesh::FaceHandle;
using HalfedgeHandle = HalfedgeMesh::HalfedgeHandle;

class Judge;

// OpenMesh's Decimater selects by priority and then collapses. Proving the error bound is too expensive for every priority, so
// this mesh proves it when a collapse is executed and does nothing if the proof fails; the Decimater then continues with the
// next one.
class BoundedMesh : public HalfedgeMesh {
 public:
  void collapse(HalfedgeHandle h);
  Judge* judge = nullptr;
  std::function<bool(HalfedgeHandle)> is_legal;
};

class Judge {
 public:
  Judge(BoundedMesh& halfedges, const Mesh& mesh, double error, double largest, const std::vector<bool>& is_locked,
        const Progress& progress)
      : halfedges_(halfedges),
        mesh_(mesh),
        cover_(error, largest),
        is_locked_(is_locked),
        progress_(progress),
        quadrics_(mesh.points.size()),
        version_(mesh.points.size(), 1),
        refused_in_(halfedges.n_halfedges(), 0) {
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      originals_.push_back({{point(f, 0), point(f, 1), point(f, 2)}, {vertex(f, 0), vertex(f, 1), vertex(f, 2)}});
      normals_.push_back(unit_normal(originals_[f].point));
      stands_for_.push_back({f});
      proof_.push_back({f});
      const auto& p = originals_[f].point;
      const double area = length(cross(p[1] - p[0], p[2] - p[0]));
      const Vec3& n = normals_[f];
      OpenMesh::Geometry::Quadricd quadric(n.x, n.y, n.z, -dot(n, p[0]));
      quadric *= area;
      for (const std::uint32_t v : originals_[f].name)
        quadrics_[v] += quadric;
    }
  }

  // Lower is earlier; negative: not allowed.
  [[nodiscard]] double priority(HalfedgeHandle h) {
    const VertexHandle v0 = halfedges_.from_vertex_handle(h);
    const auto from = static_cast<std::size_t>(v0.idx());
    if (is_locked_[from] || refused_in_[static_cast<std::size_t>(h.idx())] == version_[from] || !find_new_faces(h)) return -1;
    const OpenMesh::Vec3d to = halfedges_.point(halfedges_.to_vertex_handle(h));
    // In flat neighbourhoods the shortest edges come first, so that triangles keep a good shape.
    constexpr double kTieBreak = 1e-9;
    const double l2 = (to - halfedges_.point(v0)).sqrnorm();
    return std::max(0.0, quadrics_[from](to)) + kTieBreak * l2 * l2;
  }

  // Collapses an edge at the start vertex of h: h itself or, where its bound cannot be proved, the next by priority. `is_legal`
  // tests the topology, `collapse_edge` executes it.
  template <class IsLegal, class Collapse>
  void collapse(HalfedgeHandle h, IsLegal is_legal, Collapse collapse_edge) {
    const VertexHandle v0 = halfedges_.from_vertex_handle(h);
    std::vector<std::pair<double, HalfedgeHandle>> edges;
    for (const HalfedgeHandle edge : halfedges_.voh_range(v0)) {
      const double order = priority(edge);
      if (order >= 0 && is_legal(edge)) edges.emplace_back(order, edge);
    }
    std::sort(edges.begin(), edges.end());
    for (const auto& [order, edge] : edges) {
      if (!find_new_faces(edge) || !prove(mesh_.points[static_cast<std::size_t>(v0.idx())])) {
        refused_in_[static_cast<std::size_t>(edge.idx())] = version_[static_cast<std::size_t>(v0.idx())];
        continue;
      }
      const VertexHandle v1 = halfedges_.to_vertex_handle(edge);
      quadrics_[static_cast<std::size_t>(v1.idx())] += quadrics_[static_cast<std::size_t>(v0.idx())];
      for (const VertexHandle v : halfedges_.vv_range(v0))
        ++version_[static_cast<std::size_t>(v.idx())];
      collapse_edge(edge);
      commit();
      tell();
      return;
    }
  }

 private:
  [[nodiscard]] std::uint32_t vertex(std::uint32_t f, std::uint32_t k) const { return +mesh_.corners[3 * f + k]; }
  [[nodiscard]] const Vec3& point(std::uint32_t f, std::uint32_t k) const { return mesh_.points[vertex(f, k)]; }
  static Vec3 unit_normal(const std::array<Vec3, 3>& p) {
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    const double l = length(n);
    return l > 0 ? (1 / l) * n : Vec3{};
  }

  [[nodiscard]] NamedTriangle triangle(FaceHandle f) const {
    NamedTriangle t;
    std::size_t k = 0;
    for (const VertexHandle v : halfedges_.fv_range(f)) {
      t.name[k] = static_cast<std::uint32_t>(v.idx());
      t.point[k++] = mesh_.points[static_cast<std::size_t>(v.idx())];
    }
    return t;
  }

  // Computes the faces around the start of h after the collapse; false where one would turn too far or lose its area.
  bool find_new_faces(HalfedgeHandle h) {
    static const double kLeastCosine = std::cos(kMostTurnDegrees / 180 * std::numbers::pi);
    const VertexHandle v0 = halfedges_.from_vertex_handle(h), v1 = halfedges_.to_vertex_handle(h);
    const auto from = static_cast<std::uint32_t>(v0.idx()), to = static_cast<std::uint32_t>(v1.idx());
    old_faces_.clear();
    new_faces_.clear();
    changed_.clear();
    for (const FaceHandle f : halfedges_.vf_range(v0)) {
      const auto number = static_cast<std::uint32_t>(f.idx());
      old_faces_.push_back(number);
      NamedTriangle t = triangle(f);
      if (std::find(t.name.begin(), t.name.end(), to) != t.name.end()) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (t.name[k] != from) continue;
        t.name[k] = to;
        t.point[k] = mesh_.points[to];
      }
      const Vec3 n = cross(t.point[1] - t.point[0], t.point[2] - t.point[0]);
      if (!(dot(n, normals_[number]) > kLeastCosine * length(n))) return false;
      if (exact::collinear(t.point[0], t.point[1], t.point[2])) return false;
      new_faces_.push_back(t);
      changed_.push_back(number);
    }
    return true;
  }

  // Proves both directions: the new faces are near the originals that they replace, and these near the new faces and their
  // neighbours.
  bool prove(const Vec3& removed) {
    // The removed vertex is a point of the original surface; this test alone rejects most failures.
    if (std::none_of(new_faces_.begin(), new_faces_.end(),
                     [&](const NamedTriangle& t) { return cover_.is_near(removed, t.point); }))
      return false;
    std::vector<std::uint32_t> used;
    concerned_.clear();
    for (const std::uint32_t f : old_faces_)
      concerned_.insert(concerned_.end(), stands_for_[f].begin(), stands_for_[f].end());
    std::sort(concerned_.begin(), concerned_.end());
    concerned_.erase(std::unique(concerned_.begin(), concerned_.end()), concerned_.end());
    given_.clear();
    for (const std::uint32_t t : concerned_)
      given_.push_back(originals_[t]);
    for (const NamedTriangle& t : new_faces_) {
      if (!cover_.covers(t.point, given_, used)) return false;
    }
    find_surroundings();
    fresh_proofs_.resize(concerned_.size());
    for (std::size_t i = 0; i < concerned_.size(); ++i) {
      if (!cover_.covers(given_[i].point, surroundings_, used)) return false;
      fresh_proofs_[i].clear();
      for (const std::uint32_t c : used)
        fresh_proofs_[i].push_back(surrounding_faces_[c]);
    }
    return true;
  }

  // The new faces, and the faces that share a vertex with them.
  void find_surroundings() {
    surroundings_ = new_faces_;
    surrounding_faces_ = changed_;
    around_.clear();
    for (const std::uint32_t f : old_faces_) {
      for (const VertexHandle v : halfedges_.fv_range(FaceHandle(static_cast<int>(f)))) {
        for (const FaceHandle g : halfedges_.vf_range(v))
          around_.push_back(static_cast<std::uint32_t>(g.idx()));
      }
    }
    std::sort(around_.begin(), around_.end());
    around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    for (const std::uint32_t f : around_) {
      if (std::find(old_faces_.begin(), old_faces_.end(), f) != old_faces_.end()) continue;
      surroundings_.push_back(triangle(FaceHandle(static_cast<int>(f))));
      surrounding_faces_.push_back(f);
    }
  }

  void tell() {
    constexpr std::uint64_t kInterval = 256;  // collapses between two calls of progress
    if (progress_ && ++collapses_ % kInterval == 0)
      progress_("simplify", static_cast<double>(collapses_) / static_cast<double>(mesh_.points.size()));
  }

  void commit() {
    for (const std::uint32_t f : old_faces_)
      stands_for_[f].clear();  // all of these are reassigned
    for (std::size_t i = 0; i < concerned_.size(); ++i) {
      const std::uint32_t t = concerned_[i];
      for (const std::uint32_t f : proof_[t])
        std::erase(stands_for_[f], t);
      proof_[t] = fresh_proofs_[i];
      for (const std::uint32_t f : proof_[t])
        stands_for_[f].push_back(t);
    }
  }

  BoundedMesh& halfedges_;
  const Mesh& mesh_;
  SurfaceCover cover_;
  const std::vector<bool>& is_locked_;
  const Progress& progress_;
  std::uint64_t collapses_ = 0;
  std::vector<OpenMesh::Geometry::Quadricd> quadrics_;
  // A change counter of the faces around each vertex, from 1; and its value when the collapse of a half-edge was last refused.
  std::vector<std::uint32_t> version_, refused_in_;
  std::vector<NamedTriangle> originals_;
  std::vector<Vec3> normals_;                           // of the faces as they were given
  std::vector<std::vector<std::uint32_t>> stands_for_;  // of each face: the original faces whose proof uses it
  std::vector<std::vector<std::uint32_t>> proof_;       // of each original face: the faces used in its proof
  // For the current collapse.
  std::vector<std::uint32_t> old_faces_, changed_, concerned_, around_, surrounding_faces_;
  std::vector<NamedTriangle> new_faces_, given_, surroundings_;  // new_faces_: those of changed_
  std::vector<std::vector<std::uint32_t>> fresh_proofs_;
};

void BoundedMesh::collapse(HalfedgeHandle h) {
  judge->collapse(h, is_legal, [this](HalfedgeHandle edge) { HalfedgeMesh::collapse(edge); });
}

// Makes the protected topology test accessible.
class Decimater : public OpenMesh::Decimater::DecimaterT<BoundedMesh> {
 public:
  explicit Decimater(BoundedMesh& mesh) : BaseDecimaterT(mesh), DecimaterT(mesh) {}  // the base is virtual
  using DecimaterT::is_collapse_legal;
};

class PriorityModule : public OpenMesh::Decimater::ModBaseT<BoundedMesh> {
 public:
  using Base = OpenMesh::Decimater::ModBaseT<BoundedMesh>;
  using CollapseInfo = OpenMesh::Decimater::CollapseInfoT<BoundedMesh>;
  using Handle = OpenMesh::Decimater::ModHandleT<PriorityModule>;

  explicit PriorityModule(BoundedMesh& mesh) : Base(mesh, false) {}
  const std::string& name() const override {
    static const std::string kName = "Bounded";
    return kName;
  }
  float collapse_priority(const CollapseInfo& info) override {
    return static_cast<float>(Base::mesh().judge->priority(info.v0v1));
  }
};

std::string place(const Mesh& mesh, FaceId f) {
  return "face " + std::to_string(mesh.source_of(f));
}

}  // namespace

std::string simplify_obstacle(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states) {
  const FaceGeometry geometry(mesh, states);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t corners = mesh.face_first[f + 1] - mesh.face_first[f];
    if (corners != 3) return place(mesh, FaceId{f}) + " has " + std::to_string(corners) + " corners and not three";
    if (states[f] != FaceState::sound || !geometry.is_finite(FaceId{f}) || geometry.is_degenerate(FaceId{f}))
      return place(mesh, FaceId{f}) + " has no area, a missing vertex or a coordinate that is no number";
  }
  for (std::uint32_t h = 0; h < topology.twin.size(); ++h) {
    const bool is_crowded = topology.twin[h] == Topology::kNonManifold;
    if (!is_crowded && topology.twin[h] != Topology::kSameWay) continue;
    return place(mesh, topology.face(HalfedgeId{h})) +
           (is_crowded ? " has an edge of more than two faces" : " is wound against a neighbour");
  }
  const std::vector<VertexId> several = vertices_of_several_fans(mesh, topology, states);
  if (!several.empty()) return "vertex " + std::to_string(mesh.source_point[+several[0]]) + " joins more than one fan of faces";
  return {};
}

std::optional<Simplified> simplify(const Mesh& mesh, double error, const std::vector<bool>& is_locked,
                                   const Progress& progress) {
  double largest = 0;
  for (const Vec3& p : mesh.points)
    largest = std::max(largest, largest_component(p));
  BoundedMesh halfedges;
  for (const Vec3& p : mesh.points)
    halfedges.add_vertex({p.x, p.y, p.z});
  Simplified result;
  const auto handle = [&](std::uint32_t c) { return VertexHandle(static_cast<int>(+mesh.corners[c])); };
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!halfedges.add_face(handle(3 * f), handle(3 * f + 1), handle(3 * f + 2)).is_valid()) return std::nullopt;
  }
  Judge judge(halfedges, mesh, error, largest, is_locked, progress);
  halfedges.judge = &judge;
  {
    Decimater decimater(halfedges);
    halfedges.is_legal = [&](HalfedgeHandle h) {
      return decimater.is_collapse_legal(PriorityModule::CollapseInfo(halfedges, h));
    };
    PriorityModule::Handle module;
    decimater.add(module);
    decimater.initialize();
    decimater.decimate(std::numeric_limits<std::uint32_t>::max());  // it counts refusals too

    result.corners.resize(mesh.corners.size(), Simplified::kGone);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      const FaceHandle face(static_cast<int>(f));
      if (halfedges.status(face).deleted()) {
        ++result.gone;
        continue;
      }
      std::uint32_t c = 3 * f;
      for (const VertexHandle v : halfedges.fv_range(face))
        result.corners[c++] = static_cast<std::uint32_t>(v.idx());
    }
  }
  return result;
}

}  // namespace fdcg::bake
