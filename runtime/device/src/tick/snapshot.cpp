// SPDX-License-Identifier: Apache-2.0
#include "tick/snapshot.hpp"

#include <algorithm>

#include "base/rotation.hpp"

namespace fdcg::dev {

static_assert(FDCG_SNAPSHOT_CONTACTS == kMaxContacts && FDCG_SNAPSHOT_BODIES == kMaxBodies);

namespace {

// Of what the contact touches, that which pushes most.
void take_contact(const fdcg_finger_result& finger, fdcg_snapshot_contact* to) {
  std::copy_n(finger.force_n, 3, to->force_n);
  double most = -1;
  for (std::uint32_t i = 0; i < finger.touch_count; ++i) {
    const fdcg_touch& touch = finger.touches[i];
    const double square = dot(touch.force_n, touch.force_n);
    if (touch.state == FDCG_FREE || square <= most) continue;
    most = square;
    to->state = touch.state;
    to->is_slipping = touch.slipping;
    to->object = static_cast<std::int32_t>(touch.object.index);
    to->feature = touch.feature;
    std::copy_n(touch.god_object_m, 3, to->god_object_m);
  }
}

}  // namespace

void take_snapshot(const DeviceState& device, const TickOutput& output, std::uint64_t tick, double seconds, fdcg_snapshot* to) {
  to->tick = tick;
  to->time_s = seconds;
  to->phase = static_cast<std::uint32_t>(output.phase);
  to->fault = static_cast<std::uint32_t>(output.fault);
  to->buttons = device.sample.buttons;
  to->has_report = output.has_sample;
  std::copy_n(output.hip_world_m, 3, to->tip_world_m);
  std::copy_n(output.wanted_force_n, 3, to->wanted_force_n);
  std::copy_n(output.force.force_n(), 3, to->force_n);
  to->given_j = device.stability.given_j();
  to->round_trip_s = output.round_trip_s;
  to->contact_count = static_cast<std::uint32_t>(device.setup.contact_count);
  for (int i = 0; i < device.setup.contact_count; ++i) {
    fdcg_finger_result finger;
    const bool is_there = fdcg_scene_get_result(device.setup.scene, device.setup.fingers[i], &finger, nullptr) == FDCG_OK;
    fdcg_snapshot_contact& contact = to->contacts[i];
    contact = {};
    contact.object = -1;
    std::copy_n(device.places_m[i], 3, contact.hip_m);
    std::copy_n(device.places_m[i], 3, contact.god_object_m);
    if (is_there) take_contact(finger, &contact);
  }
  to->body_count = output.body_count;
  std::copy_n(output.bodies, output.body_count, to->bodies);
}

}  // namespace fdcg::dev
