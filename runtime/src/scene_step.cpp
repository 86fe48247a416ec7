// SPDX-License-Identifier: Apache-2.0
// A scene's tick: take in poses, and for each finger find out which objects it can have met, and step those contacts.
//
//   out of reach     the finger's own way since its last look and the objects' largest since then have not used up the distance
//                    that it saw: nothing to do
//   look             the distance to every object; the near ones get the finger's free slots
//   near             sphere and box say that the tick's way may have met it: fdcg_step, in the object's frame
//   touched          fdcg_step
//
// Which contacts are stepped depends on the places of this tick and the last alone, never on when the finger last looked: so
// the skips leave every force as it is. A free contact is nothing but the HIP's last place in the object's frame (contact-model
// section 4), so it can be made anew whenever it is wanted.
#include "reach.hpp"
#include "scene_memory.hpp"

namespace fdcg {

namespace {

// An object is near when a finger could reach it within this many ticks at the speeds of this tick (a look in so many), and is
// no further from its bounding sphere than the sphere's radius (where a finger jumps, not everything is near).
constexpr double kTicksAhead = 64;
// After as many steps in which it reached none of the objects near by, the finger looks whether they still are.
constexpr uint32_t kIdleSteps = 64;
// What the rounding of distances in the world can amount to, as a share of the coordinates; and the same of the distance
// itself.
constexpr double kPlaceRounding = 64 * RealLimits<double>::kEpsilon, kHoldBack = 1 - 0x1p-30;

double larger(double a, double b) {
  return a > b ? a : b;
}
double smaller(double a, double b) {
  return a < b ? a : b;
}

bool is_settled(const Pose& now, const Pose& last) {
  const World turned[3] = {now.row[0] - last.row[0], now.row[1] - last.row[1], now.row[2] - last.row[2]};
  return norm1(turned[0]) == 0 && norm1(turned[1]) == 0 && norm1(turned[2]) == 0 && now.scale == last.scale &&
         norm1(now.translation - last.translation) == 0;
}

// The objects whose pose was set; and, once more, those that have come to rest.
void settle_changing(fdcg_scene& scene) {
  uint32_t* const changing = scene.changing();
  uint32_t still_changing = 0;
  for (uint32_t i = 0; i < scene.changing_count; ++i) {
    Object& object = scene.objects()[changing[i]];
    if (object.is_used != 0) settle_object(scene, changing[i], true);
    if (object.is_used != 0 && !is_settled(object.now, object.last)) {
      changing[still_changing++] = changing[i];
    } else {
      object.is_changing = 0;
    }
  }
  scene.changing_count = still_changing;
}

}  // namespace

void settle_object(fdcg_scene& scene, uint32_t index, bool has_way) {
  Object& object = scene.objects()[index];
  const Pose latest(object.asked, object.bounds);
  if (latest.scale != object.now.scale) ++scene.look;
  object.last = has_way ? object.now : latest;
  object.now = latest;
  scene.tick_travel = larger(scene.tick_travel, largest_move(object.last, latest));
  const double moved = norm(latest.centre - object.last.centre);
  const double in_scan[4] = {
      latest.centre.x, latest.centre.y, latest.centre.z,
      object.is_used != 0 && object.is_enabled != 0 ? larger(latest.radius, object.last.radius) + moved : kNoReach};
  for (uint32_t array = 0; array < 4; ++array)
    scene.scan(array)[index] = in_scan[array];
  scene.farthest = larger(scene.farthest, norm1(latest.centre) + norm1(latest.translation) + latest.radius);
}

namespace {

// ---- which objects can have been met
// -----------------------------------------------------------------------------------------

// One finger's tick.
struct Tick {
  fdcg_scene& scene;
  Finger& finger;
  Slot* slots;
  World hip;
  bool is_second;  // the finger was stepped in this tick before: no object has moved since

  [[nodiscard]] const Pose& pose_before(const Object& object) const { return is_second ? object.now : object.last; }
};

// The HIP's way in this tick in the object's frame.
struct LocalWay {
  World from, to;
};

// Whether the finger can have met the object in this tick; *way is set where the sphere says so.
bool can_have_met(const Tick& tick, const Object& object, LocalWay* way) {
  const Pose &now = object.now, &before = tick.pose_before(object);
  const double radius = larger(now.radius, before.radius);
  if (!(way_distance2(tick.finger.last - before.centre, tick.hip - now.centre) <= radius * radius)) return false;
  const bool may_skip = tick.scene.skips(FDCG_SKIP_ROTATION);
  *way = {before.to_object(tick.finger.last, may_skip), now.to_object(tick.hip, may_skip)};
  return way_meets_box(way->from - object.bounds.centre, way->to - object.bounds.centre, object.bounds.half);
}

struct Approach {
  bool is_in_reach;
  double depth;  // of the HIP within the bounding sphere, negative outside: the least is felt last where slots are short
  double gap;    // that the HIP, or the object, must yet move before the object can be met; may be negative
};

Approach approach(const Tick& tick, const Object& object) {
  const Pose& now = object.now;
  const double outside = norm(tick.hip - now.centre) - now.radius;
  LocalWay way;
  Approach result = {can_have_met(tick, object, &way), -outside, outside};
  // Where the box alone keeps them apart, the HIP is within two radii of the centre, and within three until the gap is used up:
  // largest_move counts on it.
  if (!result.is_in_reach && outside < now.radius) {
    const World local = now.to_object(tick.hip, tick.scene.skips(FDCG_SKIP_ROTATION)) - object.bounds.centre;
    result.gap = larger(outside, smaller(box_distance(local, object.bounds.half) * now.scale, now.radius));
  }
  return result;
}

// The nearest objects that a look has found, best first: those in reach by depth, then the others by gap.
struct Candidates {
  struct Candidate {
    uint32_t object;
    Approach approach;
  };
  static constexpr uint32_t kMost = 32;  // fdcg_scene_config.touches_per_finger
  Candidate best[kMost];
  uint32_t count = 0, room;
  double nearest_gap_left_out = HUGE_VAL;
  bool is_crowded = false;

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
    is_crowded = true;
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
// clamped to 0 .. 1 by means of absolute values, which is exact but for rounding.
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
  const bool by_sphere = scene.skips(FDCG_SKIP_FAR_OBJECTS);
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

// Gives the finger's free slots to what was found; one that the object has already stays as it is.
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
  if (!scene.skips(FDCG_SKIP_FAR_OBJECTS) && (found.count > 0 || held > 0)) clear = -HUGE_VAL;  // look every tick
  assign_slots(tick, found);
  if (found.is_crowded) {
    finger.flags |= FDCG_FINGER_CROWDED;
    ++finger.crowded_steps;
  }
  finger.anchor = tick.hip;
  finger.limit = clear * kHoldBack - rounding + scene.travel;
  finger.look = scene.look;
  finger.idle_steps = 0;
  ++finger.looks;
}

// Whether nothing without a slot can have been met since the last look.
inline bool is_out_of_reach(const fdcg_scene& scene, const Finger& finger, World hip) {
  const double left = finger.limit - scene.travel - 4 * RealLimits<double>::kEpsilon * scene.travel;
  const World way = hip - finger.anchor;
  return left > 0 && dot(way, way) < left * left * kHoldBack && finger.look == scene.look;
}

// ---- stepping
// ----------------------------------------------------------------------------------------------------------------

void store(World from, double (&to)[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

void step_contact(const Object& object, fdcg_contact* contact, World at, fdcg_result* result) {
  double local[3];
  store(at, local);
  fdcg_step(object.graph, &object.params, contact, local, result);
}

// The slot's contact in this tick. Returns whether there is anything to feel or to carry over.
bool step_slot(const Tick& tick, Slot& slot, fdcg_contact* contact, bool missed, fdcg_result* result) {
  const fdcg_scene& scene = tick.scene;
  const Object& object = scene.objects()[slot.object];
  LocalWay way;
  if (slot.is_held != 0) {
    way.to = object.now.to_object(tick.hip, scene.skips(FDCG_SKIP_ROTATION));
  } else {
    if (!can_have_met(tick, object, &way)) return false;
    if (slot.step != tick.finger.step || missed || !scene.skips(FDCG_SKIP_RENEWAL)) {
      *contact = {};
      step_contact(object, contact, way.from, result);
    }
  }
  tick.finger.idle_steps = 0;
  slot.step = tick.finger.step + 1;
  step_contact(object, contact, way.to, result);
  const bool has_swept = norm1(vec(contact->god_object) - vec(contact->hip)) == 0;
  slot.is_held = result->state != FDCG_FREE || (result->flags & FDCG_RESULT_SWEEP_BOUND) != 0 || !has_swept;
  return slot.is_held != 0;
}

fdcg_touch touch_of(const fdcg_scene& scene, uint32_t index, const fdcg_result& result) {
  const Object& object = scene.objects()[index];
  const bool may_skip = scene.skips(FDCG_SKIP_ROTATION);
  fdcg_touch touch = {};
  touch.object = {index, object.generation};
  store(object.now.turned_to_world(vec(result.force_n), may_skip), touch.force_n);
  store(object.now.to_world(vec(result.god_object_m), may_skip), touch.god_object_m);
  touch.state = result.state;
  touch.feature = result.feature;
  touch.slipping = result.slipping;
  touch.transitions = result.transitions;
  touch.flags = result.flags;
  return touch;
}

// Lets go of objects that were removed or disabled.
void drop_gone(const Tick& tick) {
  for (uint32_t s = 0; s < tick.scene.config.touches_per_finger; ++s) {
    Slot& slot = tick.slots[s];
    if (slot.object == FDCG_NONE || tick.scene.scan(3)[slot.object] >= 0) continue;
    slot.object = FDCG_NONE;
    slot.is_held = 0;
  }
}

void step_slots(const Tick& tick, bool missed, bool is_felt) {
  fdcg_scene& scene = tick.scene;
  Finger& finger = tick.finger;
  if (++finger.idle_steps == kIdleSteps) finger.limit = -HUGE_VAL;
  const auto index = static_cast<uint32_t>(&finger - scene.fingers());
  fdcg_contact* const contacts = scene.contacts(index);
  fdcg_touch* const touches = scene.touches(index);
  constexpr uint32_t kCarriedOver = FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND;
  for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s) {
    Slot& slot = tick.slots[s];
    fdcg_result result;
    if (slot.object == FDCG_NONE || !step_slot(tick, slot, contacts + s, missed, &result)) continue;
    if (!is_felt) store({0, 0, 0}, result.force_n);
    if ((result.flags & kCarriedOver) != 0) finger.flags |= FDCG_FINGER_BOUNDED;
    uint32_t place = finger.touch_count++;
    for (; place > 0 && touches[place - 1].object.index > slot.object; --place)
      touches[place] = touches[place - 1];
    touches[place] = touch_of(scene, slot.object, result);
  }
  World force = {0, 0, 0};
  for (uint32_t i = 0; i < finger.touch_count; ++i)
    force = force + vec(touches[i].force_n);
  finger.force = force;
}

// Everything but the finger that is out of reach and has no slot in use.
[[gnu::noinline]] void step_near(fdcg_scene& scene, Finger& finger) {
  const auto index = static_cast<uint32_t>(&finger - scene.fingers());
  const bool is_felt = is_place(finger.hip);
  finger.flags = is_felt ? 0 : uint32_t{FDCG_FINGER_NON_FINITE};
  finger.non_finite_steps += is_felt ? 0 : 1;
  finger.touch_count = 0;
  finger.force = {0, 0, 0};
  if (finger.is_started == 0) {
    if (!is_felt) return;
    finger.is_started = 1;
    finger.last = finger.hip;
    finger.tick = scene.tick;
    return;
  }
  const Tick tick = {scene, finger, scene.slots(index), is_felt ? finger.hip : finger.last, finger.tick == scene.tick};
  const uint32_t missed = tick.is_second ? 0 : scene.tick - finger.tick - 1;
  if (missed > 0) finger.flags |= FDCG_FINGER_MISSED_TICK;
  finger.missed_ticks += missed;
  if (finger.look != scene.look) drop_gone(tick);
  if (!is_out_of_reach(scene, finger, tick.hip) || !scene.skips(FDCG_SKIP_OUT_OF_REACH)) look(tick);
  if (finger.busy > 0) step_slots(tick, missed > 0, is_felt);
  finger.last = tick.hip;
  finger.tick = scene.tick;
  ++finger.step;
}

inline void step_finger(fdcg_scene& scene, Finger& finger) {
  const bool is_in_step = scene.tick - finger.tick <= 1 && finger.is_started != 0 && finger.flags == 0;
  if (finger.busy == 0 && is_in_step && is_out_of_reach(scene, finger, finger.hip) && scene.skips(FDCG_SKIP_OUT_OF_REACH)) {
    finger.last = finger.hip;
    finger.tick = scene.tick;
    ++finger.step;
    return;
  }
  step_near(scene, finger);
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_scene_advance(fdcg_scene* scene) {
  ++scene->tick;
  scene->tick_travel = 0;
  if (!scene->skips(FDCG_SKIP_STILL)) {
    for (uint32_t i = 0; i < scene->object_end; ++i) {
      if (scene->objects()[i].is_used != 0) fdcg::settle_object(*scene, i, true);
    }
  } else if (scene->changing_count > 0) {
    fdcg::settle_changing(*scene);
  }
  if (scene->tick_travel > 0) {
    scene->travel = (scene->travel + scene->tick_travel) * (1 + 2 * fdcg::RealLimits<double>::kEpsilon);
  }
}

extern "C" void fdcg_scene_step(fdcg_scene* scene) {
  fdcg_scene_advance(scene);
  fdcg::Finger* const fingers = scene->fingers();
  for (uint32_t i = 0; i < scene->finger_end; ++i) {
    if (fingers[i].is_used != 0) fdcg::step_finger(*scene, fingers[i]);
  }
}

extern "C" fdcg_status fdcg_scene_step_finger(fdcg_scene* scene, fdcg_finger_id id, fdcg_error* error) {
  fdcg::Finger* const finger = fdcg::find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  fdcg::step_finger(*scene, *finger);
  return FDCG_OK;
}
