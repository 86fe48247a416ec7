// SPDX-License-Identifier: Apache-2.0
// Broad phase: the objects that a finger can have touched in a tick, and those that it could touch soon.
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

LocalWay local_way(const Tick& tick, const Object& object) {
  const bool may_skip = tick.scene.skips(FDCG_OPT_ROTATION);
  return {tick.pose_before(object).to_object(tick.finger.last, may_skip), object.now.to_object(tick.hip, may_skip)};
}

}  // namespace

bool can_have_met(const Tick& tick, const Object& object, LocalWay* way) {
  const Pose &now = object.now, &before = tick.pose_before(object);
  if (object.bounds.is_endless) {
    *way = local_way(tick, object);
    return smaller(way->from.z, way->to.z) <= 0;
  }
  const double radius = larger(now.radius, before.radius);
  if (!(way_distance2(tick.finger.last - before.centre, tick.hip - now.centre) <= radius * radius)) return false;
  *way = local_way(tick, object);
  return way_meets_box(way->from - object.bounds.centre, way->to - object.bounds.centre, object.bounds.half);
}

namespace {

// An object is near when a finger could reach it within this many ticks at the speeds of this tick (the interval of broad-phase
// updates), and is no further from its bounding sphere than the sphere's radius (so that a jump does not make everything near).
constexpr double kTicksAhead = 64;
// Bound on the rounding error of distances in the world, as a share of the coordinates.
constexpr double kPlaceRounding = 64 * RealLimits<double>::kEpsilon;

struct Approach {
  bool is_in_reach;
  double depth;  // of the HIP within the bounding sphere, negative outside: the deepest get slots first
  double gap;    // motion of HIP and object before they can touch; may be negative
};

Approach approach(const Tick& tick, const Object& object) {
  if (object.bounds.is_endless) {
    LocalWay way;
    const bool is_in_reach = can_have_met(tick, object, &way);
    const double height = way.to.z * object.now.scale;
    return {is_in_reach, -height, height};
  }
  const Pose& now = object.now;
  const double outside = norm(tick.hip - now.centre) - now.radius;
  LocalWay way;
  Approach result = {can_have_met(tick, object, &way), -outside, outside};
  // If only the box separates them, the HIP is within two radii of the centre, and within three until the gap is used up: a
  // precondition of largest_move.
  if (!result.is_in_reach && outside < now.radius) {
    const World local = now.to_object(tick.hip, tick.scene.skips(FDCG_OPT_ROTATION)) - object.bounds.centre;
    result.gap = larger(outside, smaller(box_distance(local, object.bounds.half) * now.scale, now.radius));
  }
  return result;
}

// The nearest objects of a broad-phase update, best first: those in reach by depth, then the others by gap.
struct Candidates {
  struct Candidate {
    uint32_t object;
    Approach approach;
  };
  static constexpr uint32_t kMost = 32;  // fdcg_scene_config.touches_per_finger
  Candidate best[kMost];
  uint32_t count = 0, room;
  double nearest_gap_left_out = HUGE_VAL;
  bool has_overflowed = false;

  explicit Candidates(uint32_t room_for) : room(room_for) {}

  static bool is_better(const Candidate& a, const Candidate& b) {
    if (a.approach.is_in_reach != b.approach.is_in_reach) return a.approach.is_in_reach;
    if (a.approach.is_in_reach) return a.approach.depth > b.approach.depth;
    return a.approach.gap < b.approach.gap;
  }

  void leave_out(const Candidate& candidate) {
    nearest_gap_left_out = smaller(nearest_gap_left_out, candidate.approach.gap);
    if (!candidate.approach.is_in_reach) return;
    nearest_gap_left_out = -HUGE_VAL;
    has_overflowed = true;
  }

  void add(const Candidate& candidate) {
    if (count == room && (room == 0 || !is_better(candidate, best[count - 1]))) return leave_out(candidate);
    if (count == room) leave_out(best[--count]);
    uint32_t place = count++;
    for (; place > 0 && is_better(candidate, best[place - 1]); --place)
      best[place] = best[place - 1];
    best[place] = candidate;
  }
};

// A run of bounding spheres against the finger's way in this tick.
struct Run {
  double distance[kRun];  // a lower bound of the one between the two
  double beyond[kRun];    // by how much that exceeds `ahead`, or the sphere's radius if that is less
};

// A loop without branches, so that compilers make vectors of it; each lane computes what a scalar would. The way's parameter is
// clamped to 0 .. 1 by means of absolute values, which is exact up to rounding error.
void scan_run(const fdcg_scene& scene, World from, World way, double ahead, uint32_t first, Run* __restrict run) {
  const double* const cx = scene.scan(0) + first;
  const double* const cy = scene.scan(1) + first;
  const double* const cz = scene.scan(2) + first;
  const double* const reach = scene.scan(3) + first;
  const double length2 = dot(way, way), half_per_length2 = length2 > 0 ? 0.5 / length2 : 0;
  for (uint32_t i = 0; i < kRun; ++i) {
    const double x = cx[i] - from.x, y = cy[i] - from.y, z = cz[i] - from.z;
    const double half = (x * way.x + y * way.y + z * way.z) * half_per_length2;
    const double positive = half + fabs(half);
    const double t = 0.5 * (positive + 1 - fabs(positive - 1));
    const double dx = x - t * way.x, dy = y - t * way.y, dz = z - t * way.z;
    const double distance = sqrt(dx * dx + dy * dy + dz * dz) - reach[i];
    run->distance[i] = distance;
    run->beyond[i] = distance - 0.5 * (ahead + reach[i] - fabs(ahead - reach[i]));
  }
}

double least_of(const double (&values)[kRun]) {
  double even = values[0], odd = values[1];
  for (uint32_t i = 2; i < kRun; i += 2) {
    even = smaller(values[i], even);
    odd = smaller(values[i + 1], odd);
  }
  return smaller(even, odd);
}

bool has_slot(const Tick& tick, uint32_t object) {
  for (uint32_t s = 0; s < tick.scene.config.touches_per_finger; ++s) {
    if (tick.slots[s].is_held != 0 && tick.slots[s].object == object) return true;
  }
  return false;
}

// Every object: the near ones become candidates, the others' least distance is returned. An object no more than `rounding` away
// is always near.
double find_candidates(const Tick& tick, double ahead, double rounding, Candidates* found) {
  const fdcg_scene& scene = tick.scene;
  const bool by_sphere = scene.skips(FDCG_OPT_FAR_OBJECTS);
  const World from = tick.finger.last, way = tick.hip - from;
  double least = HUGE_VAL;
  Run run;
  for (uint32_t first = 0; first < scene.object_end; first += kRun) {
    scan_run(scene, from, way, ahead, first, &run);
    if (by_sphere && least_of(run.beyond) > rounding) {
      least = smaller(least, least_of(run.distance));
      continue;
    }
    for (uint32_t i = 0; i < kRun; ++i) {
      if (by_sphere && run.beyond[i] > rounding) {
        least = smaller(least, run.distance[i]);
        continue;
      }
      if (scene.scan(3)[first + i] < 0 || has_slot(tick, first + i)) continue;
      const Approach how = approach(tick, scene.objects()[first + i]);
      if (how.gap > rounding + smaller(ahead, scene.scan(3)[first + i]) && !how.is_in_reach) {
        least = smaller(least, how.gap);
      } else {
        found->add({first + i, how});
      }
    }
  }
  return least;
}

// Assigns the finger's free slots to the objects found; existing slots are kept.
void assign_slots(const Tick& tick, const Candidates& found) {
  const uint32_t slot_count = tick.scene.config.touches_per_finger;
  bool has_place[Candidates::kMost] = {};
  for (uint32_t s = 0; s < slot_count; ++s) {
    Slot& slot = tick.slots[s];
    if (slot.is_held != 0) continue;
    bool stays = false;
    for (uint32_t c = 0; c < found.count; ++c) {
      if (found.best[c].object != slot.object) continue;
      stays = has_place[c] = true;
    }
    if (!stays) slot.object = FDCG_NONE;
  }
  uint32_t s = 0, busy = 0;
  for (uint32_t c = 0; c < found.count; ++c) {
    if (has_place[c]) continue;
    while (tick.slots[s].object != FDCG_NONE)
      ++s;
    tick.slots[s].object = found.best[c].object;
    tick.slots[s].step = tick.finger.step - 1;  // never the last step's
  }
  for (s = 0; s < slot_count; ++s)
    busy += tick.slots[s].object != FDCG_NONE;
  tick.finger.busy = busy;
}

}  // namespace

void look(const Tick& tick) {
  fdcg_scene& scene = tick.scene;
  Finger& finger = tick.finger;
  uint32_t held = 0;
  for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s)
    held += tick.slots[s].is_held;
  const double step_length = norm(tick.hip - finger.last);
  const double rounding = kPlaceRounding * (norm1(tick.hip) + step_length + scene.farthest);
  Candidates found(scene.config.touches_per_finger - held);
  double clear = find_candidates(tick, kTicksAhead * (step_length + scene.tick_travel), rounding, &found);
  clear = smaller(clear, found.nearest_gap_left_out);
  if (!scene.skips(FDCG_OPT_FAR_OBJECTS) && (found.count > 0 || held > 0)) clear = -HUGE_VAL;  // look every tick
  assign_slots(tick, found);
  if (found.has_overflowed) {
    finger.flags |= FDCG_FINGER_CONTACT_OVERFLOW;
    ++finger.overflowed_steps;
  }
  finger.anchor = tick.hip;
  // up to a quarter of the distance early
  finger.limit = clear * (kHoldBack - own_bits(scene, finger) * 0x1p-18) - rounding + scene.travel;
  finger.look = scene.look;
  finger.idle_steps = 0;
  ++finger.broadphase_updates;
}

}  // namespace fdcg
