// SPDX-License-Identifier: Apache-2.0
// Contacts that open and close, and turn about the tip, while a button of the device is held: a gripper for devices without an
// axis for one. While a button is held its share goes from 0 to 1 in `seconds`, after release back to 0; the contacts follow
// smoothly. Pure, no heap, no trigonometric functions: the same bits on every machine.
#pragma once

#include <cstdint>

namespace fdcg::dev {

inline constexpr int kMaxContacts = 8;  // of one device
inline constexpr int kMaxButtons = 32;

struct HeldButton {
  std::uint32_t mask = 0;  // of Sample::buttons; 0: there is no such button
  double seconds = 0.5;    // from 0 to 1, above 0
};

struct Grip {
  HeldButton close, turn;
  double closed_m[kMaxContacts][3] = {};  // from the tip, device's frame, where the contacts are when closed
  double turn_xyzw[4] = {0, 0, 0, 1};     // the whole turn, about the tip: a unit quaternion, device's frame
};

struct GripState {
  double closed = 0, turned = 0;  // 0 to 1
};

// One period of the device further.
void move_grip(const Grip& grip, std::uint32_t buttons, double period_s, GripState* state);

// How far the contacts are turned about the tip: a unit quaternion, device's frame.
void grip_turn(const Grip& grip, const GripState& state, double turn_xyzw[4]);

// Where a contact is, from the tip, device's frame. open_m: where it is with no button held.
void grip_offset(const Grip& grip, const GripState& state, int contact, const double open_m[3], double offset_m[3]);

}  // namespace fdcg::dev
