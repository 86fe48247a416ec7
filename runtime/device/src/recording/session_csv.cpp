// SPDX-License-Identifier: Apache-2.0
#include "recording/session_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "recording/replayed_scene.hpp"

namespace fdcg::dev {
namespace {

constexpr const char* kStates[] = {"free", "face", "edge", "vertex"};
constexpr const char* kPhases[] = {"disarmed", "ramping", "armed", "fading"};
constexpr const char* kCsvHeader =
    "t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions,device,tick,phase,fault,sent_fx,sent_fy,sent_"
    "fz";

void append(std::string& line, double value) {
  char digits[40];
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17).ptr);
  line += ',';
}

void append(std::string& line, const double (&values)[3]) {
  for (const double value : values)
    append(line, value);
}

std::string state_columns(const fdcg_touch& touch) {
  return std::string(kStates[touch.state & 3]) + "," + std::to_string(touch.feature) + "," + std::to_string(touch.slipping) +
         ",";
}

std::string column_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '"'; }, '_');
  return name;
}

// What presses on a face or a sphere: the part of the force along its normal, the part in its plane, and the share of the
// friction cone that is left (0: it slips). Elsewhere the fields stay empty.
struct Load {
  bool is_known = false;
  double along_n = 0, across_n = 0, margin = 0;
};

Load load_of(const SessionReplay& replay, const ReplayedTick& tick, const fdcg_touch& touch) {
  Load load;
  double normal[3];
  if (!touched_normal(replay, tick, touch, normal)) return load;
  double square = 0;
  for (int i = 0; i < 3; ++i)
    load.along_n += touch.force_n[i] * normal[i];
  for (int i = 0; i < 3; ++i) {
    const double across = touch.force_n[i] - load.along_n * normal[i];
    square += across * across;
  }
  load.is_known = load.along_n > 0;
  load.across_n = std::sqrt(square);
  const double mu = replay.config().objects[touch.object.index].params.mu_static;
  load.margin = mu > 0 ? 1 - load.across_n / (mu * load.along_n) : 0;
  return load;
}

}  // namespace

std::string session_csv_header(const HostConfig& config) {
  std::string line = kCsvHeader;
  for (const ObjectConfig& object : config.objects) {
    if (object.motion.kind != MotionKind::kBody) continue;
    for (const char* const part : {"_x", "_y", "_z", "_qx", "_qy", "_qz", "_qw"})
      line += "," + column_name(object.name) + part;
  }
  for (const ObjectConfig& object : config.objects)
    if (object.motion.kind == MotionKind::kSoft) line += "," + column_name(object.name) + "_dent";
  return line + "\n";
}

// Of the touch with the largest force: god-object, state and so on.
std::string session_csv_row(const ReplayedTick& tick, std::uint64_t first_ns) {
  const LoggedOutput& output = *tick.output;
  const std::vector<ReplayedTouch> touches = touches_of(tick.state->setup);
  const auto square = [](const ReplayedTouch& touch) {
    const double* const f = touch.touch->force_n;
    return f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  };
  const auto best = std::max_element(touches.begin(), touches.end(),
                                     [&](const ReplayedTouch& a, const ReplayedTouch& b) { return square(a) < square(b); });
  const bool is_free = best == touches.end();
  std::string line;
  append(line, static_cast<double>(tick.input->now_ns - first_ns) * 1e-9);
  append(line, output.hip_world_m);
  append(line, is_free ? output.hip_world_m : best->touch->god_object_m);
  append(line, output.wanted_force_n);
  line += is_free ? "free,-1,0," : state_columns(*best->touch);
  line += std::to_string(is_free ? 0 : best->touch->transitions) + ",";
  line += std::to_string(tick.device) + "," + std::to_string(tick.tick) + "," + kPhases[output.phase & 3] + "," +
          fault_name(static_cast<Fault>(output.fault)) + ",";
  append(line, output.force_n);
  for (int i = 0; i < output.body_count; ++i) {
    append(line, output.bodies[i].translation_m);
    for (const double x : output.bodies[i].rotation_xyzw)
      append(line, x);
  }
  for (int i = 0; i < tick.state->setup.soft_count; ++i)
    append(line, tick.state->setup.soft[i]->deepest_m());
  line.back() = '\n';
  return line;
}

std::string touches_csv_header() {
  return "t,device,tick,contact,object,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,load,friction,margin\n";
}

std::string touches_csv_rows(const SessionReplay& replay, const ReplayedTick& tick, std::uint64_t first_ns) {
  const HostConfig& config = replay.config();
  std::string text;
  for (const auto& [touch, contact] : touches_of(tick.state->setup)) {
    append(text, static_cast<double>(tick.input->now_ns - first_ns) * 1e-9);
    text += std::to_string(tick.device) + "," + std::to_string(tick.tick) + "," + std::to_string(contact) + "," +
            column_name(config.objects[touch->object.index].name) + ",";
    append(text, touch->god_object_m);
    append(text, touch->force_n);
    text += state_columns(*touch);
    const Load load = load_of(replay, tick, *touch);
    if (!load.is_known) {
      text += ",,\n";
      continue;
    }
    append(text, load.along_n);
    append(text, load.across_n);
    append(text, load.margin);
    text.back() = '\n';
  }
  return text;
}

}  // namespace fdcg::dev
