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

using Two = double __attribute__((vector_size(16)));

// In steps of the map; slopes per image.
struct OnMap {
  double height, along[2];
};

// Of four columns.
struct Four {
  Two low, high;

  friend Four operator+(Four a, Four b) { return {a.low + b.low, a.high + b.high}; }
  friend Four operator*(Four a, double b) { return {a.low * b, a.high * b}; }
};
double sum_of_products(Four a, Four b) {
  const Two sum = a.low * b.low + a.high * b.high;
  return sum[0] + sum[1];
}

// Four texels of 16 bits, the first lowest.
Four widened(uint64_t texels) {
#if FDCG_HAS_VECTORS && defined(__SSE2__) && __has_builtin(__builtin_ia32_cvtdq2pd)
  using Shorts = int16_t __attribute__((vector_size(16)));
  const auto shorts = reinterpret_cast<Shorts>(Lanes::Doublewords{texels, 0});
  const auto high_halves = __builtin_shufflevector(shorts, shorts, 0, 0, 1, 1, 2, 2, 3, 3);
  const Lanes::Words words = reinterpret_cast<Lanes::Words>(high_halves) >> 16;
  return {__builtin_ia32_cvtdq2pd(words), __builtin_ia32_cvtdq2pd(__builtin_shufflevector(words, words, 2, 3, 0, 1))};
#else
  const auto at = [&](int k) { return static_cast<double>(static_cast<int16_t>(texels >> 16 * k)); };
  return {Two{at(0), at(1)}, Two{at(2), at(3)}};
#endif
}

// Of four texels around a place, columns in [0] and rows in [1]: weights and their derivatives, of the B-spline of third
// degree.
struct Weights {
  Two of[4], slope_of[4];

  [[nodiscard]] static Four columns(const Two (&two)[4]) { return {Two{two[0][0], two[1][0]}, Two{two[2][0], two[3][0]}}; }
};
Weights weights_of(Two t) {
  constexpr double kSixth = 1.0 / 6;
  const Two s = 1 - t;
  return {{kSixth * s * s * s, kSixth * (4 - 3 * t * t * (1 + s)), kSixth * (4 - 3 * s * s * (1 + t)), kSixth * t * t * t},
          {-0.5 * s * s, t * (1.5 * t - 2), s * (2 - 1.5 * s), 0.5 * t * t}};
}

double floor_of(double x) {  // |x| within kFarthestImages and a side of texels
  const auto whole = static_cast<double>(static_cast<int64_t>(x));
  return whole > x ? whole - 1 : whole;
}

// Columns or rows around a place.
struct Taps {
  uint32_t at[4];
  double past;  // the second's middle, as a share of a texel
};
[[gnu::always_inline]] inline Taps taps_of(double image, uint32_t side, uint32_t wrap) {
  const double x = image * side - 0.5, middle = floor_of(x);  // texel i has its middle at i + 0.5
  const auto first = static_cast<int64_t>(middle) - 1;
  Taps taps;
  taps.past = x - middle;
  taps.at[0] = wrapped(first, side, wrap);
  for (uint32_t k = 1; k < 4; ++k) {
    const uint32_t next = taps.at[k - 1] + 1;
    taps.at[k] = wrap != FDCG_WRAP_REPEAT ? wrapped(first + k, side, wrap) : next == side ? 0 : next;  // no other division
  }
  return taps;
}

uint64_t texels_of(const int16_t* row, const uint32_t (&at)[4]) {
  if (at[3] == at[0] + 3 && at[1] == at[0] + 1) {  // side by side
    uint64_t texels;
    memcpy(&texels, row + at[0], sizeof texels);
    return texels;
  }
  const auto bits = [&](int k) { return uint64_t{static_cast<uint16_t>(row[at[k]])}; };
  return bits(0) | bits(1) << 16 | bits(2) << 32 | bits(3) << 48;
}

OnMap at_level(const fdcg_height_map& map, const int16_t* texels, const double image[2], uint32_t level) {
  if (level >= map.level_count) return {0, {0, 0}};
  const HeightLevel in = level_of(map, level);
  const Taps u = taps_of(image[0], in.width, map.wrap[0]), v = taps_of(image[1], in.height, map.wrap[1]);
  const Weights weights = weights_of(Two{u.past, v.past});
  const auto row = [&](int k) { return widened(texels_of(texels + in.first + uint64_t{v.at[k]} * in.width, u.at)); };
  const Four a = row(0), b = row(1), c = row(2), d = row(3);
  const auto down = [&](const Two(&by)[4]) { return (a * by[0][1] + b * by[1][1]) + (c * by[2][1] + d * by[3][1]); };
  const Four height = down(weights.of), rise = down(weights.slope_of), across = Weights::columns(weights.of);
  return {sum_of_products(height, across),
          {sum_of_products(height, Weights::columns(weights.slope_of)) * in.width, sum_of_products(rise, across) * in.height}};
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
  const double image[2] = {node.offset[0] + dot(per_unit[0], local), node.offset[1] + dot(per_unit[1], local)};
  if (!(absolute(image[0]) < kFarthestImages && absolute(image[1]) < kFarthestImages)) return;
  const Along way = vec(place->way_m);
  const double texels_a_tick = absolute(dot(per_m[0], way)) * map.width + absolute(dot(per_m[1], way)) * map.height;
  const OnMap found = at_speed(map, heights.texels, image, texels_a_tick);
  *height_m = map.metres_per_step * found.height;
  const Along rise = (per_m[0] * found.along[0] + per_m[1] * found.along[1]) * map.metres_per_step;
  slope[0] = rise.x, slope[1] = rise.y, slope[2] = rise.z;
}
