// SPDX-License-Identifier: Apache-2.0
// Judgements of a graph whose faces were merged within the numbers' quantum, by the mesh that it was made from and the
// deviation that its file states: the graph's surface lies no farther than that from the mesh's, so what is farther away, on
// either side, must be as the mesh says.
#include <algorithm>
#include <cmath>
#include <vector>

#include "judge.hpp"

namespace fdcg::test {
namespace {

Hip place_between(const Hip& from, const Hip& to, double share) {
  Hip x;
  for (std::size_t i = 0; i < 3; ++i)
    x[i] = from[i] + (to[i] - from[i]) * share;
  return x;
}

}  // namespace

// Whether a way passes a merged face as it is met (contact-model FREE-3): from as far off its plane as its corners may be, and
// as far beyond its sides, at a groove as far below the face across. Beyond a sharp corner, and at the end of a shallow groove,
// that is many deviations from the mesh.
bool Judge::passes_slab(const Hip& from, const Hip& to) const {
  for (std::uint32_t n = 0; n < specimen_.nodes.size(); ++n) {
    if (!specimen_.nodes[n].is_planar && passes_slab_of(n, from, to)) return true;
  }
  return false;
}

bool Judge::passes_slab_of(std::uint32_t n, const Hip& from, const Hip& to) const {
  const NodeShape& node = specimen_.nodes[n];
  double begin = 0, end = 1;                            // the part of the way in the slab, so far
  const auto cut = [&](double at_from, double at_to) {  // to where what goes from one to the other is at most moved_
    const double above = at_from - moved_, fall = at_from - at_to;
    if (fall > 0) {
      begin = std::max(begin, above / fall);
    } else if (fall < 0) {
      end = std::min(end, above / fall);
    } else if (above > 0) {
      end = -1;
    }
  };
  const double front_from = in_front_of_node(n, from), front_to = in_front_of_node(n, to);
  cut(front_from, front_to);
  cut(-front_from, -front_to);
  for (std::uint32_t k = node.first_side; k < node.first_side + node.side_count; ++k) {
    const Rim& rim = specimen_.rims[k];
    const EdgeShape& edge = specimen_.edges[rim.edge];
    const std::uint32_t across = edge.node[0] == n ? edge.node[1] : edge.node[0];
    if (edge.type == FDCG_CONCAVE) {
      cut(-in_front_of_node(across, from), -in_front_of_node(across, to));
    } else {
      cut(signed_distance(rim.normal, rim.offset, from), signed_distance(rim.normal, rim.offset, to));
    }
  }
  return begin <= end;
}

// A contact that was free: what its way met, and what it should have.
void Judge::look_at_merged_way(Tick& tick) const {
  constexpr int kPlaces = 9;  // looked at on a way through the surface
  const Hip from = {tick.before.hip[0], tick.before.hip[1], tick.before.hip[2]};
  const InsideGrid& solid = *specimen_.inside;
  const InsideGrid::Crossing way = solid.crossing(from, tick.hip);
  const bool is_stopped = tick.result.transitions > 0;
  tick.is_way_clear = !way.is_through && !way.touches && !solid.comes_near(from, tick.hip, moved_);
  const double met_from = std::max(2 * moved_, deviation_);
  if (tick.is_way_clear && is_stopped && !solid.comes_near(from, tick.hip, met_from) && !passes_slab(from, tick.hip))
    tick.faults |= bit(Fault::thin_air);
  // What is free may be below a merged face's plane by its slab, one deviation, which lies another below the mesh: so far
  // inside a way may run along the face. Of 1.5 x 10^7 ticks on noisy faces two ways do so by 1.5 deviations.
  if (!way.is_through || is_stopped) return;
  for (int i = 1; i <= kPlaces; ++i) {
    const Hip x = place_between(from, tick.hip, static_cast<double>(i) / kPlaces);
    if (solid.where(x) == InsideGrid::Where::inside && !solid.comes_near(x, x, 2 * moved_)) tick.faults |= bit(Fault::unseen);
  }
}

// By how much corners off their places by the deviation, one at each end, move the foot of a HIP so deep below, on an edge so
// long or a face with such an edge.
double Judge::turned(double edge_length, double depth) const {
  return 2 * specimen_.header().max_deviation * depth / edge_length;
}

// How far a face or an edge of the graph at the god-object, of those that hold it, leads towards the HIP.
double Judge::merged_descent_from(const Tick& tick) const {
  if (tick.after.state == FDCG_FACE) return descent_from(tick);
  if (tick.after.state == FDCG_VERTEX) return merged_descent_at(tick.after.feature, tick);
  return descent_from(tick) - turned(specimen_.edges[tick.after.feature].length, distance(tick.god_object, tick.hip));
}

double Judge::merged_descent_at(std::uint32_t corner, const Tick& tick) const {
  const double depth = distance(tick.god_object, tick.hip);
  const Hip t = difference(tick.hip, specimen_.corners[corner].point);
  const fdcg_graph& graph = specimen_.graph();
  std::vector<std::uint32_t> fan(fdcg_get_fan(&graph, corner, nullptr, 0));
  fdcg_get_fan(&graph, corner, fan.data(), static_cast<std::uint32_t>(fan.size()));
  const auto direction_of = [&](std::uint32_t entry) {
    const Hip& d = specimen_.edges[entry >> 1].direction;
    return (entry & 1) == 0 ? d : Hip{-d[0], -d[1], -d[2]};
  };
  const double sure = kMostPull_eps * tick.rounding;
  double most = 0;
  for (std::size_t i = 0; i < fan.size(); ++i) {
    const EdgeShape& edge = specimen_.edges[fan[i] >> 1];
    const EdgeShape& next_edge = specimen_.edges[fan[i + 1 < fan.size() ? i + 1 : 0] >> 1];
    const Hip along = direction_of(fan[i]), next = direction_of(fan[i + 1 < fan.size() ? i + 1 : 0]);
    const double noise = turned(std::min(edge.length, next_edge.length), depth);
    if (edge.node[1] != FDCG_NONE && in_front_of_edge(edge, tick.hip) < -sure) most = std::max(most, dot(t, along) - noise);
    const std::uint32_t n = edge.node[fan[i] & 1];
    if (n == FDCG_NONE || !(in_front_of_node(n, tick.hip) < -sure)) continue;
    const Hip& normal = specimen_.nodes[n].normal;
    const double height = dot(t, normal);
    const Hip flat = {t[0] - height * normal[0], t[1] - height * normal[1], t[2] - height * normal[2]};
    const bool is_over = dot(cross_product(along, flat), normal) > 0 && dot(cross_product(flat, next), normal) > 0;
    if (is_over) most = std::max(most, norm(flat) - noise);
  }
  return most;
}

// Outwards of an edge or a vertex, not of unit length.
Hip Judge::outwards(const Tick& tick) const {
  if (tick.after.state == FDCG_VERTEX) return specimen_.corners[tick.after.feature].normal;
  const EdgeShape& edge = specimen_.edges[tick.after.feature];
  const Hip &a = specimen_.nodes[edge.node[0]].normal, &b = specimen_.nodes[edge.node[1]].normal;
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

// Whether a god-object may rest there on the mesh, its faces as they are, or so near that merging may have moved it.
bool Judge::rests_on_mesh(const Tick& tick) const {
  const auto rests_beside = [&](std::uint32_t corner) {
    return specimen_.descent->rests_beside(specimen_.corners[corner].point, tick.god_object, moved_, tick.hip);
  };
  const std::uint32_t feature = tick.after.feature;
  if (tick.after.state == FDCG_EDGE)
    return rests_beside(specimen_.edges[feature].corner[0]) || rests_beside(specimen_.edges[feature].corner[1]);
  return rests_beside(feature) || descent_at(feature, tick) <= kMostDescent_eps * tick.rounding;
}

// Whether a hand that an edge or a vertex lets go would be in free air all the way: from in front of the god-object to a place
// somewhat before it, and on, farther from the mesh than the graph's surface may be. A face holds what is behind it and over
// it. What rests on the mesh as well is right: a groove holds however near to its end the foot of the HIP is, though a step
// from there the way would be free.
bool Judge::is_in_merged_air(const Tick& tick) const {
  if (tick.after.state == FDCG_FACE) return false;
  const InsideGrid& solid = *specimen_.inside;
  const double before = kAirPerDeviation * moved_, length = distance(tick.god_object, tick.hip);
  if (!(length > before)) return false;
  const Hip start = place_between(tick.god_object, tick.hip, before / length), out = outwards(tick);
  if (solid.where(start) != InsideGrid::Where::outside || solid.comes_near(start, tick.hip, moved_)) return false;
  Hip front = tick.god_object;
  for (std::size_t i = 0; i < 3; ++i)
    front[i] += before * out[i];
  const InsideGrid::Crossing way = solid.crossing(front, start);  // the solid may be as thin as that
  return solid.where(front) == InsideGrid::Where::outside && !way.is_through && !way.touches && !rests_on_mesh(tick);
}

}  // namespace fdcg::test
