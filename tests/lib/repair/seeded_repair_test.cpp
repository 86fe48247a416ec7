// SPDX-License-Identifier: Apache-2.0
// Defects that repair can undo completely, planted in clean meshes: the result is the clean mesh, face for face.
// FDCG_REPAIR_CASES sets how many random meshes (default 60).
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "clean_mesh.hpp"
#include "fdcg/bake.hpp"
#include "seeder.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

using Corner = std::array<double, 3>;

// The faces by their coordinates, each from its least corner on, so that neither numbers nor the first corner count.
std::multiset<std::vector<Corner>> faces_of(const PolygonSoup& soup) {
  std::multiset<std::vector<Corner>> faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    std::vector<Corner> loop;
    for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h) {
      const Vec3& p = soup.points[soup.corners[h]];
      loop.push_back({p.x, p.y, p.z});
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    faces.insert(std::move(loop));
  }
  return faces;
}

RepairOptions all_repairs() {
  RepairOptions options;
  options.weld = Weld{};
  options.drop_degenerate_faces = true;
  options.drop_duplicate_faces = true;
  options.orient = true;
  options.reverse_inside_out = true;
  return options;
}

}  // namespace

TEST_CASE("repair gives the clean mesh back where flips, copies, reversals and loose vertices were planted") {
  const char* value = std::getenv("FDCG_REPAIR_CASES");
  const int cases = value != nullptr ? std::atoi(value) : 60;
  int planted = 0;
  for (int i = 0; i < cases; ++i) {
    const std::uint64_t seed = 71'000 + static_cast<std::uint64_t>(i);
    Random random(seed);
    const Seeder::Setting setting;
    const CleanMesh clean = random_clean_mesh(random, 100 + random.below(4000), false);
    Seeder seeder(clean, setting, random);
    const std::uint32_t shell = random.below(static_cast<std::uint32_t>(clean.shells.size()));
    if (random.chance(0.4) && !clean.shells[shell].is_cavity) seeder.reverse_shell(shell);  // a cavity turned over is no error
    if (random.chance(0.3)) planted += seeder.flip_many(random.unit()) ? 1 : 0;
    for (std::uint32_t defects = random.below(30); defects > 0; --defects) {
      static const std::array<std::string, 5> kKinds = {"flip", "duplicate", "repeated-corner", "unweld", "repeated-point"};
      planted += seeder.plant(kKinds[random.below(5)]) ? 1 : 0;
    }
    const SeededMesh seeded = seeder.finish();
    std::string kinds;
    for (const auto& [kind, count] : seeded.planted)
      kinds += " " + kind + " " + std::to_string(count);
    INFO("seed " << seed << ", shells " << clean.shells.size() << "," << kinds);
    const Result<Repaired> repaired = repair(seeded.soup, all_repairs());
    REQUIRE(repaired.has_value());
    std::string left;
    for (const Issue& issue : repaired->after.issues)
      left += " " + issue.rule + " " + std::to_string(issue.total);
    CHECK(left == "");
    CHECK((faces_of(repaired->soup) == faces_of(clean.soup)));
    CHECK(repaired->soup.points.size() == clean.soup.points.size());
    std::uint64_t degenerate = 0, copies = 0, joined = 0;
    for (const RepairAction& action : repaired->actions) {
      if (action.name == "drop-degenerate") degenerate = action.total;
      if (action.name == "drop-duplicates") copies = action.total;
      if (action.name == "weld") joined = action.total;
    }
    const auto count = [&](const char* rule) {
      const auto found = seeded.findings.find(rule);
      return found == seeded.findings.end() ? 0 : found->second.size();
    };
    CHECK(degenerate == count("degenerate-face"));
    CHECK(copies == count("duplicate-face"));
    CHECK(joined == count("duplicate-vertex"));
  }
  CHECK(planted > 5 * cases);
}
