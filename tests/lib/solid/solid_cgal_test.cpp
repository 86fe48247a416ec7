// SPDX-License-Identifier: Apache-2.0
// Results of repair --solid as CGAL judges them: closed, outward, free of intersections. Generated cases, and the real files
// below FDCG_REAL_MESHES where that is given.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "solid_cases.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;
namespace pmp = CGAL::Polygon_mesh_processing;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Empty: a solid.
std::string fault_of(const PolygonSoup& soup) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  for (const Vec3& p : soup.points)
    points.emplace_back(p.x, p.y, p.z);
  for (std::size_t f = 0; f < soup.face_count(); ++f)
    faces.emplace_back(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return "no manifold";
  SurfaceMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, faces, mesh);
  if (!CGAL::is_closed(mesh)) return "not closed";
  if (!CGAL::is_triangle_mesh(mesh)) return "not all triangles";
  if (pmp::does_self_intersect(mesh)) return "meets itself";
  if (!pmp::does_bound_a_volume(mesh)) return "bounds no volume";
  if (!pmp::is_outward_oriented(mesh)) return "not outward";
  return {};
}

}  // namespace

TEST_CASE("CGAL finds the results closed, outward and free of intersections") {
  for (const SolidCase& each : solid_cases()) {
    INFO(each.soup.name);
    const Result<Repaired> repaired = repair(each.soup, repair_options(RepairLevel::solid));
    REQUIRE(repaired.has_value());
    if (repaired->actions.back().left != 0) continue;
    CHECK(fault_of(repaired->soup) == "");
  }
}

TEST_CASE("CGAL finds most real files that are warned of or refused closed and free of intersections after repair --solid") {
  const char* const folder = std::getenv("FDCG_REAL_MESHES");
  if (folder == nullptr || !std::filesystem::is_directory(folder)) {
    WARN("skipped: FDCG_REAL_MESHES names no folder of mesh files");
    return;
  }
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::size_t good = 0, reasoned = 0, count = 0;
  for (const auto& path : paths) {
    const Result<PolygonSoup> soup = import_mesh(path.string());
    if (!soup) continue;
    ++count;
    const auto begin = std::chrono::steady_clock::now();
    const Result<Repaired> repaired = repair(*soup, repair_options(RepairLevel::solid));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    REQUIRE(repaired.has_value());
    const RepairAction& solid = repaired->actions.back();
    const std::string fault = solid.left_message.find("no solid") == 0 ? solid.left_message : fault_of(repaired->soup);
    std::cout << (fault.empty() ? "good " : "FAULT ") << path.filename().string() << " " << soup->face_count() << " -> "
              << repaired->soup.face_count() << " faces, " << seconds << " s, moved " << solid.distance << ", volume " << repaired->volume_before << " -> " << repaired->volume_after << "; " << fault << "; "
              << solid.message << std::endl;
    good += fault.empty();
    reasoned += solid.left != 0;
  }
  std::cout << good << " good, " << reasoned << " with a reason, of " << count << std::endl;
}
