// SPDX-License-Identifier: Apache-2.0
#include "status_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../common/terminal.hpp"

namespace fdcg::servo {
namespace {

using Json = nlohmann::ordered_json;
using tools::grouped;

constexpr const char* kPhases[] = {"disarmed", "ramping", "armed", "fading"};
constexpr const char* kStates[] = {"free", "face", "edge", "vertex"};
constexpr const char* kVerdictNames[] = {"good",       "length",   "id",           "crc",  "constant",
                                         "not-finite", "repeated", "out-of-order", "stale"};
static_assert(std::size(kVerdictNames) == dev::kVerdicts);

double norm(const double* x) {
  return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

const char* phase_name(dev::Phase phase) {
  return kPhases[static_cast<int>(phase)];
}

// NaN and infinities become null.
Json vector_json(const double* x) {
  Json json = Json::array();
  for (int i = 0; i < 3; ++i)
    json.push_back(std::isfinite(x[i]) ? Json(x[i]) : Json());
  return json;
}

Json device_json(const DeviceLook& look) {
  const dev::TickCounters& counters = look.counters;
  Json json;
  json["name"] = look.name;
  json["connection"] = look.is_open ? "open" : "absent";
  if (!look.problem.empty()) json["problem"] = look.problem;
  if (look.is_over) json["ended"] = true;
  json["opened"] = look.opened;
  json["phase"] = phase_name(look.phase);
  json["fault"] = dev::fault_name(look.fault);
  json["rate_hz"] = look.rate_hz;
  json["contact"] = state_name(look.state);
  json["tip_m"] = vector_json(look.tip_m);
  json["wanted_force_n"] = vector_json(look.wanted_force_n);
  json["force_n"] = vector_json(look.force_n);
  for (const fdcg_pose& body : look.bodies)
    json["bodies_m"].push_back(vector_json(body.translation_m));
  if (counters.bodies_lost != 0) json["bodies_lost"] = true;
  json["calmed"] = look.calmed;
  json["damping_n_s_per_m"] = look.damping_n_s_per_m;
  json["hot"] = look.is_hot;
  json["ticks"] = counters.ticks;
  json["late"] = counters.late;
  json["lost"] = counters.lost;
  json["superseded"] = counters.superseded;
  json["timeouts"] = counters.timeouts;
  json["rejected"] = Json::object();
  for (int i = 1; i < dev::kVerdicts; ++i)
    json["rejected"][kVerdictNames[i]] = counters.rejected[i];
  json["disarmed"] = Json::object();
  for (int i = 1; i < dev::kFaults; ++i)
    if (counters.disarmed[i] != 0) json["disarmed"][dev::fault_name(static_cast<dev::Fault>(i))] = counters.disarmed[i];
  json["writes"] = look.writes;
  json["write_failures"] = look.write_failures;
  json["log_dropped"] = look.log_dropped;
  json["interval_us"] = times_json(look.interval);
  json["work_us"] = times_json(look.work);
  json["write_us"] = times_json(look.write);
  json["round_trip_us"] = times_json(look.round_trip);
  return json;
}

std::string microseconds(std::uint64_t ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", static_cast<double>(ns) * 1e-3);
  return text;
}

// "; 3 rejected (2 crc, 1 stale)"
std::string rejected_text(const dev::TickCounters& counters) {
  const std::uint64_t total = rejected_in_all(counters);
  std::string text = ", " + grouped(total) + " rejected";
  const char* before = " (";
  for (int i = 1; i < dev::kVerdicts; ++i) {
    if (counters.rejected[i] == 0) continue;
    text += before + grouped(counters.rejected[i]) + " " + kVerdictNames[i];
    before = ", ";
  }
  return total == 0 ? text : text + ")";
}

// The end of a recording disarms like an unplugged device, and is not counted here.
std::string disarmed_text(const dev::TickCounters& counters, bool is_over) {
  std::string text;
  for (int i = 1; i < dev::kFaults; ++i) {
    if (counters.disarmed[i] == 0 || (is_over && static_cast<dev::Fault>(i) == dev::Fault::kReadFailed)) continue;
    text += (text.empty() ? "" : ", ") + std::string(dev::fault_name(static_cast<dev::Fault>(i)));
    if (counters.disarmed[i] > 1) text += " " + grouped(counters.disarmed[i]) + " times";
  }
  return text.empty() ? "never" : text;
}

}  // namespace

nlohmann::ordered_json times_json(const dev::TimeHistogram& histogram) {
  constexpr double kMicro = 1e-3;
  Json json;
  json["count"] = histogram.total;
  json["p50"] = static_cast<double>(histogram.quantile(0.5)) * kMicro;
  json["p99"] = static_cast<double>(histogram.quantile(0.99)) * kMicro;
  json["p99.9"] = static_cast<double>(histogram.quantile(0.999)) * kMicro;
  json["max"] = static_cast<double>(histogram.largest_ns) * kMicro;
  return json;
}

std::string times_text(const dev::TimeHistogram& histogram) {
  if (histogram.total == 0) return "-\n";
  return "p50 " + microseconds(histogram.quantile(0.5)) + ", p99 " + microseconds(histogram.quantile(0.99)) + ", p99.9 " +
         microseconds(histogram.quantile(0.999)) + ", max " + microseconds(histogram.largest_ns) + " us\n";
}

bool is_trouble(dev::Fault fault) {
  return fault != dev::Fault::kNone && fault != dev::Fault::kCommanded;
}

std::uint64_t rejected_in_all(const dev::TickCounters& counters) {
  std::uint64_t total = 0;
  for (int i = 1; i < dev::kVerdicts; ++i)
    total += counters.rejected[i];
  return total;
}

const char* state_name(std::uint32_t state) {
  return kStates[std::min<std::uint32_t>(state, FDCG_VERTEX)];
}

std::string status_line(const DeviceLook& look, std::size_t name_width) {
  std::string line = look.name + std::string(name_width - std::min(name_width, look.name.size()) + 2, ' ');
  if (!look.is_open) {
    return line + "absent" + (look.problem.empty() ? "" : ": " + look.problem);
  }
  std::string phase = phase_name(look.phase);
  if (look.phase == dev::Phase::kDisarmed && is_trouble(look.fault)) {
    phase += std::string(" (") + dev::fault_name(look.fault) + ")";
  }
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, "%-10s %6.0f/s  %-6s %6.2f N  lost %s, rejected %s, late %s", phase.c_str(),
                look.rate_hz, state_name(look.state), norm(look.force_n), grouped(look.counters.lost).c_str(),
                grouped(rejected_in_all(look.counters)).c_str(), grouped(look.counters.late).c_str());
  line += numbers;
  if (look.log_dropped != 0) line += ", not logged " + grouped(look.log_dropped);
  return line;
}

std::string status_json(const char* event, double seconds, const std::vector<DeviceLook>& looks,
                        const std::string& log_failure) {
  Json json;
  json["event"] = event;
  json["time_s"] = seconds;
  json["devices"] = Json::array();
  for (const DeviceLook& look : looks)
    json["devices"].push_back(device_json(look));
  if (!log_failure.empty()) json["log_failure"] = log_failure;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string summary_text(const std::vector<DeviceLook>& looks) {
  std::string text;
  for (const DeviceLook& look : looks) {
    const dev::TickCounters& counters = look.counters;
    text += look.name + "\n";
    if (look.opened == 0) {
      text += "  never there" + (look.problem.empty() ? "" : ": " + look.problem) + "\n";
      continue;
    }
    text += "  reports        " + grouped(counters.ticks) + " answered, " + grouped(counters.superseded) + " superseded, " +
            grouped(counters.lost) + " lost" + rejected_text(counters) + "\n";
    text += "  late           " + grouped(counters.late) + "; opened " + grouped(look.opened) +
            (look.opened == 1 ? " time\n" : " times\n");
    text += "  interval       " + times_text(look.interval);
    text += "  work           " + times_text(look.work);
    text += "  write          " + times_text(look.write);
    if (look.round_trip.total != 0) text += "  round trip     " + times_text(look.round_trip);
    if (look.write_failures != 0) text += "  writes failed  " + grouped(look.write_failures) + "\n";
    if (look.log_dropped != 0) text += "  not logged     " + grouped(look.log_dropped) + " ticks\n";
    if (counters.bodies_lost != 0) text += "  bodies         lost: one flew beyond all bounds, and all stand still since\n";
    text += "  disarmed       " + disarmed_text(counters, look.is_over) + "\n";
    if (look.is_over) text += "  ended          the recording has ended\n";
  }
  return text;
}

}  // namespace fdcg::servo
