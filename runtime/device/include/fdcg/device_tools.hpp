// SPDX-License-Identifier: Apache-2.0
// What fdcg-servo needs of the device library beyond fdcg/device.h: scenes and profiles checked, devices listed, scenes run
// with all that a status shows, logs replayed. Not installed: it may change with every version. A function that returns a text
// returns "" when all is well, otherwise one line: the file or the device, what is wrong with it, and what to do.
//
// One thread at a time is in an object of these, but for SceneRun::request_stop and, once a scene is open, SceneRun::disarm.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fdcg/device.h"
#include "fdcg/device_status.hpp"
#include "fdcg/scene.h"
#include "fdcg/session_view.hpp"

namespace fdcg::dev {

// ---- check: files ---------------------------------------------------------------------------------------------------------

struct FileCheck {
  std::string what;     // "scene: 2 objects, 1 device"
  std::string problem;  // begins with the file; empty: none
  std::vector<std::string> warnings;
  bool is_unreadable = false;  // cannot be read, or is no JSON
};
// A scene or a device profile, by the key that says which: names, values, files, and that the runtime takes the whole. Opens
// graphs and recordings, and no device.
FileCheck check_file(const std::string& path);

// ---- devices: what is plugged in --------------------------------------------------------------------------------------------

struct ProfileMatch {
  std::string name;      // as a scene would give it
  bool is_sure = false;  // false: the profile asks for a usage page that the back end does not tell
};

struct FoundDevice {
  std::string path, serial, manufacturer, product_name;
  std::uint16_t vendor = 0, product = 0, usage_page = 0, usage = 0;
  int interface_number = -1;
  std::string description;  // path, ids and names on one line
  std::vector<ProfileMatch> profiles;
  std::string problem;  // why it cannot be opened, and the remedy; empty: it can
};

struct DeviceSearch {
  std::vector<std::string> profile_files;  // beside the built-in profiles
  std::string backend;                     // "hidraw", "libusb"; empty: the first of them that is there
};
std::string find_devices(const DeviceSearch& search, std::vector<FoundDevice>* devices, std::string* backend);
// udev rules that let users open the devices of the built-in profiles and of these files.
std::string make_udev_rules(const std::vector<std::string>& profile_files, std::string* rules);
// A built-in profile as it would stand in a file.
std::string print_profile(const std::string& name, std::string* text);

// ---- calibrate: a device's axes, read without force
// ---------------------------------------------------------------------------

// What the axes were over a time.
struct AxisMeasure {
  int axis_count = 0;
  std::uint64_t reports = 0;
  double mean[3] = {}, least[3] = {}, most[3] = {};  // in counts, or the raw numbers of a line of text
  double tip_least_m[3] = {}, tip_most_m[3] = {};    // by the profile's kinematics and the scales in use
};

// One device of a scene, of HID or on a serial line. What is sent to it asks for no force.
class AxisReader {
 public:
  AxisReader();
  ~AxisReader();
  AxisReader(const AxisReader&) = delete;
  AxisReader& operator=(const AxisReader&) = delete;

  // device: its name in the scene; empty: the only one.
  std::string open(const std::string& scene_file, const std::string& device);
  [[nodiscard]] int axis_count() const;
  [[nodiscard]] const char* unit() const;  // "m" or "rad"
  [[nodiscard]] std::string profile_text() const;
  std::string measure(double seconds, AxisMeasure* measure);
  // Of an axis, for the measures that follow: value = raw * scale + bias.
  void set_scale(int axis, double scale, double bias);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The profile with these scales and offsets of its axes, as JSON. Where an axis changes its sign so does its effort. workspace:
// may be null.
struct AxisScale {
  double scale = 1, bias = 0;
};
std::string calibrated_profile(const std::string& profile_text, const std::vector<AxisScale>& axes,
                               const AxisMeasure* workspace, std::string* json);

// ---- run: a scene -----------------------------------------------------------------------------------------------------------

// One device at one moment.
struct DeviceLook {
  std::string name;
  bool is_recorded = false;  // it plays a log
  bool takes_output = false;
  bool is_open = false;
  bool is_over = false;  // a recording that has ended
  std::string problem;   // why it is not open; empty: it is open, or no attempt was made yet
  Phase phase = Phase::kDisarmed;
  Fault fault = Fault::kNone;
  std::uint32_t state = 0;                       // fdcg_state, of the contact with the largest force
  double tip_m[3] = {}, wanted_force_n[3] = {};  // world; the force before the gate
  double force_n[3] = {};                        // device's frame, as it was sent
  std::vector<fdcg_pose> bodies;                 // world
  double calmed = 0, damping_n_s_per_m = 0;      // by the stage of stability: share of the force cut away; damping added
  bool is_hot = false;                           // the force is cut to what the motors stand
  TickCounters counters;
  std::uint64_t opened = 0, writes = 0, write_failures = 0, log_dropped = 0;
  double elapsed_s = 0;
  TimeHistogram interval, work, write, round_trip;
  double rate_hz = 0;         // the caller's to fill in
  double stated_rate_hz = 0;  // the profile's
};

// A scene file, and what the command line changes of it.
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  std::string read(const std::string& path, std::vector<std::string>* warnings);
  void set_log_file(const std::string& path);    // empty: no log
  void set_backend(const std::string& backend);  // "hidraw", "libusb"
  [[nodiscard]] const std::string& log_file() const;
  [[nodiscard]] bool has_simulated_device() const;  // which never ends by itself

 private:
  friend class SceneRun;
  friend struct FastSceneRun;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Devices in real time.
class SceneRun {
 public:
  SceneRun();
  ~SceneRun();  // stops
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;

  std::string open(Scene scene);  // graphs opened and verified; no thread yet
  void allow_plugins();           // the scene's plugins may be loaded: they are code
  std::string start();            // threads run; devices are opened as they appear
  // What the system did not grant (real-time priority, locked memory, a cpu): worse timing, nothing more.
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  [[nodiscard]] int device_count() const;
  void arm(int device);         // a request: the safety gate decides. kAllDevices: each
  void disarm(int device);      // async-signal-safe
  DeviceLook look(int device);  // some 20 ms old at most
  // Before start: so many ticks of each device are kept for take_snapshots; 0: none.
  void keep_snapshots(std::size_t ticks);
  std::size_t take_snapshots(int device, fdcg_snapshot* snapshots, std::size_t most);
  [[nodiscard]] std::uint64_t dropped_snapshots(int device) const;
  // In the order in which snapshots number them.
  [[nodiscard]] std::vector<std::string> object_names() const;
  [[nodiscard]] std::vector<std::string> body_names() const;
  [[nodiscard]] std::string log_failure() const;
  void request_stop() noexcept;  // async-signal-safe
  [[nodiscard]] bool is_stopping() const noexcept;
  bool wait_ms(int milliseconds);  // true as soon as a stop is requested or every device is over
  std::string stop();              // zero force, devices closed, log written; within 6 s

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What is called when a signal ends the process and every device has its zero: async-signal-safe. Null: nothing.
void set_last_act(void (*act)());

// Simulated and recorded devices without waiting, each on a clock of its own.
struct FastSceneRun {
  double for_s = 0;  // of the devices' time; 0: until every recording has ended
  bool arm = false;
  std::function<bool()> is_stopping;  // asked every 1,000 ticks
  // After run(): each device at its end, and whether the text that run gave is about a file (the scene's, the log).
  std::vector<DeviceLook> looks;
  bool has_failed_file = false;
  std::string run(Scene scene);
};

// ---- replay: effects of a graph's contact
// ---------------------------------------------------------------------------------------------

// Effects of a material (fdcg/effect.h) on one contact of a graph, by the keys that an object of a scene has for them, and to
// the bit as there for an object in the world's frame.
class GraphEffects {
 public:
  GraphEffects();
  ~GraphEffects();
  GraphEffects(const GraphEffects&) = delete;
  GraphEffects& operator=(const GraphEffects&) = delete;

  // "viscosity,viscosity_n_s_per_m=2,when=slipping", or the JSON that stands in a scene. Files are named from the current
  // folder. Empty: fine. Otherwise the key, what was found and what is expected.
  std::string add(const std::string& text);
  [[nodiscard]] bool is_empty() const;
  // With the graph's materials, for ticks of this length. Empty: fine.
  std::string open(const fdcg_graph& graph, double tick_s);
  // Adds their forces to `force_n`, which is what the hand feels so far (a relief may have turned it). `felt`: of the step.
  void feel(const fdcg_graph& graph, const fdcg_result& felt, const double hip_m[3], double force_n[3]);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- replay: the log of a session
// ---------------------------------------------------------------------------------------------

bool is_session_log(const std::string& path);  // false where it cannot be read

// Every recorded input through the same code again, every output compared bit for bit.
class LogReplay {
 public:
  LogReplay();
  ~LogReplay();
  LogReplay(const LogReplay&) = delete;
  LogReplay& operator=(const LogReplay&) = delete;

  // graph_folder: where the graphs are now; empty: where they were, or beside the log.
  std::string open(const std::string& path, const std::string& graph_folder);
  bool next();                            // the next tick; false: the log has ended
  [[nodiscard]] double fraction() const;  // of the log's bytes that was read, 0 to 1

  // The tick as rows of CSV (schemas/session-log.md), with line ends; "" where it has no good report.
  [[nodiscard]] std::string csv_header() const;
  [[nodiscard]] std::string csv_row() const;
  [[nodiscard]] std::string touches_header() const;
  [[nodiscard]] std::string touches_rows() const;
  // The same to be looked at. A tick without a good report has a view too: the scene may move on.
  [[nodiscard]] ViewedScene scene() const;
  [[nodiscard]] ViewedTick view() const;
  // The log anew: its header, the record of the tick, its end ("" where it has none).
  [[nodiscard]] std::string header_bytes() const;
  [[nodiscard]] std::string record_bytes() const;
  [[nodiscard]] std::string end_bytes() const;

  [[nodiscard]] const std::vector<DeviceReplay>& devices() const;
  [[nodiscard]] bool is_same() const;         // every tick was there and the same, and the log was closed in order
  [[nodiscard]] bool has_strays() const;      // ticks of devices that the scene has not
  [[nodiscard]] bool ends_at_limit() const;   // of its bytes; the session went on
  [[nodiscard]] std::string damage() const;   // of a log that was not closed; with the byte
  [[nodiscard]] std::string program() const;  // the version that wrote it
  // Names of the scene's objects that have a graph, and the graphs' files.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> graph_files() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fdcg::dev
