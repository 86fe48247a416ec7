// SPDX-License-Identifier: Apache-2.0
// The loop of LoopSetup with the real step as its wall: a device pressed on a face of a compiled graph.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "contact_rig.hpp"
#include "loop_setup.hpp"

namespace fdcg::test {

// A block of 0.1 m in some orientation, and the middle of one of its faces.
class Wall {
 public:
  explicit Wall(std::uint64_t orientation_seed);
  [[nodiscard]] const fdcg_graph& graph() const { return mesh_->view(); }
  [[nodiscard]] Hip hip_at(double depth_m) const;                    // straight below the middle
  [[nodiscard]] double push_out_n(const fdcg_result& result) const;  // the force along the face's normal

 private:
  std::unique_ptr<CompiledMesh> mesh_;
  Hip middle_{}, normal_{};
};

// How the device is started and how long it is watched. It is pressed by a constant force that the wall of this stiffness bears
// at kPressed_m, and let go with a deviation from there.
constexpr double kPressed_m = 5e-3;
struct Watch {
  double deviation_m = 0;
  double encoder_offset = 0;  // of a quantum: where the encoder's steps lie
  long ticks = 0;
};

// What is seen of the device. The early window is the second quarter of the time, the late one the last.
struct Seen {
  bool has_left_wall = false;      // once it bounces it is not watched on
  double early_m = 0, late_m = 0;  // largest sqrt(x^2 + (v / w)^2) about the place of balance, w^2 = k / m
  double late_swing_m = 0;         // of x, from peak to peak
};

Seen run_loop(const Wall& wall, const LoopSetup& setup, double wall_n_per_m, const Watch& watch,
              std::vector<double>* trace_m = nullptr);

}  // namespace fdcg::test
