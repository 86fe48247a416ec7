// SPDX-License-Identifier: Apache-2.0
#include "plan.hpp"

#include <algorithm>

#include "rival.hpp"

namespace fdcg::test {
namespace {

constexpr double kMuStatic = 0.6, kMuDynamic = 0.4;

// What the frontier is over. Ways that are aimed at corners and edges exactly do not count: there two answers are equally
// right, rounding chooses, and the way that follows remembers. A hand never meets a corner exactly.
const WayPlan kHand{WayKind::hand, 1000, 0, 0, true};
const WayPlan kPress{WayKind::hand};  // the same where no frontier is drawn
const WayPlan kRub{WayKind::hand, 1000, kMuStatic, kMuDynamic};
const WayPlan kShake{WayKind::tremor, 1000, kMuStatic, kMuDynamic};
const WayPlan kJumps{WayKind::teleport};

// What the frontier is over, too: bodies as scanners, CAD and simulation bring them.
constexpr const char* kAsBrought[] = {"scan_24k", "drilled_plate", "squashed_10k", "spindle_10k"};

// Those of rivals/, whose libraries were found when this was built.
const std::vector<std::string> kShippedRivals = {FDCG_RIVALS_SHIPPED};

constexpr std::uint32_t kLargestBullet = 200'000;  // faces; its step takes over 30 microseconds on a million

}  // namespace

WayMeasure measure_of(const WayPlan& way, bool is_quick) {
  if (way.counts) return is_quick ? WayMeasure{4, 2000, 10, 0.15} : WayMeasure{30, 1000, 3, 0.15};
  return {1, std::min(is_quick ? 4000u : 10'000u, way.most_ticks), 0, is_quick ? 0.2 : 0.4};
}

std::vector<BodyPlan> plan_of(bool is_quick) {
  const WayPlan dive{WayKind::corner_dive}, tremor{WayKind::tremor}, edges{WayKind::edge_slide};
  if (is_quick) {
    std::vector<BodyPlan> plan;
    for (const char* name : {"cube_12", "star_1k", "sphere_10k"})
      plan.push_back({name, {kHand}});
    for (const WayPlan& way : {kRub, edges, dive})
      plan[1].ways.push_back(way);
    plan.push_back({"thin_plate", {kPress}});
    plan.push_back({"corner_pit_tilted", {kShake}});
    return plan;
  }
  std::vector<BodyPlan> plan;
  for (const char* name : {"cube_12", "sphere_80", "star_80", "sphere_1k", "star_1k", "sphere_10k", "star_10k", "torus_10k",
                           "sphere_100k", "star_100k", "sphere_1M", "star_1M"}) {
    plan.push_back({name, {kHand}});
  }
  for (const char* name : kAsBrought)
    plan.push_back({name, ways_of_brought()});
  for (const WayPlan& way : {kRub, kJumps, dive})
    plan[0].ways.push_back(way);
  for (BodyPlan& body : plan) {  // the same motion at other rates, and the other motions
    if (body.body != "star_1k" && body.body != "star_100k") continue;
    const bool is_small = body.body == "star_1k";
    for (const double rate : is_small ? std::vector<double>{4000, 10'000, 40'000} : std::vector<double>{10'000})
      body.ways.push_back({WayKind::hand, rate});
    for (const WayPlan& way : {kRub, kJumps, edges, dive, tremor, WayPlan{WayKind::fan_orbit}, WayPlan{WayKind::quantised}})
      body.ways.push_back(way);
  }
  for (const char* name : {"corner_pit_tilted", "v_groove_tilted", "saddle", "spiky", "thin_plate"})
    plan.push_back({name, {kPress, kRub, dive, tremor, kShake}});
  plan.push_back({"knife", {kPress, dive}});
  plan.push_back({"foil", {kPress}});
  plan.push_back({"needle_strip", {kPress, edges}});
  // a tree's closest point on a fan, and a walk over neighbours there, cost half a millisecond a tick and more
  constexpr std::uint32_t kFanTicks = 300;
  plan.push_back({"fan_peak", {{WayKind::fan_orbit, 1000, 0, 0, false, kFanTicks}}});
  return plan;
}

std::vector<WayPlan> ways_of_other(const Body& body) {
  return body.group == BodyGroup::awkward ? std::vector<WayPlan>{kPress, kRub, kJumps} : std::vector<WayPlan>{kHand, kJumps};
}

std::vector<WayPlan> ways_of_brought() {
  return {kHand, kRub};
}

Contenders contenders_for(const Ground& ground, const Body& body, bool is_quick) {
  const bake::PolygonSoup& soup = ground.soup();
  constexpr std::uint32_t kLarge = 200'000;  // faces: from here on fewer variants, and no grid that takes minutes to bake
  constexpr std::uint32_t kLargestPaper = 2'000'000;  // its graph of vectors takes half a kilobyte a face
  Contenders list;
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    for (const bool is_stored : {true, false}) {
      list.push_back(make_fdcg(soup, {precision, is_stored, true}));
      if (body.faces < kLarge) list.push_back(make_fdcg(soup, {precision, is_stored, false}));
    }
  }
  for (const PaperLevel level : {PaperLevel::printed, PaperLevel::crossings, PaperLevel::edges, PaperLevel::vertices}) {
    if (body.faces > kLargestPaper) break;
    if (level == PaperLevel::printed || level == PaperLevel::vertices || body.faces < kLarge) {
      list.push_back(make_paper(soup, level));
    }
  }
  list.push_back(make_cgal_closest(soup));
  list.push_back(make_embree_closest(soup));
  list.push_back(make_proxy(soup));
  if (!body.is_closed) return list;  // no inside, no signed distance
  // a fan of needles takes minutes to bake finely, for the same reason as a tree's answer on it
  const bool is_coarse = is_quick || body.name.starts_with("fan_");
  const std::vector<int> resolutions = is_coarse ? std::vector<int>{32, 64} : std::vector<int>{32, 64, 128};
  for (const int resolution : resolutions)
    list.push_back(make_distance_grid(ground, resolution));
  if (!is_quick && body.name == "star_10k") list.push_back(make_distance_grid(ground, 256));
  return list;
}

Contenders all_contenders_for(const Ground& ground, const Body& body, bool is_quick, const std::vector<std::string>& rivals) {
  Contenders list = contenders_for(ground, body, is_quick);
  for (const std::string& rival : kShippedRivals) {
    if (body.faces <= kLargestBullet || rival.find("rival_bullet") == std::string::npos)
      list.push_back(make_rival(rival, ground.soup()));
  }
  for (const std::string& rival : rivals)
    list.push_back(make_rival(rival, ground.soup()));
  return list;
}

}  // namespace fdcg::test
