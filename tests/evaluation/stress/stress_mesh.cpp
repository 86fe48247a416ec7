// SPDX-License-Identifier: Apache-2.0
#include "stress_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "contact_rig.hpp"
#include "exact_solid.hpp"
#include "inside_grid.hpp"
#include "meshes.hpp"

namespace fdcg::test {
namespace {

bake::PolygonSoup mesh;
struct Judged {
  std::string why_no_inside;
  bool sheets_meet = false;
};
std::array<Judged, 2> judged;  // by precision

std::size_t index_of(bake::Precision precision) {
  return precision == bake::Precision::f64 ? 0 : 1;
}

Body mesh_body(Random& random, bake::Precision precision) {
  Body body;
  body.soup = mesh;
  body.focus = {random.below(static_cast<std::uint32_t>(mesh.points.size())),
                random.below(static_cast<std::uint32_t>(mesh.points.size()))};
  body.options.precision = precision;
  body.options.store_planes = random.chance(0.5);
  body.options.jobs = 1;
  body.options.without = {"source-map", "info"};
  body.is_closed = why_no_inside(precision).empty();
  body.sheets_meet = judged[index_of(precision)].sheets_meet;
  body.description = mesh.name + (body.options.store_planes ? "" : ", planes derived");
  return body;
}

// Of a closed surface that does not pass through itself. One part within another, both wound outwards, bounds no solid: the
// compiler's checks let it pass. Faces too low for a place in front of them to be told are not asked.
bool looks_inwards(const std::vector<Triangle>& triangles) {
  constexpr double kLeastHeight = 1e-6, kBefore = 1e-9;  // of the size
  const InsideGrid grid(triangles);
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    const Hip a = difference(t[1], t[0]), b = difference(t[2], t[0]), c = difference(t[2], t[1]), n = cross_product(a, b);
    const double area = norm(n), longest = std::max({norm(a), norm(b), norm(c)});
    if (!(area > kLeastHeight * grid.size() * longest)) return false;
    Hip front, back;
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = (t[0][i] + t[1][i] + t[2][i]) / 3, up = kBefore * grid.size() * n[i] / area;
      front[i] = middle + up, back[i] = middle - up;
    }
    return grid.where(front) == InsideGrid::Where::inside && grid.where(back) == InsideGrid::Where::outside;
  });
}

Judged judged_as(bake::Precision precision) {
  bake::ValidateOptions checks;
  checks.precision = precision;
  const bake::Report report = bake::validate(mesh, checks);
  const auto has = [&](std::string_view rule) {
    return std::any_of(report.issues.begin(), report.issues.end(),
                       [&](const bake::Issue& issue) { return issue.rule == rule && issue.total > 0; });
  };
  bake::CompileOptions options;
  options.precision = precision;
  const CompiledMesh compiled(mesh, options);
  const bool sheets_meet = has("self-intersection");
  if (compiled.view().header->connection_type_count[FDCG_BOUNDARY] != 0) return {"it is open", sheets_meet};
  if (sheets_meet) return {"faces cross or touch", sheets_meet};
  if (looks_inwards(ExactSolid(triangulated(mesh), *compiled.view().header).triangles())) return {"faces look inwards"};
  return {};
}

}  // namespace

const StressCase& mesh_case(const std::string& file) {
  auto read = bake::import_mesh(file);
  if (!read) throw std::runtime_error(read.error().message);
  mesh = std::move(*read);
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32})
    judged[index_of(precision)] = judged_as(precision);
  using enum Motion;
  static const StressCase made = {
      "mesh", "as the mesh, up to the stated deviation", mesh_body, {wander, slide, dive, on_planes, aim, jump}, true, 50};
  return made;
}

const std::string& why_no_inside(bake::Precision precision) {
  return judged[index_of(precision)].why_no_inside;
}

}  // namespace fdcg::test
