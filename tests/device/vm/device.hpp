// SPDX-License-Identifier: Apache-2.0
// The virtual device: the reference firmware core behind a port, a hand that moves it, and a record of what its motors did.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>

#include "clock.hpp"
#include "fdcg_firmware.h"
#include "port.hpp"

namespace fdcg::vm {

// The last two bytes: the CRC of those before them.
void set_crc(Bytes& report);

// Where the hand holds the tip: above the surface (z = 0) or inside it, moving at most kHandSpeed on the way.
class Hand {
 public:
  static constexpr double kAboveM = 0.005, kBelowM = -0.003, kSpeedMPerS = 0.2;
  void above() { target_m_ = kAboveM; }
  void below() { target_m_ = kBelowM; }
  bool is_above() const { return z_m_ == kAboveM; }
  std::array<double, 3> at(Nanoseconds now);

 private:
  double target_m_ = kAboveM, z_m_ = kAboveM;
  Nanoseconds last_ = 0;
};

// What the motors did and whom they obeyed.
struct Record {
  std::uint64_t sent = 0, answered = 0;    // reports; those that an output report named as the one it answers
  std::uint64_t outputs = 0, refused = 0;  // output reports, and those that the firmware did not take
  std::uint64_t misled = 0;                // non-zero forces that answer no report, or one that must not be used
  std::uint64_t watchdog_trips = 0;
  std::vector<std::uint32_t> round_trips_ns;  // from a report's sending to the first output that answers it
  Nanoseconds oldest_answer = 0;              // of a non-zero force: since the report that it answers was sent
  double most_force_n = 0;
  double force_n = 0;           // now
  bool is_enabled = false;      // by the last output report taken
  Nanoseconds force_since = 0;  // when it last became non-zero
  Nanoseconds last_output = 0;
  Nanoseconds watched_from = 0, first_zero = 0;  // the first moment without force since `watch`; 0: none yet
  Nanoseconds output_before_zero = 0;            // last_output at that moment
  double most_rise_n = 0;                        // of the force in one output, from `watch` to its end

  // Counts and worst values begin again; what the motors do now stays.
  void restart();
  void watch(Nanoseconds from) {
    watched_from = from;
    first_zero = 0;
    most_rise_n = 0;
  }
  void restart_forces() { most_force_n = force_n; }
};

class Device final : public PortUser {
 public:
  // A report on its way: kept, altered, doubled, left out.
  using Wire = std::function<void(const Bytes& report)>;

  Device(std::unique_ptr<Port> port, int rate_hz, bool has_float_axes, bool has_watchdog);
  // As after a loss of power, or (false) with its motors' supply, its clock and its counters kept.
  void plug(bool is_power_cycled);
  void unplug();
  void restart() { power_up(); }  // without anybody being told
  // What its feature report says is not what it is, by the low bit of that byte; -1: it is.
  void misdescribe(int byte) { wrong_byte_ = byte; }
  // An output report of another program: no force, and a number that this host has not come to.
  void hear_another(std::uint32_t ahead);
  int fd() const { return port_->fd(); }
  void receive();
  // Makes a report of this moment and gives it to the wire.
  void tick();
  void send(const Bytes& report) { port_->send(report); }
  void take_output(bool takes);
  // From now on reports, or outputs, are so long under way, to the next tick; 0, 0: none, and what was under way is lost.
  void lag(Nanoseconds on_reports, Nanoseconds on_outputs);

  void set_wire(Wire wire) { wire_ = std::move(wire); }
  void clear_wire() { wire_ = nullptr; }
  // Reports from now on must not be answered by force: they are bad, or the host must not be there.
  void distrust(bool is_bad) { is_bad_ = is_bad; }

  Hand hand;
  Record record;

  void on_output(const std::uint8_t* data, int bytes) override;
  Bytes on_get_feature(int report_id) override;

 private:
  struct Sent {
    std::uint32_t sequence = 0;
    bool is_bad = false, is_answered = false;
    Nanoseconds at = 0;
  };
  static constexpr std::size_t kRemembered = 1 << 17;

  struct UnderWay {
    Nanoseconds due = 0;
    Bytes bytes;
  };
  void power_up();
  void take(const std::uint8_t* data, int bytes);
  void arrive(Nanoseconds now);
  void note_force(Nanoseconds now);
  std::uint32_t device_us(Nanoseconds now) const { return static_cast<std::uint32_t>((now - born_) / kMicrosecond); }

  std::unique_ptr<Port> port_;
  fdcg_fw firmware_{};
  int rate_hz_, wrong_byte_ = -1;
  bool has_float_axes_, has_watchdog_, is_bad_ = false, was_tripped_ = false;
  Nanoseconds born_ = 0;
  Wire wire_;
  Nanoseconds lag_of_reports_ = 0, lag_of_outputs_ = 0;
  std::deque<UnderWay> reports_, outputs_;
  std::vector<Sent> sent_ = std::vector<Sent>(kRemembered);
};

}  // namespace fdcg::vm
