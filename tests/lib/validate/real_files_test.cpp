// SPDX-License-Identifier: Apache-2.0
// Mesh files of other people: every face accounted for, every total counted a second time. FDCG_RECOUNT_BYTES sets up to which
// size files are recounted (default 700,000).
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "plain_recount.hpp"
#include "real_files.hpp"

using namespace fdcg::bake;
using fdcg::test::plain_recount;
using fdcg::test::PlainRecount;
using fdcg::test::real_mesh_files;

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Loops = std::vector<std::vector<std::size_t>>;

std::uintmax_t recount_bytes() {
  const char* value = std::getenv("FDCG_RECOUNT_BYTES");
  return value != nullptr ? std::strtoull(value, nullptr, 10) : 700'000;
}

std::uint64_t total(const Report& report, const std::string& rule) {
  for (const Issue& issue : report.issues)
    if (issue.rule == rule) return issue.total;
  return 0;
}

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// The faces that the report takes out, by what it lists and by where coordinates are not finite.
std::set<std::uint32_t> faces_taken_out(const PolygonSoup& soup, const Report& report) {
  std::set<std::uint32_t> out;
  for (const Issue& issue : report.issues) {
    if (issue.rule != "degenerate-face" && issue.rule != "duplicate-face" && issue.rule != "index-out-of-range") continue;
    for (const Element& element : issue.elements)
      out.insert(element.faces.front());
  }
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h) {
      if (soup.corners[h] < soup.points.size() && !is_finite(soup.points[soup.corners[h]])) out.insert(f);
    }
  }
  return out;
}

// The soup as CGAL takes it; false where its coordinates or indices are not to be had.
bool to_cgal(const PolygonSoup& soup, std::vector<Point>& points, Loops& loops) {
  for (const Vec3& p : soup.points) {
    if (!is_finite(p)) return false;
    points.emplace_back(p.x, p.y, p.z);
  }
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    loops.emplace_back(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
    if (std::any_of(loops.back().begin(), loops.back().end(), [&](std::size_t v) { return v >= points.size(); })) return false;
  }
  return true;
}

// Counts what CGAL's orientation of a soup meets.
struct EdgeVisitor : PMP::Default_orientation_visitor {
  std::set<std::pair<std::size_t, std::size_t>>* edges = nullptr;
  void non_manifold_edge(std::size_t a, std::size_t b, std::size_t) { edges->insert(std::minmax(a, b)); }
};

}  // namespace

TEST_CASE("every face of every real file is kept or listed under its defect") {
  std::size_t read = 0, refused = 0;
  for (const auto& path : real_mesh_files()) {
    INFO(path.string());
    const Result<PolygonSoup> soup = import_mesh(path);
    if (!soup) {
      ++refused;
      CHECK(soup.error().exit_code == 3);
      CHECK(soup.error().message.find(path.filename().string()) != std::string::npos);
      CHECK((soup.error().rule == "unreadable" || soup.error().rule == "empty-mesh"));
      continue;
    }
    ++read;
    CHECK(soup->face_count() > 0);
    ValidateOptions options;
    options.max_elements = kAllElements;
    const Report report = validate(*soup, options);
    CHECK(report.faces == soup->face_count());
    CHECK(report.kept_faces + faces_taken_out(*soup, report).size() == report.faces);
    for (const Issue& issue : report.issues) {
      INFO(issue.rule);
      CHECK(issue.total == issue.elements.size());
    }
  }
  WARN(read << " files read, " << refused << " refused");
}

TEST_CASE("totals on real files equal a recount by definition") {
  std::size_t counted = 0;
  for (const auto& path : real_mesh_files()) {
    if (std::filesystem::file_size(path) > recount_bytes()) continue;
    const Result<PolygonSoup> soup = import_mesh(path);
    if (!soup) continue;
    ++counted;
    INFO(path.string());
    const Report report = validate(*soup);
    constexpr double kMostPairs = 3e7;  // of boundary edges with vertices
    const bool seams = static_cast<double>(total(report, "boundary-edge")) * static_cast<double>(report.vertices) < kMostPairs;
    const PlainRecount recount = plain_recount(*soup, seams);
    CHECK(report.vertices == recount.vertices);
    CHECK(report.components == recount.components);
    CHECK(report.kept_faces == recount.kept_faces);
    for (const std::string& rule : report.checks) {
      if (rule == "self-intersection" || rule == "non-planar-face" || (rule == "t-junction" && !seams)) continue;
      INFO(rule);
      const auto expected = recount.totals.find(rule);
      CHECK(total(report, rule) == (expected == recount.totals.end() ? 0 : expected->second));
    }
    CHECK(total(report, "non-planar-face") >= recount.least_non_planar);
    CHECK(total(report, "non-planar-face") <= recount.most_non_planar);
  }
  WARN(counted << " files recounted");
}

TEST_CASE("totals on real files agree with CGAL's polygon soup and mesh functions") {
  std::size_t soups = 0, meshes = 0;
  for (const auto& path : real_mesh_files()) {
    if (std::filesystem::file_size(path) > recount_bytes()) continue;
    const Result<PolygonSoup> soup = import_mesh(path);
    std::vector<Point> points;
    Loops loops;
    if (!soup || !to_cgal(*soup, points, loops)) continue;
    ++soups;
    INFO(path.string());
    const Report report = validate(*soup);
    const std::size_t joined = PMP::merge_duplicate_points_in_polygon_soup(points, loops);
    CHECK(total(report, "duplicate-vertex") == joined);
    CHECK(report.vertices == points.size());
    std::vector<Point> used = points;
    Loops same = loops;
    CHECK(total(report, "isolated-vertex") == PMP::remove_isolated_points_in_polygon_soup(used, same));
    Loops distinct = loops;  // a vertex that a face names again does not count, unless fewer than three are left
    for (auto& loop : distinct) {
      std::set<std::size_t> seen;
      auto once = loop;
      std::erase_if(once, [&seen](std::size_t vertex) { return !seen.insert(vertex).second; });
      if (once.size() >= 3) loop = once;
    }
    CHECK(total(report, "duplicate-face") == PMP::merge_duplicate_polygons_in_polygon_soup(points, distinct));

    // Without what takes no part: faces with a corner named twice.
    loops.erase(std::remove_if(loops.begin(), loops.end(),
                               [](const auto& loop) {
                                 return loop.size() < 3 || std::set<std::size_t>(loop.begin(), loop.end()).size() < loop.size();
                               }),
                loops.end());
    std::set<std::pair<std::size_t, std::size_t>> bad_edges;
    EdgeVisitor visitor;
    visitor.edges = &bad_edges;
    std::vector<Point> oriented_points = points;
    Loops oriented = loops;
    PMP::orient_polygon_soup(oriented_points, oriented, CGAL::parameters::visitor(visitor));
    CHECK(total(report, "non-manifold-edge") == bad_edges.size());

    if (loops.empty() || !PMP::is_polygon_soup_a_polygon_mesh(loops)) continue;
    ++meshes;
    Surface surface;
    PMP::polygon_soup_to_polygon_mesh(points, loops, surface);
    CHECK(total(report, "winding-inconsistent") + total(report, "non-manifold-edge") == 0);
    std::size_t border = 0;
    for (const auto h : halfedges(surface))
      border += is_border(h, surface) ? 1 : 0;
    CHECK(total(report, "boundary-edge") == border);
    std::vector<Surface::Halfedge_index> pinched;
    PMP::non_manifold_vertices(surface, std::back_inserter(pinched));
    CHECK(total(report, "non-manifold-vertex") == pinched.size());
    if (border != 0 || !is_triangle_mesh(surface) || total(report, "non-manifold-vertex") != 0) continue;
    if (report.components != 1 || total(report, "degenerate-face") != 0) continue;
    CHECK(total(report, "inside-out") == (PMP::is_outward_oriented(surface) ? 0 : 1));
  }
  WARN(soups << " soups, " << meshes << " meshes compared with CGAL");
}
