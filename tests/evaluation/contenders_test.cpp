// SPDX-License-Identifier: Apache-2.0
// The harness of the contenders: its judges must see what they are there to see, its rivals must be what they claim.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "instruction_count.hpp"
#include "metrics.hpp"
#include "pareto.hpp"
#include "plan.hpp"
#include "point.hpp"
#include "timing.hpp"

using namespace fdcg::test;
using namespace fdcg::test::plain;
namespace bake = fdcg::bake;

namespace {

struct Stage {
  explicit Stage(const std::string& body, WayKind kind = WayKind::hand, std::uint32_t ticks = 2000)
      : ground(body_named(body).make()), truth(ground) {
    WayOptions options;
    options.kind = kind;
    options.ticks = ticks;
    way = make_way(ground, options);
    ticks_true = truth.follow(way, {0, 0, true});
    for (const TrueBody::Tick& tick : ticks_true)
      felt.push_back(tick.feel);
  }
  [[nodiscard]] Metrics judged() const { return judge(way, 1000, felt, ticks_true, truth); }
  // The first tick of a stretch of at least `length` ticks of true contact, deep enough to count.
  [[nodiscard]] std::size_t contact(std::size_t length) const {
    std::size_t run = 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      run = plain::length(ticks_true[i].feel.force) > 0.05 ? run + 1 : 0;
      if (run == length) return i + 1 - length;
    }
    throw std::logic_error("no contact of that length");
  }

  Ground ground;
  TrueBody truth;
  Way way;
  std::vector<TrueBody::Tick> ticks_true;
  std::vector<Feel> felt;
};

// A wall at z = 0 that does what no passive wall may.
class BadWall : public Contender {
 public:
  BadWall(double gain_out, double drift) : gain_out_(gain_out), drift_(drift) {}
  void reset() override { last_ = 1, place_ = 0; }
  void step(const Point& hip, Feel& feel) override {
    feel = {hip, {}, hip[2] < 0, 0, false};
    place_ += drift_;
    if (feel.in_contact) {
      feel.god_object = {hip[0] + place_, hip[1], 0};
      feel.force = {0, 0, -kStiffness_n_per_m * hip[2] * (hip[2] > last_ ? gain_out_ : 1)};
    }
    last_ = hip[2];
  }

 private:
  double gain_out_, drift_, last_ = 1, place_ = 0;
};

Way dip() {
  Way way;
  for (int i = 0; i <= 100; ++i)
    way.push_back({0, 0, 1e-3 * std::cos(0.0314159 * i) - 5e-4});
  return way;
}

}  // namespace

TEST_CASE("the truth, with sweeps skipped where the ground is far, is the plain walker's") {
  for (const WayKind kind : {WayKind::hand, WayKind::teleport}) {
    const Stage stage("star_80", kind);
    bake::CompileOptions options;
    options.merge = false;
    const auto compiled = bake::compile(stage.ground.soup(), options);
    REQUIRE(compiled.has_value());
    fdcg_graph graph{};
    REQUIRE(fdcg_open_memory(compiled->bytes.data(), compiled->bytes.size(), FDCG_VERIFY_TRUSTED, &graph, nullptr) == FDCG_OK);
    const ReferenceSurface<long double> surface(graph);
    ReferenceWalker<long double> walker(surface, {0, 0, true});
    int contacts = 0;
    for (std::size_t i = 0; i < stage.way.size(); ++i) {
      walker.step(surface.local(stage.way[i].data()));
      REQUIRE(walker.contact.state == stage.ticks_true[i].state);
      REQUIRE(walker.contact.feature == stage.ticks_true[i].feature);
      contacts += walker.contact.state != FDCG_FREE;
    }
    CHECK(contacts > 200);
  }
}

TEST_CASE("carried work is judged by the model's own way in that tick") {
  Stage stage("star_80", WayKind::teleport);
  const auto leap = [&](auto&& wanted) {
    std::size_t i = 1;
    while (i < stage.way.size() && !(stage.ticks_true[i].feel.in_contact && stage.ticks_true[i].visit.margin > kTie &&
                                     wanted(stage.ticks_true[i].visit.features)))
      ++i;
    REQUIRE(i + 30 < stage.way.size());
    return i;
  };
  using Visited = std::vector<TrueBody::Feature>;
  const auto free_on = [&](std::size_t i) { stage.felt[i] = {stage.way[i], {}, false, 0, true}; };
  const auto hold = [&](std::size_t from, std::size_t ticks) {  // the leap's end, for so long
    std::fill_n(stage.way.begin() + static_cast<std::ptrdiff_t>(from), ticks, stage.way[from]);
    stage.ticks_true = stage.truth.follow(stage.way, {0, 0, true});
    for (std::size_t i = 0; i < stage.way.size(); ++i)
      stage.felt[i] = stage.ticks_true[i].feel;
  };

  SECTION("free while the model sweeps, but not for ever") {
    const std::size_t i = leap([](const Visited& v) { return v.front().first == FDCG_FREE; });
    hold(i, 30);
    for (std::size_t k = 0; k < 5; ++k)
      free_on(i + k);
    CHECK(stage.judged().carried_ticks == 5);
    CHECK(stage.judged().push_throughs == 0);
    CHECK(stage.judged().unjudged_share == 0);
    for (std::size_t k = 5; k < 25; ++k)
      free_on(i + k);
    CHECK(stage.judged().push_throughs == 1);
  }
  SECTION("on a feature that it visits, and not back from there") {
    const std::size_t i = leap([](const Visited& v) { return v.size() > 4 && v.front().first == FDCG_FACE; });
    hold(i, 30);
    const auto feel = [&](std::size_t tick, const Point& god_object) {
      stage.felt[tick] = {god_object, (god_object - stage.way[tick]) * kStiffness_n_per_m, true, 0, true};
    };
    const Point begin = stage.ticks_true[i - 1].feel.god_object, end = stage.ticks_true[i].feel.god_object;
    feel(i, begin);
    feel(i + 1, end);
    CHECK(stage.judged().carried_ticks == 2);
    CHECK(stage.judged().astray_ticks == 0);
    feel(i + 2, begin);
    CHECK(stage.judged().astray_ticks == 1);
    feel(i + 2, end + Point{1e-4, 1e-4, 1e-4});
    CHECK(stage.judged().astray_ticks == 1);
  }
  SECTION("the way turns where the HIP moves on meanwhile") {
    const std::size_t i = leap([](const Visited& v) { return v.size() > 4 && v.front().first == FDCG_FACE; });
    stage.way[i + 1] = (stage.way[i - 1] + stage.way[i]) * 0.5;
    stage.ticks_true = stage.truth.follow(stage.way, {0, 0, true});
    for (std::size_t k = 0; k < stage.way.size(); ++k)
      stage.felt[k] = stage.ticks_true[k].feel;
    TrueBody::Place place{stage.ticks_true[i].visit.features.front(), stage.ticks_true[i - 1].feel.god_object, stage.way[i]};
    const Feel stays{place.god_object, (place.god_object - stage.way[i]) * kStiffness_n_per_m, true, 0, true};
    CHECK(stage.truth.visit(&place, stage.way[i + 1], {0, 0, true}).features.size() > 1);
    stage.felt[i] = stays;
    stage.felt[i + 1] = {place.god_object, (place.god_object - stage.way[i + 1]) * kStiffness_n_per_m, true, 0, true};
    CHECK(stage.judged().astray_ticks == 0);
    stage.felt[i + 1].god_object[2] += 1e-3;
    CHECK(stage.judged().astray_ticks == 1);
  }
}

TEST_CASE("the judge finds nothing in the truth and what is planted in it") {
  Stage stage("star_80");
  const Metrics clean = stage.judged();
  CHECK(clean.god_object_max_m == 0);
  CHECK(clean.force_max_n == 0);
  CHECK(clean.wrong_feature_share == 0);
  CHECK(clean.push_throughs == 0);
  CHECK(clean.phantom_share == 0);
  CHECK(clean.jump_n_per_ms == clean.true_jump_n_per_ms);
  CHECK(clean.contact_ticks > 200);
  CHECK(clean.contact_ticks < clean.ticks);

  const std::size_t first = stage.contact(20);
  SECTION("contact lost for ten ticks: pushed through once") {
    for (std::size_t i = first + 5; i < first + 15; ++i)
      stage.felt[i] = {stage.way[i], {}, false, 0, false};
    const Metrics m = stage.judged();
    CHECK(m.push_throughs == 1);
    CHECK(m.push_through_share == Approx(10.0 / static_cast<double>(m.contact_ticks)));
    CHECK(m.wrong_feature_share == Approx(m.push_through_share));
    CHECK(m.god_object_max_m == Approx(m.force_max_n / kStiffness_n_per_m));
    CHECK(m.jump_n_per_ms > 0.04);
  }
  SECTION("pushed out of the other side, twice") {
    for (const std::size_t i : {first + 3, first + 12}) {
      Feel& f = stage.felt[i];
      f.god_object = stage.way[i] - (f.god_object - stage.way[i]);
      f.force = f.force * -1;
    }
    CHECK(stage.judged().push_throughs == 2);
    CHECK(stage.judged().direction_max_deg == Approx(180));
  }
  SECTION("work carried over excuses no force that is lost where the model's way stays on the surface") {
    stage.felt[first + 3] = {stage.way[first + 3], {}, false, 0, true};
    const Metrics m = stage.judged();
    CHECK(m.carried_ticks == 1);
    CHECK(m.push_throughs == 1);
    CHECK(m.astray_ticks == 1);
    CHECK(m.unjudged_share == 0);
  }
  SECTION("where it was before is not known: not judged") {
    stage.felt[first + 2].god_object[0] += 1e-4;
    stage.felt[first + 3] = {stage.way[first + 3], {}, false, 0, true};
    const Metrics m = stage.judged();
    CHECK(m.push_throughs == 0);
    CHECK(m.astray_ticks == 0);
    CHECK(m.unjudged_share == Approx(1.0 / static_cast<double>(clean.contact_ticks)));
  }
  SECTION("god-objects a tenth of a millimetre off") {
    for (Feel& f : stage.felt) {
      if (f.in_contact) f.god_object[0] += 1e-4;
    }
    const Metrics m = stage.judged();
    CHECK(m.god_object_max_m == Approx(1e-4));
    CHECK(m.god_object_p99_m == Approx(1e-4));
    CHECK(m.wrong_feature_share > 0.3);  // the rest slid along their faces
  }
  SECTION("a force in free space") {
    for (std::size_t i = 0; i < stage.way.size(); ++i) {
      if (!stage.felt[i].in_contact) stage.felt[i].force = {1, 0, 0};
    }
    CHECK(stage.judged().phantom_share == 1);
  }
  SECTION("forces ten per cent too strong, none noticed at five") {
    for (Feel& f : stage.felt)
      f.force = f.force * 1.05;
    CHECK(stage.judged().noticeable_share == 0);
    for (Feel& f : stage.felt)
      f.force = f.force * (1.10 / 1.05);
    CHECK(stage.judged().noticeable_share == 1);
    CHECK(stage.judged().force_share_p99 == Approx(0.1));
  }
}

TEST_CASE("after a tie every right answer is right, and nothing else") {
  Stage stage("star_80", WayKind::edge_slide);
  std::vector<std::size_t> tied;
  for (std::size_t i = 0; i < stage.way.size(); ++i) {
    const TrueBody::Tick& tick = stage.ticks_true[i];
    if (!tick.feel.in_contact || tick.others.empty() || !(plain::length(tick.feel.force) > 0.05)) continue;
    REQUIRE(tick.in_floats.has_value());
    const Feel& last = tick.others.back();
    if (last.in_contact != tick.in_floats->in_contact ||
        plain::length(last.god_object - tick.in_floats->god_object) >= kApart_m)
      tied.push_back(i);
    for (const Feel& other : tick.others)
      CHECK((other.in_contact != tick.feel.in_contact || plain::length(other.god_object - tick.feel.god_object) >= kApart_m));
  }
  REQUIRE(tied.size() > 10);
  CHECK(stage.judged().tied_share == 0);  // what is at the truth needs no excuse
  CHECK(stage.judged().god_object_max_m == 0);
  for (const std::size_t i : tied)
    stage.felt[i] = stage.ticks_true[i].others.back();
  const Metrics other = stage.judged();
  CHECK(other.tied_share == Approx(static_cast<double>(tied.size()) / static_cast<double>(other.contact_ticks)));
  CHECK(other.equal_share < other.tied_share);
  CHECK(other.judged_rms_m == 0);
  // What doubles tell apart is no tie for what computes in double.
  const auto told = [&](std::size_t i) { return stage.ticks_true[i].others_for(true).empty(); };
  const Metrics in_double = judge(stage.way, 1000, stage.felt, stage.ticks_true, stage.truth, {}, true);
  CHECK(in_double.tied_share < other.tied_share);
  CHECK((in_double.judged_rms_m > 0) == std::any_of(tied.begin(), tied.end(), told));
  CHECK(other.god_object_max_m >= kApart_m);
  CHECK(other.push_throughs == 0);
  for (const std::size_t i : tied)
    stage.felt[i] = {stage.way[i], {}, false, 0, false};  // let go, deep inside
  const Metrics lost = stage.judged();
  CHECK(lost.judged_rms_m > 0);
  CHECK(lost.push_throughs > 0);
}

TEST_CASE("a tie is decided in 256 bits: into the middle of an edge exactly, where long double meets a face or nothing") {
  bake::PolygonSoup soup = body_named("sphere_80").make();
  constexpr double kGrid = 0x1p34;  // of a metre: sums of two corners are exact, products of three have over 64 bits
  const auto on_grid = [](double x) { return std::nearbyint(x * kGrid) / kGrid; };
  for (bake::Vec3& p : soup.points)
    p = {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
  const Ground ground(soup);
  const TrueBody truth(ground);
  Way way;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const bake::Vec3 &a = soup.points[soup.corners[3 * f]], &b = soup.points[soup.corners[3 * f + 1]];
    const Point sum{a.x + b.x, a.y + b.y, a.z + b.z};
    const Point from{on_grid(0.6 * sum[0]), on_grid(0.6 * sum[1] + 1e-3), on_grid(0.6 * sum[2])};
    way.insert(way.end(), {from, sum - from, from});  // in over the middle, and out
  }
  const auto ticks = truth.follow(way, {0, 0, true});
  int faces_in_long_double = 0;
  bake::CompileOptions options;
  options.merge = false;
  const auto compiled = bake::compile(soup, options);
  REQUIRE(compiled.has_value());
  fdcg_graph graph{};
  REQUIRE(fdcg_open_memory(compiled->bytes.data(), compiled->bytes.size(), FDCG_VERIFY_TRUSTED, &graph, nullptr) == FDCG_OK);
  const ReferenceSurface<long double> surface(graph);
  ReferenceWalker<long double> walker(surface, {0, 0, true});
  for (std::size_t i = 0; i < way.size(); ++i) {
    const ReferenceStep rounded = walker.step(surface.local(way[i].data()));
    if (i % 3 != 1) continue;
    REQUIRE(ticks[i].visit.features.size() > 1);
    CHECK(ticks[i].visit.features[1].first == FDCG_EDGE);
    faces_in_long_double += rounded.visited.size() < 2 || rounded.visited[1].first != FDCG_EDGE;
  }
  CHECK(faces_in_long_double > 0);
}

TEST_CASE("into corners exactly, what computes in double is where 256 bits are, and needs no tie") {
  const Stage stage("star_80", WayKind::corner_dive);
  CHECK(std::any_of(stage.ticks_true.begin(), stage.ticks_true.end(),
                    [](const TrueBody::Tick& tick) { return !tick.others.empty(); }));
  const auto step = make_fdcg(stage.ground.soup(), {bake::Precision::f64, true, false});
  const Metrics m = judge(stage.way, 1000, feel_along(*step, stage.way), stage.ticks_true, stage.truth, {}, true);
  CHECK(m.tied_share == 0);
  CHECK(m.judged_rms_m < 1e-15);
}

TEST_CASE("into corners exactly, what computes in float is where 256 bits are with its numbers, and needs no tie") {
  Stage stage("star_80", WayKind::corner_dive);
  const auto step = make_fdcg(stage.ground.soup(), {bake::Precision::f32, true, false});
  const std::vector<Feel> felt = feel_along(*step, stage.way);
  const Metrics m = judge(stage.way, 1000, felt, stage.ticks_true, stage.truth);
  CHECK(m.in_floats_share > 0);
  CHECK(m.tied_share == 0);
  CHECK(m.judged_rms_m < 1e-7);
  // Its own answers are no excuse for what computes in double, nor for what is beside them all.
  CHECK(judge(stage.way, 1000, felt, stage.ticks_true, stage.truth, {}, true).in_floats_share == 0);
  stage.felt = felt;
  for (Feel& f : stage.felt)
    if (f.in_contact) f.god_object[0] += 4 * kApart_m;
  CHECK(stage.judged().in_floats_share == 0);
  CHECK(stage.judged().judged_rms_m > kApart_m);
}

TEST_CASE("into a cube along its diagonal exactly, three faces are as near") {
  const Ground ground(body_named("cube_12").make());
  const TrueBody truth(ground);
  Way way;
  for (const double a : {0.053, 0.0505, 0.0499, 0.0495})
    way.push_back({a, -a, a});
  const std::vector<TrueBody::Tick> ticks = truth.follow(way, {0, 0, true});
  std::vector<Feel> felt;
  for (const TrueBody::Tick& tick : ticks)
    felt.push_back(tick.feel);
  CHECK(judge(way, 1000, felt, ticks, truth, {}, true).tied_share == 0);
  for (std::size_t i = 2; i < way.size(); ++i) {
    REQUIRE(ticks[i].feel.in_contact);
    for (std::size_t k = 0; k < 3; ++k) {
      Ground::Point other = way[i];
      other[k] = way[i][k] > 0 ? 0.05 : -0.05;
      if (plain::length(other - ticks[i].feel.god_object) > kApart_m) felt[i].god_object = other;
    }
  }
  const Metrics equal = judge(way, 1000, felt, ticks, truth, {}, true);
  CHECK(equal.tied_share == 1);
  CHECK(equal.equal_share == 1);
  felt[3].god_object[0] += 2e-15;  // no tie's business, but no longer as near
  felt[3].god_object[1] += 2e-15;
  felt[3].god_object[2] += 2e-15;
  CHECK(judge(way, 1000, felt, ticks, truth, {}, true).equal_share == 0.5);
}

TEST_CASE("a hand that is off by a tie has met the face that it is behind") {
  const bake::PolygonSoup soup = body_named("sphere_80").make();
  const Ground ground(soup);
  const TrueBody truth(ground);
  int begun = 0;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    Ground::Point middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const bake::Vec3& p = soup.points[soup.corners[3 * f + k]];
      middle = middle + Ground::Point{p.x / 3, p.y / 3, p.z / 3};
    }
    const Ground::Point out = middle * (1 / plain::length(middle));
    const auto ticks = truth.follow({middle + out * 3e-3, middle + out * 1e-8, middle - out * 1e-3}, {0, 0, true});
    REQUIRE(ticks[1].state == FDCG_FREE);
    REQUIRE(ticks[2].state != FDCG_FREE);
    begun += ticks[2].visit.margin < kTie;
    for (const Feel& other : ticks[2].others)
      CHECK(other.in_contact);
  }
  CHECK(begun > 0);
}

TEST_CASE("without a tie one answer is right") {
  const Stage stage("sphere_1k");
  CHECK(stage.judged().tied_share < 0.05);
  const Stage tremor("corner_pit_tilted", WayKind::tremor);  // where rounding decides, all the time, and nothing comes of it
  CHECK(tremor.judged().tied_share < 0.05);
}

TEST_CASE("an active wall gives more work than the hold's bound, a passive one does not, and a creeping one creeps") {
  const Way way = dip();
  BadWall passive(1, 0), active(3, 0), creeping(1, 1e-9);
  const LoopEnergy good = energy_of_loop(passive, way), bad = energy_of_loop(active, way);
  CHECK(good.bound_j > 0);
  CHECK(good.work_j <= good.bound_j);
  CHECK(bad.work_j > bad.bound_j);
  std::vector<TrueBody::Tick> truth(way.size());
  for (std::size_t i = 0; i < way.size(); ++i)
    truth[i].feel.in_contact = way[i][2] < 0;
  CHECK(creep_m(passive, way, truth) == 0);
  CHECK(creep_m(creeping, way, truth) == Approx(500e-9));
}

TEST_CASE("closest points, grids and proxies are as good as they can be on a ball") {
  const Stage stage("sphere_1k");
  struct Case {
    std::unique_ptr<Contender> contender;
    double rms_m;
  };
  Case cases[] = {
      {make_fdcg(stage.ground.soup(), {}), 1e-16},
      {make_fdcg(stage.ground.soup(), {bake::Precision::f32, false, true}), 1e-8},
      {make_paper(stage.ground.soup(), PaperLevel::vertices), 1e-16},
      {make_cgal_closest(stage.ground.soup()), 2e-5},  // a ball's facets: the closest face is not always the one slid to
      {make_embree_closest(stage.ground.soup()), 2e-5},
      {make_proxy(stage.ground.soup()), 4e-5},
      {make_distance_grid(stage.ground, 64), 5e-5}};
  for (const Case& c : cases) {
    const Metrics m = judge(stage.way, 1000, feel_along(*c.contender, stage.way), stage.ticks_true, stage.truth);
    INFO(c.contender->info().name);
    CHECK(m.god_object_rms_m < c.rms_m);
    CHECK(m.push_through_share < 0.01);
    CHECK(m.phantom_share < 0.05);
    CHECK(c.contender->info().bytes > 1000);
    CHECK(c.contender->info().bake_s > 0);
  }
}

TEST_CASE("CGAL's and Embree's closest points are the ground's") {
  const Stage stage("spiky", WayKind::teleport, 400);
  const auto cgal = make_cgal_closest(stage.ground.soup()), embree = make_embree_closest(stage.ground.soup());
  int contacts = 0;
  for (const Point& hip : stage.way) {
    const double distance = stage.ground.closest(hip).distance;
    for (Contender* contender : {cgal.get(), embree.get()}) {
      Feel feel;
      contender->step(hip, feel);
      if (!feel.in_contact) continue;
      ++contacts;
      CHECK(plain::length(feel.god_object - hip) == Approx(distance).margin(2e-8));
    }
  }
  CHECK(contacts > 50);
}

TEST_CASE("thin plates tell who remembers the side that the HIP came in by") {
  const Stage stage("thin_plate");
  const auto pushed = [&](Contender& contender) {
    return judge(stage.way, 1000, feel_along(contender, stage.way), stage.ticks_true, stage.truth).push_throughs;
  };
  CHECK(pushed(*make_fdcg(stage.ground.soup(), {})) == 0);
  CHECK(pushed(*make_cgal_closest(stage.ground.soup())) > 0);
  CHECK(pushed(*make_distance_grid(stage.ground, 64)) > 0);
}

TEST_CASE("a contender is beaten by what is faster and no less exact, by what is not told apart never") {
  const auto entry = [](const char* name, double time_ns, double error_m, const char* family = "a") {
    Standing s;
    s.name = name;
    s.family = family;
    s.time_ns = time_ns;
    s.error_m = error_m;
    return s;
  };
  std::vector<Standing> list = {
      entry("exact", 100, 1e-17),           entry("slow", 200, 1e-9), entry("coarse", 50, 1e-5),
      entry("alike", 100.4, 1e-9),          entry("floor", 110, 0),   entry("bare", 99.5, 1e-18, "ablation"),
      entry("coarser yet slower", 51, 1e-4)};
  rank(list, 0.01, 1e-16);
  const auto beaten_by = [&](std::size_t i) { return list[i].is_on_frontier ? "" : list[i].beaten_by; };
  CHECK(beaten_by(0) == std::string());
  CHECK(beaten_by(1) == std::string("bare"));  // an ablation counts
  CHECK(beaten_by(2) == std::string());
  CHECK(beaten_by(3) == std::string());
  CHECK(beaten_by(4) == std::string("bare"));  // both under the floor
  CHECK(beaten_by(5) == std::string());
  CHECK(beaten_by(6) == std::string("coarse"));
  const std::string better = where_others_win({entry("ours", 10, 0, "fdcg"), entry("theirs", 5, 1e-3)}, "fdcg");
  CHECK(better.find("theirs faster: 0.5 times ours") == 0);
  CHECK(where_others_win({entry("ours", 10, 0, "fdcg"), entry("theirs", 11, 0)}, "fdcg").empty());
}

TEST_CASE("times: all entrants have the same rounds, and a slower one is slower") {
  class Waster : public Contender {
   public:
    explicit Waster(int work) : work_(work) {}
    void reset() override {}
    void step(const Point& hip, Feel& feel) override {
      double x = hip[0];
      for (int i = 0; i < work_; ++i)
        x = std::sqrt(x + i);
      feel.force[0] = x;
    }

   private:
    int work_;
  };
  Waster quick(10), slow(1000);
  const Way way(500, Point{1, 2, 3});
  const std::vector<Timing> timings = time_all({&quick, &slow, &quick}, way, Stopwatch(), {0.02, {3, 77, 499}});
  for (const Timing& t : timings) {
    CHECK(t.rounds >= kLeastRounds);
    CHECK(t.rounds % 2 == 1);
    CHECK(t.rounds == timings[0].rounds);
    CHECK(t.tick_ns.size() == way.size());
    CHECK(t.cold_ns.size() == 3);
    CHECK(t.batch_ns > 0);
    CHECK(t.least_mean_ns <= t.mean_ns());
    CHECK(t.met_max_ns >= t.met_p999_ns);
    CHECK(t.met_p999_ns >= t.least_mean_ns);
  }
  CHECK(timings[1].mean_ns() > 5 * timings[0].mean_ns());
  const double instructions = contact_instructions(quick, way, {5, 10, 400});
  CHECK((FDCG_COUNTS_INSTRUCTIONS == 0 || instructions > 20));
  CHECK(instructions < 300);
  CHECK(contact_instructions(slow, way, {5, 10, 400}) == 0);
}

TEST_CASE("times: what the caches have lost costs time, a contender's own clock is believed") {
  class Reader : public Contender {  // of 64 lines, each on a page of its own
   public:
    void reset() override {}
    void step(const Point&, Feel& feel) override {
      for (std::size_t i = 0; i < pages_.size(); i += 4096 + 64)
        feel.transitions += pages_[i];
    }

   private:
    std::vector<unsigned char> pages_ = std::vector<unsigned char>(64 * (4096 + 64), 1);
  };
  class Honest : public Contender {
   public:
    void reset() override {}
    void step(const Point&, Feel&) override {}
    [[nodiscard]] double own_ns() const override { return 1234; }
  };
  Reader reader;
  Honest honest;
  std::vector<std::uint32_t> cold_ticks;
  for (std::uint32_t i = 10; i < 500; i += 10)
    cold_ticks.push_back(i);
  const std::vector<Timing> timings = time_all({&reader, &honest}, Way(500), Stopwatch(), {0.01, cold_ticks});
  CHECK(Percentiles(timings[0].cold_ns).at(0.5) > 2 * Percentiles(timings[0].tick_ns).at(0.5));
  CHECK(timings[1].mean_ns() == 1234);
  CHECK(timings[1].cold_ns.back() == 1234);
  CHECK(empty_step_ns(Stopwatch()) < 100);
}
