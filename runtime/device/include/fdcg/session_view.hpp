// SPDX-License-Identifier: Apache-2.0
// What of a replayed session can be seen: objects, and tick by tick where everything is (LogReplay::scene, LogReplay::view).
// Plain values. SI units, the world's frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/scene.h"
#include "fdcg/surface.h"

namespace fdcg::dev {

enum class ViewedMotion : std::uint8_t { kFixed, kMoved, kBody, kSoft };

struct ViewedObject {
  std::string name;
  std::string file;        // of its graph; empty: it is a surface
  fdcg_surface surface{};  // where it has no graph
  ViewedMotion motion = ViewedMotion::kFixed;
  fdcg_pose pose{};  // at the beginning
  double mu_static = 0;
};

struct ViewedDevice {
  std::string name;
  std::size_t world = 0;       // devices with the same number feel one scene
  std::vector<double> pads_m;  // of each contact the radius of its pad; 0: a point
};

struct ViewedScene {
  std::vector<ViewedObject> objects;
  std::vector<ViewedDevice> devices;
  std::size_t world_count = 0;
  double gravity_m_per_s2[3] = {};
  bool has_ground = false;  // solid where ground_normal . x < ground_offset_m
  double ground_normal[3] = {}, ground_offset_m = 0;
};

// A contact of a device, and of what it touches that which pushes most.
struct ViewedContact {
  double hip_m[3] = {}, god_object_m[3] = {}, force_n[3] = {};
  double normal[3] = {};  // of the face or sphere that it touches; zero: of none
  std::uint32_t state = 0, slipping = 0;
  std::size_t object = 0;  // where state is not FDCG_FREE
};

struct ViewedSoft {
  std::size_t object = 0;
  std::size_t corners = 0;               // of its graph
  const double (*moved_m)[3] = nullptr;  // of each corner, from its place, object's frame; good until the next tick
};

struct ViewedTick {
  std::size_t device = 0;
  std::uint64_t tick = 0;
  double t_s = 0;  // from the first tick of the log on
  std::uint32_t phase = 0, fault = 0;
  double wanted_force_n[3] = {};  // the scene's, before the safety gate
  double sent_force_n[3] = {};    // device's frame
  std::vector<ViewedContact> contacts;
  std::vector<fdcg_pose> poses;  // of every object
  std::vector<ViewedSoft> soft;
};

}  // namespace fdcg::dev
