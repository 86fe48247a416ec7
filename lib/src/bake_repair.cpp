// SPDX-License-Identifier: Apache-2.0
// compile() with its repair.
#include <utility>

#include "bake_core.hpp"
#include "base/vec3.hpp"
#include "fdcg/bake.hpp"
#include "topology/weld.hpp"
#include "validate/validate.hpp"

namespace fdcg::bake {
namespace {

// Before anything is repaired.
RepairAccount account_of(const Report& report, RepairLevel level, const PolygonSoup& soup) {
  RepairAccount account;
  account.level = level;
  for (const Issue& issue : report.issues)
    account.found[issue.rule] = issue.total;
  account.faces_before = account.faces_after = soup.face_count();
  return account;
}

// As floats in the local frame hold them, so that what is repaired is what is stored.
PolygonSoup as_stored(const PolygonSoup& soup, Precision precision) {
  PolygonSoup stored = soup;
  if (precision == Precision::f64) return stored;
  const Mesh mesh = weld_points(soup, {Weld::Kind::none, 0}, precision);
  for (std::size_t v = 0; v < stored.points.size(); ++v)
    stored.points[v] = mesh.points[v] + mesh.origin;
  return stored;
}

// From the numbering of the repaired mesh to that of the input.
void number_as_input(const PolygonSoup& input, const Repaired& repaired, Report& report) {
  for (Issue& issue : report.issues) {
    for (Element& element : issue.elements) {
      for (std::uint32_t& f : element.faces)
        f = repaired.source_face[f];
      for (std::uint32_t& v : element.vertices)
        v = repaired.source_point[v];
      for (auto& [u, v] : element.edges)
        u = repaired.source_point[u], v = repaired.source_point[v];
      if (!element.faces.empty() && element.faces[0] < input.face_line.size()) element.line = input.face_line[element.faces[0]];
    }
  }
}

// The mesh after its repair; its report and the account take their places in `compiled`.
Prepared repaired_mesh(const PolygonSoup& soup, const CompileOptions& options, const CheckOptions& how, Compiled& compiled) {
  RepairOptions steps = repair_options(*options.repair);
  steps.weld = options.weld;
  if (steps.solid) steps.solid->as_floats = options.precision == Precision::f32;
  steps.reverse_inside_out = !options.allow.contains("inside-out");
  steps.judges = false;
  steps.jobs = how.jobs;
  steps.progress = options.progress;
  Result<Repaired> repaired = repair(as_stored(soup, options.precision), steps);
  if (repaired->soup.face_count() == 0) return {};  // the report before says why
  Prepared ready = prepare(repaired->soup, {Weld::Kind::none, 0}, options.precision, false, how.jobs);
  compiled.flipped_faces = 0;  // the account has those that were turned
  compiled.report = check(repaired->soup, ready.mesh, ready.topology, ready.states, how);
  number_as_input(soup, *repaired, compiled.report);
  std::map<std::string, std::uint64_t> found = std::move(compiled.repair->found);
  *compiled.repair = std::move(static_cast<RepairAccount&>(*repaired));
  compiled.repair->level = *options.repair;
  compiled.repair->found = std::move(found);
  ready.mesh.source_face = std::move(repaired->source_face);
  return ready;
}

void repair_first(const PolygonSoup& soup, const CompileOptions& options, const CheckOptions& how, Compiled& compiled,
                  Prepared& ready) {
  compiled.repair = account_of(compiled.report, *options.repair, soup);
  const bool is_wanted = options.repair == RepairLevel::solid || !compiled.report.passes();
  if (is_wanted) ready = repaired_mesh(soup, options, how, compiled);
}

}  // namespace

Result<Compiled> compile(const PolygonSoup& soup, const CompileOptions& options) {
  return compile_by(soup, options, repair_first, nullptr);
}

Result<Compiled> compile(PolygonSoup&& soup, const CompileOptions& options) {
  return compile_by(soup, options, repair_first, &soup);
}

}  // namespace fdcg::bake
