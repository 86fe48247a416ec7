// SPDX-License-Identifier: Apache-2.0
// The step: the friction-cone god-object algorithm of Melder and Harwin (2004) on a Face Directed Connection Graph.
//
//   Free --sweep--> Face | Edge | Vertex          sweep.hpp    where does the hand's way first meet the surface?
//   Face  -> rest | Edge | Vertex | Free          face.hpp     slide to the friction circle, or to the first edge on the way
//   Edge  -> rest | Face | Vertex | Free          edge.hpp     which face pulls more, or slide along the edge
//   Vertex-> rest | Face | Edge | Free            corner.hpp   the steepest descent around the corner
//
// Each rule moves the god-object nearer to the HIP or hands over to a neighbour that climbs further; the step ends where a rule
// rests. Every loop is bounded: work left over is carried to the next tick with a valid god-object.
#include "config.hpp"
#include "corner.hpp"
#include "edge.hpp"
#include "face.hpp"
#include "hooks.hpp"
#include "struct_bytes.hpp"
#include "sweep.hpp"

namespace fdcg {
namespace {

// Changes of state that one step may make. A jump across a strip of needles needs some 1,500, a hand's motion a handful.
#ifndef FDCG_MAX_TRANSITIONS
#define FDCG_MAX_TRANSITIONS 2048
#endif
constexpr uint32_t kMaxTransitions = FDCG_MAX_TRANSITIONS;

// The features visited since the god-object last came nearer to the HIP. To meet one of them again is to go round in a circle
// that only rounding can make: the step rests there (contact-model section 1).
template <class Real>
class Trail {
 public:
  explicit Trail(const Walk<Real>& walk) : nearest2_(distance2(walk)) {}

  bool has_met_again(const Walk<Real>& walk) {
    const Real now2 = distance2(walk);
    if (now2 < nearest2_) {
      nearest2_ = now2;
      count_ = 0;
    }
    for (int i = 0; i < count_; ++i) {
      if (visited_[i] == walk.active) return true;
    }
    if (count_ == kCapacity) return true;
    visited_[count_++] = walk.active;
    return false;
  }

 private:
  static constexpr int kCapacity = 32;  // without a move, a step climbs: vertex, edge, face are three

  static Real distance2(const Walk<Real>& walk) {
    const Vec3<Real> gap = walk.hip - walk.god_object;
    return dot(gap, gap);
  }

  Real nearest2_;
  Feature visited_[kCapacity];
  int count_ = 0;
};

template <class Real>
Decision apply_rule(Walk<Real>& walk) {
  switch (walk.active.state) {
    case FDCG_FACE:
      return face_rule(walk);
    case FDCG_EDGE:
      return edge_rule(walk);
    default:
      return corner_rule(walk);
  }
}

// From free space, or from the surface that was just left: places the contact on what the way to the HIP meets.
// Returns the flag of a bounded sweep, else 0.
template <class Real>
uint32_t sweep_to_hip(Walk<Real>& walk, Feature left) {
  using Kind = typename SweepResult<Real>::Kind;
  const SweepResult<Real> found = Sweep<Real>(walk, left).run();
  if (found.kind == Kind::hit && found.feature.state == FDCG_EDGE) {
    const EdgeLine<Real> line(walk.graph.edge(found.feature.index));
    walk.active = place_on_edge(walk, found.feature.index, line, line.parameter(found.point));
    return 0;
  }
  walk.active = found.feature;
  walk.place(found.kind == Kind::clear ? walk.hip : found.point, kFree);
  return found.kind == Kind::bounded ? uint32_t{FDCG_RESULT_SWEEP_BOUND} : 0;
}

// Drives the rules until one rests. Returns the changes of state; adds to *flags what was cut short.
template <class Real>
uint32_t move_god_object(Walk<Real>& walk, uint32_t* flags) {
  uint32_t transitions = 0;
  if (walk.active == kFree) {
    *flags |= sweep_to_hip(walk, kFree);
    if (walk.active == kFree) return 0;
    ++transitions;
  }
  Trail<Real> trail(walk);
  trail.has_met_again(walk);
  while (true) {
    const Feature at = walk.active;
    const Decision decision = apply_rule(walk);
    if (decision.is_rest) return transitions;
    walk.active = decision.next;
    ++transitions;
    if (walk.active == kFree) {
      *flags |= sweep_to_hip(walk, at);
      if (walk.active == kFree) return transitions;
      ++transitions;
    }
    if (trail.has_met_again(walk)) return transitions;
    if (transitions >= kMaxTransitions) {
      *flags |= FDCG_RESULT_TRANSITION_BOUND;
      return transitions;
    }
  }
}

// A HIP further away than this is nowhere near any graph (load.cpp limits scale and origin), and its arithmetic might
// overflow before it is found out.
constexpr double kFarthestHip_m = 1e110;

// The HIP in the graph's frame. False, without an overflow on the way, where it is not usable.
// Never inlined: GCC 12's basic-block vectoriser (-O2) drops the rounding of a double to float and back where it sees both.
template <class Real>
[[gnu::noinline]] bool to_local(const fdcg_header& header, const double hip_object_m[3], Vec3<Real>* hip) {
  double local[3];
  for (int k = 0; k < 3; ++k) {
    if (!(absolute(hip_object_m[k]) <= kFarthestHip_m)) return false;
    local[k] = hip_object_m[k] / header.metres_per_unit - header.origin[k];
    if (!(absolute(local[k]) <= RealLimits<Real>::kFar)) return false;
  }
  *hip = {static_cast<Real>(local[0]), static_cast<Real>(local[1]), static_cast<Real>(local[2])};
  return is_usable(*hip);
}

// Whether the graph has such a feature: asked by an assertion alone.
[[maybe_unused]] bool is_of_graph(Feature feature, const fdcg_header& header) {
  const uint32_t count[] = {0, header.node_count, header.connection_count, header.corner_count};
  return feature == kFree || (feature.state <= FDCG_VERTEX && feature.index < count[feature.state]);
}

template <class Real>
Vec3<Real> narrow(const double (&a)[3]) {
  return {static_cast<Real>(a[0]), static_cast<Real>(a[1]), static_cast<Real>(a[2])};
}

template <class Real>
void store(Vec3<Real> from, double (&to)[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

// F = k (GO - HIP), with damping along the same line; never a pull (contact-model section 8). Newtons, from local positions.
void respond(const fdcg_header& header, const fdcg_params& params, const fdcg_contact& contact, const double (&before)[3],
             fdcg_result* result) {
  const double scale = header.metres_per_unit;
  double spring[3], moved_along = 0, length2 = 0;
  for (int k = 0; k < 3; ++k) {
    spring[k] = contact.god_object[k] - contact.hip[k];
    moved_along += (contact.hip[k] - before[k]) * spring[k];
    length2 += spring[k] * spring[k];
    result->god_object_m[k] = (contact.god_object[k] + header.origin[k]) * scale;
  }
  double newtons_per_unit = params.stiffness_n_per_m * scale;
  if (params.damping_n_s_per_m > 0 && length2 > 0) {
    newtons_per_unit -= params.damping_n_s_per_m * scale * (moved_along / length2) / params.tick_s;
    if (!(newtons_per_unit > 0)) newtons_per_unit = 0;
  }
  for (int k = 0; k < 3; ++k)
    result->force_n[k] = newtons_per_unit * spring[k];
}

template <class Real>
void step(const fdcg_graph& raw, const fdcg_params& params, fdcg_contact* contact, const double hip_object_m[3],
          fdcg_result* result) {
  const GraphView<Real> graph(raw);
  Vec3<Real> hip;
  *result = {};
  if (!to_local(*raw.header, hip_object_m, &hip)) {
    ++contact->non_finite_ticks;
    result->flags = FDCG_RESULT_NON_FINITE;
    for (int k = 0; k < 3; ++k) {
      result->god_object_m[k] = (contact->god_object[k] + raw.header->origin[k]) * raw.header->metres_per_unit;
    }
  } else {
    const bool is_first = contact->started == 0;
    Walk<Real> walk = {
        graph,
        {static_cast<Real>(params.mu_static), static_cast<Real>(params.mu_dynamic), params.edge_friction == FDCG_EDGE_WEDGE},
        hip,
        plane_rounding_bound(graph, hip),
        is_first ? hip : narrow<Real>(contact->god_object),
        {contact->state, contact->feature},
        {contact->seat_state, contact->seat_feature},
        contact->slipping != 0};
    if (is_first) walk.active = walk.seat = kFree;
    double before[3];
    for (int k = 0; k < 3; ++k)
      before[k] = contact->hip[k];
    store(hip, contact->hip);
    if (is_first) store(hip, before);
    contact->started = 1;
    if (!is_first) result->transitions = move_god_object(walk, &result->flags);
    FDCG_ASSERT(is_usable(walk.god_object) && is_of_graph(walk.active, *raw.header));
    if (walk.active == kFree) walk.is_slipping = false;
    store(walk.god_object, contact->god_object);
    contact->state = walk.active.state;
    contact->feature = walk.active.index;
    contact->seat_state = walk.seat.state;
    contact->seat_feature = walk.seat.index;
    contact->slipping = walk.is_slipping ? 1 : 0;
    contact->transition_bound_ticks += (result->flags & FDCG_RESULT_TRANSITION_BOUND) != 0;
    contact->sweep_bound_ticks += (result->flags & FDCG_RESULT_SWEEP_BOUND) != 0;
    respond(*raw.header, params, *contact, before, result);
    if (walk.active == kFree) {
      for (int k = 0; k < 3; ++k)
        result->force_n[k] = 0;
    }
  }
  result->state = contact->state;
  result->feature = contact->state == FDCG_FREE ? FDCG_NONE : contact->feature;  // a contact of zeros is free, and on nothing
  result->slipping = contact->slipping;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                          const double hip_object_m[3], fdcg_result* result) {
  fdcg_params room;
  const fdcg_params& all_params = fdcg::in_full(*params, &room, fdcg_init_params);
  fdcg::with_real_of(*graph->header,
                     [&](auto real) { fdcg::step<decltype(real)>(*graph, all_params, contact, hip_object_m, result); });
}
