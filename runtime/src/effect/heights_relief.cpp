// SPDX-License-Identifier: Apache-2.0
// Heights of a map under a place, of the levels that the hand's speed allows.
#include <string.h>

#include "base/lanes.hpp"
#include "effect/effect_motion.hpp"
#include "effect/height_maps.hpp"
#include "fdcg/heights.h"

namespace fdcg {
namespace {

constexpr double kFarthestImages = 1e8;  // of a place from its image: beyond it nothing is felt

// In steps of the map; slopes per image.
struct OnMap {
  double height, along[2];
};

// Of four columns or rows. In single precision: what is rounded away is a 1,000th of a map's own step.
using Four = float __attribute__((vector_size(16)));

FDCG_HOT Four all(float a) {
  return Four{a, a, a, a};
}
FDCG_HOT double sum_of_lanes(Four a) {
  return (a[0] + a[2]) + (a[1] + a[3]);
}

// Four texels of 16 bits, the first lowest.
FDCG_HOT Four widened(uint64_t texels) {
#if FDCG_HAS_VECTORS && defined(__SSE2__)
  using Shorts = int16_t __attribute__((vector_size(16)));
  const auto shorts = reinterpret_cast<Shorts>(Lanes::Doublewords{texels, 0});
  const auto high_halves = __builtin_shufflevector(shorts, shorts, 0, 0, 1, 1, 2, 2, 3, 3);
  return __builtin_convertvector(reinterpret_cast<Lanes::Words>(high_halves) >> 16, Four);
#else
  const auto at = [&](int k) { return static_cast<float>(static_cast<int16_t>(texels >> 16 * k)); };
  return Four{at(0), at(1), at(2), at(3)};
#endif
}

// Of four texels around a place, so far past the second's middle: weights and their derivatives, of the B-spline of third
// degree.
struct Weights {
  Four of, slope_of;
};
FDCG_HOT Weights weights_of(double past) {
  constexpr float kSixth = 1.0F / 6;
  const Four t = all(static_cast<float>(past)), t2 = t * t;
  return {(Four{kSixth, 4 * kSixth, kSixth, 0} + Four{-0.5F, 0, 0.5F, 0} * t) +
              (Four{0.5F, -1, 0.5F, 0} + Four{-kSixth, 0.5F, -0.5F, kSixth} * t) * t2,
          (Four{-0.5F, 0, 0.5F, 0} + Four{1, -2, 1, 0} * t) + Four{-0.5F, 1.5F, -1.5F, 0.5F} * t2};
}

double floor_of(double x) {  // |x| within kFarthestImages and a side of texels
  const auto whole = static_cast<double>(static_cast<int64_t>(x));
  return whole > x ? whole - 1 : whole;
}

// Where a place lies among columns or rows: texel i has its middle at i + 0.5.
struct Side {
  int64_t first;  // of four, the second's middle before the place
  double past;
};
FDCG_HOT Side along_side(double image, uint32_t side) {
  const double x = image * side - 0.5;
  auto middle = static_cast<int64_t>(x);
  auto whole = static_cast<double>(middle);
  if (whole > x) middle -= 1, whole -= 1;
  return {middle - 1, x - whole};
}

// Four texels of each of four rows.
struct Rows {
  uint64_t a, b, c, d;
};
FDCG_HOT uint64_t four_at(const int16_t* texels) {
  uint64_t four;
  memcpy(&four, texels, sizeof four);
  return four;
}

// Where some of them lie beyond a border.
[[gnu::noinline, gnu::cold]] Rows rows_at_border(const fdcg_height_map& map, const HeightLevel& in, const int16_t* texels,
                                                 int64_t column, int64_t row) {
  uint32_t columns[4];
  for (int i = 0; i < 4; ++i)
    columns[i] = wrapped(column + i, in.width, map.wrap[0]);
  const bool is_whole = columns[0] == column && columns[3] == column + 3;
  uint64_t found[4];
  for (int k = 0; k < 4; ++k) {
    const int16_t* const line = texels + uint64_t{wrapped(row + k, in.height, map.wrap[1])} * in.width;
    const auto at = [&](int i) { return uint64_t{static_cast<uint16_t>(line[columns[i]])} << 16 * i; };
    found[k] = is_whole ? four_at(line + column) : at(0) | at(1) | at(2) | at(3);
  }
  return {found[0], found[1], found[2], found[3]};
}

OnMap at_level(const fdcg_height_map& map, const int16_t* all_texels, const double image[2], uint32_t level) {
  if (level >= map.level_count) return {0, {0, 0}};
  const HeightLevel in = level_of(map, level);
  const int16_t* const texels = all_texels + in.first;
  const Side u = along_side(image[0], in.width), v = along_side(image[1], in.height);
  const bool is_within = (u.first >= 0) & (v.first >= 0) & (u.first + 3 < in.width) & (v.first + 3 < in.height);
  Rows rows;
  if (is_within) {
    const int16_t* const corner = texels + (static_cast<uint64_t>(v.first) * in.width + static_cast<uint64_t>(u.first));
    rows = {four_at(corner), four_at(corner + in.width), four_at(corner + 2 * uint64_t{in.width}),
            four_at(corner + 3 * uint64_t{in.width})};
  } else {
    rows = rows_at_border(map, in, texels, u.first, v.first);
  }
  const Four a = widened(rows.a), b = widened(rows.b), c = widened(rows.c), d = widened(rows.d);
  const Weights across = weights_of(u.past), down = weights_of(v.past);
  const auto over_rows = [&](Four by) { return (a * all(by[0]) + b * all(by[1])) + (c * all(by[2]) + d * all(by[3])); };
  const Four height = over_rows(down.of), rise = over_rows(down.slope_of);
  return {sum_of_lanes(height * across.of),
          {sum_of_lanes(height * across.slope_of) * in.width, sum_of_lanes(rise * across.of) * in.height}};
}

// Level 0 up to half a texel a tick, then level k + 1 at 2^k texels, and between two of them a share of each.
OnMap at_speed(const fdcg_height_map& map, const int16_t* texels, const double image[2], double texels_a_tick) {
  double whole = 0.5, over = 2;  // the speed up to which the level is whole, and its inverse
  uint32_t level = 0;
  for (; texels_a_tick >= 2 * whole && level < map.level_count; ++level)
    whole *= 2, over *= 0.5;
  OnMap found = at_level(map, texels, image, level);
  if (!(texels_a_tick > whole) || level >= map.level_count) return found;
  const double share = (texels_a_tick - whole) * over;
  const OnMap next = at_level(map, texels, image, level + 1);
  found.height += share * (next.height - found.height);
  for (int k = 0; k < 2; ++k)
    found.along[k] += share * (next.along[k] - found.along[k]);
  return found;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_heights_law(const fdcg_relief* relief, const fdcg_relief_place* place, double* height_m, double slope[3]) {
  using namespace fdcg;
  const fdcg_heights& heights = *static_cast<const fdcg_heights*>(relief->data);
  *height_m = slope[0] = slope[1] = slope[2] = 0;
  if (place->node >= heights.node_count) return;
  const fdcg_node_place& node = heights.places[place->node];
  if (node.map >= heights.map_count) return;
  const fdcg_height_map& map = heights.maps[node.map];
  const double units_per_m = 1 / heights.metres_per_unit;
  const Along local = vec(place->place_m) * units_per_m - vec(heights.origin);
  const Along per_unit[2] = {{node.per_unit[0][0], node.per_unit[0][1], node.per_unit[0][2]},
                             {node.per_unit[1][0], node.per_unit[1][1], node.per_unit[1][2]}};
  const Along per_m[2] = {per_unit[0] * units_per_m, per_unit[1] * units_per_m};
  double image[2] = {node.offset[0] + dot(per_unit[0], local), node.offset[1] + dot(per_unit[1], local)};
  if (!(absolute(image[0]) < kFarthestImages && absolute(image[1]) < kFarthestImages)) return;
  for (int k = 0; k < 2; ++k)  // on the first of those that repeat
    if (map.wrap[k] == FDCG_WRAP_REPEAT) image[k] -= floor_of(image[k]);
  const Along way = vec(place->way_m);
  const double texels_a_tick = absolute(dot(per_m[0], way)) * map.width + absolute(dot(per_m[1], way)) * map.height;
  const OnMap found = at_speed(map, heights.texels, image, texels_a_tick);
  *height_m = map.metres_per_step * found.height;
  const Along rise = (per_m[0] * found.along[0] + per_m[1] * found.along[1]) * map.metres_per_step;
  slope[0] = rise.x, slope[1] = rise.y, slope[2] = rise.z;
}
