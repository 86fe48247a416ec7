// SPDX-License-Identifier: Apache-2.0
// The dampers of a pile's touches. One after the other, each takes its part of the relative velocity away at once, as an
// implicit step of its own: v / (1 + c h / m) at the mass m that it moves. Such a step only takes energy, so any row of them
// does, however stiff, and none needs a shorter step.
#include "pile_memory.hpp"
#include "scene_tick.hpp"

namespace fdcg {
namespace {

// Velocity that a unit impulse along u at `arm` from the centre of mass gives to that place.
World answer(const PileMember* member, World at, World u) {
  if (member == nullptr || member->is_awake == 0) return {0, 0, 0};
  const World arm = at - member->centre_m;
  return u * member->lightness_per_kg + cross(member->inverse_inertia * cross(arm, u), arm);
}

World velocity_at(const Meeting& meeting, const PileMember* member, World at) {
  if (member == nullptr) return {0, 0, 0};
  if (member->is_awake != 0) return member->velocity_m_per_s + cross(member->spin_rad_per_s, at - member->centre_m);
  if (member->is_moving == 0) return {0, 0, 0};
  const Object& object = meeting.object(*member);
  return (at - object.last.to_world(object.now.to_object(at, true), true)) * (1 / meeting.step_s);
}

void give(PileMember* member, World at, World impulse) {
  if (member == nullptr || member->is_awake == 0) return;
  const World twist = cross(at - member->centre_m, impulse);
  member->velocity_m_per_s = member->velocity_m_per_s + impulse * member->lightness_per_kg;
  member->spin_rad_per_s = member->spin_rad_per_s + member->inverse_inertia * twist;
  member->kick_n_m_s = member->kick_n_m_s + twist;
  member->has_touched = 1;
}

// What an implicit damper of this ratio to the critical one gives against a speed along a direction.
double damper_impulse(double speed, double ratio, double stiffness, double mass, double step_s) {
  const double c = 2 * ratio * root(stiffness * mass) * step_s;
  return -speed * (c * mass / (mass + c));
}

double static_mu(const Meeting& meeting, const PileMember& owner, const PileTouch& touch) {
  const fdcg_params& other =
      touch.on == kGround ? meeting.pile.ground_params : meeting.object(meeting.pile.members()[touch.on]).params;
  return root(meeting.object(owner).params.mu_static * other.mu_static);
}

}  // namespace

double mass_along(const PileMember* a, const PileMember* b, World at, World direction) {
  const double inverse = dot(direction, answer(a, at, direction)) + dot(direction, answer(b, at, direction));
  return inverse > 0 ? 1 / inverse : 0;
}

void damp_touch(const Meeting& meeting, PileMember* owner, PileTouch* touch) {
  touch->damper_n = {0, 0, 0};
  if (touch->is_pressing == 0 || touch->has_normal == 0 || !(touch->load_n >= 0)) return;
  PileMember* const other = touch->on == kGround ? nullptr : meeting.pile.members() + touch->on;
  const fdcg_pile_config& config = meeting.pile.config;
  const World at = touch->god_object, n = touch->normal;
  const double h = meeting.step_s, mass = mass_along(owner, other, at, n);
  if (mass == 0) return;
  World velocity = velocity_at(meeting, owner, at) - velocity_at(meeting, other, at);
  const double speed = dot(velocity, n);
  const double ratio = speed < 0 ? config.damping_ratio : config.leaving_ratio;
  // never a pull: at most all of the spring's push is held back
  const double along = larger(damper_impulse(speed, ratio, touch->stiffness_n_per_m, mass, h), -touch->load_n * h);
  World impulse = n * along;
  give(owner, at, impulse);
  give(other, at, impulse * -1.0);
  if (touch->contact.slipping == 0) {
    velocity = velocity_at(meeting, owner, at) - velocity_at(meeting, other, at);
    const World across = velocity - n * dot(velocity, n);
    const double slide = norm(across), side_n = norm(touch->force_n - n * touch->load_n);
    const double left = static_mu(meeting, *owner, *touch) * (touch->load_n * h + along) - side_n * h;  // of the cone
    const double side_mass = slide > 0 ? mass_along(owner, other, at, across * (1 / slide)) : 0;
    if (left > 0 && side_mass > 0) {
      const double wanted = damper_impulse(slide, config.damping_ratio, touch->stiffness_n_per_m, side_mass, h);
      const World sideways = across * (larger(wanted, -left) / slide);
      give(owner, at, sideways);
      give(other, at, sideways * -1.0);
      impulse = impulse + sideways;
    }
  }
  touch->damper_n = impulse * (1 / h);
}

}  // namespace fdcg
