// SPDX-License-Identifier: Apache-2.0
#include "stress_case.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes.hpp"
#include "squashed.hpp"
#include "stress_decimals.hpp"
#include "stress_points.hpp"

namespace fdcg::test {
namespace {

using bake::Coplanar;
using bake::PolygonSoup;
using bake::Precision;
using bake::Vec3;

constexpr auto kPi = 3.14159265358979323846;

// ---- bodies ----------------------------------------------------------------------------------------------------------------

std::uint32_t nearest_to(const PolygonSoup& soup, const Hip& p) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < soup.points.size(); ++i) {
    if (distance(point_of(soup.points[i]), p) < distance(point_of(soup.points[best]), p)) best = i;
  }
  return best;
}

// How a body is put into the world.
struct Placing {
  bool may_turn = true;
  double size = 1;
  double offset = 0;  // sizes
};

// Triangles, so that the exact solid is the graph's own; exactly coplanar ones may be merged.
Body placed(PolygonSoup shape, Random& random, Precision precision, const Placing& placing = {}, bool is_closed = true) {
  Body body;
  body.focus = {nearest_to(shape, {0, 0, 0}), static_cast<std::uint32_t>(shape.points.size() - 1)};
  std::ostringstream text;
  text << shape.name;
  if (placing.may_turn && random.chance(0.6)) {
    shape = transformed(shape, random_rotation(random.bits()));
    text << ", turned";
  }
  const Vec3 d = random.direction();
  const double offset = placing.offset * placing.size;
  shape = moved(scaled(shape, placing.size), {offset * d.x, offset * d.y, offset * d.z});
  body.options.precision = precision;
  body.options.coplanar.kind = Coplanar::Kind::exact;
  body.options.merge = random.chance(0.7);
  body.options.store_planes = random.chance(0.5);
  body.options.jobs = 1;
  body.options.without = {"source-map", "info"};
  text << ", size " << placing.size << ", offset " << placing.offset << (body.options.merge ? ", merged" : "")
       << (body.options.store_planes ? "" : ", planes derived");
  body.soup = std::move(shape);
  body.is_closed = is_closed;
  body.description = text.str();
  return body;
}

PolygonSoup any_small(Random& random) {
  switch (random.below(14)) {
    case 0:
      return triangulated(cube(), random.bits());
    case 1:
      return triangulated(corner_pit(), random.bits());
    case 2:
      return triangulated(thin_plate(0x1p-10, 2), random.bits());
    case 3:
      return triangulated(l_prism(), random.bits());
    case 4:
      return triangulated(wedge(random.uniform(0.01, 3)), random.bits());
    case 5:
      return triangulated(v_groove(random.uniform(0.05, 3)), random.bits());
    case 6:
      return triangulated(saddle_block());
    case 7:
      return triangulated(cone(3 + static_cast<int>(random.below(30))));
    case 8:
      return triangulated(cone_pit(3 + static_cast<int>(random.below(20))));
    case 9:
      return star_sphere(1, 0.4, random.bits());
    case 10:
      return spiky_sphere(1, 1.5, random.bits());
    case 11:
      return torus(8, 5);
    case 12:
      return subdivided(cube(), random.bits());
    default:
      return ico_sphere(static_cast<int>(random.below(2)));
  }
}

// A tetrahedron, mostly a sliver: three points far apart, the fourth at a height of 1 to 10^-5 over their plane.
PolygonSoup sliver(Random& random) {
  const Hip a = point_of(random.direction()), b = point_of(random.direction()), c = point_of(random.direction());
  const Hip u = difference(b, a), v = difference(c, a);
  Hip n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double height = std::pow(10, random.uniform(-5, 0)) / norm(n), p = random.uniform(-0.2, 1), q = random.uniform(-0.2, 1);
  Hip d;
  for (std::size_t i = 0; i < 3; ++i)
    d[i] = a[i] + p * u[i] + q * v[i] - height * n[i];
  return make_soup("sliver", {vec_of(a), vec_of(b), vec_of(c), vec_of(d)}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
}

// Angles from 10^-6 to 1.
double sharp_angle(Random& random, Precision precision) {
  return std::pow(10, random.uniform(precision == Precision::f64 ? -6 : -3, 0));
}

Body needles(Random& random, Precision precision) {
  switch (random.below(4)) {
    case 0:
      return placed(triangulated(fan_block(20 + static_cast<int>(random.below(60)), 40, -0.9, -0.8)), random, precision);
    case 1:
      return placed(triangulated(cone(100 + static_cast<int>(random.below(200)))), random, precision);
    case 2:
      return placed(sliver(random), random, precision);
    default:
      return placed(triangulated(fan_block(40, 3, -0.5, -0.4)), random, precision);
  }
}
Body needle_strips(Random& random, Precision precision) {
  return placed(needle_strip(200 + static_cast<int>(random.below(1300)), random.uniform(0, 1), random.bits()), random,
                precision, {}, false);
}
// Edges of boxes' flat sides, turned and rounded to float: nearly flat, up or down by a rounding; both the exact signs and the
// quantum's regions.
Body coplanar_noise(Random& random, Precision precision) {
  const int n = 2 + static_cast<int>(random.below(4));
  const PolygonSoup box = triangulated(grid_box(n, n, n, {1, 1, 1}), random.bits());
  Body body = placed(rounded_to_float(transformed(box, random_rotation(random.bits()))), random, precision, {false, 1, 0});
  if (random.chance(0.5)) body.options.coplanar.kind = Coplanar::Kind::quantum;
  return body;
}
Body knives(Random& random, Precision precision) {
  return placed(triangulated(wedge(sharp_angle(random, precision)), random.bits()), random, precision);
}
Body slits(Random& random, Precision precision) {
  return placed(triangulated(v_groove(sharp_angle(random, precision)), random.bits()), random, precision);
}
Body flat_dihedrals(Random& random, Precision precision) {
  const double angle = kPi - sharp_angle(random, precision);
  const bool is_wedge = random.chance(0.3);
  return placed(triangulated(is_wedge ? wedge(std::min(angle, 3.0)) : v_groove(angle), random.bits()), random, precision);
}
Body plates(Random& random, Precision precision) {
  return placed(triangulated(thin_plate(1e-6, 1 + static_cast<int>(random.below(4))), random.bits()), random, precision);
}
Body busy_corners(Random& random, Precision precision) {
  switch (random.below(4)) {
    case 0:
      return placed(triangulated(cone(10'000)), random, precision);
    case 1:
      return placed(triangulated(cone_pit(10'000)), random, precision);
    case 2:
      return placed(triangulated(fan_block(10'000, 0, 0.5, -0.5)), random, precision);
    default:
      return placed(triangulated(fan_block(10'000, 1e-3, 0, 0)), random, precision);
  }
}
Body concave_corners(Random& random, Precision precision) {
  switch (random.below(3)) {
    case 0:
      return placed(triangulated(corner_pit(), random.bits()), random, precision);
    case 1:
      return placed(triangulated(cone_pit(3 + static_cast<int>(random.below(40)))), random, precision);
    default:
      return placed(triangulated(fan_block(3 + static_cast<int>(random.below(6)), 0, random.uniform(0.1, 3), 1)), random,
                    precision);
  }
}
Body tremor_corners(Random& random, Precision precision) {
  switch (random.below(3)) {
    case 0:
      return placed(triangulated(v_groove(random.uniform(0.2, 2.8)), random.bits()), random, precision);
    case 1:
      return placed(triangulated(l_prism(), random.bits()), random, precision);
    default:
      return concave_corners(random, precision);
  }
}
Body saddles(Random& random, Precision precision) {
  switch (random.below(4)) {
    case 0:
      return placed(triangulated(saddle_block()), random, precision);
    case 1:
      return placed(star_sphere(2, random.uniform(0.1, 0.6), random.bits()), random, precision);
    case 2:
      return placed(triangulated(fan_block(2 * (2 + static_cast<int>(random.below(12))), 0, 0.5, -0.5)), random, precision);
    default:
      return placed(spiky_sphere(1 + static_cast<int>(random.below(2)), 1.5, random.bits()), random, precision);
  }
}
Body small_bodies(Random& random, Precision precision) {
  return placed(any_small(random), random, precision);
}
Body far_offsets(Random& random, Precision precision) {
  return placed(any_small(random), random, precision, {true, 1, random.chance(0.5) ? 1e6 : 1e3});
}
Body odd_sizes(Random& random, Precision precision) {
  Body body = placed(any_small(random), random, precision, {true, random.chance(0.5) ? 1e-6 : 1e6, 0});
  if (random.chance(0.5)) body.options.metres_per_unit = 1e-3;
  return body;
}
Body open_patches(Random& random, Precision precision) {
  const int n = 1 + static_cast<int>(random.below(8));
  switch (random.below(4)) {
    case 0:
      return placed(plane_grid(n, n), random, precision, {}, false);
    case 1:
      return placed(plane_jittered(n + 1, random.bits()), random, precision, {}, false);
    case 2:
      return placed(make_soup("triangle", {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}}, {{0, 1, 2}}), random, precision, {}, false);
    default:
      return placed(bumpy_patch(n + 1, 0.3, random.bits()), random, precision, {}, false);
  }
}
// As a user compiles: quads and polygons, merged within the numbers' own quantum.
Body merged_faces(Random& random, Precision precision) {
  PolygonSoup soup;
  switch (random.below(4)) {
    case 0:
      soup = grid_box(5, 4, 3, {1, 0.8, 0.7});
      break;
    case 1:
      soup = prism(60 + static_cast<int>(random.below(200)));
      break;
    case 2:
      soup = corner_pit();
      break;
    default:
      soup = triangulated(l_prism());
  }
  Body body = placed(soup, random, precision);
  body.options.coplanar.kind = Coplanar::Kind::quantum;
  body.options.merge = true;
  return body;
}
Body large_meshes(Random& random, Precision precision) {
  switch (random.below(4)) {
    case 0:
      return placed(geodesic_sphere(70), random, precision);
    case 1:
      return placed(star_sphere(5, 0.3 / 32, random.bits()), random, precision);
    case 2:
      return placed(torus(200, 80), random, precision);
    default:
      return placed(spiky_sphere(5, 0.5, random.bits()), random, precision);
  }
}

// Any of them flat or long by 10 to 10^6 along an axis, or along two.
template <int kTens>
Body squashed(Random& random, Precision precision) {
  constexpr Body (*kMakers[])(Random&, Precision) = {small_bodies, saddles, concave_corners, knives, slits, flat_dihedrals};
  const std::uint32_t pick = random.below(2 * std::size(kMakers));
  Body body = pick < std::size(kMakers)
                  ? kMakers[pick](random, precision)
                  : placed(double_fan(3 + static_cast<int>(random.below(10)), random.bits()), random, precision);
  const double factor = std::pow(10, random.chance(0.7) ? -kTens : kTens);
  const int axis = static_cast<int>(random.below(3));
  body.soup = stretched(body.soup, axis, factor);
  if (random.chance(0.2)) body.soup = stretched(body.soup, (axis + 1) % 3, random.chance(0.5) ? factor : std::sqrt(factor));
  body.description += ", axis " + std::to_string(axis) + " times " + std::to_string(factor);
  return body;
}

}  // namespace

const std::vector<StressCase>& stress_cases() {
  using enum Motion;
  constexpr const char* kHeld = "held as any face is";
  constexpr const char* kSquashed = "no rest at a corner that is no least place";
  constexpr bool kMayCarry = true;
  static const std::vector<StressCase> cases = {
      {"needle-faces", kHeld, needles, {wander, slide, dive, on_planes, aim}, kMayCarry},
      {"needle-strips", "GO valid every tick; work carried over", needle_strips, {wander, slide, on_planes}, kMayCarry},
      {"coplanar-noise", "neither holds nor drops GO", coplanar_noise, {wander, slide, slide, on_planes, creep}, kMayCarry},
      {"knife-edges", kHeld, knives, {wander, slide, dive, on_planes, aim}, kMayCarry},
      {"slits", kHeld, slits, {wander, slide, tremor, dive, on_planes, aim}, kMayCarry},
      {"flat-dihedrals",
       "edges at 180 degrees but 1e-6 to 1 rad",
       flat_dihedrals,
       {wander, slide, tremor, on_planes},
       kMayCarry},
      {"thin-plates", "held on the side it came from", plates, {wander, slide, on_planes, aim, jump, creep}, kMayCarry},
      {"busy-corners",
       "10^4 faces; work carried over",
       busy_corners,
       {wander, slide, dive, dive, on_planes},
       kMayCarry,
       50,
       0.05},
      {"concave-corners", "three faces and more hold", concave_corners, {wander, slide, dive, on_planes, aim}, kMayCarry},
      {"saddle-corners", "no cycle, no leak", saddles, {wander, slide, dive, on_planes, aim}, kMayCarry},
      {"tremor", "0.2 mm, friction, any orientation: held", tremor_corners, {tremor}, kMayCarry},
      {"on-features", "held, slid and entered from planes", small_bodies, {on_planes}, kMayCarry},
      {"tiny-steps", "steps of 1e-12 seen", small_bodies, {creep}, kMayCarry},
      {"offsets", "10^3 and 10^6 sizes cost nothing", far_offsets, {wander, slide, on_planes, creep}, kMayCarry},
      {"sizes", "1e-6 and 1e6 alike", odd_sizes, {wander, slide, dive, on_planes, creep}, kMayCarry},
      {"jumps", "across the whole object: seen", small_bodies, {jump}, kMayCarry},
      {"moving-object", "a still hand is met", small_bodies, {object}, kMayCarry},
      {"not-finite", "state kept, no force", small_bodies, {not_finite}, kMayCarry},
      {"open-boundaries", "no force beyond the rim", open_patches, {wander, slide, on_planes, creep, encoder}, kMayCarry},
      {"encoder", "quantised: no cycle, no leak", small_bodies, {encoder}, kMayCarry},
      {"starts-inside", "free until it has left, then met", small_bodies, {inside}, kMayCarry},
      {"aimed", "no way slips through a seam", small_bodies, {aim}, kMayCarry},
      {"merged-faces", "flat within the quantum: one node", merged_faces, {wander, slide, on_planes, jump}, kMayCarry},
      {"decimals",
       "flat but for a text file's decimals: one node",
       decimal_bodies,
       {wander, slide, dive, on_planes, aim, jump},
       kMayCarry},
      {"squashed-10", kSquashed, squashed<1>, {wander, slide, dive, on_planes, aim, jump}, kMayCarry},
      {"squashed-100", kSquashed, squashed<2>, {wander, slide, dive, on_planes, aim, jump}, kMayCarry},
      {"squashed-1000", kSquashed, squashed<3>, {wander, slide, dive, on_planes, aim, jump}, kMayCarry},
      {"squashed-1000000", kSquashed, squashed<6>, {wander, slide, dive, on_planes, aim, jump}, kMayCarry},
      {"large-meshes",
       "as small ones; work carried over",
       large_meshes,
       {wander, slide, slide, on_planes, aim},
       kMayCarry,
       50,
       0.5},
      {"points", "a force in the tick that gets inside", pointed_bodies, {approach}, kMayCarry, 5, 0.2, true},
  };
  return cases;
}

}  // namespace fdcg::test
