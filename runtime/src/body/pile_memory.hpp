// SPDX-License-Identifier: Apache-2.0
// Layout of a pile's memory:
//
//   fdcg_pile | PileMember[objects], by the scene's object index | PilePoint[points] | PileTouch[touches]
//
// Found by offsets from the start, so that a copy of the whole is a pile again. A member's points lie together; a point's
// touches are a list.
#pragma once

#include "body/body_math.hpp"
#include "fdcg/pile.h"
#include "scene/scene_memory.hpp"

namespace fdcg {

inline constexpr uint32_t kGround = FDCG_NONE - 1;  // as what is touched

struct PilePoint {
  double at[3];    // the object's frame, before its scale
  uint32_t touch;  // the first; FDCG_NONE: none
  uint32_t reserved;
};

// Limit for stiffness times the squared step times the inverse effective mass, summed over three directions. Stability allows 4
// for all springs along one direction together, so 32 of them may act.
inline constexpr double kMostPileStiffness = 0.125;

// How friction holds for a touch, see pile_patch.cpp.
enum class PatchFriction : uint32_t {
  alone,  // as for a finger
  holds,  // the touches of its patch hold together: mu_static in place of mu_dynamic
  slips   // all of them slip
};

struct PileTouch {
  uint32_t next;  // of the same point, or in the list of those not in use
  uint32_t on;    // the touched member, or kGround
  uint32_t is_pressing;
  uint32_t has_normal;
  PatchFriction patch;
  uint32_t is_softened;      // its stiffness is the step's bound
  double stiffness_n_per_m;  // constant while it presses; where faces have materials, that of the step
  double most_stiffness;     // stability bound of its body, from the start of the contact
  double load_n;
  double mu_static;
  World god_object, normal;
  World force_n;         // of the spring, on the point's body
  World damper_n;        // mean over the step
  fdcg_contact contact;  // on the ground: god-object, state and slipping, in the world
};

struct PileMember {
  static constexpr uint32_t kMostNear = 8;

  fdcg_object_id object;
  uint32_t is_used, is_enabled;
  uint32_t first_point, point_count;
  uint32_t touch_count;
  double radius_m;  // of its points, around the centre of its object's bounds, before the scale
  // result of the last broad-phase update
  double limit_m;       // fdcg_pile.travel_m at which it is due again
  uint32_t look;        // fdcg_pile.look at that time
  uint32_t near_count;  // more than kMostNear: all members count as near
  uint32_t near[kMostNear];
  // in this substep
  uint32_t body;                                     // index among the bodies, or FDCG_NONE
  uint32_t is_moving;                                // its pose has just changed, or a member was added or removed
  uint32_t seen_look;                                // fdcg_pile.look of the last substep
  uint32_t is_awake;                                 // a body that the dampers move
  uint32_t has_touched;                              // a damper has changed its velocity
  World centre_m, velocity_m_per_s, spin_rad_per_s;  // of mass; in the world
  World kick_n_m_s;                                  // angular impulse of the dampers
  Matrix inverse_inertia;                            // world
  double lightness_per_kg;
  double move_m,
      turn;  // of its bounds' centre in this step; and the most that a point moves besides, over its distance from there
  World force_n, torque_n_m;  // of the touches' springs; about the centre of mass
};

}  // namespace fdcg

struct fdcg_pile {
  uint64_t bytes;
  fdcg_pile_config config;
  uint64_t members_at, points_at, touches_at;
  uint32_t member_end, point_end;
  uint32_t free_touch;  // the first of a list
  uint32_t look;        // changes when members are added, removed or resized
  double travel_m;      // the largest move of any member's centre, added up over the substeps
  uint32_t has_ground;
  uint32_t scene_look;  // fdcg_scene.look of the last substep
  fdcg::World ground_normal;
  double ground_offset_m;
  fdcg_params ground_params;
  fdcg_pile_counts counts;

  bool skips(uint32_t what) const { return (config.disabled_optimizations & what) == 0; }
  fdcg::PileMember* members() { return fdcg::part_at<fdcg::PileMember>(this, members_at); }
  const fdcg::PileMember* members() const { return fdcg::part_at<fdcg::PileMember>(this, members_at); }
  fdcg::PilePoint* points() { return fdcg::part_at<fdcg::PilePoint>(this, points_at); }
  const fdcg::PilePoint* points() const { return fdcg::part_at<fdcg::PilePoint>(this, points_at); }
  fdcg::PileTouch* touches() { return fdcg::part_at<fdcg::PileTouch>(this, touches_at); }
  const fdcg::PileTouch* touches() const { return fdcg::part_at<fdcg::PileTouch>(this, touches_at); }
};

namespace fdcg {

// pile.cpp: removes all touches of the member's points and of other members with it; it keeps its points, or leaves the pile.
void let_go(fdcg_pile& pile, uint32_t member);
void leave_pile(fdcg_pile& pile, uint32_t member);

// One substep: collision detection between members, and contact forces.
struct Meeting {
  fdcg_scene& scene;
  fdcg_pile& pile;
  fdcg_scene_body* bodies;
  double step_s;

  [[nodiscard]] Object& object(const PileMember& member) const { return scene.objects()[member.object.index]; }
};

// Rejects points of a member that cannot have touched an object in this step, by their present position: outside of its box in
// world units, enlarged by the largest relative motion of the two.
struct Cull {
  World row[3], shift;  // from the points' frame to the box's centre and axes
  World half;

  // `at`: in its member's frame.
  [[nodiscard]] bool may_have_met(World at) const {
    return absolute(dot(row[0], at) + shift.x) <= half.x && absolute(dot(row[1], at) + shift.y) <= half.y &&
           absolute(dot(row[2], at) + shift.z) <= half.z;
  }
};
Cull cull_of(const Meeting& meeting, const PileMember& owner, const PileMember& other);
// The same for the ground, which does not move: whether a point may be below it.
struct GroundCull {
  World along;  // the ground's normal in the points' frame
  double above_m;

  [[nodiscard]] bool may_have_met(World at) const { return dot(along, at) <= above_m; }
};
GroundCull ground_cull_of(const Meeting& meeting, const PileMember& owner);

// pile_near.cpp: updates the neighbours, the members that this member's points could touch; tests all members only when needed.
// Ascending, at most PileMember::kMostNear; if near_count is larger, the caller must test every member.
void find_near(const Meeting& meeting, PileMember* member);
// Whether the point's way in this step can have touched the object; *from and *to are then the way in its frame.
bool can_have_met(const Meeting& meeting, const Object& object, World from_world, World to_world, World* from, World* to);

// pile_touch.cpp: steps the touch to the point's present position. False: it has ended and can be dropped.
struct PointWay {
  World from, to;  // of the step, in the world
};
bool step_touch(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch);

// pile_patch.cpp: decides from the last step how friction holds for the member's touches in this one.
void judge_patches(fdcg_pile& pile, PileMember* owner);

template <class Act>
void for_each_touch(fdcg_pile& pile, PileMember* member, Act act) {
  for (uint32_t p = 0; p < member->point_count && member->touch_count > 0; ++p) {
    for (uint32_t t = pile.points()[member->first_point + p].touch; t != FDCG_NONE; t = pile.touches()[t].next)
      act(pile.touches() + t);
  }
}

// pile_damp.cpp: applies the touch's damper in this step.
void damp_touch(const Meeting& meeting, PileMember* owner, PileTouch* touch);
// The inverse effective mass of both at `at`, summed over the x, y and z directions: an upper bound for any direction. 1/kg.
double looseness_at(const PileMember* a, const PileMember* b, World at);

// Returns the touches of a point for which `is_gone` is true to the free list.
template <class IsGone>
void drop_touches(fdcg_pile& pile, PileMember& member, PilePoint& point, IsGone is_gone) {
  uint32_t* link = &point.touch;
  while (*link != FDCG_NONE) {
    PileTouch& touch = pile.touches()[*link];
    if (!is_gone(touch)) {
      link = &touch.next;
      continue;
    }
    const uint32_t gone = *link;
    *link = touch.next;
    touch.next = pile.free_touch;
    pile.free_touch = gone;
    --member.touch_count;
  }
}

}  // namespace fdcg
