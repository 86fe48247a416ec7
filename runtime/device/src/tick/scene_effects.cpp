// SPDX-License-Identifier: Apache-2.0
#include "tick/scene_effects.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "tick/grip.hpp"

namespace fdcg::dev {
namespace {

// Of a contact on an object, in its frame, with lengths of the object (result, hip_m) and of the world.
struct Seen {
  double rows[9];
  double scale = 1;
  double hip_m[3];
  fdcg_result result{};
};

void to_object(const double rows[9], const double world[3], double object[3]) {
  for (int i = 0; i < 3; ++i)
    object[i] = rows[i] * world[0] + rows[3 + i] * world[1] + rows[6 + i] * world[2];
}

void place_in(const FeltObject& object, const double rows[9], const double world_m[3], double object_m[3]) {
  double from_origin_m[3];
  for (int i = 0; i < 3; ++i)
    from_origin_m[i] = world_m[i] - object.pose.translation_m[i];
  to_object(rows, from_origin_m, object_m);
  for (int i = 0; i < 3; ++i)
    object_m[i] /= object.pose.scale;
}

const fdcg_touch* touch_of(const fdcg_finger_result& felt, fdcg_object_id object) {
  for (std::uint32_t t = 0; t < felt.touch_count; ++t)
    if (felt.touches[t].object.index == object.index && felt.touches[t].state != FDCG_FREE) return &felt.touches[t];
  return nullptr;
}

Seen see(const FeltObject& object, const double hip_world_m[3], const fdcg_finger_result& felt) {
  Seen seen;
  rows_of(object.pose.rotation_xyzw, seen.rows);
  seen.scale = object.pose.scale;
  place_in(object, seen.rows, hip_world_m, seen.hip_m);
  seen.result.feature = FDCG_NONE;
  const fdcg_touch* const touch = touch_of(felt, object.id);
  if (touch == nullptr) return seen;
  seen.result.state = touch->state;
  seen.result.feature = touch->feature;
  seen.result.slipping = touch->slipping;
  place_in(object, seen.rows, touch->god_object_m, seen.result.god_object_m);
  to_object(seen.rows, touch->force_n, seen.result.force_n);
  return seen;
}

// The nearest place of a plane or a ball from outside.
void find_nearest(const fdcg_surface& surface, double reach_m, fdcg_effect_facts* facts) {
  const double* const hip = facts->hip_m;
  const double length = std::sqrt(dot(hip, hip)), side = surface.is_hollow != 0 ? -1 : 1;
  const bool is_plane = surface.kind == FDCG_SURFACE_PLANE;
  const double distance = is_plane ? hip[2] : side * (length - surface.radius_m);
  if (!(distance >= 0 && distance <= reach_m) || (!is_plane && !(length > 0))) return;
  facts->has_surface = 1;
  for (int i = 0; i < 3; ++i) {
    facts->normal[i] = is_plane ? (i == 2 ? 1 : 0) : side * hip[i] / length;
    facts->surface_m[i] = hip[i] - distance * facts->normal[i];
  }
}

void facts_of_surface(const fdcg_surface& surface, const Seen& seen, double reach_m, fdcg_effect_facts* facts) {
  facts->material = facts->node = FDCG_NONE;
  facts->is_touching = facts->has_surface = seen.result.state != FDCG_FREE ? 1 : 0;
  facts->is_slipping = seen.result.slipping;
  std::copy_n(seen.hip_m, 3, facts->hip_m);
  std::copy_n(seen.result.god_object_m, 3, facts->surface_m);
  std::copy_n(seen.result.force_n, 3, facts->spring_n);
  if (facts->is_touching != 0) return fdcg_surface_get_normal(&surface, &seen.result, facts->normal);
  if (reach_m > 0 && has_known_distance(surface)) find_nearest(surface, reach_m, facts);
}

fdcg_effect_facts facts_of(const FeltObject& object, const Seen& seen, double tick_s) {
  fdcg_effect_facts facts{};
  facts.tick_s = tick_s;
  const double reach_m = object.reach_m / seen.scale;
  if (object.graph == nullptr) {
    facts_of_surface(*object.surface, seen, reach_m, &facts);
  } else if (fdcg_get_effect_facts(object.graph, &seen.result, seen.hip_m, reach_m, tick_s, &facts, nullptr) != FDCG_OK) {
    facts.tick_s = 0;  // no force
  }
  for (int i = 0; i < 3; ++i) {
    facts.hip_m[i] *= seen.scale;
    facts.surface_m[i] *= seen.scale;
  }
  return facts;
}

// Of a hand in the world: it touches what it touches.
fdcg_effect_facts facts_of_world(const double hip_world_m[3], const fdcg_finger_result& felt, double tick_s) {
  fdcg_effect_facts facts{};
  facts.tick_s = tick_s;
  facts.material = facts.node = FDCG_NONE;
  std::copy_n(hip_world_m, 3, facts.hip_m);
  std::copy_n(hip_world_m, 3, facts.surface_m);
  std::copy_n(felt.force_n, 3, facts.spring_n);
  const double force_n = std::sqrt(dot(felt.force_n, felt.force_n));
  facts.is_touching = facts.has_surface = force_n > 0 ? 1 : 0;
  for (std::uint32_t t = 0; t < felt.touch_count; ++t)
    facts.is_slipping = facts.is_slipping != 0 || felt.touches[t].slipping != 0 ? 1 : 0;
  for (int i = 0; i < 3; ++i)
    facts.normal[i] = force_n > 0 ? felt.force_n[i] / force_n : 0;
  return facts;
}

}  // namespace

bool has_known_distance(const fdcg_surface& surface) {
  return surface.kind == FDCG_SURFACE_PLANE || surface.kind == FDCG_SURFACE_SPHERE;
}

void SceneEffects::add_object(const FeltObject& object) {
  rows_.push_back({static_cast<int>(effects_.size()), 0, false, object});
}

void SceneEffects::add(const fdcg_effect& effect) {
  if (rows_.empty()) rows_.push_back({0, 0, true, {}});
  Row& row = rows_.back();
  ++row.count;
  if (effect.kind == FDCG_EFFECT_MAGNET) row.object.reach_m = std::max(row.object.reach_m, effect.distance_m);
  effects_.push_back(effect);
}

void SceneEffects::set_relief(const fdcg_relief& relief) {
  rows_.back().has_relief = true;
  rows_.back().relief = relief;
}

void SceneEffects::begin(int devices) {
  reliefs_.assign(static_cast<std::size_t>(devices) * kMaxContacts, OnRelief{});
  states_.assign(static_cast<std::size_t>(devices) * kMaxContacts * effects_.size(), fdcg_effect_state{});
}

void SceneEffects::move(fdcg_object_id object, const fdcg_pose& pose) {
  for (Row& row : rows_)
    if (!row.is_world && row.object.id.index == object.index) row.object.pose = pose;
}

void SceneEffects::reset(int device) {
  for (int contact = 0; contact < kMaxContacts; ++contact)
    relief_of(device, contact) = OnRelief{};
  const std::size_t each = kMaxContacts * effects_.size();
  std::fill_n(states_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(device) * each), each,
              fdcg_effect_state{});
}

SceneEffects::OnRelief& SceneEffects::relief_of(int device, int contact) {
  return reliefs_[static_cast<std::size_t>(device) * kMaxContacts + static_cast<std::size_t>(contact)];
}

// Of the touched objects that which pushes most, where it has a relief.
const SceneEffects::Row* SceneEffects::strongest_row(const fdcg_finger_result& felt) const {
  const Row* strongest = nullptr;
  double most2 = 0;
  for (std::uint32_t t = 0; t < felt.touch_count; ++t) {
    const double square = dot(felt.touches[t].force_n, felt.touches[t].force_n);
    if (felt.touches[t].state == FDCG_FREE || !(square > most2)) continue;
    most2 = square;
    strongest = nullptr;
    for (const Row& row : rows_)
      if (row.has_relief && row.object.id.index == felt.touches[t].object.index) strongest = &row;
  }
  return strongest;
}

void SceneEffects::shift(int device, int contact, const double hip_world_m[3], double tick_s, double moved_world_m[3]) {
  OnRelief& on = relief_of(device, contact);
  std::copy_n(hip_world_m, 3, moved_world_m);
  std::copy_n(hip_world_m, 3, on.hip_world_m);
  if (on.row < 0) return;
  const Row& row = rows_[static_cast<std::size_t>(on.row)];
  const fdcg_finger_result free{};
  const Seen seen = see(row.object, hip_world_m, free);
  double hip_m[3], moved_m[3], by_m[3];
  for (int i = 0; i < 3; ++i)
    hip_m[i] = seen.hip_m[i] * seen.scale;
  fdcg_relief_move(&row.relief, &on.state, hip_m, tick_s, moved_m);
  if (on.state.height_m == 0) return;
  for (int i = 0; i < 3; ++i)
    by_m[i] = moved_m[i] - hip_m[i];
  for (int i = 0; i < 3; ++i)
    moved_world_m[i] += dot(seen.rows + 3 * i, by_m);
}

void SceneEffects::turn(int device, int contact, const fdcg_finger_result& felt, double tick_s, double force_n[3]) {
  OnRelief& on = relief_of(device, contact);
  const Row* const next = strongest_row(felt);
  const int next_row = next == nullptr ? -1 : static_cast<int>(next - rows_.data());
  const auto step = [&](const Row& row) {
    const Seen seen = see(row.object, on.hip_world_m, felt);
    const fdcg_effect_facts facts = facts_of(row.object, seen, tick_s);
    double own_n[3];
    to_object(seen.rows, force_n, own_n);
    fdcg_relief_turn(&row.relief, &on.state, &facts, own_n);
    for (int i = 0; i < 3; ++i)
      force_n[i] = dot(seen.rows + 3 * i, own_n);
  };
  if (on.row >= 0) step(rows_[static_cast<std::size_t>(on.row)]);
  if (next_row == on.row) return;
  // another object, or none: the account goes along
  const double credit_j = on.state.credit_j, given_j = on.state.given_j;
  const bool has_started = on.state.has_started != 0;
  on.state = fdcg_relief_state{};
  on.row = next_row;
  if (next == nullptr) return;
  on.state.given_j = given_j;
  step(*next);  // it has no slope yet: the force stays
  if (!has_started) return;
  on.state.credit_j = std::min(credit_j, next->relief.reserve_j);
  on.state.has_started = 1;
  std::copy_n(on.state.flat_n, 3, on.state.force_n);
  const Seen seen = see(next->object, on.hip_world_m, felt);
  for (int i = 0; i < 3; ++i)
    on.state.hip_m[i] = on.state.moved_m[i] = seen.hip_m[i] * seen.scale;
}

void SceneEffects::feel(int device, int contact, const double hip_world_m[3], const fdcg_finger_result& felt, double tick_s,
                        double force_n[3]) {
  fdcg_effect_state* const states =
      states_.data() + (static_cast<std::size_t>(device) * kMaxContacts + static_cast<std::size_t>(contact)) * effects_.size();
  for (const Row& row : rows_)
    feel_row(row, states + row.first, hip_world_m, felt, tick_s, force_n);
}

void SceneEffects::feel_row(const Row& row, fdcg_effect_state* states, const double hip_world_m[3],
                            const fdcg_finger_result& felt, double tick_s, double force_n[3]) const {
  double own_n[3] = {0, 0, 0};
  Seen seen{};
  if (!row.is_world) seen = see(row.object, hip_world_m, felt);
  const fdcg_effect_facts facts = row.is_world ? facts_of_world(hip_world_m, felt, tick_s) : facts_of(row.object, seen, tick_s);
  for (int i = 0; i < row.count; ++i)
    fdcg_effect_step(&effects_[static_cast<std::size_t>(row.first + i)], &facts, states + i, own_n);
  for (int i = 0; i < 3; ++i)
    force_n[i] += row.is_world ? own_n[i] : dot(seen.rows + 3 * i, own_n);
}

}  // namespace fdcg::dev
