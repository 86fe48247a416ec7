// SPDX-License-Identifier: Apache-2.0
#include "recording/replayed_scene.hpp"

#include <cmath>

#include "base/rotation.hpp"

namespace fdcg::dev {
namespace {

void normal_of_ball(const ObjectConfig& ball, const fdcg_pose& pose, const double at_m[3], double normal[3]) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    normal[i] = (at_m[i] - pose.translation_m[i]) * (ball.surface.is_hollow != 0 ? -1 : 1);
    square += normal[i] * normal[i];
  }
  const double length = std::sqrt(square);
  for (int i = 0; i < 3; ++i)
    normal[i] /= length > 0 ? length : 1;
}

}  // namespace

std::vector<ReplayedTouch> touches_of(const DeviceSetup& setup) {
  std::vector<ReplayedTouch> touches;
  for (int contact = 0; contact < setup.contact_count; ++contact) {
    fdcg_finger_result finger{};
    const bool is_there = fdcg_scene_get_result(setup.scene, setup.fingers[contact], &finger, nullptr) == FDCG_OK;
    for (std::uint32_t i = 0; is_there && i < finger.touch_count; ++i)
      if (finger.touches[i].state != FDCG_FREE) touches.push_back({finger.touches + i, contact});
  }
  return touches;
}

const fdcg_pose& tick_pose(const HostConfig& config, const ReplayedTick& tick, std::size_t object) {
  std::size_t body = 0, moved = 0;
  for (std::size_t i = 0; i < object; ++i) {
    body += config.objects[i].motion.kind == MotionKind::kBody;
    moved += is_moved(config.objects[i].motion);
  }
  const ObjectConfig& of = config.objects[object];
  if (of.motion.kind == MotionKind::kBody && body < tick.output->body_count) return tick.output->bodies[body];
  if (is_moved(of.motion) && moved < tick.input->pose_count) return tick.input->poses[moved];
  return of.pose;
}

bool touched_normal(const SessionReplay& replay, const ReplayedTick& tick, const fdcg_touch& touch, double normal[3]) {
  const std::size_t object = touch.object.index;
  const ObjectConfig& of = replay.config().objects[object];
  if (of.is_surface && of.surface.kind == FDCG_SURFACE_SPHERE) {
    normal_of_ball(of, tick_pose(replay.config(), tick, object), touch.god_object_m, normal);
  } else if (!of.is_surface && of.motion.kind != MotionKind::kSoft && touch.state == FDCG_FACE) {
    turn(tick_pose(replay.config(), tick, object).rotation_xyzw, fdcg_get_node(&replay.graph(object), touch.feature).normal,
         normal);
  } else {
    return false;
  }
  return true;
}

}  // namespace fdcg::dev
