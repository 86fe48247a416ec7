// SPDX-License-Identifier: Apache-2.0
// The way of one tick over a curved surface, against the steepest descent followed in long double by small steps: right to
// second order in the tick's way, whichever of the step's paths it takes. And its end, however deep the hand is.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;

namespace {

constexpr double kMu = 0.3, kDepth_m = 0.02;

LongPlace plus(const LongPlace& a, const LongPlace& b, Long times) {
  return {a[0] + b[0] * times, a[1] + b[1] * times, a[2] + b[2] * times};
}

// The foot on the surface of what is near it.
LongPlace onto(const fdcg_surface& s, LongPlace p) {
  for (int i = 0; i < 6; ++i)
    p = plus(p, face_normal(s, 0, p), -outside_distance(s, p));
  return p;
}

struct Pull {
  LongPlace across;
  Long load;
  [[nodiscard]] Long excess() const { return length(across) - kMu * load; }
};
Pull pull_at(const fdcg_surface& s, const LongPlace& p, const LongPlace& hip) {
  const LongPlace gap = minus(p, hip), n = face_normal(s, 0, p);
  const Long load = dot(gap, n);
  return {plus(gap, n, -load), load};
}

// The steepest descent from p to where friction stops it.
LongPlace descend(const fdcg_surface& s, LongPlace p, const LongPlace& hip) {
  constexpr Long kStep = 1e-3L;                              // of the pull
  const auto step = [&](const LongPlace& from, Long part) {  // by the midpoint
    const LongPlace middle = onto(s, plus(from, pull_at(s, from, hip).across, -part / 2));
    return onto(s, plus(from, pull_at(s, middle, hip).across, -part));
  };
  for (LongPlace next = step(p, kStep); pull_at(s, next, hip).excess() > 0; next = step(p, kStep))
    p = next;
  Long low = 0, high = kStep;
  for (int i = 0; i < 50; ++i) {
    const Long middle = (low + high) / 2;
    (pull_at(s, step(p, middle), hip).excess() > 0 ? low : high) = middle;
  }
  return step(p, high);
}

// One tick of a god-object that slips at p.
fdcg_result tick(const fdcg_surface& s, const LongPlace& p, const Place& hip) {
  fdcg_params params = fdcg_make_params();
  params.mu_static = params.mu_dynamic = kMu;
  fdcg_contact contact = {};
  contact.started = 1;
  contact.state = FDCG_FACE;
  contact.slipping = 1;
  for (int k = 0; k < 3; ++k) {
    contact.god_object[k] = static_cast<double>(p[k]);
    contact.hip[k] = hip[k];
  }
  fdcg_result result;
  fdcg_surface_step(&s, &params, &contact, hip.data(), &result);
  return result;
}
Place narrow(const LongPlace& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// How far a tick that slides by some `way` ends from the descent's end. The pull is askew to the principal directions.
Long error_of(const fdcg_surface& s, const Place& near, double way) {
  const LongPlace p = onto(s, wide(near)), n = face_normal(s, 0, p);
  LongPlace aside = {0.3L, -0.5L, 0.7L};
  aside = plus(aside, n, -dot(aside, n));
  const Long pull = (kMu * kDepth_m + way) / length(aside);
  const Place hip = narrow(plus(plus(p, n, -kDepth_m), aside, pull));
  const fdcg_result result = tick(s, p, hip);
  REQUIRE(result.state == FDCG_FACE);
  REQUIRE(result.slipping == 1);
  return length(minus(wide(result.god_object_m), descend(s, p, wide(hip))));
}

struct Case {
  fdcg_surface surface;
  Place near;
};
const Case kCases[] = {{fdcg_make_sphere(1), {0.5, 0.6, 0.62}},        {fdcg_make_cylinder(1, 4), {0.8, 0.6, 0.3}},
                       {fdcg_make_capsule(1, 2), {0.8, 0.6, 0.3}},     {fdcg_make_capsule(1, 1), {0.5, 0.6, 1.1}},
                       {fdcg_make_cone(1.5, 0.5, 3), {0.8, 0.5, 0.3}}, {fdcg_make_torus(1, 0.5), {0.9, 0.7, 0.4}},
                       {fdcg_make_torus(1, 0.5), {0.45, 0.35, 0.2}},   {fdcg_make_ellipsoid(1, 0.7, 1.3), {0.5, 0.4, 0.8}}};

}  // namespace

TEST_CASE("the way of one tick over a curved surface is right to second order") {
  for (const Case& a : kCases) {
    for (const bool is_hollow : {false, true}) {
      fdcg_surface surface = a.surface;
      surface.is_hollow = is_hollow ? 1 : 0;
      const double way = 0.0016;  // well below the pull: of the order of a hand's
      const Long errors[] = {error_of(surface, a.near, way), error_of(surface, a.near, way / 2),
                             error_of(surface, a.near, way / 4)};
      INFO(describe(surface) << ": " << errors[0] << " " << errors[1] << " " << errors[2]);
      CHECK(errors[0] < 5e-4 * way);
      CHECK(errors[2] < 1e-14L + errors[0] / 36);  // 64 at third order of what one tick leaves
    }
  }
}

TEST_CASE("a slide under a hand beyond the centre of curvature ends near the first place where friction holds") {
  for (const Case& a : kCases) {
    const fdcg_surface& surface = a.surface;
    if (surface.kind == FDCG_SURFACE_CAPSULE && a.near[2] > 1) continue;  // a cap is a sphere
    Random random(surface.kind);
    const LongPlace p = onto(surface, wide(a.near)), n = face_normal(surface, 0, p);
    const double bend = surface.kind == FDCG_SURFACE_TORUS ? 0.5 : 1;
    int judged = 0, off = 0;
    Long worst = 0;
    for (int i = 0; i < 150; ++i) {
      LongPlace aside = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      aside = plus(aside, n, -dot(aside, n));
      const Long depth = bend * random.uniform(1, 1.6), pull = depth * kMu * (1 + std::exp(random.uniform(-6, 0)));
      const Place hip = narrow(plus(plus(p, n, -depth), aside, pull / length(aside)));
      const fdcg_result result = tick(surface, p, hip);
      if (result.state != FDCG_FACE || result.feature != 0 || result.transitions != 0) continue;
      const LongPlace end = descend(surface, p, wide(hip));
      if (std::abs(outside_distance(surface, end)) > 1e-9L) continue;  // beyond an end
      const Long error = length(minus(wide(result.god_object_m), end)), way = length(minus(end, p));
      ++judged;
      // Where a way just misses a place at which friction would hold it, the step may meet that, or the other way round.
      off += error > 0.05L * way + 1e-9L;
      worst = std::max(worst, error / (way + 1e-9L));
    }
    INFO(describe(surface) << ": of " << judged << " slides " << off << " end elsewhere, " << worst << " of the way");
    CHECK(judged > 75);
    CHECK(off <= judged / 20);
  }
}
