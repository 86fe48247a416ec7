// SPDX-License-Identifier: Apache-2.0
// Effects (fdcg/effect.h) of a scene's objects, and of the scene itself, and reliefs (fdcg/relief.h) of objects, on the
// contacts of its devices. An object's effects are computed in its frame, with lengths of the world, so that what is felt and
// what is accounted for is the hand's motion over the object. They act on hands alone: objects do not feel them.
//
// Set up once, with memory; a tick has no heap, no lock, no clock. Bounded but for magnets, which ask for the nearest place of
// their object's surface (fdcg/query.h).
#pragma once

#include <cstdint>
#include <vector>

#include "fdcg/effect.h"
#include "fdcg/relief.h"
#include "fdcg/scene.h"
#include "fdcg/surface.h"

namespace fdcg::dev {

inline constexpr int kMaxEffects = 64;  // of a scene

// An object with effects. Exactly one of graph and surface is there.
struct FeltObject {
  fdcg_object_id id{};
  const fdcg_graph* graph = nullptr;
  const fdcg_surface* surface = nullptr;
  fdcg_pose pose{};
  double reach_m = 0;  // of its magnets, world
};

class SceneEffects {
 public:
  // Objects first, then effects: of the object that was added last, or, before the first, of the world.
  void add_object(const FeltObject& object);
  void add(const fdcg_effect& effect);
  void set_relief(const fdcg_relief& relief);  // of the object that was added last
  // Makes room for the states.
  void begin(int devices);

  // Where an object is in this tick; others are passed by.
  void move(fdcg_object_id object, const fdcg_pose& pose);
  // All effects of a device's contacts begin anew.
  void reset(int device);
  // Where the scene is told that a contact is, by the relief of what it touched in the last tick.
  void shift(int device, int contact, const double hip_world_m[3], double tick_s, double moved_world_m[3]);
  // What a contact of the scene's step gives the hand: the force, world, changed in place.
  void turn(int device, int contact, const fdcg_finger_result& felt, double tick_s, double force_n[3]);
  // Adds the forces on one contact to force_n, world.
  void feel(int device, int contact, const double hip_world_m[3], const fdcg_finger_result& felt, double tick_s,
            double force_n[3]);

 private:
  struct Row {
    int first = 0, count = 0;  // of effects_
    bool is_world = false;
    FeltObject object;
    bool has_relief = false;
    fdcg_relief relief{};
  };
  // The relief that a contact is on.
  struct OnRelief {
    int row = -1;  // -1: none
    double hip_world_m[3] = {};
    fdcg_relief_state state{};
  };
  OnRelief& relief_of(int device, int contact);
  const Row* strongest_row(const fdcg_finger_result& felt) const;
  void feel_row(const Row& row, fdcg_effect_state* states, const double hip_world_m[3], const fdcg_finger_result& felt,
                double tick_s, double force_n[3]) const;

  std::vector<Row> rows_;
  std::vector<fdcg_effect> effects_;
  std::vector<fdcg_effect_state> states_;  // [device][contact][effect]
  std::vector<OnRelief> reliefs_;          // [device][contact]
};

// Whether magnets know its distance.
bool has_known_distance(const fdcg_surface& surface);

}  // namespace fdcg::dev
