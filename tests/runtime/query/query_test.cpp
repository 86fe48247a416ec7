// SPDX-License-Identifier: Apache-2.0
// Nearest places, sides and rays on bodies whose answers are known, at corners, on edges and beyond; what a contact is on.
#include "fdcg/query.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "compiled.hpp"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Opened {
  bake::Compiled compiled;
  fdcg_graph graph{};
  explicit Opened(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {})
      : compiled(compile_whole(soup, options)) {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK);
  }
};

fdcg_surface_hit nearest(const fdcg_graph& graph, double x, double y, double z) {
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  const double point[3] = {x, y, z};
  fdcg_error error = {};
  INFO(error.message);
  REQUIRE(fdcg_find_nearest(&graph, point, HUGE_VAL, &hit, &error) == FDCG_OK);
  return hit;
}

double signed_distance(const fdcg_graph& graph, double x, double y, double z) {
  const double point[3] = {x, y, z};
  double distance = 0;
  fdcg_error error;
  REQUIRE(fdcg_get_signed_distance(&graph, point, &distance, &error) == FDCG_OK);
  return distance;
}

// Of the cube of side 1 around the origin.
double distance_to_cube(double x, double y, double z) {
  const double at[3] = {std::abs(x) - 0.5, std::abs(y) - 0.5, std::abs(z) - 0.5};
  double outside2 = 0, inside = -HUGE_VAL;
  for (const double a : at) {
    outside2 += a > 0 ? a * a : 0;
    inside = std::max(inside, a);
  }
  return outside2 > 0 ? std::sqrt(outside2) : inside;
}

}  // namespace

TEST_CASE("query: the nearest place of a cube is inside a face, on an edge or at a corner, and has its distance and side") {
  for (const bool is_merged : {true, false}) {
    bake::CompileOptions options;
    options.merge = is_merged;
    for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
      options.precision = precision;
      const Opened box(cube(), options);
      const double eps = precision == bake::Precision::f64 ? 0x1p-52 : 0x1p-23;
      CHECK(nearest(box.graph, 0.1, 0.2, 0.9).side == 1);
      const fdcg_surface_hit face = nearest(box.graph, 0.1, 0.2, 0.9);
      CHECK(face.point_m[2] == 0.5);
      CHECK(face.normal[2] == 1);
      const fdcg_surface_hit edge = nearest(box.graph, 0.1, 0.9, 0.9);
      CHECK(edge.state == FDCG_EDGE);
      CHECK(edge.normal[1] == Approx(std::sqrt(0.5)));
      const fdcg_surface_hit corner = nearest(box.graph, 0.7, 0.7, 0.7);
      CHECK(corner.state == FDCG_VERTEX);
      CHECK(corner.normal[0] == Approx(std::sqrt(1 / 3.0)).epsilon(1e-3));
      Random random(3);
      for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-2, 2), y = random.uniform(-2, 2), z = random.uniform(-2, 2);
        CHECK(std::abs(signed_distance(box.graph, x, y, z) - distance_to_cube(x, y, z)) <= 4 * eps);
      }
    }
  }
}

TEST_CASE("query: the side is right at corners that are neither pointed nor pits") {
  const Opened saddle(saddle_block());
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    const bake::Vec3 d = random.direction();
    const double r = random.uniform(1e-6, 0.2), p[3] = {r * d.x, r * d.y, r * d.z};
    std::int32_t is_inside = -1;
    fdcg_error error;
    REQUIRE(fdcg_is_inside(&saddle.graph, p, &is_inside, &error) == FDCG_OK);
    // A ray straight down meets the block's floor: as many faces before it as decide the side.
    int crossings = 0;
    double from[3] = {p[0], p[1], p[2]};
    const double down[3] = {0, 0, -1};
    fdcg_surface_hit hit = fdcg_make_surface_hit();
    int side = 0;
    while (fdcg_cast_ray(&saddle.graph, from, down, HUGE_VAL, &hit, &error) == FDCG_OK && ++crossings < 20) {
      if (crossings == 1) side = hit.side;
      from[2] = hit.point_m[2] - 1e-9;
    }
    CHECK(is_inside == (side < 0 ? 1 : 0));
    CHECK(is_inside == crossings % 2);
  }
}

TEST_CASE("query: a ray through an edge or a corner of a watertight mesh does not slip through") {
  for (const bake::PolygonSoup& soup : {ico_sphere(2), triangulated(cube()), cone(200), torus(40, 20)}) {
    const Opened body(soup);
    INFO(soup.name);
    Random random(11);
    const double* const low = body.graph.header->bounds_min;
    const double* const high = body.graph.header->bounds_max;
    for (std::uint32_t c = 0; c < body.graph.header->connection_count; ++c) {
      const fdcg_connection_info edge = fdcg_get_connection(&body.graph, c);
      const fdcg_corner_info a = fdcg_get_corner(&body.graph, edge.corner[0]), b = fdcg_get_corner(&body.graph, edge.corner[1]);
      for (const double share : {0.0, 0.5, random.uniform(0, 1)}) {
        double from[3], to[3], direction[3];
        const bake::Vec3 away = random.direction();
        const double far = 3 * (std::abs(high[0] - low[0]) + 1), out[3] = {away.x, away.y, away.z};
        for (int k = 0; k < 3; ++k) {
          to[k] = a.point[k] + share * (b.point[k] - a.point[k]) + body.graph.header->origin[k];
          from[k] = to[k] + far * out[k];
          direction[k] = to[k] - from[k];
        }
        fdcg_surface_hit hit = fdcg_make_surface_hit();
        fdcg_error error;
        const fdcg_status status = fdcg_cast_ray(&body.graph, from, direction, HUGE_VAL, &hit, &error);
        // Rounding of the direction may pass a silhouette by; else what is met is met from outside, or where it aims at.
        const bool is_there = status == FDCG_OK && std::abs(hit.distance_m - far) < 1e-12;
        if (status == FDCG_OK && !is_there) CHECK(hit.side == 1);
        double distance = 1;
        REQUIRE(fdcg_get_signed_distance(&body.graph, to, &distance, &error) == FDCG_OK);
        CHECK(std::abs(distance) < 1e-14);
      }
    }
  }
}

TEST_CASE("query: a ray from inside a watertight mesh always meets it, wherever it goes") {
  for (const bake::PolygonSoup& soup : {ico_sphere(4), triangulated(cube()), cone(2000)}) {
    const Opened body(soup);
    INFO(soup.name);
    for (std::uint32_t c = 0; c < body.graph.header->corner_count; ++c) {
      const fdcg_corner_info corner = fdcg_get_corner(&body.graph, c);
      double from[3], direction[3];
      for (int k = 0; k < 3; ++k) {
        from[k] = k == 2 ? -0.25 : 0.125;
        direction[k] = corner.point[k] + body.graph.header->origin[k] - from[k];
      }
      fdcg_surface_hit hit = fdcg_make_surface_hit();
      fdcg_error error;
      CHECK(fdcg_cast_ray(&body.graph, from, direction, HUGE_VAL, &hit, &error) == FDCG_OK);
      CHECK(hit.side == -1);
    }
  }
}

TEST_CASE("query: what is out of reach is absent, and what is no number is refused") {
  const Opened box(cube());
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_error error;
  const double far[3] = {0, 0, 2}, down[3] = {0, 0, -3}, up[3] = {0, 0, 1}, none[3] = {0, 0, 0};
  CHECK(fdcg_find_nearest(&box.graph, far, 1.49, &hit, &error) == FDCG_E_ABSENT);
  CHECK(fdcg_find_nearest(&box.graph, far, 1.5, &hit, &error) == FDCG_OK);
  CHECK(fdcg_cast_ray(&box.graph, far, down, 1.49, &hit, &error) == FDCG_E_ABSENT);
  REQUIRE(fdcg_cast_ray(&box.graph, far, down, 1.51, &hit, &error) == FDCG_OK);
  CHECK(hit.distance_m == Approx(1.5));
  CHECK(fdcg_cast_ray(&box.graph, far, up, HUGE_VAL, &hit, &error) == FDCG_E_ABSENT);
  CHECK(fdcg_cast_ray(&box.graph, far, none, HUGE_VAL, &hit, &error) == FDCG_E_ARGUMENT);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, HUGE_VAL, 1e200}) {
    const double at[3] = {0, bad, 0};
    double distance;
    CHECK(fdcg_get_signed_distance(&box.graph, at, &distance, &error) == FDCG_E_ARGUMENT);
    CHECK(fdcg_cast_ray(&box.graph, at, down, 1, &hit, &error) == FDCG_E_ARGUMENT);
  }
  CHECK(fdcg_find_nearest(&box.graph, far, -1, &hit, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_find_nearest(&box.graph, far, nan, &hit, &error) == FDCG_E_ARGUMENT);
  fdcg_surface_hit zero = {};
  CHECK(fdcg_find_nearest(&box.graph, far, 9, &zero, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("fdcg_make_surface_hit"));
  const double million[3] = {1e6, 0, 0};
  CHECK(nearest(box.graph, 1e6, 0, 0).distance_m == Approx(1e6 - 0.5));
  REQUIRE(fdcg_cast_ray(&box.graph, million, none, 1, &hit, &error) == FDCG_E_ARGUMENT);
}

TEST_CASE("query: a contact's info has normal, weights, source face and slip") {
  const Opened box(triangulated(cube()));
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {};
  fdcg_result before = {}, now = {};
  std::vector<std::uint32_t> source(box.graph.header->node_count);
  fdcg_error error;
  REQUIRE(fdcg_invert_source_map(&box.graph, source.data(), box.graph.header->node_count, &error) == FDCG_OK);
  fdcg_contact_info info = fdcg_make_contact_info();
  std::uint32_t events = 0;
  double slid = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double hip[3] = {-0.2 + 0.001 * tick, 0.1, tick == 0 ? 0.6 : 0.49};
    before = now;
    fdcg_step(&box.graph, &params, &contact, hip, &now);
    REQUIRE(fdcg_get_contact_info(&box.graph, source.data(), tick == 0 ? nullptr : &before, &now, 0.001, &info, &error) ==
            FDCG_OK);
    CHECK(info.events == fdcg_get_contact_events(tick == 0 ? nullptr : &before, &now));
    events |= info.events;
    if (now.state == FDCG_FREE) {
      CHECK(info.node == FDCG_NONE);
      continue;
    }
    CHECK(info.normal[2] == 1);
    REQUIRE(info.source_face < box.graph.header->source_face_count);
    CHECK(box.graph.source_map[info.source_face] == info.node);
    double at[3] = {0, 0, 0}, sum = 0;
    for (int c = 0; c < 3 && info.corners[c] != FDCG_NONE; ++c) {
      CHECK(info.weights[c] >= 0);
      sum += info.weights[c];
      const fdcg_corner_info corner = fdcg_get_corner(&box.graph, info.corners[c]);
      for (int k = 0; k < 3; ++k)
        at[k] += info.weights[c] * (corner.point[k] + box.graph.header->origin[k]);
    }
    CHECK(sum == Approx(1));
    for (int k = 0; k < 3; ++k)
      CHECK(at[k] == Approx(now.god_object_m[k]).margin(1e-12));
    slid += info.slip_m_per_s[0] * 0.001;
  }
  CHECK((events & FDCG_EVENT_BEGAN) != 0);
  CHECK((events & FDCG_EVENT_SLIP_BEGAN) != 0);
  CHECK((events & FDCG_EVENT_ENDED) == 0);
  CHECK(slid > 0.15);
  const double above[3] = {0, 0, 0.7};
  before = now;
  fdcg_step(&box.graph, &params, &contact, above, &now);
  CHECK(fdcg_get_contact_events(&before, &now) == (FDCG_EVENT_ENDED | FDCG_EVENT_SLIP_ENDED));
  now.state = FDCG_FACE;
  now.feature = 12345;
  CHECK(fdcg_get_contact_info(&box.graph, nullptr, &before, &now, 0.001, &info, &error) == FDCG_E_ARGUMENT);
}

TEST_CASE("query: a path and many contacts have the bits of single steps") {
  const Opened sphere(ico_sphere(3));
  const fdcg_params params = fdcg_make_params();
  constexpr std::size_t kTicks = 500;
  std::vector<double> hips;
  Random random(7);
  for (std::size_t i = 0; i < kTicks; ++i) {
    for (int k = 0; k < 3; ++k)
      hips.push_back(std::sin(0.01 * double(i) + k) * random.uniform(0.55, 0.6));
  }
  std::vector<fdcg_result> one(kTicks), path(kTicks), many(kTicks);
  fdcg_contact single = {}, along = {};
  std::vector<fdcg_contact> contacts(kTicks);
  for (std::size_t i = 0; i < kTicks; ++i)
    fdcg_step(&sphere.graph, &params, &single, &hips[3 * i], &one[i]);
  fdcg_step_path(&sphere.graph, &params, &along, hips.data(), path.data(), kTicks);
  CHECK(std::memcmp(one.data(), path.data(), kTicks * sizeof(fdcg_result)) == 0);
  CHECK(std::memcmp(&single, &along, sizeof single) == 0);
  fdcg_step_many(&sphere.graph, &params, contacts.data(), hips.data(), many.data(), kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    fdcg_contact fresh = {};
    fdcg_result result;
    fdcg_step(&sphere.graph, &params, &fresh, &hips[3 * i], &result);
    CHECK(std::memcmp(&result, &many[i], sizeof result) == 0);
  }
}

TEST_CASE("query: null pointers are refused by name") {
  const Opened box(cube());
  const double at[3] = {0, 0, 2};
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_contact_info info = fdcg_make_contact_info();
  fdcg_result result = {};
  double distance;
  std::int32_t is_inside;
  std::uint32_t table[6];
  fdcg_error error = {};
  const auto refuses = [&](fdcg_status status, const char* name) {
    CHECK(status == FDCG_E_ARGUMENT);
    CHECK_THAT(error.message, ContainsSubstring(name));
  };
  refuses(fdcg_find_nearest(nullptr, at, 1, &hit, &error), "graph");
  refuses(fdcg_find_nearest(&box.graph, nullptr, 1, &hit, &error), "point_object_m");
  refuses(fdcg_find_nearest(&box.graph, at, 1, nullptr, &error), "hit");
  refuses(fdcg_get_signed_distance(&box.graph, at, nullptr, &error), "distance_m");
  refuses(fdcg_get_signed_distance(nullptr, at, &distance, &error), "graph");
  refuses(fdcg_is_inside(&box.graph, at, nullptr, &error), "is_inside");
  refuses(fdcg_is_inside(&box.graph, nullptr, &is_inside, &error), "point_object_m");
  refuses(fdcg_cast_ray(nullptr, at, at, 1, &hit, &error), "graph");
  refuses(fdcg_cast_ray(&box.graph, nullptr, at, 1, &hit, &error), "from_object_m");
  refuses(fdcg_cast_ray(&box.graph, at, nullptr, 1, &hit, &error), "direction");
  refuses(fdcg_cast_ray(&box.graph, at, at, 1, nullptr, &error), "hit");
  refuses(fdcg_get_contact_info(nullptr, nullptr, nullptr, &result, 1, &info, &error), "graph");
  refuses(fdcg_get_contact_info(&box.graph, nullptr, nullptr, nullptr, 1, &info, &error), "now");
  refuses(fdcg_get_contact_info(&box.graph, nullptr, nullptr, &result, 1, nullptr, &error), "info");
  refuses(fdcg_get_contact_info(&box.graph, nullptr, nullptr, &result, 0, &info, &error), "tick_s");
  refuses(fdcg_invert_source_map(nullptr, table, 6, &error), "graph");
  refuses(fdcg_invert_source_map(&box.graph, nullptr, 6, &error), "source_of_node");
  refuses(fdcg_invert_source_map(&box.graph, table, 5, &error), "count");
  CHECK(fdcg_get_contact_events(nullptr, nullptr) == 0);
}
