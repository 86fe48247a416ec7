// SPDX-License-Identifier: Apache-2.0
// What a surface may be, what is said of one that may not, and what each solid weighs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "catch.hpp"
#include "compiled.hpp"
#include "fdcg/surface.h"
#include "meshes.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

std::string refused(const fdcg_surface& surface) {
  fdcg_error error = {};
  CHECK(fdcg_check_surface(&surface, &error) == FDCG_E_ARGUMENT);
  return error.message;
}

fdcg_mass mass_of(const fdcg_surface& surface) {
  fdcg_mass mass;
  fdcg_error error;
  if (fdcg_surface_get_mass(&surface, &mass, &error) != FDCG_OK) FAIL(error.message);
  return mass;
}

// By slices across z: volume, centroid and inertia of a body of revolution of this radius, per density.
template <class RadiusAt>
void check_revolved(const fdcg_mass& mass, double from, double to, RadiusAt radius_at, double inner = 0) {
  constexpr int kSlices = 200000;
  long double volume = 0, first = 0, second = 0, round = 0;
  const long double dz = (static_cast<long double>(to) - from) / kSlices;
  for (int i = 0; i < kSlices; ++i) {
    const long double z = from + (i + 0.5L) * dz, outer = radius_at(z), inside = inner > 0 ? 2 * inner - outer : 0;
    const long double area = 3.14159265358979323846L * (outer * outer - inside * inside) * dz;
    volume += area;
    first += area * z;
    second += area * z * z;
    round += area * (outer * outer + inside * inside) / 2;
  }
  const double bar = 1e-7;
  CHECK(mass.volume_m3 == Approx(static_cast<double>(volume)).epsilon(bar));
  CHECK(mass.centroid_m[2] == Approx(static_cast<double>(first / volume)).margin(1e-12));
  CHECK(mass.inertia_per_density_m5[0] ==
        Approx(static_cast<double>(round / 2 + second - first * first / volume)).epsilon(bar));
  CHECK(mass.inertia_per_density_m5[1] == mass.inertia_per_density_m5[0]);
  CHECK(mass.inertia_per_density_m5[2] == Approx(static_cast<double>(round)).epsilon(bar));
}

}  // namespace

TEST_CASE("every maker makes a surface that is accepted") {
  for (const fdcg_surface& surface :
       {fdcg_make_plane(), fdcg_make_sphere(1), fdcg_make_cylinder(1, 2), fdcg_make_capsule(1, 0), fdcg_make_box(1, 2, 3),
        fdcg_make_cone(1, 0, 2), fdcg_make_cone(0, 1, 2), fdcg_make_torus(2, 1), fdcg_make_ellipsoid(1, 2, 3)}) {
    fdcg_error error;
    if (fdcg_check_surface(&surface, &error) != FDCG_OK) FAIL(error.message);
  }
}

TEST_CASE("an invalid surface is refused with field, value and limit") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refused(fdcg_make_sphere(0)).find("surface.radius_m is 0, allowed") == 0);
  CHECK(refused(fdcg_make_sphere(-1)).find("surface.radius_m is -1") == 0);
  CHECK(refused(fdcg_make_sphere(1e10)).find("surface.radius_m") == 0);
  CHECK(refused(fdcg_make_sphere(kNan)).find("surface.radius_m") == 0);
  CHECK(refused(fdcg_make_cylinder(1, 1e-5)).find("surface.length_m") == 0);
  CHECK(refused(fdcg_make_capsule(1, kNan)).find("surface.length_m") == 0);
  CHECK(refused(fdcg_make_cone(0, 0, 1)).find("surface.radius_m") == 0);
  CHECK(refused(fdcg_make_cone(1, kNan, 1)).find("surface.top_radius_m") == 0);
  CHECK(refused(fdcg_make_torus(1, 1)).find("surface.tube_radius_m is 1, allowed ") == 0);
  CHECK(refused(fdcg_make_box(1, 1, 0)).find("surface.half_m[2]") == 0);
  CHECK(refused(fdcg_make_ellipsoid(1, kNan, 1)).find("surface.half_m[1]") == 0);
  fdcg_surface surface = fdcg_make_sphere(1);
  surface.length_m = 1;
  CHECK(refused(surface) == "surface.length_m is 1, allowed 0; a surface of this kind has none");
  surface = fdcg_make_sphere(1);
  surface.kind = 8;
  CHECK(refused(surface).find("surface.kind is 8") == 0);
  surface = fdcg_make_sphere(1);
  surface.is_hollow = 2;
  CHECK(refused(surface).find("surface.is_hollow is 2") == 0);
  surface = fdcg_make_plane();
  surface.is_hollow = 1;
  CHECK(refused(surface).find("surface.is_hollow is 1") == 0);
  surface = fdcg_make_sphere(1);
  surface.reserved = 1;
  CHECK(refused(surface).find("surface.reserved is 1") == 0);
  surface.struct_bytes = 12;
  CHECK(refused(surface).find("surface.struct_bytes is 12") == 0);
  fdcg_error error;
  CHECK(fdcg_check_surface(nullptr, &error) == FDCG_E_ARGUMENT);
}

TEST_CASE("the range in a surface's error message is the accepted one") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
  const struct {
    fdcg_surface surface;
    const char* words;
  } cases[] = {
      {fdcg_make_capsule(1, -1), "surface.length_m is -1, allowed 0 and 1e-9 to 1e9"},
      {fdcg_make_capsule(1, 5e-5),
       "surface.length_m is 5e-5, allowed 0 and 1e-4 to 1e9 (at least 1e-4 of the largest, radius_m, 1)"},
      {fdcg_make_capsule(0, 1), "surface.radius_m is 0, allowed 1e-9 to 1e9"},
      {fdcg_make_cylinder(0.1, kInfinity), "surface.length_m is infinite, allowed 1e-9 to 1e9"},
      {fdcg_make_cylinder(0.1, 2e9), "surface.length_m is 2e9, allowed 1e-9 to 1e9"},
      {fdcg_make_cylinder(kNan, 1), "surface.radius_m is NaN, allowed 1e-9 to 1e9"},
      {fdcg_make_cone(0, -1, 1), "surface.top_radius_m is -1, allowed 1e-9 to 1e9"},
      {fdcg_make_cone(1, -1, 1), "surface.top_radius_m is -1, allowed 0 and 1e-9 to 1e9"},
      {fdcg_make_cone(0, 0, 1), "surface.radius_m is 0, allowed 1e-9 to 1e9 (one end may be a point, not both)"},
      {fdcg_make_cone(1, 0, 0), "surface.length_m is 0, allowed 1e-9 to 1e9"},
      {fdcg_make_torus(1, 1), "surface.tube_radius_m is 1, allowed 1e-9 to 0.9999"},
      {fdcg_make_torus(1, 1e-5),
       "surface.tube_radius_m is 1e-5, allowed 1e-4 to 0.9999 (at least 1e-4 of the largest, radius_m, 1)"},
      {fdcg_make_box(1e9, 1, 1),
       "surface.half_m[1] is 1, allowed 100000 to 1e9 (at least 1e-4 of the largest, half_m[0], 1e9)"},
      {fdcg_make_ellipsoid(1, 1, 1e-10), "surface.half_m[2] is 1e-10, allowed 1e-9 to 1e9"},
  };
  for (const auto& one : cases)
    CHECK(refused(one.surface) == one.words);
  fdcg_error error;
  for (const fdcg_surface& limit :
       {fdcg_make_capsule(1, 0), fdcg_make_capsule(1, 1e-4), fdcg_make_torus(1, 0.9999), fdcg_make_torus(1, 1e-4),
        fdcg_make_box(1e9, 1e5, 1e5), fdcg_make_sphere(1e-9), fdcg_make_cone(0, 1e-9, 1e-9)})
    CHECK(fdcg_check_surface(&limit, &error) == FDCG_OK);
}

TEST_CASE("a surface's mass is that of its slices") {
  check_revolved(mass_of(fdcg_make_sphere(0.7)), -0.7, 0.7, [](long double z) { return std::sqrt(0.49L - z * z); });
  check_revolved(mass_of(fdcg_make_cylinder(0.3, 1.1)), -0.55, 0.55, [](long double) { return 0.3L; });
  check_revolved(mass_of(fdcg_make_cone(0.5, 0.2, 0.8)), -0.4, 0.4, [](long double z) { return 0.35L - 0.375L * z; });
  check_revolved(mass_of(fdcg_make_cone(0, 0.6, 0.9)), -0.45, 0.45, [](long double z) { return 0.3L + 0.6L / 0.9L * z; });
  check_revolved(mass_of(fdcg_make_capsule(0.3, 0.8)), -0.7, 0.7, [](long double z) {
    const long double over = std::max(0.0L, std::abs(z) - 0.4L);
    return std::sqrt(std::max(0.0L, 0.09L - over * over));
  });
  check_revolved(
      mass_of(fdcg_make_torus(1, 0.4)), -0.4, 0.4, [](long double z) { return 1 + std::sqrt(0.16L - z * z); }, 1);
  const fdcg_mass ball = mass_of(fdcg_make_ellipsoid(0.7, 0.7, 0.7)), same = mass_of(fdcg_make_sphere(0.7));
  CHECK(ball.volume_m3 == Approx(same.volume_m3).epsilon(1e-14));
  for (int k = 0; k < 3; ++k)
    CHECK(ball.inertia_per_density_m5[k] == Approx(same.inertia_per_density_m5[k]).epsilon(1e-14));
}

TEST_CASE("a box has the mass of its mesh to 1e-14") {
  const bake::Compiled compiled = compile_whole(grid_box(1, 2, 3, {0.3, 0.5, 0.7}), {});
  fdcg_graph graph;
  fdcg_error error;
  REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  fdcg_mass meshed;
  REQUIRE(fdcg_get_mass(&graph, &meshed, &error) == FDCG_OK);
  const fdcg_mass mass = mass_of(fdcg_make_box(0.15, 0.25, 0.35));
  CHECK(mass.volume_m3 == Approx(meshed.volume_m3).epsilon(1e-14));
  for (int k = 0; k < 3; ++k)
    CHECK(mass.inertia_per_density_m5[k] == Approx(meshed.inertia_per_density_m5[k]).epsilon(1e-14));
}

TEST_CASE("infinite surfaces have no mass") {
  fdcg_surface cavity = fdcg_make_sphere(1);
  cavity.is_hollow = 1;
  for (const fdcg_surface& surface : {fdcg_make_plane(), cavity}) {
    fdcg_mass mass;
    fdcg_error error;
    CHECK(fdcg_surface_get_mass(&surface, &mass, &error) == FDCG_E_ABSENT);
    CHECK(mass.volume_m3 == 0);
  }
}
