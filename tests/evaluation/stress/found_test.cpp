// SPDX-License-Identifier: Apache-2.0
// Whatever fdcg_stress has found and somebody has mended, cut down: each file in found/ holds a mesh and a path.
#include <algorithm>
#include <filesystem>

#include "catch.hpp"
#include "minimise.hpp"
#include "scratch_folder.hpp"

using namespace fdcg::test;

TEST_CASE("what the stress runs found does not come back") {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(FDCG_FOUND)) {
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() >= 5);
  for (const std::string& file : files) {
    INFO(file);
    const Reproducer r = read_reproducer(file);
    CHECK(first_fault(Specimen(r.body), r) == -1);
  }
}

TEST_CASE("a reproducer comes back from its file bit for bit") {
  const std::string file = std::filesystem::directory_iterator(FDCG_FOUND)->path().string();
  const Reproducer r = read_reproducer(file);
  const std::string copy = scratch_folder() / "copy.obj";
  write_reproducer(copy, r);
  const Reproducer again = read_reproducer(copy);
  CHECK(again.path_m == r.path_m);
  CHECK(again.body.soup.points == r.body.soup.points);
  CHECK(again.body.soup.corners == r.body.soup.corners);
  CHECK(again.fault == r.fault);
  CHECK(test_case_text(again, "a") == test_case_text(r, "a"));
}

TEST_CASE("a reproducer that does not fail is not cut down") {
  CHECK_THROWS(minimised(read_reproducer(std::filesystem::directory_iterator(FDCG_FOUND)->path().string())));
}

// Found and cut down, not yet mended; run by name. A file that no longer fails belongs into found/.
TEST_CASE("faults that stand open still fail", "[.open]") {
  for (const auto& entry : std::filesystem::directory_iterator(FDCG_FOUND "/../open")) {
    if (entry.path().extension() != ".obj") continue;
    INFO(entry.path().string());
    const Reproducer r = read_reproducer(entry.path().string());
    CHECK(first_fault(Specimen(r.body), r) >= 0);
  }
}
