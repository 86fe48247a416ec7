// SPDX-License-Identifier: Apache-2.0
// The dampers of a pile's touches, applied sequentially. Each reduces the relative velocity in an implicit step: v / (1 + x +
// x x / 2), x = c h / m, with the effective mass m. Such a step only removes energy, so any sequence of them does, at any
// damping and step length.
#include "body/pile_memory.hpp"
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

// Share of damping_ratio for tangential motion at sticking contacts: prevents oscillation of many contacts together.
constexpr double kSideways = 2;

// The response of a body to an impulse at a point along a unit direction.
struct Lever {
  World twist;           // angular impulse about the centre of mass per unit impulse; zero if the body cannot be moved
  World spin_rad_per_s;  // the resulting angular velocity
  double lightness_per_kg, answer_per_kg;  // inverse mass, and inverse effective mass at the point
};

FDCG_HOT Lever lever_at(const PileMember* member, World at, World direction) {
  if (member == nullptr || member->is_awake == 0) return {{0, 0, 0}, {0, 0, 0}, 0, 0};
  const World twist = cross(at - member->centre_m, direction), spin = member->inverse_inertia * twist;
  return {twist, spin, member->lightness_per_kg, member->lightness_per_kg + dot(twist, spin)};
}

FDCG_HOT World velocity_at(const Meeting& meeting, const PileMember* member, World at) {
  if (member == nullptr) return {0, 0, 0};
  if (member->is_awake != 0) return member->velocity_m_per_s + cross(member->spin_rad_per_s, at - member->centre_m);
  if (member->is_moving == 0) return {0, 0, 0};
  const Object& object = meeting.object(*member);
  return (at - object.last.to_world(object.now.to_object(at, true), true)) * (1 / meeting.step_s);
}

FDCG_HOT void give(PileMember* member, const Lever& lever, World direction, double impulse_n_s) {
  if (lever.answer_per_kg == 0) return;
  member->velocity_m_per_s = member->velocity_m_per_s + direction * (impulse_n_s * lever.lightness_per_kg);
  member->spin_rad_per_s = member->spin_rad_per_s + lever.spin_rad_per_s * impulse_n_s;
  member->kick_n_m_s = member->kick_n_m_s + lever.twist * impulse_n_s;
  member->has_touched = 1;
}

// The impulse of an implicit damper with this damping ratio against a speed, for the given inverse effective mass.
double damper_impulse(double speed, double ratio, double stiffness, double answer_per_kg, double step_s) {
  const double x = 2 * ratio * step_s * root(stiffness * answer_per_kg), taken = x + x * x / 2;
  return -speed * taken / ((1 + taken) * answer_per_kg);
}

// The largest share of `more`, 0 to 1, for which the length of `held` plus it is at most `limit`.
double share_within(World held, World more, double limit) {
  const World all = held + more;
  if (dot(all, all) <= limit * limit) return 1;
  const double a = dot(more, more), b = dot(held, more), c = dot(held, held) - limit * limit;
  if (!(a > 0) || c > 0 || !(limit > 0)) return 0;
  return smaller(1, larger(0, (root(b * b - a * c) - b) / a));
}

// Share of the least width of a body that a point may get into another, and that it may still approach in one step then.
constexpr double kMostDepth = 0.25, kLeastApproach = 1.0 / 16;

double least_width(const Object& object) {
  if (object.bounds.is_endless) return HUGE_VAL;
  const World half = object.bounds.half;
  return 2 * object.now.scale * smaller(half.x, smaller(half.y, half.z));
}

// The two members of a touch: `other` is null for the ground.
struct Between {
  PileMember *owner, *other;
  World at;

  // Applies an impulse along a unit direction to one and the opposite impulse to the other.
  void give_both(const Lever& own, const Lever& others, World direction, double impulse_n_s) const {
    give(owner, own, direction, impulse_n_s);
    give(other, others, direction, -impulse_n_s);
  }
  // How deep a point may get before the approach is stopped outright.
  [[nodiscard]] double most_depth_m(const Meeting& meeting) const {
    double least = least_width(meeting.object(*owner));
    if (other != nullptr) least = smaller(least, least_width(meeting.object(*other)));
    return kMostDepth * least;
  }
  [[nodiscard]] World velocity(const Meeting& meeting) const {
    return velocity_at(meeting, owner, at) - velocity_at(meeting, other, at);
  }
};

// Tangential impulse of a sticking touch whose damper gives `along` the normal: with the spring's force it stays in the
// friction cone.
World damp_sideways(const Meeting& meeting, const Between& between, const PileTouch& touch, double along) {
  const World n = touch.normal, velocity = between.velocity(meeting);
  const World across = velocity - n * dot(velocity, n);
  const double slide = norm(across), h = meeting.step_s;
  if (!(slide > 0)) return {0, 0, 0};
  const World direction = across * (1 / slide);
  const Lever own = lever_at(between.owner, between.at, direction), others = lever_at(between.other, between.at, direction);
  const double answer = own.answer_per_kg + others.answer_per_kg;
  if (!(answer > 0)) return {0, 0, 0};
  const double ratio = kSideways * meeting.pile.config.damping_ratio;
  const double wanted = damper_impulse(slide, ratio, touch.stiffness_n_per_m, answer, h);
  const World held = (touch.force_n - n * touch.load_n) * h;
  const double given = wanted * share_within(held, direction * wanted, touch.mu_static * (touch.load_n * h + along));
  between.give_both(own, others, direction, given);
  return direction * given;
}

}  // namespace

double looseness_at(const PileMember* a, const PileMember* b, World at) {
  double sum = 0;
  const World axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const World& u : axes)
    sum += lever_at(a, at, u).answer_per_kg + lever_at(b, at, u).answer_per_kg;
  return sum;
}

void damp_touch(const Meeting& meeting, PileMember* owner, PileTouch* touch) {
  touch->damper_n = {0, 0, 0};
  if (touch->is_pressing == 0 || touch->has_normal == 0 || !(touch->load_n >= 0)) return;
  PileMember* const other = touch->on == kGround ? nullptr : meeting.pile.members() + touch->on;
  const fdcg_pile_config& config = meeting.pile.config;
  const Between between = {owner, other, touch->god_object};
  const World n = touch->normal;
  const Lever own = lever_at(owner, between.at, n), others = lever_at(other, between.at, n);
  const double h = meeting.step_s, answer = own.answer_per_kg + others.answer_per_kg;
  if (!(answer > 0)) return;
  const double speed = dot(between.velocity(meeting), n);
  const double ratio = speed < 0 ? config.damping_ratio : config.leaving_ratio;
  // never adhesive: cancels at most the whole spring force
  double along = larger(damper_impulse(speed, ratio, touch->stiffness_n_per_m, answer, h), -touch->load_n * h);
  const double most = between.most_depth_m(meeting), depth = touch->load_n / touch->stiffness_n_per_m;
  const double approach = larger(most - depth, kLeastApproach * most) / h;
  if (speed < -approach) along = larger(along, (-approach - speed) / answer);
  between.give_both(own, others, n, along);
  World impulse = n * along;
  if (touch->contact.slipping == 0) impulse = impulse + damp_sideways(meeting, between, *touch, along);
  touch->damper_n = impulse * (1 / h);
}

}  // namespace fdcg
