// SPDX-License-Identifier: Apache-2.0
// repair --solid on meshes of which it is known what they enclose.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "random.hpp"
#include "solid/winding_tree.hpp"
#include "solid_cases.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

std::uint64_t total_of(const Report& report, const std::string& rule) {
  for (const Issue& issue : report.issues) {
    if (issue.rule == rule) return issue.total;
  }
  return 0;
}

const RepairAction& last_action(const Repaired& repaired, std::string_view name) {
  const auto found =
      std::find_if(repaired.actions.rbegin(), repaired.actions.rend(), [&](const auto& a) { return a.name == name; });
  REQUIRE(found != repaired.actions.rend());
  return *found;
}

}  // namespace

TEST_CASE("what closed surfaces enclose becomes one closed surface that does not meet itself") {
  for (const SolidCase& each : solid_cases()) {
    INFO(each.soup.name);
    const Result<Repaired> repaired = repair(each.soup, repair_options(RepairLevel::solid));
    REQUIRE(repaired.has_value());
    INFO(last_action(*repaired, "solid").message << " / " << last_action(*repaired, "solid").left_message);
    if (each.volume == 0 && each.tolerance == 0) {
      CHECK(last_action(*repaired, "solid").left != 0);
      continue;
    }
    CHECK(last_action(*repaired, "solid").left == 0);
    CHECK(repaired->after.passes());
    CHECK(total_of(repaired->after, "boundary-edge") == 0);
    CHECK(total_of(repaired->after, "self-intersection") == 0);
    CHECK(repaired->volume_after > 0);
    if (each.tolerance > 0) {
      CHECK(repaired->volume_after == Approx(each.volume).epsilon(each.tolerance));
      CHECK(repaired->after.components == each.components);
    }
    CHECK(last_action(*repaired, "solid").distance <= 1e-5);
  }
}

TEST_CASE("a surface rebuilt from its winding number is closed and does not meet itself, whatever it was made of") {
  for (const SolidCase& each : solid_cases()) {
    INFO(each.soup.name);
    RepairOptions options = repair_options(RepairLevel::solid);
    options.solid->method = SolidOptions::Method::remesh;
    options.solid->voxel = {0.03, true};
    const Result<Repaired> repaired = repair(each.soup, options);
    REQUIRE(repaired.has_value());
    const RepairAction& action = last_action(*repaired, "solid");
    INFO(action.message << " / " << action.left_message);
    if (each.volume == 0 && each.tolerance == 0) {
      CHECK(action.is_refused);
      continue;
    }
    CHECK_FALSE(action.is_refused);
    CHECK(repaired->after.passes());
    CHECK(total_of(repaired->after, "boundary-edge") == 0);
    CHECK(total_of(repaired->after, "self-intersection") == 0);
    if (each.tolerance > 0 && each.tolerance < 1e-4) CHECK(repaired->volume_after == Approx(each.volume).epsilon(0.25));
  }
}

TEST_CASE("the winding number of a group of triangles is the sum of their solid angles") {
  const auto triangles_of_soup = [](const PolygonSoup& soup) {
    std::vector<WindingTree::Triangle> triangles;
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      const std::uint32_t* const c = &soup.corners[soup.face_first[f]];
      triangles.push_back({soup.points[c[0]], soup.points[c[1]], soup.points[c[2]]});
    }
    return triangles;
  };
  SoupMaker open_box;
  open_box.box({-1, -1, -1}, {1, 1, 1}, 31);
  CHECK(WindingTree(triangles_of_soup(open_box.take("box"))).at({0, 0, 0}) == Approx(5.0 / 6));
  SoupMaker ball;
  ball.sphere({0, 0, 0}, 1, 48);
  const auto triangles = triangles_of_soup(ball.take("ball"));
  const WindingTree whole(triangles);
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p{3 * random.unit() - 1.5, 3 * random.unit() - 1.5, 3 * random.unit() - 1.5};
    double sum = 0;
    for (const auto& t : triangles)
      sum += WindingTree({t}).at(p);
    INFO(p.x << " " << p.y << " " << p.z);
    CHECK(std::fabs(whole.at(p) - sum) < 0.01);
  }
}
