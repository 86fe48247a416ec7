// SPDX-License-Identifier: Apache-2.0
// Where a body touches: the corners farthest out, in directions spread evenly over the sphere.
#include "message.hpp"
#include "pile_memory.hpp"

namespace fdcg {
namespace {

constexpr uint32_t kMostPoints = 1024, kDirectionsPerPoint = 64;
constexpr double kDrawnIn = 0x1p-10;

// The i-th of the directions: equal steps along an axis from a spiral, taken in the order of the golden ratio too, so that any
// first ones are spread. No sine: points of a low-discrepancy pair mapped on the cube's surface, which needs no more than a
// root.
World direction(uint32_t i) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto part = [i](double step) {
    const double x = (i + 0.5) * step;
    return x - static_cast<double>(static_cast<uint64_t>(x));
  };
  const double a = 2 * part(1 / kPlastic) - 1, b = 2 * part(1 / (kPlastic * kPlastic)) - 1;
  // about evenly spread from a cube's side: Everitt's polynomial is not needed for a search
  switch (i % 6) {
    case 0:
      return {1, a, b};
    case 1:
      return {-1, a, b};
    case 2:
      return {a, 1, b};
    case 3:
      return {a, -1, b};
    case 4:
      return {a, b, 1};
    default:
      return {a, b, -1};
  }
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_pick_points(const fdcg_graph* graph, double (*points_m)[3], uint32_t capacity, uint32_t* count,
                                        fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr || graph->header == nullptr || points_m == nullptr || count == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("graph, points_m or count: null pointer, or not open");
  *count = 0;
  if (capacity == 0 || capacity > kMostPoints)
    return Message(error, FDCG_E_ARGUMENT).text("capacity is ").number(capacity).text(", allowed 1 to ").number(kMostPoints);
  const fdcg_header& header = *graph->header;
  uint32_t chosen[kMostPoints];
  for (uint32_t i = 0; i < kDirectionsPerPoint * capacity && *count < capacity; ++i) {
    const World along = direction(i);
    double farthest = -HUGE_VAL;
    uint32_t found = 0;
    for (uint32_t c = 0; c < header.corner_count; ++c) {
      const double reach = dot(along, vec(fdcg_get_corner(graph, c).point));
      if (reach > farthest) farthest = reach, found = c;
    }
    bool is_new = true;
    for (uint32_t k = 0; k < *count; ++k)
      is_new = is_new && chosen[k] != found;
    if (is_new) chosen[(*count)++] = found;
  }
  World mean = {0, 0, 0};
  for (uint32_t k = 0; k < *count; ++k) {
    const World at = (vec(fdcg_get_corner(graph, chosen[k]).point) + vec(header.origin)) * header.metres_per_unit;
    put(at, points_m[k]);
    mean = mean + at;
  }
  mean = mean * (1.0 / *count);
  for (uint32_t k = 0; k < *count; ++k)
    put(vec(points_m[k]) + (mean - vec(points_m[k])) * kDrawnIn, points_m[k]);
  return FDCG_OK;
}
