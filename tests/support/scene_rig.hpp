// SPDX-License-Identifier: Apache-2.0
// What tests and benchmarks of scenes share: a scene with its memory, poses, rotations by axis and angle.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "fdcg/scene.h"
#include "random.hpp"

namespace fdcg::test {

using Place = std::array<double, 3>;

// About `axis` (unit) by `angle_rad`.
inline fdcg_pose posed(const Place& translation, const Place& axis = {0, 0, 1}, double angle_rad = 0, double scale = 1) {
  const double s = std::sin(angle_rad / 2);
  return {{axis[0] * s, axis[1] * s, axis[2] * s, std::cos(angle_rad / 2)},
          {translation[0], translation[1], translation[2]},
          scale};
}

// The pose turned on about an axis of the world through its own origin.
inline fdcg_pose turned(fdcg_pose pose, const Place& axis, double angle_rad) {
  const fdcg_pose turn = posed({0, 0, 0}, axis, angle_rad);
  const double *a = turn.rotation_xyzw,
               b[4] = {pose.rotation_xyzw[0], pose.rotation_xyzw[1], pose.rotation_xyzw[2], pose.rotation_xyzw[3]};
  pose.rotation_xyzw[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
  pose.rotation_xyzw[1] = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0];
  pose.rotation_xyzw[2] = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3];
  pose.rotation_xyzw[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
  return pose;
}

inline Place direction(Random& random) {
  const bake::Vec3 d = random.direction();
  return {d.x, d.y, d.z};
}

// A scene in memory of its own. Throws where the scene refuses.
class SceneRig {
 public:
  explicit SceneRig(const fdcg_scene_config& config) : memory_((fdcg_scene_bytes(&config) + 7) / 8) {
    expect(fdcg_scene_create(memory_.data(), memory_.size() * 8, &config, &scene_, &error_));
  }
  SceneRig(const SceneRig&) = delete;
  SceneRig& operator=(const SceneRig&) = delete;

  fdcg_object_id add(const fdcg_graph& graph, const fdcg_params& params, const fdcg_pose& pose) {
    fdcg_object_id id;
    expect(fdcg_scene_add_object(scene_, &graph, &params, &pose, &id, &error_));
    return id;
  }
  fdcg_finger_id add(const Place& hip) {
    fdcg_finger_id id;
    expect(fdcg_scene_add_finger(scene_, hip.data(), &id, &error_));
    return id;
  }
  void pose(fdcg_object_id object, const fdcg_pose& pose) { expect(fdcg_scene_set_pose(scene_, object, &pose, &error_)); }
  void move(fdcg_finger_id finger, const Place& hip) { expect(fdcg_scene_move_finger(scene_, finger, hip.data(), &error_)); }
  void step() { fdcg_scene_step(scene_); }
  [[nodiscard]] fdcg_finger_result result(fdcg_finger_id finger) {
    fdcg_finger_result result;
    expect(fdcg_scene_get_result(scene_, finger, &result, &error_));
    return result;
  }
  [[nodiscard]] fdcg_scene* get() const { return scene_; }
  [[nodiscard]] std::vector<std::uint64_t>& memory() { return memory_; }

 private:
  void expect(fdcg_status status) const {
    if (status != FDCG_OK) throw std::runtime_error(error_.message);
  }

  std::vector<std::uint64_t> memory_;
  fdcg_scene* scene_ = nullptr;
  fdcg_error error_ = {};
};

}  // namespace fdcg::test
