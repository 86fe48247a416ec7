// SPDX-License-Identifier: Apache-2.0
// Heights of a map under a place, of the levels that the hand's speed allows.
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

// Weights of four texels around a place, and their derivatives: the B-spline of third degree.
struct Taps {
  uint32_t at[4];
  double weight[4], slope[4];
};

double floor_of(double x) {  // |x| within kFarthestImages and a side of texels
  const auto whole = static_cast<double>(static_cast<int64_t>(x));
  return whole > x ? whole - 1 : whole;
}

Taps taps_of(double image, uint32_t side, uint32_t wrap) {
  const double x = image * side - 0.5, middle = floor_of(x), t = x - middle, s = 1 - t;  // texel i has its middle at i + 0.5
  const auto i = static_cast<int64_t>(middle);
  constexpr double kSixth = 1.0 / 6;
  return {{wrapped(i - 1, side, wrap), wrapped(i, side, wrap), wrapped(i + 1, side, wrap), wrapped(i + 2, side, wrap)},
          {kSixth * s * s * s, kSixth * (4 - 3 * t * t * (1 + s)), kSixth * (4 - 3 * s * s * (1 + t)), kSixth * t * t * t},
          {-0.5 * s * s, t * (1.5 * t - 2), s * (2 - 1.5 * s), 0.5 * t * t}};
}

OnMap at_level(const fdcg_height_map& map, const int16_t* texels, const double image[2], uint32_t level) {
  if (level >= map.level_count) return {0, {0, 0}};
  const HeightLevel in = level_of(map, level);
  const Taps u = taps_of(image[0], in.width, map.wrap[0]), v = taps_of(image[1], in.height, map.wrap[1]);
  OnMap sum = {0, {0, 0}};
  for (int k = 0; k < 4; ++k) {
    const int16_t* const row = texels + in.first + uint64_t{v.at[k]} * in.width;
    const double a = row[u.at[0]], b = row[u.at[1]], c = row[u.at[2]], d = row[u.at[3]];
    const double height = (a * u.weight[0] + b * u.weight[1]) + (c * u.weight[2] + d * u.weight[3]);
    sum.height += v.weight[k] * height;
    sum.along[0] += v.weight[k] * ((a * u.slope[0] + b * u.slope[1]) + (c * u.slope[2] + d * u.slope[3]));
    sum.along[1] += v.slope[k] * height;
  }
  sum.along[0] *= in.width;
  sum.along[1] *= in.height;
  return sum;
}

// Level 0 up to half a texel a tick, then level k + 1 at 2^k texels, and between two of them a share of each.
OnMap at_speed(const fdcg_height_map& map, const int16_t* texels, const double image[2], double texels_a_tick) {
  double whole = 0.5;  // the speed up to which the level is whole
  uint32_t level = 0;
  for (; texels_a_tick >= 2 * whole && level < map.level_count; ++level)
    whole *= 2;
  OnMap found = at_level(map, texels, image, level);
  if (!(texels_a_tick > whole) || level >= map.level_count) return found;
  const double share = (texels_a_tick - whole) / whole;
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
