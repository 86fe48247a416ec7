// SPDX-License-Identifier: Apache-2.0
#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fdcg::test {
namespace {

// In long double: what is measured are units in the last place.
long double long_length(const Hip& a, const Hip& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const long double d = static_cast<long double>(a[i]) - b[i];
    sum += d * d;
  }
  return std::sqrt(sum);
}
double square_distance(const Hip& a, const Hip& b) {
  const Hip d = difference(a, b);
  return dot(d, d);
}
constexpr double kPlaces = 5;  // extents, in a sum of coordinates and two extents: contact-model SIDE-1
constexpr std::uint32_t kCarried = FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND;

}  // namespace

std::string_view name_of(Fault fault) {
  constexpr std::string_view kNames[] = {"nan",      "rule-bound", "sweep-bound", "growth", "push-through",
                                         "unseen",   "thin-air",   "off-surface", "pull",   "restless",
                                         "descent",  "free-air",   "no-force",    "report", "force",
                                         "friction", "wrong-face", "uncertified", "stalled"};
  static_assert(std::size(kNames) == kFaults);
  return kNames[static_cast<std::size_t>(fault)];
}

std::optional<Fault> fault_named(std::string_view name) {
  for (std::size_t i = 0; i < kFaults; ++i) {
    if (name_of(static_cast<Fault>(i)) == name) return static_cast<Fault>(i);
  }
  return std::nullopt;
}

void Verdicts::add(const Verdicts& more) {
  for (std::size_t i = 0; i < kFaults; ++i)
    count[i] += more.count[i];
  shallow += more.shallow;
  most_carried = std::max(most_carried, more.most_carried);
  certified += more.certified;
  carried += more.carried;
  slit += more.slit;
  between += more.between;
  other += more.other;
  worst_growth_eps = std::max(worst_growth_eps, more.worst_growth_eps);
  worst_off_surface_eps = std::max(worst_off_surface_eps, more.worst_off_surface_eps);
  worst_restless_eps = std::max(worst_restless_eps, more.worst_restless_eps);
  worst_pull_eps = std::max(worst_pull_eps, more.worst_pull_eps);
  worst_inside_eps = std::max(worst_inside_eps, more.worst_inside_eps);
  worst_descent_eps = std::max(worst_descent_eps, more.worst_descent_eps);
}

Judge::Judge(const Specimen& specimen, bool owes_force)
    : specimen_(specimen),
      owes_force_(owes_force),
      epsilon_(specimen.epsilon()),
      deviation_(kPerDeviation * specimen.header().max_deviation),
      moved_(specimen.stated_deviation + kPlaces * kSlab_eps * epsilon_ * specimen.header().extent),
      is_exact_(specimen.stated_deviation == 0 && specimen.body.soup.corners.size() == 3 * specimen.body.soup.face_count()) {}

std::uint32_t Judge::judge(const fdcg_contact& before, const Hip& hip_m, const fdcg_contact& after, const fdcg_result& result,
                           Verdicts& v) {
  Tick tick = {before, after, result, hip_of(after.hip), hip_of(after.god_object), 0, 0, false};
  const double far = std::max({std::abs(tick.hip[0]), std::abs(tick.hip[1]), std::abs(tick.hip[2])});
  tick.rounding = epsilon_ * std::max(far, specimen_.header().extent);
  look_at_numbers(tick);
  if ((result.flags & FDCG_RESULT_NON_FINITE) == 0 && tick.faults == 0) {
    look_at_result(tick, hip_m);
    if ((result.flags & FDCG_RESULT_TRANSITION_BOUND) != 0) tick.faults |= bit(Fault::rule_bound);
    if ((result.flags & FDCG_RESULT_SWEEP_BOUND) != 0) tick.faults |= bit(Fault::sweep_bound);
    look_at_carried(tick);
    if (before.started != 0 && (last_flags_ & FDCG_RESULT_SWEEP_BOUND) == 0) {
      if (after.state != FDCG_FREE) look_at_growth(tick, v);
      if (is_same(before.hip, after.hip)) look_at_rest(tick, v);
      if (before.state == FDCG_FREE) look_at_way(tick);
    }
    if (after.state != FDCG_FREE) {
      look_at_feature(tick, v);
      if ((result.flags & kCarried) == 0) look_at_pull(tick, v);
      if ((result.flags & kCarried) == 0) {
        look_at_place(tick, v);
        if (specimen_.body.sheets_meet) pass_over_between_sheets(tick, v);
      } else {
        ++v.carried;
      }
    }
    if (specimen_.inside != nullptr) {
      if (owes_force_) look_at_owed_force(tick);
      look_inside(tick, v);
    }
  }
  if ((result.flags & FDCG_RESULT_NON_FINITE) == 0) {
    last_flags_ = result.flags;
    carried_ = (result.flags & kCarried) != 0 ? carried_ + 1 : 0;
    v.most_carried = std::max(v.most_carried, carried_);
  }
  if (tick.faults != 0) {
    for (std::size_t i = 0; i < kFaults; ++i)
      v.count[i] += tick.faults >> i & 1;
  }
  return tick.faults;
}

void Judge::look_at_numbers(Tick& tick) const {
  const fdcg_result& r = tick.result;
  const double sum = (r.force_n[0] + r.force_n[1] + r.force_n[2]) * 0 +
                     (r.god_object_m[0] + r.god_object_m[1] + r.god_object_m[2]) * 0 +
                     (tick.god_object[0] + tick.god_object[1] + tick.god_object[2]) * 0;
  if (sum != 0) tick.faults |= bit(Fault::not_a_number);  // true for NaN
  if ((r.flags & FDCG_RESULT_NON_FINITE) == 0) return;
  const fdcg_contact &a = tick.before, &b = tick.after;
  const bool is_kept = a.state == b.state && a.feature == b.feature && is_same(a.god_object, b.god_object) &&
                       is_same(a.hip, b.hip) && a.slipping == b.slipping;
  if (!is_kept || r.force_n[0] != 0 || r.force_n[1] != 0 || r.force_n[2] != 0) tick.faults |= bit(Fault::not_a_number);
}

void Judge::look_at_growth(Tick& tick, Verdicts& v) const {
  const Hip start = hip_of(tick.before.state == FDCG_FREE ? tick.before.hip : tick.before.god_object);
  if (square_distance(tick.god_object, tick.hip) <= square_distance(start, tick.hip)) return;
  double growth = static_cast<double>(long_length(tick.god_object, tick.hip) - long_length(start, tick.hip)) - deviation_;
  // Met on a way, in a tick that began free, or let the contact go and met another face.
  const bool may_have_met =
      tick.before.state == FDCG_FREE ||
      (tick.after.state == FDCG_FACE && (tick.before.state != FDCG_FACE || tick.before.feature != tick.after.feature));
  if (may_have_met && deviation_ > 0) growth -= slab_around(start);
  v.worst_growth_eps = std::max(v.worst_growth_eps, growth / tick.rounding);
  if (growth > kMostGrowth_eps * tick.rounding) tick.faults |= bit(Fault::growth);
}

// How far behind a merged face's plane a way may begin that meets it. Its corners lie off its plane, so no exact sign tells two
// such neighbours' sides apart: what is in front of one within the rounding of a plane's distance is in front of the other, or
// a way would slip through their seam. The step bounds that rounding by 8 eps of the coordinates' sum and two extents; from
// there to the plane the god-object moves away from the HIP.
double Judge::slab_around(const Hip& x) const {
  const double sum = std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]);
  return kSlab_eps * epsilon_ * (sum + 2 * specimen_.header().extent);
}

void Judge::look_at_rest(Tick& tick, Verdicts& v) const {
  if ((last_flags_ & kCarried) != 0) return;  // work in hand is no rest
  if ((tick.before.state == FDCG_FREE) != (tick.after.state == FDCG_FREE)) {
    tick.faults |= bit(Fault::restless);
    return;
  }
  if (is_same(tick.before.god_object, tick.after.god_object)) return;
  // Where GO is nearest, a change of its place changes its distance by the square: d may be sqrt(2 gap rounding).
  const Hip was = hip_of(tick.before.god_object);
  const double gap = distance(tick.god_object, tick.hip), allowed = kMostRestless_eps * tick.rounding + deviation_;
  const double nearer = static_cast<double>(long_length(was, tick.hip) - long_length(tick.god_object, tick.hip));
  v.worst_restless_eps = std::max(v.worst_restless_eps, (nearer - deviation_) / tick.rounding);
  const bool is_moving = distance(was, tick.god_object) > allowed + 2 * std::sqrt(2 * gap * allowed);
  if (nearer > allowed || is_moving) tick.faults |= bit(Fault::restless);
}

// Whatever the rules leave for the next tick, each move takes the god-object nearer: no circle (contact-model TICK-5, BOUND-1).
void Judge::look_at_carried(Tick& tick) {
  const auto is_at_work = [](std::uint32_t flags) { return (flags & FDCG_RESULT_TRANSITION_BOUND) != 0; };
  const bool is_held = is_same(tick.before.hip, tick.after.hip) && is_at_work(last_flags_) && is_at_work(tick.result.flags);
  const bool gets_nowhere =
      is_held && long_length(tick.god_object, tick.hip) >= long_length(hip_of(tick.before.god_object), tick.hip);
  stalled_ = gets_nowhere ? stalled_ + 1 : 0;
  if (stalled_ >= kSlowTicks + specimen_.nodes.size() / kFacesATick) tick.faults |= bit(Fault::stalled);
}

void Judge::look_at_feature(Tick& tick, Verdicts& v) const {
  double off = 0;
  const Hip& x = tick.god_object;
  if (tick.after.state == FDCG_FACE) {
    const NodeShape& node = specimen_.nodes[tick.after.feature];
    off = std::abs(signed_distance(node.normal, node.offset, x));
    for (std::uint32_t k = 0; k < node.side_count; ++k) {
      const Rim& rim = specimen_.rims[node.first_side + k];
      off = std::max(off, signed_distance(rim.normal, rim.offset, x));
    }
  } else if (tick.after.state == FDCG_EDGE) {
    const EdgeShape& edge = specimen_.edges[tick.after.feature];
    const Hip from_start = difference(x, edge.start);
    const double along = dot(from_start, edge.direction);
    Hip beside;
    for (std::size_t i = 0; i < 3; ++i)
      beside[i] = from_start[i] - edge.direction[i] * along;
    off = std::max({norm(beside), -along, along - edge.length});
  } else {
    off = distance(x, specimen_.corners[tick.after.feature].point);
  }
  off -= deviation_;
  if (off <= 0) return;
  v.worst_off_surface_eps = std::max(v.worst_off_surface_eps, off / tick.rounding);
  if (off > kMostOffSurface_eps * tick.rounding) tick.faults |= bit(Fault::off_surface);
}

double Judge::in_front_of_node(std::uint32_t node, const Hip& x) const {
  return signed_distance(specimen_.nodes[node].normal, specimen_.nodes[node].offset, x);
}

double Judge::in_front_of_edge(const EdgeShape& edge, const Hip& x) const {
  const double a = in_front_of_node(edge.node[0], x);
  const double b = edge.node[1] == FDCG_NONE ? a : in_front_of_node(edge.node[1], x);
  return edge.type == FDCG_CONCAVE ? std::min(a, b) : std::max(a, b);
}

// At a groove's end the groove holds, by its friction too, whatever the corner's normal says: it points away from all faces
// together.
double Judge::in_front_of_corner(std::uint32_t corner, const Hip& x, double rounding) const {
  const CornerShape& shape = specimen_.corners[corner];
  const Hip from_corner = difference(x, shape.point);
  if (is_exact_ && !shape.is_open && !shape.is_shared)
    return specimen_.descent->begins_outside(shape.point, x) ? norm(from_corner) : 0;
  double front = dot(from_corner, shape.normal);
  if (front <= kMostPull_eps * rounding) return front;
  const fdcg_graph& graph = specimen_.graph();
  std::vector<std::uint32_t> fan(fdcg_get_fan(&graph, corner, nullptr, 0));
  fdcg_get_fan(&graph, corner, fan.data(), static_cast<std::uint32_t>(fan.size()));
  for (const std::uint32_t entry : fan) {
    const EdgeShape& edge = specimen_.edges[entry >> 1];
    const double along = dot(from_corner, edge.direction) * ((entry & 1) == 0 ? 1 : -1);
    if (edge.type != FDCG_CONCAVE || along < -kMostOffSurface_eps * rounding) continue;
    front = std::min(front, in_front_of_edge(edge, x));
  }
  return front;
}

// An open corner holds nothing that every edge there leads away from (contact-model CORNER-5).
bool Judge::is_beyond_open_corner(const Tick& tick) const {
  const CornerShape& corner = specimen_.corners[tick.after.feature];
  if (!corner.is_open) return false;
  const fdcg_graph& graph = specimen_.graph();
  std::vector<std::uint32_t> fan(fdcg_get_fan(&graph, tick.after.feature, nullptr, 0));
  fdcg_get_fan(&graph, tick.after.feature, fan.data(), static_cast<std::uint32_t>(fan.size()));
  const Hip t = difference(tick.hip, corner.point);
  const double sure = kMostPull_eps * tick.rounding + deviation_;
  return std::all_of(fan.begin(), fan.end(), [&](std::uint32_t entry) {
    return dot(t, specimen_.edges[entry >> 1].direction) * ((entry & 1) == 0 ? 1 : -1) < -sure;
  });
}

// How far the HIP is in front of what holds it.
void Judge::look_at_pull(Tick& tick, Verdicts& v) const {
  const std::uint32_t feature = tick.after.feature;
  if (tick.after.state == FDCG_VERTEX && is_beyond_open_corner(tick)) tick.faults |= bit(Fault::pull);
  double front = tick.after.state == FDCG_FACE   ? in_front_of_node(feature, tick.hip)
                 : tick.after.state == FDCG_EDGE ? in_front_of_edge(specimen_.edges[feature], tick.hip)
                                                 : in_front_of_corner(feature, tick.hip, tick.rounding);
  // A face holds what is behind it: on its plane is not behind it (contact-model FACE-1).
  const bool may_be_on = tick.after.state == FDCG_FACE && deviation_ == 0 && front > -kMostPull_eps * tick.rounding;
  if (may_be_on && specimen_.nodes[feature].is_planar && specimen_.exact_side(feature, tick.hip) >= 0)
    tick.faults |= bit(Fault::pull);
  front -= deviation_;
  if (front <= 0) return;
  v.worst_pull_eps = std::max(v.worst_pull_eps, front / tick.rounding);
  if (front > kMostPull_eps * tick.rounding) tick.faults |= bit(Fault::pull);
}

// How far a face or an edge at the god-object leads towards the HIP; at a corner all the way where the way itself is free.
double Judge::descent_from(const Tick& tick) const {
  const Hip gap = difference(tick.hip, tick.god_object);
  if (tick.after.state == FDCG_FACE) {
    const Hip& n = specimen_.nodes[tick.after.feature].normal;
    const double height = dot(gap, n);
    return norm({gap[0] - height * n[0], gap[1] - height * n[1], gap[2] - height * n[2]});
  }
  if (tick.after.state == FDCG_EDGE) {
    const EdgeShape& edge = specimen_.edges[tick.after.feature];
    double most = has_friction_ ? 0 : std::abs(dot(gap, edge.direction));
    // Where it ends, but for rounding, the corner is meant (contact-model FACE-6).
    for (const std::uint32_t corner : edge.corner) {
      if (has_friction_ || !is_meant(corner, tick.god_object)) continue;
      most = std::max(most, is_exact_ ? descent_at(corner, tick) : merged_descent_at(corner, tick));
    }
    const Hip t = difference(tick.hip, edge.start);
    for (const std::uint32_t n : edge.node) {  // square to the edge, into the face
      if (n == FDCG_NONE) continue;
      // On the cone's rim and on the edge but for rounding, which name it gets is open: the face's friction may hold it.
      const bool may_pull = !has_friction_ || in_front_of_node(n, tick.hip) < -kMostDescent_eps * tick.rounding;
      if (!may_pull || (has_friction_ && is_held_by_face(tick, n))) continue;
      const Hip& normal = specimen_.nodes[n].normal;
      const Hip across = n == edge.node[0] ? cross_product(normal, edge.direction) : cross_product(edge.direction, normal);
      most = std::max(most, dot(has_friction_ ? t : gap, across));
    }
    return most;
  }
  return descent_at(tick.after.feature, tick);
}

double Judge::descent_at(std::uint32_t corner, const Tick& tick) const {
  const Hip& point = specimen_.corners[corner].point;
  const double reach = specimen_.descent->reach(point, tick.hip);
  if (reach > kMostDescent_eps * tick.rounding || !specimen_.descent->begins_outside(point, tick.hip)) return reach;
  return distance(point, tick.hip);
}

// Whether a place on an edge is so near to a corner at its end that the corner is active by rule: half as near, since the place
// is rounded.
bool Judge::is_meant(std::uint32_t corner, const Hip& place) const {
  return distance(place, specimen_.corners[corner].point) <= kEnd_eps / 2 * epsilon_ * specimen_.header().extent;
}

// Where a god-object may be that is at rest.
void Judge::look_at_place(Tick& tick, Verdicts& v) {
  const bool is_still_to_judge = !look_at_descent(tick, v);
  const bool is_rubbing = look_at_friction(tick);
  look_at_choice(tick);
  look_at_certificate(tick, v);
  if (!is_still_to_judge || is_rubbing) return;
  ++(tick.after.state == FDCG_EDGE ? v.slit : v.other);
}

bool Judge::look_at_descent(Tick& tick, Verdicts& v) const {
  const bool is_corner = tick.after.state == FDCG_VERTEX;  // where friction holds nothing
  const bool is_closed = specimen_.inside != nullptr, is_exact = is_exact_ && is_closed;
  if (!is_closed && !is_corner) return false;
  if (has_friction_ && !is_corner && (!is_exact || tick.after.state == FDCG_FACE)) return false;
  const double reach = is_exact ? descent_from(tick) : merged_descent_from(tick) - deviation_;
  v.worst_descent_eps = std::max(v.worst_descent_eps, reach / tick.rounding);
  if (!is_exact && !has_friction_ && is_closed && is_in_merged_air(tick))
    tick.faults |= bit(Fault::descent) | bit(Fault::free_air);
  if (!(reach > kMostDescent_eps * tick.rounding) || (is_corner && has_friction_ && is_held_at_corner(tick))) return true;
  tick.faults |= bit(Fault::descent);
  if (is_closed && specimen_.inside->where(tick.hip) == InsideGrid::Where::outside) tick.faults |= bit(Fault::free_air);
  return true;
}

// A contact that was free: what its way met.
void Judge::look_at_way(Tick& tick) {
  if (specimen_.inside == nullptr || !is_known_outside_) return;
  if ((tick.result.flags & kCarried) != 0 || is_let_off(tick.hip)) return;
  const Hip from = hip_of(tick.before.hip);  // from far away the step cuts the way, where rounding may move it
  if (std::abs(from[0]) + std::abs(from[1]) + std::abs(from[2]) > 8 * specimen_.header().extent) return;
  if (!is_exact_) return look_at_merged_way(tick);
  const bool is_stopped = tick.result.transitions > 0;
  const InsideGrid::Crossing way = specimen_.inside->crossing(from, tick.hip);
  tick.is_way_clear = !way.is_through && !way.touches;
  if (way.is_through && !is_stopped) tick.faults |= bit(Fault::unseen);
  if (!is_stopped) return;
  const bool is_held = tick.after.state != FDCG_FREE;
  const auto may_be_inside = [&] {  // as one inside may be taken for outside
    return specimen_.inside->distance_to_surface(tick.hip) <= kShallow_eps * epsilon_ * specimen_.inside->size();
  };
  if (is_held && way.touches && !way.is_through && specimen_.inside->grazes(from, tick.hip) && !may_be_inside())
    tick.faults |= bit(Fault::thin_air);
  if (!tick.is_way_clear) return;
  if (is_held ? !may_be_inside() : !passes_busy_corner(from, tick.hip)) tick.faults |= bit(Fault::thin_air);
}

// A busy corner that a way passes within rounding may be met, to be let go in the same tick (contact-model FREE-8, CORNER-4).
// Nothing else may be met by a way that is clear. The rounding is that of the rule, where hundreds of faces are within it, and
// of the doubles that it is asked in.
bool Judge::passes_busy_corner(const Hip& from, const Hip& to) const {
  constexpr double kRule_eps = 4, kDouble = 0x1p-50;
  const Hip way = difference(to, from);
  for (const Hip& corner : specimen_.busy_points) {
    const Hip reach = difference(corner, from);
    const double share = std::clamp(dot(reach, way) / dot(way, way), 0.0, 1.0);
    const Hip nearest = {from[0] + share * way[0], from[1] + share * way[1], from[2] + share * way[2]};
    const double sum = std::abs(corner[0]) + std::abs(corner[1]) + std::abs(corner[2]) + specimen_.header().extent;
    if (long_length(nearest, corner) <= kRule_eps * epsilon_ * sum + kDouble * (sum + norm(way))) return true;
  }
  return false;
}

// Around an apex of 10^4 faces the grid's cells hold them all: there one tick in some dozens is asked for.
bool Judge::is_let_off(const Hip& point) {
  constexpr std::size_t kCrowd = 64;
  const std::size_t crowd = specimen_.inside->crowd_at(point);
  if (crowd <= kCrowd) return false;
  asked_ += 1;
  return asked_ % (crowd / kCrowd + 1) != 0;
}

// Where work is carried over: the god-object stays where its way began, the HIP may be inside.
void Judge::look_at_owed_force(Tick& tick) {
  const double* force = tick.result.force_n;
  if (force[0] != 0 || force[1] != 0 || force[2] != 0 || !is_known_outside_ ||
      (tick.result.flags & FDCG_RESULT_SWEEP_BOUND) == 0)
    return;
  if (specimen_.inside->where(tick.hip) != InsideGrid::Where::inside) return;
  const double depth = specimen_.inside->distance_to_surface(tick.hip) - moved_inside();
  if (depth > kShallow_eps * epsilon_ * specimen_.inside->size()) tick.faults |= bit(Fault::no_force);
}

void Judge::look_inside(Tick& tick, Verdicts& v) {
  const bool was_outside = std::exchange(is_outside_, false);
  if (tick.after.state != FDCG_FREE) {
    is_known_outside_ = true;  // if the contact is lost, the HIP has left
    return;
  }
  if (was_outside && (tick.is_way_clear || is_same(tick.before.god_object, tick.after.god_object))) {
    is_outside_ = true;
    return;
  }
  if (is_let_off(tick.god_object)) return;
  const InsideGrid::Where where = specimen_.inside->where(tick.god_object);  // the HIP, or how far a carried sweep has come
  is_outside_ = where == InsideGrid::Where::outside;
  // A contact that begins nearer to the mesh than merging moved the graph's surface may begin inside of the graph (TICK-3).
  if (is_outside_ && !is_known_outside_)
    is_known_outside_ =
        specimen_.stated_deviation == 0 || !specimen_.inside->comes_near(tick.god_object, tick.god_object, moved_);
  if (where != InsideGrid::Where::inside || !is_known_outside_) return;
  const bool is_on_its_way = (tick.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;  // may start on the surface
  is_known_outside_ = is_on_its_way;                                              // once is enough
  const double size = specimen_.inside->size();
  const double depth = specimen_.inside->distance_to_surface(tick.god_object) - moved_inside();
  v.worst_inside_eps = std::max(v.worst_inside_eps, depth / (epsilon_ * size));
  if (depth > (is_on_its_way ? kMostOffSurface_eps * tick.rounding : kShallow_eps * epsilon_ * size)) {
    tick.faults |= bit(Fault::push_through);
  } else {
    ++v.shallow;
  }
}

}  // namespace fdcg::test
