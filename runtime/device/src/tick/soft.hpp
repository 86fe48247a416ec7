// SPDX-License-Identifier: Apache-2.0
// A soft sheet (fdcg/deform.h), an object of a scene: a graph whose corners yield elastically under contacts. Each corner has a
// spring to its rest position and one to each neighbour, with viscous damping and without mass (overdamped, no oscillation). A
// contact's force is distributed to the three corners of its triangle by barycentric coordinates of the god-object, and from
// there over a radius (soft_load.hpp).
//
//   damping * du/dt = force - stiffness * u + tension * sum over neighbours (u_neighbour - u)
//
// Stepped once per tick, implicitly (backward Euler) in each corner's own position: stable at any stiffness. An unloaded corner
// close to its rest position is reset to it and costs only a test. No heap after begin.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fdcg/deform.h"
#include "fdcg/scene.h"
#include "scene/soft_load.hpp"

namespace fdcg::dev {

struct SoftConfig {
  double stiffness_n_per_m = 5;    // of each corner to its place, above 0
  double tension_n_per_m = 100;    // along each edge, >= 0
  double damping_n_s_per_m = 2;    // of each corner, above 0
  double depth_m = 0.05;           // that a corner can be moved along each axis
  std::optional<double> radius_m;  // over which a contact's force is spread (soft_load.hpp); none: by the mesh
};

class SoftObject {
 public:
  // `graph` must outlive it. Empty: fine. Otherwise why the graph cannot be deformed.
  std::string begin(const fdcg_graph& graph, const SoftConfig& config, const fdcg_pose& pose);
  // What a scene of this pose adds (fdcg_scene_add_deform).
  fdcg_deform* deform() const { return deform_; }

  // A finger's touch of it in the scene's last step: presses in the next relax.
  void press(const fdcg_touch& touch);
  // The sheet moves on by tick_s.
  void relax(double tick_s);

  double radius_m() const { return load_.radius_m(); }  // over which a contact's force is spread
  double deepest_m() const { return deepest_m_; }       // the farthest that a corner is from its place, world
  const double (*displacements_m() const)[3] { return reinterpret_cast<const double(*)[3]>(moved_m_.data()); }

 private:
  const fdcg_graph* graph_ = nullptr;
  SoftConfig config_;
  fdcg_pose pose_;
  double turn_[9] = {};  // object to world
  fdcg_deform* deform_ = nullptr;
  double deepest_m_ = 0;
  std::vector<std::uint64_t> memory_;
  // By corner, in the object's frame: rest position and displacement.
  std::vector<double> rest_m_, moved_m_;
  CornerNeighbours corners_;
  SoftLoad load_;
};

}  // namespace fdcg::dev
