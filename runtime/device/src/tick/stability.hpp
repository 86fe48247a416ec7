// SPDX-License-Identifier: Apache-2.0
// The stage before the gate: it keeps a loop that is stiffer than its device allows from shaking, and the motors from heat. A
// pure function of places, forces and times, as the gate is. No heap, no lock, bounded work. Three parts; a scene may switch
// the first two off (schemas/servo-scene.schema.json, "stability"), and the third needs a continuous force in the device's
// profile:
//
//   passivity    An observer adds up the energy that the device was given, force times way; what it may give back is what is
//                stored in the touched springs. Where more comes out, a controller damps the hand until that is made good
//                (Hannaford and Ryu 2002, Time-domain passivity control of haptic interfaces, IEEE T. Robotics and Automation
//                18(1), sections III and IV, impedance causality). Forces are paired with the way that they caused: they are as
//                old as the link's round trip.
//   calming      Force that goes to and fro faster than a hand can, in place, without fading and without rubbing: all
//                forces of the scene are cut to a tenth, for as long as the device is armed. Where that does not end it, the
//                gate disarms. The same for bounces that feed themselves (bounce_watch.hpp), where passivity is on too: what
//                moves by itself may throw a hand.
//   heat         The mean square of the force, with the motors' time constant, stays below the square of the continuous force.
#pragma once

#include <cstdint>

#include "profile/profile.hpp"
#include "tick/bounce_watch.hpp"

namespace fdcg::dev {

inline constexpr double kSwingShare = 0.04;       // of the force limit: smaller swings, from peak to peak, are no shaking
inline constexpr double kShakeS = 0.22;           // two and a half swings to and fro within this
inline constexpr int kReversals = 5;              // are so many changes of direction
inline constexpr double kFadingShare = 0.6;       // the last swing of these is at least so much of the first
inline constexpr double kInPlaceShare = 1.0 / 3;  // where they end is no farther from where they began than this of the way
inline constexpr double kLossShare = 0.3;     // and of the energy that goes to and fro the hand loses no more: it does not rub
inline constexpr double kCalmingShare = 0.1;  // of the force that is left each time
inline constexpr int kMostCalmings = 3;       // then the gate disarms ...
inline constexpr double kLongestShakeS = 0.25;  // ... or where shaking goes on for so long
inline constexpr double kShakePauseS = 0.1;     // without a change of direction: it has ended
inline constexpr double kMostDamping_n_s_per_m = 20;
inline constexpr double kFreeEnergy_j = 1e-4;  // that may come out beside what is stored: rounding of encoders
inline constexpr double kMostOwed_j = 0.05;    // so the damping of what nobody can make good ends

// The force of effects (fdcg/effect.h), which have accounts of their own: the first two parts do not judge it. It is cut where
// the scene's force is, and it heats the motors.
struct EffectForce {
  double now_n[3] = {};   // to be added
  double sent_n[3] = {};  // what of sent_n below was theirs
};

struct StabilitySetup {
  bool has_passivity = false, has_calming = false;
  double stiffness_n_per_m = 0;  // the least that is touched, felt at the device: what a force has stored is f^2 / (2 K)
};

class Stability {
 public:
  void begin(const StabilitySetup& setup, const DeviceLimits& limits, double rate_hz);
  // Nothing is known of the past: armed anew.
  void reset();
  // A tick with a good report. tip_m and force_n: device's frame; the force is changed in place. sent_n: what the gate let
  // through in the tick before. round_trip_s: 0 where it is not known. rubs: a touch slides with friction, whose turns are the
  // hand's.
  void step(const double tip_m[3], std::uint64_t now_ns, const double sent_n[3], double round_trip_s, bool rubs,
            double force_n[3], const EffectForce& effects = {});

  double share() const { return share_; }                // of the scene's force
  double damping() const { return damping_n_s_per_m_; }  // of the passivity controller, in this tick
  double given_j() const { return given_j_; }            // to the hand, since it was armed
  bool shakes() const { return shakes_; }                // calming has not helped
  bool is_hot() const { return is_hot_; }                // the force is cut to what the motors stand

 private:
  static constexpr int kSent = 64;
  struct Axis {
    double turned_n = 0, extreme_n = 0;  // where the force turned last; and the farthest that it has gone since
    int direction = 0;                   // 0: it has not swung yet
    std::uint64_t since_ns = 0;          // of the first change of direction that no pause came after
    struct Reversal {
      std::uint64_t ns = 0;
      double swing_n = 0, path_m = 0;  // to it from the one before; all the way so far
      double place_m[3] = {};
      double given_j = 0, moved_j = 0;  // to the hand, in all; and to and fro
    } last[kReversals];                 // a ring
    int count = 0;
  };
  void observe(const double way_m[3], double round_trip_s);
  void look_for_shaking(const double force_n[3], const double tip_m[3], std::uint64_t now_ns);
  bool has_reversed(Axis& axis, double force_n, const double tip_m[3], std::uint64_t now_ns) const;
  static bool is_shaking(const Axis& axis);
  void forget_swings();
  void calm(std::uint64_t since_ns, std::uint64_t now_ns);
  void damp(const double way_m[3], double seconds, double force_n[3]);
  void cool(const double sent_n[3], double seconds, double force_n[3]);

  StabilitySetup setup_;
  DeviceLimits limits_;
  double period_s_ = 0;
  bool has_last_ = false, shakes_ = false, is_hot_ = false;
  double last_m_[3] = {};
  std::uint64_t last_ns_ = 0;
  double sent_n_[kSent][3] = {};  // a ring
  std::uint32_t sent_count_ = 0;
  double stored_j_ = 0, given_j_ = 0, moved_j_ = 0, path_m_ = 0, damping_n_s_per_m_ = 0;
  double share_ = 1;
  int calmings_ = 0;
  std::uint64_t shakes_since_ns_ = 0, last_calmed_ns_ = 0;  // of the shaking that was calmed last
  Axis axes_[3];
  BounceWatch bounces_;
  double heat_n2_ = 0;  // mean square of the force; kept by reset: motors stay hot
};

}  // namespace fdcg::dev
