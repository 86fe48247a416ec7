// SPDX-License-Identifier: Apache-2.0
// Broad phase of a pile: bounding spheres, tested again only when motion can have used up the distances of the last test.
#include "body/pile_memory.hpp"
#include "scene/finger_tick.hpp"
#include "scene/reach.hpp"

namespace fdcg {
namespace {

// Members within this share of a member's radius are neighbours: larger values mean more neighbours and rarer updates.
constexpr double kNearShare = 0.25;
constexpr double kPileRounding = 64 * DBL_EPSILON;

// At least the largest coordinate of any number that a point's place is computed from.
double size_of(const PileMember& member, const Pose& pose) {
  return norm1(pose.centre) + 2 * norm1(pose.translation) + member.radius_m * pose.scale;
}

// A lower bound of a place's distance from an object.
double distance(const Object& object, World at) {
  if (!object.bounds.is_endless) return norm(object.now.centre - at) - object.now.radius;
  return object.now.to_object(at, true).z * object.now.scale;
}

}  // namespace

void find_near(const Meeting& meeting, PileMember* member) {
  fdcg_pile& pile = meeting.pile;
  if (!pile.skips(FDCG_PILE_OPT_FAR)) {
    member->near_count = PileMember::kMostNear + 1;
    return;
  }
  if (member->look == pile.look && pile.travel_m < member->limit_m) return;
  const Object& own = meeting.object(*member);
  const double radius = member->radius_m * own.now.scale, ahead = radius * kNearShare;
  const double rounding = kPileRounding * (norm1(own.now.centre) + radius + meeting.scene.farthest);
  double nearest_far = HUGE_VAL;
  member->near_count = 0;
  for (uint32_t i = 0; i < pile.member_end; ++i) {
    const PileMember& other = pile.members()[i];
    if (&other == member || other.is_used == 0 || other.is_enabled == 0) continue;
    const Object& object = meeting.object(other);
    const double gap = distance(object, own.now.centre) - radius - rounding;
    // the motion of both in this step is part of the swept way
    const double moved = norm(object.now.centre - object.last.centre) + norm(own.now.centre - own.last.centre);
    if (gap - moved > ahead) {
      nearest_far = smaller(nearest_far, gap);
    } else if (member->near_count++ < PileMember::kMostNear) {
      member->near[member->near_count - 1] = i;
    }
  }
  member->look = pile.look;
  member->limit_m = (pile.travel_m + nearest_far / 2) * (1 - kPileRounding);
  ++pile.counts.broadphase_updates;
}

Cull cull_of(const Meeting& meeting, const PileMember& owner, const PileMember& other) {
  const Object &own = meeting.object(owner), &object = meeting.object(other);
  const double scale = object.now.scale, far = 3 * object.now.radius;
  double moved = owner.move_m + owner.turn * owner.radius_m * own.now.scale + other.move_m + other.turn * far;
  // beyond that far from it, the other's turn moves its frame by more; and where a size changes there is no bound
  if (moved > far || object.last.scale != scale || own.last.scale != own.now.scale) moved = HUGE_VAL;
  const bool is_endless = object.bounds.is_endless;
  const double grown = moved + kPileRounding * (size_of(owner, own.now) + norm1(object.now.translation) +
                                                (is_endless ? 0 : norm1(object.bounds.centre) * scale + object.now.radius));
  const World centre = is_endless ? World{0, 0, 0} : object.bounds.centre * scale;
  const World half = is_endless ? World{HUGE_VAL, HUGE_VAL, grown} : object.bounds.half * scale + World{grown, grown, grown};
  const World apart = own.now.translation - object.now.translation;
  const Matrix turn = {{object.now.row[0], object.now.row[1], object.now.row[2]}};  // its columns are the box's axes
  Cull cull = {{}, turn.transposed_times(apart) - centre, half};
  for (int k = 0; k < 3; ++k) {
    const World axis = {component(turn.row[0], k), component(turn.row[1], k), component(turn.row[2], k)};
    cull.row[k] = (own.now.row[0] * axis.x + own.now.row[1] * axis.y + own.now.row[2] * axis.z) * own.now.scale;
  }
  return cull;
}

GroundCull ground_cull_of(const Meeting& meeting, const PileMember& owner) {
  const fdcg_pile& pile = meeting.pile;
  const Pose& now = meeting.object(owner).now;
  const World n = pile.ground_normal;
  const World along = (now.row[0] * n.x + now.row[1] * n.y + now.row[2] * n.z) * now.scale;
  const double rounding = kPileRounding * (size_of(owner, now) + absolute(pile.ground_offset_m));
  return {along, pile.ground_offset_m - dot(n, now.translation) + rounding};
}

bool can_have_met(const Meeting& meeting, const Object& object, World from_world, World to_world, World* from, World* to) {
  const Pose &now = object.now, &before = object.last;
  const bool may_skip = meeting.scene.skips(FDCG_OPT_ROTATION);
  const double radius = larger(now.radius, before.radius);
  if (!object.bounds.is_endless && !(way_distance2(from_world - before.centre, to_world - now.centre) <= radius * radius))
    return false;
  *from = before.to_object(from_world, may_skip);
  *to = now.to_object(to_world, may_skip);
  if (object.bounds.is_endless) return smaller(from->z, to->z) <= 0;
  return way_meets_box(*from - object.bounds.centre, *to - object.bounds.centre, object.bounds.half);
}

}  // namespace fdcg
