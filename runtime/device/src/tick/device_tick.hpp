// SPDX-License-Identifier: Apache-2.0
// One tick of one device as a pure function of what came in: reports -> judge -> kinematics -> world -> scene step -> gate.
// The loop gathers a TickInput (every clock reading and every byte is in it), calls device_tick, hands the force to the writer
// and the record to the log. So a session is replayed bit for bit by feeding the same inputs, and every fault can be tested
// without a device. No heap, no lock, no clock.
//
// The time of bodies (fdcg/body.h) is counted in ticks: each tick with a good report advances them by one period of the device,
// whatever the clock, and without reports they do not move. So a busy computer slows them down but does not destabilise them.
//
// Devices that share a scene are ticked together by group_tick (scene_tick.hpp has the common part). Each has its own judge,
// gate and counters, as a single device has.
#pragma once

#include <cstdint>

#include "fdcg/device_status.hpp"
#include "fdcg/pile.h"
#include "profile/profile.hpp"
#include "profile/report_codec.hpp"
#include "tick/gate.hpp"
#include "tick/grip.hpp"
#include "tick/link_watch.hpp"
#include "tick/scene_effects.hpp"
#include "tick/soft.hpp"
#include "tick/stability.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

inline constexpr int kMaxDrain = 64;     // reports in one tick: what hidraw keeps
inline constexpr int kSamplesToArm = 8;  // good reports since the device was opened: by then it has taken an output that asks
                                         // for no force, which many want before the first that does
inline constexpr int kMaxDriven = 16;    // objects that something moves
inline constexpr int kMaxSoft = 4;       // objects that give way
inline constexpr int kMaxBodies = 16;    // objects that move by what acts on them
inline constexpr int kMaxDevices = 16;   // of a scene

struct RawReport {
  std::uint64_t host_ns = 0;
  std::uint16_t bytes = 0;  // as read; what is beyond kMaxReportBytes is cut off, and bytes is then kMaxReportBytes + 1
  std::uint8_t data[kMaxReportBytes] = {};
};

struct TickInput {
  std::uint64_t now_ns = 0;    // after the drain
  std::uint64_t slept_ns = 0;  // for which the computer has been suspended since it was started
  ReadStatus read = ReadStatus::kTimeout;
  bool arm = false, disarm = false;
  bool begins = false;  // the device has just been opened (again): nothing is known of its sequence and clock
  bool write_failed = false;
  std::uint64_t write_busy_ns = 0;
  SentReport sent;  // the newest output that the device has been handed
  std::uint32_t report_count = 0;
  std::uint32_t pose_count = 0;  // of driven objects, in the order of DeviceSetup::driven
  fdcg_pose poses[kMaxDriven];
  RawReport reports[kMaxDrain];  // oldest first; only the first report_count are set
};

// But for the bodies, of which most scenes have few.
struct TickTold {
  GatedForce force;
  std::uint32_t echo = 0;  // sequence of the report that the force answers
  Phase phase = Phase::kDisarmed;
  Fault fault = Fault::kNone;
  bool arming_refused = false;
  double round_trip_s = 0;       // from a write to its echo, newest; 0: not known
  double calmed = 0;             // share of the scene's force that is cut away, since it shook: 0 to 1
  double damping_n_s_per_m = 0;  // of the passivity controller
  bool is_hot = false;           // the force is cut to what the motors stand
  bool has_sample = false;
  std::uint32_t state = 0;        // of the contact with the largest force: fdcg_state
  double hip_world_m[3] = {};     // of the tip
  double wanted_force_n[3] = {};  // world, before the gate
  Sample sample;
  std::uint32_t body_count = 0;
};

struct TickOutput : TickTold {
  fdcg_pose bodies[kMaxBodies] = {};  // world, after the tick; in the order of DeviceSetup::bodies; zero beyond body_count
};

// World = R (scale * device) + offset. Forces are turned, not scaled: a stiffness of K in the world is felt as scale * K.
struct Mapping {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  double scale = 1;
  double offset_m[3] = {};
};

struct DeviceSetup {
  Profile profile;
  Mapping mapping;
  int contact_count = 1;
  double contacts_m[kMaxContacts][3] = {};  // from the tip, device's frame, not scaled
  double pads_m[kMaxContacts] = {};         // radius of each contact's pad, world; 0: a point
  double most_force_n = 0;                  // the scene's limit; 0: the profile's
  fdcg_scene* scene = nullptr;              // this device's own, or that of all devices
  bool is_shared = false;                   // the scene is that of several devices: what follows the fingers is so too
  fdcg_finger_id fingers[kMaxContacts] = {};
  int driven_count = 0;
  fdcg_object_id driven[kMaxDriven] = {};
  Grip grip;
  std::uint32_t dead_man_mask = 0;  // of the button without which there is no force; 0: none
  // Bodies: all of it in the DeviceScene's memory, which changes with every tick as the scene's does.
  fdcg_scene_body* bodies = nullptr;
  std::uint32_t body_count = 0;
  std::uint32_t substeps = 1;  // of a tick at scene_rate_hz, 1 to FDCG_BODY_MAX_SUBSTEPS
  StabilitySetup stability;    // stiffness: felt at this device
  bool has_friction = false;   // of an object
  bool is_played = false;      // a recording: it answers nothing that is sent now
  double scene_rate_hz = 0;    // of the fastest device that shares the scene; 0: this one's
  fdcg_pile* pile = nullptr;   // with the ground and all objects; null where there are no bodies
  fdcg_reaction* reactions = nullptr;
  std::uint32_t reaction_count = 0;
  int soft_count = 0;               // objects that give way, in the DeviceScene's memory too
  SceneEffects* effects = nullptr;  // in the DeviceScene's memory; null: none
  int effects_device = 0;           // which device of the scene this is
  SoftObject* soft[kMaxSoft] = {};
  fdcg_object_id soft_id[kMaxSoft] = {};
};

// The state of a device between ticks, except for the scene's memory.
struct DeviceState {
  DeviceSetup setup;
  Gate gate;
  GateInput to_gate;  // of the tick that is going on
  ReportJudge judge;
  LinkWatch link;
  Stability stability;
  double steadied_n[3] = {};  // device's frame, of the last good report: what the stage of stability has made of both forces
  EffectForce effects;        // device's frame
  TickCounters counters;
  int samples = 0;          // good reports since the device was opened, up to kSamplesToArm
  bool has_place = false;   // fingers stand where the tip was last seen
  bool has_left = false;    // is_shared: the fingers are out of the scene
  bool is_waiting = false;  // is_shared: after a fault they stay out until the device is armed again
  std::uint64_t last_good_ns = 0;
  GripState grip;
  double tip_m[3] = {};                   // device's frame, as of the last good report with a place
  double places_m[kMaxContacts][3] = {};  // of the contacts, world, in the last tick
  double moved_m[kMaxContacts][3] = {};   // where the scene was told that they are (fdcg/relief.h)
  double turn_xyzw[4] = {0, 0, 0, 1};     // and how they were turned
  // as of the last good report
  Sample sample;
  double tip_world_m[3] = {};
  double wanted_n[3] = {};  // world: of the contacts, without effects
  double effect_n[3] = {};  // world: of the effects
  std::uint32_t state = 0;
  bool rubs = false;  // a touch slides with friction
};

// setup.scene's fingers are added here. False with *error where the scene refuses them.
bool begin_device(const DeviceSetup& setup, DeviceState* device, fdcg_error* error);
void device_tick(DeviceState& device, const TickInput& input, TickOutput* output);

// One of the devices that share a scene, in the scene's order.
struct Member {
  DeviceState* device = nullptr;
  const TickInput* input = nullptr;
  TickOutput* output = nullptr;
};
// 1 to kMaxDevices devices, the same in every call; each gets a tick, with or without a report. For one device equal to
// device_tick. Returns the index of the clock device: the loop waits for its next report, and takes the queued ones of the
// others.
int group_tick(const Member* members, int count);

}  // namespace fdcg::dev
