// SPDX-License-Identifier: Apache-2.0
// One finger's tick in a scene: the result of the broad phase (scene_look.cpp), used by scene_step.cpp.
#pragma once

#include "scene/reach.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {

// Safety margin subtracted from a distance in the world: more than its rounding error.
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

// 16 pseudo-random bits of the finger. Fingers added at once would update their broad phase in the same ticks; these bits shift
// each update slightly within its allowed range.
inline uint32_t own_bits(const fdcg_scene& scene, const Finger& finger) {
  return (static_cast<uint32_t>(&finger - scene.fingers()) * 0x9E3779B9u) >> 16;
}

// The friction curve's speeds and depths, converted from the world to the frame of an object of this scale.
inline void measure_in_object(double scale, fdcg_params* params) {
  params->stribeck_m_per_s /= scale;
  params->viscous_s_per_m *= scale;
  params->unique_solution_depth_m /= scale;
}

// The object's parameters for this finger: with its material, and with speeds and depths in the object's frame.
fdcg_params params_met(const Object& object, const Finger& finger);

// Whether the finger can have touched the object in this tick; *way is set if the bounding sphere is reached.
bool can_have_met(const Tick& tick, const Object& object, LocalWay* way);

// Broad-phase update over all objects: the near ones get the finger's free slots, and the least distance to the others is
// stored in the finger. Cost: 2 to 3 ns per object, some 20 more for one near the way. Slots of removed or disabled objects are
// empty.
void look(const Tick& tick);

}  // namespace fdcg
