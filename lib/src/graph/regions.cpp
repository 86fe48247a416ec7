// SPDX-License-Identifier: Apache-2.0
#include "graph/regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/vec3.hpp"
#include "exact/plane_fit.hpp"
#include "exact/projection.hpp"
#include "fdcg/format.h"
#include "graph/tips.hpp"

namespace fdcg::bake {
namespace {

// An atom: faces connected by exactly flat edges. All of them are exactly coplanar, so they join a region together or not at
// all.
struct Atoms {
  std::vector<std::uint32_t> of_face;  // kNone where no edge of the face is flat
  std::vector<std::uint32_t> first;    // atom a: faces[first[a]] .. faces[first[a + 1] - 1]
  std::vector<std::uint32_t> faces;

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(first.size() - 1); }
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t atom) const {
    return {faces.data() + first[atom], first[atom + 1] - first[atom]};
  }
};

Atoms find_atoms(const Mesh& mesh, const Topology& topology, const std::vector<EdgeClass>& edges) {
  Atoms atoms;
  atoms.first.push_back(0);
  const auto is_flat = [&](std::uint32_t slot) { return edges[slot].flat() != Flat::no; };
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!is_flat(3 * f) && !is_flat(3 * f + 1) && !is_flat(3 * f + 2)) continue;
    if (atoms.of_face.empty()) atoms.of_face.assign(mesh.face_count(), kNone);
    if (atoms.of_face[f] != kNone) continue;
    const std::uint32_t atom = atoms.count();
    atoms.of_face[f] = atom;
    std::size_t done = atoms.faces.size();
    for (atoms.faces.push_back(f); done < atoms.faces.size(); ++done) {
      const std::uint32_t at = atoms.faces[done];
      for (std::uint32_t slot = 3 * at; slot < 3 * at + 3; ++slot) {
        if (edges[slot].flat() != Flat::exact) continue;
        const std::uint32_t other = +topology.twin[slot] / 3;
        if (atoms.of_face[other] == kNone) {
          atoms.of_face[other] = atom;
          atoms.faces.push_back(other);
        }
      }
    }
    atoms.first.push_back(static_cast<std::uint32_t>(atoms.faces.size()));
  }
  return atoms;
}

// Of a solid, twice its volume for its surface: a plate's thickness, two thirds of a ball's radius. Infinite for a surface that
// is open or inside out.
double thickness(const Mesh& mesh, const Topology& topology) {
  double six_volumes = 0, two_areas = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const Vec3 &a = mesh.points[+mesh.corners[3 * f]], &b = mesh.points[+mesh.corners[3 * f + 1]],
               &c = mesh.points[+mesh.corners[3 * f + 2]];
    six_volumes += dot(a, cross(b, c));
    two_areas += length(cross(b - a, c - a));
  }
  const bool is_open = std::find(topology.twin.begin(), topology.twin.end(), Topology::kBoundary) != topology.twin.end();
  return is_open || !(six_volumes > 0) ? std::numeric_limits<double>::infinity() : 2.0 / 3 * six_volumes / two_areas;
}

// How far corners may be off their faces' planes. The step takes a face for a slab, so much and the rounding of a distance deep
// (contact-model GRAPH-4, FREE-3), and of a solid that is not much thicker its two sides would be one.
double most_deviation(const Mesh& mesh, const Topology& topology, Precision precision) {
  constexpr double kMostShare = 1.0 / 64;  // of the thickness
  constexpr double kRoundings = 24;        // of a distance, in units of the extent's last place
  double extent = 0;
  for (const Vec3& p : mesh.points)
    extent = std::max(extent, largest_component(p));
  return kMostShare * thickness(mesh, topology) - kRoundings * (precision == Precision::f32 ? 0x1p-23 : 0x1p-52) * extent;
}

class Grower {
 public:
  // `is_tip`, of each vertex: faces there stay in their atoms. Empty: there is none.
  Grower(const Mesh& mesh, const Topology& topology, const std::vector<EdgeClass>& edges, const RegionOptions& options,
         const std::vector<bool>& is_tip)
      : mesh_(mesh),
        topology_(topology),
        edges_(edges),
        options_(options),
        is_tip_(is_tip),
        cos_angle_(std::cos(options.coplanar.angle_rad)),
        atoms_(find_atoms(mesh, topology, edges)) {}

  Regions run() {
    if (atoms_.count() == 0) return {};
    if (options_.coplanar.kind == Coplanar::Kind::quantum)
      most_deviation_ = most_deviation(mesh_, topology_, options_.precision);
    measure_atoms();
    std::vector<std::uint32_t> order(atoms_.count());
    for (std::uint32_t i = 0; i < order.size(); ++i)
      order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return area_[a] != area_[b] ? area_[a] > area_[b] : a < b; });
    regions_.of_face.assign(mesh_.face_count(), kNone);
    taken_.assign(atoms_.count(), 0);
    tried_.assign(atoms_.count(), 0);
    for (const std::uint32_t atom : order) {
      if (taken_[atom] == 0) grow(atom);
    }
    if (regions_.list.empty()) regions_.of_face.clear();
    return std::move(regions_);
  }

 private:
  struct Candidate {
    Vec3 normal, point;
  };

  [[nodiscard]] const Vec3& corner(std::uint32_t face, std::uint32_t i) const {
    return mesh_.points[+mesh_.corners[3 * face + i]];
  }
  [[nodiscard]] Vec3 area_vector(std::uint32_t face) const {
    return cross(corner(face, 1) - corner(face, 0), corner(face, 2) - corner(face, 0));
  }

  [[nodiscard]] bool is_at_tip(std::uint32_t atom) const {
    if (is_tip_.empty()) return false;
    const auto faces = atoms_.of(atom);
    return std::any_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
      return is_tip_[+mesh_.corners[3 * face]] || is_tip_[+mesh_.corners[3 * face + 1]] ||
             is_tip_[+mesh_.corners[3 * face + 2]];
    });
  }

  void measure_atoms() {
    area_.resize(atoms_.count());
    largest_face_.resize(atoms_.count());
    for (std::uint32_t atom = 0; atom < atoms_.count(); ++atom) {
      double largest = -1;
      for (const std::uint32_t face : atoms_.of(atom)) {
        const double area = length(area_vector(face));
        area_[atom] += area;
        if (area > largest) {
          largest = area;
          largest_face_[atom] = face;
        }
      }
    }
  }

  [[nodiscard]] bool is_within_quantum(std::uint32_t face, const Candidate& plane) const {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Vec3& p = corner(face, i);
      const double reach = std::max(reach_, kQuantumReach * options_.quantum.at(p));
      if (std::fabs(dot(plane.normal, p - plane.point)) > reach) return false;
    }
    return dot(area_vector(face), plane.normal) > 0;
  }

  [[nodiscard]] bool is_within_angle(std::uint32_t face, const Candidate& plane) const {
    const Vec3 area = area_vector(face);
    return dot(area, plane.normal) >= cos_angle_ * length(area);
  }

  [[nodiscard]] bool fits(std::uint32_t atom, const Candidate& plane) const {
    const bool by_angle = options_.coplanar.kind == Coplanar::Kind::angle;
    const auto faces = atoms_.of(atom);
    return std::all_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
      const Vec3 &a = corner(face, 0), &b = corner(face, 1), &c = corner(face, 2);
      return (is_within_quantum(face, plane) || (by_angle && is_within_angle(face, plane))) && runs_along(plane.normal, a, b) &&
             runs_along(plane.normal, b, c) && runs_along(plane.normal, c, a);
    });
  }

  void add_to(PlaneFit& fit, std::uint32_t atom) const {
    for (const std::uint32_t face : atoms_.of(atom))
      fit.add(corner(face, 0), corner(face, 1), corner(face, 2));
  }

  [[nodiscard]] Candidate fitted(const PlaneFit& fit, const Vec3& normal) const {
    if (options_.coplanar.kind == Coplanar::Kind::angle) return {fit.mean_normal(), fit.centre()};
    const PlaneFit::Fitted plane = fit.fit(normal);
    return {plane.normal, plane.point};
  }

  void take(std::uint32_t atom, PlaneFit& fit) {
    taken_[atom] = 1;
    members_.push_back(atom);
    face_count_ += static_cast<std::uint32_t>(atoms_.of(atom).size());
    add_to(fit, atom);
    for (const std::uint32_t face : atoms_.of(atom)) {
      for (std::uint32_t i = 0; i < 3; ++i)
        reach_ = std::max(reach_, kQuantumReach * options_.quantum.at(corner(face, i)));
    }
  }

  // The plane fitted to all members, if every one of them (and `extra`) is within tolerance of it.
  [[nodiscard]] std::optional<Candidate> refit(const PlaneFit& fit, const Vec3& normal, std::uint32_t extra) const {
    const Candidate plane = fitted(fit, normal);
    if (extra != kNone && !fits(extra, plane)) return std::nullopt;
    const bool suits = std::all_of(members_.begin(), members_.end(), [&](std::uint32_t atom) { return fits(atom, plane); });
    return suits ? std::optional(plane) : std::nullopt;
  }

  void grow(std::uint32_t seed) {
    const std::uint32_t face = largest_face_[seed];
    Candidate plane{unit_normal(corner(face, 0), corner(face, 1), corner(face, 2)), corner(face, 0)};
    PlaneFit fit(plane.point);
    members_.clear();
    face_count_ = 0;
    reach_ = 0;
    take(seed, fit);
    if (options_.coplanar.kind != Coplanar::Kind::exact && !is_at_tip(seed)) {
      // Members are always within tolerance of `plane`. It is fitted again when the region has doubled and when growth stops.
      constexpr int kMostRounds = 64;
      for (int round = 0; round < kMostRounds && spread(fit, plane); ++round) {
        const std::optional<Candidate> better = refit(fit, plane.normal, kNone);
        if (!better) break;
        plane = *better;
      }
    }
    if (face_count_ > 1) finish(plane);
  }

  // Adds neighbours across flat edges that fit the plane, until the region has doubled or none is left. Returns whether any was
  // added.
  bool spread(PlaneFit& fit, Candidate& plane) {
    constexpr std::uint32_t kFewFaces = 32;  // the plane of so small a region is uncertain: it may tilt for each new face
    const std::uint32_t limit = std::max(2 * face_count_, kFewFaces), before = face_count_;
    ++round_;
    for (std::size_t m = 0; m < members_.size() && face_count_ < limit; ++m) {
      for (const std::uint32_t face : atoms_.of(members_[m])) {
        for (std::uint32_t slot = 3 * face; slot < 3 * face + 3; ++slot) {
          if (edges_[slot].flat() == Flat::no) continue;
          const std::uint32_t atom = atoms_.of_face[+topology_.twin[slot] / 3];
          if (taken_[atom] != 0 || tried_[atom] == round_) continue;
          tried_[atom] = round_;
          if (is_at_tip(atom)) continue;
          if (fits(atom, plane)) {
            take(atom, fit);
          } else if (face_count_ + atoms_.of(atom).size() <= kFewFaces) {
            PlaneFit wider = fit;
            add_to(wider, atom);
            if (const std::optional<Candidate> tilted = refit(wider, plane.normal, atom)) {
              plane = *tilted;
              take(atom, fit);
            }
          }
        }
      }
    }
    return face_count_ > before;
  }

  // Whether every triangle of the atom has the orientation of the region's normal: exactly, in the projection that merging
  // uses. Slivers with corners within the quantum but deviating normals are not merged.
  [[nodiscard]] bool faces(std::uint32_t atom, const Vec3& normal) const {
    const Projection view(normal);
    const auto all = atoms_.of(atom);
    return std::all_of(all.begin(), all.end(),
                       [&](std::uint32_t face) { return view.orient(corner(face, 0), corner(face, 1), corner(face, 2)) > 0; });
  }

  void finish(const Candidate& plane) {
    const Vec3 stored_normal = stored_plane(plane.normal, {&plane.point, 1}, options_.precision).normal;
    const bool is_coarse = members_.size() > 1 && largest_deviation(plane) > most_deviation_;
    std::vector<std::uint32_t> left_out;
    std::erase_if(members_, [&](std::uint32_t atom) {
      const bool leaves = members_.size() > 1 && (is_coarse || !faces(atom, stored_normal));
      if (leaves) left_out.push_back(atom);
      return leaves;
    });
    if (!members_.empty()) add_region(plane);
    for (const std::uint32_t atom : left_out) {
      members_.assign(1, atom);
      const std::uint32_t face = largest_face_[atom];
      add_region({unit_normal(corner(face, 0), corner(face, 1), corner(face, 2)), corner(face, 0)});
    }
  }

  [[nodiscard]] double largest_deviation(const Candidate& plane) {
    points_.clear();
    for (const std::uint32_t atom : members_) {
      for (const std::uint32_t face : atoms_.of(atom))
        points_.insert(points_.end(), {corner(face, 0), corner(face, 1), corner(face, 2)});
    }
    const Plane stored = stored_plane(plane.normal, points_, options_.precision);
    double largest = 0;
    for (const Vec3& p : points_)
      largest = std::max(largest, std::fabs(dot(stored.normal, p) + stored.offset));
    return largest;
  }

  void add_region(const Candidate& plane) {
    if (members_.size() == 1 && atoms_.of(members_[0]).size() == 1) return;
    Region region;
    region.is_exact = members_.size() == 1;
    points_.clear();
    const auto id = static_cast<std::uint32_t>(regions_.list.size());
    bool within_quantum = true;
    for (const std::uint32_t atom : members_) {
      for (const std::uint32_t face : atoms_.of(atom)) {
        regions_.of_face[face] = id;
        for (std::uint32_t i = 0; i < 3; ++i)
          points_.push_back(corner(face, i));
        within_quantum = within_quantum && is_within_quantum(face, plane);
      }
    }
    region.tier = region.is_exact ? Flat::exact : within_quantum ? Flat::quantum : Flat::angle;
    region.plane = stored_plane(plane.normal, points_, options_.precision);
    regions_.list.push_back(region);
  }

  const Mesh& mesh_;
  const Topology& topology_;
  const std::vector<EdgeClass>& edges_;
  const RegionOptions& options_;
  const std::vector<bool>& is_tip_;
  double cos_angle_;
  double most_deviation_ = std::numeric_limits<double>::infinity();
  Atoms atoms_;
  std::vector<double> area_;
  std::vector<std::uint32_t> largest_face_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> tried_;  // the last round in which an atom was tried
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> members_;
  std::uint32_t face_count_ = 0;
  double reach_ = 0;  // tolerance to the plane: by the largest quantum of a member, since it may move the whole plane
  std::vector<Vec3> points_;
  Regions regions_;
};

}  // namespace

Regions find_regions(const Mesh& mesh, const Topology& topology, const std::vector<EdgeClass>& edges,
                     const RegionOptions& options) {
  std::vector<bool> is_tip;
  Regions regions = Grower(mesh, topology, edges, options, is_tip).run();
  if (options.coplanar.kind != Coplanar::Kind::quantum || regions.list.empty()) return regions;
  // Without those at tips other faces meet in other planes, and there may be more tips; in the end any busy vertex is one.
  constexpr int kMostRounds = 8;
  is_tip.assign(mesh.points.size(), false);
  for (int round = 0; mark_tips(mesh, topology, regions, round < kMostRounds ? FDCG_BUSY_FAN : 0, is_tip); ++round)
    regions = Grower(mesh, topology, edges, options, is_tip).run();
  return regions;
}

}  // namespace fdcg::bake
