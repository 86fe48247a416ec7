// SPDX-License-Identifier: Apache-2.0
// The dampers of a pile's touches. One after the other, each takes its part of the relative velocity away at once, as an
// implicit step of its own: v / (1 + x + x x / 2), x = c h / m, at the mass m that it moves. Such a step only takes energy, so
// any row of them does, however stiff, and none needs a shorter step.
#include "pile_memory.hpp"
#include "scene_tick.hpp"

namespace fdcg {
namespace {

// Of damping_ratio, where a contact sticks: many together then do not swing, whatever their masses sideways.
constexpr double kSideways = 2;

// Velocity that a unit impulse along u at `arm` from the centre of mass gives to that place.
FDCG_HOT World answer(const PileMember* member, World at, World u) {
  if (member == nullptr || member->is_awake == 0) return {0, 0, 0};
  const World arm = at - member->centre_m;
  return u * member->lightness_per_kg + cross(member->inverse_inertia * cross(arm, u), arm);
}

FDCG_HOT World velocity_at(const Meeting& meeting, const PileMember* member, World at) {
  if (member == nullptr) return {0, 0, 0};
  if (member->is_awake != 0) return member->velocity_m_per_s + cross(member->spin_rad_per_s, at - member->centre_m);
  if (member->is_moving == 0) return {0, 0, 0};
  const Object& object = meeting.object(*member);
  return (at - object.last.to_world(object.now.to_object(at, true), true)) * (1 / meeting.step_s);
}

FDCG_HOT void give(PileMember* member, World at, World impulse) {
  if (member == nullptr || member->is_awake == 0) return;
  const World twist = cross(at - member->centre_m, impulse);
  member->velocity_m_per_s = member->velocity_m_per_s + impulse * member->lightness_per_kg;
  member->spin_rad_per_s = member->spin_rad_per_s + member->inverse_inertia * twist;
  member->kick_n_m_s = member->kick_n_m_s + twist;
  member->has_touched = 1;
}

// What an implicit damper of this ratio to the critical one gives against a speed along a direction.
double damper_impulse(double speed, double ratio, double stiffness, double mass, double step_s) {
  const double x = 2 * ratio * step_s * root(stiffness / mass), taken = x + x * x / 2;
  return -speed * mass * (taken / (1 + taken));
}

// The mass that a push along the unit `direction` at `at` meets: of both, as they can move.
double mass_along(const PileMember* a, const PileMember* b, World at, World direction) {
  const double inverse = dot(direction, answer(a, at, direction)) + dot(direction, answer(b, at, direction));
  return inverse > 0 ? 1 / inverse : 0;
}

// How much of `more`, 0 to 1, may be added to `held` without going beyond `limit` in length.
double share_within(World held, World more, double limit) {
  const World all = held + more;
  if (dot(all, all) <= limit * limit) return 1;
  const double a = dot(more, more), b = dot(held, more), c = dot(held, held) - limit * limit;
  if (!(a > 0) || c > 0 || !(limit > 0)) return 0;
  return smaller(1, larger(0, (root(b * b - a * c) - b) / a));
}

// Of a touch that sticks and gives `along` as its damper's push: with the spring's it stays in the cone.
World sideways_impulse(const Meeting& meeting, const PileMember& owner, const PileMember* other, const PileTouch& touch,
                       double along) {
  const World at = touch.god_object, n = touch.normal;
  const World velocity = velocity_at(meeting, &owner, at) - velocity_at(meeting, other, at);
  const World across = velocity - n * dot(velocity, n);
  const double slide = norm(across), h = meeting.step_s;
  const double mass = slide > 0 ? mass_along(&owner, other, at, across * (1 / slide)) : 0;
  if (mass == 0) return {0, 0, 0};
  const double ratio = kSideways * meeting.pile.config.damping_ratio;
  const World wanted = across * (damper_impulse(slide, ratio, touch.stiffness_n_per_m, mass, h) / slide);
  const World held = (touch.force_n - n * touch.load_n) * h;
  return wanted * share_within(held, wanted, touch.mu_static * (touch.load_n * h + along));
}

}  // namespace

double looseness_at(const PileMember* a, const PileMember* b, World at) {
  double sum = 0;
  const World axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const World& u : axes)
    sum += dot(u, answer(a, at, u)) + dot(u, answer(b, at, u));
  return sum;
}

void damp_touch(const Meeting& meeting, PileMember* owner, PileTouch* touch) {
  touch->damper_n = {0, 0, 0};
  if (touch->is_pressing == 0 || touch->has_normal == 0 || !(touch->load_n >= 0)) return;
  PileMember* const other = touch->on == kGround ? nullptr : meeting.pile.members() + touch->on;
  const fdcg_pile_config& config = meeting.pile.config;
  const World at = touch->god_object, n = touch->normal;
  const double h = meeting.step_s, mass = mass_along(owner, other, at, n);
  if (mass == 0) return;
  const double speed = dot(velocity_at(meeting, owner, at) - velocity_at(meeting, other, at), n);
  const double ratio = speed < 0 ? config.damping_ratio : config.leaving_ratio;
  // never a pull: at most all of the spring's push is held back
  const double along = larger(damper_impulse(speed, ratio, touch->stiffness_n_per_m, mass, h), -touch->load_n * h);
  World impulse = n * along;
  give(owner, at, impulse);
  give(other, at, impulse * -1.0);
  if (touch->contact.slipping == 0) {
    const World sideways = sideways_impulse(meeting, *owner, other, *touch, along);
    give(owner, at, sideways);
    give(other, at, sideways * -1.0);
    impulse = impulse + sideways;
  }
  touch->damper_n = impulse * (1 / h);
}

}  // namespace fdcg
