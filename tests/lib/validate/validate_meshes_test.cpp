// SPDX-License-Identifier: Apache-2.0
// Totals on real meshes, where they are at hand: FDCG_REAL_MESHES, or ../shared/meshes beside the project. Not part of it.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"

using namespace fdcg::bake;

namespace {

std::filesystem::path folder() {
  const char* named = std::getenv("FDCG_REAL_MESHES");
  return named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FDCG_SOURCE_DIR) / "../shared/meshes";
}

using Totals = std::map<std::string, std::uint64_t>;
struct Known {
  std::string file;
  std::uint64_t faces;
  Totals totals;  // of rules of error severity, boundary edges and isolated vertices; those not named are zero
  std::uint64_t self_intersections;
};

// Published with the meshes as counted with other programs, or (folded edges, the few that come with other defects) recounted
// by definition; self-intersections as CGAL counts them.
const std::vector<Known> kKnown{
    {"clean/ADIS16480.STL", 7436, {}, 0},
    {"clean/1002_tray_bottom.STL", 4520, {}, 0},
    {"clean/spot.ply", 5856, {}, 0},
    {"clean/lucy.ply", 99970, {}, 0},
    {"clean/link1.obj", 12516, {}, 0},
    {"clean/Octocat-v2.obj", 40246, {}, 0},
    {"clean/cube_quads.ply", 6, {}, 0},
    {"clean/dodecahedron_poly.obj", 12, {}, 0},
    {"clean/platonic_shelf.obj", 50, {}, 0},
    {"clean/scallop.glb", 120000, {}, 0},
    {"clean/mengerSponge3.glb", 21598, {}, 0},
    {"clean/bunny_gltf.drc", 69451, {{"boundary-edge", 223}}, 0},
    {"clean/shark.ply", 2562, {{"inside-out", 1}}, 0},
    {"defective/featuretype.STL", 3476, {{"boundary-edge", 576}}, 1216},
    {"defective/cycloidal.ply", 43368, {{"non-manifold-edge", 242}, {"non-manifold-vertex", 26}, {"folded-edge", 2}}, 54960},
    {"defective/bunny.ply",
     16301,
     {{"boundary-edge", 123}, {"non-manifold-edge", 150}, {"duplicate-face", 87}, {"folded-edge", 92}, {"isolated-vertex", 25}},
     97},
    {"defective/chair_model.obj", 12756, {{"non-manifold-edge", 9518}, {"duplicate-face", 6382}, {"folded-edge", 9}}, 8946},
    {"defective/hourglass_ico.obj", 40, {{"non-manifold-vertex", 1}}, 0},
    {"defective/fan3.obj", 3, {{"non-manifold-edge", 1}, {"boundary-edge", 6}}, 0},
    {"defective/moebius.obj", 224, {{"not-orientable", 1}, {"winding-inconsistent", 4}, {"boundary-edge", 112}}, 0},
    {"defective/bun_zipper.ply", 69451, {{"boundary-edge", 223}, {"isolated-vertex", 1113}}, 0},
    {"defective/deg_faces.obj", 4, {{"degenerate-face", 1}, {"boundary-edge", 5}, {"isolated-vertex", 1}}, 0},
    {"defective/inf_nan.obj", 1, {{"non-finite-coordinate", 3}}, 0},
    {"defective/non_manifold_wrap.obj", 12, {{"non-manifold-edge", 1}, {"boundary-edge", 8}}, 0},
    {"defective/self_intersectA.obj", 17160, {}, 338},
    {"defective/openscad-nonmanifold-crash.obj",
     1442,
     {{"non-manifold-edge", 18},
      {"non-manifold-vertex", 34},
      {"degenerate-face", 1},
      {"duplicate-face", 3},
      {"folded-edge", 47}},
     7545},
    {"defective/horse.ply", 96966, {{"inside-out", 1}}, 4},
    {"defective/trunk.obj",
     28750,
     {{"non-manifold-edge", 53}, {"duplicate-face", 8}, {"non-manifold-vertex", 6}, {"inside-out", 2}},
     10608},
};

bool is_compared(const Issue& issue) {
  return issue.severity == Severity::error || issue.rule == "boundary-edge" || issue.rule == "isolated-vertex";
}

}  // namespace

TEST_CASE("totals on real meshes are those that other programs count") {
  std::size_t found = 0;
  for (const Known& known : kKnown) {
    const std::filesystem::path path = folder() / known.file;
    if (!std::filesystem::exists(path)) continue;
    ++found;
    INFO(known.file);
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE(soup.has_value());
    const Report report = validate(*soup);
    CHECK(report.faces == known.faces);
    Totals totals;
    std::uint64_t self_intersections = 0;
    for (const Issue& issue : report.issues) {
      if (is_compared(issue)) totals[issue.rule] = issue.total;
      if (issue.rule == "self-intersection") self_intersections = issue.total;
    }
    CHECK(self_intersections == known.self_intersections);
    CHECK(totals == known.totals);
    CHECK(report.passes() == std::none_of(report.issues.begin(), report.issues.end(),
                                          [](const Issue& i) { return i.severity == Severity::error; }));
  }
  if (found == 0) WARN("skipped: none of the meshes is at hand");
  WARN(found << " of " << kKnown.size() << " real meshes found in " << folder());
}
