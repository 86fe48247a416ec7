// SPDX-License-Identifier: Apache-2.0
// The simulated device itself, behind its USB socket: mass, hand, encoders, firmware. One thread; time only goes forward, and
// only when it is told to.
#pragma once

#include "fdcg_firmware.h"
#include "transport/simulated_device.hpp"

namespace fdcg::dev {

class SimulatedBody {
 public:
  explicit SimulatedBody(const SimulationConfig& config);
  // The firmware begins anew, without force; the hand and the mass are where they are.
  void power_up();
  // The force ends; what was on its way to the firmware is lost.
  void unplug();
  // Lets time pass, with the force that the firmware gives at each moment. Earlier times do nothing. Reaches back at most
  // kMostCatchUpS: what lies before that is left out.
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
