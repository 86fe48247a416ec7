// SPDX-License-Identifier: Apache-2.0
// Selection of the rules that run, and their threads.
#include "validate/validate.hpp"

#include <algorithm>
#include <mutex>
#include <string_view>
#include <utility>

#include "base/parallel.hpp"
#include "topology/orient.hpp"
#include "topology/weld.hpp"
#include "validate/check_rules.hpp"

namespace fdcg::bake {
namespace {

// Rules only read the mesh, so they run concurrently, except for rules that share a result: these run in sequence on one
// thread.
enum class Group {
  patches,     // share find_patches()
  polygons,    // share FaceGeometry's cache of planar polygons
  duplicates,  // share duplicate_faces()
  slivers,     // one long rule, started early so that it does not run alone at the end
  none,
  alone,  // parallel in itself
};

struct Row {
  std::string_view rule;
  Group group;
  void (*run)(const Subject&, Findings&);
};

// In the order of the catalogue, which report and checks use too.
constexpr Row kRows[] = {
    {"non-finite-coordinate", Group::none, checks::non_finite_coordinate},
    {"index-out-of-range", Group::none, checks::index_out_of_range},
    {"empty-mesh", Group::none, checks::empty_mesh},
    {"degenerate-face", Group::none, checks::degenerate_face},
    {"self-crossing-face", Group::none, checks::self_crossing_face},
    {"duplicate-face", Group::duplicates, checks::duplicate_face},
    {"non-manifold-edge", Group::none, checks::non_manifold_edge},
    {"non-manifold-vertex", Group::none, checks::non_manifold_vertex},
    {"winding-inconsistent", Group::none, checks::winding_inconsistent},
    {"not-orientable", Group::patches, checks::not_orientable},
    {"inside-out", Group::patches, checks::inside_out},
    {"folded-edge", Group::polygons, checks::folded_edge},
    {"boundary-edge", Group::none, checks::boundary_edge},
    {"self-intersection", Group::alone, checks::self_intersection},
    {"non-planar-face", Group::polygons, checks::non_planar_face},
    {"t-junction", Group::none, checks::t_junction},
    {"sliver-face", Group::slivers, checks::sliver_face},
    {"isolated-vertex", Group::none, checks::isolated_vertex},
    {"duplicate-vertex", Group::none, checks::duplicate_vertex},
};

class Checker {
 public:
  Checker(Subject& subject, const CheckOptions& options) : subject_(subject), options_(options) {}

  // One for each row; without findings where the rule is not enabled.
  std::vector<Issue> run();

 private:
  void run_group(Group group);
  void run_row(std::size_t row);

  Subject& subject_;
  const CheckOptions& options_;
  std::vector<Issue> issues_{std::size(kRows)};
  std::mutex progress_lock_;
  std::size_t done_ = 0;
};

// Empty if the rule is not to be run.
std::optional<Severity> severity_of(std::string_view rule, const CheckOptions& options) {
  const auto chosen = options.severities.find(std::string(rule));
  return chosen == options.severities.end() ? find_rule(rule)->severity : chosen->second;
}

void Checker::run_row(std::size_t row) {
  if (const std::optional<Severity> severity = severity_of(kRows[row].rule, options_)) {
    Findings findings(subject_, *find_rule(kRows[row].rule), *severity, options_.max_elements, options_.each_element);
    kRows[row].run(subject_, findings);
    issues_[row] = std::move(findings).take();
  }
  if (!options_.progress) return;
  const std::scoped_lock lock(progress_lock_);
  options_.progress("check", static_cast<double>(++done_) / std::size(kRows));
}

void Checker::run_group(Group group) {
  if (group == Group::patches) {
    subject_.patches = find_patches(subject_.mesh, subject_.topology, subject_.states, subject_.odd, subject_.geometry);
  }
  if (group == Group::duplicates) {
    subject_.duplicates = duplicate_faces(subject_.mesh, subject_.topology, subject_.states);
  }
  for (std::size_t row = 0; row < std::size(kRows); ++row) {
    if (kRows[row].group == group) run_row(row);
  }
}

std::vector<Issue> Checker::run() {
  subject_.odd = odd_edges(subject_.mesh, subject_.topology, options_.jobs);
  constexpr Group kGroups[] = {Group::patches, Group::polygons, Group::slivers, Group::duplicates};  // longest first
  std::vector<std::size_t> single;
  for (std::size_t row = 0; row < std::size(kRows); ++row) {
    if (kRows[row].group == Group::none) single.push_back(row);
  }
  parallel_for(options_.jobs, std::size(kGroups) + single.size(), 1, [&](std::size_t task, std::size_t) {
    if (task < std::size(kGroups)) {
      run_group(kGroups[task]);
    } else {
      run_row(single[task - std::size(kGroups)]);
    }
  });
  run_group(Group::alone);
  return std::move(issues_);
}

std::uint64_t count_kept(const Subject& subject) {
  std::uint64_t kept = 0;
  auto copy = subject.duplicates.begin();  // ascending
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    const bool is_copy = copy != subject.duplicates.end() && copy->copy == FaceId{f};
    if (is_copy) ++copy;
    kept += !is_copy && subject.geometry.is_finite(FaceId{f}) && !subject.geometry.is_degenerate(FaceId{f});
  }
  return kept;
}

}  // namespace

Report check(const PolygonSoup& soup, const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
             const CheckOptions& options) {
  FaceGeometry geometry(mesh, states, options.jobs);
  Subject subject{soup, mesh, topology, states, options.precision, options.jobs, options.progress, geometry};
  std::vector<Issue> issues = Checker(subject, options).run();
  Report report;
  report.file = soup.name;
  report.vertices = mesh.points.size();
  report.faces = mesh.face_count();
  report.components = subject.patches.components;
  report.kept_faces = count_kept(subject);
  report.ignored = soup.ignored;
  report.fail_on = options.fail_on;
  for (std::size_t row = 0; row < std::size(kRows); ++row) {
    const std::string rule(kRows[row].rule);
    if (!severity_of(rule, options)) continue;
    report.checks.push_back(rule);
    if (find_rule(rule)->can_be_allowed && options.allow.count(rule) != 0) report.allowed.insert(rule);
    if (issues[row].total != 0) report.issues.push_back(std::move(issues[row]));
  }
  std::stable_sort(report.issues.begin(), report.issues.end(),
                   [](const Issue& a, const Issue& b) { return a.severity > b.severity; });
  return report;
}

Prepared prepare(const PolygonSoup& soup, const Weld& weld, Precision precision, bool orient, unsigned jobs) {
  Prepared ready;
  ready.mesh = weld_points(soup, weld, precision, jobs);
  ready.states = face_states(ready.mesh, jobs);
  ready.topology = pair_halfedges(ready.mesh, ready.states, jobs);
  if (orient) ready.flipped_faces = bake::orient(ready.mesh, ready.topology, ready.states).size();
  return ready;
}

Report validate(const PolygonSoup& soup, const ValidateOptions& options) {
  const unsigned jobs = resolve_jobs(options.jobs);
  const Prepared ready = prepare(soup, options.weld, options.precision, options.orient, jobs);
  CheckOptions how;
  how.allow = options.allow;
  how.severities = options.severities;
  how.fail_on = options.fail_on;
  how.max_elements = options.max_elements;
  how.precision = options.precision;
  how.jobs = jobs;
  how.progress = options.progress;
  how.each_element = options.each_element;
  return check(soup, ready.mesh, ready.topology, ready.states, how);
}

}  // namespace fdcg::bake
