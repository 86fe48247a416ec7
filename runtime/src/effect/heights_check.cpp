// SPDX-License-Identifier: Apache-2.0
// The sections of height maps: found and checked when a program asks for them, so that others link nothing of it.
#include "base/message.hpp"
#include "effect/effect_motion.hpp"
#include "effect/height_maps.hpp"
#include "fdcg/heights.h"
#include "graph/section_records.hpp"
#include "graph/verify.hpp"

namespace fdcg {
namespace {

constexpr double kFarthestOffset = 1e6, kMostPerUnit = 1e12, kLeastStep_m = 1e-15, kMostStep_m = 1;

fdcg_status refuse_heights(fdcg_error* error, const char* what) {
  return Message(error, FDCG_E_GRAPH).say("the heights: ", what, "; compile the mesh again");
}

fdcg_status find(const fdcg_header& header, fdcg_heights* heights, uint32_t* texels, fdcg_error* error) {
  uint32_t present = 0;
  for (uint32_t id = FDCG_SECTION_NODE_PLACES; id <= FDCG_SECTION_HEIGHT_TEXELS; ++id)
    present += find_section(header, id) != nullptr;
  if (present == 0) return Message(error, FDCG_E_ABSENT).text("the file has no heights: compile the mesh with --heights");
  heights->places = records_of<fdcg_node_place>(header, FDCG_SECTION_NODE_PLACES, &heights->node_count);
  heights->maps = records_of<fdcg_height_map>(header, FDCG_SECTION_HEIGHT_MAPS, &heights->map_count);
  heights->texels = records_of<int16_t>(header, FDCG_SECTION_HEIGHT_TEXELS, texels);
  if (heights->places == nullptr || heights->maps == nullptr || heights->texels == nullptr)
    return refuse_heights(error, "sections 21 to 23 go together, and one is missing or has records of a wrong size");
  if (heights->node_count != header.node_count || heights->map_count == 0 || heights->map_count > FDCG_MAX_HEIGHT_MAPS)
    return refuse_heights(error, "its sections have numbers of records that do not fit");
  for (int k = 0; k < 3; ++k)
    heights->origin[k] = header.origin[k];
  heights->metres_per_unit = header.metres_per_unit;
  return FDCG_OK;
}

double square_of(const float (&v)[3]) {
  const Along along = {v[0], v[1], v[2]};
  return dot(along, along);
}

template <class Faults>
void look_at_place(const fdcg_node_place& place, uint32_t map_count, Faults* faults) {
  faults->note(place.map >= map_count && place.map != FDCG_NONE, "map out of range");
  for (int k = 0; k < 2; ++k) {
    faults->note(!(absolute(place.offset[k]) <= kFarthestOffset), "its image is too far away");
    faults->note(!(square_of(place.per_unit[k]) <= kMostPerUnit * kMostPerUnit), "its image is too small");
  }
  faults->note(place.reserved != 0, "a reserved number is not zero");
}

uint64_t end_of(const fdcg_height_map& map) {
  return level_of(map, map.level_count).first;
}

template <class Faults>
void look_at_map(const fdcg_heights& heights, uint32_t texels, uint32_t index, Faults* faults) {
  const fdcg_height_map& map = heights.maps[index];
  const bool has_sides = map.width >= 1 && map.width <= FDCG_MAX_HEIGHT_SIDE && map.height >= 1 &&
                         map.height <= FDCG_MAX_HEIGHT_SIDE && map.level_count >= 1 &&
                         map.level_count <= FDCG_MAX_HEIGHT_LEVELS;
  faults->note(!has_sides, "its size is out of range");
  faults->note(!(map.metres_per_step >= kLeastStep_m && map.metres_per_step <= kMostStep_m), "its unit is out of range");
  faults->note(map.wrap[0] > FDCG_WRAP_MIRROR || map.wrap[1] > FDCG_WRAP_MIRROR, "unknown wrap");
  faults->note(map.reserved[0] != 0 || map.reserved[1] != 0, "a reserved number is not zero");
  if (!has_sides) return;
  const uint64_t begin = index == 0 ? 0 : end_of(heights.maps[index - 1]), end = end_of(map);
  faults->note(map.first != begin || end > texels || (index + 1 == heights.map_count && end != texels),
               "its texels do not follow those before it, or are not all there");
}

// Of steps of the map, per texel of the level.
struct HeightBounds {
  int32_t height, across, along, mixed;
};

void raise(int32_t value, int32_t* most) {
  const int32_t size = value < 0 ? -value : value;
  if (size > *most) *most = size;
}

// Of a spline of third degree no value is larger than a texel's, no second derivative than a second difference.
HeightBounds bounds_of(const fdcg_height_map& map, const int16_t* texels, const HeightLevel& level) {
  HeightBounds most = {0, 0, 0, 0};
  const int16_t* const first = texels + level.first;
  for (uint32_t y = 0; y < level.height; ++y) {
    const int16_t* const row = first + uint64_t{y} * level.width;
    const int16_t* const above = first + uint64_t{wrapped(int64_t{y} - 1, level.height, map.wrap[1])} * level.width;
    const int16_t* const below = first + uint64_t{wrapped(int64_t{y} + 1, level.height, map.wrap[1])} * level.width;
    for (uint32_t x = 0; x < level.width; ++x) {
      const uint32_t left = wrapped(int64_t{x} - 1, level.width, map.wrap[0]);
      const uint32_t right = wrapped(int64_t{x} + 1, level.width, map.wrap[0]);
      raise(row[x], &most.height);
      raise(row[left] - 2 * row[x] + row[right], &most.along);
      raise(above[x] - 2 * row[x] + below[x], &most.across);
      raise((below[right] - below[x]) - (row[right] - row[x]), &most.mixed);
      raise((above[right] - above[x]) - (row[right] - row[x]), &most.mixed);
    }
  }
  return most;
}

// Of the nodes on a map: the largest squares and product of how much of the image a metre takes.
struct Density {
  double columns2, rows2, both;
};

constexpr uint32_t kMapsAtOnce = 32;  // so that all nodes are read eight times at most

// Of the maps first .. first + kMapsAtOnce - 1.
void find_densities(const fdcg_heights& heights, uint32_t first, Density (&of)[kMapsAtOnce]) {
  const double units_per_m = 1 / heights.metres_per_unit, square = units_per_m * units_per_m;
  for (uint32_t n = 0; n < heights.node_count; ++n) {
    const fdcg_node_place& place = heights.places[n];
    if (place.map < first || place.map >= first + kMapsAtOnce) continue;  // FDCG_NONE is larger
    Density* const most = &of[place.map - first];
    const double u2 = square_of(place.per_unit[0]) * square, v2 = square_of(place.per_unit[1]) * square;
    *most = {larger(most->columns2, u2), larger(most->rows2, v2), larger(most->both, root(u2) * root(v2))};
  }
}

void bound_map(uint32_t index, const Density& per_m, fdcg_heights* heights) {
  const fdcg_height_map& map = heights->maps[index];
  for (uint32_t k = 0; k < map.level_count; ++k) {
    const HeightLevel level = level_of(map, k);
    const HeightBounds most = bounds_of(map, heights->texels, level);
    const double columns = level.width, rows = level.height;
    const double curvature = per_m.columns2 * columns * columns * most.along + per_m.rows2 * rows * rows * most.across +
                             2 * per_m.both * columns * rows * most.mixed;
    heights->most_m = larger(heights->most_m, map.metres_per_step * most.height);
    heights->curvature_per_m = larger(heights->curvature_per_m, map.metres_per_step * curvature);
  }
}

fdcg_status check(fdcg_heights* heights, uint32_t texels, fdcg_error* error) {
  fdcg_status status = for_all(0, heights->node_count, "place of node", error, [&](uint32_t n, auto* faults) {
    look_at_place(heights->places[n], heights->map_count, faults);
  });
  if (status != FDCG_OK) return status;
  for (uint32_t m = 0; m < heights->map_count; ++m) {  // one after the other: each is read where the one before is right
    status = for_all(m, m + uint64_t{1}, "height map", error,
                     [&](uint32_t i, auto* faults) { look_at_map(*heights, texels, i, faults); });
    if (status != FDCG_OK) return status;
  }
  for (uint32_t first = 0; first < heights->map_count; first += kMapsAtOnce) {
    Density of[kMapsAtOnce] = {};
    find_densities(*heights, first, of);
    for (uint32_t m = first; m < heights->map_count && m < first + kMapsAtOnce; ++m)
      bound_map(m, of[m - first], heights);
  }
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_get_heights(const fdcg_graph* graph, fdcg_heights* heights, fdcg_error* error) {
  using namespace fdcg;
  if (heights == nullptr) return refuse(error, "heights: null pointer");
  *heights = {};
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not opened");
  uint32_t texels = 0;
  fdcg_status status = find(*graph->header, heights, &texels, error);
  if (status == FDCG_OK) status = check(heights, texels, error);
  if (status != FDCG_OK) *heights = {};
  return status;
}
