// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/session_view.hpp
/// What of a replayed session can be seen: objects, and tick by tick where everything is (LogReplay::scene, LogReplay::view).
/// Plain values. SI units, the world's frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/scene.h"
#include "fdcg/surface.h"

namespace fdcg::dev {

/// How an object comes to move: not at all, by its pose, as a body, or part by part.
enum class ViewedMotion : std::uint8_t { kFixed, kMoved, kBody, kSoft };

/// An object of the scene.
struct ViewedObject {
  std::string name;                            ///< as in the scene file
  std::string file;                            ///< of its graph; empty: it is a surface
  fdcg_surface surface{};                      ///< where it has no graph
  ViewedMotion motion = ViewedMotion::kFixed;  ///< how it moves
  fdcg_pose pose{};                            ///< at the beginning
  double mu_static = 0;                        ///< its coefficient of static friction
};

/// A device of the session.
struct ViewedDevice {
  std::string name;            ///< as in the scene file
  std::size_t world = 0;       ///< devices with the same number feel one scene
  std::vector<double> pads_m;  ///< of each contact the radius of its pad; 0: a point
};

/// What stays as it is from tick to tick.
struct ViewedScene {
  std::vector<ViewedObject> objects;  ///< in the scene file's order
  std::vector<ViewedDevice> devices;  ///< in the log's order
  std::size_t world_count = 0;        ///< of scenes; see ViewedDevice::world
  double gravity_m_per_s2[3] = {};    ///< on bodies
  bool has_ground = false;            ///< solid where ground_normal . x < ground_offset_m
  double ground_normal[3] = {};       ///< of length 1
  double ground_offset_m = 0;         ///< from the world's origin along the normal
};

/// A contact of a device, and of what it touches that which pushes most.
struct ViewedContact {
  double hip_m[3] = {};         ///< where the hand is
  double god_object_m[3] = {};  ///< where it would be, were nothing passed through
  double force_n[3] = {};       ///< on the hand
  double normal[3] = {};        ///< of the face or sphere that it touches; zero: of none
  std::uint32_t state = 0;      ///< fdcg_state
  std::uint32_t slipping = 0;   ///< 1: dynamic friction holds
  std::size_t object = 0;       ///< where state is not FDCG_FREE
};

/// Where the corners of a deformable mesh are.
struct ViewedSoft {
  std::size_t object = 0;                ///< its place in ViewedScene::objects
  std::size_t corners = 0;               ///< of its graph
  const double (*moved_m)[3] = nullptr;  ///< of each corner, from its place, object's frame; good until the next tick
};

/// One tick of one device.
struct ViewedTick {
  std::size_t device = 0;               ///< its place in ViewedScene::devices
  std::uint64_t tick = 0;               ///< its number
  double t_s = 0;                       ///< from the first tick of the log on
  std::uint32_t phase = 0;              ///< of the safety gate
  std::uint32_t fault = 0;              ///< what made the gate disarm; 0: nothing
  double wanted_force_n[3] = {};        ///< the scene's, before the safety gate
  double sent_force_n[3] = {};          ///< device's frame
  std::vector<ViewedContact> contacts;  ///< of this device
  std::vector<fdcg_pose> poses;         ///< of every object
  std::vector<ViewedSoft> soft;         ///< of every deformable mesh
};

}  // namespace fdcg::dev
