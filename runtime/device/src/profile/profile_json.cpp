// SPDX-License-Identifier: Apache-2.0
#include "profile/profile_json.hpp"

#include <algorithm>
#include <cstring>

#include "profile/profile_kinematics.hpp"
#include "profile/profile_reports.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::dev {
namespace {

// Bounds far beyond any device for a hand: a value outside them has a wrong unit.
constexpr json::NumberRange kForce{0, 1000, false, "N"};
constexpr json::NumberRange kEffort{0, 1000, false, "N or N m"};
constexpr json::NumberRange kSlew{0, 1e8, false, "N/s"};
constexpr json::NumberRange kVelocity{0, 1000, false, "m/s"};
constexpr json::NumberRange kPlace{-100, 100, true, "m"};
constexpr json::NumberRange kHeat{0.01, 10000, true, "s"};
constexpr json::NumberRange kDamping{0, 1000, true, "N s/m"};
constexpr json::NumberRange kStiffness{0, 1e7, false, "N/m"};
constexpr double kUsualHeatS = 5;  // of small motors
constexpr json::NumberRange kWatchdog{0, 10, true, "s"};
constexpr json::NumberRange kRate{1, 100000, true, "Hz"};
constexpr std::size_t kLongestText = 1000;

constexpr json::Keys kReportKeys{"format", "columns", "separator", "report_id", "bytes", "fields", "crc"};

void read_match(const json::Value& json, Match* match) {
  match->vendor = static_cast<std::uint16_t>(json["vendor_id"].id(0xFFFF));
  match->product = static_cast<std::uint16_t>(json["product_id"].id(0xFFFF));
  if (match->vendor == 0) json["vendor_id"].fail("is 0; no maker has that: look for it with lsusb");
  if (json["usage_page"]) match->usage_page = static_cast<std::int32_t>(json["usage_page"].id(0xFFFF));
  if (json["usage"]) match->usage = static_cast<std::int32_t>(json["usage"].id(0xFFFF));
  match->interface_number = static_cast<std::int32_t>(json["interface"].integer_or(-1, 0, 255));
}

void read_fixed(const json::Value& json, const char* key, FixedReport* reports, int* count) {
  if (!json[key]) return;
  for (const json::Value& report : json[key].objects(0, kMaxFixedReports, {"kind", "hex"})) {
    FixedReport& fixed = reports[(*count)++];
    fixed.is_feature = report["kind"].choice({"output", "feature"}) == 1;
    const std::vector<std::uint8_t> bytes = report["hex"].hex(1, kMaxReportBytes);
    fixed.bytes = static_cast<std::uint16_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), fixed.data);
  }
}

void read_workspace(const json::Value& json, DeviceLimits* limits) {
  const json::Value min = json["min"];
  min.numbers(limits->workspace_min_m, 3, kPlace);
  json["max"].numbers(limits->workspace_max_m, 3, kPlace);
  for (int i = 0; i < 3; ++i) {
    if (!(limits->workspace_min_m[i] < limits->workspace_max_m[i]))
      min.item(static_cast<std::size_t>(i))
          .must_be("below max[" + std::to_string(i) + "], " + shown_number(limits->workspace_max_m[i]));
  }
}

}  // namespace

void read_limits(const json::Value& json, int axis_count, DeviceLimits* limits) {
  json.allow_only({"force_n", "effort", "slew_n_per_s", "velocity_m_per_s", "workspace_m", "device_watchdog_s",
                   "continuous_force_n", "heat_s", "damping_n_s_per_m", "stiffness_n_per_m"});
  if (json["force_n"]) limits->force_n = json["force_n"].number(kForce);
  if (json["effort"]) json["effort"].numbers(limits->effort, axis_count, kEffort);
  if (json["slew_n_per_s"]) limits->slew_n_per_s = json["slew_n_per_s"].number(kSlew);
  if (json["velocity_m_per_s"]) limits->velocity_m_per_s = json["velocity_m_per_s"].number(kVelocity);
  if (json["workspace_m"]) read_workspace(json["workspace_m"].object({"min", "max"}), limits);
  limits->device_watchdog_s = json["device_watchdog_s"].number_or(0, kWatchdog);
  if (json["continuous_force_n"]) {
    limits->continuous_force_n = json["continuous_force_n"].number(kForce);
    limits->heat_s = json["heat_s"].number_or(kUsualHeatS, kHeat);
  } else if (json["heat_s"]) {
    json["heat_s"].fail("stands without continuous_force_n, of which it is the time; give both");
  }
  if (json["damping_n_s_per_m"]) limits->damping_n_s_per_m = json["damping_n_s_per_m"].number(kDamping);
  if (json["stiffness_n_per_m"]) limits->stiffness_n_per_m = json["stiffness_n_per_m"].number(kStiffness);
}

namespace {

// Warnings: limits that are not known, for a device that could push, and a rate that is too low.
void warn(const json::Value& limits, double rate_hz, const std::string& file_name, std::vector<std::string>* warnings) {
  if (const std::string warning = rate_warning(rate_hz); !warning.empty())
    warnings->push_back(one_line(file_name + ": " + warning));
  std::string unknown;
  for (const char* key : {"force_n", "effort", "slew_n_per_s", "velocity_m_per_s", "workspace_m"}) {
    if (!limits || !limits[key]) unknown += (unknown.empty() ? "limits." : ", limits.") + std::string(key);
  }
  if (!unknown.empty())
    warnings->push_back(
        one_line(file_name + ": not known: " + unknown +
                 ": the device is read but gives no force; measure them, or ask its maker, and write them into a "
                 "profile of your own ('fdcg-servo devices --print' gives a built-in one to begin with)"));
  if (!limits || !limits["device_watchdog_s"])
    warnings->push_back(one_line(file_name +
                                 ": limits.device_watchdog_s is not known and taken as none: forces stay low, since "
                                 "nothing would stop the device when the host dies"));
}

void read_profile(const json::Value& json, const std::string& file_name, Profile* profile, std::vector<std::string>* warnings) {
  (void)json["fdcg_profile"].integer(1, 1);
  const std::string name = json["name"].text(kProfileNameBytes - 1);
  std::memcpy(profile->name, name.data(), name.size());
  if (json["source"]) (void)json["source"].text(kLongestText);
  if (json["notes"]) (void)json["notes"].texts(0, 100, kLongestText);
  if (json["match"])
    read_match(json["match"].object({"vendor_id", "product_id", "usage_page", "usage", "interface"}), &profile->match);
  profile->rate_hz = json["rate_hz"].number(kRate);
  const json::Value kinematics = json["kinematics"].object(kKinematicsKeys);
  read_kinematics(kinematics, &profile->kinematics);
  const KinematicsKind kind = profile->kinematics.kind;
  read_input(json["input"].object(kReportKeys), kind, &profile->input, &profile->axis_count);
  check_axis_count(kinematics, kind, profile->axis_count);
  profile->has_output = static_cast<bool>(json["output"]);
  if (profile->has_output) read_output(json["output"].object(kReportKeys), kind, profile->axis_count, &profile->output);
  read_fixed(json, "init", profile->init, &profile->init_count);
  read_fixed(json, "safe_stop", profile->safe_stop, &profile->safe_stop_count);
  const json::Value limits = json["limits"];
  if (limits) read_limits(limits, profile->axis_count, &profile->limits);
  if (warnings != nullptr && profile->has_output) warn(limits, profile->rate_hz, file_name, warnings);
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
  try {
    const json::Document file(text);
    const json::Value json = file.object({"$schema", "fdcg_profile", "name", "source", "notes", "match", "rate_hz", "input",
                                          "output", "init", "safe_stop", "kinematics", "limits"});
    read_profile(json, file_name, profile, warnings);
  } catch (const json::Refusal& refusal) {
    return one_line(file_name + ": " + refusal.message);
  }
  return "";
}

}  // namespace fdcg::dev
