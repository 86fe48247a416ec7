// SPDX-License-Identifier: Apache-2.0
// A scene's tick: take in poses, and for each finger find out which objects it can have met, and step those contacts.
//
//   out of reach     the finger's own way since its last look and the objects' largest since then have not used up the distance
//                    that it saw: nothing to do
//   look             the distance to every object; the near ones get the finger's free slots
//   near             sphere and box say that the tick's way may have met it: fdcg_step, in the object's frame
//   touched          fdcg_step
//
// Which contacts are stepped depends on the places of this tick and the last alone, never on when the finger last looked: so the
// skips leave every force as it is. A free contact is nothing but the HIP's last place in the object's frame (contact-model
// section 4), so it can be made anew whenever it is wanted.
#include "reach.hpp"
#include "scene_memory.hpp"

namespace fdcg {

void place_in_scan(fdcg_scene& scene, uint32_t index, double moved) {
  const Object& object = scene.objects()[index];
  const Pose& now = object.now;
  const double radius = now.radius > object.last.radius ? now.radius : object.last.radius;
  scene.scan(0)[index] = now.centre.x;
  scene.scan(1)[index] = now.centre.y;
  scene.scan(2)[index] = now.centre.z;
  scene.scan(3)[index] = object.is_used != 0 && object.is_enabled != 0 ? radius + moved : -HUGE_VAL;
  const double far = norm1(now.centre) + norm1(now.translation) + now.radius;
  if (far > scene.farthest) scene.farthest = far;
}

namespace {

// An object is near when a finger could reach it within this many ticks at the speeds of this tick: a look in so many.
constexpr double kTicksAhead = 64;
// After as many steps in which it reached none of the objects near by, the finger looks whether they still are.
constexpr uint32_t kIdleSteps = 64;
// What the rounding of distances in the world can amount to, as a share of the coordinates; and the same of the distance itself.
constexpr double kPlaceRounding = 64 * RealLimits<double>::kEpsilon, kHoldBack = 1 - 0x1p-30;

double larger(double a, double b) {
  return a > b ? a : b;
}
double smaller(double a, double b) {
  return a < b ? a : b;
}

void settle_object(fdcg_scene& scene, uint32_t index) {
  Object& object = scene.objects()[index];
  object.last = object.now;
  object.now = Pose(object.asked, object.bounds);
  const double moved = norm(object.now.centre - object.last.centre);
  scene.tick_travel = larger(scene.tick_travel, largest_move(object.last, object.now));
  if (object.now.scale != object.last.scale) ++scene.look;
  place_in_scan(scene, index, moved);
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
    if (object.is_used != 0) settle_object(scene, changing[i]);
    if (object.is_used != 0 && !is_settled(object.now, object.last)) {
      changing[still_changing++] = changing[i];
    } else {
      object.is_changing = 0;
    }
  }
  scene.changing_count = still_changing;
}

// ---- which objects can have been met -----------------------------------------------------------------------------------------

// One finger's tick.
struct Tick {
  fdcg_scene& scene;
  Finger& finger;
  Slot* slots;
  World hip;
  bool is_second;  // the finger was stepped in this tick before: no object has moved since

  [[nodiscard]] const Pose& pose_before(const Object& object) const { return is_second ? object.now : object.last; }
};

struct Approach {
  bool is_in_reach;
  double depth;  // of the HIP within the bounding sphere, negative outside: the least is felt last where slots are short
  double gap;    // that the HIP, or the object, must yet move before the object can be met; may be negative
};

Approach approach(const Tick& tick, const Object& object) {
  const bool may_skip = tick.scene.skips(FDCG_SKIP_ROTATION);
  const Pose &now = object.now, &before = tick.pose_before(object);
  const World from = tick.finger.last - before.centre, to = tick.hip - now.centre;
  const double radius = larger(now.radius, before.radius), outside = norm(to) - now.radius;
  Approach result = {way_distance2(from, to) <= radius * radius, -outside, outside};
  // Where the box alone keeps them apart, the HIP is within two radii of the centre, and within three until the gap is used up:
  // largest_move counts on it.
  if (outside < now.radius) {
    const World local = now.to_object(tick.hip, may_skip) - object.bounds.centre;
    const double box_gap = box_distance(local, object.bounds.half) * now.scale;
    result.gap = larger(outside, smaller(box_gap, now.radius));
  }
  if (result.is_in_reach) {
    const World local_from = before.to_object(tick.finger.last, may_skip) - object.bounds.centre;
    const World local_to = now.to_object(tick.hip, may_skip) - object.bounds.centre;
    result.is_in_reach = way_meets_box(local_from, local_to, object.bounds.half);
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

// Lower bounds of the distances between the finger's way in this tick and a run of bounding spheres. A loop of its own, without
// branches, so that compilers make vectors of it: each lane computes what a scalar would.
constexpr uint32_t kRun = 64;

void scan_run(const Tick& tick, uint32_t first, uint32_t count, double (&distance)[kRun]) {
  const fdcg_scene& scene = tick.scene;
  const double* const cx = scene.scan(0) + first;
  const double* const cy = scene.scan(1) + first;
  const double* const cz = scene.scan(2) + first;
  const double* const reach = scene.scan(3) + first;
  const World from = tick.finger.last, way = tick.hip - from;
  const double length2 = dot(way, way), per_length2 = length2 > 0 ? 1 / length2 : 0;
  for (uint32_t i = 0; i < count; ++i) {
    const double x = cx[i] - from.x, y = cy[i] - from.y, z = cz[i] - from.z;
    double t = (x * way.x + y * way.y + z * way.z) * per_length2;
    t = t > 0 ? t : 0;
    t = t < 1 ? t : 1;
    const double dx = x - t * way.x, dy = y - t * way.y, dz = z - t * way.z;
    distance[i] = sqrt(dx * dx + dy * dy + dz * dz) - reach[i];
  }
}

bool has_slot(const Tick& tick, uint32_t object) {
  for (uint32_t s = 0; s < tick.scene.config.touches_per_finger; ++s) {
    if (tick.slots[s].is_held != 0 && tick.slots[s].object == object) return true;
  }
  return false;
}

// Every object: the near ones become candidates, the others' least distance is returned.
double find_candidates(const Tick& tick, double near, Candidates* found) {
  const fdcg_scene& scene = tick.scene;
  const bool by_sphere = scene.skips(FDCG_SKIP_FAR_OBJECTS);
  double least = HUGE_VAL, distance[kRun];
  for (uint32_t first = 0; first < scene.object_end; first += kRun) {
    const uint32_t count = scene.object_end - first < kRun ? scene.object_end - first : kRun;
    scan_run(tick, first, count, distance);
    for (uint32_t i = 0; i < count; ++i) {
      if (by_sphere && distance[i] > near) {
        least = smaller(least, distance[i]);
        continue;
      }
      if (scene.scan(3)[first + i] < 0 || has_slot(tick, first + i)) continue;
      const Approach how = approach(tick, scene.objects()[first + i]);
      if (how.gap > near && !how.is_in_reach) {
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
  double clear = find_candidates(tick, kTicksAhead * (step_length + scene.tick_travel) + rounding, &found);
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

// ---- stepping ----------------------------------------------------------------------------------------------------------------

void store(World from, double (&to)[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

void step_contact(const Object& object, Slot& slot, World at, fdcg_result* result) {
  double local[3];
  store(at, local);
  fdcg_step(object.graph, &object.params, &slot.contact, local, result);
}

// The slot's contact in this tick. Returns whether there is anything to feel or to carry over.
bool step_slot(const Tick& tick, Slot& slot, bool missed, fdcg_result* result) {
  fdcg_scene& scene = tick.scene;
  const Object& object = scene.objects()[slot.object];
  const bool may_skip = scene.skips(FDCG_SKIP_ROTATION);
  if (slot.is_held == 0) {
    if (!approach(tick, object).is_in_reach) return false;
    if (slot.step != tick.finger.step || missed || !scene.skips(FDCG_SKIP_RENEWAL)) {
      slot.contact = {};
      step_contact(object, slot, tick.pose_before(object).to_object(tick.finger.last, may_skip), result);
    }
  }
  tick.finger.idle_steps = 0;
  slot.step = tick.finger.step + 1;
  step_contact(object, slot, object.now.to_object(tick.hip, may_skip), result);
  const bool has_swept = norm1(vec(slot.contact.god_object) - vec(slot.contact.hip)) == 0;
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
  fdcg_touch* const touches = scene.touches(static_cast<uint32_t>(&finger - scene.fingers()));
  constexpr uint32_t kCarriedOver = FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND;
  for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s) {
    Slot& slot = tick.slots[s];
    fdcg_result result;
    if (slot.object == FDCG_NONE || !step_slot(tick, slot, missed, &result)) continue;
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
void step_near(fdcg_scene& scene, Finger& finger) {
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
      if (scene->objects()[i].is_used != 0) fdcg::settle_object(*scene, i);
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
