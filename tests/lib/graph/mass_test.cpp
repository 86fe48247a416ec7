// SPDX-License-Identifier: Apache-2.0
// Mass properties: against formulas, against rational arithmetic, and invariance under triangulation, rotation and translation.
// A few lines over 400: a list of solids with their mass.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kBar = 1e-12;

fdcg_mass mass_of(const PolygonSoup& soup, const bake::CompileOptions& options = {}) {
  const bake::Compiled compiled = compile_whole(soup, options);
  INFO(soup.name << ": " << compiled.no_mass);
  fdcg_graph graph;
  fdcg_error error;
  REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  fdcg_mass mass;
  REQUIRE(fdcg_get_mass(&graph, &mass, &error) == FDCG_OK);
  return mass;
}

// Within `bar` of each other, lengths by `size`, inertia by the largest entry.
void check_close(const fdcg_mass& a, const fdcg_mass& b, double size, double bar) {
  CHECK(std::abs(a.volume_m3 / b.volume_m3 - 1) <= bar);
  double largest = 0;
  for (const double x : b.inertia_per_density_m5)
    largest = std::max(largest, std::abs(x));
  for (int k = 0; k < 3; ++k)
    CHECK(std::abs(a.centroid_m[k] - b.centroid_m[k]) <= bar * size);
  for (int n = 0; n < 6; ++n)
    CHECK(std::abs(a.inertia_per_density_m5[n] - b.inertia_per_density_m5[n]) <= bar * largest);
}

fdcg_mass box_by_formula(double x, double y, double z, const Vec3& centre) {
  fdcg_mass mass{};
  mass.volume_m3 = x * y * z;
  mass.centroid_m[0] = centre.x, mass.centroid_m[1] = centre.y, mass.centroid_m[2] = centre.z;
  mass.inertia_per_density_m5[0] = mass.volume_m3 * (y * y + z * z) / 12;
  mass.inertia_per_density_m5[1] = mass.volume_m3 * (x * x + z * z) / 12;
  mass.inertia_per_density_m5[2] = mass.volume_m3 * (x * x + y * y) / 12;
  return mass;
}

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix tensor(const fdcg_mass& mass) {
  const double* const i = mass.inertia_per_density_m5;
  return {{{i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}}};
}

// What the formulas of rigid motion make of it: point -> rotation * point * scale + translation.
fdcg_mass carried(const fdcg_mass& mass, const Rotation& rotation, double scale, const Vec3& translation) {
  fdcg_mass moved = mass;
  moved.volume_m3 *= scale * scale * scale;
  const Vec3 at = rotated(rotation, {mass.centroid_m[0], mass.centroid_m[1], mass.centroid_m[2]});
  moved.centroid_m[0] = at.x * scale + translation.x;
  moved.centroid_m[1] = at.y * scale + translation.y;
  moved.centroid_m[2] = at.z * scale + translation.z;
  const Matrix i = tensor(mass);
  const auto entry = [&](int a, int b) {
    const auto row = [&](int n) {
      return std::array<double, 3>{rotation[static_cast<std::size_t>(n)].x, rotation[static_cast<std::size_t>(n)].y,
                                   rotation[static_cast<std::size_t>(n)].z};
    };
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < 3; ++l)
        sum += row(a)[k] * i[k][l] * row(b)[l];
    }
    return sum * std::pow(scale, 5);
  };
  const double entries[6] = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
  std::copy(std::begin(entries), std::end(entries), moved.inertia_per_density_m5);
  return moved;
}

// The exact moments in rationals, straight from the soup: tetrahedra from the first point, not from the origin.
fdcg_mass by_rationals(const PolygonSoup& soup) {
  using Point = std::array<mpq_class, 3>;
  const auto point = [&](std::uint32_t n) {
    const Vec3& p = soup.points[n];
    return Point{mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)};
  };
  const Point apex = point(0);
  mpq_class volume, first[3], second[3][3];
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const Polygon corners = face_corners(soup, f);
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const Point v[4] = {apex, point(corners[0]), point(corners[k - 1]), point(corners[k])};
      Point e[3];
      for (int i = 0; i < 3; ++i) {
        for (std::size_t d = 0; d < 3; ++d)
          e[i][d] = v[i + 1][d] - v[0][d];
      }
      const mpq_class part =
          (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
          6;
      volume += part;
      for (std::size_t d = 0; d < 3; ++d) {
        const mpq_class sum = v[0][d] + v[1][d] + v[2][d] + v[3][d];
        first[d] += part * sum / 4;
        for (std::size_t c = 0; c < 3; ++c) {
          mpq_class products = sum * (v[0][c] + v[1][c] + v[2][c] + v[3][c]);
          for (const Point& corner : v)
            products += corner[d] * corner[c];
          second[d][c] += part * products / 20;
        }
      }
    }
  }
  fdcg_mass mass{};
  mass.volume_m3 = volume.get_d();
  mpq_class covariance[3][3];
  for (int d = 0; d < 3; ++d) {
    mass.centroid_m[d] = mpq_class(first[d] / volume).get_d();
    for (int c = 0; c < 3; ++c)
      covariance[d][c] = second[d][c] - first[d] * first[c] / volume;
  }
  for (int d = 0; d < 3; ++d)
    mass.inertia_per_density_m5[d] =
        mpq_class(covariance[(d + 1) % 3][(d + 1) % 3] + covariance[(d + 2) % 3][(d + 2) % 3]).get_d();
  mass.inertia_per_density_m5[3] = -covariance[0][1].get_d();
  mass.inertia_per_density_m5[4] = -covariance[0][2].get_d();
  mass.inertia_per_density_m5[5] = -covariance[1][2].get_d();
  return mass;
}

PolygonSoup tetrahedron(double a, double b, double c) {
  return make_soup("tetrahedron", {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
}

PolygonSoup joined(const PolygonSoup& a, const PolygonSoup& b, bool turn_second) {
  std::vector<Vec3> points = a.points;
  points.insert(points.end(), b.points.begin(), b.points.end());
  std::vector<Polygon> faces;
  for (std::size_t f = 0; f < a.face_count(); ++f)
    faces.push_back(face_corners(a, f));
  for (std::size_t f = 0; f < b.face_count(); ++f) {
    Polygon corners = face_corners(b, f);
    for (std::uint32_t& corner : corners)
      corner += static_cast<std::uint32_t>(a.points.size());
    if (turn_second) std::reverse(corners.begin(), corners.end());
    faces.push_back(corners);
  }
  return make_soup(a.name + " and " + b.name, points, faces);
}

std::vector<PolygonSoup> solids() {
  return {cube(),
          grid_box(3, 4, 5, {1, 2, 3}),
          thin_plate(1e-6, 4),
          l_prism(),
          corner_pit(),
          v_groove(1.0),
          wedge(0.01),
          cone(64),
          cone_pit(40),
          prism(64),
          ico_sphere(3),
          uv_sphere(20, 10),
          torus(30, 20),
          star_sphere(3, 0.3, 1),
          spiky_sphere(2, 0.5, 4)};
}

bake::Result<bake::Compiled> with_density(const PolygonSoup& soup, std::set<std::string> allow = {}) {
  bake::CompileOptions options;
  options.density_kg_per_m3 = 1000;
  options.allow = std::move(allow);
  return bake::compile(soup, options);
}

}  // namespace

TEST_CASE("mass of boxes, tetrahedra and prisms is that of the formulas") {
  check_close(mass_of(cube()), box_by_formula(1, 1, 1, {}), 1, kBar);
  check_close(mass_of(moved(grid_box(3, 4, 5, {1, 2, 3}), {100, -7, 0.1})), box_by_formula(1, 2, 3, {100, -7, 0.1}), 100, kBar);
  check_close(mass_of(thin_plate(1e-6, 4)), box_by_formula(1, 1, 1e-6, {}), 1, kBar);

  const double a = 0.3, b = 1.7, c = 2.9, volume = a * b * c / 6;
  fdcg_mass corner{};
  corner.volume_m3 = volume;
  const double side[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    const double y = side[(k + 1) % 3], z = side[(k + 2) % 3];
    corner.centroid_m[k] = side[k] / 4;
    corner.inertia_per_density_m5[k] = volume * (y * y + z * z) * 3 / 80;
    corner.inertia_per_density_m5[5 - k] = volume * y * z / 80;  // about the centroid the products are minus y z / 80
  }
  check_close(mass_of(tetrahedron(a, b, c)), corner, 1, kBar);

  for (const int n : {3, 5, 64}) {  // a regular n-gon of radius 1 from z = -1 to 1
    const double angle = 2 * 3.14159265358979323846 / n, area = n * std::sin(angle) / 2;
    fdcg_mass prism_mass{};
    prism_mass.volume_m3 = 2 * area;
    const double polar = area * (2 + std::cos(angle)) / 6;
    prism_mass.inertia_per_density_m5[0] = prism_mass.inertia_per_density_m5[1] = 2 * (polar / 2) + 2 * area / 3;
    prism_mass.inertia_per_density_m5[2] = 2 * polar;
    CAPTURE(n);
    check_close(mass_of(prism(n)), prism_mass, 1, kBar);
  }
}

TEST_CASE("mass of any polyhedron is that of rational arithmetic") {
  for (const PolygonSoup& soup : solids()) {
    CAPTURE(soup.name);
    const PolygonSoup cut = triangulated(soup, 1);  // so that every face is planar, and there is one answer
    check_close(mass_of(cut), by_rationals(cut), 1, 1e-15);
    const PolygonSoup short_numbers = rounded_to_float(cut);  // summed in another width
    check_close(mass_of(short_numbers), by_rationals(short_numbers), 1, 1e-15);
  }
}

TEST_CASE("a finer sphere of triangles comes nearer to the ball's volume and inertia, at second order") {
  constexpr double kBall = 4.18879020478639098462;
  double last = 0;
  for (const int level : {2, 3, 4, 5}) {
    const fdcg_mass mass = mass_of(ico_sphere(level));
    const double off = kBall - mass.volume_m3;
    CHECK(off > 0);
    if (last != 0) CHECK(last / off == Approx(4).epsilon(0.03));
    last = off;
    CHECK(mass.inertia_per_density_m5[0] == Approx(0.4 * kBall).epsilon(3 * off / kBall));
  }
}

TEST_CASE("mass does not depend on the triangulation") {
  for (const PolygonSoup& soup : {cube(), grid_box(3, 4, 5, {1, 2, 3}), l_prism(), corner_pit(), thin_plate(0.25, 4)}) {
    CAPTURE(soup.name);
    const fdcg_mass whole = mass_of(soup);
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const fdcg_mass cut = mass_of(subdivided(triangulated(soup, seed), seed));
      CHECK(std::memcmp(&cut, &whole, sizeof whole) == 0);  // the same solid exactly, so the same bits
    }
  }
  bake::CompileOptions unmerged, derived, one_job;
  unmerged.merge = false;
  derived.store_planes = false;
  one_job.jobs = 1;
  const fdcg_mass whole = mass_of(star_sphere(4, 0.3, 1));
  for (const bake::CompileOptions& options : {unmerged, derived, one_job}) {
    const fdcg_mass again = mass_of(star_sphere(4, 0.3, 1), options);
    CHECK(std::memcmp(&again, &whole, sizeof whole) == 0);
  }
}

TEST_CASE("mass properties transform with the mesh") {
  for (const PolygonSoup& soup : solids()) {
    const fdcg_mass still = mass_of(triangulated(soup));
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      CAPTURE(soup.name, seed);
      const Rotation rotation = random_rotation(seed);
      const Vec3 away{3, -20, 0.7};
      const double scale = seed == 1 ? 0.01 : 1;
      // turned coordinates are rounded: of a plate of 1e-6 that shows
      const double bar = soup.name.find("plate") != std::string::npos   ? 1e-7
                         : soup.name.find("wedge") != std::string::npos ? 1e-10
                                                                        : kBar;
      check_close(mass_of(transformed(triangulated(soup), rotation, scale, away)), carried(still, rotation, scale, away), 20,
                  bar);
    }
  }
}

TEST_CASE("the unit scales mass properties by its third and fifth power") {
  bake::CompileOptions in_mm;
  in_mm.metres_per_unit = 0.001;
  const PolygonSoup soup = star_sphere(2, 0.3, 9);
  check_close(mass_of(soup, in_mm), carried(mass_of(soup), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0.001, {}), 1e-3, kBar);
}

TEST_CASE("two solids weigh the sum, with the parallel-axis theorem; a cavity is taken away") {
  const PolygonSoup a = star_sphere(2, 0.2, 1), b = moved(torus(20, 12), {4, 1, -2});
  const fdcg_mass ma = mass_of(a), mb = mass_of(b), both = mass_of(joined(a, b, false));
  const auto check_sum = [](const fdcg_mass& one, const fdcg_mass& other, double sign, const fdcg_mass& total) {
    fdcg_mass sum{};
    sum.volume_m3 = one.volume_m3 + sign * other.volume_m3;
    for (int k = 0; k < 3; ++k)
      sum.centroid_m[k] = (one.volume_m3 * one.centroid_m[k] + sign * other.volume_m3 * other.centroid_m[k]) / sum.volume_m3;
    const auto add = [&](const fdcg_mass& part, double weight) {
      double d[3];
      for (int k = 0; k < 3; ++k)
        d[k] = part.centroid_m[k] - sum.centroid_m[k];
      const double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
      for (int n = 0; n < 6; ++n) {
        const double shift = (row[n] == column[n] ? d2 : 0) - d[row[n]] * d[column[n]];
        sum.inertia_per_density_m5[n] += weight * (part.inertia_per_density_m5[n] + part.volume_m3 * shift);
      }
    };
    add(one, 1);
    add(other, sign);
    check_close(total, sum, 1, kBar);
  };
  check_sum(ma, mb, 1, both);
  const PolygonSoup hole = moved(scaled(cube(), 0.25), {0.125, 0, 0});
  check_sum(mass_of(cube()), mass_of(hole), -1, mass_of(joined(cube(), hole, true)));
}

TEST_CASE("coordinates that span hundreds of bits are summed exactly") {
  const PolygonSoup soup =
      make_soup("octahedron", {{1, 1e-200, 0}, {-1, 0, 1e-200}, {0, 1, 0}, {0, -1, 1e-100}, {0, 0, 1}, {0, 0, -1}},
                {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
  const fdcg_mass mass = mass_of(soup);
  CHECK(mass.volume_m3 == 4.0 / 3);
  check_close(mass, by_rationals(soup), 1e-100, 1e-15);  // even the centroid, some 1e-101 from the middle
  CHECK(mass_of(scaled(cube(), 1e-50)).volume_m3 == Approx(1e-150).epsilon(kBar));
  CHECK(mass_of(scaled(cube(), 1e50)).inertia_per_density_m5[0] == Approx(1e250 / 6).epsilon(kBar));
}

TEST_CASE("triangles with lower bits than others are summed as exactly") {
  for (const double small : {0x1p-12, 0x1p-60, 0x1p-400}) {  // beside coordinates near one: on each of the three grids
    PolygonSoup soup = triangulated(star_sphere(4, 0.3, 1), 1);
    int moved_points = 0;
    for (Vec3& p : soup.points) {
      if (std::abs(p.y) > 0.05) continue;
      p.y *= small;
      ++moved_points;
    }
    CAPTURE(small);
    REQUIRE(moved_points > 10);
    check_close(mass_of(soup), by_rationals(soup), 1, 1e-15);
  }
}

TEST_CASE("density and mass determine each other, and the given one is stored exactly") {
  bake::CompileOptions options;
  CHECK(mass_of(cube()).mass_kg == 0);
  CHECK(mass_of(cube()).density_kg_per_m3 == 0);
  options.metres_per_unit = 0.01;
  options.density_kg_per_m3 = 7850;
  CHECK(mass_of(cube(), options).density_kg_per_m3 == 7850);
  CHECK(mass_of(cube(), options).mass_kg == Approx(7850e-6).epsilon(1e-15));
  options.density_kg_per_m3 = 0;
  options.mass_kg = 0.3;
  CHECK(mass_of(cube(), options).mass_kg == 0.3);
  CHECK(mass_of(cube(), options).density_kg_per_m3 == Approx(0.3e6).epsilon(1e-15));
}

TEST_CASE("an open mesh has no mass section but a reason; with a density it is refused") {
  PolygonSoup inside_out = cube();
  std::reverse(inside_out.corners.begin(), inside_out.corners.end());
  const struct {
    PolygonSoup soup;
    std::set<std::string> allow;
    const char* reason;
  } cases[] = {{plane_quad(), {}, "the mesh is not closed: 4 edges have"},
               {joined(cube(), moved(plane_grid(2, 2), {3, 0, 0}), false), {}, "the mesh is not closed: 8 edges have"},
               {inside_out, {"inside-out"}, "1 closed patch is inside out"}};
  for (const auto& [soup, allow, reason] : cases) {
    bake::CompileOptions options;
    options.allow = allow;
    const bake::Compiled compiled = compile_whole(soup, options);
    CHECK(compiled.no_mass.find(reason) == 0);
    fdcg_graph graph;
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    fdcg_mass mass;
    CHECK(fdcg_get_mass(&graph, &mass, &error) == FDCG_E_ABSENT);
    CHECK(std::string(error.message).find("fdcg inspect") != std::string::npos);
    const auto refused = with_density(soup, allow);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().exit_code == 1);
    CHECK(refused.error().message.find(reason) != std::string::npos);
  }
  CHECK(with_density(cube()));
}

TEST_CASE("options about mass that make no sense are refused") {
  const auto code = [](auto change) {
    bake::CompileOptions options;
    change(options);
    const auto compiled = bake::compile(cube(), options);
    return compiled ? 0 : compiled.error().exit_code;
  };
  using Options = bake::CompileOptions;
  CHECK(code([](Options& o) { o.density_kg_per_m3 = -1; }) == 2);
  CHECK(code([](Options& o) { o.mass_kg = 1e31; }) == 2);
  CHECK(code([](Options& o) { o.density_kg_per_m3 = o.mass_kg = 1; }) == 2);
  CHECK(code([](Options& o) { o.density_kg_per_m3 = 1, o.without = {"mass"}; }) == 2);
  CHECK(code([](Options& o) { o.without = {"mass"}; }) == 0);
}

TEST_CASE("impossible mass properties are refused by full verification and by the reader of a trusted file") {
  const bake::Compiled compiled = compile_whole(cube());
  const auto damaged = [&](std::size_t at, double value) {
    AlignedBytes file(compiled.bytes);
    const auto& section = reinterpret_cast<const fdcg_section*>(&file.header() + 1)[file.header().section_count - 1];
    REQUIRE(section.id == FDCG_SECTION_MASS);
    std::memcpy(file.data() + section.offset + at, &value, sizeof value);
    seal(file);
    fdcg_graph graph;
    fdcg_error error;
    const fdcg_status full = fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error);
    REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_TRUSTED, &graph, &error) == FDCG_OK);
    fdcg_mass mass;
    const fdcg_status read = fdcg_get_mass(&graph, &mass, &error);
    CHECK(read == full);
    return full;
  };
  CHECK(damaged(0, 1) == FDCG_OK);
  for (const double value : {0.0, -1.0, std::nan(""), HUGE_VAL})
    CHECK(damaged(offsetof(fdcg_mass_record, volume), value) == FDCG_E_GRAPH);
  CHECK(damaged(offsetof(fdcg_mass_record, centroid), std::nan("")) == FDCG_E_GRAPH);
  for (const double value : {0.0, -1.0, 0.34, std::nan("")})  // 1/6 each: none may be more than the other two
    CHECK(damaged(offsetof(fdcg_mass_record, inertia), value) == FDCG_E_GRAPH);
  for (const double value : {0.09, -0.09, std::nan("")})
    CHECK(damaged(offsetof(fdcg_mass_record, inertia) + 40, value) == FDCG_E_GRAPH);
  CHECK(damaged(offsetof(fdcg_mass_record, density_kg_per_m3), 1) == FDCG_E_GRAPH);
  CHECK(damaged(offsetof(fdcg_mass_record, mass_kg), -1) == FDCG_E_GRAPH);
  CHECK(damaged(offsetof(fdcg_mass_record, deviation), -1) == FDCG_E_GRAPH);
}
