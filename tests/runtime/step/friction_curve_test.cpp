// SPDX-License-Identifier: Apache-2.0
// The friction curve: forces at steady speed lie on it, it has one solution and no jump, there is no creep while sticking, and
// no term does work on the hand. The laws are implemented here independently of the runtime's functions. Over 400 lines: all
// cases compare the step with one curve.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "hip_loop.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "random.hpp"
#include "step/contact_internals.hpp"

using fdcg::internals_of;
using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

constexpr std::uint32_t kCurve = FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG;

fdcg_params curve_params(std::uint32_t terms, double mu_static = 0.7, double mu_dynamic = 0.45) {
  fdcg_params params = contact_params(mu_static, mu_dynamic);
  params.friction_flags = terms;
  params.friction_lag_s = 0.04;
  return params;
}

void require_sound(const fdcg_params& params) {
  fdcg_error error = {};
  const fdcg_status status = fdcg_check_params(&params, &error);
  INFO(error.message);
  REQUIRE(status == FDCG_OK);
}

// The coefficient that the header promises for a steady slide.
double curve(const fdcg_params& p, double speed, double depth) {
  double mu = p.mu_dynamic;
  if ((p.friction_flags & FDCG_FRICTION_STRIBECK) != 0) {
    const double x = speed / (p.stribeck_m_per_s * std::max(1.0, depth / p.unique_solution_depth_m));
    mu += (p.mu_static - p.mu_dynamic) / (1 + x * x);
  }
  return (p.friction_flags & FDCG_FRICTION_VISCOUS) != 0 ? mu + p.viscous_s_per_m * speed : mu;
}

Hip along(const Hip& p, const Hip& d, double s) {
  return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]};
}

// Tangential over normal force.
double ratio(const Hip& force, const Hip& normal) {
  const double n = dot(force, normal);
  return norm(along(force, normal, -n)) / n;
}

// A plane of 1,000 m, so that a slide can go on until it is steady, with its own directions.
struct Plane {
  Rotation tilt;
  PlainGraph graph;
  Hip normal, side;
  explicit Plane(std::uint64_t seed, Precision precision = Precision::f64)
      : tilt(random_rotation(seed)),
        graph(transformed(triangulated(plane_quad()), tilt, 1000), precision),
        normal(point_of(rotated(tilt, {0, 0, 1}))),
        side(point_of(rotated(tilt, {0.8, 0.6, 0}))) {}
};

// Slides at a speed for some seconds and returns the last ratio; the way there is up to 400 m long.
double steady_ratio(const Plane& plane, const fdcg_params& params, double speed, double depth, int ticks) {
  Contact contact(plane.graph.view(), params);
  const Hip start = along(along({0, 0, 0}, plane.side, -speed * params.tick_s * ticks / 2), plane.normal, -depth);
  contact.step(along(start, plane.normal, 2 * depth));
  for (int tick = 0; tick <= ticks; ++tick)
    contact.step(along(start, plane.side, speed * params.tick_s * tick));
  REQUIRE(contact.result.state == FDCG_FACE);
  REQUIRE(contact.result.slipping == 1);
  return ratio(contact.force(), plane.normal);
}

}  // namespace

TEST_CASE("at steady speed the ratio of forces lies on the curve, whatever its terms") {
  const std::uint32_t all[] = {FDCG_FRICTION_VISCOUS,
                               FDCG_FRICTION_STRIBECK | FDCG_FRICTION_LAG,
                               kCurve,
                               kCurve | FDCG_FRICTION_PRESLIDING,
                               FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG,
                               FDCG_FRICTION_STRIBECK};
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Plane plane(seed);
    for (const std::uint32_t terms : all) {
      fdcg_params params = curve_params(terms);
      if (terms == FDCG_FRICTION_STRIBECK) params.stribeck_m_per_s = 2;  // without the lag it must fall gently
      if (terms == FDCG_FRICTION_STRIBECK) params.unique_solution_depth_m = 3e-3;
      require_sound(params);
      for (const double depth : {1e-3, 3e-3, 2e-2}) {
        for (const double speed : {0.02, 0.05, 0.2, 1.0, 5.0}) {
          // The lag takes 40 of its times to be gone to 1e-15.
          const double found = steady_ratio(plane, params, speed, depth, 3000);
          INFO("terms " << terms << ", depth " << depth << " m, " << speed << " m/s");
          REQUIRE(found == Approx(curve(params, speed, depth)).epsilon(1e-9).margin(0));
        }
      }
    }
  }
}

TEST_CASE("a groove's slide lies on the curve by the load of its two walls") {
  for (const double opening : {0.6, 1.5}) {
    const PlainGraph graph(v_groove(opening), Precision::f64);
    for (const std::uint32_t rule : {FDCG_EDGE_WEDGE, FDCG_EDGE_PAPER}) {
      fdcg_params params = curve_params(kCurve | FDCG_FRICTION_PRESLIDING);
      params.edge_friction = rule;
      const double h = 4e-3, speed = 0.3;
      const double load = rule == FDCG_EDGE_WEDGE ? h / std::sin(opening / 2) : h;
      Contact contact(graph.view(), params);
      contact.step(-0.9, 0, 0.1);
      for (int tick = 0; tick < 5500; ++tick)
        contact.step(-0.9 + speed * params.tick_s * tick, 0, -h);
      REQUIRE(contact.result.state == FDCG_EDGE);
      CHECK(-contact.force()[0] / (contact.force()[2] / h * load) == Approx(curve(params, speed, load)).epsilon(1e-9));
    }
  }
}

TEST_CASE("slip begins at the static limit without a jump, and the curve is felt continuously in speed") {
  const Plane plane(7);
  const fdcg_params params = curve_params(FDCG_FRICTION_STRIBECK | FDCG_FRICTION_LAG);
  require_sound(params);
  const double depth = 2e-3;
  const Hip start = along({0, 0, 0}, plane.normal, -depth);
  const auto felt_after = [&](double way) {
    Contact contact(plane.graph.view(), params);
    contact.step(along(start, plane.normal, 2 * depth));
    contact.step(start);
    contact.step(along(start, plane.side, way));
    return ratio(contact.force(), plane.normal);
  };
  const double limit = params.mu_static * depth;
  CHECK(felt_after(limit * (1 - 1e-9)) == Approx(0.7).epsilon(1e-8));
  CHECK(felt_after(limit * (1 + 1e-9)) == Approx(0.7).epsilon(1e-7));
  // One tick's coefficient against how far the hand went in it: small steps give small changes, all the way out.
  double before = felt_after(limit), largest = 0;
  for (double way = limit; way < 40 * limit; way += limit / 500) {
    const double now = felt_after(way);
    largest = std::max(largest, std::abs(now - before));
    REQUIRE(now <= before + 1e-12);
    before = now;
  }
  CHECK(largest < 0.005);
  CHECK(before < 0.69);
}

TEST_CASE("a path does not depend on how a plane is cut up, with the curve on") {
  const fdcg_params params = curve_params(kCurve);
  const PlainGraph whole(scaled(plane_quad(), 1), Precision::f64);
  const PlainGraph cut(triangulated(plane_jittered(12, 5)), Precision::f64);
  Contact one(whole.view(), params), other(cut.view(), params);
  Random random(3);
  Hip hip = {0.01, 0.02, 0.1};
  double farthest = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    hip = {0.3 * std::sin(tick * 0.0013) + 0.05 * std::sin(tick * 0.021), 0.3 * std::sin(tick * 0.0017 + 1),
           tick == 0 ? 0.01 : -3e-3 - 2e-3 * std::sin(tick * 0.004)};
    one.step(hip);
    other.step(hip);
    farthest = std::max(farthest, distance(one.force(), other.force()));
    REQUIRE(one.result.slipping == other.result.slipping);
  }
  CHECK(farthest < 1e-9);  // N, of some 5: roundings of places, times 1,000 N/m
}

TEST_CASE("presliding has the given stiffness, is elastic, and does not creep") {
  const Plane plane(11);
  fdcg_params params = curve_params(FDCG_FRICTION_PRESLIDING);
  params.presliding_n_per_m = 2e4;
  require_sound(params);
  const double depth = 5e-3, k = params.stiffness_n_per_m, kp = params.presliding_n_per_m;
  Contact contact(plane.graph.view(), params);
  const Hip start = along({0, 0, 0}, plane.normal, -depth);
  contact.step(along(start, plane.normal, 2 * depth));
  contact.step(start);
  const Hip origin = contact.god_object();
  const Hip anchor = {contact.state.god_object[0], contact.state.god_object[1], contact.state.god_object[2]};
  const double limit = params.mu_static * depth * (k + kp) / kp;  // where the tangential force reaches mu_s of the normal one
  for (const double way : {0.3 * limit, 0.999999 * limit, -0.5 * limit, 0.0}) {
    contact.step(along(start, plane.side, way));
    REQUIRE(contact.result.slipping == 0);
    const double yielded = dot(difference(contact.god_object(), origin), plane.side);
    CHECK(yielded == Approx(way * k / (k + kp)).epsilon(1e-9).margin(1e-13));
    CHECK(std::abs(-dot(contact.force(), plane.side) - kp * yielded) < 1e-6);  // both springs bear one force
    CHECK(dot(contact.force(), plane.normal) == Approx(k * depth).epsilon(1e-9));
  }
  // Tremor below the limit for a million ticks: the remembered place is the same to the last bit.
  Random random(5);
  for (int tick = 0; tick < 1000000; ++tick) {
    const double a = random.uniform(0, 2 * std::numbers::pi), r = random.uniform(0, 0.45 * limit);
    Hip hip = along(along(start, plane.side, r * std::cos(a)), plane.normal, 0.3 * depth * random.uniform(-1, 1));
    contact.step(hip);
    if (contact.result.slipping != 0 || contact.state.god_object[0] != anchor[0] || contact.state.god_object[1] != anchor[1] ||
        contact.state.god_object[2] != anchor[2]) {
      FAIL("creeps at tick " << tick);
    }
  }
  contact.step(start);
  CHECK(distance(contact.god_object(), origin) < 1e-15);
  contact.step(along(start, plane.side, 1.000001 * limit));
  CHECK(contact.result.slipping == 1);
}

TEST_CASE("with all terms a held contact is still to the last bit over a million ticks") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const Plane plane(13, precision);
    Contact contact(plane.graph.view(), curve_params(kCurve | FDCG_FRICTION_PRESLIDING));
    const double depth = 5e-3;
    const Hip start = along({0, 0, 0}, plane.normal, -depth);
    contact.step(along(start, plane.normal, 2 * depth));
    for (int tick = 0; tick < 50; ++tick)
      contact.step(along(start, plane.side, 1e-4 * tick));
    for (int tick = 0; tick < 3000; ++tick)  // the lag's memory fades
      contact.step(along(start, plane.side, 5e-3));
    const fdcg_result rest = contact.result;
    for (int tick = 0; tick < 1000000; ++tick) {
      contact.step(along(start, plane.side, 5e-3));
      for (int k = 0; k < 3; ++k) {
        if (contact.result.god_object_m[k] != rest.god_object_m[k] || contact.result.force_n[k] != rest.force_n[k])
          FAIL("moves at tick " << tick);
      }
    }
  }
}

TEST_CASE("after a slide, sticking returns as the lag decays") {
  const Plane plane(17);
  fdcg_params params = curve_params(FDCG_FRICTION_STRIBECK | FDCG_FRICTION_LAG);
  const double depth = 3e-3;
  const auto hold_after = [&](int ticks) {
    Contact contact(plane.graph.view(), params);
    const Hip start = along({0, 0, 0}, plane.normal, -depth);
    contact.step(along(start, plane.normal, 2 * depth));
    for (int tick = 0; tick < 1000; ++tick)
      contact.step(along(start, plane.side, 1e-3 * tick));
    const Hip stopped = along(along(contact.god_object(), plane.normal, -depth), plane.side, 0);
    for (int tick = 0; tick < ticks; ++tick)
      contact.step(stopped);
    // how far it holds now: the smallest way that makes it slip, by bisection over copies
    double low = 0, high = 2 * depth;
    for (int i = 0; i < 50; ++i) {
      Contact copy = contact;
      const double middle = (low + high) / 2;
      copy.step(along(stopped, plane.side, middle));
      (copy.state.god_object[0] == contact.state.god_object[0] && copy.state.god_object[1] == contact.state.god_object[1]
           ? low
           : high) = middle;
    }
    return low / depth;
  };
  double before = 0;
  for (const int ticks : {1, 10, 50, 200, 1000}) {
    const double now = hold_after(ticks);
    CHECK(now > before);
    before = now;
  }
  CHECK(hold_after(1) < 0.5);
  CHECK(before == Approx(params.mu_static).epsilon(1e-6));
}

TEST_CASE("friction terms: closed loops over many bodies give the hand no work") {
  const Rotation tilt = random_rotation(31);
  const std::vector<PolygonSoup> bodies = {cube(),
                                           transformed(triangulated(corner_pit()), tilt),
                                           v_groove(1.2),
                                           cone_pit(12),
                                           saddle_block(),
                                           star_sphere(2, 0.3, 8),
                                           plane_jittered(6, 2)};
  const std::uint32_t all[] = {FDCG_FRICTION_STRIBECK, FDCG_FRICTION_VISCOUS, FDCG_FRICTION_PRESLIDING, kCurve,
                               kCurve | FDCG_FRICTION_PRESLIDING};
  Random random(9);
  for (const PolygonSoup& soup : bodies) {
    const PlainGraph graph(soup, Precision::f64);
    for (const std::uint32_t terms : all) {
      int closed = 0;
      for (int loop = 0; loop < 40; ++loop) {
        // Random terms, some of them beyond what check_params takes: passive all the same.
        fdcg_params params = curve_params(terms, 0.3 + random.uniform(0, 1), 0.2);
        params.stribeck_m_per_s = std::exp(random.uniform(-5, 2));
        params.viscous_s_per_m = std::exp(random.uniform(-4, 0));
        params.presliding_n_per_m = params.stiffness_n_per_m * std::exp(random.uniform(-1, 5));
        params.unique_solution_depth_m = 0.1;
        const std::vector<Hip> hips = elliptic_loop(random, extent(soup), 400);
        const LoopAccount account = account_of(graph.view(), params, hips);
        INFO(soup.name << " terms " << terms << ", loop " << loop);
        REQUIRE(account.work_j <= account.bound_j * (1 + 1e-9));
        closed += account.is_closed && account.has_touched();
      }
      INFO(soup.name << " terms " << terms);
      CHECK(closed >= 3);
    }
  }
}

// Tick by tick, which is stronger than the sum over a loop: stored energy never grows by more than the hand's work plus the
// zero-order-hold term. With presliding two springs store energy.
TEST_CASE("the energy of both springs grows by at most the hand's work in each tick, on every body") {
  const Rotation tilt = random_rotation(31);
  const std::vector<PolygonSoup> bodies = {cube(),         transformed(triangulated(corner_pit()), tilt),
                                           v_groove(1.2),  cone_pit(12),
                                           saddle_block(), star_sphere(2, 0.3, 8),
                                           l_prism(),      spiky_sphere(2, 1, 2)};
  for (const PolygonSoup& soup : bodies) {
    const PlainGraph graph(soup, Precision::f64);
    for (const double kp : {300.0, 3e3, 1e5}) {  // from softer than the contact to all but rigid
      fdcg_params params = curve_params(kCurve | FDCG_FRICTION_PRESLIDING, 0.8, 0.5);
      params.presliding_n_per_m = kp;
      const double k = params.stiffness_n_per_m;
      Contact contact(graph.view(), params);
      HipWalk walk(soup, 21);
      Hip hip = walk.next({0, 0, 3}), last_hip = hip;
      contact.step(hip);
      const auto stored = [&](const Hip& at) {
        const Hip anchor = {contact.state.god_object[0], contact.state.god_object[1], contact.state.god_object[2]};
        const double gap = distance(contact.god_object(), at), yielded = distance(contact.god_object(), anchor);
        return contact.result.state == FDCG_FREE
                   ? 0.0
                   : internals_of(contact.state).stiffness_n_per_m / k * (k * gap * gap + kp * yielded * yielded) / 2;
      };
      double before = 0;
      int touched = 0;
      for (int i = 0; i < 20000; ++i) {
        hip = walk.next(contact.god_object());
        const bool was_free = contact.result.state == FDCG_FREE;
        const Hip way = difference(hip, last_hip);
        const double allowed = before - dot(contact.force(), way) + k * dot(way, way) / 2;
        contact.step(hip);
        const double now = stored(hip);
        const bool is_bounded = (contact.result.flags & (FDCG_RESULT_SWEEP_BOUND | FDCG_RESULT_TRANSITION_BOUND)) != 0;
        if (!was_free && contact.result.state != FDCG_FREE && !is_bounded) {
          ++touched;
          INFO(soup.name << " k_p " << kp << ", step " << i << ": " << contact.describe());
          REQUIRE(now <= allowed + 1e-9 * k * extent(soup) * extent(soup));
        }
        before = now;
        last_hip = hip;
      }
      CHECK(touched > 1000);
    }
  }
}

TEST_CASE("disabled friction terms do not change any bit, whatever their fields") {
  const PolygonSoup soup = star_sphere(2, 0.3, 8);
  const PlainGraph graph(soup, Precision::f64);
  fdcg_params plain = contact_params(0.6, 0.4), odd = plain;
  odd.stribeck_m_per_s = 0;
  odd.viscous_s_per_m = -1;
  odd.presliding_n_per_m = 0;
  odd.unique_solution_depth_m = 0;
  odd.finger = {-1, -1, -1};
  require_sound(odd);
  Contact one(graph.view(), plain), other(graph.view(), odd);
  HipWalk walk(soup, 5);
  for (int tick = 0; tick < 5000; ++tick) {
    const Hip hip = walk.next(one.god_object());
    one.step(hip);
    other.step(hip);
    REQUIRE(one.force() == other.force());
    REQUIRE(one.god_object() == other.god_object());
  }
}

// Every term enabled with zero effect: a flat curve, a nearly rigid bristle.
TEST_CASE("friction terms with zero effect give the result of the step without them") {
  const PolygonSoup soup = star_sphere(2, 0.3, 8);
  const PlainGraph graph(soup, Precision::f64);
  fdcg_params plain = contact_params(0.5, 0.5), terms = plain;
  terms.friction_flags = FDCG_FRICTION_ALL & ~FDCG_FRICTION_FINGER;
  terms.viscous_s_per_m = 0;
  terms.presliding_n_per_m = 1e9;
  terms.stiffness_n_per_m = plain.stiffness_n_per_m = 1;
  require_sound(terms);
  HipWalk walk(soup, 6);
  Contact one(graph.view(), plain), other(graph.view(), terms);
  int touched = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const Hip hip = walk.next(one.god_object());
    one.step(hip);
    other.step(hip);
    touched += one.result.state != FDCG_FREE;
    INFO("tick " << tick << ": " << one.describe() << " / " << other.describe());
    REQUIRE(distance(one.force(), other.force()) < 1e-6);
    other.state.god_object[0] = one.state.god_object[0];  // two paths may part at a tie: each tick begins as one
    other.state.god_object[1] = one.state.god_object[1];
    other.state.god_object[2] = one.state.god_object[2];
    const double slip = internals_of(other.state).slip_m_per_s, stiffness = internals_of(other.state).stiffness_n_per_m;
    other.state = one.state;
    internals_of(other.state).slip_m_per_s = slip;
    internals_of(other.state).stiffness_n_per_m = stiffness;
  }
  CHECK(touched > 500);
}

TEST_CASE("a curve that would have two solutions is refused with the limit") {
  fdcg_params params = curve_params(FDCG_FRICTION_STRIBECK);
  fdcg_error error = {};
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("falls by 3.247") &&
                                Catch::Matchers::ContainsSubstring("0.025 s/m") &&
                                Catch::Matchers::ContainsSubstring("raise stribeck_m_per_s"));
  // Just inside and just outside of 0.65 (mu_s - mu_d) / v_s depth <= lag + tick / 4.
  params.friction_flags |= FDCG_FRICTION_LAG;
  const double steepest = 3 * std::sqrt(3.0) / 8 * (0.7 - 0.45) * params.unique_solution_depth_m;
  params.stribeck_m_per_s = steepest / (params.friction_lag_s + params.tick_s / 4) * (1 + 1e-9);
  CHECK(fdcg_check_params(&params, &error) == FDCG_OK);
  params.stribeck_m_per_s *= 1 - 2e-9;
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  params.friction_flags |= FDCG_FRICTION_VISCOUS;
  CHECK(fdcg_check_params(&params, &error) == FDCG_OK);
  params = curve_params(128);  // no flag
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  params = curve_params(FDCG_FRICTION_PRESLIDING);
  params.presliding_n_per_m = std::nan("");
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("presliding_n_per_m") != std::string::npos);
}
