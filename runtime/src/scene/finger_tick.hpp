// SPDX-License-Identifier: Apache-2.0
// One finger's tick in a scene: what scene_look.cpp finds out for it, and scene_step.cpp acts on.
#pragma once

#include "scene/reach.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {

// What is held back of a distance in the world: more than the rounding of computing with it.
inline constexpr double kHoldBack = 1 - 0x1p-30;

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

// 16 bits of the finger's own. Fingers that all come in at once would go on to look at the objects in one and the same tick; so
// each looks somewhat earlier than it must, or later than it might, by these.
inline uint32_t own_bits(const fdcg_scene& scene, const Finger& finger) {
  return (static_cast<uint32_t>(&finger - scene.fingers()) * 0x9E3779B9u) >> 16;
}

// The friction curve's speeds and depths, which are the world's, in the metres of an object of this scale.
inline void measure_in_object(double scale, fdcg_params* params) {
  params->stribeck_m_per_s /= scale;
  params->viscous_s_per_m *= scale;
  params->unique_solution_depth_m /= scale;
}

// The object's parameters as this finger meets them: with its material, and speeds and depths in the object's metres.
fdcg_params params_met(const Object& object, const Finger& finger);

// Whether the finger can have met the object in this tick; *way is set where the sphere says so.
bool can_have_met(const Tick& tick, const Object& object, LocalWay* way);

// Looks at every object: the near ones get the finger's free slots, and the finger learns how far it is from the others. Cost:
// 2 to 3 ns an object, some 20 more for one near the way. Slots of objects removed or disabled are empty.
void look(const Tick& tick);

}  // namespace fdcg
