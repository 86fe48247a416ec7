// SPDX-License-Identifier: Apache-2.0
// Data of soft fingers in a scene's memory: after its other arrays, SoftFinger[fingers] | SoftTouch[fingers][touches].
#pragma once

#include "fdcg/scene.h"
#include "scene/pose.hpp"

namespace fdcg {

struct Turn {
  World v;  // x, y, z
  double w;
};

struct SoftFinger {
  double radius_m;  // 0: not soft
  Turn rotation;    // in the world
};

struct SoftTouch {
  fdcg_object_id object;
  uint32_t is_on;  // touching: the rest is of the last step
  uint32_t is_slipping;
  uint32_t state, feature;
  Turn reference;    // of the finger against the object, untwisted
  World god_object;  // object's frame
  World normal;      // object's frame
  World torque_n_m;  // world, on the finger
};

// In soft_finger.cpp, called through a pointer so that programs without soft fingers do not link it. Steps the contact of a
// finger's slot to a HIP in the object's frame.
using SoftStep = void(fdcg_scene* scene, uint32_t finger, uint32_t slot, fdcg_object_id object, fdcg_contact* contact,
                      World hip, fdcg_result* result);

}  // namespace fdcg
