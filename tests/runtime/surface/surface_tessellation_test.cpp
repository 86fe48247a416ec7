// SPDX-License-Identifier: Apache-2.0
// A surface against graphs of its tessellations, under the same hand. At a depth a god-object follows the facet's normal, so
// that along the surface it is off by depth times an angle of first order, this way on one half of a facet and that way on the
// other (tests/evaluation/laws/tessellation.cpp). Of second order are the size of the force, and over many facets the mean of
// everything.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;
using fdcg::bake::PolygonSoup;

namespace {

constexpr double kPi = std::numbers::pi;

// A frustum of 2 in height, radius 1 below and 0.5 above.
PolygonSoup frustum(int n) {
  PolygonSoup soup = prism(n);
  for (fdcg::bake::Vec3& p : soup.points) {
    if (p.z > 0) p = {p.x / 2, p.y / 2, p.z};
  }
  soup.name = "frustum";
  return soup;
}

struct Case {
  const char* name;
  fdcg_surface surface;
  PolygonSoup (*mesh)(int level);
  Place (*point)(double u, double v);   // of the surface, at 0 <= u, v <= 1
  Place (*normal)(double u, double v);  // there
  bool is_hollow;
};

Place on_circle(double u) {
  return {std::cos(0.3 + 2 * u), std::sin(0.3 + 2 * u), 0};
}

const Case kCases[] = {
    {"sphere", fdcg_make_sphere(1), [](int level) { return geodesic_sphere(8 << level); },
     [](double u, double v) {
       const Place c = on_circle(u);
       const double z = 0.8 * v - 0.3, r = std::sqrt(1 - z * z);
       return Place{c[0] * r, c[1] * r, z};
     },
     [](double u, double v) {
       const Place c = on_circle(u);
       const double z = 0.8 * v - 0.3, r = std::sqrt(1 - z * z);
       return Place{c[0] * r, c[1] * r, z};
     },
     false},
    {"cylinder", fdcg_make_cylinder(1, 2), [](int level) { return prism(48 << level); },
     [](double u, double v) {
       const Place c = on_circle(u);
       return Place{c[0], c[1], 1.2 * v - 0.6};
     },
     [](double u, double) { return on_circle(u); }, false},
    {"frustum", fdcg_make_cone(1, 0.5, 2), [](int level) { return frustum(48 << level); },
     [](double u, double v) {
       const Place c = on_circle(u);
       const double z = 1.2 * v - 0.6, r = 0.75 - 0.25 * z;
       return Place{c[0] * r, c[1] * r, z};
     },
     [](double u, double) {
       const Place c = on_circle(u);
       const double l = std::hypot(2, 0.5);
       return Place{c[0] * 2 / l, c[1] * 2 / l, 0.5 / l};
     },
     false},
    {"torus", fdcg_make_torus(1, 0.4), [](int level) { return torus(48 << level, 24 << level, 0.4); },
     [](double u, double v) {
       const Place c = on_circle(u);
       const double a = 2.5 * v - 0.4, r = 1 + 0.4 * std::cos(a);
       return Place{c[0] * r, c[1] * r, 0.4 * std::sin(a)};
     },
     [](double u, double v) {
       const Place c = on_circle(u);
       const double a = 2.5 * v - 0.4;
       return Place{c[0] * std::cos(a), c[1] * std::cos(a), std::sin(a)};
     },
     false},
};

struct Errors {
  double size = 0;   // largest difference of |force|, newtons
  double place = 0;  // of the god-objects' means, metres
  double force = 0;  // of the forces' means
  int ticks = 0;
};

// A slide of `ticks` over the surface and the graph, at a depth.
Errors compare(const Case& a, const fdcg_graph& graph, double mu, double depth, int ticks) {
  SurfaceContact smooth(a.surface, mu, mu);
  Contact faceted(graph, contact_params(mu, mu));
  Errors errors;
  double places[3] = {}, forces[3] = {};
  for (int i = -1; i <= ticks; ++i) {
    const double t = i < 0 ? 0 : double(i) / ticks;
    const Place p = a.point(t, t), n = a.normal(t, t);
    const double out = i < 0 ? 0.05 : -depth;
    const Place hip = {p[0] + out * n[0], p[1] + out * n[1], p[2] + out * n[2]};
    smooth.step(hip);
    faceted.step(Hip{hip[0], hip[1], hip[2]});
    if (i < ticks / 5) continue;  // until both slide
    REQUIRE(smooth.result.state == FDCG_FACE);
    REQUIRE(faceted.result.state != FDCG_FREE);
    ++errors.ticks;
    double size[2] = {};
    for (int k = 0; k < 3; ++k) {
      places[k] += smooth.result.god_object_m[k] - faceted.result.god_object_m[k];
      forces[k] += smooth.result.force_n[k] - faceted.result.force_n[k];
      size[0] += smooth.result.force_n[k] * smooth.result.force_n[k];
      size[1] += faceted.result.force_n[k] * faceted.result.force_n[k];
    }
    errors.size = std::max(errors.size, std::abs(std::sqrt(size[0]) - std::sqrt(size[1])));
  }
  errors.place = std::sqrt(places[0] * places[0] + places[1] * places[1] + places[2] * places[2]) / errors.ticks;
  errors.force = std::sqrt(forces[0] * forces[0] + forces[1] * forces[1] + forces[2] * forces[2]) / errors.ticks;
  return errors;
}

}  // namespace

TEST_CASE("tessellations converge to the surface at second order") {
  constexpr int kLevels = 3, kTicks = 40000;
  for (const Case& a : kCases) {
    for (const double mu : {0.0, 0.3}) {
      Errors errors[kLevels];
      for (int level = 0; level < kLevels; ++level) {
        const CompiledMesh mesh(a.mesh(level));
        errors[level] = compare(a, mesh.view(), mu, 0.02, kTicks);
      }
      INFO(a.name << " mu " << mu << " size " << errors[0].size << " " << errors[1].size << " " << errors[2].size << " place "
                  << errors[0].place << " " << errors[1].place << " " << errors[2].place << " force " << errors[0].force << " "
                  << errors[1].force << " " << errors[2].force);
      const double order_size = std::log2(errors[0].size / errors[2].size) / 2;
      const double order_place = std::log2(errors[0].place / errors[2].place) / 2;
      const double order_force = std::log2(errors[0].force / errors[2].force) / 2;
      if (mu == 0) CHECK(order_size > 1.8);
      CHECK(order_place > 1.8);
      CHECK(order_force > 1.8);
    }
  }
}
