// SPDX-License-Identifier: Apache-2.0
// Whatever fdcg_stress has found and somebody has mended, cut down: each file in found/ holds a mesh and a path.
#include <algorithm>
#include <filesystem>
#include <limits>

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

namespace {

double squared_distance_from_way(const Hip& from, const Hip& to, const fdcg::bake::Vec3& p) {
  const Hip way = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, at = {p.x - from[0], p.y - from[1], p.z - from[2]};
  const double share = std::clamp(
      (at[0] * way[0] + at[1] * way[1] + at[2] * way[2]) / (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]), 0., 1.);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += (at[i] - share * way[i]) * (at[i] - share * way[i]);
  return sum;
}

// Without the triangle that is farthest from the last way.
Body opened(Body body, const Hip& from, const Hip& to) {
  std::size_t farthest = 0;
  double most = 0;
  for (std::size_t f = 0; f < body.soup.face_count(); ++f) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 3 * f; i < 3 * f + 3; ++i)
      nearest = std::min(nearest, squared_distance_from_way(from, to, body.soup.points[body.soup.corners[i]]));
    if (nearest > most) most = nearest, farthest = f;
  }
  const auto first = body.soup.corners.begin() + static_cast<std::ptrdiff_t>(3 * farthest);
  body.soup.corners.erase(first, first + 3);
  body.soup.face_first.pop_back();
  body.is_closed = false;
  return body;
}

}  // namespace

TEST_CASE("a way between merged faces meets them where the mesh has a hole elsewhere, and where it has no hierarchy") {
  for (const char* const name :
       {"through_a_coarsely_merged_body", "in_beside_a_merged_edge_in_floats", "in_and_out_of_a_merged_prism_in_floats"}) {
    const Reproducer r = read_reproducer(FDCG_FOUND "/" + std::string(name) + ".obj");
    for (const bool has_hierarchy : {true, false}) {
      INFO(name << (has_hierarchy ? "" : ", no hierarchy"));
      Body body = opened(r.body, r.path_m[r.path_m.size() - 2], r.path_m.back());
      if (!has_hierarchy) body.options.without.insert("hierarchy");
      const Specimen specimen(body);
      REQUIRE(specimen.header().connection_type_count[FDCG_BOUNDARY] == 3);
      fdcg_contact contact{};
      fdcg_result out{};
      for (const Hip& hip : r.path_m)
        fdcg_step(&specimen.graph(), &r.params, &contact, hip.data(), &out);
      CHECK(out.transitions > 0);
    }
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
