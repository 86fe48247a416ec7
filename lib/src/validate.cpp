// SPDX-License-Identifier: Apache-2.0
// Every rule of the catalogue that runs on a mesh, one short function each; together a little over 400 lines.
#include "validate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

#include "duplicates.hpp"
#include "edges.hpp"
#include "face_geometry.hpp"
#include "parallel.hpp"
#include "patches.hpp"
#include "phrases.hpp"
#include "weld.hpp"

namespace fdcg::bake {
namespace {

bool is_halfedge(HalfedgeId h) {
  return +h < +Topology::kSkipped;
}
bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
// Halved first: the middle of two finite points is finite.
Vec3 middle(const Vec3& a, const Vec3& b) {
  return {a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
}

// Gathers the findings of one rule: counts all, keeps the first few.
class Checker {
 public:
  Checker(const PolygonSoup& soup, const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
          const CheckOptions& options)
      : soup_(soup), mesh_(mesh), topology_(topology), states_(states), options_(options), geometry_(mesh, states) {}

  Report run();

 private:
  struct Row {
    std::string_view name;
    void (Checker::*run)(Issue&);
  };
  static constexpr std::size_t kRuleCount = 15;
  static const Row kRules[kRuleCount];
  Issue issue_of(const Row& row);
  std::array<Issue, kRuleCount> all_issues();

  // ---- elements
  Element at_vertex(std::uint32_t source) const;
  Element at_face(FaceId f) const;
  Element at_edge(HalfedgeId h) const;
  void add_face(Element& element, FaceId f) const;
  [[nodiscard]] VertexId end_of(HalfedgeId h) const { return mesh_.corners[+next(mesh_, topology_.face(h), h)]; }

  // Counts; calls `locate` only for those that are listed.
  template <class Locate>
  void found(Issue& issue, Locate locate) {
    if (issue.total++ < options_.max_elements) issue.elements.push_back(locate());
  }

  // ---- rules, each named after its own
  void non_finite_coordinate(Issue& issue);
  void index_out_of_range(Issue& issue);
  void empty_mesh(Issue& issue);
  void degenerate_face(Issue& issue);
  void duplicate_face(Issue& issue);
  void non_manifold_edge(Issue& issue);
  void non_manifold_vertex(Issue& issue);
  void winding_inconsistent(Issue& issue);
  void not_orientable(Issue& issue);
  void inside_out(Issue& issue);
  void folded_edge(Issue& issue);
  void boundary_edge(Issue& issue);
  void non_planar_face(Issue& issue);
  void isolated_vertex(Issue& issue);
  void duplicate_vertex(Issue& issue);
  [[nodiscard]] bool is_planar_within_quantum(FaceId f) const;
  [[nodiscard]] Element at_patch(std::uint32_t patch) const;

  const PolygonSoup& soup_;
  const Mesh& mesh_;
  const Topology& topology_;
  const std::vector<FaceState>& states_;
  const CheckOptions& options_;
  FaceGeometry geometry_;
  std::vector<OddEdge> odd_;
  Patches patches_;
};

Element Checker::at_vertex(std::uint32_t source) const {
  Element element;
  element.vertices.push_back(source);
  element.point = soup_.points[source];
  if (source < soup_.point_line.size()) element.line = soup_.point_line[source];
  return element;
}

void Checker::add_face(Element& element, FaceId f) const {
  constexpr std::size_t kMaxFaces = 32;  // an edge may have a million, and a report stays small
  const std::uint32_t source = mesh_.source_of(f);
  if (element.faces.size() < kMaxFaces) element.faces.push_back(source);
  if (!element.line && source < soup_.face_line.size()) element.line = soup_.face_line[source];
}

Element Checker::at_face(FaceId f) const {
  Element element;
  add_face(element, f);
  for (std::uint32_t h = mesh_.face_first[+f]; h < mesh_.face_first[+f + 1]; ++h) {
    if (mesh_.corners[h] == VertexId{kNone}) continue;
    element.point = soup_.points[mesh_.source_point[+mesh_.corners[h]]];
    break;
  }
  return element;
}

Element Checker::at_edge(HalfedgeId h) const {
  Element element;
  const std::uint32_t u = mesh_.source_point[+mesh_.corners[+h]], v = mesh_.source_point[+end_of(h)];
  element.edges.push_back({u, v});
  element.point = middle(soup_.points[u], soup_.points[v]);
  add_face(element, topology_.face(h));
  return element;
}

Element Checker::at_patch(std::uint32_t patch) const {
  const Patch& p = patches_.patches[patch];
  Element element = at_face(p.first_face);
  if (p.conflict != HalfedgeId{kNone}) element.edges = at_edge(p.conflict).edges;
  return element;
}

// ---- vertices and faces

void Checker::non_finite_coordinate(Issue& issue) {
  for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
    if (!is_finite(mesh_.points[v])) found(issue, [&] { return at_vertex(mesh_.source_point[v]); });
  }
}

void Checker::index_out_of_range(Issue& issue) {
  for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
    if (states_[f] == FaceState::invalid_corner) found(issue, [&] { return at_face(FaceId{f}); });
  }
}

void Checker::empty_mesh(Issue& issue) {
  if (mesh_.face_count() == 0) found(issue, [] { return Element{}; });
}

void Checker::degenerate_face(Issue& issue) {
  for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
    if (geometry_.is_degenerate(FaceId{f})) found(issue, [&] { return at_face(FaceId{f}); });
  }
}

void Checker::duplicate_face(Issue& issue) {
  for (const Duplicate& duplicate : duplicate_faces(mesh_, topology_, states_)) {
    found(issue, [&] {
      Element element = at_face(duplicate.copy);
      add_face(element, duplicate.first);
      return element;
    });
  }
}

void Checker::isolated_vertex(Issue& issue) {
  std::vector<bool> is_used(mesh_.points.size(), false);
  for (const VertexId v : mesh_.corners) {
    if (v != VertexId{kNone}) is_used[+v] = true;
  }
  for (std::uint32_t v = 0; v < is_used.size(); ++v) {
    if (!is_used[v]) found(issue, [&] { return at_vertex(mesh_.source_point[v]); });
  }
}

void Checker::duplicate_vertex(Issue& issue) {
  // The vertices that stand for themselves are in ascending order: whatever is between two of them was joined.
  std::uint32_t source = 0;
  for (std::size_t v = 0; v <= mesh_.source_point.size() && issue.elements.size() < options_.max_elements; ++v, ++source) {
    const std::size_t stop = v < mesh_.source_point.size() ? mesh_.source_point[v] : soup_.points.size();
    for (; source < stop && issue.elements.size() < options_.max_elements; ++source) {
      issue.elements.push_back(at_vertex(source));
    }
  }
  issue.total = mesh_.joined_vertices;
}

// ---- edges and fans

void Checker::non_manifold_edge(Issue& issue) {
  for (const OddEdge& edge : odd_) {
    if (edge.halfedges.size() == 2) continue;
    found(issue, [&] {
      Element element = at_edge(edge.halfedges[0]);
      for (std::size_t i = 1; i < edge.halfedges.size(); ++i)
        add_face(element, topology_.face(edge.halfedges[i]));
      return element;
    });
  }
}

void Checker::non_manifold_vertex(Issue& issue) {
  std::vector<std::uint32_t> sources;
  for (const VertexId v : vertices_of_several_fans(mesh_, topology_, states_))
    sources.push_back(mesh_.source_point[+v]);
  for (const std::uint32_t source : sources)
    found(issue, [&] { return at_vertex(source); });
}

void Checker::winding_inconsistent(Issue& issue) {
  for (const OddEdge& edge : odd_) {
    if (edge.halfedges.size() != 2) continue;
    found(issue, [&] {
      Element element = at_edge(edge.halfedges[0]);
      add_face(element, topology_.face(edge.halfedges[1]));
      return element;
    });
  }
}

void Checker::boundary_edge(Issue& issue) {
  for (std::uint32_t h = 0; h < topology_.twin.size(); ++h) {
    if (topology_.twin[h] == Topology::kBoundary) found(issue, [&] { return at_edge(HalfedgeId{h}); });
  }
}

void Checker::folded_edge(Issue& issue) {
  std::vector<std::pair<HalfedgeId, HalfedgeId>> folds;
  for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
    for (std::uint32_t h = mesh_.face_first[f]; h < mesh_.face_first[f + 1]; ++h) {
      const HalfedgeId twin = topology_.twin[h];
      if (!is_halfedge(twin) || +twin < h) continue;
      if (geometry_.is_fold(FaceId{f}, HalfedgeId{h}, topology_.face(twin), twin)) folds.emplace_back(HalfedgeId{h}, twin);
    }
  }
  for (const OddEdge& edge : odd_) {
    if (edge.halfedges.size() != 2) continue;
    const HalfedgeId a = edge.halfedges[0], b = edge.halfedges[1];
    if (geometry_.is_fold(topology_.face(a), a, topology_.face(b), b)) folds.emplace_back(a, b);
  }
  std::sort(folds.begin(), folds.end());
  for (const auto& [a, b] : folds) {
    found(issue, [&, h = a, other = b] {
      Element element = at_edge(h);
      add_face(element, topology_.face(other));
      return element;
    });
  }
}

// ---- patches

void Checker::not_orientable(Issue& issue) {
  for (std::uint32_t p = 0; p < patches_.patches.size(); ++p) {
    if (!patches_.patches[p].is_orientable) found(issue, [&] { return at_patch(p); });
  }
}

void Checker::inside_out(Issue& issue) {
  for (const std::uint32_t p : inside_out_patches(mesh_, patches_))
    found(issue, [&] { return at_patch(p); });
}

// ---- polygons

void Checker::non_planar_face(Issue& issue) {
  for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
    const FaceId face{f};
    if (mesh_.face_first[f + 1] - mesh_.face_first[f] < 4) continue;
    if (!geometry_.is_finite(face) || geometry_.is_degenerate(face) || is_planar_within_quantum(face)) continue;
    if (!geometry_.is_flat(face)) found(issue, [&] { return at_face(face); });
  }
}

// Every corner lies within the tolerance of the plane of the area vector through the corners' mean. The tolerance is what moves
// of every coordinate by the input's quantum (and the storage's) can do, times four: the corner and the plane are off by one
// each, and programs that turn an object round more than once.
bool Checker::is_planar_within_quantum(FaceId f) const {
  const std::uint32_t first = mesh_.face_first[+f], end = mesh_.face_first[+f + 1];
  const auto point = [&](std::uint32_t h) -> const Vec3& { return mesh_.points[+mesh_.corners[h]]; };
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
  const double stored = options_.precision == Precision::f32 ? 0x1p-24 : 0;
  const auto quantum = [&](double local, double origin) {
    const double input = std::max(soup_.relative_quantum * (local + std::abs(origin)), soup_.absolute_quantum);
    return input + stored * local;
  };
  constexpr double kTolerance = 4;
  const double limit =
      kTolerance *
      (std::abs(n.x) * quantum(largest.x, mesh_.origin.x) + std::abs(n.y) * quantum(largest.y, mesh_.origin.y) +
       std::abs(n.z) * quantum(largest.z, mesh_.origin.z)) /
      length;
  for (std::uint32_t h = first; h < end; ++h) {
    const Vec3& p = point(h);
    const double x = p.x - o.x - mean.x, y = p.y - o.y - mean.y, z = p.z - o.z - mean.z;
    if (!(std::abs(x * n.x + y * n.y + z * n.z) / length <= limit)) return false;
  }
  return true;
}

// ---- the report

// In the order of the catalogue, which report and checks keep.
const Checker::Row Checker::kRules[kRuleCount] = {
    {"non-finite-coordinate", &Checker::non_finite_coordinate},
    {"index-out-of-range", &Checker::index_out_of_range},
    {"empty-mesh", &Checker::empty_mesh},
    {"degenerate-face", &Checker::degenerate_face},
    {"duplicate-face", &Checker::duplicate_face},
    {"non-manifold-edge", &Checker::non_manifold_edge},
    {"non-manifold-vertex", &Checker::non_manifold_vertex},
    {"winding-inconsistent", &Checker::winding_inconsistent},
    {"not-orientable", &Checker::not_orientable},
    {"inside-out", &Checker::inside_out},
    {"folded-edge", &Checker::folded_edge},
    {"boundary-edge", &Checker::boundary_edge},
    {"non-planar-face", &Checker::non_planar_face},
    {"isolated-vertex", &Checker::isolated_vertex},
    {"duplicate-vertex", &Checker::duplicate_vertex},
};

Issue Checker::issue_of(const Row& row) {
  const Rule& rule = *find_rule(row.name);
  Issue issue;
  issue.rule = rule.name;
  issue.severity = rule.severity;
  (this->*row.run)(issue);
  if (issue.total != 0) issue.message = finding_message(rule, issue.total);
  return issue;
}

// The rules look at the mesh only, so they run side by side, but for those that share what one of them works out: the patches,
// and which polygons are flat (FaceGeometry keeps that). These two groups take longest and so come first.
std::array<Issue, Checker::kRuleCount> Checker::all_issues() {
  std::array<Issue, kRuleCount> issues;
  std::mutex progress_lock;
  std::size_t done = 0;
  const auto group_of = [](const Row& row) -> std::size_t {
    if (row.name == "not-orientable" || row.name == "inside-out") return 1;
    return row.name == "folded-edge" || row.name == "non-planar-face" ? 2 : 0;
  };
  const auto run_rule = [&](std::size_t rule) {
    issues[rule] = issue_of(kRules[rule]);
    if (!options_.progress) return;
    const std::lock_guard<std::mutex> lock(progress_lock);
    options_.progress("check", static_cast<double>(++done) / kRuleCount);
  };
  constexpr std::size_t kGroups = 2;
  parallel_for(options_.jobs, kGroups + kRuleCount, 1, [&](std::size_t task, std::size_t) {
    if (task >= kGroups) {
      if (group_of(kRules[task - kGroups]) == 0) run_rule(task - kGroups);
      return;
    }
    if (task == 0) patches_ = find_patches(mesh_, topology_, states_, odd_, geometry_);
    for (std::size_t rule = 0; rule < kRuleCount; ++rule) {
      if (group_of(kRules[rule]) == task + 1) run_rule(rule);
    }
  });
  return issues;
}

Report Checker::run() {
  odd_ = odd_edges(mesh_, topology_);
  std::array<Issue, kRuleCount> issues = all_issues();
  Report report;
  report.file = soup_.name;
  report.vertices = mesh_.points.size();
  report.faces = mesh_.face_count();
  report.components = patches_.components;
  for (Issue& issue : issues) {
    report.checks.push_back(issue.rule);
    if (find_rule(issue.rule)->can_be_allowed && options_.allow.count(issue.rule) != 0) report.allowed.insert(issue.rule);
    if (issue.total != 0) report.issues.push_back(std::move(issue));
  }
  std::stable_sort(report.issues.begin(), report.issues.end(),
                   [](const Issue& a, const Issue& b) { return a.severity > b.severity; });
  return report;
}

}  // namespace

Report check(const PolygonSoup& soup, const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
             const CheckOptions& options) {
  return Checker(soup, mesh, topology, states, options).run();
}

Report validate(const PolygonSoup& soup, const ValidateOptions& options) {
  const unsigned jobs = resolve_jobs(options.jobs);
  const Mesh mesh = weld_points(soup, options.weld, options.precision, jobs);
  const std::vector<FaceState> states = face_states(mesh);
  const Topology topology = pair_halfedges(mesh, states);
  Report report =
      check(soup, mesh, topology, states, {options.allow, options.max_elements, options.precision, jobs, options.progress});
  report.fail_on = options.fail_on;
  return report;
}

}  // namespace fdcg::bake
