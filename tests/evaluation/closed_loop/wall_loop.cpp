// SPDX-License-Identifier: Apache-2.0
#include "wall_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meshes.hpp"

namespace fdcg::test {
namespace {

constexpr double kBlock_m = 0.1;

// The force that the step gives for a reading, along the axis of the device, positive into the wall.
class Renderer {
 public:
  Renderer(const Wall& wall, const LoopSetup& setup, double wall_n_per_m) : wall_(wall) {
    params_.stiffness_n_per_m = wall_n_per_m;
    params_.damping_n_s_per_m = setup.virtual_damping_n_s_per_m;
    params_.tick_s = setup.tick_s();
    step(-kPressed_m);  // comes from outside
    step(kPressed_m);
    step(kPressed_m);
  }
  double step(double depth_m) {
    const Hip hip = wall_.hip_at(depth_m);
    fdcg_step(&wall_.graph(), &params_, &contact_, hip.data(), &result_);
    return -wall_.push_out_n(result_);
  }
  [[nodiscard]] bool is_in_contact() const { return result_.state != FDCG_FREE; }

 private:
  const Wall& wall_;
  fdcg_params params_ = fdcg_make_params();
  fdcg_contact contact_{};
  fdcg_result result_{};
};

}  // namespace

Wall::Wall(std::uint64_t orientation_seed) {
  const Rotation turn = random_rotation(orientation_seed);
  mesh_ = std::make_unique<CompiledMesh>(transformed(triangulated(cube()), turn, kBlock_m));
  middle_ = point_of(rotated(turn, {0, 0, kBlock_m / 2}));
  normal_ = point_of(rotated(turn, {0, 0, 1}));
}

Hip Wall::hip_at(double depth_m) const {
  return {middle_[0] - depth_m * normal_[0], middle_[1] - depth_m * normal_[1], middle_[2] - depth_m * normal_[2]};
}

double Wall::push_out_n(const fdcg_result& result) const {
  return dot({result.force_n[0], result.force_n[1], result.force_n[2]}, normal_);
}

Seen run_loop(const Wall& wall, const LoopSetup& setup, double wall_n_per_m, const Watch& watch, std::vector<double>* trace_m) {
  const HeldPlant device(setup.plant, setup.tick_s());
  Renderer renderer(wall, setup, wall_n_per_m);
  const double all_n_per_m = wall_n_per_m + setup.plant.stiffness_n_per_m, push_n = all_n_per_m * kPressed_m;
  const double swing_per_s = std::sqrt(all_n_per_m / setup.plant.mass_kg);
  const auto read = [&](double x) {
    if (setup.quantum_m == 0) return x;
    const double offset_m = watch.encoder_offset * setup.quantum_m;
    return std::floor((x - offset_m) / setup.quantum_m) * setup.quantum_m + offset_m;
  };
  std::array<double, kMostDelay_ticks + 1> under_way;  // a ring of forces
  const auto slots = static_cast<std::size_t>(setup.delay_ticks) + 1;
  under_way.fill(-wall_n_per_m * kPressed_m);
  PlantState state = {kPressed_m + watch.deviation_m, 0};
  Seen seen;
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (long tick = 0; tick < watch.ticks; ++tick) {
    const auto now = static_cast<std::size_t>(tick) % slots;
    under_way[now] = renderer.step(read(state.x_m));
    if (!renderer.is_in_contact()) {
      seen.has_left_wall = true;
      return seen;
    }
    const double wall_n = under_way[(now + 1) % slots];  // the oldest
    state = device.after_tick(state, push_n + wall_n);
    const double off_m = state.x_m - kPressed_m;
    if (trace_m != nullptr) trace_m->push_back(off_m);
    const double size_m = std::hypot(off_m, state.v_m_per_s / swing_per_s);
    const long quarter = 4 * tick / watch.ticks;
    if (quarter == 1) seen.early_m = std::max(seen.early_m, size_m);
    if (quarter == 3) {
      seen.late_m = std::max(seen.late_m, size_m);
      low_m = std::min(low_m, state.x_m), high_m = std::max(high_m, state.x_m);
    }
  }
  seen.late_swing_m = high_m - low_m;
  return seen;
}

}  // namespace fdcg::test
