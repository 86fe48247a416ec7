// SPDX-License-Identifier: Apache-2.0
// Facets of one plane that touch or overlap there form a sheet, which is triangulated as a whole, with the sides of each and
// their common segments with facets of other planes. Points are compared exactly at the end: the same place may have been made
// in several ways.
#include "solid/arrangement.hpp"

#include <algorithm>
#include <deque>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "base/vec3.hpp"
#include "solid/meeting_points.hpp"
#include "solid/plane_triangulation.hpp"
#include "topology/face_geometry.hpp"
#include "validate/self_intersection.hpp"

namespace fdcg::bake {
namespace {

struct MeetingSegment {
  PointId a, b;
  std::uint32_t other;  // the facet whose plane it lies in
};

// What is to be inserted into the plane of one facet.
struct Insertions {
  std::vector<PointId> points;
  std::vector<MeetingSegment> segments;
};

using Sheet = std::vector<std::uint32_t>;  // facets

class Arranger {
 public:
  Arranger(const FacetSet& set, Arrangement& result) : set_(set), result_(result), leader_(set.facets.size()) {
    result_.points = std::make_unique<ExactPoints>(set.points);
    triangles_.reserve(set.facets.size());
    for (const Facet& facet : set.facets)
      triangles_.push_back(facet.corner);
    std::iota(leader_.begin(), leader_.end(), 0U);
  }

  void run(const std::vector<MeetingFaces>& pairs, const Progress& progress) {
    MeetingPoints meeting(*result_.points, triangles_);
    for (const MeetingFaces& pair : pairs)
      take(meeting, +pair.a, +pair.b);
    std::vector<Sheet> sheets = all_sheets();
    for (std::size_t i = 0; i < sheets.size() && result_.outcome == Arrangement::Outcome::done; ++i) {
      cut(meeting, sheets[i]);
      if (progress && i % 1024 == 0) progress("arrangement", static_cast<double>(i) / static_cast<double>(sheets.size()));
    }
    unite_points();
  }

 private:
  void take(MeetingPoints& meeting, std::uint32_t a, std::uint32_t b) {
    const TriangleMeeting found = meet(set_.points, triangles_[a], triangles_[b]);
    Insertions &in_a = inserted_[a], &in_b = inserted_[b];
    if (found.is_coplanar) {
      leader_[leader_of(a)] = leader_of(b);
    } else if (found.count == 1) {
      const PointId p = meeting.at(a, b, found.end[0]);
      in_a.points.push_back(p);
      in_b.points.push_back(p);
    } else if (found.count == 2) {
      const PointId p = meeting.at(a, b, found.end[0]), q = meeting.at(a, b, found.end[1]);
      in_a.segments.push_back({p, q, b});
      in_b.segments.push_back({p, q, a});
    }
  }

  std::uint32_t leader_of(std::uint32_t t) {
    while (leader_[t] != t)
      t = leader_[t] = leader_[leader_[t]];
    return t;
  }

  // Ascending by their first facets; those that nothing meets are sheets of their own.
  std::vector<Sheet> all_sheets() {
    std::vector<Sheet> sheets;
    std::vector<std::uint32_t> number(triangles_.size(), SupportLine::kNoTriangle);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      std::uint32_t& sheet = number[leader_of(t)];
      if (sheet == SupportLine::kNoTriangle) {
        sheet = static_cast<std::uint32_t>(sheets.size());
        sheets.emplace_back();
      }
      sheets[sheet].push_back(t);
    }
    return sheets;
  }

  void cut(MeetingPoints& meeting, const Sheet& sheet) {
    if (sheet.size() == 1 && !inserted_.contains(sheet[0])) {
      result_.facets.push_back(set_.facets[sheet[0]]);
      result_.is_piece.push_back(0);
      return;
    }
    const bool is_cut = sheet.size() == 1 ? cut_facet(meeting, sheet[0]) : cut_sheet(meeting, sheet);
    if (!is_cut) result_.outcome = Arrangement::Outcome::fault;
    result_.cut += sheet.size();
    touched_.insert(touched_.end(), sheet.begin(), sheet.end());
  }

  bool cut_facet(MeetingPoints& meeting, std::uint32_t t) {
    PlaneTriangulation plane(meeting, t, axis_of(set_.points, triangles_[t]));
    plane.start(triangles_[t]);
    if (!insert_into(plane, {t})) return false;
    plane.improve();
    for (const PlaneTriangulation::Face& face : plane.faces())
      keep(plane, face, set_.facets[t].weight, t);
    return true;
  }

  bool insert_into(PlaneTriangulation& plane, const Sheet& sheet) {
    std::unordered_map<PointId, PlaneTriangulation::Local> local;
    const auto at = [&](PointId p) {
      const auto [place, is_new] = local.try_emplace(p, 0);
      if (is_new) place->second = plane.insert(p);
      return place->second;
    };
    for (const std::uint32_t t : sheet) {
      if (sheet.size() > 1) {
        for (const PointId corner : triangles_[t])
          at(corner);
      }
      const Insertions& inserted = inserted_[t];
      for (const PointId p : inserted.points)
        at(p);
      for (const MeetingSegment& segment : inserted.segments) {
        at(segment.a);
        at(segment.b);
      }
    }
    for (const std::uint32_t t : sheet) {
      for (std::size_t i = 0; i < 3 && sheet.size() > 1; ++i) {
        const PointId a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
        if (!plane.insert_segment(at(a), at(b), {{a, b}}, set_.facets[t].weight)) return false;
      }
    }
    for (const std::uint32_t t : sheet) {
      for (const MeetingSegment& segment : inserted_[t].segments) {
        if (!plane.insert_segment(at(segment.a), at(segment.b), {{}, segment.other}, 0)) return false;
      }
    }
    return true;
  }

  bool cut_sheet(MeetingPoints& meeting, const Sheet& sheet) {
    const int axis = axis_of(set_.points, triangles_[sheet[0]]);
    PlaneTriangulation plane(meeting, sheet[0], axis);
    plane.start(frame_around(sheet, axis));
    if (!insert_into(plane, sheet)) return false;
    plane.improve();
    const std::vector<std::int32_t> weights = weights_of(plane);
    for (std::uint32_t f = 0; f < weights.size(); ++f) {
      if (weights[f] != 0) keep(plane, plane.faces()[f], weights[f], source_at(plane, plane.faces()[f], sheet, axis));
    }
    return true;
  }

  // Three new points, as seen around all facets of the sheet, in the direction in which the first one runs.
  std::array<PointId, 3> frame_around(const Sheet& sheet, int axis) {
    Vec3 low = set_.points[triangles_[sheet[0]][0]], high = low;
    for (const std::uint32_t t : sheet) {
      for (const PointId corner : triangles_[t]) {
        const Vec3& p = set_.points[corner];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    const Vec3 middle = 0.5 * (low + high);
    const double reach = 8 * largest_component(high - low);
    const auto point = [&](double u, double v) {
      const double ways[3] = {0, u * reach, v * reach};
      return result_.points->add(middle + Vec3{ways[(3 - axis) % 3], ways[(4 - axis) % 3], ways[(5 - axis) % 3]});
    };
    const PointId a = point(-1, -1), b = point(2, -1), c = point(-1, 2);
    const Triangle3& t = triangles_[sheet[0]];
    const bool is_alike = result_.points->orient2d(t[0], t[1], t[2], axis) == result_.points->orient2d(a, b, c, axis);
    return is_alike ? std::array{a, b, c} : std::array{a, c, b};
  }

  // The winding number of each face in the sheet's sides, from the rim inwards, where it is 0.
  static std::vector<std::int32_t> weights_of(const PlaneTriangulation& plane) {
    const auto& faces = plane.faces();
    std::vector<std::int32_t> weights(faces.size(), 0);
    std::vector<bool> is_seen(faces.size(), false);
    std::deque<std::uint32_t> open;
    for (std::uint32_t f = 0; f < faces.size() && open.empty(); ++f) {
      const auto& across = faces[f].across;
      if (std::find(across.begin(), across.end(), PlaneTriangulation::kNothing) == across.end()) continue;
      open.push_back(f);
      is_seen[f] = true;
    }
    while (!open.empty()) {
      const std::uint32_t f = open.front();
      open.pop_front();
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t g = faces[f].across[i];
        if (g == PlaneTriangulation::kNothing || is_seen[g]) continue;
        is_seen[g] = true;
        weights[g] = weights[f] - faces[f].along[i];
        open.push_back(g);
      }
    }
    return weights;
  }

  // A facet of the sheet on which a face lies, for its source; any of them where rounding hides it.
  [[nodiscard]] std::uint32_t source_at(const PlaneTriangulation& plane, const PlaneTriangulation::Face& face,
                                        const Sheet& sheet, int axis) const {
    Vec3 p;
    for (const auto corner : face.corner)
      p = p + 1.0 / 3 * result_.points->near(plane.point(corner));
    const auto left_of = [&](const Vec3& a, const Vec3& b) { return component(cross(b - a, p - a), axis) > 0; };
    for (const std::uint32_t t : sheet) {
      const Vec3 &a = set_.points[triangles_[t][0]], &b = set_.points[triangles_[t][1]], &c = set_.points[triangles_[t][2]];
      if (left_of(a, b) == left_of(b, c) && left_of(b, c) == left_of(c, a)) return t;
    }
    return sheet[0];
  }

  void keep(const PlaneTriangulation& plane, const PlaneTriangulation::Face& face, std::int32_t weight, std::uint32_t t) {
    Facet facet{
        {plane.point(face.corner[0]), plane.point(face.corner[1]), plane.point(face.corner[2])}, weight, set_.facets[t].source};
    if (weight < 0) {
      std::swap(facet.corner[1], facet.corner[2]);
      facet.weight = -weight;
    }
    result_.facets.push_back(facet);
    result_.is_piece.push_back(1);
  }

  // Of points at one place the first stands for all.
  void unite_points() {
    const ExactPoints& points = *result_.points;
    std::vector<PointId> made, number(points.count());
    std::iota(number.begin(), number.end(), 0U);
    for (const std::uint32_t t : touched_)
      made.insert(made.end(), triangles_[t].begin(), triangles_[t].end());
    for (const Facet& facet : result_.facets) {
      for (const PointId corner : facet.corner) {
        if (corner >= set_.points.size()) made.push_back(corner);
      }
    }
    std::sort(made.begin(), made.end());
    made.erase(std::unique(made.begin(), made.end()), made.end());
    std::stable_sort(made.begin(), made.end(), [&](PointId a, PointId b) { return points.compare(a, b) < 0; });
    for (std::size_t i = 1; i < made.size(); ++i) {
      if (points.compare(made[i - 1], made[i]) == 0) number[made[i]] = number[made[i - 1]];
    }
    for (Facet& facet : result_.facets) {
      for (PointId& corner : facet.corner)
        corner = number[corner];
    }
  }

  const FacetSet& set_;
  Arrangement& result_;
  std::vector<Triangle3> triangles_;
  std::vector<std::uint32_t> leader_;  // towards the first of each sheet
  std::unordered_map<std::uint32_t, Insertions> inserted_;
  Sheet touched_;
};

}  // namespace

Arrangement arrange(const FacetSet& set, unsigned jobs, const Progress& progress) {
  Arrangement result;
  Mesh mesh;
  mesh.points = set.points;
  for (const Facet& facet : set.facets) {
    mesh.face_first.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    for (const std::uint32_t corner : facet.corner)
      mesh.corners.push_back(VertexId{corner});
  }
  mesh.face_first.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  const FaceGeometry geometry(mesh, face_states(mesh, jobs), jobs);
  SelfIntersectionOptions how;
  how.max_listed = kAllElements;
  how.jobs = jobs;
  how.progress = progress;
  const SelfIntersections found = find_self_intersections(mesh, geometry, how);
  result.pairs = found.crossing + found.touching;
  if (found.has_more) {
    result.outcome = Arrangement::Outcome::too_many_pairs;
    return result;
  }
  Arranger(set, result).run(found.listed, progress);
  return result;
}

}  // namespace fdcg::bake
