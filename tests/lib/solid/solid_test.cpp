// SPDX-License-Identifier: Apache-2.0
// repair --solid on meshes of which it is known what they enclose.
#include <algorithm>

#include "catch.hpp"
#include "fdcg/bake.hpp"
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

const RepairAction& last_action(const Repaired& repaired, const std::string& name) {
  const auto found = std::find_if(repaired.actions.rbegin(), repaired.actions.rend(), [&](const auto& a) { return a.name == name; });
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
