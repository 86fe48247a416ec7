// SPDX-License-Identifier: Apache-2.0
#include "profile/profile_json.hpp"

#include <algorithm>
#include <cstring>

#include "base/json_reader.hpp"
#include "base/words.hpp"
#include "profile/profile_kinematics.hpp"
#include "profile/profile_reports.hpp"

namespace fdcg::dev {
namespace {

// Bounds that no device for a hand comes near: what is beyond them is a slip of the unit.
constexpr NumberRange kForce{0, 1000, false, "N"};
constexpr NumberRange kEffort{0, 1000, false, "N or N m"};
constexpr NumberRange kSlew{0, 1e8, false, "N/s"};
constexpr NumberRange kVelocity{0, 1000, false, "m/s"};
constexpr NumberRange kPlace{-100, 100, true, "m"};
constexpr NumberRange kWatchdog{0, 10, true, "s"};
constexpr NumberRange kRate{1, 100000, true, "Hz"};
constexpr std::size_t kLongestText = 1000;

constexpr Keys kReportKeys{"report_id", "bytes", "fields", "crc"};

void read_match(const JsonObject& json, Match* match) {
  match->vendor = static_cast<std::uint16_t>(json.id("vendor_id", 0xFFFF));
  match->product = static_cast<std::uint16_t>(json.id("product_id", 0xFFFF));
  if (match->vendor == 0) json.fail("vendor_id", "is 0; no maker has that: look for it with lsusb");
  if (json.has("usage_page")) match->usage_page = static_cast<std::int32_t>(json.id("usage_page", 0xFFFF));
  if (json.has("usage")) match->usage = static_cast<std::int32_t>(json.id("usage", 0xFFFF));
  match->interface_number = static_cast<std::int32_t>(json.integer_or("interface", -1, 0, 255));
}

void read_fixed(const JsonObject& json, const char* key, FixedReport* reports, int* count) {
  if (!json.has(key)) return;
  for (const JsonObject& report : json.objects(key, 0, kMaxFixedReports, {"kind", "hex"})) {
    FixedReport& fixed = reports[(*count)++];
    fixed.is_feature = report.choice("kind", {"output", "feature"}) == 1;
    const std::vector<std::uint8_t> bytes = report.hex("hex", 1, kMaxReportBytes);
    fixed.bytes = static_cast<std::uint16_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), fixed.data);
  }
}

void read_workspace(const JsonObject& json, DeviceLimits* limits) {
  json.numbers("min", limits->workspace_min_m, 3, kPlace);
  json.numbers("max", limits->workspace_max_m, 3, kPlace);
  for (int i = 0; i < 3; ++i) {
    if (!(limits->workspace_min_m[i] < limits->workspace_max_m[i]))
      json.fail("min", "[" + std::to_string(i) + "] is " + shown_number(limits->workspace_min_m[i]) +
                           "; it must be below max[" + std::to_string(i) + "], " + shown_number(limits->workspace_max_m[i]));
  }
}

void read_limits(const JsonObject& json, int axis_count, DeviceLimits* limits) {
  if (json.has("force_n")) limits->force_n = json.number("force_n", kForce);
  if (json.has("effort")) json.numbers("effort", limits->effort, axis_count, kEffort);
  if (json.has("slew_n_per_s")) limits->slew_n_per_s = json.number("slew_n_per_s", kSlew);
  if (json.has("velocity_m_per_s")) limits->velocity_m_per_s = json.number("velocity_m_per_s", kVelocity);
  if (json.has("workspace_m")) read_workspace(json.object("workspace_m", {"min", "max"}), limits);
  limits->device_watchdog_s = json.number_or("device_watchdog_s", 0, kWatchdog);
}

// What is not known, for a device that could push, and what it is too slow for.
void warn(const JsonObject* json, double rate_hz, const std::string& file_name, std::vector<std::string>* warnings) {
  if (const std::string warning = rate_warning(rate_hz); !warning.empty())
    warnings->push_back(one_line(file_name + ": " + warning));
  for (const char* key : {"force_n", "effort", "slew_n_per_s", "velocity_m_per_s", "workspace_m"}) {
    if (json == nullptr || !json->has(key))
      warnings->push_back(one_line(file_name + ": limits." + key +
                                   " is not known: the device is read but gives no force; measure it, or ask its maker"));
  }
  if (json == nullptr || !json->has("device_watchdog_s"))
    warnings->push_back(one_line(file_name +
                                 ": limits.device_watchdog_s is not known and taken as none: forces stay low, since "
                                 "nothing would stop the device when the host dies"));
}

void read_profile(const JsonObject& json, const std::string& file_name, Profile* profile, std::vector<std::string>* warnings) {
  json.integer("fdcg_profile", 1, 1);
  const std::string name = json.text("name", kProfileNameBytes - 1);
  std::memcpy(profile->name, name.data(), name.size());
  json.text_or("source", "", kLongestText);
  if (json.has("notes")) json.texts("notes", 0, 100, kLongestText);
  read_match(json.object("match", {"vendor_id", "product_id", "usage_page", "usage", "interface"}), &profile->match);
  profile->rate_hz = json.number("rate_hz", kRate);
  read_kinematics(json.object("kinematics", kKinematicsKeys), &profile->kinematics);
  const KinematicsKind kind = profile->kinematics.kind;
  read_input(json.object("input", kReportKeys), kind, &profile->input, &profile->axis_count);
  check_axis_count(json, kind, profile->axis_count);
  profile->has_output = json.has("output");
  if (profile->has_output) read_output(json.object("output", kReportKeys), kind, profile->axis_count, &profile->output);
  read_fixed(json, "init", profile->init, &profile->init_count);
  read_fixed(json, "safe_stop", profile->safe_stop, &profile->safe_stop_count);
  if (json.has("limits")) {
    const JsonObject limits =
        json.object("limits", {"force_n", "effort", "slew_n_per_s", "velocity_m_per_s", "workspace_m", "device_watchdog_s"});
    read_limits(limits, profile->axis_count, &profile->limits);
    if (warnings != nullptr && profile->has_output) warn(&limits, profile->rate_hz, file_name, warnings);
  } else if (warnings != nullptr && profile->has_output) {
    warn(nullptr, profile->rate_hz, file_name, warnings);
  }
}

}  // namespace

std::string rate_warning(double rate_hz) {
  constexpr double kLeastRate = 1 / kSilenceS;  // at it each report comes as the last one's time is over
  if (!(rate_hz <= kLeastRate)) return {};
  return "rate_hz is " + shown_number(rate_hz) + ", a report every " + shown_number(1000 / rate_hz) +
         " ms, and the gate disarms after " + shown_number(1000 * kSilenceS) +
         " ms without one: it will not stay armed, so there is no force; above " + shown_number(kLeastRate) +
         " Hz it does, and above " + shown_number(2 * kLeastRate) + " also where a report is lost";
}

std::string parse_profile(std::string_view text, const std::string& file_name, Profile* profile,
                          std::vector<std::string>* warnings) {
  *profile = {};
  JsonFile file(file_name);
  const JsonObject json = file.parse(text, {"$schema", "fdcg_profile", "name", "source", "notes", "match", "rate_hz", "input",
                                            "output", "init", "safe_stop", "kinematics", "limits"});
  read_profile(json, file_name, profile, warnings);
  return file.error();
}

}  // namespace fdcg::dev
