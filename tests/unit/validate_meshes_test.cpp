// SPDX-License-Identifier: Apache-2.0
// Totals on real meshes, where they are at hand: FDCG_REAL_MESHES, or ../shared/meshes beside the project. Not part of it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

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
  Totals totals;  // of rules of error severity, boundary edges and isolated vertices: those named; the others are zero
  bool all;       // false: further errors are expected beyond what was counted elsewhere
};

// Counted with other programs, and published with the meshes.
const std::vector<Known> kKnown{
    {"clean/ADIS16480.STL", 7436, {}, true},
    {"clean/1002_tray_bottom.STL", 4520, {}, true},
    {"clean/spot.ply", 5856, {}, true},
    {"clean/lucy.ply", 99970, {}, true},
    {"clean/link1.obj", 12516, {}, true},
    {"clean/Octocat-v2.obj", 40246, {}, true},
    {"clean/cube_quads.ply", 6, {}, true},
    {"clean/dodecahedron_poly.obj", 12, {}, true},
    {"clean/platonic_shelf.obj", 50, {}, true},
    {"clean/shark.ply", 2562, {{"inside-out", 1}}, true},
    {"defective/featuretype.STL", 3476, {{"boundary-edge", 576}}, true},
    {"defective/cycloidal.ply", 43368, {{"non-manifold-edge", 242}, {"non-manifold-vertex", 26}}, false},
    {"defective/bunny.ply", 16301, {{"boundary-edge", 123}, {"non-manifold-edge", 150}, {"duplicate-face", 87}}, false},
    {"defective/chair_model.obj", 12756, {{"non-manifold-edge", 9518}, {"duplicate-face", 6382}}, false},
    {"defective/hourglass_ico.obj", 40, {{"non-manifold-vertex", 1}}, true},
    {"defective/fan3.obj", 3, {{"non-manifold-edge", 1}, {"boundary-edge", 6}}, true},
    {"defective/moebius.obj", 224, {{"not-orientable", 1}}, false},
    {"defective/bun_zipper.ply", 69451, {{"boundary-edge", 223}, {"isolated-vertex", 1113}}, true},
    {"defective/self_intersectA.obj", 17160, {}, true},
    {"defective/openscad-nonmanifold-crash.obj", 1442, {{"non-manifold-edge", 18}, {"non-manifold-vertex", 34}}, false},
    {"defective/horse.ply", 96966, {{"inside-out", 1}}, true},
    {"defective/trunk.obj", 28750, {{"non-manifold-edge", 53}}, false},
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
    for (const Issue& issue : report.issues) {
      if (is_compared(issue) && (known.all || known.totals.count(issue.rule) != 0)) totals[issue.rule] = issue.total;
    }
    CHECK(totals == known.totals);
    CHECK(report.passes() == std::none_of(report.issues.begin(), report.issues.end(),
                                          [](const Issue& i) { return i.severity == Severity::error; }));
  }
  WARN(found << " of " << kKnown.size() << " real meshes found in " << folder());
}
