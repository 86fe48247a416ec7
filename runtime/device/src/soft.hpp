// SPDX-License-Identifier: Apache-2.0
// A soft sheet (fdcg/deform.h): a graph whose corners give way under contacts and come back. Each corner hangs on a spring to
// where the file has it and on one to each neighbour, in something thick: it has no mass and no speed of its own, so it never
// swings. A contact's force goes to the three corners of the triangle that it is on, by how near the god-object is to each.
//
//   damping * du/dt = force - stiffness * u + tension * sum over neighbours (u_neighbour - u)
//
// Stepped once a tick by backward differences in the corner's own place: stable at any stiffness. A corner that is hardly out
// of its place and feels nothing is put back and costs nothing but the look. No heap after begin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/deform.h"
#include "fdcg/scene.h"
#include "grip.hpp"

namespace fdcg::dev {

struct SoftConfig {
  double stiffness_n_per_m = 5;  // of each corner to its place, above 0
  double tension_n_per_m = 100;  // along each edge, >= 0
  double damping_n_s_per_m = 2;  // of each corner, above 0
  double depth_m = 0.05;         // that a corner can be moved along each axis
};

// What the device's tick feels of it.
struct SoftTouch {
  std::uint32_t state = 0;  // fdcg_state
  std::uint32_t feature = 0, slipping = 0;
  double force_n[3] = {};       // world, on the contact
  double god_object_m[3] = {};  // world
};

class SoftObject {
 public:
  // `graph` must outlive it. Empty: fine. Otherwise why the graph cannot be deformed.
  std::string begin(const fdcg_graph& graph, const SoftConfig& config, const fdcg_params& params, const fdcg_pose& pose,
                    int contact_count);
  // Lets go of every contact: the next step of each starts where it is.
  void release();
  // The contacts at these places (world) press, then the sheet moves on by tick_s.
  void step(const double (*contacts_m)[3], double tick_s);

  const SoftTouch& touch(int contact) const { return touches_[contact]; }
  double deepest_m() const { return deepest_m_; }  // the farthest that a corner is from its place, world
  const double (*displacements_m() const)[3] { return reinterpret_cast<const double(*)[3]>(moved_m_.data()); }

 private:
  void press(int contact, const double place_world_m[3]);
  void share_out(const fdcg_result& result);
  void relax(double tick_s);

  const fdcg_graph* graph_ = nullptr;
  SoftConfig config_;
  fdcg_params params_;
  fdcg_pose pose_;
  double turn_[9] = {};  // object to world
  int contact_count_ = 0;
  fdcg_deform* deform_ = nullptr;
  fdcg_deform_contact contacts_[kMaxContacts];
  SoftTouch touches_[kMaxContacts];
  double deepest_m_ = 0;
  std::vector<std::uint64_t> memory_;
  // By corner, in the object's frame: where it belongs, how far it is from there, what pushes it.
  std::vector<double> rest_m_, moved_m_, pushed_n_;
  std::vector<std::uint32_t> first_neighbour_, neighbours_;
};

}  // namespace fdcg::dev
