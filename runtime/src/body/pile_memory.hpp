// SPDX-License-Identifier: Apache-2.0
// What a pile's memory holds:
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

struct PileTouch {
  uint32_t next;  // of the same point, or in the list of those not in use
  uint32_t on;    // member, or kGround
  uint32_t is_pressing;
  uint32_t has_normal;
  double stiffness_n_per_m;  // for as long as it presses; where faces have materials, as the step has it
  double most_stiffness;     // that its body bears, of when it began to press
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
  // where a look found the others
  double limit_m;       // fdcg_pile.travel_m at which it looks again
  uint32_t look;        // fdcg_pile.look of then
  uint32_t near_count;  // more than kMostNear: all that there are
  uint32_t near[kMostNear];
  // in this substep
  uint32_t body;                                     // index among the bodies, or FDCG_NONE
  uint32_t is_moving;                                // its pose has just changed, or something in the pile has come or gone
  uint32_t seen_look;                                // fdcg_pile.look of the last substep
  uint32_t is_awake;                                 // a body that the dampers move
  uint32_t has_touched;                              // a damper has changed its velocity
  World centre_m, velocity_m_per_s, spin_rad_per_s;  // of mass; in the world
  World kick_n_m_s;                                  // what dampers gave to its angular momentum
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
  uint32_t look;        // changes when members come, go or change their size
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

// pile.cpp: the member lets go of what its points touch, and others let go of it; it keeps its points, or leaves the pile.
void let_go(fdcg_pile& pile, uint32_t member);
void leave_pile(fdcg_pile& pile, uint32_t member);

// One substep: who meets whom, and what acts between them.
struct Meeting {
  fdcg_scene& scene;
  fdcg_pile& pile;
  fdcg_scene_body* bodies;
  double step_s;

  [[nodiscard]] Object& object(const PileMember& member) const { return scene.objects()[member.object.index]; }
};

// Points of a member that cannot have met an object in this step, told by where they are now: its box in the world's measure,
// grown by as far as the two can have moved against each other.
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

// pile_near.cpp: which members could be touched by this member's points; a look at all where it must. Ascending, at most
// PileMember::kMostNear; near_count is larger where the caller must ask every member.
void find_near(const Meeting& meeting, PileMember* member);
// Whether the point's way in this step can have met the object; *from and *to are then the way in its frame.
bool can_have_met(const Meeting& meeting, const Object& object, World from_world, World to_world, World* from, World* to);

// pile_touch.cpp: on to where the point is now. False: it touches nothing any more, and need not be kept.
struct PointWay {
  World from, to;  // of the step, in the world
};
bool step_touch(const Meeting& meeting, const PileMember& owner, const PointWay& way, bool is_new, PileTouch* touch);

// pile_damp.cpp: what the touch's damper gives in this step.
void damp_touch(const Meeting& meeting, PileMember* owner, PileTouch* touch);
// Velocity that a unit impulse at `at` gives to that place of both against each other, along its own direction; for the x, y
// and z directions added up: no direction has more. 1/kg.
double looseness_at(const PileMember* a, const PileMember* b, World at);

}  // namespace fdcg
