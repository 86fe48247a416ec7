// SPDX-License-Identifier: Apache-2.0
// A tick of a contact on shaded faces with smooth edges between them, with two coefficients and one stiffness: what a moving
// hand meets most. As the rules of shading.hpp one after the other, without what serves other ends of theirs. Whatever is not
// plain is left to them, from the start of the tick.
#pragma once

#include "step/contact_internals.hpp"
#include "step/shading.hpp"

namespace fdcg {

inline constexpr int kMostShadedHops = 16;  // edges crossed in such a tick

// Where it has led so far.
template <class Real>
struct ShadedTick {
  uint32_t node;
  uint32_t edge;         // the last that it went over, or FDCG_NONE
  uint32_t transitions;  // edges crossed
  bool is_slipping;
  bool is_rest;  // friction holds it: it slides to no place on the last face
  Vec3<Real> god_object;
};

static_assert(sizeof(NormalField) == sizeof(KeptField::normals) && alignof(NormalField) == alignof(double));
inline NormalField& normals_of(KeptField& kept) {
  return *reinterpret_cast<NormalField*>(kept.normals);
}

// Keeps the field of a node; a flat one has its own normal. False: there is none.
template <class Geometry>
[[gnu::noinline]] bool make_kept_field(const fdcg_graph& raw, const GraphView<Geometry>& graph, uint32_t index,
                                       KeptField* kept) {
  const NodeRef<Geometry> node = graph.node(index);
  const fdcg_node_normals& normals = raw.normals[index];
  kept->of_node = 0;
  normals_of(*kept) = {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
  if (!is_flat(normals) && !make_field(graph, node, frame_of(node), normals, &normals_of(*kept))) return false;
  kept->of_node = uint64_t{index} + 1;
  return true;
}

inline bool is_same_code(const uint16_t (&a)[2], const uint16_t (&b)[2]) {
  return a[0] == b[0] && a[1] == b[1] && !is_flat_code(a);
}

// Goes over the side that a move to `target` meets, where both faces have the same normals along it (contact-model SHADE-4).
// False: not plainly so.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] bool hop_over_smooth_edge(const fdcg_graph& raw, const GraphView<Geometry>& graph, Crossing<Real> crossing,
                                            const Vec3<Real>& target, ShadedTick<Real>* tick) {
  const NodeRef<Geometry> here = graph.node(tick->node);
  const uint32_t k = crossing.local_side;
  const fdcg_side& crossed = here.side(k);
  if (crossed.across == FDCG_NONE || crossed.link >> 1 == tick->edge || here.side_count() != 3) return false;
  const NodeRef<Geometry> there = graph.node(crossed.across);
  const uint32_t back = there.side_of_link(crossed.link ^ 1u);
  if (there.side_count() != 3 || back > 2) return false;
  const fdcg_node_normals &from = raw.normals[tick->node], &to = raw.normals[crossed.across];
  if (!is_same_code(from.corner[k], to.corner[there.next(back)]) || !is_same_code(from.corner[here.next(k)], to.corner[back]))
    return false;
  const Vec3<Real> landed = tick->god_object + (target - tick->god_object) * crossing.fraction;
  const Edge<Real> edge = graph.edge(here, k);
  const Real u = dot(landed - edge.start, edge.direction), end_tolerance = end_rounding(here.extent());
  if (!(u > end_tolerance && edge.length - u > end_tolerance)) return false;
  tick->god_object = by_parts(edge.start + edge.direction * u);
  tick->node = crossed.across;
  tick->edge = crossed.link >> 1;
  ++tick->transitions;
  return true;
}

// From where the contact stands, on tick->node, to where it comes to rest or slides; `last`: from the HIP to the god-object
// after the last tick. False: the rules are to be asked. What is not for an edge that is crossed stays in registers: numbers
// stored one by one, and copied two at once, take as long as a step of Newton's.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT bool slides_on_shaded_faces(const fdcg_graph& raw, Vec3<Real> hip, Vec3<double> last, PlainFriction<Real> friction,
                                     KeptField* field, ShadedTick<Real>* tick) {
  const GraphView<Geometry> graph(raw);
  const Real bound = plane_rounding_bound(graph, hip);
  if (is_far(graph, hip)) return false;
  uint32_t index = tick->node;
  Vec3<Real> god_object = by_parts(tick->god_object);
  for (uint32_t hops = 0; hops < kMostShadedHops; ++hops) {
    const NodeRef<Geometry> node = graph.node(index);
    const Real side = distance_from(node, hip);
    if (!(side < -bound)) return false;
    if (field->of_node != uint64_t{index} + 1 && !make_kept_field(raw, graph, index, field)) return false;
    Vec3<Real> target;
    const bool is_rest =
        rests_while_shaded(quick_frame_of(node), normals_of(*field), &friction, god_object, hip, -side, last, &target);
    tick->is_rest = is_rest;
    tick->is_slipping = friction.is_slipping;
    if (is_rest) return hops == 0;
    const Crossing<Real> crossing = first_crossing(node, god_object, target, bound);
    if (crossing.local_side == FDCG_NONE) {
      tick->god_object = by_parts(target);
      return is_usable(target);
    }
    const Vec3<Real> beyond = by_parts(target);
    if (!hop_over_smooth_edge(raw, graph, crossing, beyond, tick)) return false;
    index = tick->node;
    god_object = by_parts(tick->god_object);
  }
  return false;
}

}  // namespace fdcg
