// SPDX-License-Identifier: Apache-2.0
// Contact points of a body: the extreme corners in directions spread over the sphere; then points along its sharp edges.
#include "base/message.hpp"
#include "body/pile_memory.hpp"

namespace fdcg {
namespace {

constexpr uint32_t kMostPoints = 256, kDirectionsPerPoint = 64;
constexpr double kDrawnIn = 0x1p-10;
constexpr double kSharpCosine = 0.9;  // the faces of a sharp edge turn by more than 26 degrees

// The i-th direction, not of unit length: a low-discrepancy sequence on the sides of a cube, so that any initial part of it is
// spread.
World direction(uint32_t i) {
  constexpr double kPlastic = 1.32471795724474602596;  // the golden ratio of pairs (Roberts 2018)
  const auto part = [i](double step) {
    const double x = (i + 0.5) * step;
    return 2 * (x - static_cast<double>(static_cast<uint64_t>(x))) - 1;
  };
  const double a = part(1 / kPlastic), b = part(1 / (kPlastic * kPlastic)), side = i % 2 == 0 ? 1 : -1;
  return i % 6 < 2 ? World{side, a, b} : i % 6 < 4 ? World{a, side, b} : World{a, b, side};
}

struct Points {
  const fdcg_graph& graph;
  double (*at)[3];  // local first
  uint32_t count, capacity;

  [[nodiscard]] World corner(uint32_t index) const { return vec(fdcg_get_corner(&graph, index).point); }
  void add(World point) {
    if (count < capacity) put(point, at[count++]);
  }
};

void pick_corners(Points* points) {
  uint32_t chosen[kMostPoints];
  for (uint32_t i = 0; i < kDirectionsPerPoint * points->capacity && points->count < points->capacity; ++i) {
    const World along = direction(i);
    double farthest = -HUGE_VAL;
    uint32_t found = 0;
    for (uint32_t c = 0; c < points->graph.header->corner_count; ++c) {
      const double reach = dot(along, points->corner(c));
      if (reach > farthest) farthest = reach, found = c;
    }
    bool is_new = true;
    for (uint32_t k = 0; k < points->count; ++k)
      is_new = is_new && chosen[k] != found;
    if (!is_new) continue;
    chosen[points->count] = found;
    points->add(points->corner(found));
  }
}

struct SharpEdge {
  uint32_t connection, pieces;
  double length;

  [[nodiscard]] double piece() const { return length / pieces; }
};

bool is_sharp(const fdcg_graph& graph, const fdcg_connection_info& edge) {
  if (edge.type != FDCG_CONVEX) return false;
  return dot(vec(fdcg_get_node(&graph, edge.node[0]).normal), vec(fdcg_get_node(&graph, edge.node[1]).normal)) < kSharpCosine;
}

// The longest ones, longest first, at most as many as there is room for points.
uint32_t longest_sharp_edges(const Points& points, SharpEdge (&edges)[kMostPoints]) {
  const uint32_t room = points.capacity - points.count;
  uint32_t count = 0;
  for (uint32_t c = 0; c < points.graph.header->connection_count && room > 0; ++c) {
    const fdcg_connection_info info = fdcg_get_connection(&points.graph, c);
    if (count == room && info.length <= edges[count - 1].length) continue;
    if (!is_sharp(points.graph, info)) continue;
    if (count < room) ++count;
    uint32_t place = count - 1;
    for (; place > 0 && edges[place - 1].length < info.length; --place)
      edges[place] = edges[place - 1];
    edges[place] = {c, 1, info.length};
  }
  return count;
}

// Each point halves, thirds, ... the edge whose pieces are the longest.
void pick_on_edges(Points* points) {
  SharpEdge edges[kMostPoints];
  const uint32_t count = longest_sharp_edges(*points, edges);
  if (count == 0) return;
  for (uint32_t left = points->capacity - points->count; left > 0; --left) {
    uint32_t longest = 0;
    for (uint32_t e = 1; e < count; ++e) {
      if (edges[e].piece() > edges[longest].piece()) longest = e;
    }
    ++edges[longest].pieces;
  }
  for (uint32_t e = 0; e < count; ++e) {
    const fdcg_connection_info info = fdcg_get_connection(&points->graph, edges[e].connection);
    const World from = points->corner(info.corner[0]), way = points->corner(info.corner[1]) - from;
    for (uint32_t p = 1; p < edges[e].pieces; ++p)
      points->add(from + way * (static_cast<double>(p) / edges[e].pieces));
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
    return Message(error, FDCG_E_ARGUMENT).say("capacity is ", capacity, ", allowed 1 to ", kMostPoints);
  Points points = {*graph, points_m, 0, capacity};
  pick_corners(&points);
  World mean = {0, 0, 0};
  for (uint32_t k = 0; k < points.count; ++k)
    mean = mean + vec(points_m[k]);
  mean = mean * (1.0 / points.count);
  pick_on_edges(&points);
  for (uint32_t k = 0; k < points.count; ++k) {
    const World at = vec(points_m[k]) + (mean - vec(points_m[k])) * kDrawnIn;
    put((at + vec(graph->header->origin)) * graph->header->metres_per_unit, points_m[k]);
  }
  *count = points.count;
  return FDCG_OK;
}
