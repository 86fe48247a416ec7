// SPDX-License-Identifier: Apache-2.0
#include "recording/viewed_session.hpp"

#include <algorithm>

#include "base/rotation.hpp"
#include "recording/replayed_scene.hpp"

namespace fdcg::dev {
namespace {

ViewedMotion viewed_motion(MotionKind kind) {
  switch (kind) {
    case MotionKind::kFixed:
      return ViewedMotion::kFixed;
    case MotionKind::kBody:
      return ViewedMotion::kBody;
    case MotionKind::kSoft:
      return ViewedMotion::kSoft;
    case MotionKind::kSpin:
    case MotionKind::kSwing:
    case MotionKind::kDriven:
      break;
  }
  return ViewedMotion::kMoved;
}

void copy(const double (&from)[3], double (&to)[3]) {
  std::copy(from, from + 3, to);
}

// Where each contact is, and what it touches: of several things that which pushes most.
std::vector<ViewedContact> viewed_contacts(const SessionReplay& replay, const ReplayedTick& tick) {
  const DeviceState& state = *tick.state;
  std::vector<ViewedContact> contacts(static_cast<std::size_t>(state.setup.contact_count));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    copy(state.places_m[i], contacts[i].hip_m);
    copy(state.places_m[i], contacts[i].god_object_m);
  }
  for (const auto& [touch, index] : touches_of(state.setup)) {
    ViewedContact& contact = contacts[static_cast<std::size_t>(index)];
    if (contact.state != FDCG_FREE && dot(contact.force_n, contact.force_n) >= dot(touch->force_n, touch->force_n)) continue;
    copy(touch->god_object_m, contact.god_object_m);
    copy(touch->force_n, contact.force_n);
    contact.state = touch->state;
    contact.slipping = touch->slipping;
    contact.object = touch->object.index;
    const double none[3] = {};
    if (!touched_normal(replay, tick, *touch, contact.normal)) copy(none, contact.normal);
  }
  return contacts;
}

}  // namespace

ViewedScene viewed_scene(const HostConfig& config) {
  ViewedScene scene;
  for (const ObjectConfig& from : config.objects) {
    ViewedObject object{from.name,    from.is_surface ? std::string() : from.file,
                        from.surface, viewed_motion(from.motion.kind),
                        from.pose,    from.params.mu_static};
    scene.objects.push_back(std::move(object));
  }
  for (const DeviceRange& range : device_ranges(config)) {
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      const DeviceConfig& from = config.devices[i];
      scene.devices.push_back({from.name, scene.world_count, {from.pads_m, from.pads_m + from.contact_count}});
    }
    ++scene.world_count;
  }
  copy(config.gravity_m_per_s2, scene.gravity_m_per_s2);
  scene.has_ground = config.ground.is_there;
  copy(config.ground.normal, scene.ground_normal);
  scene.ground_offset_m = config.ground.offset_m;
  return scene;
}

ViewedTick viewed_tick(const SessionReplay& replay, const ReplayedTick& tick, std::uint64_t first_ns) {
  const HostConfig& config = replay.config();
  ViewedTick view;
  view.device = tick.device;
  view.tick = tick.tick;
  view.t_s = static_cast<double>(tick.input->now_ns - first_ns) * 1e-9;
  view.phase = tick.output->phase;
  view.fault = tick.output->fault;
  copy(tick.output->wanted_force_n, view.wanted_force_n);
  copy(tick.output->force_n, view.sent_force_n);
  view.contacts = viewed_contacts(replay, tick);
  const DeviceSetup& setup = tick.state->setup;
  int soft = 0;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    view.poses.push_back(tick_pose(config, tick, i));
    view.poses.back().scale = config.objects[i].pose.scale;  // a log's bodies have none
    if (config.objects[i].motion.kind != MotionKind::kSoft || soft == setup.soft_count) continue;
    view.soft.push_back({i, replay.graph(i).header->corner_count, setup.soft[soft++]->displacements_m()});
  }
  return view;
}

}  // namespace fdcg::dev
