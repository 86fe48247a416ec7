// SPDX-License-Identifier: Apache-2.0
// What a hand feels of a contender's loop, beside what it feels of the truth's own.
#pragma once

#include <cstddef>
#include <vector>

#include "hand_loop.hpp"

namespace fdcg::test {

// A force that differs by less is not counted as felt, however small the true one is: chosen, some five grammes.
constexpr double kLeastFelt_n = 0.05;

struct HandMetrics {
  double rms_n = 0, max_n = 0;             // of the difference of the forces on the hand
  double vibration_n = 0;                  // RMS of that difference between 80 and 450 Hz, all axes
  double true_vibration_n = 0;             // of the true force on the hand
  double direction_p99_deg = 0;            // between the forces, where both are over kLeastFelt_n
  double felt_share = 0, felt_ms = 0;      // ticks, and the longest run of them, that differ by over 7 % and kLeastFelt_n
  double apart_m = 0;                      // of the devices, at most
  double lost_share = 0;                   // of the truth's ticks in contact: the contender is free
  double held_swing_m = 0;                 // of the device, from end to end, in the second half of the hold
  double gained_j = 0, true_gained_j = 0;  // work of the contact on the device, over the whole way, from free to free
};
HandMetrics judge_hand(const std::vector<HandTick>& ticks, const std::vector<HandTick>& truth, double rate_hz,
                       std::size_t held_from, std::size_t held_to);

}  // namespace fdcg::test
