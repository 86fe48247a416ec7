// SPDX-License-Identifier: Apache-2.0
// The simulated device behind its USB connection: mass, hand, encoders, firmware. For one thread; time advances only by
// advance().
#pragma once

#include "fdcg_firmware.h"
#include "transport/simulated_device.hpp"

namespace fdcg::dev {

class SimulatedBody {
 public:
  explicit SimulatedBody(const SimulationConfig& config);
  // The firmware restarts without force; the hand and the mass keep their state.
  void power_up();
  // Sets zero force; reports in transmission to the firmware are lost.
  void unplug();
  // Advances the simulation with the firmware's force at each moment. Earlier times have no effect. Covers at most
  // kMostCatchUpS; time before that is skipped.
  void advance(std::uint64_t time_ns);
  void set_fault(bool has_fault);
  void make_report(std::uint8_t* report);  // FDCG_FW_INPUT_BYTES of it
  void take(const std::uint8_t* data, int bytes);
  const double* position_m() const { return position_m_; }
  std::uint64_t time_ns() const { return time_ns_; }

  static constexpr double kMostCatchUpS = 10;

 private:
  std::uint32_t clock_us() const;
  void step(double step_s);
  void target(double now_s, int axis, double* place_m, double* speed_m_per_s) const;
  std::size_t script_step(double now_s) const;
  void note_force();

  SimulationConfig config_;
  fdcg_fw fw_ = {};
  std::uint64_t time_ns_ = 0, boot_ns_ = 0;
  double position_m_[3] = {}, velocity_m_per_s_[3] = {};
  float noted_n_[3] = {};
  bool had_tripped_ = false;
};

}  // namespace fdcg::dev
