// SPDX-License-Identifier: Apache-2.0
// The content of a scene file (scene_json.hpp fills it), checked, with the full path of every file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fdcg/effect.h"
#include "fdcg/fdcg.h"
#include "fdcg/heights.h"
#include "fdcg/relief.h"
#include "fdcg/surface.h"
#include "tick/device_tick.hpp"
#include "tick/soft.hpp"
#include "transport/transports.hpp"

namespace fdcg::dev {

// kDriven: by the caller, fdcg_host_set_pose. kBody: by forces (fdcg/body.h).
// kSoft: fixed and deformable (soft.hpp).
enum class MotionKind { kFixed, kSpin, kSwing, kDriven, kBody, kSoft };

// Of kBody. Weighed by the first of mass and density that is above 0, or by the graph's file.
struct BodyConfig {
  double mass_kg = 0, density_kg_per_m3 = 0;
  double linear_damping_per_s = 0, angular_damping_per_s = 0;
  int points = 20;  // with which it touches the ground and other objects, 1 to 256
};

// Of an object, as a function of the time since the host started.
struct Motion {
  MotionKind kind = MotionKind::kFixed;
  double axis[3] = {0, 0, 1};  // unit: of the spin, or the direction of the swing
  double rate_hz = 0;          // turns or swings a second
  double amplitude_m = 0;      // of the swing
  BodyConfig body;
  SoftConfig soft;
};
// Its pose is part of a tick's input.
inline bool is_moved(const Motion& motion) {
  return motion.kind == MotionKind::kSpin || motion.kind == MotionKind::kSwing || motion.kind == MotionKind::kDriven;
}

// A recorded texture (fdcg_texture), as its file has it.
struct TextureConfig {
  double rate_hz = 0;
  std::vector<double> speed_m_per_s, force_n;  // ascending
  struct Model {
    std::vector<double> coefficients;
    double variance = 0;
  };
  std::vector<Model> models;  // [speed][force], all of one order
};

// An effect of an object, or of the scene.
struct EffectConfig {
  fdcg_effect effect{};  // its material and texture are set by the scene that is built
  std::string material;  // by name; empty: all
  std::optional<TextureConfig> texture;
};

// Heights on an object's surface (fdcg/relief.h).
enum class ReliefKind { kRidges, kBumps, kGrain, kImage };
struct ReliefConfig {
  ReliefKind kind = ReliefKind::kRidges;
  double amplitude_m = 0, wavelength_m = 0;                       // ridges and bumps
  double direction[3] = {1, 0, 0};                                // of ridges, unit
  double rms_m = 0, shortest_m = 0, longest_m = 0, exponent = 1;  // grain
  std::uint32_t seed = 0;
  std::string material;       // by name; empty: all
  fdcg_relief relief{};       // its limits; law, data and material are set by the scene that is built
  fdcg_waves waves() const {  // but of kImage: its heights are in the object's file
    if (kind == ReliefKind::kRidges) return fdcg_make_ridges(amplitude_m, wavelength_m, direction);
    if (kind == ReliefKind::kBumps) return fdcg_make_bumps(amplitude_m, wavelength_m);
    return fdcg_make_grain(rms_m, shortest_m, longest_m, exponent, seed);
  }
};

struct ObjectConfig {
  std::string name, file;  // file: empty where it is a surface
  bool is_surface = false;
  fdcg_surface surface{};  // is_surface
  fdcg_pose pose;
  fdcg_params params;  // tick_s is set from each device's rate
  Motion motion;
  std::vector<EffectConfig> effects;
  std::optional<ReliefConfig> relief;
};

// The ground: solid where normal . x < offset_m, world.
struct GroundConfig {
  bool is_there = false;
  double normal[3] = {0, 0, 1};  // unit
  double offset_m = 0;
  fdcg_params params = fdcg_make_params();
};

enum class DeviceSource { kHid, kSimulated, kRecorded, kPlugin, kSerial };

struct DeviceConfig {
  std::string name;
  DeviceSource source = DeviceSource::kHid;
  Profile profile;
  std::string profile_text;               // its JSON, for the log
  std::string serial, path;               // of the HID device; empty: the first that matches
  std::string plugin, plugin_settings;    // kPlugin: its file, empty where the program hands it over; JSON
  std::string limits_text;                // kPlugin: its limits as JSON, for the log
  SerialAccess serial_access;             // kSerial
  std::string recording;                  // kRecorded: a session's log
  bool is_recording_in_real_time = true;  // false: as fast as it is read (FastRun)
  SimulationConfig simulation;            // kSimulated
  Mapping mapping;
  int contact_count = 1;
  double contacts_m[kMaxContacts][3] = {};
  double pads_m[kMaxContacts] = {};  // radius of each contact's pad; 0: a point
  Grip grip;
  std::uint32_t dead_man_mask = 0;  // of the button without which there is no force; 0: none
  double most_force_n = 0;
};

struct LoopConfig {
  int servo_priority = 80, writer_priority = 70;  // SCHED_FIFO; 0: ordinary scheduling
  int cpu = -1;                                   // -1: any
  bool lock_memory = true;
  HidBackend backend = HidBackend::kAny;
  bool maps_graphs = false;  // false: a copy in memory of our own, which nobody can change once it is verified
};

// Parts of the stage of stability (stability.hpp).
struct StabilityConfig {
  bool has_passivity = true;  // where nothing in the scene moves by itself; else what it gives is not the springs'
  bool has_calming = true;
};

struct HostConfig {
  std::string scene_file, scene_text;
  std::vector<ObjectConfig> objects;
  std::vector<DeviceConfig> devices;
  std::vector<EffectConfig> effects;  // of the world
  bool is_shared = false;  // all devices feel one scene, in one loop; else each has its own, and there may be no body
  double gravity_m_per_s2[3] = {0, 0, -9.80665};
  GroundConfig ground;
  LoopConfig loop;
  StabilityConfig stability;
  std::string log_file;      // empty: none
  double log_megabytes = 0;  // the log ends there; 0: no limit
};

}  // namespace fdcg::dev
